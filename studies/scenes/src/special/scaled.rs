//! Numbers beyond the range of double-double: what a motion depends on are products, and those have a size that can be told.
//!
//! k t^2 / m may be 4 where k / m is not a number. A product of f64 loses bits below 1e-292, where its rounding error is no f64.

use faer::fx128;
use integrator::{Real, Rotation};
use nalgebra::Vector3;

/// mantissa 2^exponent, the mantissa zero or between 1 and 2 in size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scaled {
    mantissa: fx128,
    exponent: i64,
}

/// floor(log2 |x|); 0 for zero and for what is no number.
pub(crate) fn exponent_of(x: f64) -> i64 {
    if x == 0.0 || !x.is_finite() { 0 } else { i64::from(libm::ilogb(x)) }
}

/// The largest of [`exponent_of`] over numbers that are not zero; 0 if all are.
pub(crate) fn exponent_of_largest(numbers: &[f64]) -> i64 {
    exponent_of(numbers.iter().fold(0.0, |largest, x| x.abs().max(largest)))
}

/// x 2^k, exactly unless it leaves the range of f64.
pub(crate) fn times_two_to(x: fx128, k: i64) -> fx128 {
    let k = k.clamp(-5000, 5000) as i32;
    let high = libm::scalbn(x.0, k);
    fx128 { 0: high, 1: if high.is_finite() { libm::scalbn(x.1, k) } else { 0.0 } }
}

/// The same of an f64.
pub(crate) fn f64_times_two_to(x: f64, k: i64) -> f64 {
    libm::scalbn(x, k.clamp(-5000, 5000) as i32)
}

/// A quaternion over its norm, whatever its size.
pub(crate) fn unit_quaternion(q: [f64; 4]) -> Rotation<fx128> {
    let k = -exponent_of_largest(&q);
    Rotation::from_wxyz(q.map(|c| fx128::from_f64(f64_times_two_to(c, k))))
}

impl Scaled {
    /// An f64, exactly.
    pub(crate) fn of(x: f64) -> Self {
        Self::of_wide(fx128::from_f64(x))
    }

    /// A double-double, exactly.
    pub(crate) fn of_wide(x: fx128) -> Self {
        let exponent = exponent_of(x.0);
        Self { mantissa: times_two_to(x, -exponent), exponent }
    }

    /// The product.
    pub(crate) fn times(self, other: Self) -> Self {
        Self::of_wide(self.mantissa * other.mantissa).shifted(self.exponent + other.exponent)
    }

    /// The quotient.
    pub(crate) fn over(self, other: Self) -> Self {
        Self::of_wide(self.mantissa / other.mantissa).shifted(self.exponent - other.exponent)
    }

    /// The square root of what is not negative.
    pub(crate) fn sqrt(self) -> Self {
        let odd = self.exponent.rem_euclid(2);
        let root = Real::sqrt(times_two_to(self.mantissa, odd));
        Self::of_wide(root).shifted((self.exponent - odd) / 2)
    }

    /// Its absolute value.
    pub(crate) fn magnitude(self) -> Self {
        Self { mantissa: Real::abs(self.mantissa), ..self }
    }

    /// The one of the larger magnitude, roughly: to a factor of two.
    pub(crate) fn larger(self, other: Self) -> Self {
        let size = |n: Self| if n.mantissa.0 == 0.0 { i64::MIN } else { n.exponent };
        if size(self) >= size(other) { self } else { other }
    }

    /// Times 2^k.
    pub(crate) fn shifted(self, k: i64) -> Self {
        Self { exponent: if self.mantissa.0 == 0.0 { 0 } else { self.exponent + k }, ..self }
    }

    /// floor(log2) of its size.
    pub(crate) fn exponent(self) -> i64 {
        self.exponent
    }

    /// The number: zero or infinite beyond the range of f64.
    pub(crate) fn value(self) -> fx128 {
        times_two_to(self.mantissa, self.exponent)
    }

    /// The exponent of the largest of several numbers.
    fn largest(numbers: &[Self]) -> i64 {
        numbers.iter().filter(|n| n.mantissa.0 != 0.0).map(|n| n.exponent).max().unwrap_or(0)
    }

    /// The sum, which leaves the range only if it is outside.
    pub(crate) fn sum(numbers: &[Self]) -> fx128 {
        let unit = Self::largest(numbers);
        let sum = numbers.iter().fold(fx128::ZERO, |sum, n| sum + times_two_to(n.mantissa, n.exponent - unit));
        times_two_to(sum, unit)
    }
}

/// Vectors times numbers, summed: in units of the largest term, so that only the sum can leave the range.
pub(crate) fn sum_of_vectors<const N: usize>(terms: [(Scaled, Vector3<fx128>); N]) -> Vector3<fx128> {
    Vector3::from_fn(|i, _| {
        let products = terms.map(|(factor, vector)| factor.times(Scaled::of_wide(vector[i])));
        Scaled::sum(&products)
    })
}
