//! Legendre's elliptic integrals of the complementary parameter mc = 1 - m.
//!
//! m = k^2 is never an argument: near m = 1 the integrals depend on log(1 - m), which a subtraction would destroy.
//! All are sums of positive terms of Carlson's integrals (DLMF 19.25). mc in (0, 1] unless said otherwise; amplitudes
//! up to pi/2 are given by their sine and cosine (cosine >= 0), so that the neighbourhood of pi/2 loses nothing.

use faer::fx128;
use integrator::real::{Real, Single};

use super::carlson::{rd, rf, rj};

/// K(m) = F(pi/2 | m) = RF(0, mc, 1), infinite at mc = 0.
pub fn complete_f<T: Single>(mc: T) -> T {
    rf(T::lit(0.0), mc, T::lit(1.0))
}

/// E(m) = mc (RD(0, mc, 1) + RD(0, 1, mc)) / 3 (DLMF 19.25.1), mc in (0, 1].
pub fn complete_e<T: Single>(mc: T) -> T {
    let (zero, one) = (T::lit(0.0), T::lit(1.0));
    mc * (rd(zero, mc, one) + rd(zero, one, mc)) / T::lit(3.0)
}

/// Pi(n; pi/2 | m) with nc = 1 - n > 0: RF(0, mc, 1) + n RJ(0, mc, 1, nc) / 3.
pub fn complete_pi<T: Single>(nc: T, mc: T) -> T {
    pi_of(nc, T::lit(1.0), T::lit(0.0), mc)
}

/// F(phi | m) = s RF(c^2, d^2, 1) with s = sin phi, c = cos phi >= 0, d^2 = c^2 + mc s^2; mc = 0 wants c > 0.
pub fn f_of<T: Single>(sine: T, cosine: T, mc: T) -> T {
    let (s2, c2) = (sine * sine, cosine * cosine);
    sine * rf(c2, c2 + mc * s2, T::lit(1.0))
}

/// E(phi | m) = mc s RF(c^2, d^2, 1) + m mc s^3 RD(c^2, 1, d^2) / 3 + m s c / d (DLMF 19.25.10), c = cos phi >= 0.
pub fn e_of<T: Single>(sine: T, cosine: T, mc: T) -> T {
    let (s2, c2, m) = (sine * sine, cosine * cosine, T::lit(1.0) - mc);
    let d2 = c2 + mc * s2;
    let thirds = rd(c2, T::lit(1.0), d2) / T::lit(3.0);
    sine * (mc * (rf(c2, d2, T::lit(1.0)) + m * s2 * thirds) + m * cosine / d2.sqrt())
}

/// Pi(n; phi | m) = s RF(c^2, d^2, 1) + n s^3 RJ(c^2, d^2, 1, c^2 + nc s^2) / 3 with nc = 1 - n > 0, c = cos phi >= 0.
///
/// Sign of n as in DLMF 19.2.7: the integrand is 1 / ((1 - n sin^2) sqrt(1 - m sin^2)).
pub fn pi_of<T: Single>(nc: T, sine: T, cosine: T, mc: T) -> T {
    let (s2, c2, one) = (sine * sine, cosine * cosine, T::lit(1.0));
    let d2 = c2 + mc * s2;
    let n = one - nc;
    sine * (rf(c2, d2, one) + n * s2 * rj(c2, d2, one, c2 + nc * s2) / T::lit(3.0))
}

/// Half turns N = round(phi / pi) and (sin, cos) of phi - N pi, reduced in double-double.
fn half_turns<T: Single>(phi: T) -> (T, T, T) {
    let wide = phi.widen();
    let turns = (wide / fx128::PI).round();
    let (sine, cosine) = (wide - turns * fx128::PI).sin_cos();
    (T::narrow(turns), T::narrow(sine), T::narrow(cosine.abs()))
}

/// F(phi | m) for any amplitude: 2 N K + F(phi - N pi), N = round(phi / pi).
pub fn f<T: Single>(phi: T, mc: T) -> T {
    let (turns, sine, cosine) = half_turns(phi);
    let part = f_of(sine, cosine, mc);
    if turns == T::lit(0.0) { part } else { part + turns * T::lit(2.0) * complete_f(mc) }
}

/// E(phi | m) for any amplitude.
pub fn e<T: Single>(phi: T, mc: T) -> T {
    let (turns, sine, cosine) = half_turns(phi);
    e_of(sine, cosine, mc) + turns * T::lit(2.0) * complete_e(mc)
}

/// Pi(n; phi | m) for any amplitude, nc = 1 - n > 0.
pub fn pi<T: Single>(nc: T, phi: T, mc: T) -> T {
    let (turns, sine, cosine) = half_turns(phi);
    pi_of(nc, sine, cosine, mc) + turns * T::lit(2.0) * complete_pi(nc, mc)
}
