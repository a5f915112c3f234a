//! What the rigid-body scenes share.

use faer::fx128;
use integrator::pose::Fixed;
use integrator::rigid_body::Kinematics;
use integrator::{Real, Rotation, Vector};
use nalgebra::Vector3;

use crate::error::Error;
use crate::observation::{Observation, Quantity};
use crate::scene::{Balance, Entry};

/// The motion of a body with a fixed point.
pub(crate) fn fixed_point<T: Real>(attitude: Rotation<T>, omega_body: Vector3<T>) -> Kinematics<T, Fixed<T>> {
    Kinematics { position: Fixed::zero(), velocity: Fixed::zero(), attitude, omega_body }
}

/// Rotational energy plus `potential`, and angular momentum in the world frame.
pub(crate) fn account(
    inertia: [f64; 3],
    seen: &Observation,
    potential: fx128,
    energy_conserved: bool,
    momentum_conserved: bool,
) -> Vec<Entry> {
    let Some(attitude) = seen.rotation() else { return Vec::new() };
    let omega_world = Vector3::from_column_slice(seen.vector(Quantity::AngularVelocity));
    let omega_body = attitude.rotate_back(omega_world);
    let momentum_body = omega_body.component_mul(&Vector3::from(inertia.map(fx128::lit)));
    let twice_energy = integrator::rotation::dot(omega_body, momentum_body);
    let momentum = attitude.rotate(momentum_body);
    vec![
        Entry {
            balance: Balance::Energy,
            value: vec![twice_energy * fx128::lit(0.5) + potential],
            conserved: energy_conserved,
        },
        Entry {
            balance: Balance::AngularMomentum,
            value: momentum.iter().copied().collect(),
            conserved: momentum_conserved,
        },
    ]
}

/// Moments of inertia of a body that can exist (none exceeds the sum of the other two), and a quaternion that is not zero.
pub(crate) fn check(scene: &str, inertia: [f64; 3], attitude: [f64; 4]) -> Result<(), Error> {
    let refuse = |parameter: &str, value: String, expected: &str| {
        Err(Error::Parameter {
            scene: scene.to_owned(),
            parameter: parameter.to_owned(),
            value,
            expected: expected.to_owned(),
        })
    };
    let [a, b, c] = inertia;
    // Flat bodies have equality; sums of decimals may miss it by a rounding.
    let slack = 4.0 * f64::EPSILON * (a + b + c);
    if a > b + c + slack || b > a + c + slack || c > a + b + slack {
        return refuse(
            "inertia",
            format!("{a},{b},{c}"),
            "no moment of inertia of a rigid body exceeds the sum of the other two",
        );
    }
    if attitude.iter().all(|&x| x == 0.0) {
        return refuse("attitude", "0,0,0,0".to_owned(), "must not be the zero quaternion");
    }
    Ok(())
}
