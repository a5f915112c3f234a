use crate::methods::facts::{Facts, LinearTheory, Rational};
use crate::model::{Method, Model, State};
use crate::newton::{Pair, crossing_speed, no_solution, solve};
use crate::real::Single;
use crate::space::{Space, Vector};

/// Implicit (backward) Euler: v1 = v0 + h rate(t1, q1, v1), q1 = q0 + h velocity(q1, v1). Order 1; Newton's iteration.
///
/// Where the iteration does not converge the state becomes NaN, which the driver reports.
/// Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), IV.1 (1.10).
#[derive(Clone, Copy, Debug, Default)]
pub struct ImplicitEuler;

impl ImplicitEuler {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "implicit-euler",
        title: "Implicit Euler",
        order: 1,
        implicit: true,
        symplectic: Some(false),
        reversible: Some(false),
        linear: Some(LinearTheory::RungeKutta(Rational { numerator: &[1.0], denominator: &[1.0, -1.0] })),
        worked_out: true,
        formula: "v1 = v0 + h a(t1, q1, v1), q1 = q0 + h w(q1, v1)",
        latex: &[r"v_1 = v_0 + h\,a(t_1, q_1, v_1),\quad q_1 = q_0 + h\,v_1"],
        source: "E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), IV.1 (1.10)",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Single, M: Model<T>> Method<T, M> for ImplicitEuler {
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let guess = Pair { w: m.velocity(s.q, s.v), v: s.v.add_scaled(m.rate(t, &s), h) };
        let end = |z: &Pair<_>| State { q: s.q.retract(z.w, h), v: z.v };
        let solution = solve::<T, _>(guess, crossing_speed(&s.q, h), &|z| {
            let s1 = end(z);
            Pair { w: z.w - m.velocity(s1.q, s1.v), v: z.v - s.v.add_scaled(m.rate(t + h, &s1), h) }
        });
        end(&solution.unwrap_or(Pair { w: no_solution(), v: no_solution() }))
    }
}
