//! From rows to observed orders, and to claims about them.

use reports::{Claim, Table, Verdict as Truth};
use serde::{Deserialize, Serialize};

use super::{HALVINGS, Row, envelope};
use crate::error::Error;
use crate::order;
use crate::order::{Expected, Limits, Sample, Verdict};
use crate::study::{Derived, short};
use scenes::observation::Quantity;
use scenes::run::Precision;

/// Where in a run an error is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// At the end.
    End,
    /// The largest of the run.
    Max,
}

impl Measure {
    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            Measure::End => "end",
            Measure::Max => "max",
        }
    }
}

/// The order observed in one sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrderRow {
    /// Scene or preset.
    pub scene: String,
    /// Method.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// What was compared.
    pub quantity: Quantity,
    /// At the end, or the largest of the run.
    pub measure: Measure,
    /// The order that theory predicts; empty where it predicts no error but rounding.
    pub theory_order: Option<f64>,
    /// Whether theory only bounds the error by theory_constant h^theory_order.
    pub theory_is_envelope: bool,
    /// The order observed; of the envelope, from the coarser to the finer half of a sweep.
    pub order: Option<f64>,
    /// Low end of its interval.
    pub order_low: Option<f64>,
    /// High end of its interval.
    pub order_high: Option<f64>,
    /// Largest step of the window, s.
    pub window_from_h_s: Option<f64>,
    /// Smallest step of the window, s.
    pub window_to_h_s: Option<f64>,
    /// Runs of the sweep.
    pub runs: usize,
    /// Runs in the window.
    pub window_points: Option<usize>,
    /// lim error / h^theory_order, extrapolated linearly from the two smallest steps of the window.
    pub constant: Option<f64>,
    /// By how much the extrapolation changed it: a bound on what is left.
    pub constant_change: Option<f64>,
    /// What theory predicts for it.
    pub theory_constant: Option<f64>,
    /// Largest error that is nothing but rounding.
    pub floor: Option<f64>,
    /// Unit of floor, and of constant times s^order.
    pub unit: String,
    /// What the sweep shows.
    pub verdict: Verdict,
    /// Largest accepted difference from theory_order.
    pub tolerance: f64,
    /// The verdict in words.
    pub note: String,
}

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
            let floor = if row.precision == Precision::DoubleDouble { 0.0 } else { rounding.unwrap_or(0.0) };
            Sample { h_s: row.h_s, error, floor }
        })
        .collect();
    if first.theory_is_envelope {
        return envelope::order_of(first, measure, &samples);
    }
    let tolerance = tolerance(first.precision, sweep.len());
    let expected = first.theory_order.map_or(Expected::Exact, |order| Expected::Order { order, tolerance });
    // The scale may vanish where a quantity passes through zero; one unit of it stands in.
    let scale = if first.scale > 0.0 { first.scale } else { 1.0 };
    // One operation on the state where an order is sought; where there is no error but rounding, that of a whole run.
    let operations = if first.theory_order.is_none() { first.steps as f64 } else { 1.0 };
    let limits = Limits { rounding_unit: operations * first.precision.epsilon() * scale, saturation: scale };
    let seen = order::observe(&samples, expected, limits);
    let step = |pick: fn((usize, usize)) -> usize| seen.window.map(|w| samples[pick(w)].h_s);
    let constant = seen.window.zip(first.theory_order).and_then(|(window, p)| {
        let ratio = |i: usize| Some(samples[i].error? / samples[i].h_s.powf(p));
        let (fine, next) = if samples[window.0].h_s < samples[window.1].h_s {
            (window.0, window.0 + 1)
        } else {
            (window.1, window.1 - 1)
        };
        // c(h) = C + d h + ...: the line through two steps meets h = 0 at C.
        let slope = (ratio(next)? - ratio(fine)?) / (samples[next].h_s - samples[fine].h_s);
        let change = -slope * samples[fine].h_s;
        Some((ratio(fine)? + change, change.abs()))
    });
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
        constant: constant.map(|c| c.0),
        constant_change: constant.map(|c| c.1),
        theory_constant: if measure == Measure::End { first.theory_constant } else { None },
        floor: seen.floor,
        unit: first.unit.clone(),
        verdict: seen.verdict,
        tolerance,
        note: seen.note,
    }
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
        claims.push(order_claim(group));
        claims.extend(group.iter().filter_map(|o| constant_claim(o)));
        claims.extend(group.iter().filter_map(|o| envelope::claim(o)));
    }
    claims
}

fn order_claim(group: &[&OrderRow]) -> Claim {
    let first = group[0];
    let judged: Vec<&OrderRow> = group.iter().copied().filter(|o| is_judged(o)).collect();
    let word = |o: &OrderRow| o.order.map_or_else(|| o.verdict.to_string(), |p| format!("{p:.3}"));
    let measured: Vec<String> =
        judged.iter().map(|o| format!("{} ({}) {}", o.quantity.id(), o.measure.id(), word(o))).collect();
    let theory = |o: &&OrderRow| o.theory_order.map_or_else(|| "exact".to_owned(), |p| p.to_string());
    let mut promised: Vec<String> = group.iter().map(theory).collect();
    promised.dedup();
    Claim {
        id: format!("convergence.{}.{}.order", first.scene, first.method),
        study: "convergence".to_owned(),
        statement: format!("{} on {} converges with the order of theory", first.method, first.scene),
        theory: promised.join(", "),
        measured: measured.join("; "),
        bound: format!("within {} of theory in double-double", first.tolerance),
        // Two runs have a slope, and nothing that could contradict it.
        verdict: if judged.iter().all(|o| o.runs < 3) {
            Truth::NotTested
        } else {
            Truth::from_comparison(judged.iter().all(|o| o.verdict.passes()))
        },
    }
}

/// The largest error of a run has no envelope where a velocity jumps: beside a bounce that is seen late the velocity is wrong by
/// all of its size, however small the step.
fn is_judged(o: &OrderRow) -> bool {
    !(o.theory_is_envelope && o.measure == Measure::Max)
}

fn constant_claim(o: &OrderRow) -> Option<Claim> {
    let (theory, measured, change) = (o.theory_constant?, o.constant?, o.constant_change?);
    // Where the next term is of second order, the extrapolation overshoots by two thirds of its change.
    let bound = change + ROUNDING * theory;
    Some(Claim {
        id: format!("convergence.{}.{}.{}.constant", o.scene, o.method, o.quantity.id()),
        study: "convergence".to_owned(),
        statement: format!("the {} error of {} on {} has the constant of theory", o.quantity.id(), o.method, o.scene),
        theory: format!("{theory:.9e} {}/s^{}", o.unit, o.theory_order.unwrap_or(0.0)),
        measured: format!("{measured:.9e}"),
        bound: format!("+- {bound:.1e}, the change of the last extrapolation"),
        verdict: Truth::from_comparison((measured - theory).abs() <= bound),
    })
}

/// Rounding of a constant that is computed in f64 from theory.
const ROUNDING: f64 = 1e-13;
