use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::{Space, Vector};

/// Velocity Verlet (kick, drift, kick): a0 = rate(t0, q0, v0), u = v0 + (h/2) a0, q1 = q0 + h velocity(q_half, u),
/// a1 = rate(t1, q1, v0 + h a0), v1 = u + (h/2) a1. Order 2, two evaluations.
///
/// The second force is evaluated at v0 + h a0, which keeps order 2 where the force depends on the velocity. The drift
/// takes its velocity at q_half = q0 + (h/2) velocity(q0, u): where the velocity does not depend on q that is u, and no work.
/// Source: L. Verlet, Phys. Rev. 159 (1967) 98; W. Swope et al., J. Chem. Phys. 76 (1982) 637, eq. 7-8.
#[derive(Clone, Copy, Debug, Default)]
pub struct VelocityVerlet;

impl<T: Real, M: Model<T>> Method<T, M> for VelocityVerlet {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let half = h * T::lit(0.5);
        let a0 = m.rate(t, &s);
        let u = s.v.plus(a0, half);
        let q_half = s.q.retract(m.velocity(s.q, u), half);
        let q = s.q.retract(m.velocity(q_half, u), h);
        let a1 = m.rate(t + h, &State { q, v: s.v.plus(a0, h) });
        State { q, v: u.plus(a1, half) }
    }
}
