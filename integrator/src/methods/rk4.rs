use crate::methods::facts::{Facts, LinearTheory, Rational};
use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::{Space, Vector};

/// The classical Runge-Kutta method, on a curved space in Munthe-Kaas's form. Order 4, four evaluations.
///
/// With w = velocity(q, v), a = rate(t, q, v) at the stages t0, t0 + h/2 (twice), t0 + h:
/// q1 = q0 + h/6 (w1 + 2 w2 + 2 w3 + w4 - (h/2) [w1, w4]), v1 = v0 + h/6 (a1 + 2 a2 + 2 a3 + a4), and stage 3 starts from
/// q0 + (h/2) (w2 - (h/4) [w1, w2]). On a flat space the brackets vanish; without them the order on SO(3) falls to 2.
/// Source: W. Kutta, Z. Math. Phys. 46 (1901) 435; H. Munthe-Kaas and B. Owren, Phil. Trans. R. Soc. A 357 (1999) 957,
/// example with two commutators.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rk4;

impl Rk4 {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "rk4",
        title: "RK4",
        order: 4,
        evaluations: Some(4),
        symplectic: Some(false),
        reversible: Some(false),
        linear: Some(LinearTheory::RungeKutta(Rational::polynomial(&[1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0]))),
        worked_out: true,
        formula: "q1 = q0 + h (w1 + 2 w2 + 2 w3 + w4 - h [w1, w4] / 2) / 6, v1 = v0 + h (a1 + 2 a2 + 2 a3 + a4) / 6",
        latex: &[
            r"a_1 = a(t_0, q_0, v_0),\quad w_1 = v_0",
            r"a_2 = a(t_0 + \tfrac{h}{2}, q_0 + \tfrac{h}{2} w_1, v_0 + \tfrac{h}{2} a_1),\quad w_2 = v_0 + \tfrac{h}{2} a_1",
            r"a_3 = a(t_0 + \tfrac{h}{2}, q_0 + \tfrac{h}{2} (w_2 - \tfrac{h}{4} [w_1, w_2]), v_0 + \tfrac{h}{2} a_2),\quad w_3 = v_0 + \tfrac{h}{2} a_2",
            r"a_4 = a(t_1, q_0 + h w_3, v_0 + h a_3),\quad w_4 = v_0 + h a_3",
            r"q_1 = q_0 + \tfrac{h}{6} (w_1 + 2 w_2 + 2 w_3 + w_4 - \tfrac{h}{2} [w_1, w_4]),\quad v_1 = v_0 + \tfrac{h}{6} (a_1 + 2 a_2 + 2 a_3 + a_4)",
        ],
        source: "W. Kutta, Z. Math. Phys. 46 (1901) 435; on rotations H. Munthe-Kaas, B. Owren, Phil. Trans. R. Soc. A 357 (1999) 957",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, M: Model<T>> Method<T, M> for Rk4 {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let half = h * T::lit(0.5);
        let two = T::lit(2.0);
        let (w1, a1) = (m.velocity(s.q, s.v), m.rate(t, &s));

        let s2 = State { q: s.q.retract(w1, half), v: s.v.add_scaled(a1, half) };
        let (w2, a2) = (m.velocity(s2.q, s2.v), m.rate(t + half, &s2));

        let w2_corrected = M::Config::plus_bracket(w2, h * T::lit(-0.25), w1, w2);
        let s3 = State { q: s.q.retract(w2_corrected, half), v: s.v.add_scaled(a2, half) };
        let (w3, a3) = (m.velocity(s3.q, s3.v), m.rate(t + half, &s3));

        let s4 = State { q: s.q.retract(w3, h), v: s.v.add_scaled(a3, h) };
        let (w4, a4) = (m.velocity(s4.q, s4.v), m.rate(t + h, &s4));

        let w = M::Config::plus_bracket((w1 + w4).add_scaled(w2 + w3, two), -half, w1, w4);
        let a = (a1 + a4).add_scaled(a2 + a3, two);
        let sixth = h / T::lit(6.0);
        State { q: s.q.retract(w, sixth), v: s.v.add_scaled(a, sixth) }
    }
}
