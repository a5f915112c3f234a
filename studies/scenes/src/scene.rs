//! What a scene states about itself, in no particular arithmetic.

use std::any::Any;

use faer::fx128;
use integrator::methods::MethodId;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::observation::{Observation, Quantity};
use crate::parameters::{Parameters, Substitute};
use crate::theory::{ExpectedGrowth, StabilityLimit, Theory};

/// What kind of motion a scene is, for a reader who looks for the one that is most like his own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The force is the same everywhere and always.
    ConstantForce,
    /// A free flight between impacts.
    Bounces,
    /// A restoring force, with or without a periodic drive.
    Oscillation,
    /// A resistance takes the energy away.
    Damping,
    /// A path that closes, in a central field or a magnetic one.
    Orbit,
    /// A rigid body without a torque.
    FreeBody,
    /// A rigid body under a torque.
    DrivenBody,
}

impl Kind {
    /// All of them, in the order in which they are shown.
    pub const ALL: [Kind; 7] = [
        Kind::ConstantForce,
        Kind::Bounces,
        Kind::Oscillation,
        Kind::Damping,
        Kind::Orbit,
        Kind::FreeBody,
        Kind::DrivenBody,
    ];

    /// The kind in a few words.
    pub fn title(self) -> &'static str {
        match self {
            Kind::ConstantForce => "Constant force",
            Kind::Bounces => "Bounces",
            Kind::Oscillation => "Oscillation",
            Kind::Damping => "Damping",
            Kind::Orbit => "Orbit",
            Kind::FreeBody => "Free rigid body",
            Kind::DrivenBody => "Rigid body with torque",
        }
    }
}

/// What a reader should know of a scene before looking at its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Info {
    /// What kind of motion it is.
    pub kind: Kind,
    /// One line: what moves, and why it is looked at.
    pub about: &'static str,
    /// The equation of motion, in LaTeX.
    pub equation: &'static str,
    /// Where the exact motion comes from.
    pub source: &'static str,
    /// End of an error run, s: dyadic, and neither a period nor half of one.
    pub horizon_s: f64,
    /// Natural time scale, s, positive and finite: 1/omega, 1/k, ...
    pub time_scale_s: f64,
    /// Steps of the coarsest run of a sweep, a power of two.
    pub coarsest_steps: u64,
}

/// What every scene states about itself, in no particular arithmetic.
pub trait Scene: Parameters + Any + Send + Sync {
    /// Horizon, time scale, source.
    fn info(&self) -> Info;

    /// Whether the parameters fit together.
    ///
    /// # Errors
    /// What does not, naming the parameter, its value and what is allowed.
    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    /// Energy and momenta of an observed state.
    fn invariants(&self, t: fx128, seen: &Observation) -> Vec<Entry>;

    /// Times up to `end_s` at which the exact motion is not smooth: bounces, kinks of the force.
    fn nonsmooth_times_s(&self, end_s: f64) -> Vec<f64> {
        let _ = end_s;
        Vec::new()
    }

    /// Up to when the exact motion is known, s.
    fn ends_s(&self) -> f64 {
        f64::INFINITY
    }

    /// The time after which the motion, or the state of what turns, is the same again, s: an oscillation, an orbit, a bounce, the
    /// force's period; of a free body one revolution at the rate of the start.
    fn period_s(&self) -> Option<f64> {
        None
    }

    /// Parameters that may be given in the place of one of its own.
    fn substitutes(&self) -> Vec<Substitute> {
        Vec::new()
    }

    /// Whether the motion goes round or to and fro, with 2 pi times the time scale as its period.
    fn is_periodic(&self) -> bool {
        true
    }

    /// Whether rounding errors add up as independent ones do, relative to the size of a coordinate: not where the motion
    /// forgets them, where an event multiplies them, nor where a coordinate grows all the time.
    fn rounding_accumulates(&self) -> bool {
        true
    }

    /// Whether a rigid body turns about one principal axis with a constant angular acceleration: the angle is a quadratic polynomial
    /// of t, for which every method of order 2 has no error but rounding.
    fn has_constant_angular_acceleration(&self) -> bool {
        false
    }

    /// By what factor the motion multiplies a rounding until `end_s`, where it is a steady one that is not stable.
    fn amplification(&self, end_s: f64) -> f64 {
        let _ = end_s;
        1.0
    }

    /// What theory says of a method's error in a quantity at the time `end_s`.
    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        let _ = (quantity, end_s);
        Theory::usual(method)
    }

    /// What theory says of the error of an invariant over a long run with the step `h_s`, where it says anything.
    fn growth(&self, method: MethodId, invariant: Invariant, h_s: f64) -> Option<ExpectedGrowth> {
        let _ = (method, invariant, h_s);
        None
    }

    /// The largest stable step of a method and where the formula comes from, where theory says anything.
    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        let _ = method;
        None
    }
}

/// What is known beforehand of a method: the scene's theory where it was worked out for the method, else nothing.
impl dyn Scene + '_ {
    /// The error in a quantity at the time `end_s`. The order of a method without theory is a least one.
    pub fn expected_error(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        if method.facts().worked_out {
            self.theory(method, quantity, end_s)
        } else {
            Theory::least(method, self.nonsmooth_times_s(end_s).is_empty())
        }
    }

    /// The growth of the error of an invariant over a long run with the step `h_s`.
    pub fn expected_growth(&self, method: MethodId, invariant: Invariant, h_s: f64) -> Option<ExpectedGrowth> {
        method.facts().worked_out.then(|| self.growth(method, invariant, h_s))?
    }

    /// The largest stable step, and where the formula comes from.
    pub fn expected_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        method.facts().worked_out.then(|| self.stability_limit(method))?
    }
}

/// How long a motion is followed, and how finely at first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// End of an error run, s.
    pub horizon_s: f64,
    /// Steps of the coarsest run of a sweep.
    pub coarsest_steps: u64,
}

/// A motion is followed for at most this many times as much of itself as the default one, and for at least that part of it.
const LONGEST: f64 = 8.0;
const SHORTEST: f64 = 1.0 / 128.0;
/// The coarsest step may be this many times as long, in the motion's own time, as that of the default.
const COARSEST: f64 = 5.0;

impl Pace {
    /// The same for a motion that is `faster` times as fast. The horizon changes by powers of two, and only where the motion
    /// would be over, or would not have begun: it stays dyadic, and is that of the default wherever it can be.
    #[must_use]
    pub fn at(self, faster: f64) -> Self {
        if !(faster > 0.0 && faster.is_finite()) {
            return self;
        }
        let halvings = (faster / LONGEST).log2().ceil().max(0.0) + (faster / SHORTEST).log2().floor().min(0.0);
        let left = faster / halvings.exp2();
        Pace {
            horizon_s: self.horizon_s / halvings.exp2(),
            coarsest_steps: self.coarsest_steps << (left / COARSEST).log2().ceil().max(0.0) as u32,
        }
    }
}

/// The period of a motion with this rate, s; none of one that does nothing.
pub(crate) fn period(rate: f64) -> Option<f64> {
    Some(std::f64::consts::TAU / rate).filter(|s| *s > 0.0 && s.is_finite())
}

/// The time scale of a motion with this rate, s; 1 s for one that does nothing.
pub(crate) fn time_scale(rate: f64) -> f64 {
    let scale_s = 1.0 / rate;
    if scale_s > 0.0 && scale_s.is_finite() { scale_s } else { 1.0 }
}
