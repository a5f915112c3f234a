//! The kinds of failure, told apart by what a run shows.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::growth;

/// What goes wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Failure {
    /// Nothing.
    #[default]
    None,
    /// Every step multiplies the error by the same factor above one.
    ExponentialGrowth,
    /// The growth feeds on itself: infinity is reached at a finite time.
    FiniteTimeBlowUp,
    /// Bounded, but too fast or too slow.
    WrongFrequency,
    /// Bounded, but the axis points the other way.
    FlippedAxis,
    /// Bounded, but fewer than two steps fall into a period: the fast motion is seen as a slow one or as none.
    Aliasing,
    /// Decays, but from one side to the other, where the exact motion keeps to one side.
    OscillatingDecay,
    /// The equations of an implicit step are not solved.
    NewtonNotConverging,
    /// The error falls more slowly with the step than the method promises.
    OrderLost,
    /// A steady loss or gain of what should be kept.
    Drift,
}

impl Failure {
    /// Every kind.
    pub const ALL: [Failure; 10] = [
        Failure::None,
        Failure::ExponentialGrowth,
        Failure::FiniteTimeBlowUp,
        Failure::WrongFrequency,
        Failure::FlippedAxis,
        Failure::Aliasing,
        Failure::OscillatingDecay,
        Failure::NewtonNotConverging,
        Failure::OrderLost,
        Failure::Drift,
    ];

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Failure::None => "no failure",
            Failure::ExponentialGrowth => "exponential growth",
            Failure::FiniteTimeBlowUp => "blow-up in finite time",
            Failure::WrongFrequency => "bounded, wrong frequency",
            Failure::FlippedAxis => "bounded, flipped axis",
            Failure::Aliasing => "bounded, aliased",
            Failure::OscillatingDecay => "decay that oscillates",
            Failure::NewtonNotConverging => "Newton's iteration does not converge",
            Failure::OrderLost => "order lost",
            Failure::Drift => "drift",
        }
    }

    /// The kind of a growth, from sizes at every step up to the end of the finite numbers (the last may be infinite).
    ///
    /// The steps in which the size goes from s to s^2 are compared with those from s^2 to s^4, s = 1e8 times the start:
    /// exponential growth needs twice as many, a growth that feeds on itself (x' ~ x^p, p > 1) as many or fewer.
    pub fn of_growth(sizes: &[(u64, f64)]) -> Failure {
        let Some(start) = sizes.iter().map(|(_, s)| *s).find(|s| *s > 0.0) else { return Failure::None };
        let reached = |factor: f64| sizes.iter().find(|(_, s)| !(*s < start * factor)).map(|(step, _)| *step as f64);
        let (Some(first), Some(second)) = (reached(1e8), reached(1e16)) else {
            // Too slow to tell within the run, hence not a blow-up.
            return Failure::ExponentialGrowth;
        };
        let Some(third) = reached(1e32) else { return Failure::ExponentialGrowth };
        if third - second >= 1.5 * (second - first) { Failure::ExponentialGrowth } else { Failure::FiniteTimeBlowUp }
    }

    /// The kind of failure of a scalar that should follow another. Both are centred on what they oscillate about or decay to.
    pub fn of_signal(signal: &Signal<'_>) -> Failure {
        let Signal { numeric, exact, turn_per_step, unsolved } = *signal;
        let size = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let reached = numeric.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if unsolved && reached <= GROWN * size {
            return Failure::NewtonNotConverging;
        }
        // NaN counts as grown.
        if !(reached <= GROWN * size) || numeric.len() < exact.len() || numeric.iter().any(|x| !x.is_finite()) {
            return Failure::of_growth(&running_maximum(numeric));
        }
        let (turns, exact_turns) = (sign_changes(numeric), sign_changes(exact));
        if exact_turns == 0 {
            return if turns >= 3 { Failure::OscillatingDecay } else { Failure::None };
        }
        if turn_per_step > std::f64::consts::PI {
            return Failure::Aliasing;
        }
        if (turns as f64 / exact_turns as f64 - 1.0).abs() > WRONG { Failure::WrongFrequency } else { Failure::None }
    }

    /// The kind of failure of an axis that should keep its direction, from the cosine of the angle between the two.
    pub fn of_axis(cosines: &[f64]) -> Failure {
        if cosines.iter().any(|c| !c.is_finite()) {
            return Failure::FiniteTimeBlowUp;
        }
        if cosines.iter().any(|c| *c < 0.0) { Failure::FlippedAxis } else { Failure::None }
    }

    /// The kind of failure of a quantity that should be kept, from (time, relative error).
    pub fn of_invariant(errors: &[(f64, f64)]) -> Failure {
        let envelope = growth::running_maximum(errors.iter().copied());
        let Some(end) = envelope.last() else { return Failure::None };
        if !end.error.is_finite() {
            return Failure::FiniteTimeBlowUp;
        }
        // A bounded error has a ratio of 1 between the times T and T / 10, a steady loss one of 10.
        let ratio = growth::drift_ratio(&envelope, 0.1 * end.t_s);
        if ratio.is_some_and(|ratio| ratio > 3.0) { Failure::Drift } else { Failure::None }
    }

    /// The kind of failure of a convergence: observed order against the promised one.
    pub fn of_order(observed: f64, promised: f64) -> Failure {
        if observed < promised - 0.5 { Failure::OrderLost } else { Failure::None }
    }
}

/// A bounded numerical signal does not exceed the exact one by this factor.
const GROWN: f64 = 10.0;
/// A frequency is wrong that differs by more than this part.
const WRONG: f64 = 0.1;

/// A scalar along a run, and what it should be.
#[derive(Clone, Copy, Debug)]
pub struct Signal<'a> {
    /// After every step, up to the end or to the step that failed.
    pub numeric: &'a [f64],
    /// The same of the exact motion, at every step planned.
    pub exact: &'a [f64],
    /// Phase of the fastest exact motion in one step, rad; above pi no sampling can follow it.
    pub turn_per_step: f64,
    /// Whether the run ended because the equations of a step were not solved.
    pub unsolved: bool,
}

/// The largest size so far, after every step: an oscillating signal passes through zero on its way up.
fn running_maximum(signal: &[f64]) -> Vec<(u64, f64)> {
    let mut largest = 0.0_f64;
    let grown = signal.iter().map(|x| {
        largest = if x.is_finite() { largest.max(x.abs()) } else { f64::INFINITY };
        largest
    });
    (0..).zip(grown.collect::<Vec<_>>().into_iter().chain([f64::INFINITY])).collect()
}

fn sign_changes(signal: &[f64]) -> usize {
    signal.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count()
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.words())
    }
}
