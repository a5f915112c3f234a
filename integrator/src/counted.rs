//! Counting evaluations exactly, machine-independently.

use std::cell::Cell;

use nalgebra::Vector3;

use crate::model::{Model, State, Tangent};
use crate::real::Real;
use crate::rigid_body::{Kinematics, RigidBody, Torque};

/// A model (or a body) that counts how often its force law is evaluated.
#[derive(Debug, Default)]
pub struct Counted<M> {
    /// What is counted.
    pub inner: M,
    evaluations: Cell<u64>,
}

impl<M> Counted<M> {
    /// Counts from zero.
    pub fn new(inner: M) -> Self {
        Counted { inner, evaluations: Cell::new(0) }
    }

    /// Evaluations so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    fn count(&self) {
        self.evaluations.set(self.evaluations.get() + 1);
    }
}

impl<T: Real, M: Model<T>> Model<T> for Counted<M> {
    type Config = M::Config;

    fn rate(&self, t: T, s: &State<M::Config>) -> Tangent<Self, T> {
        self.count();
        self.inner.rate(t, s)
    }
    fn kick(&self, t: T, h: T, s: &State<M::Config>) -> Tangent<Self, T> {
        self.count();
        self.inner.kick(t, h, s)
    }
    fn velocity(&self, q: M::Config, v: Tangent<Self, T>) -> Tangent<Self, T> {
        self.inner.velocity(q, v)
    }
    fn contact(&self, before: &State<M::Config>, after: State<M::Config>) -> State<M::Config> {
        self.inner.contact(before, after)
    }
}

impl<T: Real, B: RigidBody<T>> RigidBody<T> for Counted<B> {
    type Position = B::Position;

    fn inertia(&self) -> Vector3<T> {
        self.inner.inertia()
    }
    fn torque(&self, t: T, at: &Kinematics<T, B::Position>) -> Torque<T> {
        self.count();
        self.inner.torque(t, at)
    }
    fn acceleration(&self, t: T, at: &Kinematics<T, B::Position>) -> B::Position {
        self.inner.acceleration(t, at)
    }
}
