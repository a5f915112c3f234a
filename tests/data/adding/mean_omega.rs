use crate::methods::facts::Facts;
use crate::model::{Method, Model, State};
use crate::pose::{Body, Pose, Update};
use crate::real::Real;
use crate::rigid_body::{BodyOmega, RigidBody};
use crate::space::{Space, Vector};

/// v1 = v0 + h rate(t0, q0, v0), q1 = q0 exp(h (v0 + v1) / 2). Order 1, one evaluation.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeanOmega;

impl MeanOmega {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "mean-omega",
        title: "Mean angular velocity",
        order: 1,
        evaluations: Some(1),
        formula: "omega1 = omega0 + h omega0', q1 = q0 exp(h (omega0 + omega1) / 2)",
        latex: &[r"\omega_1 = \omega_0 + h\,\dot\omega_0,\quad q_1 = q_0\exp(\tfrac{h}{2}\,(\omega_0 + \omega_1))"],
        source: "README of this workspace",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, B: RigidBody<T>, U: Update<Frame = Body>> Method<T, BodyOmega<B, U>> for MeanOmega {
    fn step(
        &self,
        m: &BodyOmega<B, U>,
        t: T,
        h: T,
        s: State<Pose<T, U, B::Position>>,
    ) -> State<Pose<T, U, B::Position>> {
        let v = s.v.add_scaled(m.rate(t, &s), h);
        State { q: s.q.retract((s.v + v) * T::lit(0.5), h), v }
    }
}
