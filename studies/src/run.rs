//! One trajectory: a scene, a method, a precision and a number of steps.

use faer::fx128;
use integrator::counted::Counted;
use integrator::methods::{MethodId, Visitor};
use integrator::{Method, Single, drive};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::observation::Observation;
use crate::scene::Motion;

/// The arithmetic of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// 24 bits.
    F32,
    /// 53 bits.
    F64,
    /// 105 bits and more: no rounding to speak of.
    DoubleDouble,
}

impl Precision {
    /// Every precision.
    pub const ALL: [Precision; 3] = [Precision::F32, Precision::F64, Precision::DoubleDouble];

    /// The name on the command line and in tables.
    pub fn id(self) -> &'static str {
        match self {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
            Precision::DoubleDouble => "double-double",
        }
    }

    /// Distance from 1 to the next number.
    pub fn epsilon(self) -> f64 {
        match self {
            Precision::F32 => <f32 as Single>::EPSILON,
            Precision::F64 => <f64 as Single>::EPSILON,
            Precision::DoubleDouble => <fx128 as Single>::EPSILON,
        }
    }

    /// The precision of that name.
    ///
    /// # Errors
    /// [`Error::UnknownName`] with the list.
    pub fn from_id(id: &str) -> Result<Self, Error> {
        Self::ALL
            .into_iter()
            .find(|p| p.id() == id)
            .ok_or_else(|| Error::unknown("precision", id, Self::ALL.map(|p| p.id().to_owned())))
    }
}

/// Compiles an expression for the arithmetic of a [`Precision`] and takes the branch once.
macro_rules! in_precision {
    ($precision:expr, $t:ident => $body:expr) => {
        match $precision {
            $crate::run::Precision::F32 => {
                type $t = f32;
                $body
            }
            $crate::run::Precision::F64 => {
                type $t = f64;
                $body
            }
            $crate::run::Precision::DoubleDouble => {
                type $t = faer::fx128;
                $body
            }
        }
    };
}

/// The method of that name.
///
/// # Errors
/// [`Error::UnknownName`] with the list.
pub fn method_from_id(id: &str) -> Result<MethodId, Error> {
    let known = || MethodId::ALL.iter().map(|m| m.id().to_owned());
    MethodId::ALL.iter().copied().find(|m| m.id() == id).ok_or_else(|| Error::unknown("method", id, known()))
}

/// What to run on a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// The rule of a step.
    pub method: MethodId,
    /// The arithmetic.
    pub precision: Precision,
    /// End of the run, s.
    pub end_s: f64,
    /// Number of steps, at least 1; h = end_s / steps.
    pub steps: u64,
}

impl Run {
    /// The step, s.
    pub fn h_s(&self) -> f64 {
        self.end_s / self.steps as f64
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Every step was taken.
    Finished,
    /// A step gave a non-finite state.
    Diverged,
    /// The equations of an implicit step were not solved.
    NotConverged,
}

/// What was seen of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// How it ended.
    pub outcome: Outcome,
    /// The step at which it failed, counted from 1.
    pub failed_step: Option<u64>,
    /// Step number and what was seen there. Without a failure the last is the end of the run.
    pub seen: Vec<(u64, Observation)>,
    /// Evaluations of the force law.
    pub evaluations: u64,
}

impl Trajectory {
    /// What was seen at the end of a finished run.
    pub fn end(&self) -> Option<&Observation> {
        (self.outcome == Outcome::Finished).then(|| self.seen.last().map(|(_, seen)| seen))?
    }
}

/// Runs one model with a method chosen at run time.
pub(crate) fn run_model<T: Single, M: Motion<T>>(model: &M, run: &Run, stride: u64) -> Trajectory {
    let counted = Counted::new(model);
    run.method.visit(Watch { model: &counted, run, stride })
}

struct Watch<'a, M> {
    model: &'a Counted<&'a M>,
    run: &'a Run,
    stride: u64,
}

impl<'a, T: Single, M: Motion<T>> Visitor<T, Counted<&'a M>> for Watch<'a, M> {
    type Output = Trajectory;

    fn visit<A: Method<T, Counted<&'a M>>>(self, method: &A) -> Trajectory {
        let Run { steps, end_s, .. } = *self.run;
        let h = T::lit(end_s) / T::lit(steps as f64);
        let start = self.model.inner.exact(T::lit(0.0));
        let mut seen = Vec::new();
        let result = drive::integrate(method, self.model, start, h, steps, |i, s| {
            if i % self.stride == 0 || i == steps {
                seen.push((i, self.model.inner.observe(s)));
            }
        });
        let outcome = match result {
            Ok(_) => Outcome::Finished,
            Err(_) if self.run.method.is_implicit() => Outcome::NotConverged,
            Err(_) => Outcome::Diverged,
        };
        let failed_step = result.err().map(|failure| failure.step);
        Trajectory { outcome, failed_step, seen, evaluations: self.model.evaluations() }
    }
}
