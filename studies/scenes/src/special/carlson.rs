//! Carlson's symmetric elliptic integrals by duplication.
//!
//! B. C. Carlson, Numerical computation of real or complex elliptic integrals, Numer. Algorithms 10 (1995) 13-26; the
//! series to degree 7 are DLMF 19.36.1-2. Arguments are not negative, at most one of x, y, z is zero (the last argument
//! of RC, RD and RJ is positive); otherwise the result is infinite or NaN. Every term added is positive, so the result is
//! good to a few eps of the arithmetic (measured: 2.3 eps in f64 and in double-double, ratios of
//! arguments up to 1e16).

use integrator::real::Single;

/// Spread of the arguments below which the first term left out, of degree 8, is below eps / 4: (eps / 4)^(1/8).
fn spread_bound<T: Single>() -> f64 {
    (T::EPSILON / 4.0).sqrt().sqrt().sqrt()
}

/// Duplications that bring any finite arguments together: a large ratio shrinks to its square root each time, a spread below
/// 1 to a quarter.
const MOST_DUPLICATIONS: usize = 60;

/// RF(x, y, z) = 1/2 int_0^inf dt / sqrt((t + x)(t + y)(t + z)).
pub fn rf<T: Single>(x: T, y: T, z: T) -> T {
    let (mut x, mut y, mut z) = (x, y, z);
    for _ in 0..MOST_DUPLICATIONS {
        let mean = (x + y + z) / T::lit(3.0);
        let (dx, dy) = (T::lit(1.0) - x / mean, T::lit(1.0) - y / mean);
        let dz = -(dx + dy);
        if largest(&[dx, dy, dz]) <= spread_bound::<T>() {
            let (e2, e3) = (dx * dy - dz * dz, dx * dy * dz);
            return rf_series(e2, e3) / mean.sqrt();
        }
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * (ry + rz) + ry * rz;
        let quarter = T::lit(0.25);
        (x, y, z) = ((x + lambda) * quarter, (y + lambda) * quarter, (z + lambda) * quarter);
    }
    T::lit(f64::NAN)
}

/// DLMF 19.36.1: 1 - E2/10 + E3/14 + E2^2/24 - 3 E2 E3/44 - 5 E2^3/208 + 3 E3^2/104 + E2^2 E3/16.
fn rf_series<T: Single>(e2: T, e3: T) -> T {
    let c = |n: f64, d: f64| T::lit(n) / T::lit(d);
    let square = e2 * e2;
    T::lit(1.0)
        + (e3 * c(1.0, 14.0) - e2 * c(1.0, 10.0)
            + (square * c(1.0, 24.0) - e2 * e3 * c(3.0, 44.0))
            + (e3 * e3 * c(3.0, 104.0) - square * e2 * c(5.0, 208.0))
            + square * e3 * c(1.0, 16.0))
}

/// RC(x, y) = RF(x, y, y), y > 0.
pub fn rc<T: Single>(x: T, y: T) -> T {
    rf(x, y, y)
}

/// RD(x, y, z) = RJ(x, y, z, z) = 3/2 int_0^inf dt / (sqrt((t + x)(t + y)) (t + z)^(3/2)).
pub fn rd<T: Single>(x: T, y: T, z: T) -> T {
    rj(x, y, z, z)
}

/// RJ(x, y, z, p) = 3/2 int_0^inf dt / (sqrt((t + x)(t + y)(t + z)) (t + p)), p > 0.
pub fn rj<T: Single>(x: T, y: T, z: T, p: T) -> T {
    let (mut x, mut y, mut z, mut p) = (x, y, z, p);
    let (one, quarter) = (T::lit(1.0), T::lit(0.25));
    let (mut scale, mut sum) = (one, T::lit(0.0));
    for _ in 0..MOST_DUPLICATIONS {
        let mean = (x + y + z + p + p) / T::lit(5.0);
        let (dx, dy, dz) = (one - x / mean, one - y / mean, one - z / mean);
        let dp = -(dx + dy + dz) * T::lit(0.5);
        if largest(&[dx, dy, dz, dp]) <= spread_bound::<T>() {
            return sum * T::lit(6.0) + scale * rj_series(dx, dy, dz, dp) / (mean * mean.sqrt());
        }
        let (rx, ry, rz, rp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let lambda = rx * (ry + rz) + ry * rz;
        // Carlson's RC(1, 1 + e) with 1 + e = 2 sqrt(p) (p + lambda) / d, which cannot cancel where p is small.
        let d = (rp + rx) * (rp + ry) * (rp + rz);
        sum += scale / d * rc(one, (rp + rp) * (p + lambda) / d);
        scale *= quarter;
        (x, y, z, p) = ((x + lambda) * quarter, (y + lambda) * quarter, (z + lambda) * quarter, (p + lambda) * quarter);
    }
    T::lit(f64::NAN)
}

/// DLMF 19.36.2 with E2..E5 of (X, Y, Z, P, P), X + Y + Z + 2 P = 0.
fn rj_series<T: Single>(x: T, y: T, z: T, p: T) -> T {
    let c = |n: f64, d: f64| T::lit(n) / T::lit(d);
    let (xyz, square) = (x * y * z, p * p);
    let e2 = x * y + x * z + y * z - square * T::lit(3.0);
    let e3 = xyz + e2 * p * T::lit(2.0) + square * p * T::lit(4.0);
    let e4 = (xyz * T::lit(2.0) + e2 * p + square * p * T::lit(3.0)) * p;
    let e5 = xyz * square;
    T::lit(1.0)
        + (e3 * c(1.0, 6.0) - e2 * c(3.0, 14.0)
            + (e2 * e2 * c(9.0, 88.0) - e4 * c(3.0, 22.0))
            + (e5 * c(3.0, 26.0) - e2 * e3 * c(9.0, 52.0))
            + (e3 * e3 * c(3.0, 40.0) - e2 * e2 * e2 * c(1.0, 16.0) + e2 * e4 * c(3.0, 20.0))
            + (e2 * e2 * e3 * c(45.0, 272.0) - (e3 * e4 + e2 * e5) * c(9.0, 68.0)))
}

fn largest<T: Single>(values: &[T]) -> f64 {
    values.iter().fold(0.0, |most, v| v.to_f64().abs().max(most))
}
