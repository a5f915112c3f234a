//! The observed order of convergence: which steps show it, what it is, how well it is known, and whether it is the
//! order that theory promises.
//!
//! Theory says `error = C h^p (1 + c h + ...)` for small h. Coarse steps show the bracket, fine steps show rounding,
//! and only a window between them shows p. The window is found from the local orders
//! `p_i = ln(e_i / e_(i+1)) / ln(h_i / h_(i+1))` alone; the expected order takes no part in the search.

mod verdict;
mod window;

use serde::{Deserialize, Serialize};
pub use verdict::Verdict;

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
