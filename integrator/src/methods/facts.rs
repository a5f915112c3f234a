//! What is known of a step beforehand, as data: a field that is left at [`Facts::NOTHING_KNOWN`] claims nothing.

use nalgebra::{Complex, Matrix2};

/// What a step states of itself.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// The name on the command line and in tables.
    pub id: &'static str,
    /// The name in a sentence.
    pub title: &'static str,
    /// The order of convergence on a smooth problem.
    pub order: u32,
    /// The order where the force depends on the velocity, if it is another.
    pub order_with_velocity: Option<u32>,
    /// The order on rotations, if it is another.
    pub order_on_rotations: Option<u32>,
    /// Evaluations of the force law in one step of a run under way; `None` where a step iterates until its equations are
    /// solved.
    pub evaluations: Option<u64>,
    /// Whether a step solves a system of equations, and so can fail to.
    pub implicit: bool,
    /// Whether a step is a symplectic map where the force derives from a potential; of a free rigid body, a Poisson map.
    pub symplectic: Option<bool>,
    /// Whether a step with the velocity turned around undoes a step, where the force does not depend on the velocity; of a
    /// free rigid body likewise.
    pub reversible: Option<bool>,
    /// What it keeps to rounding on every torque-free rigid body, whatever else it keeps there.
    pub conserves: &'static [Conserved],
    /// What it does to linear equations.
    pub linear: Option<LinearTheory>,
    /// Whether the theory of the scenes has been worked out for it. Without it a scene promises nothing of its errors, and
    /// only an order below `order` is a fault.
    pub worked_out: bool,
    /// The step from (t0, q0, v0) to (t1, q1, v1) in one line of plain text.
    pub formula: &'static str,
    /// The step in LaTeX, a formula a line; a is the rate of v, w the velocity of q.
    pub latex: &'static [&'static str],
    /// Who described it, or uses it.
    pub source: &'static str,
}

impl Facts {
    /// No claim: what a row of facts starts from.
    pub const NOTHING_KNOWN: Facts = Facts {
        id: "",
        title: "",
        order: 0,
        order_with_velocity: None,
        order_on_rotations: None,
        evaluations: None,
        implicit: false,
        symplectic: None,
        reversible: None,
        conserves: &[],
        linear: None,
        worked_out: false,
        formula: "",
        latex: &[],
        source: "",
    };
}

/// What a step keeps to rounding on every torque-free rigid body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Conserved {
    /// T = omega . I omega / 2.
    Energy,
    /// |L|.
    MomentumNorm,
    /// L in the world frame, as a vector.
    Momentum,
}

/// A rational function, its coefficients from the lowest power on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rational {
    /// Coefficients of the numerator.
    pub numerator: &'static [f64],
    /// Coefficients of the denominator.
    pub denominator: &'static [f64],
}

impl Rational {
    /// A polynomial.
    pub const fn polynomial(numerator: &'static [f64]) -> Self {
        Rational { numerator, denominator: &[1.0] }
    }

    /// Its value.
    #[must_use]
    pub fn at(self, z: Complex<f64>) -> Complex<f64> {
        let sum = |c: &[f64]| c.iter().rev().fold(Complex::new(0.0, 0.0), |sum, &c| sum * z + c);
        sum(self.numerator) / sum(self.denominator)
    }

    /// Its value at a matrix; NaN where the denominator is singular.
    #[must_use]
    pub fn at_matrix(self, a: Matrix2<f64>) -> Matrix2<f64> {
        let sum = |c: &[f64]| c.iter().rev().fold(Matrix2::zeros(), |sum, &c| sum * a + Matrix2::identity() * c);
        let inverse = sum(self.denominator).try_inverse().unwrap_or(Matrix2::repeat(f64::NAN));
        inverse * sum(self.numerator)
    }
}

/// What one step does to linear equations.
#[derive(Clone, Copy, Debug)]
pub enum LinearTheory {
    /// z1 = R(h A) z0 on every linear system z' = A z: a Runge-Kutta method.
    RungeKutta(Rational),
    /// Position and velocity have rules of their own.
    Partitioned {
        /// R(z) of v' = lambda v with z = h lambda: what happens to a velocity that no position acts on.
        velocity: Rational,
        /// The step of x'' = -k x - c x' with h = 1, as a matrix on (x, v).
        oscillator: fn(k: f64, c: f64) -> Matrix2<f64>,
    },
}

impl LinearTheory {
    /// R(z) of v' = lambda v, z = h lambda.
    #[must_use]
    pub fn velocity(self) -> Rational {
        match self {
            LinearTheory::RungeKutta(velocity) | LinearTheory::Partitioned { velocity, .. } => velocity,
        }
    }

    /// The step of x'' = -k x - c x' with h = 1, as a matrix on (x, v). With a step h: of k h^2 and c h, on (x, h v).
    #[must_use]
    pub fn oscillator(self, k: f64, c: f64) -> Matrix2<f64> {
        match self {
            LinearTheory::RungeKutta(factor) => factor.at_matrix(Matrix2::new(0.0, 1.0, -k, -c)),
            LinearTheory::Partitioned { oscillator, .. } => oscillator(k, c),
        }
    }

    /// Whether x'' = -k x - c x' with h = 1 stays bounded, up to `slack`: no eigenvalue of [`Self::oscillator`] is longer
    /// than one, by Jury's conditions |det| <= 1 and |trace| <= 1 + det.
    #[must_use]
    pub fn is_bounded(self, k: f64, c: f64, slack: f64) -> bool {
        let step = self.oscillator(k, c);
        let (trace, det) = (step.trace(), step.determinant());
        det.abs() <= 1.0 + slack && trace.abs() <= 1.0 + det + slack
    }
}
