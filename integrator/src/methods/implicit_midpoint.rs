use crate::methods::facts::{Facts, LinearTheory, Rational};
use crate::model::{Method, Model, State};
use crate::newton::{Pair, crossing_speed, no_solution, solve};
use crate::real::Single;
use crate::space::{Space, Vector};

/// Implicit midpoint: with vm = (v0 + v1) / 2, qm = q0 + (h/2) w and w = velocity(qm, vm), v1 = v0 + h rate(t0 + h/2, qm, vm)
/// and q1 = q0 + h w. Order 2, symmetric; Newton's iteration.
///
/// Conserves every quadratic invariant of a flat space exactly. Where the iteration does not converge the state becomes NaN,
/// which the driver reports. Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1.1 (1.7).
#[derive(Clone, Copy, Debug, Default)]
pub struct ImplicitMidpoint;

impl ImplicitMidpoint {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "implicit-midpoint",
        title: "Implicit midpoint",
        order: 2,
        implicit: true,
        symplectic: Some(true),
        reversible: Some(true),
        linear: Some(LinearTheory::RungeKutta(Rational { numerator: &[1.0, 0.5], denominator: &[1.0, -0.5] })),
        worked_out: true,
        formula: "vm = (v0 + v1) / 2, qm = q0 + h w(qm, vm) / 2, v1 = v0 + h a(t0 + h/2, qm, vm), q1 = q0 + h w(qm, vm)",
        latex: &[
            r"v_m = \tfrac12\,(v_0 + v_1),\quad q_m = q_0 + \tfrac{h}{2}\,v_m",
            r"v_1 = v_0 + h\,a(t_0 + \tfrac{h}{2}, q_m, v_m),\quad q_1 = q_0 + h\,v_m",
        ],
        source: "E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1.1 (1.7)",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Single, M: Model<T>> Method<T, M> for ImplicitMidpoint {
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let half = h * T::lit(0.5);
        let guess = Pair { w: m.velocity(s.q, s.v), v: s.v.add_scaled(m.rate(t, &s), half) };
        // The unknown is the middle of the step: w, and vm.
        let solution = solve::<T, _>(guess, crossing_speed(&s.q, h), &|z| {
            let middle = State { q: s.q.retract(z.w, half), v: z.v };
            let w = m.velocity(middle.q, middle.v);
            Pair { w: z.w - w, v: z.v - s.v.add_scaled(m.rate(t + half, &middle), half) }
        });
        let z = solution.unwrap_or(Pair { w: no_solution(), v: no_solution() });
        State { q: s.q.retract(z.w, h), v: z.v + (z.v - s.v) }
    }
}
