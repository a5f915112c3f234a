use nalgebra::Matrix2;

use crate::methods::facts::{Facts, LinearTheory, Rational};
use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::Space;

/// Semi-implicit (symplectic) Euler: v1 = v0 + h rate(t0, q0, v0), then q1 = q0 + h velocity(q0, v1). Order 1, one evaluation.
///
/// The velocity is kicked first, and the new velocity moves the configuration. Symplectic where the force does not depend
/// on the velocity. Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1.2 (1.9).
#[derive(Clone, Copy, Debug, Default)]
pub struct SemiImplicitEuler;

impl SemiImplicitEuler {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "semi-implicit-euler",
        title: "Semi-implicit Euler",
        order: 1,
        evaluations: Some(1),
        symplectic: Some(true),
        reversible: Some(false),
        linear: Some(LinearTheory::Partitioned {
            velocity: Rational::polynomial(&[1.0, 1.0]),
            oscillator: |k, c| Matrix2::new(1.0 - k, 1.0 - c, -k, 1.0 - c),
        }),
        worked_out: true,
        formula: "v1 = v0 + h a(t0, q0, v0), q1 = q0 + h w(q0, v1)",
        latex: &[r"v_1 = v_0 + h\,a(t_0, q_0, v_0),\quad q_1 = q_0 + h\,v_1"],
        source: "E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1.2 (1.9)",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, M: Model<T>> Method<T, M> for SemiImplicitEuler {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let v = m.kick(t, h, &s);
        State { q: s.q.retract(m.velocity(s.q, v), h), v }
    }
}
