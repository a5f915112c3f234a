//! [`State`], [`Model`] and [`Method`]: what moves, by which law, by which rule.

use crate::real::Real;
use crate::space::{Space, Vector};

/// The tangent of a model's configuration space.
pub type Tangent<M, T> = <<M as Model<T>>::Config as Space>::Tangent;

/// Configuration and stored velocity at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<Q: Space> {
    /// Configuration: positions in m, angles in rad, an attitude.
    pub q: Q,
    /// What the model stores beside it: a velocity, or a momentum that [`Model::velocity`] turns into one.
    pub v: Q::Tangent,
}

impl<Q: Space> State<Q> {
    /// Whether every number of the state is finite.
    #[inline(always)]
    pub fn is_finite(&self) -> bool {
        self.q.is_finite() && self.v.is_finite()
    }

    /// [`Space::settled`] of the configuration.
    #[inline(always)]
    #[must_use]
    pub fn settled(self) -> Self {
        State { q: self.q.settled(), v: self.v }
    }
}

/// A law of motion: q' = velocity(q, v), v' = rate(t, q, v).
pub trait Model<T: Real> {
    /// Where configurations live.
    type Config: Space<Scalar = T>;

    /// dv/dt.
    fn rate(&self, t: T, s: &State<Self::Config>) -> Tangent<Self, T>;

    /// v + h rate(t, q, v): the kick of both Eulers. A model may write it out where that saves a multiplication, as
    /// v + (h c) q for a rate c q.
    #[inline(always)]
    fn kick(&self, t: T, h: T, s: &State<Self::Config>) -> Tangent<Self, T> {
        s.v.add_scaled(self.rate(t, s), h)
    }

    /// The velocity of the configuration: v itself, unless what is stored is a momentum.
    #[inline(always)]
    fn velocity(&self, _q: Self::Config, v: Tangent<Self, T>) -> Tangent<Self, T> {
        v
    }

    /// An instantaneous change at the end of a step, which no rate can tell: a bounce. The driver applies it to every
    /// step, from the state `before` it to the state `after` it; the methods do not know of it.
    #[inline(always)]
    fn contact(&self, _before: &State<Self::Config>, after: State<Self::Config>) -> State<Self::Config> {
        after
    }
}

/// A rule of a step: the state at t + h from the state at t.
pub trait Method<T: Real, M: Model<T>> {
    /// One step, the first of a run. A step that cannot be taken (an iteration that does not converge) returns a non-finite
    /// state.
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config>;

    /// The steps of one run, as the drivers take them. A method with a memory keeps it there, so that every run starts with
    /// none; of a one-step method each is [`Self::step`].
    #[inline(always)]
    fn stepper<'a>(&'a self, m: &'a M) -> impl Steps<T, M> + 'a
    where
        Self: Sized,
        T: 'a,
    {
        OneStep { method: self, model: m }
    }
}

/// The steps of one run, one after the other, and what is remembered between them.
///
/// A trait of its own and not a closure: what the compiler does not inline costs a step of a rigid body twice its time.
pub trait Steps<T: Real, M: Model<T>>: Clone {
    /// The next step.
    fn next(&mut self, t: T, h: T, s: State<M::Config>) -> State<M::Config>;
}

/// The steps of a method without a memory.
struct OneStep<'a, A, M> {
    method: &'a A,
    model: &'a M,
}

impl<A, M> Clone for OneStep<'_, A, M> {
    #[inline(always)]
    fn clone(&self) -> Self {
        OneStep { method: self.method, model: self.model }
    }
}

impl<T: Real, M: Model<T>, A: Method<T, M>> Steps<T, M> for OneStep<'_, A, M> {
    #[inline(always)]
    fn next(&mut self, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        self.method.step(self.model, t, h, s)
    }
}

impl<T: Real, M: Model<T> + ?Sized> Model<T> for &M {
    type Config = M::Config;

    #[inline(always)]
    fn rate(&self, t: T, s: &State<Self::Config>) -> Tangent<Self, T> {
        (**self).rate(t, s)
    }
    #[inline(always)]
    fn kick(&self, t: T, h: T, s: &State<Self::Config>) -> Tangent<Self, T> {
        (**self).kick(t, h, s)
    }
    #[inline(always)]
    fn velocity(&self, q: Self::Config, v: Tangent<Self, T>) -> Tangent<Self, T> {
        (**self).velocity(q, v)
    }
    #[inline(always)]
    fn contact(&self, before: &State<Self::Config>, after: State<Self::Config>) -> State<Self::Config> {
        (**self).contact(before, after)
    }
}
