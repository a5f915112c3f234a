//! The questions asked of a file, one module each.

pub mod clamps;
pub mod conservation;
pub mod dynamics;
pub mod error;
pub mod kinematics;
pub mod time;

use crate::finding::{Check, Finding, Verdict};
use crate::trajectory::Trajectory;

/// What the numbers left open, and what contradicts the names.
pub fn reading(t: &Trajectory) -> Vec<Finding> {
    let tie = |tie: &crate::trajectory::Tie| {
        let evidence = format!("{}: {}; {} decides", tie.what, tie.readings.join(" | "), tie.flag);
        Finding::new(Check::Reading, "tie", Verdict::Tie, ("readings", tie.readings.len() as f64, ""), evidence)
    };
    let mut found: Vec<Finding> = t.ties.iter().map(tie).collect();
    found.extend(kinematics::contradictions(t));
    found
}
