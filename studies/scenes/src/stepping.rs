//! Steps of a scene from a displaced start, and what a step does to small displacements.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Real, Single};

use crate::any::AnyScene;
use crate::observation::{Observation, Quantity, Value};
use crate::run::{Precision, Run, Trajectory};

/// What is stepped, and how.
#[derive(Clone, Copy)]
pub struct Stepping<'a> {
    /// The scene.
    pub scene: &'a dyn AnyScene,
    /// The rule of a step.
    pub method: MethodId,
    /// The arithmetic.
    pub precision: Precision,
}

impl Stepping<'_> {
    /// `steps` steps of length `h_s` from the start moved by `displacement`; `None` where the scene's space is curved.
    pub fn walk(&self, h_s: f64, steps: u64, displacement: &[f64], samples: &[u64]) -> Option<Trajectory> {
        let run = Run::new(self.method, self.precision, h_s * steps as f64, steps);
        self.scene.run_displaced(&run, displacement, samples)
    }
}

/// The coordinates of a state of a flat space: configuration, then velocity.
pub fn coordinates(seen: &Observation) -> Vec<fx128> {
    seen.values
        .iter()
        .flat_map(|(_, value)| match value {
            Value::Vector(components) => components.as_slice(),
            Value::Rotation(_) => &[],
        })
        .copied()
        .collect()
}

/// Number of coordinates of the scene's configuration.
pub fn dimension(scene: &dyn AnyScene) -> usize {
    let start = scene.exact(fx128::ZERO);
    start.vector(Quantity::Velocity).len().max(start.vector(Quantity::AngularVelocity).len())
}

/// The spectral radius of one step of an oscillator: of its 2 x 2 matrix M with columns S(y0 + e_j) - S(y0). `None` where a
/// state is more than two numbers, or a step failed.
///
/// With the half trace m and the determinant d: |m| + sqrt(m^2 - d) where that is real, sqrt(d) where it is not.
pub fn spectral_radius(stepping: &Stepping<'_>, h_s: f64) -> Option<f64> {
    let step = |displacement: &[f64]| {
        let end = stepping.walk(h_s, 1, displacement, &[1])?;
        <[fx128; 2]>::try_from(coordinates(end.end()?)).ok()
    };
    let (origin, q, v) = (step(&[])?, step(&[1.0])?, step(&[0.0, 1.0])?);
    let (a, c) = (q[0] - origin[0], q[1] - origin[1]);
    let (b, d) = (v[0] - origin[0], v[1] - origin[1]);
    let half_trace = ((a + d) * fx128::lit(0.5)).to_f64();
    let determinant = (a * d - b * c).to_f64();
    let discriminant = half_trace * half_trace - determinant;
    Some(if discriminant > 0.0 { half_trace.abs() + discriminant.sqrt() } else { determinant.sqrt() })
}
