//! A rotation whose angular velocity (omega_x, 0, A s) turns slowly: its adiabatic series, to fourteen terms.
//!
//! W = |omega|, p = A s / W, d = A / W^2. About the direction of omega the rotation is that of the angle int W ds but for
//! the spinor ratio eta = i d sqrt(1 - p^2) y, and
//! y = 1/2 - (d^2 / 2)(1 - p^2) y^2 - i d ((1 - p^2) dy/dp - 3 p y) - i d (what falls on d itself) is solved by
//! y = sum (-i d)^n Z_n(p), Z_0 = 1/2, Z_(n+1) = (1 - p^2) Z_n' - (2 n + 3) p Z_n + (1 - p^2)/2 sum_(j+k=n-1) Z_j Z_k.
//! The angle gains Re int d y dp. (M. V. Berry, Quantum phase corrections from adiabatic iteration, Proc. R. Soc. A 414 (1987)
//! 31-46, for the iteration; what is left after all terms is e^(-pi / (4 d)) at d's largest.)

use std::sync::LazyLock;

use faer::fx128;
use integrator::real::Real;
use integrator::rotation::Rotation;
use nalgebra::Vector3;

use super::elementary::asinh;

/// W^2 / A from which on the series is good for double-double: its terms have fallen below 1e-28.
pub(super) const SLOWEST: f64 = 640.0;

const TERMS: usize = 15;
/// Nodes of Gauss and Legendre: exact for polynomials of degree 47, and the integrand has 2 + 3 (TERMS - 1).
const NODES: usize = 24;

/// Coefficients of Z_n by powers of p.
static SERIES: LazyLock<Vec<Vec<fx128>>> = LazyLock::new(series);
/// Nodes in (0, 1) and weights that sum to 1.
static GAUSS: LazyLock<Vec<(fx128, fx128)>> = LazyLock::new(gauss_legendre);

/// A part of the motion: A, omega_x, omega_z at its start and end, and the time it takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    pub(super) rate: fx128,
    pub(super) across: fx128,
    pub(super) start: fx128,
    pub(super) end: fx128,
    pub(super) time: fx128,
}

/// What is needed at one end: omega_z, W, and 1 / (W (W + |omega_z|)).
#[derive(Clone, Copy)]
struct End {
    along: fx128,
    size: fx128,
    nearness: fx128,
}

fn lit(x: f64) -> fx128 {
    fx128::from_f64(x)
}

impl Leg {
    /// Whether omega turns slowly all the way.
    pub(super) fn is_adiabatic(&self) -> bool {
        let (a, b) = (self.start.0, self.end.0);
        let nearest = if a * b <= 0.0 { 0.0 } else { a.abs().min(b.abs()) };
        nearest.hypot(self.across.0).powi(2) >= SLOWEST * self.rate.0
    }

    /// The rotation from the start to the end.
    pub(super) fn turn(&self) -> Rotation<fx128> {
        let (a, b) = (self.at(self.start), self.at(self.end));
        let half = (self.angle(a, b) + self.correction(a, b)) * lit(0.5);
        let (sine, cosine) = half.sin_cos();
        let about = Rotation { w: cosine, v: Vector3::new(fx128::ZERO, fx128::ZERO, sine) };
        self.axis(b) * about * self.axis(a).conjugate()
    }

    fn at(&self, along: fx128) -> End {
        let size = Real::sqrt(along * along + self.across * self.across);
        End { along, size, nearness: fx128::ONE / (size * (size + Real::abs(along))) }
    }

    /// int W ds, in which nothing cancels however weak the torque is:
    /// (t W_b + a t (a + b) / (W_a + W_b) + omega_x^2 t arsinh(D) / (A t)) / 2, sinh of D = (b W_a - a W_b) / omega_x^2.
    fn angle(&self, a: End, b: End) -> fx128 {
        let (t, square) = (self.time, self.across * self.across);
        let over_time = if a.along.0 * b.along.0 > 0.0 {
            (a.along + b.along) / (b.along * a.size + a.along * b.size)
        } else {
            (b.along * a.size - a.along * b.size) / (square * (b.along - a.along))
        };
        let argument = over_time * self.rate * t;
        let share = if argument.0 == 0.0 { fx128::ONE } else { asinh(argument) / argument };
        let swept = a.along * t * (a.along + b.along) / (a.size + b.size);
        (t * b.size + swept + square * t * over_time * share) * lit(0.5)
    }

    /// Re int d y dp, by way of 1 - |p| = omega_x^2 nearness.
    fn correction(&self, a: End, b: End) -> fx128 {
        if a.along.0 * b.along.0 < 0.0 {
            let middle = self.at(fx128::ZERO);
            return self.correction(a, middle) + self.correction(middle, b);
        }
        let square = self.across * self.across;
        let sense = if a.along.0 + b.along.0 < 0.0 { lit(-1.0) } else { fx128::ONE };
        let mut sum = fx128::ZERO;
        for &(node, weight) in GAUSS.iter() {
            let nearness = a.nearness + (b.nearness - a.nearness) * node;
            let (p, slowness) = self.node(sense, nearness);
            sum += weight * slowness * ratio(p, slowness).0;
        }
        sense * square * (a.nearness - b.nearness) * sum
    }

    /// p and d = A / W^2 from 1 / (W (W + |omega_z|)).
    fn node(&self, sense: fx128, nearness: fx128) -> (fx128, fx128) {
        let from_pole = self.across * self.across * nearness;
        (sense * (fx128::ONE - from_pole), self.rate * nearness * (lit(2.0) - from_pole))
    }

    /// The rotation of z onto the axis about which the motion turns: of z onto omega, after the spinor (1, eta).
    fn axis(&self, end: End) -> Rotation<fx128> {
        let (p, slowness) = self.node(if end.along.0 < 0.0 { lit(-1.0) } else { fx128::ONE }, end.nearness);
        let (re, im) = ratio(p, slowness);
        // eta = i d q y, q = omega_x / W.
        let size = slowness * self.across / end.size;
        let (re, im) = (-im * size, re * size);
        let spinor = Rotation { w: fx128::ONE, v: Vector3::new(-im, re, fx128::ZERO) }.normalized();
        // Half the angle of omega from z: the larger of its cosine and sine does not cancel.
        let (near, far) = {
            let large = Real::sqrt((fx128::ONE + Real::abs(end.along) / end.size) * lit(0.5));
            (large, self.across / (end.size * (large + large)))
        };
        let (cosine, sine) = if end.along.0 < 0.0 { (far, near) } else { (near, far) };
        Rotation { w: cosine, v: Vector3::new(fx128::ZERO, sine, fx128::ZERO) } * spinor
    }
}

/// y(p, d) = sum (-i d)^n Z_n(p), up to its smallest term.
fn ratio(p: fx128, slowness: fx128) -> (fx128, fx128) {
    let (mut re, mut im, mut power) = (fx128::ZERO, fx128::ZERO, fx128::ONE);
    for (n, coefficients) in SERIES.iter().enumerate() {
        let value = coefficients.iter().rev().fold(fx128::ZERO, |sum, &c| sum * p + c) * power;
        match n % 4 {
            0 => re += value,
            1 => im -= value,
            2 => re -= value,
            _ => im += value,
        }
        power *= slowness;
        if power.0 < 1e-50 {
            break;
        }
    }
    (re, im)
}

fn series() -> Vec<Vec<fx128>> {
    let mut all: Vec<Vec<fx128>> = vec![vec![lit(0.5)]];
    for n in 0..TERMS - 1 {
        let mut next = vec![fx128::ZERO; n + 2];
        // (1 - p^2) times the coefficient c of p^k.
        let mut add = |k: usize, c: fx128| {
            next[k] += c;
            next[k + 2] -= c;
        };
        for (k, &c) in all[n].iter().enumerate().skip(1) {
            add(k - 1, c * lit(k as f64));
        }
        for j in 0..n {
            for (k, &a) in all[j].iter().enumerate() {
                for (l, &b) in all[n - 1 - j].iter().enumerate() {
                    add(k + l, a * b * lit(0.5));
                }
            }
        }
        for (k, &c) in all[n].iter().enumerate() {
            next[k + 1] -= c * lit(2.0 * n as f64 + 3.0);
        }
        all.push(next);
    }
    all
}

/// Newton's method on Legendre's polynomial from cos(pi (i - 1/4) / (n + 1/2)).
fn gauss_legendre() -> Vec<(fx128, fx128)> {
    let n = NODES as f64;
    let polynomial = |x: fx128| {
        let (mut before, mut last) = (fx128::ONE, x);
        for k in 2..=NODES {
            let k = k as f64;
            let next = (lit(2.0 * k - 1.0) * x * last - lit(k - 1.0) * before) / lit(k);
            (before, last) = (last, next);
        }
        (last, lit(n) * (x * last - before) / (x * x - fx128::ONE))
    };
    (1..=NODES)
        .map(|i| {
            let mut x = lit(libm::cos(std::f64::consts::PI * (i as f64 - 0.25) / (n + 0.5)));
            for _ in 0..4 {
                let (value, slope) = polynomial(x);
                x -= value / slope;
            }
            let slope = polynomial(x).1;
            ((fx128::ONE + x) * lit(0.5), fx128::ONE / ((fx128::ONE - x * x) * slope * slope))
        })
        .collect()
}
