//! The same equations in the libraries of others, used as their manuals say.

use std::hint::black_box;

use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, Rk4, SVector, System};

use crate::problem::Problem;

/// The end of a run, and how often the right-hand side was evaluated.
pub struct End<const N: usize> {
    /// y(T).
    pub y: [f64; N],
    /// Evaluations of f.
    pub evaluations: u64,
}

impl<const N: usize> End<N> {
    /// A run that failed.
    fn failed() -> Self {
        End { y: [f64::NAN; N], evaluations: 0 }
    }
}

/// A problem in the traits of both libraries.
#[derive(Clone, Copy)]
struct Shared<P>(P);

impl<P: Problem<N>, const N: usize> System<f64, SVector<f64, N>> for Shared<P> {
    #[inline(always)]
    fn system(&self, _t: f64, y: &SVector<f64, N>, dy: &mut SVector<f64, N>) {
        *dy = SVector::from(self.0.rate(&(*y).into()));
    }
}

impl<P: Problem<N>, const N: usize> ODE<f64, [f64; N]> for Shared<P> {
    #[inline(always)]
    fn diff(&self, _t: f64, y: &[f64; N], dydt: &mut [f64; N]) {
        *dydt = self.0.rate(y);
    }
}

/// `ode_solvers::Rk4`, which stores every step.
pub fn ode_solvers_rk4<P: Problem<N>, const N: usize>(p: P, y0: [f64; N], end_s: f64, steps: u64) -> End<N> {
    let mut stepper =
        Rk4::new(Shared(black_box(p)), 0.0, SVector::from(black_box(y0)), black_box(end_s), end_s / steps as f64);
    let Ok(stats) = stepper.integrate() else { return End::failed() };
    let end = stepper.y_out().last().map_or([f64::NAN; N], |y| (*y).into());
    black_box(stepper);
    End { y: end, evaluations: u64::from(stats.num_eval) }
}

/// `ode_solvers::Dop853` without dense output, the absolute tolerance equal to the relative; it stores every step.
pub fn ode_solvers_dop853<P: Problem<N>, const N: usize>(p: P, y0: [f64; N], end_s: f64, tolerance: f64) -> End<N> {
    let y0 = SVector::from(black_box(y0));
    let mut stepper = Dop853::new(Shared(black_box(p)), 0.0, black_box(end_s), end_s, y0, tolerance, tolerance);
    stepper.set_output(OutputType::Sparse);
    let Ok(stats) = stepper.integrate() else { return End::failed() };
    let end = stepper.y_out().last().map_or([f64::NAN; N], |y| (*y).into());
    black_box(stepper);
    End { y: end, evaluations: u64::from(stats.num_eval) }
}

macro_rules! differential_equations {
    ($($(#[$doc:meta])* $name:ident($setting:ident: $type:ty), $h:ident => $method:expr;)*) => {$(
        $(#[$doc])*
        pub fn $name<P: Problem<N>, const N: usize>(p: P, y0: [f64; N], end_s: f64, $setting: $type) -> End<N> {
            let ode = Shared(black_box(p));
            let $h = end_s;
            match IVP::ode(&ode, 0.0, black_box(end_s), black_box(y0)).method($method).solve() {
                Ok(solution) => {
                    let end = solution.y.last().copied().unwrap_or([f64::NAN; N]);
                    let evaluations = solution.evals.function as u64;
                    black_box(solution);
                    End { y: end, evaluations }
                }
                Err(_) => End::failed(),
            }
        }
    )*};
}
differential_equations! {
    /// `differential_equations`' Euler, which stores every step.
    differential_equations_euler(steps: u64), end => ExplicitRungeKutta::euler(end / steps as f64);
    /// `differential_equations`' RK4, which stores every step.
    differential_equations_rk4(steps: u64), end => ExplicitRungeKutta::rk4(end / steps as f64);
    /// `differential_equations`' DOP853, the absolute tolerance equal to the relative; it stores every step.
    differential_equations_dop853(tolerance: f64), _end => ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance);
}
