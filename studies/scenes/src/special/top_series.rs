//! A heavy symmetric top by power series in time, for motions through the vertical or near it, where the angles of
//! the closed form are singular and the motion is not.
//!
//! In the frame that turns about the axis of symmetry at a = (I3 / I1) omega_3 the top moves as a sphere does:
//! Omega' = g (u_y, -u_x, 0), u' = u x Omega, s' = s Omega / 2 with g = m g l / I1, Omega = (Omega_1, Omega_2, a), u the vertical in
//! that frame and s its attitude. Order and step as in A. Jorba, M. Zou, A software package for the numerical integration of ODEs by
//! means of high-order Taylor methods, Experimental Mathematics 14 (2005) 99-117.

use faer::fx128;
use integrator::real::{Real, Single};
use integrator::rotation::Rotation;
use nalgebra::{Vector2, Vector3};

const ORDER: usize = 40;
/// Size of the last terms: rounding of double-double.
const LAST: f64 = 1e-34;

type Series = [fx128; ORDER + 1];

/// The frame that turns at a about the axis: its attitude and angular velocity across the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spherical {
    pub(super) attitude: Rotation<fx128>,
    pub(super) omega: Vector2<fx128>,
}

/// What does not change: g = m g l / I1 and a.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    pub(super) gravity: fx128,
    pub(super) axial: fx128,
}

impl Pull {
    /// The state a time later, or earlier.
    pub(super) fn after(&self, start: Spherical, time: fx128) -> Spherical {
        let (mut at, mut left) = (start, time);
        while left.0 != 0.0 {
            let series = self.series(&at);
            let h = step(&series);
            let h = if h < left.0.abs() { fx128::from_f64(h.copysign(left.0)) } else { left };
            let [x, y, w, i, j, k] = series.map(|series| sum(&series, h));
            at.omega = Vector2::new(x, y);
            at.attitude = Rotation { w, v: Vector3::new(i, j, k) }.normalized();
            left -= h;
        }
        at
    }

    /// The series of Omega_1, Omega_2 and the four components of s.
    fn series(&self, at: &Spherical) -> [Series; 6] {
        let zero = [fx128::ZERO; ORDER + 1];
        let (mut x, mut y, z) = (zero, zero, self.axial);
        let mut up = [zero; 3];
        let mut s = [zero; 4];
        (x[0], y[0]) = (at.omega.x, at.omega.y);
        let vertical = at.attitude.rotate_back(Vector3::new(fx128::ZERO, fx128::ZERO, fx128::ONE));
        (0..3).for_each(|i| up[i][0] = vertical[i]);
        s.iter_mut().zip(at.attitude.wxyz()).for_each(|(s, c)| s[0] = c);
        for n in 0..ORDER {
            let next = fx128::ONE / fx128::from_f64(n as f64 + 1.0);
            let half = next * fx128::from_f64(0.5);
            let of = |a: &Series, b: &Series| (0..=n).fold(fx128::ZERO, |sum, k| sum + a[k] * b[n - k]);
            let [w, i, j, k] = &s;
            let quaternion = [
                -(of(i, &x) + of(j, &y) + k[n] * z),
                of(w, &x) + j[n] * z - of(k, &y),
                of(w, &y) + of(k, &x) - i[n] * z,
                w[n] * z + of(i, &y) - of(j, &x),
            ];
            let turned =
                [up[1][n] * z - of(&up[2], &y), of(&up[2], &x) - up[0][n] * z, of(&up[0], &y) - of(&up[1], &x)];
            x[n + 1] = self.gravity * up[1][n] * next;
            y[n + 1] = -(self.gravity * up[0][n] * next);
            (0..3).for_each(|i| up[i][n + 1] = turned[i] * next);
            (0..4).for_each(|i| s[i][n + 1] = quaternion[i] * half);
        }
        let [w, i, j, k] = s;
        [x, y, w, i, j, k]
    }
}

/// The step at which the last two terms of every series are [`LAST`].
fn step(series: &[Series; 6]) -> f64 {
    let of = |n: usize| {
        let most = series.iter().fold(0.0_f64, |most, c| most.max(c[n].0.abs()));
        // By logarithms, as the last coefficient may be out of range of a power.
        libm::exp((LAST.ln() - most.max(f64::MIN_POSITIVE).ln()) / n as f64)
    };
    of(ORDER).min(of(ORDER - 1))
}

fn sum(series: &Series, h: fx128) -> fx128 {
    series.iter().rev().fold(fx128::ZERO, |sum, &c| sum * h + c)
}

/// The argument of `a` / `b`, complex numbers (re, im).
pub(super) fn turned([a, b]: [Vector2<fx128>; 2]) -> fx128 {
    (a.y * b.x - a.x * b.y).atan2(a.x * b.x + a.y * b.y)
}

/// (w, z) and (x, y) of a quaternion: the first turns by (phi + psi) / 2, the second by (phi - psi) / 2.
pub(super) fn halves(q: Rotation<fx128>) -> [Vector2<fx128>; 2] {
    [Vector2::new(q.w, q.v.z), Vector2::new(q.v.x, q.v.y)]
}

/// `a` turned by an angle.
pub(super) fn turn(a: Vector2<fx128>, angle: fx128) -> Vector2<fx128> {
    let (sine, cosine) = Real::sin_cos(angle);
    Vector2::new(a.x * cosine - a.y * sine, a.x * sine + a.y * cosine)
}
