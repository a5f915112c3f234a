//! Arithmetic for speed: fused multiply-add, SIMD lanes, and several independent vectors side by side.
//!
//! Each is a type, chosen by the caller, and never a switch inside `f64`: plain `f64` gives the same bits everywhere.
//! [`Fused`] rounds `a b + c` once. `wide::f64x4` is four plain numbers; [`Pack`] is N numbers (or N vectors of lanes)
//! that are stepped together, so that their dependency chains overlap. A lane of `Pack<Fused<f64x4>, N>` has the bits of
//! `Fused<f64>`, and a lane of `Pack<f64x4, N>` those of `f64`.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use wide::f64x4;

use crate::real::{Real, TAYLOR_BOUND, doubled_cos_sinc, taylor_cos_sinc};

/// Plain numbers side by side: one of them, or a SIMD vector.
pub trait Lanes: Real {
    /// `self * a + b` in every lane, rounded once.
    fn fused(self, a: Self, b: Self) -> Self;
    /// Whether every lane is at most `bound`.
    fn all_at_most(self, bound: f64) -> bool;
    /// A function of each lane by itself.
    fn each_lane(self, f: impl Fn(f64) -> (f64, f64)) -> (Self, Self);
}

/// Numbers that are filled from plain ones, and read, lane by lane.
pub trait FromLanes: Real {
    /// How many plain numbers there are.
    const LANES: usize;
    /// The numbers f(0), f(1), ...
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self;
    /// The number in the lane `i` < [`Self::LANES`].
    fn lane(&self, i: usize) -> f64;
}

/// The same numbers with every `mul_add` fused.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Fused<T>(pub T);

/// N numbers that are computed with independently of each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pack<T, const N: usize>(pub [T; N]);

impl Lanes for f64 {
    #[inline(always)]
    fn fused(self, a: Self, b: Self) -> Self {
        f64::mul_add(self, a, b)
    }
    #[inline(always)]
    fn all_at_most(self, bound: f64) -> bool {
        self <= bound
    }
    #[inline(always)]
    fn each_lane(self, f: impl Fn(f64) -> (f64, f64)) -> (Self, Self) {
        f(self)
    }
}

impl Lanes for f64x4 {
    #[inline(always)]
    fn fused(self, a: Self, b: Self) -> Self {
        if cfg!(target_feature = "fma") {
            f64x4::mul_add(self, a, b)
        } else {
            // Without the instruction `wide` rounds twice: slow and right is better here.
            let (x, a, b) = (self.to_array(), a.to_array(), b.to_array());
            f64x4::from(std::array::from_fn::<f64, 4, _>(|i| f64::mul_add(x[i], a[i], b[i])))
        }
    }
    #[inline(always)]
    fn all_at_most(self, bound: f64) -> bool {
        self.simd_le(f64x4::splat(bound)).all()
    }
    #[cold]
    #[inline(never)]
    fn each_lane(self, f: impl Fn(f64) -> (f64, f64)) -> (Self, Self) {
        let pairs = self.to_array().map(f);
        (f64x4::from(pairs.map(|pair| pair.0)), f64x4::from(pairs.map(|pair| pair.1)))
    }
}

/// Four plain numbers: no operation is fused.
impl Real for f64x4 {
    #[inline(always)]
    fn lit(x: f64) -> Self {
        f64x4::splat(x)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64x4::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64x4::abs(self)
    }
    fn sin_cos(self) -> (Self, Self) {
        self.each_lane(Real::sin_cos)
    }
    #[inline(always)]
    fn cos_sinc(x_squared: Self) -> (Self, Self) {
        if x_squared.all_at_most(TAYLOR_BOUND) {
            taylor_cos_sinc::<_, 0>(x_squared)
        } else {
            x_squared.each_lane(f64::cos_sinc)
        }
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        f64x4::is_finite(self).all()
    }
}

macro_rules! operators {
    ($([$($generics:tt)*] $type:ty, |$a:ident, $b:ident, $f:ident| $body:expr;)*) => {$(
        operators!(@ [$($generics)*] $type, Add add AddAssign add_assign, |$a, $b, $f| $body);
        operators!(@ [$($generics)*] $type, Sub sub SubAssign sub_assign, |$a, $b, $f| $body);
        operators!(@ [$($generics)*] $type, Mul mul MulAssign mul_assign, |$a, $b, $f| $body);
        operators!(@ [$($generics)*] $type, Div div DivAssign div_assign, |$a, $b, $f| $body);
    )*};
    (@ [$($generics:tt)*] $type:ty, $op:ident $method:ident $assign:ident $assign_method:ident, |$a:ident, $b:ident, $f:ident| $body:expr) => {
        impl<$($generics)*> $op for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ($a, $b, $f) = (self, other, T::$method);
                $body
            }
        }
        impl<$($generics)*> $assign for $type {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = $op::$method(*self, other);
            }
        }
    };
}

operators! {
    [T: Lanes] Fused<T>, |a, b, f| Fused(f(a.0, b.0));
    [T: Real, const N: usize] Pack<T, N>, |a, b, f| a.zip(b, f);
}

impl<T: Lanes> Neg for Fused<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Fused(-self.0)
    }
}

impl<T: Real, const N: usize> Neg for Pack<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(T::neg)
    }
}

impl<T: Real, const N: usize> Pack<T, N> {
    // Index loops: a closure that is called several times is not inlined everywhere, and then costs fifty-fold.
    #[inline(always)]
    fn zip(mut self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        for i in 0..N {
            self.0[i] = f(self.0[i], other.0[i]);
        }
        self
    }

    #[inline(always)]
    fn each(mut self, f: impl Fn(T) -> T) -> Self {
        for i in 0..N {
            self.0[i] = f(self.0[i]);
        }
        self
    }

    #[inline(always)]
    fn pairs(self, f: impl Fn(T) -> (T, T)) -> (Self, Self) {
        let (mut first, mut second) = (self, self);
        for i in 0..N {
            (first.0[i], second.0[i]) = f(self.0[i]);
        }
        (first, second)
    }
}

/// [`Real::cos_sinc`] of one fused number.
#[inline(always)]
fn fused_cos_sinc(x: f64) -> (f64, f64) {
    let (cosine, sinc) =
        if x <= TAYLOR_BOUND { taylor_cos_sinc::<_, 0>(Fused(x)) } else { doubled_cos_sinc::<_, 0>(Fused(x), x) };
    (cosine.0, sinc.0)
}

impl<T: Lanes> Real for Fused<T> {
    #[inline(always)]
    fn lit(x: f64) -> Self {
        Fused(T::lit(x))
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Fused(self.0.fused(a.0, b.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Fused(self.0.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Fused(self.0.abs())
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.0.sin_cos();
        (Fused(sine), Fused(cosine))
    }
    #[inline(always)]
    fn cos_sinc(x_squared: Self) -> (Self, Self) {
        if x_squared.0.all_at_most(TAYLOR_BOUND) {
            return taylor_cos_sinc::<_, 0>(x_squared);
        }
        let (cosine, sinc) = x_squared.0.each_lane(fused_cos_sinc);
        (Fused(cosine), Fused(sinc))
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}

impl<T: Real, const N: usize> Real for Pack<T, N> {
    #[inline(always)]
    fn lit(x: f64) -> Self {
        Pack([T::lit(x); N])
    }
    #[inline(always)]
    fn mul_add(mut self, a: Self, b: Self) -> Self {
        for i in 0..N {
            self.0[i] = self.0[i].mul_add(a.0[i], b.0[i]);
        }
        self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.each(T::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.each(T::abs)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        self.pairs(T::sin_cos)
    }
    #[inline(always)]
    fn cos_sinc(x_squared: Self) -> (Self, Self) {
        x_squared.pairs(T::cos_sinc)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.0.iter().all(|x| x.is_finite())
    }
}

impl FromLanes for f64 {
    const LANES: usize = 1;
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        f(0)
    }
    fn lane(&self, _i: usize) -> f64 {
        *self
    }
}

impl FromLanes for f64x4 {
    const LANES: usize = 4;
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self {
        f64x4::from(std::array::from_fn::<f64, 4, _>(f))
    }
    fn lane(&self, i: usize) -> f64 {
        self.to_array()[i]
    }
}

impl<T: FromLanes + Lanes> FromLanes for Fused<T> {
    const LANES: usize = T::LANES;
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self {
        Fused(T::from_lanes(f))
    }
    fn lane(&self, i: usize) -> f64 {
        self.0.lane(i)
    }
}

impl<T: FromLanes, const N: usize> FromLanes for Pack<T, N> {
    const LANES: usize = N * T::LANES;
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        Pack(std::array::from_fn(|vector| T::from_lanes(|i| f(vector * T::LANES + i))))
    }
    fn lane(&self, i: usize) -> f64 {
        self.0[i / T::LANES].lane(i % T::LANES)
    }
}
