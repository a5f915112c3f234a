//! One line of `orders.csv`: what one sweep shows.

use serde::{Deserialize, Serialize};

use crate::order::{Sample, Verdict, local_order};
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
    /// lim error / h^theory_order, extrapolated to h = 0.
    pub constant: Option<f64>,
    /// A bound on what the extrapolation leaves.
    pub constant_change: Option<f64>,
    /// The largest error / h^theory_order of the sweep.
    pub coarse_constant: f64,
    /// The same of the finest run that is clear of rounding.
    pub fine_constant: f64,
    /// What theory predicts for the limit.
    pub theory_constant: Option<f64>,
    /// How far that may be off.
    pub theory_doubt: f64,
    /// The limit by the equation of first variation.
    pub leading: Option<f64>,
    /// How far that may be off.
    pub leading_doubt: Option<f64>,
    /// The order over the finest four runs above rounding.
    pub finest_order: Option<f64>,
    /// Whether every error is rounding.
    pub is_rounding: bool,
    /// Whether even the finest step is too long for the errors of a correct method to be small: phi (h / time scale)^p, where phi is
    /// the length of the run in time scales, is above 0.03.
    pub is_coarse: bool,
    /// Whether the order between neighbours is too high and too low by turns: of errors of several motions, or methods.
    pub is_erratic: bool,
    /// The longest step of the finest runs that failed, s.
    pub coarsest_failure_h_s: Option<f64>,
    /// Natural time scale of the scene, s.
    pub time_scale_s: f64,
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

impl OrderRow {
    /// The limit of error / h^p by theory and how far it may be off: the scene's own constant, or that of the equation of first variation,
    /// whichever is known better.
    pub(super) fn theory_limit(&self) -> Option<(f64, f64)> {
        let own = self.theory_constant.map(|constant| (constant, self.theory_doubt));
        let varied = self.leading.zip(self.leading_doubt);
        own.into_iter().chain(varied).min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// The order over the finest four runs whose errors are clear of rounding.
pub(super) fn finest_order(samples: &[Sample], rounding: impl Fn(&Sample) -> f64) -> Option<f64> {
    let is_clear = |s: &&Sample| s.error.is_some_and(|e| e.is_finite() && e > rounding(s));
    let clear: Vec<&Sample> = samples.iter().filter(is_clear).collect();
    let (fine, coarse) = (clear.last()?, clear.get(clear.len().checked_sub(4)?)?);
    local_order((coarse.h_s, coarse.error?), (fine.h_s, fine.error?))
}
