//! How far an advised step is from the largest stable one.

use super::candidate::{Candidate, Span};
use crate::run::Precision;
use crate::scene::AnyScene;
use crate::stability::amplification;
use crate::stability::answer::measure_nonlinear;
use crate::stability::bisect::Found;
use crate::stability::displaced::Stepping;
use crate::stability::limits::number;

/// The largest stable step, and how it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// s; 0 where no step is stable, infinite where every one is.
    pub h_s: f64,
    /// Where it comes from.
    pub source: &'static str,
}

/// By the amplification matrix on a linear scene, by running everywhere else.
pub fn limit(scene: &dyn AnyScene, candidate: Candidate, precision: Precision) -> Limit {
    let linear = candidate
        .method()
        .filter(|_| !candidate.is_rigid)
        .and_then(|method| number(amplification::limit(&Stepping { scene, method, precision })?));
    if let Some(h_s) = linear {
        return Limit { h_s, source: "amplification matrix" };
    }
    let found = measure_nonlinear(scene, |end_s, steps| candidate.run(scene, precision, Span { end_s, steps }, 1));
    let h_s = match found {
        Found::NoStep { .. } => 0.0,
        Found::Bracket { low_s, .. } => low_s,
        Found::Unlimited { .. } => f64::INFINITY,
    };
    Limit { h_s, source: "measured over 64 time scales" }
}

impl Limit {
    /// The step as a part of the limit, in words.
    pub fn margin(self, h_s: f64) -> String {
        if self.h_s == 0.0 {
            format!("no step is stable in the long run ({})", self.source)
        } else if self.h_s.is_infinite() {
            format!("every step is stable ({})", self.source)
        } else {
            format!("{:.3} of the largest stable step, {:.6} s ({})", h_s / self.h_s, self.h_s, self.source)
        }
    }

    /// The step as a part of the limit, in a table.
    pub fn part(self, h_s: f64) -> String {
        if self.h_s == 0.0 {
            "no stable step".to_owned()
        } else if self.h_s.is_infinite() {
            "no limit".to_owned()
        } else {
            format!("{:.3}", h_s / self.h_s)
        }
    }
}
