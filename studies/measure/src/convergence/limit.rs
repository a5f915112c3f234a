//! lim error / h^p for h -> 0, and whether it is theory's: a statement that holds for every motion. Where the limit is not zero
//! the order is p; where it is zero, or small beside the next term, the slope of a sweep is anything from p upwards.

use crate::claim::Evidence;

use super::OrderRow;
use crate::order::{Sample, Verdict};

/// A limit with a bound on what the extrapolation leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// lim error / h^p.
    pub value: f64,
    /// How far it may be off.
    pub bound: f64,
}

/// The limit from three neighbouring runs: c(h) = C + d h + ..., and the line through two steps meets h = 0 at C. The bound is
/// what the extrapolation changes, what it changed since the pair before, and `rounding` of the errors. The finest runs whose
/// rounding is below the change serve; where there are none, those with the least bound.
pub fn limit(samples: &[Sample], p: f64, rounding: impl Fn(&Sample) -> f64) -> Option<Limit> {
    let ratio = |s: &Sample| Some(s.error.filter(|e| e.is_finite())? / s.h_s.powf(p));
    let line = |a: &Sample, b: &Sample| {
        let (coarse, fine) = (ratio(a)?, ratio(b)?);
        Some(fine - (coarse - fine) / (a.h_s - b.h_s) * b.h_s)
    };
    let of = |w: &[Sample]| {
        let (value, before) = (line(&w[1], &w[2])?, line(&w[0], &w[1])?);
        let change = (value - ratio(&w[2])?).abs();
        let noise = 2.0 * rounding(&w[2]) / w[2].h_s.powf(p);
        Some((Limit { value, bound: change + (value - before).abs() + noise }, noise <= change))
    };
    let all: Vec<(Limit, bool)> = samples.windows(3).rev().filter_map(of).collect();
    let clear = all.iter().find(|(limit, clear)| *clear && limit.bound.is_finite());
    let least = || all.iter().filter(|(l, _)| l.bound.is_finite()).min_by(|a, b| a.0.bound.total_cmp(&b.0.bound));
    clear.or_else(least).map(|(limit, _)| *limit)
}

/// The part of a limit to which it is resolved: a wrong constant would be seen.
const RESOLVED: f64 = 0.1;
/// By how much error / h^p has to fall over a sweep before it is taken to vanish.
const VANISHED: f64 = 0.25;
/// An order that is this much too low over the finest runs is too low.
const TOO_LOW: f64 = 0.5;
/// Runs with steps longer than this part of the time scale may fail without a fault of the method.
const COARSE: f64 = 0.25;

/// Whether one sweep shows what theory says.
pub fn judge(o: &OrderRow) -> Evidence {
    if o.theory_order.is_none() || o.theory_is_envelope {
        return Evidence::is(o.verdict.passes());
    }
    let known = o.leading.zip(o.leading_doubt);
    match (known, o.constant.zip(o.constant_change)) {
        (Some((theory, doubt)), Some((value, change))) => {
            // Three times the change covers a sweep that is not far into its limit, or whose largest error moves from one checkpoint
            // to another. Errors are lengths: a limit below zero is that of an error that has yet to change its sign.
            let (value, allowed) = (value.abs(), 3.0 * change + doubt + ROUNDING * theory);
            let seen = allowed <= RESOLVED * theory.max(value) || allowed + value <= VANISHED * o.coarse_constant;
            if (value - theory).abs() > allowed {
                Evidence::Outside
            } else if seen || o.verdict.passes() || o.is_rounding {
                Evidence::Inside
            } else {
                Evidence::Undecided
            }
        }
        _ => without_constant(o),
    }
}

/// The verdict where theory knows an order and no constant: at least this order. No method is exact by mistake.
fn without_constant(o: &OrderRow) -> Evidence {
    match o.verdict {
        Verdict::AsExpected | Verdict::Exact | Verdict::SuperConvergent => Evidence::Inside,
        _ if o.is_rounding => Evidence::Inside,
        // The finest run finished, or even that was coarse: nothing is said of finer ones.
        Verdict::Failed if o.coarsest_failure_h_s.is_none_or(|h| h > COARSE * o.time_scale_s) => Evidence::Undecided,
        Verdict::Failed => Evidence::Outside,
        Verdict::Capped | Verdict::NotAsymptotic | Verdict::AtTheFloor => match (o.finest_order, o.theory_order) {
            (Some(order), Some(p)) if order >= p - o.tolerance => Evidence::Inside,
            (Some(order), Some(p)) if order <= p - TOO_LOW => Evidence::Outside,
            _ => Evidence::Undecided,
        },
    }
}

/// Rounding of a constant that is computed in f64 from theory.
pub(super) const ROUNDING: f64 = 1e-13;
