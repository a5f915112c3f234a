//! Where configurations live: [`Space`] (possibly curved) and [`Vector`] (its tangents).

use std::fmt::Debug;
use std::ops::{Add, Mul, Neg, Sub};

use nalgebra::SMatrix;

use crate::real::Real;

/// A finite-dimensional vector over `T`: velocities, momenta, accelerations.
pub trait Vector<T: Real>:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<T, Output = Self>
{
    /// Number of components.
    const DIM: usize;

    /// The vector whose i-th component is `f(i)`.
    fn from_fn(f: impl FnMut(usize) -> T) -> Self;

    /// The i-th component, i < [`Self::DIM`].
    fn component(&self, i: usize) -> T;

    /// `self + rate * h`, the update every method is made of; fused where the arithmetic fuses.
    fn add_scaled(self, rate: Self, h: T) -> Self;

    /// The zero vector.
    fn zero() -> Self {
        Self::from_fn(|_| T::lit(0.0))
    }

    /// Whether every component is finite.
    fn is_finite(&self) -> bool {
        (0..Self::DIM).all(|i| self.component(i).is_finite())
    }
}

/// A configuration space: R^n, or R^3 x SO(3).
pub trait Space: Copy + Debug + Send + Sync + 'static {
    /// The arithmetic.
    type Scalar: Real;
    /// Velocities at a configuration.
    type Tangent: Vector<Self::Scalar>;

    /// The configuration reached from `self` by the constant velocity `v` in the time `h`: q + h v on a flat space, the
    /// exponential map on a rotation.
    fn retract(self, v: Self::Tangent, h: Self::Scalar) -> Self;

    /// `k + c [a, b]`, with the Lie bracket of the space. A flat space has none: `k`.
    fn plus_bracket(k: Self::Tangent, _c: Self::Scalar, _a: Self::Tangent, _b: Self::Tangent) -> Self::Tangent {
        k
    }

    /// The same configuration without the rounding that has gathered in its constraints (a quaternion's norm).
    fn settled(self) -> Self {
        self
    }

    /// The sum of the sizes of the coordinates, 1 for an attitude: what their rounding is relative to.
    fn size(&self) -> Self::Scalar;

    /// Whether every coordinate is finite.
    fn is_finite(&self) -> bool;
}

/// The sum of the sizes of the components.
pub(crate) fn sum_of_sizes<T: Real, V: Vector<T>>(v: &V) -> T {
    (0..V::DIM).fold(T::lit(0.0), |sum, i| sum + v.component(i).abs())
}

impl<T: Real, const R: usize, const C: usize> Vector<T> for SMatrix<T, R, C> {
    const DIM: usize = R * C;

    #[inline(always)]
    fn from_fn(mut f: impl FnMut(usize) -> T) -> Self {
        Self::from_fn(|row, column| f(column * R + row))
    }
    #[inline(always)]
    fn component(&self, i: usize) -> T {
        self[i]
    }
    #[inline(always)]
    fn add_scaled(self, rate: Self, h: T) -> Self {
        self.zip_map(&rate, |x, r| r.mul_add(h, x))
    }
}

/// R^n and R^(3xN).
impl<T: Real, const R: usize, const C: usize> Space for SMatrix<T, R, C> {
    type Scalar = T;
    type Tangent = Self;

    #[inline(always)]
    fn retract(self, v: Self, h: T) -> Self {
        self.add_scaled(v, h)
    }
    fn size(&self) -> T {
        sum_of_sizes(self)
    }
    #[inline(always)]
    fn is_finite(&self) -> bool {
        Vector::is_finite(self)
    }
}
