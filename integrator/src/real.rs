//! Arithmetic: [`Real`] is what a step may do with numbers, [`Single`] adds what only one comparable number can.

use std::fmt::Debug;
use std::ops::Neg;

use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign, Scalar};

use crate::reduction::{LARGE, folded};

/// A number of about 31 digits, the sum of two `f64`. `faer::fx128` is the same type.
pub use qd::Quad as DoubleDouble;

/// A number, or several lanes of numbers, that a step computes with.
///
/// Every operation gives the same bits on every platform: `+ - * /` and `sqrt` are correctly rounded, the
/// trigonometric functions come from the `libm` crate and not from the platform's C library.
pub trait Real:
    Scalar
    + Copy
    + Debug
    + Send
    + Sync
    + Neg<Output = Self>
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + ClosedDivAssign
{
    /// The constant `x`. Exact in every precision only where `x` is: write `h / lit(6.0)`, not `h * lit(1.0 / 6.0)`.
    fn lit(x: f64) -> Self;

    /// `self * a + b`. Two roundings, except for types that exist to fuse them.
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }

    /// Square root.
    fn sqrt(self) -> Self;

    /// Absolute value.
    fn abs(self) -> Self;

    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);

    /// `(cos x, sin x / x)` as functions of `x_squared`, smooth through zero: what an exponential map needs, without
    /// a square root or a division for the small angles of a step.
    fn cos_sinc(x_squared: Self) -> (Self, Self);

    /// Whether the number (every lane of it) is neither infinite nor NaN.
    fn is_finite(self) -> bool;
}

/// One number with an order: what exact motions, Newton iterations and measurements need beyond [`Real`].
pub trait Single: Real + PartialOrd {
    /// Distance from 1 to the next larger number.
    const EPSILON: f64;

    /// The nearest `f64`.
    fn to_f64(self) -> f64;

    /// The same number in double-double, exactly.
    fn widen(self) -> DoubleDouble;

    /// The nearest number to a double-double.
    fn narrow(x: DoubleDouble) -> Self;

    /// e^x.
    fn exp(self) -> Self;

    /// Natural logarithm; NaN for negative numbers.
    fn ln(self) -> Self;

    /// The angle of the point (x, y) = (`other`, `self`) in (-pi, pi].
    fn atan2(self, other: Self) -> Self;

    /// The nearest integer.
    fn round(self) -> Self;
}

/// Taylor coefficients of cos x and sin x / x in x^2, for |x| <= 1/4: half a radian a step.
///
/// The first terms left out are x^14/14! < 5e-20 and x^12/13! < 1e-17 (f64), x^10/10! < 3e-13 and x^8/9! < 5e-11 (f32).
const COS: [f64; 7] = [1.0, -0.5, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0, -1.0 / 3_628_800.0, 1.0 / 479_001_600.0];
const SINC: [f64; 6] = [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5_040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0];
/// Largest x^2 for which the Taylor sums are used.
pub(crate) const TAYLOR_BOUND: f64 = 0.0625;

/// c0 + c1 x + ... for at most eight coefficients by Estrin's scheme: as many operations as Horner's, half as deep.
#[inline(always)]
fn polynomial<T: Real>(c: &[f64], [x, x2, x4]: [T; 3]) -> T {
    // Functions and not closures, which are not inlined where the call is cold.
    #[inline(always)]
    fn two<T: Real>(c: &[f64], i: usize, x: T) -> T {
        if i + 1 < c.len() { T::lit(c[i + 1]).mul_add(x, T::lit(c[i])) } else { T::lit(c[i]) }
    }
    #[inline(always)]
    fn four<T: Real>(c: &[f64], i: usize, x: T, x2: T) -> T {
        if i + 2 < c.len() { two(c, i + 2, x).mul_add(x2, two(c, i, x)) } else { two(c, i, x) }
    }
    if c.len() > 4 { four(c, 4, x, x2).mul_add(x4, four(c, 0, x, x2)) } else { four(c, 0, x, x2) }
}

/// (cos x, sin x / x) for x^2 <= [`TAYLOR_BOUND`], without the last `SKIP` terms of the sums: 53 bits with none left out.
#[inline(always)]
pub(crate) fn taylor_cos_sinc<T: Real, const SKIP: usize>(x_squared: T) -> (T, T) {
    let square = x_squared * x_squared;
    let powers = [x_squared, square, square * square];
    (polynomial(&COS[..COS.len() - SKIP], powers), polynomial(&SINC[..SINC.len() - SKIP], powers))
}

/// The same for larger x: k times halved, summed and doubled back by cos 2x = 1 - 2 x^2 sinc(x)^2, sinc 2x = sinc x cos x.
///
/// The error is that of the angle, about 2 |x| EPSILON. Arithmetic in place, without a call: the compiler can see that it ends
/// and has no effect, and drops it with an attitude that nobody asks for; and no register is saved for a call never made.
#[cold]
#[inline(always)]
pub(crate) fn doubled_cos_sinc<T: Real, const SKIP: usize>(x_squared: T, size: f64) -> (T, T) {
    let halvings = halvings(size);
    let mut scaled = x_squared * T::lit(f64::from_bits((1023 - 2 * halvings) << 52));
    let (mut cosine, mut sinc) = taylor_cos_sinc::<T, SKIP>(scaled);
    for _ in 0..halvings {
        let half_sinc = sinc;
        sinc = half_sinc * cosine;
        cosine = T::lit(1.0) - scaled * half_sinc * half_sinc * T::lit(2.0);
        scaled *= T::lit(4.0);
    }
    (cosine, sinc)
}

/// The least k with size <= 4^k [`TAYLOR_BOUND`] = 2^(2 k - 4): k >= log2(size) / 2 + 2. At most 64, as 4^64 > 1e38: nobody
/// turns by more in a step, and an infinite argument ends too.
#[inline(always)]
fn halvings(size: f64) -> u64 {
    let bits = size.to_bits();
    let log_rounded_up = (bits >> 52) as i64 - 1023 + i64::from(bits << 12 != 0);
    (log_rounded_up + 5).div_euclid(2).clamp(0, 64) as u64
}

macro_rules! real_for_primitive {
    ($t:ty, $skip:literal, $sin:path, $cos:path, $exp:path, $ln:path, $atan2:path) => {
        impl Real for $t {
            #[inline(always)]
            fn lit(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                ($sin(self), $cos(self))
            }
            #[inline(always)]
            fn cos_sinc(x_squared: Self) -> (Self, Self) {
                if x_squared <= TAYLOR_BOUND as $t {
                    taylor_cos_sinc::<Self, $skip>(x_squared)
                } else {
                    doubled_cos_sinc::<Self, $skip>(x_squared, f64::from(x_squared))
                }
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                self.is_finite()
            }
        }

        impl Single for $t {
            const EPSILON: f64 = <$t>::EPSILON as f64;
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline]
            fn widen(self) -> DoubleDouble {
                DoubleDouble::from(f64::from(self))
            }
            #[inline]
            fn narrow(x: DoubleDouble) -> Self {
                (x.0 + x.1) as $t
            }
            #[inline]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline]
            fn ln(self) -> Self {
                $ln(self)
            }
            #[inline]
            fn atan2(self, other: Self) -> Self {
                $atan2(self, other)
            }
            #[inline]
            fn round(self) -> Self {
                self.round()
            }
        }
    };
}

real_for_primitive!(f64, 0, libm::sin, libm::cos, libm::exp, libm::log, libm::atan2);
real_for_primitive!(f32, 2, libm::sinf, libm::cosf, libm::expf, libm::logf, libm::atan2f);

/// pi / 2 in three parts, for the reduction of an argument.
const HALF_PI: [f64; 3] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_183_4e-33];

/// 1 / n! in double-double.
const INVERSE_FACTORIAL: [DoubleDouble; 26] = {
    let mut table = [DoubleDouble::ONE; 26];
    let mut n = 1;
    while n < 26 {
        table[n] = table[n - 1].const_div(DoubleDouble::from_f64(n as f64));
        n += 1;
    }
    table
};

/// Taylor sums of (cos x, sin x / x) for x^2 <= 1/16; the first term left out is x^24/24! < 6e-39.
fn taylor_double_double(x_squared: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let sum = |parity: usize| {
        (0..12).rev().fold(DoubleDouble::ZERO, |sum, k| INVERSE_FACTORIAL[2 * k + parity] - sum * x_squared)
    };
    (sum(0), sum(1))
}

/// `qd` has no trigonometric functions: the argument is reduced modulo pi/2 with a three-part constant, divided
/// by four, summed by Taylor and doubled back twice. Error below 2e-31 for |x| < 1e6 and for |x| > 2^55, where all digits of
/// pi that count are used.
impl Real for DoubleDouble {
    #[inline(always)]
    fn lit(x: f64) -> Self {
        Self::from_f64(x)
    }
    #[inline]
    fn sqrt(self) -> Self {
        DoubleDouble::sqrt(self)
    }
    #[inline]
    fn abs(self) -> Self {
        DoubleDouble::abs(self)
    }
    fn sin_cos(self) -> (Self, Self) {
        if !DoubleDouble::is_finite(self) {
            return (DoubleDouble::NAN, DoubleDouble::NAN);
        }
        let (turned, angle) = if self.0.abs() < LARGE { (0, self) } else { folded(self) };
        let quarters = (angle.0 / HALF_PI[0]).round();
        let k = DoubleDouble::from_f64(quarters);
        let reduced = HALF_PI.iter().fold(angle, |x, &part| x.sub_accurate(k * DoubleDouble::from_f64(part)));
        let x = reduced * DoubleDouble::from_f64(0.25);
        let (mut cosine, sinc) = taylor_double_double(x * x);
        let mut sine = sinc * x;
        for _ in 0..2 {
            let twice = sine + sine;
            (sine, cosine) = (twice * cosine, DoubleDouble::ONE - twice * sine);
        }
        match (quarters.rem_euclid(4.0) as u64 + turned) % 4 {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }
    fn cos_sinc(x_squared: Self) -> (Self, Self) {
        if x_squared.0 <= 0.0625 {
            taylor_double_double(x_squared)
        } else {
            let x = DoubleDouble::sqrt(x_squared);
            let (sine, cosine) = x.sin_cos();
            (cosine, sine / x)
        }
    }
    #[inline]
    fn is_finite(self) -> bool {
        DoubleDouble::is_finite(self)
    }
}

impl Single for DoubleDouble {
    const EPSILON: f64 = f64::EPSILON * f64::EPSILON;
    #[inline]
    fn to_f64(self) -> f64 {
        self.0 + self.1
    }
    #[inline]
    fn widen(self) -> DoubleDouble {
        self
    }
    #[inline]
    fn narrow(x: DoubleDouble) -> Self {
        x
    }
    fn exp(self) -> Self {
        DoubleDouble::exp(self)
    }
    fn ln(self) -> Self {
        DoubleDouble::ln(self)
    }
    /// One Newton step from the `f64` angle a: a + (y cos a - x sin a) / |(x, y)|; what is left is the cube of 1e-16.
    fn atan2(self, other: Self) -> Self {
        let angle = DoubleDouble::from_f64(libm::atan2(self.0, other.0));
        let radius = (self * self + other * other).sqrt();
        if radius.0 == 0.0 || !radius.is_finite() {
            return angle;
        }
        let (sine, cosine) = angle.sin_cos();
        angle + (self * cosine - other * sine) / radius
    }
    fn round(self) -> Self {
        let high = self.0.round();
        if high == self.0 {
            return DoubleDouble::from_f64(high) + DoubleDouble::from_f64(self.1.round());
        }
        // Where the high part lies half way, the low part decides.
        let up = high - self.0;
        let beyond_half = up.abs() == 0.5 && self.1 * up < 0.0;
        DoubleDouble::from_f64(if beyond_half { high - 2.0 * up } else { high })
    }
}
