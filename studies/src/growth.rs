//! The law by which the error of an invariant grows in a long run.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The error of an invariant over a long run: the maximum up to, or in a bin that ends at, a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Envelope {
    /// Time, positive and increasing from sample to sample.
    pub t_s: f64,
    /// Largest |error| in the unit of the invariant (or relative).
    pub error: f64,
}

/// How the error grows with time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// It does not.
    Bounded,
    /// As sqrt(t), the random walk of rounding errors.
    SqrtT,
    /// As t.
    Linear,
    /// As t^2.
    Quadratic,
    /// As exp(r t).
    Exponential,
    /// It never leaves the noise floor.
    AtTheFloor,
    /// No law fits, or two fit equally well.
    Unclassified,
    /// It stops being finite.
    Diverged,
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bounded => "bounded",
            Self::SqrtT => "sqrt-t",
            Self::Linear => "linear",
            Self::Quadratic => "quadratic",
            Self::Exponential => "exponential",
            Self::AtTheFloor => "at-the-floor",
            Self::Unclassified => "unclassified",
            Self::Diverged => "diverged",
        })
    }
}

/// The growth law and its evidence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    /// The law the data show.
    pub law: Law,
    /// p of `error ~ t^p` over the fitted stretch; None where nothing was fitted.
    pub exponent: Option<f64>,
    /// r of `error ~ exp(r t)` in 1/s over the fitted stretch; None where nothing was fitted.
    pub rate: Option<f64>,
    /// 95 % interval of the rate for the exponential law, of the exponent otherwise.
    pub interval: Option<[f64; 2]>,
    /// rms of ln error about the power law divided by that about the exponential: below 1 the power law fits better.
    pub misfit_ratio: Option<f64>,
    /// `error(T) / error(T/10)` at the end T of the run.
    pub decade_ratio: Option<f64>,
    /// The law that fits next best, if it is not excluded.
    pub alternative: Option<Law>,
    /// The numbers behind the law, in words.
    pub evidence: String,
}
