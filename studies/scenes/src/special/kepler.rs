//! Kepler's equation E - e sin E = M for elliptic orbits.

use faer::fx128;
use integrator::real::{Real, Single};

use super::elementary::x_minus_sin;

/// An eccentric anomaly with its sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EccentricAnomaly<T> {
    /// E in [-pi, pi], modulo the whole turns of the mean anomaly.
    pub angle: T,
    /// sin E.
    pub sine: T,
    /// cos E.
    pub cosine: T,
}

/// Newton steps allowed; the worst case met (e = 0.99 in double-double) takes 9.
const MOST_STEPS: usize = 60;

/// Solves E - e sin E = M for e in [0, 1) and any M in radians, which is reduced modulo 2 pi in double-double.
///
/// The equation is solved as (1 - e) E + e (E - sin E) = |M| with 1 - e exact and E - sin E by its series for small E,
/// so no digit cancels near the pericentre. The left side is convex on [0, pi]: Newton's method from an upper bound
/// (|M| / (1 - e), |M| + e, (pi^2 |M| / e)^(1/3) from E - sin E >= E^3 / pi^2, or pi) falls monotonically onto the root and
/// cannot fail; it stops when it no longer falls. Error: a few eps, times the condition number of E in M.
///
/// J. M. A. Danby, Fundamentals of Celestial Mechanics (1988), section 6.6.
pub fn eccentric_anomaly<T: Single>(mean_anomaly: fx128, eccentricity: T) -> EccentricAnomaly<T> {
    let two_pi = fx128::PI + fx128::PI;
    let reduced = mean_anomaly - (mean_anomaly / two_pi).round() * two_pi;
    let (e, mean) = (eccentricity, T::narrow(Real::abs(reduced)));
    let mut angle = T::lit(upper_bound(mean.to_f64(), e.to_f64()));
    for _ in 0..MOST_STEPS {
        let next = angle - excess(angle, e, mean) / slope(angle, e);
        // The first steps fall strictly; once a step does not fall, only rounding is left.
        if next >= angle {
            break;
        }
        angle = next;
    }
    let angle = if reduced.0 < 0.0 { -angle } else { angle };
    let (sine, cosine) = angle.sin_cos();
    EccentricAnomaly { angle, sine, cosine }
}

/// (1 - e) E + e (E - sin E) - M.
fn excess<T: Single>(angle: T, e: T, mean: T) -> T {
    (T::lit(1.0) - e) * angle - mean + e * x_minus_sin(angle)
}

/// Distance from the focus over the semi-major axis, 1 - e cos E = (1 - e) + 2 e sin^2(E/2).
pub fn slope<T: Single>(angle: T, e: T) -> T {
    let half_sine = (angle * T::lit(0.5)).sin_cos().0;
    (T::lit(1.0) - e) + T::lit(2.0) * e * half_sine * half_sine
}

/// A number not below the root, from f64 arithmetic; NaN stays NaN.
fn upper_bound(mean: f64, e: f64) -> f64 {
    let by_cube = libm::cbrt(std::f64::consts::PI * std::f64::consts::PI * mean / e);
    let bound = (mean / (1.0 - e)).min(mean + e).min(by_cube).min(std::f64::consts::PI.next_up());
    if mean.is_nan() || e.is_nan() { f64::NAN } else { bound * (1.0 + 4.0 * f64::EPSILON) }
}
