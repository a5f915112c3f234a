//! The largest stable step, measured on the running scene: a bracket, not a point.

use serde::{Deserialize, Serialize};

/// The width of a bracket, in parts of its upper end.
pub const WIDTH: f64 = 0.004;

/// What a search for the largest stable step found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Found {
    /// Even the smallest step tried failed; s.
    NoStep {
        /// The smallest step tried, s.
        tried_s: f64,
    },
    /// The first step held, the second failed; s.
    Bracket {
        /// The largest step that held, s.
        low_s: f64,
        /// The smallest step that failed, s.
        high_s: f64,
    },
    /// Even the largest step tried held; s.
    Unlimited {
        /// The largest step tried, s.
        tried_s: f64,
    },
}

/// Tries steps from `from_s` up, each twice the one before, until one fails or `to_s` is passed; then halves the ratio of the
/// bracket until it is narrower than `width`. Nothing of theory goes in.
pub fn bracket(from_s: f64, to_s: f64, width: f64, holds: impl Fn(f64) -> bool) -> Found {
    let mut low_s = from_s;
    if !holds(low_s) {
        return Found::NoStep { tried_s: from_s };
    }
    let mut high_s = 2.0 * low_s;
    while holds(high_s) {
        low_s = high_s;
        if low_s >= to_s {
            return Found::Unlimited { tried_s: low_s };
        }
        high_s = 2.0 * low_s;
    }
    while high_s - low_s > width * high_s {
        let middle = (low_s * high_s).sqrt();
        if holds(middle) {
            low_s = middle;
        } else {
            high_s = middle;
        }
    }
    Found::Bracket { low_s, high_s }
}
