use crate::methods::facts::{Facts, LinearTheory, Rational};
use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::{Space, Vector};

/// Kutta's method of third order, on a curved space in Munthe-Kaas's form. Order 3, three evaluations.
///
/// With w = velocity(q, v), a = rate(t, q, v) at the stages t0, t0 + h/2, t0 + h: stage 2 starts from q0 + (h/2) w1,
/// v0 + (h/2) a1, stage 3 from q0 + h (2 k2 - w1), v0 + h (2 a2 - a1) with k2 = w2 - (h/4) [w1, w2]; then
/// q1 = q0 + (h/6) (w1 + 4 k2 + k3), k3 = w3 - (h/2) [2 w2 - w1, w3], v1 = v0 + (h/6) (a1 + 4 a2 + a3).
/// On a flat space the brackets vanish. Source: W. Kutta, Z. Math. Phys. 46 (1901) 435; H. Munthe-Kaas, BIT 38 (1998) 92.
#[derive(Clone, Copy, Debug, Default)]
pub struct Kutta3;

impl Kutta3 {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "kutta3",
        title: "Kutta, third order",
        order: 3,
        evaluations: Some(3),
        symplectic: Some(false),
        reversible: Some(false),
        linear: Some(LinearTheory::RungeKutta(Rational::polynomial(&[1.0, 1.0, 0.5, 1.0 / 6.0]))),
        formula: "q1 = q0 + h (w1 + 4 k2 + k3) / 6, v1 = v0 + h (a1 + 4 a2 + a3) / 6, stages at 0, h/2, h",
        latex: &[
            r"a_1 = a(t_0, q_0, v_0),\quad w_1 = v_0",
            r"a_2 = a(t_0 + \tfrac{h}{2}, q_0 + \tfrac{h}{2} w_1, v_0 + \tfrac{h}{2} a_1),\quad w_2 = v_0 + \tfrac{h}{2} a_1",
            r"a_3 = a(t_1, q_0 + h (2 w_2 - w_1), v_0 + h (2 a_2 - a_1)),\quad w_3 = v_0 + h (2 a_2 - a_1)",
            r"q_1 = q_0 + \tfrac{h}{6} (w_1 + 4 w_2 + w_3),\quad v_1 = v_0 + \tfrac{h}{6} (a_1 + 4 a_2 + a_3)",
        ],
        source: "W. Kutta, Z. Math. Phys. 46 (1901) 435; on rotations H. Munthe-Kaas, BIT 38 (1998) 92",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, M: Model<T>> Method<T, M> for Kutta3 {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let (half, two) = (h * T::lit(0.5), T::lit(2.0));
        let (w1, a1) = (m.velocity(s.q, s.v), m.rate(t, &s));

        let s2 = State { q: s.q.retract(w1, half), v: s.v.add_scaled(a1, half) };
        let (w2, a2) = (m.velocity(s2.q, s2.v), m.rate(t + half, &s2));
        let k2 = M::Config::plus_bracket(w2, h * T::lit(-0.25), w1, w2);

        let s3 =
            State { q: s.q.retract((-w1).add_scaled(k2, two), h), v: s.v.add_scaled((-a1).add_scaled(a2, two), h) };
        let (w3, a3) = (m.velocity(s3.q, s3.v), m.rate(t + h, &s3));
        let k3 = M::Config::plus_bracket(w3, -half, (-w1).add_scaled(w2, two), w3);

        let sixth = h / T::lit(6.0);
        let four = T::lit(4.0);
        State {
            q: s.q.retract((w1 + k3).add_scaled(k2, four), sixth),
            v: s.v.add_scaled((a1 + a3).add_scaled(a2, four), sixth),
        }
    }
}
