//! From rows to observed orders, and to claims about them.

use reports::{Claim, Table};

use super::limit::{Approach, RESOLVED, ROUNDING, judge, limit};
use super::order_row::{Measure, OrderRow, finest_order};
use super::{HALVINGS, Row, envelope};
use crate::claim::{Evidence, claim};
use crate::error::Error;
use crate::order;
use crate::order::{Expected, Limits, Sample, local_order};
use crate::study::{Derived, short};
use scenes::errors::CHECKPOINTS;
use scenes::run::{Outcome, Precision, method_from_id};

/// The largest difference from theory's order that is accepted: 0.02 in double-double after 12 halvings of the step. What
/// the next term of the error adds to the slope is proportional to the step, so that each halving less doubles it.
/// Rounding bends the fine end of a window in f32 and f64.
pub fn tolerance(precision: Precision, runs: usize) -> f64 {
    let base = match precision {
        Precision::F32 => 0.1,
        Precision::F64 => 0.05,
        Precision::DoubleDouble => 0.02,
    };
    let missing = (HALVINGS as usize + 1).saturating_sub(runs).min(3);
    base * f64::from(1_u32 << missing)
}

/// The observed order of every sweep among the rows, in their order.
pub fn orders(rows: &[Row]) -> Vec<OrderRow> {
    let key = |row: &Row| (row.scene.clone(), row.method.clone(), row.precision, row.quantity);
    let mut keys = Vec::new();
    let mut sweeps: std::collections::HashMap<_, Vec<&Row>> = std::collections::HashMap::new();
    for row in rows {
        let sweep = sweeps.entry(key(row)).or_default();
        if sweep.is_empty() {
            keys.push(key(row));
        }
        sweep.push(row);
    }
    for sweep in sweeps.values_mut() {
        sweep.sort_by_key(|row| row.steps);
    }
    let both = |key| [Measure::End, Measure::Max].map(|measure| order_of(&sweeps[key], measure));
    keys.iter().flat_map(both).collect()
}

fn order_of(sweep: &[&Row], measure: Measure) -> OrderRow {
    let first = sweep[0];
    let samples: Vec<Sample> = sweep
        .iter()
        .map(|row| {
            let (error, rounding) = match measure {
                Measure::End => (row.error_end, row.rounding_end),
                Measure::Max => (row.error_max, row.rounding_max),
            };
            let error = error.filter(|_| row.outcome == Outcome::Finished);
            let floor = if row.precision == Precision::DoubleDouble { 0.0 } else { rounding.unwrap_or(0.0) };
            Sample { h_s: row.h_s, error, floor }
        })
        .collect();
    if first.theory_is_envelope {
        return envelope::order_of(first, measure, &samples);
    }
    let tolerance = tolerance(first.precision, sweep.len());
    let expected = first.theory_order.map_or(Expected::Exact, |order| Expected::Order { order, tolerance });
    // A quantity that is zero all along has no scale of its own; one unit of it stands in.
    let scale = if first.scale > 0.0 { first.scale } else { 1.0 };
    let unit = first.precision.epsilon() * scale;
    // Where an order is sought a run's rounding is not known beforehand; where there is no error but rounding, that of a whole run.
    let operations = if first.theory_order.is_none() { first.steps as f64 } else { 1.0 };
    let limits = Limits { rounding_unit: operations * unit, saturation: scale };
    // With steps beyond its stability limit a method multiplies roundings even of a motion that it has exactly.
    let longest = first.theory_below_h_s.unwrap_or(f64::INFINITY).min(first.time_scale_s);
    let unstable = samples.iter().take_while(|s| s.h_s > longest).count();
    let judged = match expected {
        Expected::Exact if samples.len() - unstable >= 3 => &samples[unstable..],
        _ => &samples[..],
    };
    let seen = order::observe(judged, expected, limits);
    let step = |pick: fn((usize, usize)) -> usize| seen.window.map(|w| judged[pick(w)].h_s);
    let steps = |s: &Sample| (first.h_s * first.steps as f64) / s.h_s;
    let rounding = |s: &Sample| s.floor.max(ROUNDINGS * steps(s) * unit);
    let approach = if measure == Measure::End { Approach::Smooth } else { Approach::Largest };
    let limit = first.theory_order.and_then(|p| limit(comparable(&samples, sweep, measure), p, approach, rounding));
    let ratio = |s: &Sample| s.error.map(|e| e / s.h_s.powf(first.theory_order.unwrap_or(0.0)));
    let (theory_constant, theory_doubt, leading) = match measure {
        Measure::End => (first.theory_constant, first.theory_doubt, first.leading_end),
        Measure::Max => (None, 0.0, first.leading_max),
    };
    // The largest error is taken at the checkpoints only where they are steps.
    let at_checkpoints = sweep.iter().all(|row| row.steps < CHECKPOINTS || row.steps.is_multiple_of(CHECKPOINTS));
    let leading = leading.filter(|_| measure == Measure::End || at_checkpoints);
    let failed = samples.iter().rev().take_while(|s| s.error.is_none());
    OrderRow {
        scene: first.scene.clone(),
        method: first.method.clone(),
        precision: first.precision,
        quantity: first.quantity,
        measure,
        theory_order: first.theory_order,
        theory_is_envelope: false,
        order: seen.slope,
        order_low: seen.interval.map(|i| i[0]),
        order_high: seen.interval.map(|i| i[1]),
        window_from_h_s: step(|w| w.0),
        window_to_h_s: step(|w| w.1),
        runs: sweep.len(),
        window_points: seen.window.map(|w| w.1 - w.0 + 1),
        constant: limit.map(|l| l.value),
        constant_change: limit.map(|l| l.bound),
        coarse_constant: samples.iter().filter_map(ratio).filter(|r| r.is_finite()).fold(0.0, f64::max),
        fine_constant: samples
            .iter()
            .rfind(|s| s.error.is_some_and(|e| e.is_finite() && e > rounding(s)))
            .and_then(ratio)
            .unwrap_or(0.0),
        theory_constant,
        theory_doubt,
        leading,
        leading_doubt: first.leading_doubt,
        finest_order: finest_order(&samples, rounding),
        is_rounding: samples.iter().all(|s| s.error.is_some_and(|e| e <= rounding(s))),
        is_coarse: is_coarse(first, samples.last().map_or(f64::INFINITY, |s| s.h_s)),
        is_erratic: first.theory_order.is_some_and(|p| is_erratic(&samples, p, rounding)),
        coarsest_failure_h_s: failed.last().map(|s| s.h_s),
        time_scale_s: first.time_scale_s,
        floor: seen.floor,
        unit: first.unit.clone(),
        verdict: seen.verdict,
        tolerance,
        note: seen.note,
    }
}

/// What steps of this length make of a motion in steps and in radians, at most, that an order can be judged by.
const COARSE: f64 = 0.03;

fn is_coarse(first: &Row, finest_h_s: f64) -> bool {
    let end_s = first.h_s * first.steps as f64;
    let part = (finest_h_s / first.time_scale_s).powf(first.theory_order.unwrap_or(f64::INFINITY));
    first.theory_order.is_some() && end_s / first.time_scale_s * part > COARSE
}

/// Turns in the finest runs from an order too high by one or more to one too low, or back, that no smooth motion has: an error that
/// changes its sign has one.
const TURNS: usize = 3;

fn is_erratic(samples: &[Sample], p: f64, rounding: impl Fn(&Sample) -> f64) -> bool {
    let clear: Vec<&Sample> = samples.iter().filter(|s| s.error.is_some_and(|e| e > rounding(s))).collect();
    let off = |w: &[&Sample]| Some(local_order((w[0].h_s, w[0].error?), (w[1].h_s, w[1].error?))? - p);
    let all: Vec<f64> = clear.windows(2).filter_map(off).collect();
    let turns = all.windows(2).rev().take_while(|w| w[0] * w[1] < 0.0 && w[0].abs().min(w[1].abs()) > 1.0);
    turns.count() >= TURNS
}

/// A step rounds a few times, and the motion carries it along.
const ROUNDINGS: f64 = 16.0;

/// The runs that are compared at the same times: of the largest errors those that pass every checkpoint, where there are enough.
fn comparable<'a>(samples: &'a [Sample], sweep: &[&Row], measure: Measure) -> &'a [Sample] {
    let first = sweep.iter().position(|row| row.steps >= CHECKPOINTS).unwrap_or(0);
    if measure == Measure::Max && samples.len() - first >= 3 { &samples[first..] } else { samples }
}

/// Every order as CSV; for a reader those in double-double, which no rounding disturbs.
pub(super) fn table(rows: &[Row]) -> Result<Derived, Error> {
    let orders = orders(rows);
    let headers = ["scene", "method", "quantity", "taken", "theory", "order", "interval", "window h (s)", "verdict"];
    let mut table = Table::new(&headers, &["theory", "order"]);
    for o in orders.iter().filter(|o| o.precision == Precision::DoubleDouble) {
        let pair = |a: Option<f64>, b: Option<f64>, show: fn(Option<f64>) -> String| match (a, b) {
            (None, None) => "–".to_owned(),
            _ => format!("{} … {}", show(a), show(b)),
        };
        table.push([
            o.scene.clone(),
            o.method.clone(),
            o.quantity.id().to_owned(),
            o.measure.id().to_owned(),
            o.theory_order.map_or_else(|| "exact".to_owned(), |p| p.to_string()),
            o.order.map_or_else(|| "–".to_owned(), |p| format!("{p:.3}")),
            pair(o.order_low, o.order_high, |x| x.map_or_else(String::new, |x| format!("{x:.3}"))),
            pair(o.window_from_h_s, o.window_to_h_s, short),
            o.verdict.to_string(),
        ]);
    }
    Ok(Derived {
        name: "orders",
        caption: "Observed orders in double-double; the CSV has all precisions, constants and floors",
        csv: reports::write_csv(&orders)?,
        table,
    })
}

/// One claim a scene and method: the order in double-double is theory's, in every quantity, at the end and at most; and the
/// error constant where theory knows it.
pub(super) fn claims(rows: &[Row]) -> Vec<Claim> {
    let orders = orders(rows);
    let double: Vec<&OrderRow> = orders.iter().filter(|o| o.precision == Precision::DoubleDouble).collect();
    let mut claims = Vec::new();
    for group in double.chunk_by(|a, b| a.scene == b.scene && a.method == b.method) {
        claims.extend(order_claim(group));
        claims.extend(group.iter().filter_map(|o| constant_claim(o)));
        claims.extend(group.iter().filter_map(|o| envelope::envelope_claim(o)));
    }
    claims
}

fn order_claim(group: &[&OrderRow]) -> Option<Claim> {
    let first = group[0];
    let judged: Vec<&OrderRow> = group.iter().copied().filter(|o| is_judged(o)).collect();
    let word = |o: &OrderRow| o.order.map_or_else(|| o.verdict.to_string(), |p| format!("{p:.3}"));
    let measured: Vec<String> =
        judged.iter().map(|o| format!("{} ({}) {}", o.quantity.id(), o.measure.id(), word(o))).collect();
    let theory = |o: &&OrderRow| match o.theory_order {
        None => "exact".to_owned(),
        Some(p) if vanishes(o) => format!("at least {}", p + 1.0),
        Some(p) => p.to_string(),
    };
    let mut promised: Vec<String> = group.iter().map(theory).collect();
    promised.dedup();
    let texts = [
        format!("{} on {} converges with the order of theory", first.method, first.scene),
        promised.join(", "),
        measured.join("; "),
        format!("within {} of theory in double-double", first.tolerance),
    ];
    // Two runs have a slope, and nothing that could contradict it.
    let few = judged.iter().all(|o| o.runs < 3);
    let evidence = judged.iter().map(|o| if few { Evidence::Undecided } else { said(o, &judged) });
    let evidence = evidence.filter(|&one| is_promised(&first.method, &first.scene, one)).collect::<Vec<_>>();
    let id = format!("{}.{}.order", first.scene, first.method);
    (!evidence.is_empty()).then(|| claim("convergence", &id, texts, evidence).on(&first.scene).by(&first.method))
}

/// Whether a sweep can speak for or against a claim. Of a method that no theory was worked out for nothing is promised where the
/// motion is not smooth, and what is undecided was not promised.
fn is_promised(method: &str, scene: &str, said: Evidence) -> bool {
    let is_smooth = || {
        let scene = scenes::by_id(scene);
        scene.is_ok_and(|any| any.scene().nonsmooth_times_s(any.scene().info().horizon_s).is_empty())
    };
    method_from_id(method).is_ok_and(|method| method.facts().worked_out) || (said != Evidence::Undecided && is_smooth())
}

/// What one sweep says. An error at the end is at most the largest, so that the order of the largest is the least of the other
/// where theory knows no constant of it.
fn said(o: &OrderRow, judged: &[&OrderRow]) -> Evidence {
    match judge(o) {
        Evidence::Inside => Evidence::Inside,
        _ if o.measure == Measure::End
            && !o.is_erratic
            && is_unknown(o)
            && o.theory_order.is_some()
            && !o.theory_is_envelope =>
        {
            let largest = |x: &&&OrderRow| x.quantity == o.quantity && x.measure == Measure::Max;
            judged.iter().find(largest).map_or(Evidence::Undecided, |x| judge(x))
        }
        other => other,
    }
}

/// Whether theory does not know the limit, or only that it is small.
fn is_unknown(o: &OrderRow) -> bool {
    o.theory_limit().is_none_or(|(limit, doubt)| doubt > RESOLVED * limit)
}

/// A constant below this part of the ratio that is seen is zero.
const VANISHES: f64 = 1e-9;

/// Whether theory knows that the leading term is zero, or too small to be seen.
fn vanishes(o: &OrderRow) -> bool {
    o.leading.zip(o.leading_doubt).is_some_and(|(c, doubt)| c + doubt <= VANISHES * o.fine_constant)
}

/// The largest error of a run has no envelope where a velocity jumps: beside a bounce that is seen late the velocity is wrong by
/// all of its size, however small the step.
fn is_judged(o: &OrderRow) -> bool {
    !(o.theory_is_envelope && o.measure == Measure::Max)
}

fn constant_claim(o: &OrderRow) -> Option<Claim> {
    // An envelope has a claim of its own.
    let theory = o.theory_constant.filter(|_| !o.theory_is_envelope)?;
    let bound = o.constant_change.map_or(f64::NAN, |change| change + o.theory_doubt + ROUNDING * theory);
    let texts = [
        format!("the {} error of {} on {} has the constant of theory", o.quantity.id(), o.method, o.scene),
        format!("{theory:.9e} {}/s^{}", o.unit, o.theory_order.unwrap_or(0.0)),
        o.constant.map_or_else(|| "none".to_owned(), |x| format!("{x:.9e}")),
        format!("+- {bound:.1e}, what the extrapolation may leave"),
    ];
    // Too few runs, too coarse ones, or errors at the floor have no window to extrapolate from.
    // So are those of which the extrapolation leaves too much: a part of the constant, of one that vanishes a part of what is seen.
    let is_zero = theory <= VANISHES * o.fine_constant;
    let size = |x: &f64| if is_zero { o.fine_constant } else { theory.max(x.abs()) };
    let is_resolved = |x: &f64| !o.is_coarse && bound <= RESOLVED * size(x);
    let evidence = match o.constant.filter(is_resolved) {
        _ if o.is_rounding && theory == 0.0 => Evidence::Inside,
        resolved => resolved.map_or(Evidence::Undecided, |x| Evidence::near(Some(x.abs()), Some(theory), bound)),
    };
    let id = format!("{}.{}.{}.constant", o.scene, o.method, o.quantity.id());
    Some(claim("convergence", &id, texts, [evidence]).on(&o.scene).by(&o.method))
}

#[cfg(test)]
mod tests {
    use super::*;

    // Fails if: what is undecided of a method without theory stays in a claim, or in one of a motion that is not smooth a lower order.
    #[test]
    fn nothing_is_promised_of_a_method_without_theory_but_a_least_order_on_a_smooth_motion() {
        let promised = |method, scene| {
            [Evidence::Inside, Evidence::Outside, Evidence::Undecided].map(|said| is_promised(method, scene, said))
        };
        assert_eq!(promised("rk4", "bouncing-ball"), [true; 3]);
        assert_eq!(promised("new-method", "oscillator"), [true, true, false]);
        assert_eq!(promised("new-method", "bouncing-ball"), [false; 3]);
    }
}
