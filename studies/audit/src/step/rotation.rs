//! Candidates for the step that turns a body: methods and rigid steps, what they store, how the attitude is advanced and by
//! which angular velocity, damping, substeps, precision; and methods on the bare quaternion.

pub(super) mod bare;

use integrator::methods::{MethodId, RigidStep, RigidVisitor, Visitor};
use integrator::pose::{Body as BodyFrame, Exponential, Fixed, Linear, World};
use integrator::rigid_body::{
    AttitudeUpdate, BodyOmega, Formulation, Kinematics, RigidModel, WithoutGyroscopicTerm, WorldMomentum, WorldOmega,
};
use integrator::{Method, Rotation, Single, Space, State, Tangent, Twist, Vector};
use nalgebra::Vector3;

use bare::raw_candidates;

use super::candidate::{Candidate, Kin, Precision};
use super::damping::{Damping, Rule, When, apply};
use crate::physics::{Body, Drag, Moment};
use crate::trajectory::readings::OmegaFrame;

/// How the angular velocity is advanced.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scheme {
    General(MethodId, Formulation),
    Rigid(RigidStep),
}

/// Which angular velocity turns the attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Turn {
    AsMethod,
    Old,
    New,
    Mean,
}

#[derive(Clone, Copy, Debug)]
struct Plan {
    scheme: Scheme,
    update: AttitudeUpdate,
    turn: Turn,
    body: Body,
    damping: Option<Damping>,
    substeps: u32,
    frame: OmegaFrame,
}

/// All candidates for a body; `damping`: those that the file may have.
pub(super) fn candidates(
    inertia: Vector3<f64>,
    moment: Moment,
    damping: &[Option<Damping>],
    frame: OmegaFrame,
    single: bool,
) -> Vec<Candidate> {
    let body = Body { inertia, moment, drag: Drag::None };
    let mut schemes: Vec<Scheme> = RigidStep::ALL.iter().map(|s| Scheme::Rigid(*s)).collect();
    for storage in [
        Formulation::BodyOmega,
        Formulation::WorldOmega,
        Formulation::WorldMomentum,
        Formulation::WithoutGyroscopicTerm,
    ] {
        schemes.extend(MethodId::ALL.iter().map(|m| Scheme::General(*m, storage)));
    }
    let mut all = Vec::new();
    for &precision in Precision::tried(single) {
        for &damping in damping {
            for &scheme in &schemes {
                for update in AttitudeUpdate::ALL {
                    for turn in [Turn::AsMethod, Turn::Old, Turn::New, Turn::Mean] {
                        if !is_sensible(scheme, turn, damping) {
                            continue;
                        }
                        for substeps in [1, 2, 4, 8] {
                            if substeps > 1 && (turn != Turn::AsMethod || !is_substepped(scheme)) {
                                continue;
                            }
                            all.push(candidate(
                                Plan { scheme, update, turn, body, damping, substeps, frame },
                                precision,
                            ));
                        }
                    }
                }
            }
            raw_candidates(&mut all, body, damping, frame, precision);
        }
    }
    all
}

/// Turns that make a step of their own.
fn is_sensible(scheme: Scheme, turn: Turn, damping: Option<Damping>) -> bool {
    let euler = matches!(
        scheme,
        Scheme::General(MethodId::ExplicitEuler | MethodId::SemiImplicitEuler, _)
            | Scheme::Rigid(RigidStep::ImplicitGyroscopic | RigidStep::RestoredMomentum)
    );
    let semi = !matches!(scheme, Scheme::General(MethodId::ExplicitEuler, _));
    match turn {
        Turn::AsMethod => damping.is_none() || euler,
        // Explicit Euler is semi-implicit Euler with the old velocity.
        Turn::Old => euler && semi && !matches!(scheme, Scheme::General(..)),
        Turn::New => !euler && damping.is_none() && matches!(scheme, Scheme::General(MethodId::Rk4, _)),
        Turn::Mean => semi && damping.is_none() && !matches!(scheme, Scheme::General(MethodId::ImplicitMidpoint, _)),
    }
}

fn is_substepped(scheme: Scheme) -> bool {
    matches!(
        scheme,
        Scheme::General(
            MethodId::SemiImplicitEuler,
            Formulation::BodyOmega | Formulation::WorldOmega | Formulation::WithoutGyroscopicTerm
        ) | Scheme::Rigid(RigidStep::ImplicitGyroscopic | RigidStep::RestoredMomentum)
    )
}

fn name(plan: &Plan) -> String {
    let mut id = match plan.scheme {
        Scheme::Rigid(step) => step.id().to_owned(),
        Scheme::General(method, storage) => format!("{}/{}", method.id(), storage.id()),
    };
    id = format!("{id}/{}", plan.update.id());
    id += match plan.turn {
        Turn::AsMethod => "",
        Turn::Old => ", turned by the old angular velocity",
        Turn::New => ", turned by the new angular velocity",
        Turn::Mean => ", turned by the mean angular velocity",
    };
    if plan.substeps > 1 {
        id = format!("{id}, {} substeps", plan.substeps);
    }
    id
}

fn suffixed(mut id: String, damping: Option<Damping>, precision: Precision) -> String {
    if let Some(d) = damping {
        id = format!("{id}, {}", d.name());
    }
    if precision == Precision::Single {
        id += ", f32";
    }
    id
}

fn candidate(plan: Plan, precision: Precision) -> Candidate {
    let run = move |start: &Kin, h: f64, k: u64, rows: u64| match precision {
        Precision::Double => run::<f64>(plan, start, h, k, rows),
        Precision::Single => run::<f32>(plan, start, h, k, rows),
    };
    let id = suffixed(name(&plan), plan.damping, precision);
    Candidate {
        id,
        memory: false,
        steps: plan.damping.and_then(|d| d.steps),
        damping: plan.damping.map(|d| d.c),
        substeps: plan.substeps,
        run: Box::new(run),
    }
}

fn drag(damping: Option<Damping>) -> Drag {
    match damping {
        Some(Damping { rule: Rule::Force, c, .. }) => Drag::Linear(c),
        Some(Damping { rule: Rule::QuadraticForce, c, .. }) => Drag::Quadratic(c),
        _ => Drag::None,
    }
}

struct Runner<'a> {
    plan: Plan,
    start: &'a Kin,
    h: f64,
    k: u64,
    rows: u64,
}

impl Runner<'_> {
    fn go<T: Single, M: RigidModel<T, Body = Body>, A: Method<T, M>>(self, method: &A, model: &M) -> Vec<Kin> {
        let plan = &self.plan;
        let attitude = Rotation::from_wxyz(self.start.q);
        let omega_body = match plan.frame {
            OmegaFrame::Body => self.start.w,
            OmegaFrame::World => attitude.rotate_back(self.start.w),
        };
        let attitude = Rotation { w: T::lit(attitude.w), v: attitude.v.map(T::lit) };
        let mut s = model.state(&Kinematics {
            position: Fixed::zero(),
            velocity: Fixed::zero(),
            attitude,
            omega_body: omega_body.map(T::lit),
        });
        let inner = self.h / f64::from(plan.substeps);
        let mut out = Vec::with_capacity(self.rows as usize);
        for _ in 0..self.rows {
            for _ in 0..self.k * u64::from(plan.substeps) {
                s = step(plan, method, model, inner, s);
            }
            let at = model.kinematics(&s);
            let q = Rotation { w: at.attitude.w.to_f64(), v: at.attitude.v.map(Single::to_f64) };
            let body = at.omega_body.map(Single::to_f64);
            let w = if plan.frame == OmegaFrame::Body { body } else { q.normalized().rotate(body) };
            out.push(Kin { q: q.wxyz(), w, ..*self.start });
        }
        out
    }
}

fn step<T: Single, M: RigidModel<T, Body = Body>, A: Method<T, M>>(
    plan: &Plan,
    method: &A,
    model: &M,
    h: f64,
    mut s: State<M::Config>,
) -> State<M::Config> {
    let step = T::lit(h);
    let damped = |when: When, v: Tangent<M, T>| Twist { angular: apply(plan.damping, when, h, v.angular), ..v };
    s.v = damped(When::Before, s.v);
    let mut next = method.step(model, T::lit(0.0), step, s);
    let between = plan.damping.is_some_and(|d| d.when == When::Between && !d.rule.is_force());
    let explicit = matches!(plan.scheme, Scheme::General(MethodId::ExplicitEuler, _)) || plan.turn == Turn::Old;
    if between {
        next.v = damped(When::Between, next.v);
    }
    let by = match plan.turn {
        Turn::AsMethod if between && !explicit => Some(next.v),
        Turn::AsMethod => None,
        Turn::Old => Some(s.v),
        Turn::New => Some(next.v),
        Turn::Mean => Some((s.v + next.v) * T::lit(0.5)),
    };
    if let Some(v) = by {
        next.q = s.q.retract(model.velocity(s.q, v), step);
    }
    next.v = damped(When::After, next.v);
    next.settled()
}

struct General<'a, M>(Runner<'a>, &'a M);

impl<T: Single, M: RigidModel<T, Body = Body>> Visitor<T, M> for General<'_, M> {
    type Output = Vec<Kin>;
    fn visit<A: Method<T, M>>(self, method: &A) -> Vec<Kin> {
        self.0.go(method, self.1)
    }
}

impl<T: Single> RigidVisitor<T, Body> for Runner<'_> {
    type Output = Vec<Kin>;
    fn visit<M: RigidModel<T, Body = Body>, A: Method<T, M>>(self, method: &A, model: &M) -> Vec<Kin> {
        self.go(method, model)
    }
}

fn run<T: Single>(plan: Plan, start: &Kin, h: f64, k: u64, rows: u64) -> Vec<Kin> {
    let body = Body { drag: drag(plan.damping), ..plan.body };
    let runner = Runner { plan, start, h, k, rows };
    macro_rules! general {
        ($method:expr, $($storage:ident, $frame:ident;)*) => {
            match (plan.scheme, plan.update) { $(
                (Scheme::General(method, Formulation::$storage), AttitudeUpdate::Exponential) => {
                    let model = $storage::<Body, Exponential<$frame>>::new(body);
                    Visit::<T>::visit(method, General(runner, &model), &model)
                }
                (Scheme::General(method, Formulation::$storage), AttitudeUpdate::Linear) => {
                    let model = $storage::<Body, Linear<$frame>>::new(body);
                    Visit::<T>::visit(method, General(runner, &model), &model)
                }
            )*
                (Scheme::Rigid(step), update) => step.visit::<T, _, _>(update, body, runner),
            }
        };
    }
    general!(plan.scheme, WorldOmega, World; BodyOmega, BodyFrame; WorldMomentum, World; WithoutGyroscopicTerm, World;)
}

/// Names the type of the model for [`MethodId::visit`].
struct Visit<T>(std::marker::PhantomData<T>);

impl<T: Single> Visit<T> {
    fn visit<M: RigidModel<T, Body = Body>>(method: MethodId, general: General<'_, M>, _model: &M) -> Vec<Kin> {
        method.visit::<T, M, _>(general)
    }
}
