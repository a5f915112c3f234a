//! Error constants and stability limits of linear equations of motion, z' = A z + b cos(W t) with z = (q, v).
//!
//! The error of a method of order p is h^p e(T) + O(h^(p+1)), where e' = A e + d(t), e(0) = 0, and h^(p+1) d(t) is the
//! method's local error on the exact motion. With z^(k) the derivatives of the motion and g^(k) those of b cos(W t):
//!
//! | method | d |
//! |---|---|
//! | explicit Euler | -z''/2 |
//! | implicit Euler | z''/2 |
//! | semi-implicit Euler | (q''/2, -v''/2): the drift takes the new velocity |
//! | velocity Verlet | (-q'''/6, v'''/12 - A_vv v''/4): the second force is taken at v + h v' |
//! | implicit midpoint | -z'''/24 + A z''/8 |
//! | RK4 | -A^3 z''/120 + A^2 g''/480 - A g'''/720 + g''''/2880 |
//!
//! The last line sums the trees of order five that do not vanish for a linear equation. All of them are linear
//! in y = (z, cos W t, sin W t), and y' = Y y, so that e(T) is a block of one matrix exponential.
//! Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I (1993), II.3 and II.8.

use integrator::methods::MethodId;
use nalgebra::{DMatrix, DVector};

use crate::observation::Quantity;
use crate::theory::{StabilityLimit, Theory};

/// z' = A z + b cos(W t), z = (q, v).
pub(crate) struct Linear {
    a: DMatrix<f64>,
    b: DVector<f64>,
    drive: f64,
    start: DVector<f64>,
}

/// The parts of v' = S q + D v + f cos(W t).
pub(crate) struct Parts<'a> {
    /// Stiffness matrix S, 1/s^2.
    pub(crate) stiffness: DMatrix<f64>,
    /// Damping (or gyroscopic) matrix D, 1/s.
    pub(crate) damping: DMatrix<f64>,
    /// Amplitude f of the forcing.
    pub(crate) forcing: &'a [f64],
    /// Its angular frequency W, rad/s; 0 for a constant force.
    pub(crate) drive: f64,
    /// Configuration at the start.
    pub(crate) q0: &'a [f64],
    /// Velocity at the start.
    pub(crate) v0: &'a [f64],
}

impl Linear {
    pub(crate) fn new(parts: &Parts<'_>) -> Self {
        let n = parts.q0.len();
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        a.view_mut((0, n), (n, n)).fill_with_identity();
        a.view_mut((n, 0), (n, n)).copy_from(&parts.stiffness);
        a.view_mut((n, n), (n, n)).copy_from(&parts.damping);
        let mut b = DVector::zeros(2 * n);
        b.rows_mut(n, n).copy_from_slice(parts.forcing);
        let start = DVector::from_iterator(2 * n, parts.q0.iter().chain(parts.v0).copied());
        Linear { a, b, drive: parts.drive, start }
    }

    /// What theory says of a method's error at the time `t_s`, with the constant |e_q| or |e_v|. It vanishes in some phases,
    /// and along some motions.
    pub(crate) fn theory(&self, method: MethodId, quantity: Quantity, t_s: f64) -> Theory {
        if !self.is_resolved(t_s) {
            return Theory::usual(method);
        }
        let n = self.start.len() / 2;
        let Some((error, size)) = self.error_constants(method, t_s) else { return Theory::usual(method) };
        let first = if quantity == Quantity::Position { 0 } else { n };
        let constant = error.rows(first, n).norm();
        let reason = "the method's local error, propagated by the linear equations of motion";
        Theory::with_constant(method, constant, reason).give_or_take(ROUNDING * size * t_s)
    }

    /// Whether the matrix exponential has digits at the time T: it loses as many as |Y| T has, and its powers must be numbers.
    fn is_resolved(&self, t_s: f64) -> bool {
        let size = self.extended().amax();
        size * t_s <= MOST_PHASE && size.powi(5) * self.start.amax().max(1.0) < f64::MAX.sqrt()
    }

    /// e(T), and what the terms of d amount to at the start without their signs; `None` where d is not known.
    fn error_constants(&self, method: MethodId, t_s: f64) -> Option<(DVector<f64>, f64)> {
        let (dim, wide) = (self.start.len(), self.start.len() + 2);
        let extended = self.extended();
        let d = self.local_error(method, &extended)?;
        let mut y = DVector::zeros(wide);
        y.rows_mut(0, dim).copy_from(&self.start);
        y[dim] = 1.0;
        // (e, y)' = [[A, d], [0, Y]] (e, y)
        let mut block = DMatrix::zeros(dim + wide, dim + wide);
        block.view_mut((0, 0), (dim, dim)).copy_from(&self.a);
        block.view_mut((0, dim), (dim, wide)).copy_from(&d);
        block.view_mut((dim, dim), (wide, wide)).copy_from(&extended);
        let flow = (block * t_s).exp();
        let size = (d.abs() * y.abs()).norm();
        Some((flow.view((0, dim), (dim, wide)) * y, size))
    }

    /// Y of y' = Y y.
    fn extended(&self) -> DMatrix<f64> {
        let dim = self.start.len();
        let mut y = DMatrix::zeros(dim + 2, dim + 2);
        y.view_mut((0, 0), (dim, dim)).copy_from(&self.a);
        y.view_mut((0, dim), (dim, 1)).copy_from(&self.b);
        y[(dim, dim + 1)] = -self.drive;
        y[(dim + 1, dim)] = self.drive;
        y
    }

    /// d as a matrix that acts on y, where it is known.
    fn local_error(&self, method: MethodId, extended: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let (a, dim) = (&self.a, self.start.len());
        let n = dim / 2;
        let power = |k: u32| (0..k).fold(DMatrix::identity(dim + 2, dim + 2), |p, _| p * extended);
        // z^(k), and the k-th derivative of b cos(W t)
        let z = |k: u32| power(k).rows(0, dim).into_owned();
        let g = |k: u32| &self.b * power(k).row(dim);
        let halves = |q: DMatrix<f64>, v: DMatrix<f64>| {
            let mut d = DMatrix::zeros(dim, dim + 2);
            d.rows_mut(0, n).copy_from(&q);
            d.rows_mut(n, n).copy_from(&v);
            d
        };
        let (q, v) = (|k| z(k).rows(0, n).into_owned(), |k| z(k).rows(n, n).into_owned());
        Some(match method {
            MethodId::ExplicitEuler => z(2) * -0.5,
            MethodId::ImplicitEuler => z(2) * 0.5,
            MethodId::SemiImplicitEuler => halves(q(2) * 0.5, v(2) * -0.5),
            MethodId::VelocityVerlet => halves(q(3) / -6.0, v(3) / 12.0 - a.view((n, n), (n, n)) * v(2) * 0.25),
            MethodId::ImplicitMidpoint => z(3) / -24.0 + a * z(2) / 8.0,
            MethodId::Rk4 => a * a * a * z(2) / -120.0 + a * a * g(2) / 480.0 - a * g(3) / 720.0 + g(4) / 2880.0,
            _ => return None,
        })
    }
}

/// Radians, or decay, after which eight digits of an error constant are left.
const MOST_PHASE: f64 = 1e8;

/// Rounding of the matrix exponential, as a part of T |d|.
const ROUNDING: f64 = 1e-13;

/// End of RK4's stability interval on the negative real axis: the root of 1 - x/2 + x^2/6 - x^3/24 = 0, so that R(-x) = 1.
pub(crate) const RK4_REAL: f64 = 2.785_293_563_405_282;

/// The first h > 0 at which a step `fails`, by steps of `scale_s` / 256 and bisection; none up to 16 `scale_s`.
pub(crate) fn first_failure(scale_s: f64, fails: impl Fn(f64) -> bool) -> StabilityLimit {
    let at = |i: u32| scale_s * f64::from(i) / 256.0;
    let Some(i) = (1..=16 * 256).find(|&i| fails(at(i))) else { return StabilityLimit::Unlimited };
    let (mut low, mut high) = (at(i - 1), at(i));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if fails(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    StabilityLimit::Below(low)
}
