//! The law by which the error of an invariant grows in a long run.
//!
//! Power laws are straight lines of ln error over ln t, exponential growth is one of ln error over t; which is
//! straighter over the end of the run decides. Growth as exp(r t) - 1 with r t well below 1 *is* linear as far as these
//! data go and is reported so; where theory names the rate, `fit_exponential_rate` measures it at any r t.

use crate::fit;
use crate::fit::Line;
use scenes::theory::Law;
use serde::{Deserialize, Serialize};

/// The error of an invariant over a long run: the maximum up to, or in a bin that ends at, a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Envelope {
    /// Time, positive and increasing from sample to sample.
    pub t_s: f64,
    /// Largest |error| in the unit of the invariant (or relative).
    pub error: f64,
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

/// Errors up to this multiple of the noise floor are taken as noise: it then shifts ln error by at most ln(1 + 1/8).
const ABOVE_FLOOR: f64 = 8.0;

/// Fewest samples of a stretch from which a law is read: four in each half, so that each half has a fit of its own.
const FEWEST: usize = 8;

/// Most samples of a stretch, so that the samples of a uniform grid do not all lie at its end.
const BINS: usize = 32;

/// By how much one fit must be better than the other. For t^p over a decade the exponential misses ln error by
/// 0.25 p rms, so that scatter of up to 0.2 p leaves the power law ahead by this factor.
const CLEARLY: f64 = 1.5;

/// The running maximum of (time, error), which turns an oscillating error into its envelope. NaN stays NaN.
pub fn running_maximum(errors: impl IntoIterator<Item = (f64, f64)>) -> Vec<Envelope> {
    let mut worst = 0.0_f64;
    let running = |(t_s, e): (f64, f64)| {
        worst = if e.is_nan() || worst.is_nan() { f64::NAN } else { worst.max(e.abs()) };
        Envelope { t_s, error: worst }
    };
    errors.into_iter().map(running).collect()
}

/// `error(10 t) / error(t)`, of the largest errors up to these times: 1 if bounded, 10 if linear, 100 if quadratic.
///
/// None if the samples do not reach 10 t (to a rounding of t), none lies before t, or the error up to t is zero or not finite.
pub fn drift_ratio(envelope: &[Envelope], t_s: f64) -> Option<f64> {
    let slack = 1.0 + 4.0 * f64::EPSILON;
    let up_to =
        |t: f64| running_maximum(envelope.iter().filter(|s| s.t_s <= t * slack).map(|s| (s.t_s, s.error))).pop();
    let reached = envelope.last().is_some_and(|s| s.t_s * slack >= 10.0 * t_s);
    let ratio = up_to(10.0 * t_s)?.error / up_to(t_s)?.error;
    (reached && ratio.is_finite()).then_some(ratio)
}

/// The rate r in 1/s of `E / E_0 = exp(r t)` from samples of (t, E / E_0 - 1): the slope of ln(1 + error) over t.
///
/// It has no lower limit in r t, where `classify` cannot tell exp(r t) - 1 from r t. None for fewer than three samples,
/// or where E / E_0 is not positive and finite.
pub fn fit_exponential_rate(relative_errors: &[(f64, f64)]) -> Option<Line> {
    let points: Vec<(f64, f64)> = relative_errors.iter().map(|(t, e)| (*t, e.ln_1p())).collect();
    fit::line(&points)
}

/// The law of growth of `envelope`, judged over the last decade of time, or its last quarter where a transient is
/// still seen in the decade; `noise_floor` is the rounding error of the invariant (0 if there is none).
///
/// Exponential growth that has saturated is reported as exponential, from the stretch before. Fewer than eight samples,
/// less than a decade of time or times that do not increase from above 0 give `Unclassified`.
pub fn classify(envelope: &[Envelope], noise_floor: f64) -> Growth {
    let times_are_valid = envelope.iter().all(|s| s.t_s > 0.0 && s.t_s.is_finite());
    if !times_are_valid || envelope.windows(2).any(|w| w[0].t_s >= w[1].t_s) {
        return Growth::blank(Law::Unclassified, "times must be positive, finite and increasing".to_owned());
    }
    if let Some(bad) = envelope.iter().find(|s| !(s.error.is_finite() && s.error >= 0.0)) {
        return Growth::blank(Law::Diverged, format!("the error is {} at t = {} s", bad.error, bad.t_s));
    }
    let (Some(start), Some(end)) = (envelope.first(), envelope.last()) else {
        return Growth::blank(Law::Unclassified, "no samples".to_owned());
    };
    if envelope.len() < FEWEST || start.t_s * 10.0 > end.t_s * (1.0 + 4.0 * f64::EPSILON) {
        return Growth::blank(Law::Unclassified, "a law needs eight samples over a decade of time".to_owned());
    }
    let largest = envelope.iter().map(|s| s.error).fold(0.0, f64::max);
    if largest <= ABOVE_FLOOR * noise_floor {
        let evidence = format!("largest error {largest:.3e} within {ABOVE_FLOOR} times the floor {noise_floor:.3e}");
        return Growth::blank(Law::AtTheFloor, evidence);
    }
    let noisy = envelope.iter().rposition(|s| s.error <= ABOVE_FLOOR * noise_floor).map_or(0, |i| i + 1);
    let growth = laws::of(&envelope[noisy..], largest);
    let decade_ratio = drift_ratio(envelope, end.t_s / 10.0);
    let evidence = match decade_ratio {
        Some(ratio) => format!("error(T)/error(T/10) = {ratio:.3}; {}", growth.evidence),
        None => growth.evidence,
    };
    Growth { decade_ratio, evidence, ..growth }
}

impl Growth {
    fn blank(law: Law, evidence: String) -> Self {
        Self {
            law,
            exponent: None,
            rate: None,
            interval: None,
            misfit_ratio: None,
            decade_ratio: None,
            alternative: None,
            evidence,
        }
    }
}

mod laws;
#[cfg(test)]
mod tests;
