//! The rigid body: one physics ([`RigidBody`]), several models of it that differ in the angular quantity they store.
//!
//! L = I_w omega with I_w = R I R^T; dL/dt = tau. In the world frame I_w omega' = tau - omega x (I_w omega), in the body
//! frame I omega' = tau - omega x (I omega). What is stored is a choice of model, and it changes what a method conserves.

use std::marker::PhantomData;

use nalgebra::Vector3;

use crate::model::{Model, State};
use crate::pose::{Body, Exponential, Frame, Pose, Twist, Update, World};
use crate::real::Real;
use crate::rotation::{Rotation, cross};
use crate::space::Vector;

/// A torque about the centre of mass (or about the fixed point), N m, in the frame in which the physics gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Torque<T: Real> {
    /// No torque, and no arithmetic for it.
    None,
    /// World components.
    World(Vector3<T>),
    /// Body components.
    Body(Vector3<T>),
}

impl<T: Real> Torque<T> {
    /// `rest + torque`, in world components.
    #[inline(always)]
    pub fn plus_in_world(self, attitude: Rotation<T>, rest: Vector3<T>) -> Vector3<T> {
        match self {
            Torque::None => rest,
            Torque::World(torque) => rest + torque,
            Torque::Body(torque) => rest + attitude.rotate(torque),
        }
    }

    /// `rest + torque`, in body components.
    #[inline(always)]
    pub fn plus_in_body(self, attitude: Rotation<T>, rest: Vector3<T>) -> Vector3<T> {
        match self {
            Torque::None => rest,
            Torque::World(torque) => rest + attitude.rotate_back(torque),
            Torque::Body(torque) => rest + torque,
        }
    }
}

/// What the loads of a body may depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics<T: Real, P> {
    /// Centre of mass, world frame, m.
    pub position: P,
    /// Its velocity, world frame, m/s.
    pub velocity: P,
    /// Body to world.
    pub attitude: Rotation<T>,
    /// Angular velocity, body frame, rad/s.
    pub omega_body: Vector3<T>,
}

/// The physics of one rigid body, whatever a model stores of it.
pub trait RigidBody<T: Real> {
    /// `Vector3<T>`, or [`Fixed`](crate::pose::Fixed) where a point of the body is held.
    type Position: Vector<T>;

    /// Principal moments of inertia along the body axes, kg m^2.
    fn inertia(&self) -> Vector3<T>;

    /// The applied torque. The gyroscopic term is not part of it.
    fn torque(&self, t: T, at: &Kinematics<T, Self::Position>) -> Torque<T>;

    /// Force / mass, world frame, m/s^2.
    #[inline(always)]
    fn acceleration(&self, _t: T, _at: &Kinematics<T, Self::Position>) -> Self::Position {
        Self::Position::zero()
    }
}

/// Stores the angular velocity in the world frame: omega' = I_w^-1 (tau - omega x I_w omega).
#[derive(Clone, Copy, Debug)]
pub struct WorldOmega<B, U = Exponential<World>>(pub B, PhantomData<U>);

/// Stores the angular velocity in the body frame: omega' = I^-1 (tau - omega x I omega). No R I R^T anywhere.
#[derive(Clone, Copy, Debug)]
pub struct BodyOmega<B, U = Exponential<Body>>(pub B, PhantomData<U>);

/// Stores the angular momentum in the world frame: L' = tau, omega = I_w^-1 L. The gyroscopic term is in the kinematics.
#[derive(Clone, Copy, Debug)]
pub struct WorldMomentum<B, U = Exponential<World>>(pub B, PhantomData<U>);

/// The starting description, as printed: I_w^-1 = R I^-1 R^T, omega' = I_w^-1 tau, without the gyroscopic term. It is
/// consistent only where omega x I omega vanishes: spheres, and spin and torque about one principal axis.
#[derive(Clone, Copy, Debug)]
pub struct WithoutGyroscopicTerm<B, U = Exponential<World>>(pub B, PhantomData<U>);

macro_rules! constructor {
    ($($model:ident),*) => {$(
        impl<B, U> $model<B, U> {
            /// The model of a body.
            pub fn new(body: B) -> Self {
                $model(body, PhantomData)
            }
        }
    )*};
}
constructor!(WorldOmega, BodyOmega, WorldMomentum, WithoutGyroscopicTerm);

/// Which angular quantity a model of a rigid body stores.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Formulation {
    /// [`WorldOmega`].
    #[default]
    WorldOmega,
    /// [`BodyOmega`].
    BodyOmega,
    /// [`WorldMomentum`].
    WorldMomentum,
    /// [`WithoutGyroscopicTerm`].
    WithoutGyroscopicTerm,
}

impl Formulation {
    /// Every one.
    pub const ALL: [Formulation; 4] = [
        Formulation::WorldOmega,
        Formulation::BodyOmega,
        Formulation::WorldMomentum,
        Formulation::WithoutGyroscopicTerm,
    ];

    /// The name on the command line and in tables.
    pub fn id(self) -> &'static str {
        match self {
            Formulation::WorldOmega => "world-omega",
            Formulation::BodyOmega => "body-omega",
            Formulation::WorldMomentum => "world-momentum",
            Formulation::WithoutGyroscopicTerm => "without-gyroscopic-term",
        }
    }
}

/// How the attitude is advanced by an angular velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum AttitudeUpdate {
    /// [`Exponential`].
    #[default]
    Exponential,
    /// [`Linear`](crate::pose::Linear).
    Linear,
}

impl AttitudeUpdate {
    /// Every one.
    pub const ALL: [AttitudeUpdate; 2] = [AttitudeUpdate::Exponential, AttitudeUpdate::Linear];

    /// The name on the command line and in tables.
    pub fn id(self) -> &'static str {
        match self {
            AttitudeUpdate::Exponential => "exponential",
            AttitudeUpdate::Linear => "linear",
        }
    }
}

/// A model of a rigid body, whatever it stores.
pub trait RigidModel<T: Real>:
    Model<T, Config = Pose<T, Self::Update, <Self::Body as RigidBody<T>>::Position>>
{
    /// The physics.
    type Body: RigidBody<T>;
    /// Frame of the angular velocity, and how it advances the attitude.
    type Update: Update;

    /// The physics.
    fn body(&self) -> &Self::Body;

    /// What is stored of a body with this attitude and angular velocity.
    fn stored(&self, attitude: Rotation<T>, omega_body: Vector3<T>) -> Vector3<T>;

    /// The state of a body that moves like this.
    #[inline(always)]
    fn state(&self, at: &Kinematics<T, <Self::Body as RigidBody<T>>::Position>) -> State<Self::Config> {
        let v = Twist { linear: at.velocity, angular: self.stored(at.attitude, at.omega_body) };
        State { q: Pose::new(at.position, at.attitude), v }
    }

    /// How a body in this state moves.
    #[inline(always)]
    fn kinematics(&self, s: &State<Self::Config>) -> Kinematics<T, <Self::Body as RigidBody<T>>::Position> {
        let angular = self.velocity(s.q, s.v).angular;
        let omega_body = <Self::Update as Update>::Frame::to_body(s.q.attitude, angular);
        kinematics(&s.q, s.v.linear, omega_body)
    }
}

macro_rules! rigid_model {
    ($($model:ident, $frame:ident, $stored:expr;)*) => {$(
        impl<T: Real, B: RigidBody<T>, U: Update<Frame = $frame>> RigidModel<T> for $model<B, U> {
            type Body = B;
            type Update = U;

            #[inline(always)]
            fn body(&self) -> &B {
                &self.0
            }
            #[inline(always)]
            fn stored(&self, attitude: Rotation<T>, omega_body: Vector3<T>) -> Vector3<T> {
                let stored: fn(Vector3<T>, Rotation<T>, Vector3<T>) -> Vector3<T> = $stored;
                stored(self.0.inertia(), attitude, omega_body)
            }
        }
    )*};
}
rigid_model! {
    WorldOmega, World, |_, attitude, omega| attitude.rotate(omega);
    BodyOmega, Body, |_, _, omega| omega;
    WorldMomentum, World, |inertia, attitude, omega| attitude.rotate(inertia.component_mul(&omega));
    WithoutGyroscopicTerm, World, |_, attitude, omega| attitude.rotate(omega);
}

/// Kinematics of a state whose angular velocity in the body frame is known.
#[inline(always)]
fn kinematics<T: Real, U: Update, P: Vector<T>>(
    q: &Pose<T, U, P>,
    velocity: P,
    omega_body: Vector3<T>,
) -> Kinematics<T, P> {
    Kinematics { position: q.position, velocity, attitude: q.attitude, omega_body }
}

/// ((I2 - I3) / I1, (I3 - I1) / I2, (I1 - I2) / I3).
#[inline(always)]
fn gyroscopic_ratios<T: Real>(inertia: Vector3<T>) -> Vector3<T> {
    let [a, b, c] = [inertia.x, inertia.y, inertia.z];
    Vector3::new((b - c) / a, (c - a) / b, (a - b) / c)
}

impl<T: Real, B: RigidBody<T>, U: Update<Frame = World>> Model<T> for WorldOmega<B, U> {
    type Config = Pose<T, U, B::Position>;

    #[inline(always)]
    fn rate(&self, t: T, s: &State<Self::Config>) -> Twist<T, B::Position> {
        let (attitude, inertia) = (s.q.attitude, self.0.inertia());
        let omega_body = attitude.rotate_back(s.v.angular);
        let momentum = attitude.rotate(inertia.component_mul(&omega_body));
        let at = kinematics(&s.q, s.v.linear, omega_body);
        let torque = self.0.torque(t, &at).plus_in_world(attitude, cross(momentum, s.v.angular));
        let angular = attitude.rotate(attitude.rotate_back(torque).component_div(&inertia));
        Twist { linear: self.0.acceleration(t, &at), angular }
    }
}

impl<T: Real, B: RigidBody<T>, U: Update<Frame = Body>> Model<T> for BodyOmega<B, U> {
    type Config = Pose<T, U, B::Position>;

    #[inline(always)]
    fn rate(&self, t: T, s: &State<Self::Config>) -> Twist<T, B::Position> {
        let inertia = self.0.inertia();
        let omega = s.v.angular;
        let at = kinematics(&s.q, s.v.linear, omega);
        // Euler's equations with their constants in front, (I2 - I3) / I1 ...: they do not wait for omega, and nothing cancels.
        let products = Vector3::new(omega.y * omega.z, omega.z * omega.x, omega.x * omega.y);
        let gyroscopic = products.component_mul(&gyroscopic_ratios(inertia));
        let angular = match self.0.torque(t, &at) {
            Torque::None => gyroscopic,
            torque => gyroscopic + torque.plus_in_body(s.q.attitude, Vector3::zero()).component_div(&inertia),
        };
        Twist { linear: self.0.acceleration(t, &at), angular }
    }
}

impl<T: Real, B: RigidBody<T>, U: Update<Frame = World>> Model<T> for WorldMomentum<B, U> {
    type Config = Pose<T, U, B::Position>;

    #[inline(always)]
    fn rate(&self, t: T, s: &State<Self::Config>) -> Twist<T, B::Position> {
        let omega_body = s.q.attitude.rotate_back(s.v.angular).component_div(&self.0.inertia());
        let at = kinematics(&s.q, s.v.linear, omega_body);
        let angular = self.0.torque(t, &at).plus_in_world(s.q.attitude, Vector3::zero());
        Twist { linear: self.0.acceleration(t, &at), angular }
    }

    #[inline(always)]
    fn velocity(&self, q: Self::Config, v: Twist<T, B::Position>) -> Twist<T, B::Position> {
        let omega_body = q.attitude.rotate_back(v.angular).component_div(&self.0.inertia());
        Twist { linear: v.linear, angular: q.attitude.rotate(omega_body) }
    }
}

impl<T: Real, B: RigidBody<T>, U: Update<Frame = World>> Model<T> for WithoutGyroscopicTerm<B, U> {
    type Config = Pose<T, U, B::Position>;

    #[inline(always)]
    fn rate(&self, t: T, s: &State<Self::Config>) -> Twist<T, B::Position> {
        let attitude = s.q.attitude;
        let at = kinematics(&s.q, s.v.linear, attitude.rotate_back(s.v.angular));
        let torque = self.0.torque(t, &at).plus_in_body(attitude, Vector3::zero());
        Twist { linear: self.0.acceleration(t, &at), angular: attitude.rotate(torque.component_div(&self.0.inertia())) }
    }
}

impl<T: Real, B: RigidBody<T> + ?Sized> RigidBody<T> for &B {
    type Position = B::Position;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        (**self).inertia()
    }
    #[inline(always)]
    fn torque(&self, t: T, at: &Kinematics<T, B::Position>) -> Torque<T> {
        (**self).torque(t, at)
    }
    #[inline(always)]
    fn acceleration(&self, t: T, at: &Kinematics<T, B::Position>) -> B::Position {
        (**self).acceleration(t, at)
    }
}
