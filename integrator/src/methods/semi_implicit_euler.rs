use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::Space;

/// Semi-implicit (symplectic) Euler: v1 = v0 + h rate(t0, q0, v0), then q1 = q0 + h velocity(q0, v1). Order 1, one evaluation.
///
/// The velocity is kicked first, and the new velocity moves the configuration. Symplectic where the force does not depend
/// on the velocity. Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1.2 (1.9).
#[derive(Clone, Copy, Debug, Default)]
pub struct SemiImplicitEuler;

impl<T: Real, M: Model<T>> Method<T, M> for SemiImplicitEuler {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let v = m.kick(t, h, &s);
        State { q: s.q.retract(m.velocity(s.q, v), h), v }
    }
}
