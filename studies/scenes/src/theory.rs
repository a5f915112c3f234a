//! What theory says beforehand: orders, error constants, growth laws, stability limits.

use std::fmt;

use integrator::methods::MethodId;
use serde::{Deserialize, Serialize};

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

/// What theory predicts for one method and quantity of a scene, beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theory {
    /// The order of convergence at the horizon.
    pub order: ExpectedOrder,
    /// lim error(T) / h^order, in the quantity's unit / s^order, where known. Zero where the leading term vanishes: the order
    /// is then one higher, or more.
    pub constant: Option<f64>,
    /// How far the constant may be off by the rounding of its formula.
    pub doubt: f64,
    /// The step below which the constant of an envelope bounds the error, or an exact result holds, s: larger steps may move an event
    /// past the end.
    pub below_h_s: f64,
    /// Where it comes from, or why it is not the method's own order.
    pub reason: &'static str,
}

/// The order that theory predicts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExpectedOrder {
    /// No error but rounding.
    Exact,
    /// error ~ h^order.
    Of(f64),
    /// error <= C h^order, and no better than that over a sweep: an event that falls anywhere in a step (a bounce, a kink of
    /// the force) makes error / h^order jump from step to step between its bounds. The constant of [`Theory`] is C.
    Envelope(f64),
}

impl Theory {
    /// The order that the method has on every smooth problem.
    pub fn usual(method: MethodId) -> Self {
        Theory {
            order: ExpectedOrder::Of(f64::from(method.order())),
            constant: None,
            doubt: 0.0,
            below_h_s: f64::INFINITY,
            reason: "the method's order on a smooth problem",
        }
    }

    /// What holds of a method that no theory was worked out for: the smallest of its orders, or a higher one; where the motion is
    /// not smooth, the first.
    pub fn least(method: MethodId, is_smooth: bool) -> Self {
        let facts = method.facts();
        let others = [facts.order_with_velocity, facts.order_on_rotations, (!is_smooth).then_some(1)];
        let least = others.into_iter().flatten().fold(facts.order, u32::min);
        Theory {
            order: ExpectedOrder::Of(f64::from(least)),
            reason: "the least order that the method states; nothing else is known",
            ..Self::usual(method)
        }
    }

    /// No error but rounding.
    pub fn exact(reason: &'static str) -> Self {
        Theory { order: ExpectedOrder::Exact, constant: None, doubt: 0.0, below_h_s: f64::INFINITY, reason }
    }

    /// The usual order with a known error constant; zero means a higher order.
    pub fn with_constant(method: MethodId, constant: f64, reason: &'static str) -> Self {
        Theory { constant: Some(constant.abs()), reason, ..Self::usual(method) }
    }

    /// The same with a constant whose formula is rounded by up to `doubt`.
    #[must_use]
    pub fn give_or_take(self, doubt: f64) -> Self {
        Theory { doubt, ..self }
    }
}

/// How theory says that the error of an invariant grows over a long run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedGrowth {
    /// The law.
    pub law: Law,
    /// The length of a run from which on the law is to be seen, s.
    pub seen_after_s: f64,
    /// For a bounded law the bounds of value / start, for an exponential one its rate in 1/s twice.
    pub bounds: Option<[f64; 2]>,
    /// Where it comes from.
    pub reason: &'static str,
}

/// The largest step with which a method does not fail on a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StabilityLimit {
    /// Every step fails, sooner or later.
    NoStep,
    /// Steps below this fail not, steps above do; s.
    Below(f64),
    /// No step fails.
    Unlimited,
}
