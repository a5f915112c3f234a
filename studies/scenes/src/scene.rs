//! What a scene states about itself, in no particular arithmetic.

use std::any::Any;

use faer::fx128;
use integrator::methods::MethodId;

use crate::error::Error;
use crate::invariants::{Balance, Entry};
use crate::observation::{Observation, Quantity};
use crate::parameters::Parameters;
use crate::theory::{ExpectedGrowth, StabilityLimit, Theory};

/// What a reader should know of a scene before looking at its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Info {
    /// One line: what moves, and why it is looked at.
    pub about: &'static str,
    /// The equation of motion, in LaTeX.
    pub equation: &'static str,
    /// Where the exact motion comes from.
    pub source: &'static str,
    /// End of an error run, s: dyadic, and neither a period nor half of one.
    pub horizon_s: f64,
    /// Natural time scale, s: 1/omega, 1/k, ...
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
    fn account(&self, t: fx128, seen: &Observation) -> Vec<Entry>;

    /// Times up to the horizon at which the exact motion is not smooth: bounces, kinks of the force.
    fn breaks_s(&self) -> Vec<f64> {
        Vec::new()
    }

    /// What theory says of a method's error in a quantity at the horizon.
    fn theory(&self, method: MethodId, quantity: Quantity) -> Theory {
        let _ = quantity;
        Theory::usual(method)
    }

    /// What theory says of the error of a balance over a long run with the step `h_s`, where it says anything.
    fn growth(&self, method: MethodId, balance: Balance, h_s: f64) -> Option<ExpectedGrowth> {
        let _ = (method, balance, h_s);
        None
    }

    /// The largest stable step of a method and where the formula comes from, where theory says anything.
    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        let _ = method;
        None
    }
}
