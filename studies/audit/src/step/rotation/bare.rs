//! Candidates on the bare quaternion: methods of a flat space, methods with a memory, Runge-Kutta-Munthe-Kaas.

use integrator::methods::{MethodId, Visitor};
use integrator::pose::Fixed;
use integrator::rigid_body::Kinematics;
use integrator::{Method, Model, Rotation, Single, State, Vector};
use nalgebra::{Vector3, Vector4};

use super::{drag, suffixed};
use crate::physics::{Body, Drag, Moment};
use crate::step::candidate::{Candidate, Kin, Precision};
use crate::step::damping::{Damping, When, apply};
use crate::step::own::{Memory, Tableau};
use crate::trajectory::readings::OmegaFrame;

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

/// A quaternion and an angular velocity as eight plain numbers: q' = q omega / 2 or omega q / 2.
#[derive(Clone, Copy)]
pub(in crate::step) struct Bare {
    plan: RawPlan,
}

impl Bare {
    /// A body with the angular velocity in its own axes.
    pub(in crate::step) fn free(inertia: Vector3<f64>, moment: Moment) -> Self {
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

pub(super) fn raw_candidates(
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
pub(in crate::step) fn munthe_kaas<T: Single>(model: &Bare, h: T, s: State<Vector4<T>>) -> State<Vector4<T>> {
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
    let (k2, a2) = slope(k1 * half, s.v.add_scaled(a1, half));
    let (k3, a3) = slope(k2 * half, s.v.add_scaled(a2, half));
    let (k4, a4) = slope(k3 * h, s.v.add_scaled(a3, h));
    let (two, sixth) = (T::lit(2.0), h / T::lit(6.0));
    let u = (k1 + k4 + (k2 + k3) * two) * sixth;
    at(u, s.v.add_scaled((a1 + a4).add_scaled(a2 + a3, two), sixth))
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
                    s.q = before.q.add_scaled(model.velocity(before.q, s.v), step);
                }
            }
            s.v = damp(When::After, s.v);
            s = model.contact(&before, s);
        }
        out.push(kin(&s));
    }
    out
}
