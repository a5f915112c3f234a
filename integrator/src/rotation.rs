//! Rotations as unit quaternions over any [`Real`].

use std::ops::Mul;

use nalgebra::{Matrix3, Vector3};

use crate::real::{Real, Single};

/// The unit quaternion (w, x, y, z): v_world = q v_body q*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation<T> {
    /// Scalar part, cos(angle / 2).
    pub w: T,
    /// Vector part, axis * sin(angle / 2).
    pub v: Vector3<T>,
}

/// a . b for any [`Real`].
#[inline(always)]
pub fn dot<T: Real>(a: Vector3<T>, b: Vector3<T>) -> T {
    a.z.mul_add(b.z, a.y.mul_add(b.y, a.x * b.x))
}

/// a x b for any [`Real`].
#[inline(always)]
pub fn cross<T: Real>(a: Vector3<T>, b: Vector3<T>) -> Vector3<T> {
    Vector3::new(a.y.mul_add(b.z, -(a.z * b.y)), a.z.mul_add(b.x, -(a.x * b.z)), a.x.mul_add(b.y, -(a.y * b.x)))
}

impl<T: Real> Rotation<T> {
    /// The rotation that leaves everything where it is.
    pub fn identity() -> Self {
        Rotation { w: T::lit(1.0), v: Vector3::repeat(T::lit(0.0)) }
    }

    /// The rotation with the components (w, x, y, z) / |(w, x, y, z)|, normalised in the arithmetic of `T`.
    pub fn from_wxyz([w, x, y, z]: [T; 4]) -> Self {
        Rotation { w, v: Vector3::new(x, y, z) }.normalized()
    }

    /// The components (w, x, y, z).
    pub fn wxyz(self) -> [T; 4] {
        [self.w, self.v.x, self.v.y, self.v.z]
    }

    /// exp(phi): the rotation by |phi| rad about phi.
    #[inline(always)]
    pub fn exp(phi: Vector3<T>) -> Self {
        Self::from_rotation_vector(phi, T::lit(1.0))
    }

    /// exp(omega h): what the constant angular velocity omega does in the time h.
    #[inline(always)]
    pub fn from_rotation_vector(omega: Vector3<T>, h: T) -> Self {
        let half = h * T::lit(0.5);
        let (cosine, sinc) = T::cos_sinc(dot(omega, omega) * (half * half));
        Rotation { w: cosine, v: omega * (sinc * half) }
    }

    /// The inverse rotation.
    #[inline(always)]
    #[must_use]
    pub fn conjugate(self) -> Self {
        Rotation { w: self.w, v: -self.v }
    }

    /// |q|^2, which is 1 but for rounding.
    #[inline(always)]
    pub fn norm_squared(self) -> T {
        self.w.mul_add(self.w, dot(self.v, self.v))
    }

    /// q / |q|.
    #[inline(always)]
    #[must_use]
    pub fn normalized(self) -> Self {
        let inverse = T::lit(1.0) / self.norm_squared().sqrt();
        Rotation { w: self.w * inverse, v: self.v * inverse }
    }

    /// R a: a vector of the body frame in the world frame, a + 2 w (v x a) + 2 v x (v x a).
    #[inline(always)]
    pub fn rotate(self, a: Vector3<T>) -> Vector3<T> {
        let twice = cross(self.v, a) * T::lit(2.0);
        a + twice * self.w + cross(self.v, twice)
    }

    /// R^T a: a vector of the world frame in the body frame.
    #[inline(always)]
    pub fn rotate_back(self, a: Vector3<T>) -> Vector3<T> {
        self.conjugate().rotate(a)
    }

    /// The rotation matrix R, its columns the body axes in the world frame.
    #[inline(always)]
    pub fn matrix(self) -> Matrix3<T> {
        let two = T::lit(2.0);
        let one = T::lit(1.0);
        let Rotation { w, v } = self;
        let (x, y, z) = (v.x * two, v.y * two, v.z * two);
        let (xx, xy, xz) = (x * v.x, x * v.y, x * v.z);
        let (yy, yz, zz) = (y * v.y, y * v.z, z * v.z);
        let (wx, wy, wz) = (w * x, w * y, w * z);
        Matrix3::new(
            one - (yy + zz),
            xy - wz,
            xz + wy,
            xy + wz,
            one - (xx + zz),
            yz - wx,
            xz - wy,
            yz + wx,
            one - (xx + yy),
        )
    }

    /// Whether all four components are finite.
    #[inline(always)]
    pub fn is_finite(&self) -> bool {
        self.w.is_finite() && self.v.iter().all(|c| c.is_finite())
    }
}

impl<T: Single> Rotation<T> {
    /// The geodesic distance to another rotation in rad, in [0, pi]: 4 asin(|q - r| / 2) with the nearer sign of r.
    ///
    /// Computed as 4 atan2(|q - r|, |q + r|), which is as accurate for a small angle as for one near pi, where an
    /// arc cosine of the product has lost half the digits.
    pub fn angle_to(self, other: Self) -> T {
        let difference = Rotation { w: self.w - other.w, v: self.v - other.v }.norm_squared().sqrt();
        let sum = Rotation { w: self.w + other.w, v: self.v + other.v }.norm_squared().sqrt();
        let (small, large) = if difference <= sum { (difference, sum) } else { (sum, difference) };
        T::lit(4.0) * small.atan2(large)
    }
}

/// The quaternion product: first `other`, then `self`.
impl<T: Real> Mul for Rotation<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.v, other.v);
        let (p, q) = (self.w, other.w);
        Rotation {
            w: p.mul_add(q, -(a.x.mul_add(b.x, a.y.mul_add(b.y, a.z * b.z)))),
            v: Vector3::new(
                p.mul_add(b.x, a.x.mul_add(q, a.y.mul_add(b.z, -(a.z * b.y)))),
                p.mul_add(b.y, a.y.mul_add(q, a.z.mul_add(b.x, -(a.x * b.z)))),
                p.mul_add(b.z, a.z.mul_add(q, a.x.mul_add(b.y, -(a.y * b.x)))),
            ),
        }
    }
}
