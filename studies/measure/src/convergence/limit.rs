//! lim error / h^p for h -> 0, and whether it is theory's: a statement that holds for every motion. Where the limit is not zero
//! the order is p; where it is zero, or small beside the next term, the slope of a sweep is anything from p upwards.

use crate::claim::Evidence;

use integrator::methods::MethodId;
use scenes::run::method_from_id;

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

/// How the ratio error / h^p of a sweep comes to its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Approach {
    /// As C + d h + e h^2: an error at one time.
    Smooth,
    /// As the largest of several such: it may change from one of them to another.
    Largest,
}

/// The limit from three neighbouring runs, by the parabola through them; of a largest error by the line through the finer two. The
/// bound is what the coarser runs change, and `rounding` of the errors. The finest runs whose rounding is below that change serve;
/// where there are none, those with the least bound.
pub fn limit(samples: &[Sample], p: f64, approach: Approach, rounding: impl Fn(&Sample) -> f64) -> Option<Limit> {
    let ratio = |s: &Sample| Some(s.error.filter(|e| e.is_finite())? / s.h_s.powf(p));
    let line = |a: &Sample, b: &Sample| {
        let (coarse, fine) = (ratio(a)?, ratio(b)?);
        Some(fine - (coarse - fine) / (a.h_s - b.h_s) * b.h_s)
    };
    let parabola = |w: &[Sample]| {
        let (fine, coarse) = (line(&w[1], &w[2])?, line(&w[0], &w[1])?);
        Some((w[0].h_s * fine - w[2].h_s * coarse) / (w[0].h_s - w[2].h_s))
    };
    // A distance |a + b h| bends where a is small; its square is a parabola.
    let square = |w: &[Sample]| {
        let square = |s: &Sample| Some(ratio(s)? * ratio(s)?);
        let line = |a: &Sample, b: &Sample| {
            let (coarse, fine) = (square(a)?, square(b)?);
            Some(fine - (coarse - fine) / (a.h_s - b.h_s) * b.h_s)
        };
        let (fine, coarse) = (line(&w[1], &w[2])?, line(&w[0], &w[1])?);
        let value = (w[0].h_s * fine - w[2].h_s * coarse) / (w[0].h_s - w[2].h_s);
        Some((value, (value - fine).abs()))
    };
    let of_squares = |last: usize| {
        let (value, beyond_a_line) = square(&samples[last - 2..=last])?;
        let before = if last >= 3 { square(&samples[last - 3..last]) } else { None };
        let change = CHANGES * before.map_or(beyond_a_line, |(before, _)| (value - before).abs());
        let [low, middle, high] = [value - change, value, value + change].map(|x| x.max(0.0).sqrt());
        Some((middle, (high - middle).max(middle - low)))
    };
    let of = |last: usize| {
        let w = &samples[last - 2..=last];
        let (fine, coarse) = (line(&w[1], &w[2])?, line(&w[0], &w[1])?);
        let noise = WEIGHTS * rounding(&w[2]) / w[2].h_s.powf(p);
        let (value, change) = match approach {
            Approach::Smooth if parabola(w)?.abs() < SMALL * ratio(&w[2])? => of_squares(last)?,
            Approach::Smooth => {
                let value = parabola(w)?;
                // A change may be small by chance, where a term passes zero: the one before bounds it then.
                let before = if last >= 3 { parabola(&samples[last - 3..last]) } else { None };
                let drift = before.map_or(0.0, |before| (value - before).abs());
                (value, CHANGES * (value - fine).abs().max(drift))
            }
            Approach::Largest => (fine, CHANGES * ((fine - ratio(&w[2])?).abs() + (fine - coarse).abs())),
        };
        Some((Limit { value, bound: change + noise }, noise <= change))
    };
    let all: Vec<(Limit, bool)> = (2..samples.len()).rev().filter_map(of).collect();
    let clear = all.iter().find(|(limit, clear)| *clear && limit.bound.is_finite());
    let least = || all.iter().filter(|(l, _)| l.bound.is_finite()).min_by(|a, b| a.0.bound.total_cmp(&b.0.bound));
    clear.or_else(least).map(|(limit, _)| *limit)
}

/// Sum of the sizes of the weights (8, -6, 1) / 3 of three halved steps.
const WEIGHTS: f64 = 5.0;
/// What is left is bounded by this many times the last change, for sweeps that are not far into their limit.
const CHANGES: f64 = 3.0;
/// A limit below this part of the finest ratio is that of a distance which bends.
const SMALL: f64 = 0.5;
/// The part of a limit to which it is resolved: a wrong constant would be seen.
pub const RESOLVED: f64 = 0.3;
/// A limit below this part of the finest ratio adds nothing to it.
const NOTHING: f64 = 0.01;
/// Half an order: where the finest runs fall by so much faster, or slower, than the order of theory, it is not theirs.
const HALF: f64 = 0.5;
/// Runs with steps longer than this part of the time scale may fail without a fault of the method.
const COARSE: f64 = 0.25;

/// Whether one sweep shows what theory says. Steps that are too long for a small error speak against nothing.
pub fn judge(o: &OrderRow) -> Evidence {
    match judge_fine(o) {
        Evidence::Inside | Evidence::Undecided if o.is_erratic && !o.is_coarse => Evidence::Outside,
        Evidence::Outside if o.is_coarse || is_at_the_floor(o) => Evidence::Undecided,
        evidence => evidence,
    }
}

/// Whether fewer than three errors are clear of rounding where an order is promised.
fn is_at_the_floor(o: &OrderRow) -> bool {
    o.theory_order.is_some() && o.verdict == Verdict::AtTheFloor
}

fn judge_fine(o: &OrderRow) -> Evidence {
    let Some(p) = o.theory_order.filter(|_| !o.theory_is_envelope) else {
        let too_coarse = o.coarsest_failure_h_s.is_none_or(|h| h > COARSE * o.time_scale_s);
        return match o.verdict {
            // No step is short enough for the envelope.
            _ if o.theory_is_envelope && o.window_points == Some(0) => Evidence::Undecided,
            // As below: runs that failed with coarse steps say nothing of finer ones.
            Verdict::Failed if too_coarse => Evidence::Undecided,
            // An equation that Newton's iteration has solved to less than the last digit.
            Verdict::AtTheFloor if method_from_id(&o.method).is_ok_and(MethodId::is_implicit) => Evidence::Undecided,
            verdict => Evidence::is(verdict.passes()),
        };
    };
    let (Some((theory, doubt)), Some((value, bound))) = (o.theory_limit(), o.constant.zip(o.constant_change)) else {
        return without_constant(o, p);
    };
    // Errors are lengths: a limit below zero is that of an error that has yet to change its sign.
    let (value, allowed) = (value.abs(), bound + doubt + ROUNDING * theory);
    let resolved = allowed <= RESOLVED * theory.max(value);
    // An error that falls faster shows a zero only where what is left is small beside what is seen.
    let falls_faster = o.finest_order.is_some_and(|order| order >= p + HALF);
    let vanished = value <= allowed && falls_faster && allowed <= RESOLVED * o.fine_constant;
    // A clean order one higher is that of a limit which theory says is next to nothing beside what is seen.
    let is_next = o.order.is_some_and(|order| (order - p - 1.0).abs() <= o.tolerance);
    if o.verdict == Verdict::SuperConvergent && is_next && theory + doubt <= NOTHING * o.fine_constant {
        return Evidence::Inside;
    }
    if o.leading.is_some_and(|size| size < 0.0) || (value - theory).abs() > allowed {
        if resolved || is_too_low(o, p) { Evidence::Outside } else { Evidence::Undecided }
    } else if o.is_rounding || resolved || vanished {
        Evidence::Inside
    } else {
        Evidence::Undecided
    }
}

/// Whether error / h^p grows to the finest runs, by half an order or more: of a lower order, or of another limit.
fn is_too_low(o: &OrderRow, p: f64) -> bool {
    o.finest_order.is_some_and(|order| order <= p - HALF) && o.fine_constant >= 0.9 * o.coarse_constant
}

/// The verdict where theory knows an order and no constant: at least this order. No method is exact by mistake.
fn without_constant(o: &OrderRow, p: f64) -> Evidence {
    match o.verdict {
        Verdict::AsExpected | Verdict::Exact | Verdict::SuperConvergent => Evidence::Inside,
        _ if o.is_rounding => Evidence::Inside,
        // The finest run finished, or even that was coarse: nothing is said of finer ones.
        Verdict::Failed if o.coarsest_failure_h_s.is_none_or(|h| h > COARSE * o.time_scale_s) => Evidence::Undecided,
        Verdict::Failed => Evidence::Outside,
        _ if o.finest_order.is_some_and(|order| order >= p - o.tolerance) => Evidence::Inside,
        _ if is_too_low(o, p) => Evidence::Outside,
        _ => Evidence::Undecided,
    }
}

/// Rounding of a constant that is computed in f64 from theory.
pub(super) const ROUNDING: f64 = 1e-13;
