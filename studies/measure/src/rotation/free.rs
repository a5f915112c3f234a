//! A free body, followed in double-double or f64 with any scheme: for laws that hold for one step.

use faer::fx128;
use integrator::{Real, Single};
use nalgebra::Vector3;

use super::scheme::{Rule, Scheme};
use scenes::TorqueFreeSpin;
use scenes::observation::{Observation, Quantity};
use scenes::run::{Precision, Run, Trajectory, run_body, run_step};

/// A free body at an instant: body components.
#[derive(Clone, Copy, Debug)]
pub struct Free {
    /// Principal moments of inertia, kg m^2.
    pub inertia: Vector3<fx128>,
    /// Angular velocity, body frame, rad/s.
    pub omega: Vector3<fx128>,
    /// Angular momentum, world frame, kg m^2/s.
    pub momentum_world: Vector3<fx128>,
}

/// a . b.
pub fn dot(a: Vector3<fx128>, b: Vector3<fx128>) -> fx128 {
    integrator::rotation::dot(a, b)
}

impl Free {
    /// What is seen of a body with these moments of inertia.
    pub fn of(inertia: [f64; 3], seen: &Observation) -> Option<Self> {
        let attitude = seen.rotation()?;
        let inertia = Vector3::from(inertia.map(fx128::lit));
        let omega = attitude.rotate_back(Vector3::from_column_slice(seen.vector(Quantity::AngularVelocity)));
        Some(Free { inertia, omega, momentum_world: attitude.rotate(inertia.component_mul(&omega)) })
    }

    /// l = I omega, body frame.
    pub fn momentum(&self) -> Vector3<fx128> {
        self.inertia.component_mul(&self.omega)
    }

    /// 2 T.
    pub fn twice_energy(&self) -> fx128 {
        dot(self.omega, self.momentum())
    }

    /// |L|^2.
    pub fn momentum_squared(&self) -> fx128 {
        dot(self.momentum(), self.momentum())
    }

    /// (2T/|L|^2 - 1/I_max) / (1/I_min - 1/I_max): 0 where the body spins about its axis of greatest inertia, 1 about that of
    /// least; the exact motion keeps it.
    pub fn axis_coordinate(&self) -> f64 {
        let inverse = self.inertia.map(|i| (fx128::ONE / i).to_f64());
        let (low, high) = (inverse.min(), inverse.max());
        ((self.twice_energy() / self.momentum_squared()).to_f64() - low) / (high - low)
    }
}

/// Runs a free body in the given arithmetic.
pub fn run<T: Single>(scheme: Scheme, body: &TorqueFreeSpin, end_s: f64, steps: u64, stride: u64) -> Trajectory {
    // The arithmetic is the type; the field is not read.
    let precision = Precision::F64;
    match scheme.rule {
        Rule::General(method) => {
            run_body::<T, _>(body, &scheme.stored(Run::new(method, precision, end_s, steps)), stride)
        }
        Rule::Rigid(step) => run_step::<T, _>(body, &scheme.stored(Run::new(step, precision, end_s, steps)), stride),
    }
}
