//! How far an advised step is from the largest stable one.

use super::candidate::{Candidate, Span};
use crate::stability::amplification;
use crate::stability::answer::{TIME_SCALES, measure_nonlinear, significant};
use crate::stability::bisect::Found;
use crate::stability::limits::number;
use crate::study::short;
use scenes::any::AnyScene;
use scenes::run::Precision;
use scenes::stepping::Stepping;

/// The largest stable step, and how it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// s; 0 where no step is stable, infinite where every one is or none was found that is not.
    pub h_s: f64,
    /// Time scales of the runs that it was measured with; `None` where it is that of the amplification matrix.
    pub measured: Option<f64>,
}

/// Looks at a run that is measured, at most: a failure stays to be seen.
const SAMPLES: u64 = 1 << 14;

/// By the amplification matrix on a linear scene, by running at least so long everywhere else.
pub fn limit(scene: &dyn AnyScene, candidate: Candidate, precision: Precision, end_s: f64) -> Limit {
    let linear = candidate
        .method()
        .filter(|_| !candidate.is_rigid)
        .and_then(|method| number(amplification::limit(&Stepping { scene, method, precision })?));
    if let Some(h_s) = linear {
        return Limit { h_s, measured: None };
    }
    let found = measure_nonlinear(scene, end_s, |end_s, steps| {
        candidate.run(scene, precision, Span { end_s, steps }, (steps / SAMPLES).max(1))
    });
    let h_s = match found {
        Found::NoStep { .. } => 0.0,
        Found::Bracket { low_s, .. } => low_s,
        Found::Unlimited { .. } => f64::INFINITY,
    };
    Limit { h_s, measured: Some(TIME_SCALES.max(end_s / scene.scene().info().time_scale_s)) }
}

impl Limit {
    /// Whether a step is stable; at the limit itself it counts as such, and a quotient of 1 + 1e-16 is 1.
    pub fn allows(self, h_s: f64) -> bool {
        h_s * (1.0 - 4.0 * f64::EPSILON) <= self.h_s
    }

    fn source(self) -> String {
        self.measured
            .map_or("amplification matrix".to_owned(), |scales| format!("measured over {scales:.0} time scales"))
    }

    /// The step as a part of the limit, in words.
    pub fn margin(self, h_s: f64) -> String {
        if self.h_s == 0.0 {
            format!("NOT STABLE: no step is, in the long run ({})", self.source())
        } else if self.h_s.is_infinite() {
            self.measured.map_or("every step is stable (amplification matrix)".to_owned(), |scales| {
                format!("no limit found in {scales:.0} time scales")
            })
        } else {
            let (part, limit) = (short(Some(h_s / self.h_s)), significant(self.h_s));
            let warning = if self.allows(h_s) { "" } else { "NOT STABLE in the long run: " };
            format!("{warning}{part} of the largest stable step, {limit} s ({})", self.source())
        }
    }

    /// The step as a part of the limit, in a table.
    pub fn part(self, h_s: f64) -> String {
        if self.h_s == 0.0 {
            "no stable step".to_owned()
        } else if self.h_s.is_infinite() {
            self.measured.map_or("no limit".to_owned(), |scales| format!("none found in {scales:.0} time scales"))
        } else {
            let part = short(Some(h_s / self.h_s));
            if self.allows(h_s) { part } else { format!("{part}, not stable") }
        }
    }
}
