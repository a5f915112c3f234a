//! A scene's model of which only the kind of space is known, in f64: what a method from outside is compiled for. One virtual
//! call per evaluation costs nothing that matters where nothing is timed.
//!
//! There are two flat spaces, whatever the dimension of a scene: its coordinates are the first of [`FEW`] or of [`MANY`], and
//! the others stay zero. A method that works component by component, as every explicit one does, leaves the bits as they are.

use integrator::counted::Counted;
use integrator::pose::Fixed;
use integrator::rigid_body::{BodyOmega, RigidBody, WorldOmega};
use integrator::{Method, Model, Space, State, Vector};
use nalgebra::{SVector, Vector3};

use crate::motion::{Motion, RigidMotion};
use crate::observation::Observation;

/// Coordinates of the smaller flat space.
pub const FEW: usize = 4;
/// Coordinates of the larger flat space: no flat scene has more.
pub const MANY: usize = 64;

/// The exact motion on a flat space of `N` dimensions.
pub type FlatMotion<'a, const N: usize> = &'a (dyn Motion<f64, Config = SVector<f64, N>> + 'a);

/// The exact motion of a rigid body whose position is a `P`.
pub type BodyMotion<'a, P> = &'a (dyn RigidMotion<f64, Position = P> + 'a);

/// A scene of which only the kind of space is known.
pub enum AnyMotion<'a> {
    /// Up to [`FEW`] coordinates.
    Few(FlatScene<'a, FEW>),
    /// Up to [`MANY`] coordinates.
    Many(FlatScene<'a, MANY>),
    /// A rigid body with a fixed point.
    Pivoted(BodyMotion<'a, Fixed<f64>>),
    /// A rigid body that flies.
    Flying(BodyMotion<'a, Vector3<f64>>),
}

/// A flat scene whose coordinates are the first of `M`.
pub struct FlatScene<'a, const M: usize> {
    /// How many coordinates the scene has.
    pub dimension: usize,
    padded: Box<dyn Motion<f64, Config = SVector<f64, M>> + 'a>,
}

impl<const M: usize> FlatScene<'_, M> {
    /// The model and its exact motion.
    pub fn motion(&self) -> FlatMotion<'_, M> {
        self.padded.as_ref()
    }
}

/// A scene of `N` coordinates on a space of `M`.
struct Padded<'a, const N: usize, const M: usize>(FlatMotion<'a, N>);

fn resized<const N: usize, const M: usize>(x: SVector<f64, N>) -> SVector<f64, M> {
    SVector::from_fn(|i, _| x.get(i).copied().unwrap_or(0.0))
}

fn resized_state<const N: usize, const M: usize>(s: &State<SVector<f64, N>>) -> State<SVector<f64, M>> {
    State { q: resized(s.q), v: resized(s.v) }
}

impl<const N: usize, const M: usize> Model<f64> for Padded<'_, N, M> {
    type Config = SVector<f64, M>;

    fn rate(&self, t: f64, s: &State<Self::Config>) -> SVector<f64, M> {
        resized(self.0.rate(t, &resized_state(s)))
    }
    fn kick(&self, t: f64, h: f64, s: &State<Self::Config>) -> SVector<f64, M> {
        resized(self.0.kick(t, h, &resized_state(s)))
    }
    fn velocity(&self, q: SVector<f64, M>, v: SVector<f64, M>) -> SVector<f64, M> {
        resized(self.0.velocity(resized(q), resized(v)))
    }
    fn contact(&self, before: &State<Self::Config>, after: State<Self::Config>) -> State<Self::Config> {
        resized_state(&self.0.contact(&resized_state(before), resized_state(&after)))
    }
}

impl<const N: usize, const M: usize> Motion<f64> for Padded<'_, N, M> {
    fn exact(&self, t: f64) -> State<Self::Config> {
        resized_state(&self.0.exact(t))
    }
    fn observe(&self, s: &State<Self::Config>) -> Observation {
        self.0.observe(&resized_state(s))
    }
}

/// A flat space on which a scene lives.
pub trait FlatSpace: Vector<f64> + Space<Scalar = f64> {
    /// Forgets all of a scene but how many coordinates it has.
    fn erase<'a>(motion: &'a (dyn Motion<f64, Config = Self> + 'a)) -> AnyMotion<'a>;
}

impl<const N: usize> FlatSpace for SVector<f64, N> {
    fn erase<'a>(motion: FlatMotion<'a, N>) -> AnyMotion<'a> {
        const { assert!(N <= MANY, "a flat scene has at most erased::MANY coordinates") };
        if N <= FEW {
            AnyMotion::Few(FlatScene { dimension: N, padded: Box::new(Padded(motion)) })
        } else {
            AnyMotion::Many(FlatScene { dimension: N, padded: Box::new(Padded(motion)) })
        }
    }
}

/// Where a rigid body may be.
pub trait ErasedPlace: Vector<f64> {
    /// Forgets all of a body but the kind of its position.
    fn erase<'a>(motion: &'a (dyn RigidMotion<f64, Position = Self> + 'a)) -> AnyMotion<'a>;
}

impl ErasedPlace for Fixed<f64> {
    fn erase<'a>(motion: BodyMotion<'a, Self>) -> AnyMotion<'a> {
        AnyMotion::Pivoted(motion)
    }
}

impl ErasedPlace for Vector3<f64> {
    fn erase<'a>(motion: BodyMotion<'a, Self>) -> AnyMotion<'a> {
        AnyMotion::Flying(motion)
    }
}

/// What a method from outside steps on a flat space.
pub type FlatModel<'a, const N: usize> = Counted<FlatMotion<'a, N>>;

/// The body that a method from outside turns.
pub type ErasedBody<'a, P> = Counted<&'a (dyn RigidBody<f64, Position = P> + 'a)>;

/// A method for every flat scene: whatever is `impl<T: Real, M: Model<T>> Method<T, M>`.
pub trait OnFlatScenes:
    for<'a> Method<f64, FlatModel<'a, FEW>> + for<'a> Method<f64, FlatModel<'a, MANY>> + Sync
{
}

impl<A> OnFlatScenes for A where
    A: for<'a> Method<f64, FlatModel<'a, FEW>> + for<'a> Method<f64, FlatModel<'a, MANY>> + Sync
{
}

/// A method for every rigid body that stores its angular velocity in the world frame.
pub trait OnWorldOmega:
    for<'a> Method<f64, WorldOmega<ErasedBody<'a, Fixed<f64>>>>
    + for<'a> Method<f64, WorldOmega<ErasedBody<'a, Vector3<f64>>>>
    + Sync
{
}

impl<A> OnWorldOmega for A where
    A: for<'a> Method<f64, WorldOmega<ErasedBody<'a, Fixed<f64>>>>
        + for<'a> Method<f64, WorldOmega<ErasedBody<'a, Vector3<f64>>>>
        + Sync
{
}

/// A method for every rigid body that stores its angular velocity in the body frame.
pub trait OnBodyOmega:
    for<'a> Method<f64, BodyOmega<ErasedBody<'a, Fixed<f64>>>>
    + for<'a> Method<f64, BodyOmega<ErasedBody<'a, Vector3<f64>>>>
    + Sync
{
}

impl<A> OnBodyOmega for A where
    A: for<'a> Method<f64, BodyOmega<ErasedBody<'a, Fixed<f64>>>>
        + for<'a> Method<f64, BodyOmega<ErasedBody<'a, Vector3<f64>>>>
        + Sync
{
}
