//! The search for the window of steps that show the order.

use super::{Limits, Sample, local_order};

/// A point counts if rounding is at most an eighth of its error. Rounding then moves its local order by at most
/// log2(1 + 1/8) = 0.17, and the slope of a four-point fit, in which the last point weighs 0.3, by at most 0.05;
/// what is bent by more than its neighbours is trimmed by the search below.
const ABOVE_FLOOR: f64 = 8.0;

/// Up to here a measured floor may bend a local order visibly: log2(1 + 1/64) = 0.02, the tightest spread below.
const FLOOR_REACH: f64 = 64.0;

/// The reach of a floor that was not measured: a random walk of a million operations, sqrt(2^20) rounding units.
const UNMEASURED_REACH: f64 = 1024.0;

/// Largest spread of the local orders and smallest number of points of a window, in the order they are tried.
///
/// With errors C h^p (1 + c h), halved steps and d the excess of the coarsest local order, four points have the spread
/// 3/4 d and the bias 0.575 d: a spread of 0.02 bounds the bias by 0.015. Three points can agree by chance and
/// come after four that agree about as well; at a spread of 0.2 they would leave the order uncertain by 0.7.
const LADDER: [(f64, usize); 6] = [(0.02, 4), (0.05, 4), (0.02, 3), (0.1, 4), (0.1, 3), (0.2, 4)];

/// Up to this spread four points hardly agree by chance: if local orders are anything between -1.5 and 3.5, three of
/// them do with a probability of 3 (0.05 / 5)^2 = 0.0003.
const BEYOND_CHANCE: f64 = 0.05;

/// What one sample can contribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Usable,
    AtFloor,
    Saturated,
    Failed,
}

pub(super) fn kind(sample: &Sample, limits: &Limits) -> Kind {
    match sample.error {
        Some(e) if e.is_finite() && e >= 0.0 => {
            if e <= ABOVE_FLOOR * sample.floor.max(limits.rounding_unit) {
                Kind::AtFloor
            } else if e >= limits.saturation {
                Kind::Saturated
            } else {
                Kind::Usable
            }
        }
        _ => Kind::Failed,
    }
}

/// Whether the error is rounding even if every one of its h_0 / h times more operations errs the same way.
pub(super) fn is_exact(sample: &Sample, h_0: f64, limits: &Limits) -> bool {
    let bound = ABOVE_FLOOR * sample.floor.max(limits.rounding_unit * (h_0 / sample.h_s));
    sample.error.is_some_and(|e| e >= 0.0 && e <= bound)
}

/// Local orders `ln(e_i / e_(i+1)) / ln(h_i / h_(i+1))`; None where an error is missing, zero or not finite.
pub(super) fn local_orders(samples: &[Sample]) -> Vec<Option<f64>> {
    samples.windows(2).map(|w| local_order((w[0].h_s, w[0].error?), (w[1].h_s, w[1].error?))).collect()
}

/// Whether rounding can bend the local orders at this sample.
fn near_floor(sample: &Sample, limits: &Limits) -> bool {
    let reach = if sample.floor > 0.0 {
        FLOOR_REACH * sample.floor.max(limits.rounding_unit)
    } else {
        UNMEASURED_REACH * limits.rounding_unit
    };
    sample.error.is_some_and(|e| e <= reach)
}

/// The samples of a sweep as the search sees them.
pub(super) struct Search<'a> {
    pub(super) samples: &'a [Sample],
    pub(super) limits: &'a Limits,
    pub(super) kinds: &'a [Kind],
    pub(super) local: &'a [Option<f64>],
}

impl Search<'_> {
    /// The finest, then longest window whose local orders agree and that no finer point contradicts; failing that,
    /// one that is contradicted (the bool), to be shown but not believed.
    pub(super) fn window(&self) -> Option<((usize, usize), bool)> {
        let clean = self.first_on_ladder(false).map(|w| (w, false));
        clean.or_else(|| self.first_on_ladder(true).map(|w| (w, true)))
    }

    fn first_on_ladder(&self, contradicted: bool) -> Option<(usize, usize)> {
        LADDER.iter().find_map(|&(spread, points)| {
            (0..self.samples.len())
                .rev()
                .filter(|&last| contradicted || !self.contradicted_after(last))
                .map(|last| (self.longest_before(last, spread), last))
                .find(|&(first, last)| last + 1 >= first + points && self.trustworthy(first, last, spread))
        })
    }

    /// The first index of the longest window that ends at `last` and whose local orders differ by at most `spread`.
    fn longest_before(&self, last: usize, spread: f64) -> usize {
        let (mut low, mut high, mut first) = (f64::INFINITY, f64::NEG_INFINITY, last);
        if self.kinds[last] != Kind::Usable {
            return last;
        }
        while first > 0 && self.kinds[first - 1] == Kind::Usable {
            let Some(p) = self.local[first - 1] else { break };
            (low, high) = (low.min(p), high.max(p));
            if high - low > spread {
                break;
            }
            first -= 1;
        }
        first
    }

    /// Whether a finer sample denies the window: it failed, or it has an error that is not explained by rounding.
    fn contradicted_after(&self, last: usize) -> bool {
        (last + 1..self.samples.len()).any(|i| match self.kinds[i] {
            Kind::AtFloor => false,
            Kind::Usable => !near_floor(&self.samples[i], self.limits),
            Kind::Saturated | Kind::Failed => true,
        })
    }

    /// A flat or rising stretch within reach of the floor is the floor. Three points, or more that agree only roughly,
    /// may agree by chance among many that do not: they must be two thirds of all, or the end of a drift that dies away.
    fn trustworthy(&self, first: usize, last: usize, spread: f64) -> bool {
        let (coarse, fine) = (&self.samples[first], &self.samples[last]);
        let falls = coarse.error > fine.error.map(|e| e * (coarse.h_s / fine.h_s).sqrt());
        if near_floor(coarse, self.limits) && !falls {
            return false;
        }
        let points = last + 1 - first;
        (points >= 4 && spread <= BEYOND_CHANCE)
            || 2 * self.points_outside(first, last) <= points
            || self.drift_dies_away(first)
    }

    fn points_outside(&self, first: usize, last: usize) -> usize {
        let counts = |i: &usize| self.kinds[*i] == Kind::Usable && !near_floor(&self.samples[*i], self.limits);
        (0..first).chain(last + 1..self.samples.len()).filter(counts).count()
    }

    /// Whether the local orders come into a window by a drift that keeps its sense and shrinks: their last
    /// two differences before the window (or the only one there is), below 1, and its first one inside.
    fn drift_dies_away(&self, first: usize) -> bool {
        let usable = self.kinds[..first].iter().rev().take_while(|k| **k == Kind::Usable).count().min(2);
        let orders: Option<Vec<f64>> = self.local[first - usable..first + 2].iter().copied().collect();
        let Some(orders) = orders.filter(|_| usable > 0) else { return false };
        let steps: Vec<f64> = orders.windows(2).map(|p| p[0] - p[1]).collect();
        steps[0].abs() <= 1.0 && steps.windows(2).all(|d| d[0] * d[1] >= 0.0 && d[0].abs() >= d[1].abs())
    }
}
