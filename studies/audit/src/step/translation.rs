//! Candidates for the step that moves a point: methods, damping, substeps with the force fresh or frozen, precision.

use integrator::methods::{MethodId, Visitor};
use integrator::{Method, Single, State, Vector};
use nalgebra::Vector3;

use super::candidate::{Candidate, Kin, Precision};
use super::damping::{Damping, Rule, When, apply};
use super::own::{Memory, Tableau};
use crate::physics::{Drag, Force, Point, acceleration};

/// How the velocity and the position follow.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scheme {
    Method(MethodId),
    Tableau(Tableau),
    Memory(Memory),
    /// v1 = v0 + h a(x0), x1 = x0 + h (v0 + v1) / 2.
    MeanVelocity,
    /// x1 = x0 + h v0, v1 = v0 + h a(x1).
    PositionFirst,
}

impl Scheme {
    fn id(self) -> &'static str {
        match self {
            Scheme::Method(m) => m.id(),
            Scheme::Tableau(t) => t.id(),
            Scheme::Memory(m) => m.id(),
            Scheme::MeanVelocity => "mean-velocity",
            Scheme::PositionFirst => "position-first-euler",
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Plan {
    scheme: Scheme,
    force: Force,
    damping: Option<Damping>,
    substeps: u32,
    frozen: bool,
}

/// All candidates for a force; `damping`: those that the file may have.
pub(super) fn candidates(force: Force, damping: &[Option<Damping>], single: bool) -> Vec<Candidate> {
    let mut schemes: Vec<Scheme> = MethodId::ALL.iter().map(|m| Scheme::Method(*m)).collect();
    schemes.extend([Scheme::MeanVelocity, Scheme::PositionFirst]);
    schemes.extend(Tableau::ALL.into_iter().take(3).map(Scheme::Tableau));
    schemes.extend(Memory::ALL.map(Scheme::Memory));
    let mut all = Vec::new();
    for &precision in Precision::tried(single) {
        for &damping in damping {
            for &scheme in &schemes {
                let damped = damping.is_some();
                let plain = matches!(scheme, Scheme::Method(MethodId::SemiImplicitEuler | MethodId::ExplicitEuler));
                if damped && !plain && !damping.is_some_and(|d| d.rule.is_force()) {
                    continue;
                }
                all.push(candidate(Plan { scheme, force, damping, substeps: 1, frozen: false }, precision));
                let is_one_step = !matches!(scheme, Scheme::Memory(_));
                if !is_one_step || force == Force::None && !damped {
                    continue;
                }
                let constant = matches!(force, Force::Constant(_) | Force::None);
                if !constant {
                    all.push(candidate(Plan { scheme, force, damping, substeps: 1, frozen: true }, precision));
                }
                for substeps in [2, 3, 4, 8] {
                    let common =
                        matches!(scheme, Scheme::Method(MethodId::SemiImplicitEuler | MethodId::ExplicitEuler));
                    if common {
                        all.push(candidate(Plan { scheme, force, damping, substeps, frozen: false }, precision));
                        if !constant {
                            all.push(candidate(Plan { scheme, force, damping, substeps, frozen: true }, precision));
                        }
                    }
                }
            }
        }
    }
    all
}

fn candidate(plan: Plan, precision: Precision) -> Candidate {
    let mut id = plan.scheme.id().to_owned();
    if plan.substeps > 1 {
        id = format!("{id}, {} substeps", plan.substeps);
    }
    if plan.frozen {
        id += ", force held over the step";
    }
    if let Some(d) = plan.damping {
        id = format!("{id}, {}", d.name());
    }
    if precision == Precision::Single {
        id += ", f32";
    }
    let memory = matches!(plan.scheme, Scheme::Memory(_));
    let run = move |start: &Kin, h: f64, k: u64, rows: u64| match precision {
        Precision::Double => run::<f64>(plan, start, h, k, rows),
        Precision::Single => run::<f32>(plan, start, h, k, rows),
    };
    Candidate {
        id,
        memory,
        steps: plan.damping.and_then(|d| d.steps),
        damping: plan.damping.map(|d| d.c),
        substeps: plan.substeps,
        run: Box::new(run),
    }
}

fn run<T: Single>(plan: Plan, start: &Kin, h: f64, k: u64, rows: u64) -> Vec<Kin> {
    let drag = match plan.damping {
        Some(Damping { rule: Rule::Force, c, .. }) => Drag::Linear(c),
        Some(Damping { rule: Rule::QuadraticForce, c, .. }) => Drag::Quadratic(c),
        _ => Drag::None,
    };
    let point = Point { force: plan.force, drag };
    let mut s = State { q: start.x.map(T::lit), v: start.v.map(T::lit) };
    let kin = |s: &State<Vector3<T>>| Kin { x: s.q.map(Single::to_f64), v: s.v.map(Single::to_f64), ..*start };
    let mut out = Vec::with_capacity(rows as usize);
    if let Scheme::Memory(memory) = plan.scheme {
        let mut n = 0;
        memory.run(&point, T::lit(h), s, k * rows, |s| {
            n += 1;
            if n % k == 0 {
                out.push(kin(s));
            }
        });
        return out;
    }
    for _ in 0..rows {
        for _ in 0..k {
            let inner = h / f64::from(plan.substeps);
            let held = if plan.frozen {
                Point { force: Force::Constant(acceleration(plan.force, s.q).map(Single::to_f64)), drag }
            } else {
                point
            };
            for _ in 0..plan.substeps {
                s = step(plan, &held, inner, s);
            }
        }
        out.push(kin(&s));
    }
    out
}

struct Once<T: Single> {
    point: Point,
    h: T,
    s: State<Vector3<T>>,
}

impl<T: Single> Visitor<T, Point> for Once<T> {
    type Output = State<Vector3<T>>;
    fn visit<A: Method<T, Point>>(self, method: &A) -> Self::Output {
        method.step(&self.point, T::lit(0.0), self.h, self.s)
    }
}

fn step<T: Single>(plan: Plan, point: &Point, h: f64, s: State<Vector3<T>>) -> State<Vector3<T>> {
    let step = T::lit(h);
    let s = State { v: apply(plan.damping, When::Before, h, s.v), ..s };
    let mut next = match plan.scheme {
        Scheme::Method(method) => method.visit(Once { point: *point, h: step, s }),
        Scheme::Tableau(tableau) => tableau.step(point, T::lit(0.0), step, s),
        Scheme::MeanVelocity => {
            let v = s.v.add_scaled(integrator::Model::rate(point, step, &s), step);
            State { q: s.q.add_scaled((s.v + v) * T::lit(0.5), step), v }
        }
        Scheme::PositionFirst | Scheme::Memory(_) => {
            let q = s.q.add_scaled(s.v, step);
            State { q, v: s.v.add_scaled(integrator::Model::rate(point, step, &State { q, v: s.v }), step) }
        }
    };
    if plan.damping.is_some_and(|d| d.when == When::Between && !d.rule.is_force()) {
        next.v = apply(plan.damping, When::Between, h, next.v);
        if plan.scheme == Scheme::Method(MethodId::SemiImplicitEuler) {
            next.q = s.q.add_scaled(next.v, step);
        }
    }
    next.v = apply(plan.damping, When::After, h, next.v);
    next
}
