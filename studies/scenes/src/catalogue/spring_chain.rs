//! Sixteen masses in a row between two walls, with equal springs: m x_i'' = k (x_(i-1) - 2 x_i + x_(i+1)).
//!
//! Modes: w_j = 2 sqrt(k / m) sin(j pi / (2 (N + 1))), shapes sqrt(2 / (N + 1)) sin(i j pi / (N + 1)), i, j = 1..N. Each
//! oscillates by itself. Source: A. L. Fetter, J. D. Walecka, Theoretical Mechanics of Particles and Continua (1980), section 24.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::{DMatrix, SVector};

use crate::catalogue::answerable;
use crate::catalogue::linear::{Linear, Parts};
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene};
use crate::special::elementary::sinc;
use crate::special::scaled::{Scaled, exponent_of_largest, f64_times_two_to};
use crate::theory::Law;
use crate::theory::{ExpectedGrowth, StabilityLimit, Theory};

/// Number of masses.
pub const MASSES: usize = 16;

scene_parameters! {
    /// Equal masses and springs in a row between two walls.
    pub struct SpringChain {
        /// Each mass.
        mass: f64 = 0.75, "kg", Positive;
        /// Stiffness of each spring.
        stiffness: f64 = 6.0, "N/m", Positive;
        /// Displacements at the start.
        x0: [f64; 16] = [
            0.125, 0.25, 0.4375, 0.625, 0.75, 0.6875, 0.5, 0.3125, 0.1875, -0.0625, -0.1875, -0.3125, -0.25, -0.1875,
            -0.125, -0.0625,
        ], "m", Finite;
        /// Velocities at the start.
        v0: [f64; 16] = [
            0.25, -0.125, 0.375, 0.5, -0.25, -0.625, -0.375, 0.125, 0.75, 0.5, 0.25, -0.5, -0.25, 0.375, 0.125, -0.375,
        ], "m/s", Finite;
    }
}

/// sin(a pi / b) with the quotient reduced exactly, a >= 0.
fn sine_of_turns(a: usize, b: usize) -> fx128 {
    let angle = fx128::PI * fx128::lit((a % (2 * b)) as f64) / fx128::lit(b as f64);
    angle.sin_cos().0
}

/// Angular frequency of mode j = 1..=n of a chain of n masses with `ratio` = k / m, rad/s.
pub fn mode_frequency(n: usize, j: usize, ratio: fx128) -> fx128 {
    fx128::lit(2.0) * ratio.sqrt() * sine_of_turns(j, 2 * (n + 1))
}

/// The motion of a chain of N masses with `ratio` = k / m, by modes, in double-double.
pub fn chain_motion<const N: usize>(
    ratio: fx128,
    x0: &[f64; N],
    v0: &[f64; N],
    t: fx128,
) -> (SVector<fx128, N>, SVector<fx128, N>) {
    chain_at(Scaled::of_wide(ratio), x0, v0, t)
}

/// The same; in units of the largest start, and of the time.
fn chain_at<const N: usize>(
    ratio: Scaled,
    x0: &[f64; N],
    v0: &[f64; N],
    t: fx128,
) -> (SVector<fx128, N>, SVector<fx128, N>) {
    if t.0 == 0.0 {
        let start = |values: &[f64; N]| SVector::from(values.map(fx128::lit));
        return (start(x0), start(v0));
    }
    let zero = SVector::from([fx128::ZERO; N]);
    // Displacements and velocities (times the time) from the displaced start, and from the moving one.
    let (mut x, mut v) = ([zero; 2], [zero; 2]);
    let (time, base) = (Scaled::of_wide(t), ratio.sqrt());
    let units = [exponent_of_largest(x0), exponent_of_largest(v0)];
    let start = [(x0, units[0]), (v0, units[1])];
    let weight = fx128::lit(2.0) / fx128::lit((N + 1) as f64);
    for j in 1..=N {
        let shape: [fx128; N] = std::array::from_fn(|i| sine_of_turns((i + 1) * j, N + 1));
        let [a, b] = start.map(|(values, unit)| {
            let unit = |c: f64| fx128::lit(f64_times_two_to(c, -unit));
            shape.iter().zip(values).fold(fx128::ZERO, |sum, (&s, &c)| sum + s * unit(c)) * weight
        });
        let phase = base.times(time).times(Scaled::of_wide(mode_frequency(N, j, fx128::ONE))).value();
        let (sine, cosine) = phase.sin_cos();
        let sinc = sinc(phase);
        for i in 0..N {
            x[0][i] += shape[i] * (a * cosine);
            v[0][i] -= shape[i] * (a * phase * sine);
            x[1][i] += shape[i] * (b * sinc);
            v[1][i] += shape[i] * (b * cosine);
        }
    }
    let one = Scaled::of(1.0);
    let [x_unit, v_unit] = units.map(|unit| one.shifted(unit));
    let sum = |factors: [Scaled; 2], parts: [SVector<fx128, N>; 2]| {
        SVector::from_fn(|i, _| {
            let terms = [0, 1].map(|k| factors[k].times(Scaled::of_wide(parts[k][i])));
            Scaled::sum(&terms)
        })
    };
    (sum([x_unit, v_unit.times(time)], x), sum([x_unit.over(time), v_unit], v))
}

impl SpringChain {
    /// k / m, 1/s^2.
    fn ratio(&self) -> Scaled {
        Scaled::of(self.stiffness).over(Scaled::of(self.mass))
    }

    /// Angular frequency of the stiffest mode, rad/s.
    pub fn stiffest(&self) -> f64 {
        let of_one = Scaled::of_wide(mode_frequency(MASSES, MASSES, fx128::ONE));
        self.ratio().sqrt().times(of_one).value().to_f64()
    }

    /// The matrix of x'' = S x.
    pub fn stiffness_matrix(&self) -> DMatrix<f64> {
        let ratio = self.stiffness / self.mass;
        DMatrix::from_fn(MASSES, MASSES, |i, j| match i.abs_diff(j) {
            0 => -2.0 * ratio,
            1 => ratio,
            _ => 0.0,
        })
    }

    fn linear(&self) -> Linear {
        Linear::new(&Parts {
            stiffness: self.stiffness_matrix(),
            damping: DMatrix::zeros(MASSES, MASSES),
            forcing: &[0.0; MASSES],
            drive: 0.0,
            q0: &self.x0,
            v0: &self.v0,
        })
    }
}

impl<T: Real> Model<T> for SpringChain {
    type Config = SVector<T, MASSES>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Self::Config>) -> SVector<T, MASSES> {
        let (x, wall) = (&s.q, T::lit(0.0));
        let ratio = T::lit(self.stiffness) / T::lit(self.mass);
        SVector::<T, MASSES>::from_fn(|i, _| {
            let left = if i == 0 { wall } else { x[i - 1] };
            let right = if i + 1 == MASSES { wall } else { x[i + 1] };
            ((left - x[i]) + (right - x[i])) * ratio
        })
    }
}

impl<T: Single> Motion<T> for SpringChain {
    fn exact(&self, t: T) -> State<Self::Config> {
        let (x, v) = chain_at(self.ratio(), &self.x0, &self.v0, t.widen());
        rounded(x, v)
    }
    fn observe(&self, s: &State<Self::Config>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for SpringChain {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.25, coarsest_steps: 4 }.at(self.stiffest() / 5.6);
        Info {
            kind: Kind::Oscillation,
            about: "sixteen masses and springs: the stiffest mode sets the step, whether it moves or not",
            equation: r"m\,\ddot x_i = k\,(x_{i-1} - 2x_i + x_{i+1}),\quad i = 1,\dots,16,\quad x_0 = x_{17} = 0",
            source: "normal modes (A. L. Fetter, J. D. Walecka, Theoretical Mechanics (1980), section 24)",
            horizon_s: pace.horizon_s,
            time_scale_s: 1.0 / self.stiffest(),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let end_s = self.info().horizon_s;
        answerable::phase("spring-chain", ("stiffness", &self.stiffness), self.stiffest() * end_s, end_s)?;
        let seen = Motion::<f64>::observe(self, &self.exact(end_s));
        answerable::range("spring-chain", self, &seen, end_s)
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position), seen.vector(Quantity::Velocity));
        let square = |sum: fx128, c: fx128| sum + c * c;
        let kinetic = v.iter().copied().fold(fx128::ZERO, square) * fx128::lit(self.mass);
        let inner = x.windows(2).map(|pair| pair[1] - pair[0]);
        let stretched = inner.chain([x[0], x[MASSES - 1]]).fold(fx128::ZERO, square) * fx128::lit(self.stiffness);
        let momentum = v.iter().fold(fx128::ZERO, |sum, &c| sum + c) * fx128::lit(self.mass);
        vec![
            Entry {
                invariant: Invariant::Energy,
                value: vec![(kinetic + stretched) * fx128::lit(0.5)],
                conserved: true,
            },
            // The walls push.
            Entry { invariant: Invariant::Momentum, value: vec![momentum], conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        self.linear().theory(method, quantity, end_s)
    }

    fn growth(&self, method: MethodId, invariant: Invariant, _h_s: f64) -> Option<ExpectedGrowth> {
        let (law, reason) = match method {
            MethodId::SemiImplicitEuler => (Law::Bounded, "each mode keeps v^2 + w^2 x^2 - w^2 h x v"),
            MethodId::VelocityVerlet => (Law::Bounded, "each mode keeps v^2 + w^2 (1 - w^2 h^2/4) x^2"),
            MethodId::ImplicitMidpoint => (Law::AtTheFloor, "quadratic invariants are conserved exactly"),
            _ => return None,
        };
        (invariant == Invariant::Energy).then_some(ExpectedGrowth { law, bounds: None, seen_after_s: 0.0, reason })
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        let below = |z: f64| StabilityLimit::Below(z / self.stiffest());
        Some(match method {
            MethodId::ExplicitEuler => (StabilityLimit::NoStep, "every mode grows, the stiffest by 1 + w^2 h^2 a step"),
            MethodId::SemiImplicitEuler | MethodId::VelocityVerlet => (below(2.0), "w h <= 2 in the stiffest mode"),
            MethodId::Rk4 => (below(8.0_f64.sqrt()), "w h <= sqrt(8) in the stiffest mode"),
            MethodId::ImplicitEuler | MethodId::ImplicitMidpoint => (StabilityLimit::Unlimited, "A-stable"),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_the_eigenvectors_that_a_numerical_solver_finds() {
        let chain = SpringChain::default();
        let ratio = chain.stiffness / chain.mass;
        let s = chain.stiffness_matrix();
        let matrix = faer::Mat::from_fn(MASSES, MASSES, |i, j| -s[(i, j)]);
        let found = matrix.self_adjoint_eigen(faer::Side::Lower).expect("a finite symmetric matrix");
        for j in 1..=MASSES {
            let w = mode_frequency(MASSES, j, fx128::lit(ratio)).to_f64();
            // A backward stable solver errs by a few eps times the norm of the matrix, 4 k / m.
            let error = (found.S()[j - 1] - w * w).abs();
            assert!(error <= 16.0 * f64::EPSILON * 4.0 * ratio, "mode {j}: {error:e}");
            let shape: Vec<f64> = (1..=MASSES).map(|i| sine_of_turns(i * j, MASSES + 1).to_f64()).collect();
            let overlap: f64 = (0..MASSES).map(|i| shape[i] * found.U()[(i, j - 1)]).sum();
            let aligned = overlap.abs() * (2.0 / (MASSES + 1) as f64).sqrt();
            assert!((aligned - 1.0).abs() <= 64.0 * f64::EPSILON, "mode {j}: {aligned}");
        }
    }
}
