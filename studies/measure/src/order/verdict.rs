//! The possible answers to "is this the order that theory promises?".

use super::window::Kind;
use super::{Expected, Order};
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

/// The verdict where no window was found: what took the points away.
pub(super) fn without_window(kinds: &[Kind]) -> (Verdict, String) {
    let count = |k: Kind| kinds.iter().filter(|x| **x == k).count();
    let (usable, floor, failed) = (count(Kind::Usable), count(Kind::AtFloor), count(Kind::Failed));
    let saturated = count(Kind::Saturated);
    let verdict = match usable {
        3.. => Verdict::NotAsymptotic,
        _ if floor > 0 && usable + floor >= 3 => Verdict::AtTheFloor,
        _ if failed > 0 => Verdict::Failed,
        _ => Verdict::NotAsymptotic,
    };
    let counts = format!("{usable} usable, {floor} at the floor, {saturated} saturated, {failed} failed");
    let remedy = match verdict {
        Verdict::AtTheFloor => "take coarser steps or a wider arithmetic",
        Verdict::Failed => "take finer steps",
        _ => "no three neighbours have a stable local order",
    };
    (verdict, format!("{counts}: {remedy}"))
}

/// The verdict on a window that no finer point contradicts. An order that is not known to better than half an order,
/// or whose deviation is smaller than its uncertainty, is no order yet.
pub(super) fn of_slope(slope: f64, interval: [f64; 2], expected: &Expected) -> Verdict {
    let (order, tolerance) = match *expected {
        Expected::Order { order, tolerance } => (order, tolerance),
        Expected::Exact => (f64::INFINITY, 0.0),
    };
    let resolved = interval[1] - interval[0] < 1.0;
    if !resolved {
        Verdict::NotAsymptotic
    } else if (slope - order).abs() <= tolerance {
        Verdict::AsExpected
    } else if interval[0] > order {
        Verdict::SuperConvergent
    } else if interval[1] < order {
        Verdict::Capped
    } else {
        Verdict::NotAsymptotic
    }
}

/// The verdict of an order with a window in words.
pub(super) fn note(order: &Order, expected: &Expected, why: &str) -> String {
    let (Some(slope), Some([low, high]), Some((first, last))) = (order.slope, order.interval, order.window) else {
        return why.to_owned();
    };
    let promise = match expected {
        Expected::Order { order, tolerance } => format!("{order} +- {tolerance}"),
        Expected::Exact => "exact".to_owned(),
    };
    format!("slope {slope:.3} in [{low:.3}, {high:.3}] over samples {first}..={last}, expected {promise}{why}")
}
