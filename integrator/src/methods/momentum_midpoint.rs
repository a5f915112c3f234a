use crate::methods::facts::{Conserved, Facts};
use crate::model::{Method, Model, State};
use crate::pose::{Pose, Update, World};
use crate::real::Real;
use crate::rigid_body::{RigidBody, WorldMomentum};
use crate::space::{Space, Vector};

/// The angular momentum stored in the world frame, and the angular velocity taken at a midpoint attitude. Order 2, two
/// evaluations.
///
/// With omega(q, L) = R I^-1 R^T L: qm = q0 + (h/2) omega(q0, L0), Lm = L0 + (h/2) tau(t0, q0, L0), then
/// L1 = L0 + h tau(t0 + h/2, qm, Lm), q1 = q0 + h omega(qm, Lm); the translation by the same rule. Without a torque L is kept
/// exactly, as a vector, and a step of velocity Verlet on the same model is the same step.
/// Source: C. Runge, Math. Ann. 46 (1895) 167 (explicit midpoint); S. R. Buss, J. Comput. Phys. 164 (2000) 377 (L stored).
#[derive(Clone, Copy, Debug, Default)]
pub struct MomentumMidpoint;

impl MomentumMidpoint {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "momentum-midpoint",
        title: "Stored momentum, midpoint attitude",
        order: 2,
        evaluations: Some(2),
        reversible: Some(false),
        conserves: &[Conserved::Momentum],
        worked_out: true,
        formula: "qm = q0 exp(h omega(q0, L0) / 2), Lm = L0 + h tau0 / 2, L1 = L0 + h taum, q1 = q0 exp(h omega(qm, Lm))",
        latex: &[
            r"q_m = \exp(\tfrac{h}{2}\,\omega(q_0, L_0))\,q_0,\quad L_m = L_0 + \tfrac{h}{2}\,\tau_0",
            r"L_1 = L_0 + h\,\tau_m,\quad q_1 = \exp(h\,\omega(q_m, L_m))\,q_0",
        ],
        source: "C. Runge, Math. Ann. 46 (1895) 167; S. R. Buss, J. Comput. Phys. 164 (2000) 377",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, B: RigidBody<T>, U: Update<Frame = World>> Method<T, WorldMomentum<B, U>> for MomentumMidpoint {
    #[inline(always)]
    fn step(
        &self,
        m: &WorldMomentum<B, U>,
        t: T,
        h: T,
        s: State<Pose<T, U, B::Position>>,
    ) -> State<Pose<T, U, B::Position>> {
        let half = h * T::lit(0.5);
        let middle = State { q: s.q.retract(m.velocity(s.q, s.v), half), v: s.v.add_scaled(m.rate(t, &s), half) };
        State { q: s.q.retract(m.velocity(middle.q, middle.v), h), v: s.v.add_scaled(m.rate(t + half, &middle), h) }
    }
}
