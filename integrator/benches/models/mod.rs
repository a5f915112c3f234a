//! What the benchmarks step: an oscillator and a free body, every number of them hidden from the compiler.

use std::hint::black_box;

use integrator::lanes::{Fused, Pack};
use integrator::pose::{Fixed, Pose, Twist};
use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, Torque};
use integrator::{Method, Model, Real, Rotation, State, Tangent, Vector, drive};
use nalgebra::{Vector1, Vector3};
use wide::f64x4;

/// Steps of one run.
pub(crate) const STEPS: u64 = 20_000;

/// Several vectors of fused lanes.
pub(crate) type Lanes<const N: usize> = Pack<Fused<f64x4>, N>;

/// x'' = -w^2 x.
pub(crate) struct Spring<T> {
    minus_w_squared: T,
}

impl<T: Real> Model<T> for Spring<T> {
    type Config = Vector1<T>;
    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        s.q * self.minus_w_squared
    }
    #[inline(always)]
    fn kick(&self, _t: T, h: T, s: &State<Vector1<T>>) -> Vector1<T> {
        s.v.add_scaled(s.q, self.minus_w_squared * h)
    }
}

/// A body without torque.
pub(crate) struct Free<T: Real>(pub(crate) Vector3<T>);

impl<T: Real> RigidBody<T> for Free<T> {
    type Position = Fixed<T>;
    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        self.0
    }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::None
    }
}

/// An oscillator and its start.
pub(crate) fn spring<T: Real>(seed: f64) -> (Spring<T>, State<Vector1<T>>) {
    let start = State { q: Vector1::new(T::lit(black_box(seed))), v: Vector1::new(T::lit(black_box(0.25))) };
    (Spring { minus_w_squared: T::lit(black_box(-2.25)) }, start)
}

/// The state of a free body.
pub(crate) type Spin<T> = State<<BodyOmega<Free<T>> as Model<T>>::Config>;

/// Three unequal moments of inertia.
pub(crate) fn inertia<T: Real>() -> Vector3<T> {
    Vector3::new(T::lit(black_box(1.25)), T::lit(black_box(0.75)), T::lit(black_box(1.75)))
}

/// A free body that stores its angular velocity in the body frame, and its start.
pub(crate) fn spin<T: Real>(seed: f64) -> (BodyOmega<Free<T>>, Spin<T>) {
    let omega = Vector3::new(T::lit(black_box(seed)), T::lit(black_box(-0.75)), T::lit(black_box(1.0)));
    let start =
        State { q: Pose::new(Fixed::zero(), Rotation::identity()), v: Twist { linear: Fixed::zero(), angular: omega } };
    (BodyOmega::new(Free(inertia())), start)
}

/// The last component of the velocity after [`STEPS`] steps of a millisecond.
pub(crate) fn go<T: Real, M: Model<T>, A: Method<T, M>>(method: &A, (model, start): (M, State<M::Config>)) -> T
where
    Tangent<M, T>: Vector<T>,
{
    let end = drive::advance(method, &model, start, T::lit(black_box(0.001)), STEPS);
    end.map_or(T::lit(f64::NAN), |s| s.v.component(<Tangent<M, T> as Vector<T>>::DIM - 1))
}
