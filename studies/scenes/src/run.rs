//! One trajectory: a scene, a method, a precision and a number of steps.

use faer::fx128;
use integrator::counted::Counted;
use integrator::methods::{MethodId, RigidStep, RigidVisitor, Visitor};
use integrator::pose::{Body, Exponential, Linear, World};
use integrator::rigid_body::{
    AttitudeUpdate, BodyOmega, Kinematics, RigidBody, RigidModel, Storage, WithoutGyroscopicTerm, WorldMomentum,
    WorldOmega,
};
use integrator::{Method, Model, Single, State, Vector, drive};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::motion::{Motion, RigidMotion};
use crate::observation::Observation;

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

/// What to run on a scene. `A` names the rule of a step: a [`MethodId`], or a
/// [`RigidStep`] for a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run<A = MethodId> {
    /// The rule of a step.
    pub method: A,
    /// What a rigid body stores; a flat scene, and a step that leaves no choice, pay no heed to it.
    pub storage: Storage,
    /// How a rigid body's attitude is advanced.
    pub update: AttitudeUpdate,
    /// The arithmetic.
    pub precision: Precision,
    /// End of the run, s.
    pub end_s: f64,
    /// Number of steps, at least 1; h = end_s / steps.
    pub steps: u64,
}

impl<A> Run<A> {
    /// A run of which a rigid body stores its angular velocity in the world frame and moves by the exponential map.
    pub fn new(method: A, precision: Precision, end_s: f64, steps: u64) -> Self {
        let (storage, update) = (Storage::default(), AttitudeUpdate::default());
        Run { method, storage, update, precision, end_s, steps }
    }

    /// The same with another stored quantity and another attitude update.
    #[must_use]
    pub fn storing(self, storage: Storage, update: AttitudeUpdate) -> Self {
        Run { storage, update, ..self }
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

/// Runs a model of a flat space with a method chosen at run time.
pub fn run_model<T: Single, M: Motion<T>>(model: &M, run: &Run, stride: u64) -> Trajectory {
    let counted = Counted::new(model);
    let seen = run.method.visit(Flat { model: &counted, motion: model, clock: Schedule::of(run, stride) });
    seen.trajectory(run.method.is_implicit(), counted.evaluations())
}

struct Flat<'a, M> {
    model: &'a Counted<&'a M>,
    motion: &'a M,
    clock: Schedule,
}

impl<'a, T: Single, M: Motion<T>> Visitor<T, Counted<&'a M>> for Flat<'a, M> {
    type Output = Samples;

    fn visit<A: Method<T, Counted<&'a M>>>(self, method: &A) -> Samples {
        self.clock.drive(method, self.model, self.motion.exact(T::lit(0.0)), |s| self.motion.observe(s))
    }
}

/// Runs a rigid body with a method, a stored quantity and an attitude update chosen at run time.
///
/// What every study runs, the world omega with the exponential map, is compiled for each body. The other combinations
/// take their body behind a pointer, one virtual call an evaluation: they are compared and not timed, and compiled for each
/// body they made the build more than twice as long.
pub fn run_body<T: Single, B: RigidMotion<T>>(body: &B, run: &Run, stride: u64) -> Trajectory {
    let start = body.exact(T::lit(0.0));
    if (run.storage, run.update) != (Storage::WorldOmega, AttitudeUpdate::Exponential) {
        return run_any(body as AnyBody<'_, T, B::Position>, start, run, stride);
    }
    let counted = Counted::new(body);
    let model = WorldOmega::<_, Exponential<World>>::new(&counted);
    let seen = run.method.visit(Turning { model: &model, start, clock: Schedule::of(run, stride) });
    seen.trajectory(run.method.is_implicit(), counted.evaluations())
}

/// A body of which only the kind of its position is known.
pub type AnyBody<'a, T, P> = &'a dyn RigidBody<T, Position = P>;

/// Runs a body of which only the kind of its position is known.
pub fn run_any<T: Single, P: Vector<T>>(
    body: AnyBody<'_, T, P>,
    start: Kinematics<T, P>,
    run: &Run,
    stride: u64,
) -> Trajectory {
    let counted = Counted::new(body);
    let clock = Schedule::of(run, stride);
    macro_rules! with {
        ($model:ident, $update:ident<$frame:ident>) => {{
            let model = $model::<_, $update<$frame>>::new(&counted);
            run.method.visit(Turning { model: &model, start, clock })
        }};
    }
    use AttitudeUpdate as U;
    let seen = match (run.storage, run.update) {
        (Storage::WorldOmega, U::Exponential) => with!(WorldOmega, Exponential<World>),
        (Storage::WorldOmega, U::Linear) => with!(WorldOmega, Linear<World>),
        (Storage::BodyOmega, U::Exponential) => with!(BodyOmega, Exponential<Body>),
        (Storage::BodyOmega, U::Linear) => with!(BodyOmega, Linear<Body>),
        (Storage::WorldMomentum, U::Exponential) => with!(WorldMomentum, Exponential<World>),
        (Storage::WorldMomentum, U::Linear) => with!(WorldMomentum, Linear<World>),
        (Storage::WithoutGyroscopicTerm, U::Exponential) => with!(WithoutGyroscopicTerm, Exponential<World>),
        (Storage::WithoutGyroscopicTerm, U::Linear) => with!(WithoutGyroscopicTerm, Linear<World>),
    };
    seen.trajectory(run.method.is_implicit(), counted.evaluations())
}

/// Runs a rigid body with a step that exists for rigid bodies only.
pub fn run_step<T: Single, B: RigidMotion<T>>(body: &B, run: &Run<RigidStep>, stride: u64) -> Trajectory {
    step_any(body as AnyBody<'_, T, B::Position>, body.exact(T::lit(0.0)), run, stride)
}

/// The same with a step that exists for rigid bodies only.
pub fn step_any<T: Single, P: Vector<T>>(
    body: AnyBody<'_, T, P>,
    start: Kinematics<T, P>,
    run: &Run<RigidStep>,
    stride: u64,
) -> Trajectory {
    let counted = Counted::new(body);
    let turn = Turn { start, clock: Schedule::of(run, stride) };
    let seen = run.method.visit::<T, _, _>(run.update, &counted, turn);
    seen.trajectory(false, counted.evaluations())
}

/// A rigid body in what its model stores, with a general method.
struct Turning<'a, T: Single, M: RigidModel<T>> {
    model: &'a M,
    start: Kinematics<T, <M::Body as RigidBody<T>>::Position>,
    clock: Schedule,
}

impl<T: Single, M: RigidModel<T>> Visitor<T, M> for Turning<'_, T, M> {
    type Output = Samples;

    fn visit<A: Method<T, M>>(self, method: &A) -> Samples {
        self.clock.drive(method, self.model, self.model.state(&self.start), |s| Observation::of_body(self.model, s))
    }
}

/// A rigid body whose model the step chooses.
struct Turn<T: Single, P> {
    start: Kinematics<T, P>,
    clock: Schedule,
}

impl<T: Single, B: RigidBody<T>> RigidVisitor<T, B> for Turn<T, B::Position> {
    type Output = Samples;

    fn visit<M: RigidModel<T, Body = B>, A: Method<T, M>>(self, method: &A, model: &M) -> Samples {
        self.clock.drive(method, model, model.state(&self.start), |s| Observation::of_body(model, s))
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
    pub fn of<A>(run: &Run<A>, stride: u64) -> Self {
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
