//! The possible answers to "is this the order that theory promises?".

use serde::{Deserialize, Serialize};
use std::fmt;

/// What a step-size sweep shows. Anything but the first two is not a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The slope lies within the tolerance of the expected order, above and below.
    AsExpected,
    /// Exactness was expected, and every error is rounding.
    Exact,
    /// A stable slope above the expected order.
    SuperConvergent,
    /// A stable slope below the expected order; 0 where another error, such as that of a model, has taken over.
    Capped,
    /// No three neighbouring points have a stable local order, or finer points above the floor contradict those that do.
    NotAsymptotic,
    /// Rounding leaves fewer than three points.
    AtTheFloor,
    /// Failed runs leave fewer than three points, or a run finer than the window failed.
    Failed,
}

impl Verdict {
    /// Whether theory is confirmed.
    pub fn passes(self) -> bool {
        matches!(self, Self::AsExpected | Self::Exact)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AsExpected => "as-expected",
            Self::Exact => "exact",
            Self::SuperConvergent => "super-convergent",
            Self::Capped => "capped",
            Self::NotAsymptotic => "not-asymptotic",
            Self::AtTheFloor => "at-the-floor",
            Self::Failed => "failed",
        })
    }
}
