use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::Space;

/// Explicit (forward) Euler: q1 = q0 + h velocity(q0, v0), v1 = v0 + h rate(t0, q0, v0). Order 1, one evaluation.
///
/// Both updates read the state before the step. On a rotation, q + h v is q moved by the constant velocity v for h.
/// Source: L. Euler, Institutionum calculi integralis I (1768), section 650.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExplicitEuler;

impl<T: Real, M: Model<T>> Method<T, M> for ExplicitEuler {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        State { q: s.q.retract(m.velocity(s.q, s.v), h), v: m.kick(t, h, &s) }
    }
}
