use crate::methods::facts::{Facts, LinearTheory, Rational};
use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::{Space, Vector};

/// Heun's method, the explicit trapezoidal rule. Order 2, two evaluations.
///
/// With w = velocity(q, v), a = rate(t, q, v): (w1, a1) at (t0, q0, v0), (w2, a2) at (t0 + h, q0 + h w1, v0 + h a1), then
/// q1 = q0 + (h/2) (w1 + w2), v1 = v0 + (h/2) (a1 + a2). On a rotation the bracket that is left out is of third order.
/// Source: K. Heun, Z. Math. Phys. 45 (1900) 23; E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I
/// (1993), II.1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Heun;

impl Heun {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "heun",
        title: "Heun",
        order: 2,
        evaluations: Some(2),
        symplectic: Some(false),
        reversible: Some(false),
        linear: Some(LinearTheory::RungeKutta(Rational::polynomial(&[1.0, 1.0, 0.5]))),
        formula: "q1 = q0 + h (w1 + w2) / 2, v1 = v0 + h (a1 + a2) / 2, (w2, a2) at t0 + h after explicit Euler",
        latex: &[
            r"a_1 = a(t_0, q_0, v_0),\quad a_2 = a(t_1, q_0 + h\,v_0, v_0 + h\,a_1)",
            r"q_1 = q_0 + \tfrac{h}{2}\,(v_0 + (v_0 + h\,a_1)),\quad v_1 = v_0 + \tfrac{h}{2}\,(a_1 + a_2)",
        ],
        source: "K. Heun, Z. Math. Phys. 45 (1900) 23",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, M: Model<T>> Method<T, M> for Heun {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let half = h * T::lit(0.5);
        let (w1, a1) = (m.velocity(s.q, s.v), m.rate(t, &s));
        let s2 = State { q: s.q.retract(w1, h), v: s.v.add_scaled(a1, h) };
        let (w2, a2) = (m.velocity(s2.q, s2.v), m.rate(t + h, &s2));
        State { q: s.q.retract(w1 + w2, half), v: s.v.add_scaled(a1 + a2, half) }
    }
}
