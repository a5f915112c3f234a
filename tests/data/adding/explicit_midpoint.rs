use crate::methods::facts::Facts;
use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::{Space, Vector};

/// The explicit midpoint rule. Order 2, two evaluations.
///
/// With w = velocity(q, v), a = rate(t, q, v): (w2, a2) at (t0 + h/2, q0 + (h/2) w1, v0 + (h/2) a1), then q1 = q0 + h w2,
/// v1 = v0 + h a2.
/// Source: C. Runge, Math. Ann. 46 (1895) 167.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExplicitMidpoint;

impl ExplicitMidpoint {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "explicit-midpoint",
        title: "Explicit midpoint",
        order: 2,
        evaluations: Some(2),
        formula: "q1 = q0 + h w2, v1 = v0 + h a2, (w2, a2) at t0 + h / 2 after half a step of explicit Euler",
        latex: &[r"v_m = v_0 + \tfrac{h}{2}\,a_0,\quad q_1 = q_0 + h\,v_m,\quad v_1 = v_0 + h\,a_m"],
        source: "C. Runge, Math. Ann. 46 (1895) 167",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, M: Model<T>> Method<T, M> for ExplicitMidpoint {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let half = h * T::lit(0.5);
        let (w1, a1) = (m.velocity(s.q, s.v), m.rate(t, &s));
        let middle = State { q: s.q.retract(w1, half), v: s.v.add_scaled(a1, half) };
        let (w2, a2) = (m.velocity(middle.q, middle.v), m.rate(t + half, &middle));
        State { q: s.q.retract(w2, h), v: s.v.add_scaled(a2, h) }
    }
}
