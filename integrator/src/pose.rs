//! R^3 x SO(3): where a rigid body is, in which frame its velocity is written, and how its attitude is advanced.

use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::{Add, Mul, Neg, Sub};

use nalgebra::{SVector, Vector3};

use crate::real::Real;
use crate::rotation::{Rotation, cross};
use crate::space::{Space, Vector, sum_of_sizes};

/// The position of a body with a fixed point: none. Such a pose is an attitude and nothing else.
pub type Fixed<T> = SVector<T, 0>;

/// The frame in which angular velocities are written.
pub trait Frame: Copy + Debug + Send + Sync + 'static {
    /// The attitude after the incremental rotation `dq`, given in this frame.
    fn compose<T: Real>(q: Rotation<T>, dq: Rotation<T>) -> Rotation<T>;
    /// The Lie bracket of two angular velocities in this frame.
    fn bracket<T: Real>(a: Vector3<T>, b: Vector3<T>) -> Vector3<T>;
    /// World components of a vector given in this frame.
    fn to_world<T: Real>(q: Rotation<T>, a: Vector3<T>) -> Vector3<T>;
    /// Body components of a vector given in this frame.
    fn to_body<T: Real>(q: Rotation<T>, a: Vector3<T>) -> Vector3<T>;
}

/// World components: q' = (0, omega) q / 2, increments multiply from the left, [a, b] = a x b.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct World;

/// Body components: q' = q (0, omega) / 2, increments multiply from the right, [a, b] = -a x b.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Body;

impl Frame for World {
    #[inline(always)]
    fn compose<T: Real>(q: Rotation<T>, dq: Rotation<T>) -> Rotation<T> {
        dq * q
    }
    #[inline(always)]
    fn bracket<T: Real>(a: Vector3<T>, b: Vector3<T>) -> Vector3<T> {
        cross(a, b)
    }
    #[inline(always)]
    fn to_world<T: Real>(_q: Rotation<T>, a: Vector3<T>) -> Vector3<T> {
        a
    }
    #[inline(always)]
    fn to_body<T: Real>(q: Rotation<T>, a: Vector3<T>) -> Vector3<T> {
        q.rotate_back(a)
    }
}

impl Frame for Body {
    #[inline(always)]
    fn compose<T: Real>(q: Rotation<T>, dq: Rotation<T>) -> Rotation<T> {
        q * dq
    }
    #[inline(always)]
    fn bracket<T: Real>(a: Vector3<T>, b: Vector3<T>) -> Vector3<T> {
        cross(b, a)
    }
    #[inline(always)]
    fn to_world<T: Real>(q: Rotation<T>, a: Vector3<T>) -> Vector3<T> {
        q.rotate(a)
    }
    #[inline(always)]
    fn to_body<T: Real>(_q: Rotation<T>, a: Vector3<T>) -> Vector3<T> {
        a
    }
}

/// How an attitude is advanced by a constant angular velocity.
pub trait Update: Copy + Debug + Send + Sync + 'static {
    /// The frame of the angular velocity.
    type Frame: Frame;
    /// The incremental rotation of the time `h`.
    fn increment<T: Real>(omega: Vector3<T>, h: T) -> Rotation<T>;
}

/// The exponential map exp(omega h): exact for a constant angular velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exponential<F>(PhantomData<F>);

/// The normalised linear step of physics engines, q + (h/2) omega q divided by its norm: it turns by 2 atan(|omega| h / 2)
/// instead of |omega| h, third-order wrong in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Linear<F>(PhantomData<F>);

impl<F: Frame> Update for Exponential<F> {
    type Frame = F;
    #[inline(always)]
    fn increment<T: Real>(omega: Vector3<T>, h: T) -> Rotation<T> {
        Rotation::from_rotation_vector(omega, h)
    }
}

impl<F: Frame> Update for Linear<F> {
    type Frame = F;
    #[inline(always)]
    fn increment<T: Real>(omega: Vector3<T>, h: T) -> Rotation<T> {
        // |q + dq q| = |1 + dq| for a unit q: normalising the increment normalises the result.
        Rotation { w: T::lit(1.0), v: omega * (h * T::lit(0.5)) }.normalized()
    }
}

/// Position and attitude (body to world) of a rigid body. `U` is the frame and the attitude update, `P` the position:
/// `Vector3<T>`, or [`Fixed`] for a body with a fixed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T: Real, U = Exponential<World>, P = Vector3<T>> {
    /// Centre of mass in the world frame, m.
    pub position: P,
    /// Body to world.
    pub attitude: Rotation<T>,
    update: PhantomData<U>,
}

impl<T: Real, U, P> Pose<T, U, P> {
    /// A pose from its two parts.
    #[inline(always)]
    pub fn new(position: P, attitude: Rotation<T>) -> Self {
        Pose { position, attitude, update: PhantomData }
    }
}

/// Velocity of a rigid body (or a momentum, where that is what a model stores).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<T: Real, P = Vector3<T>> {
    /// Of the centre of mass, world frame, m/s.
    pub linear: P,
    /// Angular, in the frame of the pose's update, rad/s (or kg m^2 / s).
    pub angular: Vector3<T>,
}

impl<T: Real, P: Vector<T>> Add for Twist<T, P> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Twist { linear: self.linear + other.linear, angular: self.angular + other.angular }
    }
}

impl<T: Real, P: Vector<T>> Sub for Twist<T, P> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Twist { linear: self.linear - other.linear, angular: self.angular - other.angular }
    }
}

impl<T: Real, P: Vector<T>> Neg for Twist<T, P> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Twist { linear: -self.linear, angular: -self.angular }
    }
}

impl<T: Real, P: Vector<T>> Mul<T> for Twist<T, P> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, c: T) -> Self {
        Twist { linear: self.linear * c, angular: self.angular * c }
    }
}

impl<T: Real, P: Vector<T>> Vector<T> for Twist<T, P> {
    const DIM: usize = P::DIM + 3;

    #[inline(always)]
    fn from_fn(mut f: impl FnMut(usize) -> T) -> Self {
        let linear = P::from_fn(&mut f);
        Twist { linear, angular: Vector3::from_fn(|i, _| f(P::DIM + i)) }
    }
    #[inline(always)]
    fn component(&self, i: usize) -> T {
        if i < P::DIM { self.linear.component(i) } else { self.angular[i - P::DIM] }
    }
    #[inline(always)]
    fn add_scaled(self, rate: Self, h: T) -> Self {
        Twist { linear: self.linear.add_scaled(rate.linear, h), angular: self.angular.add_scaled(rate.angular, h) }
    }
    #[inline(always)]
    fn is_finite(&self) -> bool {
        self.linear.is_finite() && Vector::is_finite(&self.angular)
    }
}

impl<T: Real, U: Update, P: Vector<T>> Space for Pose<T, U, P> {
    type Scalar = T;
    type Tangent = Twist<T, P>;

    #[inline(always)]
    fn retract(self, v: Twist<T, P>, h: T) -> Self {
        Pose::new(self.position.add_scaled(v.linear, h), U::Frame::compose(self.attitude, U::increment(v.angular, h)))
    }
    #[inline(always)]
    fn plus_bracket(k: Twist<T, P>, c: T, a: Twist<T, P>, b: Twist<T, P>) -> Twist<T, P> {
        Twist { linear: k.linear, angular: k.angular.add_scaled(U::Frame::bracket(a.angular, b.angular), c) }
    }
    #[inline(always)]
    fn settled(self) -> Self {
        Pose::new(self.position, self.attitude.normalized())
    }
    fn size(&self) -> T {
        sum_of_sizes(&self.position) + T::lit(1.0)
    }
    #[inline(always)]
    fn is_finite(&self) -> bool {
        self.position.is_finite() && self.attitude.is_finite()
    }
}
