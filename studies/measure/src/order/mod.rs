//! The observed order of convergence: which steps show it, what it is, how well it is known, and whether it is the
//! order that theory promises.
//!
//! Theory says `error = C h^p (1 + c h + ...)` for small h. Coarse steps show the bracket, fine steps show rounding,
//! and only a window between them shows p. The window is found from the local orders
//! `p_i = ln(e_i / e_(i+1)) / ln(h_i / h_(i+1))` alone; the expected order takes no part in the search.

mod verdict;
mod window;

use crate::fit;
use scenes::observation::worse;
use serde::{Deserialize, Serialize};
pub use verdict::Verdict;
use window::{Kind, Search};

/// The error of one run of a step-size sweep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Step.
    pub h_s: f64,
    /// Error against the exact solution, in the unit of the quantity; None if the run failed.
    pub error: Option<f64>,
    /// Measured rounding error at this step, in the unit of the error; 0 if it was not measured.
    pub floor: f64,
}

/// What theory promises.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Expected {
    /// `error ~ C h^order`; the observed slope may differ from it by `tolerance` either way.
    Order {
        /// The order p.
        order: f64,
        /// The largest difference that is accepted, above and below.
        tolerance: f64,
    },
    /// The method solves this problem exactly, so that the error is rounding at every step.
    Exact,
}

/// The error levels between which an order can be seen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Rounding error of one operation on the state: EPSILON of the arithmetic times the scale of the state.
    pub rounding_unit: f64,
    /// The error from which on it says nothing about the step, such as the size of the orbit; may be infinite.
    pub saturation: f64,
}

/// The observed order and its evidence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Order {
    /// Slope of ln error over ln h in the window; None without a window.
    pub slope: Option<f64>,
    /// Where the order lies, with 95 % confidence if the residuals are scatter, plus the drift that is still visible.
    pub interval: Option<[f64; 2]>,
    /// First and last index (inclusive) of the samples the slope was fitted to.
    pub window: Option<(usize, usize)>,
    /// C of `error = C h^p` with p the expected order, over the window; only where that order was found.
    pub constant: Option<f64>,
    /// Largest error among the samples that are nothing but rounding; None if there is no such sample.
    pub floor: Option<f64>,
    /// Local orders between neighbours; None where an error is missing, zero or not finite.
    pub local: Vec<Option<f64>>,
    /// Whether this is what theory promises.
    pub verdict: Verdict,
    /// The verdict in words, with its numbers.
    pub note: String,
}

impl Order {
    fn blank(verdict: Verdict, note: String) -> Self {
        Self { slope: None, interval: None, window: None, constant: None, floor: None, local: vec![], verdict, note }
    }
}

/// The order between two runs, `ln(e_1 / e_2) / ln(h_1 / h_2)`, each a step with its error; `None` where an error is zero or not
/// finite.
pub fn local_order(coarse: (f64, f64), fine: (f64, f64)) -> Option<f64> {
    let is_usable = |e: f64| e.is_finite() && e > 0.0;
    let order = || (coarse.1 / fine.1).ln() / (coarse.0 / fine.0).ln();
    (is_usable(coarse.1) && is_usable(fine.1)).then(order)
}

/// The observed order of `samples`, which go from the coarsest step to the finest.
///
/// Failed runs, errors that are not finite and saturated errors are never fitted, and none of them can pass. Steps that
/// are not finite, positive and decreasing give `Failed`.
pub fn observe(samples: &[Sample], expected: Expected, limits: Limits) -> Order {
    let steps_are_valid = samples.iter().all(|s| s.h_s.is_finite() && s.h_s > 0.0);
    if !steps_are_valid || samples.windows(2).any(|w| w[0].h_s <= w[1].h_s) {
        let note = "the steps must be finite, positive and strictly decreasing: sort the samples by step";
        return Order::blank(Verdict::Failed, note.to_owned());
    }
    let kinds: Vec<Kind> = samples.iter().map(|s| window::kind(s, &limits)).collect();
    let at_floor = samples.iter().zip(&kinds).filter(|(_, k)| **k == Kind::AtFloor).filter_map(|(s, _)| s.error);
    let found = Order {
        floor: at_floor.reduce(worse),
        local: window::local_orders(samples),
        ..Order::blank(Verdict::NotAsymptotic, String::new())
    };
    if expected == Expected::Exact
        && let Some((verdict, note)) = exactness(samples, &kinds, &limits)
    {
        return Order { verdict, note, ..found };
    }
    let search = Search { samples, limits: &limits, kinds: &kinds, local: &found.local };
    match search.window() {
        Some((window, contradicted)) => in_window(samples, &kinds, expected, window, contradicted, found),
        None => {
            let (verdict, note) = verdict::without_window(&kinds);
            Order { verdict, note, ..found }
        }
    }
}

/// The verdict on a run that should be exact, unless there is an error to be fitted.
fn exactness(samples: &[Sample], kinds: &[Kind], limits: &Limits) -> Option<(Verdict, String)> {
    if kinds.contains(&Kind::Failed) {
        return Some((Verdict::Failed, "a run failed where an exact solution was expected".to_owned()));
    }
    let exact = samples.len() >= 3 && samples.iter().all(|s| window::is_exact(s, samples[0].h_s, limits));
    exact.then(|| (Verdict::Exact, "every error is rounding".to_owned()))
}

/// The fit over the window, added to what was `found`.
fn in_window(
    samples: &[Sample],
    kinds: &[Kind],
    expected: Expected,
    (first, last): (usize, usize),
    contradicted: bool,
    found: Order,
) -> Order {
    let points: Vec<(f64, f64)> =
        samples[first..=last].iter().filter_map(|s| Some((s.h_s.ln(), s.error?.ln()))).collect();
    let Some(line) = fit::line(&points) else {
        return Order { note: "the window cannot be fitted".to_owned(), ..found };
    };
    // The t interval takes the residuals as scatter. Where the local order still drifts they are not, and what is left
    // of the drift is about the distance of the slope from the finest local order.
    let drift = found.local[last - 1].map_or(f64::INFINITY, |p| (line.slope - p).abs());
    let half_width = line.half_width() + drift;
    let interval = [line.slope - half_width, line.slope + half_width];
    let (verdict, why) = match contradicted {
        true if kinds[last + 1..].contains(&Kind::Failed) => (Verdict::Failed, "; but a finer run failed"),
        true => (Verdict::NotAsymptotic, "; but finer samples above the floor do not follow it"),
        false => (verdict::of_slope(line.slope, interval, &expected), ""),
    };
    let constant = match expected {
        Expected::Order { order, .. } if verdict == Verdict::AsExpected => {
            Some((points.iter().map(|(x, y)| y - order * x).sum::<f64>() / points.len() as f64).exp())
        }
        _ => None,
    };
    let fitted = Order {
        slope: Some(line.slope),
        interval: Some(interval),
        window: Some((first, last)),
        constant,
        verdict,
        ..found
    };
    Order { note: verdict::note(&fitted, &expected, why), ..fitted }
}

#[cfg(test)]
mod tests;
