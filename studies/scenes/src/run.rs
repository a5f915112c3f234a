//! One trajectory: a scene, a method, a precision and a number of steps.

use faer::fx128;
use integrator::counted::Counted;
use integrator::methods::{MethodId, RigidVisitor, Visitor};
use integrator::pose::{Body, Exponential, Fixed, Linear, World};
use integrator::rigid_body::{
    AttitudeUpdate, BodyOmega, Formulation, Kinematics, RigidBody, RigidModel, WithoutGyroscopicTerm, WorldMomentum,
    WorldOmega,
};
use integrator::{Method, Model, Single, Space, State, Vector, drive};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::motion::Motion;
use crate::observation::Observation;
use crate::scheme::{Rule, Scheme};

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

/// Times at which a run is compared with the exact motion, evenly spaced; also the end.
pub const CHECKPOINTS: u64 = 32;

/// What to run on a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// How to step.
    pub scheme: Scheme,
    /// The arithmetic.
    pub precision: Precision,
    /// End of the run, s.
    pub end_s: f64,
    /// Number of steps, at least 1; h = end_s / steps.
    pub steps: u64,
}

impl Run {
    /// A run by a method, by a step for rigid bodies, or by a whole scheme.
    pub fn new(scheme: impl Into<Scheme>, precision: Precision, end_s: f64, steps: u64) -> Self {
        Run { scheme: scheme.into(), precision, end_s, steps }
    }

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

/// The motion on a flat space of which only the space is known.
pub type AnyFlat<'a, T, Q> = &'a (dyn Motion<T, Config = Q> + 'a);

/// A body of which only the kind of its position is known.
pub type AnyBody<'a, T, P> = &'a (dyn RigidBody<T, Position = P> + 'a);

/// Runs a motion on a flat space; `None` for a step that exists for rigid bodies only.
///
/// The motion is behind a pointer, one virtual call per evaluation: compiled for each scene, runs that nobody times were
/// three quarters of the build. Timed runs are compiled for each scene, see [`timed`](crate::timed).
pub(crate) fn run_flat<T: Single, Q: Space<Scalar = T>>(
    motion: AnyFlat<'_, T, Q>,
    run: &Run,
    shown: Shown<'_>,
) -> Option<Trajectory> {
    let Rule::General(method) = run.scheme.rule else { return None };
    let counted = Counted::new(motion);
    let samples = method.visit(FlatRun { model: &counted, motion, run, shown });
    Some(samples.trajectory(method.is_implicit(), counted.evaluations()))
}

struct FlatRun<'a, T: Single, Q: Space<Scalar = T>> {
    model: &'a Counted<AnyFlat<'a, T, Q>>,
    motion: AnyFlat<'a, T, Q>,
    run: &'a Run,
    shown: Shown<'a>,
}

impl<'a, T: Single, Q: Space<Scalar = T>> Visitor<T, Counted<AnyFlat<'a, T, Q>>> for FlatRun<'a, T, Q> {
    type Output = Samples;

    fn visit<A: Method<T, Counted<AnyFlat<'a, T, Q>>>>(self, method: &A) -> Samples {
        let start = self.motion.exact(T::lit(0.0));
        self.shown.drive(self.run, method, self.model, start, |s| self.motion.observe(s))
    }
}

/// Where a rigid body may be, in the arithmetic `T`: [`Fixed`] or a [`Vector3`].
pub trait Place<T: Single>: Vector<T> {
    /// Runs a body of which only the kind of its position is known.
    fn run(body: AnyBody<'_, T, Self>, start: Kinematics<T, Self>, run: &Run, stride: u64) -> Trajectory {
        Self::show(body, start, run, Shown::Every(stride))
    }

    /// The same, showing of it what is asked for.
    fn show(body: AnyBody<'_, T, Self>, start: Kinematics<T, Self>, run: &Run, shown: Shown<'_>) -> Trajectory;
}

// Not generic, so that it is compiled once and not in every crate that runs a body.
macro_rules! place {
    ($($t:ty),*) => {$(
        impl Place<$t> for Fixed<$t> {
            fn show(body: AnyBody<'_, $t, Self>, start: Kinematics<$t, Self>, run: &Run, shown: Shown<'_>) -> Trajectory {
                run_body(body, start, run, shown)
            }
        }
        impl Place<$t> for Vector3<$t> {
            fn show(body: AnyBody<'_, $t, Self>, start: Kinematics<$t, Self>, run: &Run, shown: Shown<'_>) -> Trajectory {
                run_body(body, start, run, shown)
            }
        }
    )*};
}
place!(f32, f64, fx128);

fn run_body<T: Single, P: Vector<T>>(
    body: AnyBody<'_, T, P>,
    start: Kinematics<T, P>,
    run: &Run,
    shown: Shown<'_>,
) -> Trajectory {
    let counted = Counted::new(body);
    let Scheme { rule, storage, update } = run.scheme;
    let method = match rule {
        Rule::General(method) => method,
        Rule::Rigid(step) => {
            let samples = step.visit::<T, _, _>(update, &counted, RigidStepRun { start, run, shown });
            return samples.trajectory(false, counted.evaluations());
        }
    };
    macro_rules! with {
        ($model:ident, $update:ident<$frame:ident>) => {{
            let model = $model::<_, $update<$frame>>::new(&counted);
            method.visit(RigidRun { model: &model, start, run, shown })
        }};
    }
    use AttitudeUpdate as U;
    let samples = match (storage, update) {
        (Formulation::WorldOmega, U::Exponential) => with!(WorldOmega, Exponential<World>),
        (Formulation::WorldOmega, U::Linear) => with!(WorldOmega, Linear<World>),
        (Formulation::BodyOmega, U::Exponential) => with!(BodyOmega, Exponential<Body>),
        (Formulation::BodyOmega, U::Linear) => with!(BodyOmega, Linear<Body>),
        (Formulation::WorldMomentum, U::Exponential) => with!(WorldMomentum, Exponential<World>),
        (Formulation::WorldMomentum, U::Linear) => with!(WorldMomentum, Linear<World>),
        (Formulation::WithoutGyroscopicTerm, U::Exponential) => with!(WithoutGyroscopicTerm, Exponential<World>),
        (Formulation::WithoutGyroscopicTerm, U::Linear) => with!(WithoutGyroscopicTerm, Linear<World>),
    };
    samples.trajectory(method.is_implicit(), counted.evaluations())
}

/// A rigid body in what its model stores, with a general method.
struct RigidRun<'a, T: Single, M: RigidModel<T>> {
    model: &'a M,
    start: Kinematics<T, <M::Body as RigidBody<T>>::Position>,
    run: &'a Run,
    shown: Shown<'a>,
}

impl<T: Single, M: RigidModel<T>> Visitor<T, M> for RigidRun<'_, T, M> {
    type Output = Samples;

    fn visit<A: Method<T, M>>(self, method: &A) -> Samples {
        let start = self.model.state(&self.start);
        self.shown.drive(self.run, method, self.model, start, |s| Observation::of_body(self.model, s))
    }
}

/// A rigid body whose model the step chooses.
struct RigidStepRun<'a, T: Single, P> {
    start: Kinematics<T, P>,
    run: &'a Run,
    shown: Shown<'a>,
}

impl<T: Single, B: RigidBody<T>> RigidVisitor<T, B> for RigidStepRun<'_, T, B::Position> {
    type Output = Samples;

    fn visit<M: RigidModel<T, Body = B>, A: Method<T, M>>(self, method: &A, model: &M) -> Samples {
        let start = model.state(&self.start);
        self.shown.drive(self.run, method, model, start, |s| Observation::of_body(model, s))
    }
}

/// What is seen of a run.
#[derive(Clone, Copy)]
pub enum Shown<'a> {
    /// Samples are kept: every multiple of so many steps, and the end.
    Every(u64),
    /// Every step is shown to this, with its number, and none is kept: for maxima over runs that are too long to be kept.
    To(&'a dyn Fn(u64, Observation)),
}

impl Shown<'_> {
    fn drive<T: Single, M: Model<T>, A: Method<T, M>>(
        self,
        run: &Run,
        method: &A,
        model: &M,
        start: State<M::Config>,
        observe: impl Fn(&State<M::Config>) -> Observation,
    ) -> Samples {
        match self {
            Shown::Every(stride) => Schedule::of(run, stride).drive(method, model, start, observe),
            Shown::To(watch) => {
                let h = T::lit(run.end_s) / T::lit(run.steps as f64);
                let result = drive::integrate(method, model, start, h, run.steps, |i, s| watch(i, observe(s)));
                Samples { seen: Vec::new(), failed_step: result.err().map(|failure| failure.step) }
            }
        }
    }
}

/// When to step, and when to look.
#[derive(Clone, Copy)]
pub struct Schedule {
    /// End of the run, s.
    pub end_s: f64,
    /// Number of steps.
    pub steps: u64,
    /// Steps between two samples.
    pub stride: u64,
}

/// What was seen until the end, or until the step that failed.
pub struct Samples {
    /// Step number and what was observed there.
    pub seen: Vec<(u64, Observation)>,
    /// The step that failed, counted from 1.
    pub failed_step: Option<u64>,
}

impl Schedule {
    /// The schedule of a run.
    pub fn of(run: &Run, stride: u64) -> Self {
        Schedule { end_s: run.end_s, steps: run.steps, stride }
    }

    /// Drives a method on a model and looks when it is time to.
    pub fn drive<T: Single, M: Model<T>, A: Method<T, M>>(
        self,
        method: &A,
        model: &M,
        start: State<M::Config>,
        observe: impl Fn(&State<M::Config>) -> Observation,
    ) -> Samples {
        let h = T::lit(self.end_s) / T::lit(self.steps as f64);
        let mut seen = Vec::new();
        let result = drive::integrate(method, model, start, h, self.steps, |i, s| {
            if i % self.stride == 0 || i == self.steps {
                seen.push((i, observe(s)));
            }
        });
        Samples { seen, failed_step: result.err().map(|failure| failure.step) }
    }
}

impl Samples {
    /// With its outcome and the evaluations it took.
    pub fn trajectory(self, implicit: bool, evaluations: u64) -> Trajectory {
        let outcome = match self.failed_step {
            None => Outcome::Finished,
            Some(_) if implicit => Outcome::NotConverged,
            Some(_) => Outcome::Diverged,
        };
        Trajectory { outcome, failed_step: self.failed_step, seen: self.seen, evaluations }
    }
}
