//! The time of a step: unobserved, uncounted, compiled for the one scene, method and storage, with no virtual call in it.
//!
//! Compiled in f64 are all methods of the core with the angular velocity of the body, and the explicit ones with that of the
//! world; in f32 the explicit ones with that of the body. The implicit ones are the larger part of a build.

use std::hint::black_box;
use std::time::Instant;

use integrator::methods::{RigidStep, RigidVisitor, Visitor};
use integrator::rigid_body::{AttitudeUpdate, BodyOmega, Formulation, Kinematics, RigidBody, RigidModel, WorldOmega};
use integrator::{Method, Model, Single, State, Vector, drive};

use crate::motion::{Motion, RigidMotion};
use crate::run::Run;
use crate::scheme::Rule;

/// How often a run is repeated from its start within one timing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Repetitions(pub u32);

/// What a timing gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Time of all laps, ns.
    pub ns: f64,
    /// The first component of the last stored velocity: whoever has it has taken the steps.
    pub checksum: f64,
}

/// Times a run of a scene that is its own model, with every method of the core.
pub(crate) fn particles<S: Motion<f64>>(scene: &S, run: &Run, laps: Repetitions) -> Option<Timing> {
    let Rule::General(method) = run.scheme.rule else { return None };
    method.visit_core(Watch { model: scene, start: scene.exact(0.0), pace: Pace::of(run, laps) })
}

/// The same with the explicit methods, in any arithmetic; `None` for an implicit one.
pub(crate) fn particles_explicit<T: Single, S: Motion<T>>(scene: &S, run: &Run, laps: Repetitions) -> Option<Timing> {
    let Rule::General(method) = run.scheme.rule else { return None };
    method.visit_core_explicit(Watch { model: scene, start: scene.exact(T::lit(0.0)), pace: Pace::of(run, laps) })
}

/// Times a run of a rigid body that stores an angular velocity; `None` for another storage, and for an implicit method that
/// stores that of the world.
pub(crate) fn body<B: RigidMotion<f64>>(body: &B, run: &Run, laps: Repetitions) -> Option<Timing> {
    let method = match run.scheme.rule {
        Rule::General(method) => method,
        Rule::Rigid(step) => return Some(of_step::<f64, B>(body, step, run, laps)),
    };
    let (start, pace) = (body.exact(0.0), Pace::of(run, laps));
    match run.scheme.storage {
        Formulation::WorldOmega => {
            let model = WorldOmega::<&B>::new(body);
            method.visit_core_explicit(Watch { model: &model, start: model.state(&start), pace })
        }
        Formulation::BodyOmega => {
            let model = BodyOmega::<&B>::new(body);
            method.visit_core(Watch { model: &model, start: model.state(&start), pace })
        }
        _ => None,
    }
}

/// The same with the explicit methods and the angular velocity of the body, in any arithmetic; `None` for anything else.
pub(crate) fn body_explicit<T: Single, B: RigidMotion<T>>(body: &B, run: &Run, laps: Repetitions) -> Option<Timing> {
    let method = match run.scheme.rule {
        Rule::Rigid(step) => return Some(of_step::<T, B>(body, step, run, laps)),
        Rule::General(method) if run.scheme.storage == Formulation::BodyOmega => method,
        Rule::General(_) => return None,
    };
    let model = BodyOmega::<&B>::new(body);
    let start = model.state(&body.exact(T::lit(0.0)));
    method.visit_core_explicit(Watch { model: &model, start, pace: Pace::of(run, laps) })
}

/// Times a run with a step that exists for rigid bodies only.
fn of_step<T: Single, B: RigidMotion<T>>(body: &B, step: RigidStep, run: &Run, laps: Repetitions) -> Timing {
    let turn = RigidStepRun { start: body.exact(T::lit(0.0)), pace: Pace::of(run, laps) };
    step.visit::<T, _, _>(AttitudeUpdate::Exponential, body, turn)
}

#[derive(Clone, Copy)]
struct Pace {
    end_s: f64,
    steps: u64,
    laps: Repetitions,
}

impl Pace {
    fn of(run: &Run, laps: Repetitions) -> Self {
        Pace { end_s: run.end_s, steps: run.steps, laps }
    }

    fn time<T: Single, M: Model<T>, A: Method<T, M>>(self, method: &A, model: &M, start: State<M::Config>) -> Timing {
        let h = T::lit(self.end_s) / T::lit(self.steps as f64);
        let mut checksum = f64::NAN;
        let clock = Instant::now();
        for _ in 0..self.laps.0 {
            let end = drive::advance(method, black_box(model), black_box(start), black_box(h), self.steps);
            checksum = black_box(end.map_or(f64::NAN, |s| s.v.component(0).to_f64()));
        }
        Timing { ns: clock.elapsed().as_secs_f64() * 1e9, checksum }
    }
}

struct Watch<'a, T: Single, M: Model<T>> {
    model: &'a M,
    start: State<M::Config>,
    pace: Pace,
}

impl<T: Single, M: Model<T>> Visitor<T, M> for Watch<'_, T, M> {
    type Output = Timing;

    fn visit<A: Method<T, M>>(self, method: &A) -> Timing {
        self.pace.time(method, self.model, self.start)
    }
}

struct RigidStepRun<T: Single, P> {
    start: Kinematics<T, P>,
    pace: Pace,
}

impl<T: Single, B: RigidBody<T>> RigidVisitor<T, B> for RigidStepRun<T, B::Position> {
    type Output = Timing;

    fn visit<M: RigidModel<T, Body = B>, A: Method<T, M>>(self, method: &A, model: &M) -> Timing {
        self.pace.time(method, model, model.state(&self.start))
    }
}
