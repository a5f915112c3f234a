//! What order a column shows, and what is wrong with it.

use serde::Serialize;

use super::read::{Cell, Column, Of, Table};
use super::richardson::{Extrapolation, Refusal, extrapolate, order};
use super::trouble::{Errors, LONG_REACH, Trouble, TroubleKind};
use crate::order::{Expected, Limits, Sample, local_order, observe};

/// What is asked of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// The order that is expected.
    pub expect: Option<f64>,
    /// Accepted difference from it, either way.
    pub tolerance: f64,
    /// Safety factor of the grid convergence index.
    pub safety: f64,
    /// Distance from 1 to the next number of the arithmetic.
    pub epsilon: f64,
    /// Size of the quantity, in the unit of its errors.
    pub scale: f64,
    /// Error from which on it says nothing of the step.
    pub saturation: f64,
}

impl Default for Ask {
    fn default() -> Self {
        Ask { expect: None, tolerance: 0.1, safety: 1.25, epsilon: f64::EPSILON, scale: 1.0, saturation: f64::INFINITY }
    }
}

/// What a column says of its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It shows an order, and none was expected.
    Found,
    /// It shows the expected order.
    AsExpected,
    /// It shows a lower order.
    TooLow,
    /// It shows a higher order.
    TooHigh,
    /// It shows no order.
    NoOrder,
}

/// One column judged.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// Name of the column.
    pub name: String,
    /// Steps, coarsest first.
    pub h: Vec<f64>,
    /// Errors, or values; `null` for a failed run.
    pub numbers: Vec<Option<f64>>,
    /// Of errors: the order between neighbours. Of values: the order of each three neighbours.
    pub rates: Vec<Option<f64>>,
    /// The observed order.
    pub order: Option<f64>,
    /// Where it lies.
    pub interval: Option<[f64; 2]>,
    /// Coarsest and finest step of the rows that show it.
    pub window: Option<[f64; 2]>,
    /// C of error = C h^p over these rows.
    pub constant: Option<f64>,
    /// What it says.
    pub verdict: Verdict,
    /// Of values: the limit, and how far the finest value is from it.
    pub extrapolation: Option<Extrapolation>,
    /// Of values: why there is no limit.
    pub refusal: Option<Refusal>,
    /// What is wrong.
    pub troubles: Vec<Trouble>,
}

/// Judges every column of a table.
pub fn judge(table: &Table, ask: &Ask) -> Vec<Judged> {
    let of = |column: &Column| match column.of {
        Of::Errors => errors(table, column, ask),
        Of::Values => values(table, column, ask),
    };
    table.columns.iter().map(of).collect()
}

fn errors(table: &Table, column: &Column, ask: &Ask) -> Judged {
    let signed: Vec<Option<f64>> = column.cells.iter().map(|cell| cell.number).collect();
    let unit = ask.epsilon * ask.scale;
    let (usable, floor) = rounding(&signed, unit);
    let samples: Vec<Sample> =
        table.h.iter().zip(&signed).map(|(&h_s, e)| Sample { h_s, error: e.map(f64::abs), floor }).collect();
    let limits = Limits { rounding_unit: unit, saturation: ask.saturation };
    // Any order is welcome: the window is found without an expectation, and what it shows is judged here.
    let seen = observe(&samples[..usable], Expected::Order { order: 0.0, tolerance: f64::INFINITY }, limits);
    let settling = settling(&samples[..usable], 8.0 * floor.max(unit));
    let fitted = seen.slope.zip(seen.interval).zip(seen.window).filter(|_| seen.verdict.passes());
    let (slope, interval, window) = match (fitted, settling) {
        // The drift that is left in the window is known, and points at the limit.
        (Some(((slope, [low, high]), window)), Some((limit, _))) => {
            (Some(slope), Some([low.min(limit), high.max(limit)]), Some(window))
        }
        (Some(((slope, interval), window)), None) => (Some(slope), Some(interval), Some(window)),
        (None, Some((limit, last))) => {
            let left = (limit - last).abs();
            (Some(limit), Some([limit - left, limit + left]), Some((usable - 3, usable - 1)))
        }
        (None, None) => (None, None, None),
    };
    let rates = samples.windows(2).map(|w| local_order((w[0].h_s, w[0].error?), (w[1].h_s, w[1].error?))).collect();
    let trouble =
        Errors { h: &table.h, signed: &signed, window, slope, expected: ask.expect, unit, saturation: ask.saturation };
    let constant = slope.zip(window).and_then(|(p, (first, last))| {
        let ln: Option<Vec<f64>> = samples[first..=last].iter().map(|s| Some(s.error?.ln() - p * s.h_s.ln())).collect();
        ln.map(|ln| (ln.iter().sum::<f64>() / ln.len() as f64).exp())
    });
    Judged {
        name: column.name.clone(),
        h: table.h.clone(),
        rates,
        order: slope,
        interval,
        window: window.map(|(first, last)| [table.h[first], table.h[last]]),
        constant,
        verdict: match (verdict(slope, interval, ask), settling, ask.expect) {
            (_, Some((limit, _)), Some(p)) if (limit - p).abs() <= ask.tolerance => Verdict::AsExpected,
            (verdict, ..) => verdict,
        },
        extrapolation: None,
        refusal: None,
        troubles: trouble.troubles(),
        numbers: signed,
    }
}

/// Where the last three rates come to rest, and the last of them: rates p + c h drift one way, by less from step to step. `None` where
/// they do not, or where an error is within `floor`.
fn settling(samples: &[Sample], floor: f64) -> Option<(f64, f64)> {
    let last: [&Sample; 4] = samples.iter().collect::<Vec<_>>().last_chunk().copied()?;
    let mut errors = last.iter().map(|s| s.error.filter(|e| *e > floor));
    errors.by_ref().all(|e| e.is_some()).then_some(())?;
    let rate = |i: usize| local_order((last[i].h_s, last[i].error?), (last[i + 1].h_s, last[i + 1].error?));
    let [a, b, c] = [rate(0)?, rate(1)?, rate(2)?];
    let ratio = last[2].h_s / last[3].h_s;
    let settles = (c - b) * (b - a) > 0.0 && (c - b).abs() < (b - a).abs() + SCATTER && (c - b).abs() < UNSETTLED;
    settles.then(|| (c + (c - a) / (ratio * ratio - 1.0), c))
}

/// Scatter of a rate by errors of a percent or so.
const SCATTER: f64 = 0.05;

/// Rates that still change by so much from one pair to the next tell no limit.
const UNSETTLED: f64 = 0.3;

/// How many rows there are before rounding makes the errors rise, and the rounding error that shows in the row before: the smallest
/// of all, where the finer ones are larger and it is small enough to be rounding.
fn rounding(signed: &[Option<f64>], unit: f64) -> (usize, f64) {
    let known = signed.iter().enumerate().filter_map(|(i, e)| Some((i, (*e)?.abs())));
    let smallest = known.min_by(|a, b| a.1.total_cmp(&b.1));
    match smallest {
        Some((i, e)) if i + 1 < signed.len() && e <= LONG_REACH * unit => (i + 1, e),
        _ => (signed.len(), 0.0),
    }
}

/// An order is the expected one if it is so within the tolerance. It is another one only if its interval leaves the expected one
/// out; else nothing is known.
fn verdict(slope: Option<f64>, interval: Option<[f64; 2]>, ask: &Ask) -> Verdict {
    let (Some(slope), Some(interval)) = (slope, interval) else { return Verdict::NoOrder };
    let Some(expected) = ask.expect else { return Verdict::Found };
    if (slope - expected).abs() <= ask.tolerance {
        Verdict::AsExpected
    } else if interval[1] < expected {
        Verdict::TooLow
    } else if interval[0] > expected {
        Verdict::TooHigh
    } else {
        Verdict::NoOrder
    }
}

/// Orders of two triples that agree differ by less, as a part of the order.
const SETTLED: f64 = 0.1;

fn values(table: &Table, column: &Column, ask: &Ask) -> Judged {
    let numbers: Vec<Option<f64>> = column.cells.iter().map(|cell| cell.number).collect();
    // From the finest on: f1, f2, f3.
    let three = |last: usize| -> Option<([f64; 3], [f64; 3], [f64; 3])> {
        let [c, b, a] = [last - 2, last - 1, last];
        let cells: [Cell; 3] = [a, b, c].map(|i| column.cells[i]);
        let values = [cells[0].number?, cells[1].number?, cells[2].number?];
        Some((values, [a, b, c].map(|i| table.h[i]), cells.map(|cell| cell.half_digit)))
    };
    let n = numbers.len();
    let found = if n < 3 { None } else { three(n - 1) };
    let result = found.map(|(values, h, half)| extrapolate(values, h, half, ask.safety));
    let rates: Vec<Option<f64>> = (2..n)
        .map(|last| three(last).and_then(|(v, h, half)| extrapolate(v, h, half, ask.safety).ok().and(order(v, h))))
        .collect();
    let mut troubles = Vec::new();
    let failed = numbers.iter().filter(|x| x.is_none()).count();
    if failed > 0 {
        troubles.push(TroubleKind::FailedRun.with(format!("{failed} of {n} rows have no value")));
    }
    let (extrapolation, refusal) = match result {
        Some(Ok(extrapolation)) => (Some(extrapolation), None),
        Some(Err(refusal)) => {
            troubles.push(refused(refusal));
            (None, Some(refusal))
        }
        None => {
            if n < 3 {
                let evidence = format!("{n} rows; an order of values without a truth needs three");
                troubles.push(TroubleKind::NotAsymptotic.with(evidence));
            }
            (None, None)
        }
    };
    if let Some(found) = extrapolation {
        let known: Vec<f64> = rates.iter().copied().flatten().collect();
        let settled =
            rates.len() < 2 || (known.len() > 1 && (known[known.len() - 2] / found.order - 1.0).abs() <= SETTLED);
        if !settled {
            let orders: Vec<String> =
                rates.iter().map(|p| p.map_or("none".to_owned(), |p| format!("{p:.2}"))).collect();
            let evidence = format!("three rows at a time show the orders {}, which do not agree", orders.join(", "));
            troubles.push(TroubleKind::NotAsymptotic.with(evidence));
        }
    }
    let interval = extrapolation.map(|e| e.order_interval);
    let is_settled = troubles.iter().all(|t| t.kind == TroubleKind::FailedRun);
    let slope = extrapolation.map(|e| e.order).filter(|_| is_settled);
    Judged {
        name: column.name.clone(),
        h: table.h.clone(),
        rates,
        order: extrapolation.map(|e| e.order),
        interval,
        window: extrapolation.map(|_| [table.h[n - 3], table.h[n - 1]]),
        constant: None,
        verdict: verdict(slope, interval, ask),
        extrapolation,
        refusal,
        troubles,
        numbers,
    }
}

fn refused(refusal: Refusal) -> Trouble {
    match refusal {
        Refusal::Oscillating { ratio } => TroubleKind::Oscillating.with(format!(
            "the last two differences have opposite signs, ratio {ratio:.3}; no order and no limit follow"
        )),
        Refusal::Diverging { ratio } => TroubleKind::Diverging
            .with(format!("the last difference is {ratio:.3} of the one before; no order and no limit follow")),
        Refusal::Unresolved { difference, resolution } => TroubleKind::Unresolved
            .with(format!("values differ by {difference:.2e}, and their digits resolve {resolution:.2e}")),
    }
}
