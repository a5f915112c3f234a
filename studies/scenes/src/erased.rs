//! A scene's model of which only the space is known, in f64: what a method from outside is compiled for. There are five such
//! spaces and more than thirty scenes, and one virtual call an evaluation is no price where nothing is timed.

use integrator::counted::Counted;
use integrator::pose::Fixed;
use integrator::rigid_body::{BodyOmega, RigidBody, WorldOmega};
use integrator::{Method, Space, Vector};
use nalgebra::{SVector, Vector3};

use crate::motion::{Motion, RigidMotion};

/// The exact motion on a flat space of `N` dimensions.
pub type FlatMotion<'a, const N: usize> = &'a (dyn Motion<f64, Config = SVector<f64, N>> + 'a);

/// The exact motion of a rigid body whose position is a `P`.
pub type BodyMotion<'a, P> = &'a (dyn RigidMotion<f64, Position = P> + 'a);

/// A scene of which only the space is known.
#[derive(Clone, Copy)]
pub enum AnyMotion<'a> {
    /// One coordinate.
    One(FlatMotion<'a, 1>),
    /// Two coordinates.
    Two(FlatMotion<'a, 2>),
    /// Three coordinates.
    Three(FlatMotion<'a, 3>),
    /// Sixteen coordinates.
    Sixteen(FlatMotion<'a, 16>),
    /// A rigid body with a fixed point.
    Pivoted(BodyMotion<'a, Fixed<f64>>),
    /// A rigid body that flies.
    Flying(BodyMotion<'a, Vector3<f64>>),
}

/// A flat space on which a scene lives.
pub trait FlatSpace: Space<Scalar = f64> + Vector<f64> {
    /// Forgets all of a scene but its space.
    fn erase<'a>(motion: &'a (dyn Motion<f64, Config = Self> + 'a)) -> AnyMotion<'a>;
}

macro_rules! flat {
    ($($n:literal $name:ident),*) => {$(
        impl FlatSpace for SVector<f64, $n> {
            fn erase<'a>(motion: FlatMotion<'a, $n>) -> AnyMotion<'a> {
                AnyMotion::$name(motion)
            }
        }
    )*};
}
flat!(1 One, 2 Two, 3 Three, 16 Sixteen);

/// Where a rigid body may be.
pub trait Place: Vector<f64> {
    /// Forgets all of a body but the kind of its position.
    fn erase<'a>(motion: &'a (dyn RigidMotion<f64, Position = Self> + 'a)) -> AnyMotion<'a>;
}

impl Place for Fixed<f64> {
    fn erase<'a>(motion: BodyMotion<'a, Self>) -> AnyMotion<'a> {
        AnyMotion::Pivoted(motion)
    }
}

impl Place for Vector3<f64> {
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
    for<'a> Method<f64, FlatModel<'a, 1>>
    + for<'a> Method<f64, FlatModel<'a, 2>>
    + for<'a> Method<f64, FlatModel<'a, 3>>
    + for<'a> Method<f64, FlatModel<'a, 16>>
    + Sync
{
}

impl<A> OnFlatScenes for A where
    A: for<'a> Method<f64, FlatModel<'a, 1>>
        + for<'a> Method<f64, FlatModel<'a, 2>>
        + for<'a> Method<f64, FlatModel<'a, 3>>
        + for<'a> Method<f64, FlatModel<'a, 16>>
        + Sync
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
