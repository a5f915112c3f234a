//! Candidates for the step that turns a body: methods and rigid steps, what they store, how the attitude is advanced and by
//! which angular velocity, damping, substeps, precision; and methods on the bare quaternion.

use integrator::methods::{MethodId, RigidStep, RigidVisitor, Visitor};
use integrator::pose::{Body as BodyFrame, Exponential, Fixed, Linear, World};
use integrator::rigid_body::{
    AttitudeUpdate, BodyOmega, Kinematics, RigidModel, Storage, WithoutGyroscopicTerm, WorldMomentum, WorldOmega,
};
use integrator::{Method, Model, Rotation, Single, Space, State, Tangent, Twist, Vector};
use nalgebra::{Vector3, Vector4};

use super::candidate::{Candidate, Kin, Precision};
use super::damping::{Damping, Rule, When, apply};
use super::own::{Memory, Tableau};
use crate::physics::{Body, Drag, Moment};
use crate::trajectory::readings::OmegaFrame;

/// How the angular velocity is advanced.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scheme {
    General(MethodId, Storage),
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

/// How a bare quaternion is advanced.
#[derive(Clone, Copy, Debug, PartialEq)]
enum RawScheme {
    Method(MethodId),
    Tableau(Tableau),
    Memory(Memory),
    /// The classical tableau on the rotation vector of the step, with the exact inverse of dexp at every stage.
    MuntheKaas,
}

#[derive(Clone, Copy, Debug)]
struct RawPlan {
    scheme: RawScheme,
    body: Body,
    /// Whether the angular velocity is stored in world components.
    world: bool,
    normalise: bool,
    gyroscopic: bool,
    damping: Option<Damping>,
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
    for storage in [Storage::BodyOmega, Storage::WorldOmega, Storage::WorldMomentum, Storage::WithoutGyroscopicTerm] {
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
            Storage::BodyOmega | Storage::WorldOmega | Storage::WithoutGyroscopicTerm
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
                (Scheme::General(method, Storage::$storage), AttitudeUpdate::Exponential) => {
                    let model = $storage::<Body, Exponential<$frame>>::new(body);
                    Visit::<T>::visit(method, General(runner, &model), &model)
                }
                (Scheme::General(method, Storage::$storage), AttitudeUpdate::Linear) => {
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

/// A quaternion and an angular velocity as eight plain numbers: q' = q omega / 2 or omega q / 2.
#[derive(Clone, Copy)]
pub(super) struct Bare {
    plan: RawPlan,
}

impl Bare {
    /// A body with the angular velocity in its own axes.
    pub(super) fn free(inertia: Vector3<f64>, moment: Moment) -> Self {
        let plan = RawPlan {
            scheme: RawScheme::MuntheKaas,
            body: Body { inertia, moment, drag: Drag::None },
            world: false,
            normalise: true,
            gyroscopic: true,
            damping: None,
            frame: OmegaFrame::Body,
        };
        Bare { plan }
    }
}

impl<T: Single> Model<T> for Bare {
    type Config = Vector4<T>;

    fn rate(&self, _t: T, s: &State<Vector4<T>>) -> Vector4<T> {
        let q = Rotation { w: s.q.x, v: Vector3::new(s.q.y, s.q.z, s.q.w) }.normalized();
        let omega = Vector3::new(s.v.y, s.v.z, s.v.w);
        let body = self.plan.body;
        let inertia = body.inertia.map(T::lit);
        let omega_body = if self.plan.world { q.rotate_back(omega) } else { omega };
        let at = Kinematics { position: Fixed::zero(), velocity: Fixed::zero(), attitude: q, omega_body };
        let torque =
            integrator::rigid_body::RigidBody::torque(&body, T::lit(0.0), &at).plus_in_body(q, Vector3::zero());
        let gyroscopic = if self.plan.gyroscopic {
            integrator::rotation::cross(inertia.component_mul(&omega_body), omega_body)
        } else {
            Vector3::repeat(T::lit(0.0))
        };
        let alpha = (torque + gyroscopic).component_div(&inertia);
        let alpha = if self.plan.world { q.rotate(alpha) } else { alpha };
        Vector4::new(T::lit(0.0), alpha.x, alpha.y, alpha.z)
    }

    fn velocity(&self, q: Vector4<T>, v: Vector4<T>) -> Vector4<T> {
        let a = Rotation { w: q.x, v: Vector3::new(q.y, q.z, q.w) };
        let b = Rotation { w: T::lit(0.0), v: Vector3::new(v.y, v.z, v.w) };
        let d = if self.plan.world { b * a } else { a * b };
        Vector4::new(d.w, d.v.x, d.v.y, d.v.z) * T::lit(0.5)
    }

    fn contact(&self, _before: &State<Vector4<T>>, after: State<Vector4<T>>) -> State<Vector4<T>> {
        if !self.plan.normalise {
            return after;
        }
        let square = (0..4).fold(T::lit(0.0), |sum, i| after.q[i].mul_add(after.q[i], sum));
        State { q: after.q * (T::lit(1.0) / square.sqrt()), ..after }
    }
}

fn raw_candidates(
    all: &mut Vec<Candidate>,
    body: Body,
    damping: Option<Damping>,
    frame: OmegaFrame,
    precision: Precision,
) {
    let mut schemes: Vec<RawScheme> = MethodId::ALL.iter().map(|m| RawScheme::Method(*m)).collect();
    schemes.extend(Tableau::ALL.map(RawScheme::Tableau));
    schemes.extend(Memory::ALL.map(RawScheme::Memory));
    schemes.push(RawScheme::MuntheKaas);
    for scheme in schemes {
        for (world, normalise, gyroscopic) in [
            (true, false, true),
            (true, true, true),
            (false, false, true),
            (false, true, true),
            (false, true, false),
            (true, false, false),
        ] {
            // Both Eulers, normalised, are steps of a pose.
            let pose = matches!(scheme, RawScheme::Method(MethodId::ExplicitEuler | MethodId::SemiImplicitEuler));
            let force = damping.is_none_or(|d| d.rule.is_force());
            let munthe_kaas = scheme == RawScheme::MuntheKaas && (world || !normalise || !gyroscopic);
            if pose && normalise && gyroscopic || !force && !pose || munthe_kaas {
                continue;
            }
            let plan = RawPlan { scheme, body, world, normalise, gyroscopic, damping, frame };
            all.push(raw_candidate(plan, precision));
        }
    }
}

fn raw_candidate(plan: RawPlan, precision: Precision) -> Candidate {
    let scheme = match plan.scheme {
        RawScheme::Method(m) => m.id(),
        RawScheme::Tableau(t) => t.id(),
        RawScheme::Memory(m) => m.id(),
        RawScheme::MuntheKaas => "rk4-munthe-kaas",
    };
    let frame = if plan.world { "world-omega" } else { "body-omega" };
    let norm = if plan.normalise { "quaternion normalised" } else { "quaternion never normalised" };
    let gyroscopic = if plan.gyroscopic { "" } else { ", without the gyroscopic term" };
    let id = suffixed(format!("{scheme}/{frame}/{norm}{gyroscopic}"), plan.damping, precision);
    let run = move |start: &Kin, h: f64, k: u64, rows: u64| match precision {
        Precision::Double => run_raw::<f64>(plan, start, h, k, rows),
        Precision::Single => run_raw::<f32>(plan, start, h, k, rows),
    };
    let memory = matches!(plan.scheme, RawScheme::Memory(_));
    Candidate {
        id,
        memory,
        steps: plan.damping.and_then(|d| d.steps),
        damping: plan.damping.map(|d| d.c),
        substeps: 1,
        run: Box::new(run),
    }
}

struct Once<'a, T: Single> {
    model: &'a Bare,
    h: T,
    s: State<Vector4<T>>,
}

impl<T: Single> Visitor<T, Bare> for Once<'_, T> {
    type Output = State<Vector4<T>>;
    fn visit<A: Method<T, Bare>>(self, method: &A) -> Self::Output {
        method.step(self.model, T::lit(0.0), self.h, self.s)
    }
}

/// dexp^-1 of u on omega in body axes: omega + u x omega / 2 + (1 - (a/2) cot(a/2)) / a^2 u x (u x omega), a = |u|.
fn dexp_inverse<T: Single>(u: Vector3<T>, omega: Vector3<T>) -> Vector3<T> {
    use integrator::rotation::{cross, dot};
    let square = dot(u, u);
    let once = cross(u, omega);
    let coefficient = if square.to_f64() < 1e-4 {
        T::lit(1.0) / T::lit(12.0) + square / T::lit(720.0)
    } else {
        let half = square.sqrt() * T::lit(0.5);
        let (sine, cosine) = half.sin_cos();
        (T::lit(1.0) - half * cosine / sine) / square
    };
    omega + once * T::lit(0.5) + cross(u, once) * coefficient
}

/// One step of Runge-Kutta-Munthe-Kaas on the attitude, with the classical tableau for both.
pub(super) fn munthe_kaas<T: Single>(model: &Bare, h: T, s: State<Vector4<T>>) -> State<Vector4<T>> {
    let q0 = Rotation { w: s.q.x, v: Vector3::new(s.q.y, s.q.z, s.q.w) };
    let omega = |v: Vector4<T>| Vector3::new(v.y, v.z, v.w);
    let at = |u: Vector3<T>, v: Vector4<T>| {
        let q = q0 * Rotation::exp(u);
        State { q: Vector4::new(q.w, q.v.x, q.v.y, q.v.z), v }
    };
    let half = h * T::lit(0.5);
    let zero = Vector3::repeat(T::lit(0.0));
    let slope = |u: Vector3<T>, v: Vector4<T>| (dexp_inverse(u, omega(v)), model.rate(h, &at(u, v)));
    let (k1, a1) = slope(zero, s.v);
    let (k2, a2) = slope(k1 * half, s.v.plus(a1, half));
    let (k3, a3) = slope(k2 * half, s.v.plus(a2, half));
    let (k4, a4) = slope(k3 * h, s.v.plus(a3, h));
    let (two, sixth) = (T::lit(2.0), h / T::lit(6.0));
    let u = (k1 + k4 + (k2 + k3) * two) * sixth;
    at(u, s.v.plus((a1 + a4).plus(a2 + a3, two), sixth))
}

fn run_raw<T: Single>(plan: RawPlan, start: &Kin, h: f64, k: u64, rows: u64) -> Vec<Kin> {
    let model = Bare { plan: RawPlan { body: Body { drag: drag(plan.damping), ..plan.body }, ..plan } };
    let q = Rotation { w: start.q[0], v: Vector3::new(start.q[1], start.q[2], start.q[3]) };
    let stored = match (plan.frame, plan.world) {
        (OmegaFrame::World, true) | (OmegaFrame::Body, false) => start.w,
        (OmegaFrame::World, false) => q.normalized().rotate_back(start.w),
        (OmegaFrame::Body, true) => q.normalized().rotate(start.w),
    };
    let lift = |q: Rotation<f64>, w: Vector3<f64>| State {
        q: Vector4::new(q.w, q.v.x, q.v.y, q.v.z).map(T::lit),
        v: Vector4::new(0.0, w.x, w.y, w.z).map(T::lit),
    };
    let kin = |s: &State<Vector4<T>>| {
        let q = s.q.map(Single::to_f64);
        let w = Vector3::new(s.v.y.to_f64(), s.v.z.to_f64(), s.v.w.to_f64());
        let unit = Rotation::from_wxyz([q.x, q.y, q.z, q.w]);
        let w = match (plan.frame, plan.world) {
            (OmegaFrame::World, true) | (OmegaFrame::Body, false) => w,
            (OmegaFrame::World, false) => unit.rotate(w),
            (OmegaFrame::Body, true) => unit.rotate_back(w),
        };
        Kin { q: [q.x, q.y, q.z, q.w], w, ..*start }
    };
    let mut s = lift(q, stored);
    let step = T::lit(h);
    let mut out = Vec::with_capacity(rows as usize);
    if let RawScheme::Memory(memory) = plan.scheme {
        let mut n = 0;
        memory.run(&model, step, s, k * rows, |s| {
            n += 1;
            if n % k == 0 {
                out.push(kin(s));
            }
        });
        return out;
    }
    let damp = |when: When, v: Vector4<T>| {
        let w = apply(plan.damping, when, h, Vector3::new(v.y, v.z, v.w));
        Vector4::new(v.x, w.x, w.y, w.z)
    };
    for _ in 0..rows {
        for _ in 0..k {
            s.v = damp(When::Before, s.v);
            let before = s;
            s = match plan.scheme {
                RawScheme::Method(method) => method.visit(Once { model: &model, h: step, s }),
                RawScheme::Tableau(tableau) => tableau.step(&model, T::lit(0.0), step, s),
                RawScheme::Memory(_) => s,
                RawScheme::MuntheKaas => munthe_kaas(&model, step, s),
            };
            if plan.damping.is_some_and(|d| d.when == When::Between && !d.rule.is_force()) {
                s.v = damp(When::Between, s.v);
                if plan.scheme == RawScheme::Method(MethodId::SemiImplicitEuler) {
                    s.q = before.q.plus(model.velocity(before.q, s.v), step);
                }
            }
            s.v = damp(When::After, s.v);
            s = model.contact(&before, s);
        }
        out.push(kin(&s));
    }
    out
}
