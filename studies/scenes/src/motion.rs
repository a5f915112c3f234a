//! A law of motion together with its exact motion, in any arithmetic.

use faer::fx128;
use integrator::rigid_body::{Kinematics, RigidBody, RigidModel, WorldOmega};
use integrator::{Model, Single, State};
use nalgebra::SMatrix;

use crate::observation::Observation;

/// A model with its exact motion in the arithmetic `T`.
pub trait Motion<T: Single>: Model<T> {
    /// The exact state at the time `t`, in what the model stores.
    fn exact(&self, t: T) -> State<Self::Config>;
    /// What can be seen of a state.
    fn observe(&self, s: &State<Self::Config>) -> Observation;
}

/// A state that was computed in double-double, rounded once. Exact motions are evaluated so in every arithmetic: the truth
/// then has no rounding but the last, whatever the time and however the formula is conditioned.
pub(crate) fn rounded<T: Single, const R: usize, const C: usize>(
    q: SMatrix<fx128, R, C>,
    v: SMatrix<fx128, R, C>,
) -> State<SMatrix<T, R, C>> {
    State { q: q.map(T::narrow), v: v.map(T::narrow) }
}

/// A rigid body with its exact motion in the arithmetic `T`.
pub trait RigidMotion<T: Single>: RigidBody<T> {
    /// The exact motion at the time `t`.
    fn exact(&self, t: T) -> Kinematics<T, Self::Position>;
}

/// The model whose equation of motion a rigid body's exact motion is held against.
impl<T: Single, B: RigidMotion<T>> Motion<T> for WorldOmega<&B> {
    fn exact(&self, t: T) -> State<Self::Config> {
        self.state(&self.0.exact(t))
    }
    fn observe(&self, s: &State<Self::Config>) -> Observation {
        Observation::of_body(self, s)
    }
}
