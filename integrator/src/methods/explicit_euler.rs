use crate::methods::facts::{Facts, LinearTheory, Rational};
use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::Space;

/// Explicit (forward) Euler: q1 = q0 + h velocity(q0, v0), v1 = v0 + h rate(t0, q0, v0). Order 1, one evaluation.
///
/// Both updates read the state before the step. On a rotation, q + h v is q moved by the constant velocity v for h.
/// Source: L. Euler, Institutionum calculi integralis I (1768), section 650.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExplicitEuler;

impl ExplicitEuler {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "explicit-euler",
        title: "Explicit Euler",
        order: 1,
        evaluations: Some(1),
        symplectic: Some(false),
        reversible: Some(false),
        linear: Some(LinearTheory::RungeKutta(Rational::polynomial(&[1.0, 1.0]))),
        worked_out: true,
        formula: "q1 = q0 + h w(q0, v0), v1 = v0 + h a(t0, q0, v0)",
        latex: &[r"q_1 = q_0 + h\,v_0,\quad v_1 = v_0 + h\,a(t_0, q_0, v_0)"],
        source: "L. Euler, Institutionum calculi integralis I (1768), section 650",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, M: Model<T>> Method<T, M> for ExplicitEuler {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        State { q: s.q.retract(m.velocity(s.q, s.v), h), v: m.kick(t, h, &s) }
    }
}
