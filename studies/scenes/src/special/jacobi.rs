//! Jacobi's elliptic functions by the arithmetic-geometric mean, in double-double.
//!
//! R. Bulirsch, Numerical calculation of elliptic integrals and elliptic functions, Numer. Math. 7 (1965) 78-90 (sncndn).
//! Bulirsch's recursion divides positive sums only, so it keeps every digit of the phase pi u / (2 K); it runs
//! in double-double throughout, so that f64 results are those of the exact function, rounded.
//! Error (measured, relative, |u| <= 1e6, mc from 1e-100 to 1): f64 1.2e-16; double-double 1e-31 times 1 + |u| times the
//! function's condition number.

use faer::fx128;
use integrator::real::{Real, Single};

use super::elementary::{sech, tanh};

/// Most steps of the mean: mc = 1e-300 takes 14.
const MOST_STEPS: usize = 20;

/// The values sn(u|m), cn(u|m), dn(u|m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobi<T> {
    /// sin am(u).
    pub sn: T,
    /// cos am(u).
    pub cn: T,
    /// sqrt(1 - m sn^2) = sqrt(cn^2 + mc sn^2) > 0.
    pub dn: T,
}

/// A parameter with its ladder of means, for many evaluations at one mc.
#[derive(Clone, Copy, Debug)]
pub struct Modulus {
    /// Complementary parameter 1 - m in [0, 1].
    pub mc: fx128,
    /// Arithmetic means a_0 = 1, a_1, ... and geometric means g_0 = sqrt(mc), g_1, ...
    means: [(fx128, fx128); MOST_STEPS],
    /// Steps in use; the last arithmetic mean is the limit.
    steps: usize,
    /// The common limit M(1, sqrt(mc)) = pi / (2 K).
    limit: fx128,
}

impl Modulus {
    /// The means of 1 and sqrt(mc), mc in [0, 1] (mc = 0: hyperbolic functions); NaN gives NaN throughout.
    pub fn new(mc: fx128) -> Self {
        let (mut a, mut g) = (fx128::ONE, Real::sqrt(mc));
        let mut means = [(a, g); MOST_STEPS];
        let mut steps = 0;
        while mc.0 > 0.0 && steps < MOST_STEPS {
            means[steps] = (a, g);
            steps += 1;
            let mean = (a + g) * fx128::from_f64(0.5);
            // The next difference is the square of this one.
            let close = (a - g).0.abs() <= 1e-17 * a.0;
            (a, g) = (mean, Real::sqrt(a * g));
            if close {
                break;
            }
        }
        let limit = if mc.0 > 0.0 { a } else { mc };
        Self { mc, means, steps, limit }
    }

    /// Quarter period K = pi / (2 M(1, sqrt(mc))), infinite at mc = 0.
    pub fn quarter_period(&self) -> fx128 {
        if self.mc.0 == 0.0 { fx128::INFINITY } else { fx128::PI / (self.limit + self.limit) }
    }

    /// sn, cn, dn at u.
    pub fn at<T: Single>(&self, u: fx128) -> Jacobi<T> {
        if self.mc.0 == 0.0 {
            let sech = T::narrow(sech(u));
            return Jacobi { sn: T::narrow(tanh(u)), cn: sech, dn: sech };
        }
        let Jacobi { sn, cn, dn } = self.climb((u * self.limit).sin_cos());
        Jacobi { sn: T::narrow(sn), cn: T::narrow(cn), dn: T::narrow(dn) }
    }

    /// Bulirsch's recursion from the sine and cosine of the phase up the ladder of means.
    fn climb(&self, (sine, cosine): (fx128, fx128)) -> Jacobi<fx128> {
        let one = fx128::ONE;
        // Below this the quotients may overflow, and all terms beyond the first are below the rounding.
        if sine.0.abs() < 1e-18 {
            return Jacobi { sn: sine / self.limit, cn: if cosine.0 < 0.0 { -one } else { one }, dn: one };
        }
        let cotangent = cosine / sine;
        let (mut ratio, mut product, mut dn) = (cotangent, self.limit * cotangent, one);
        for &(a, g) in self.means[..self.steps].iter().rev() {
            ratio *= product;
            product *= dn;
            dn = (g + ratio) / (a + ratio);
            ratio = product / a;
        }
        let size = one / Real::sqrt(product * product + one);
        let sn = if sine.0 < 0.0 { -size } else { size };
        Jacobi { sn, cn: product * sn, dn }
    }

    /// The half periods N = round(u / 2K) nearest to u, and the functions at u - 2 K N, where cn >= 0.
    pub fn reduced_at<T: Single>(&self, u: fx128) -> (fx128, Jacobi<T>) {
        let reduced = self.at::<T>(u);
        if self.mc.0 == 0.0 {
            return (fx128::ZERO, reduced);
        }
        let halves = (u * self.limit / fx128::PI).round();
        let sign = T::lit(parity(halves));
        (halves, Jacobi { sn: reduced.sn * sign, cn: reduced.cn * sign, dn: reduced.dn })
    }

    /// The amplitude am(u), continuous in u: N pi + atan2(sn, cn) of the reduced argument.
    pub fn amplitude<T: Single>(&self, u: fx128) -> T {
        let (halves, Jacobi { sn, cn, .. }) = self.reduced_at::<fx128>(u);
        T::narrow(halves * fx128::PI + sn.atan2(cn))
    }
}

/// (-1)^N: the factor by which 2 K N changes sn and cn.
pub(super) fn parity(halves: fx128) -> f64 {
    // Above 2^53 only the low part may be odd.
    let odd = (halves.0.rem_euclid(2.0) + halves.1.rem_euclid(2.0)).rem_euclid(2.0) == 1.0;
    if odd { -1.0 } else { 1.0 }
}

/// sn, cn, dn of u with complementary parameter mc in [0, 1], |u| <= 1e6.
///
/// The parameter may be in another arithmetic than u: double-double where 1 - m is not an f64.
pub fn jacobi<T: Single, M: Single>(u: T, mc: M) -> Jacobi<T> {
    Modulus::new(mc.widen()).at(u.widen())
}

/// The amplitude am(u | 1 - mc), continuous: am' = dn, am(u + 2 K) = am(u) + pi.
pub fn am<T: Single, M: Single>(u: T, mc: M) -> T {
    Modulus::new(mc.widen()).amplitude(u.widen())
}
