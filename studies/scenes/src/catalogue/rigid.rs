//! What the rigid-body scenes share.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::pose::Fixed;
use integrator::rigid_body::Kinematics;
use integrator::{Real, Rotation, Single, Vector};
use nalgebra::Vector3;

use crate::catalogue::answerable;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::observation::{Observation, Quantity};
use crate::parameters::ParameterValue;
use crate::scene::Info;
use crate::special::free_top::{UNSTABLE_RADIANS, has_vanishing_component};
use crate::theory::Theory;

/// The motion of a body with a fixed point.
pub(crate) fn fixed_point<T: Real>(attitude: Rotation<T>, omega_body: Vector3<T>) -> Kinematics<T, Fixed<T>> {
    Kinematics { position: Fixed::zero(), velocity: Fixed::zero(), attitude, omega_body }
}

/// The nearest rotation in another arithmetic.
pub(crate) fn narrow<T: Single>(q: Rotation<fx128>) -> Rotation<T> {
    Rotation { w: T::narrow(q.w), v: q.v.map(T::narrow) }
}

/// Energy less the work, and angular momentum less the impulse, of a torque that is constant in the world, on a body in
/// which omega' = tau / I: both are conserved, though neither energy nor angular momentum is.
pub(crate) fn account_less_torque(
    inertia: [f64; 3],
    about_torque: f64,
    torque: Vector3<fx128>,
    omega0: Vector3<fx128>,
    t: fx128,
    seen: &Observation,
) -> Vec<Entry> {
    let dot = integrator::rotation::dot;
    let gained = dot(torque, torque) * t / fx128::lit(2.0 * about_torque);
    let work = (dot(torque, omega0) + gained) * t;
    let mut entries = invariants(inertia, seen, -work, true, true);
    for entry in entries.iter_mut().filter(|entry| entry.invariant == Invariant::AngularMomentum) {
        entry.value.iter_mut().zip(torque.iter()).for_each(|(l, &c)| *l -= c * t);
    }
    entries
}

/// By how much a disturbance of a spin about a principal axis grows while the body turns by phi: as 1 + phi, and about the axis of the
/// intermediate moment as exp(k phi) besides, k^2 = (I - I_a) (I_b - I) / (I_a I_b) with the moments I_a and I_b of the other axes. A
/// momentum turns into an angular velocity with the moments' ratio.
pub(crate) fn amplification(inertia: [f64; 3], axis: usize, turned: f64) -> f64 {
    let [own, a, b] = [0, 1, 2].map(|i| inertia[(axis + i) % 3]);
    let rate = ((own - a) * (b - own) / (a * b)).max(0.0).sqrt();
    let [least, largest] = [own.min(a).min(b), own.max(a).max(b)];
    (1.0 + turned) * (rate * turned).exp() * largest / least
}

/// The same for a free body: 1 unless it spins about one axis alone.
pub(crate) fn free_amplification(inertia: [f64; 3], omega: [f64; 3], end_s: f64) -> f64 {
    let along: Vec<usize> = (0..3).filter(|&i| omega[i] != 0.0).collect();
    match along[..] {
        [axis] => amplification(inertia, axis, omega[axis].abs() * end_s),
        _ => 1.0,
    }
}

/// What theory says where omega_world' is constant: omega is exact, and an Euler method that drifts with the omega of one end
/// of the step is wrong by -+ (tau / I) h / 2 in it. Seen from the body that adds up to h / 2 times the integral of
/// R^T tau / I = omega_body', so that the angle is off by h / 2 times `gained` = |omega_body(T) - omega_body(0)|.
pub(crate) fn theory_of_constant_torque(method: MethodId, quantity: Quantity, gained: f64) -> Theory {
    match (method, quantity) {
        (_, Quantity::AngularVelocity) => Theory::exact("omega is linear in t, and every method sums it exactly"),
        (MethodId::ExplicitEuler | MethodId::SemiImplicitEuler | MethodId::ImplicitEuler, _) => Theory::with_constant(
            method,
            0.5 * gained,
            "omega of one end of the step: the angle is off by |omega_body(T) - omega_body(0)| h / 2",
        ),
        _ => Theory::usual(method),
    }
}

/// Rotational energy plus `potential`, and angular momentum in the world frame.
pub(crate) fn invariants(
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
            invariant: Invariant::Energy,
            value: vec![twice_energy * fx128::lit(0.5) + potential],
            conserved: energy_conserved,
        },
        Entry {
            invariant: Invariant::AngularMomentum,
            value: momentum.iter().copied().collect(),
            conserved: momentum_conserved,
        },
    ]
}

/// Energy with the potential -m g . x, momentum, and angular momentum about the centre of mass; whether they are conserved
/// is left to the scene.
pub(crate) fn account_of_flight(
    mass: f64,
    inertia: [f64; 3],
    gravity: Vector3<fx128>,
    seen: &Observation,
) -> Vec<Entry> {
    let dot = integrator::rotation::dot;
    let mass = fx128::lit(mass);
    let [x, v] = [Quantity::Position, Quantity::Velocity].map(|q| Vector3::from_column_slice(seen.vector(q)));
    let translation = mass * (dot(v, v) * fx128::lit(0.5) - dot(gravity, x));
    let mut entries = invariants(inertia, seen, translation, true, true);
    let momentum = v.iter().map(|&c| c * mass).collect();
    entries.push(Entry { invariant: Invariant::Momentum, value: momentum, conserved: false });
    entries
}

/// A free body whose phase double-double resolves, and of which no part of omega is too small to be followed.
pub(crate) fn check_free(scene: &str, info: &Info, omega: &[f64; 3]) -> Result<(), Error> {
    let angle = Vector3::from(*omega).norm() * info.horizon_s;
    answerable::phase(scene, ("omega", omega), angle, info.horizon_s)?;
    if angle <= UNSTABLE_RADIANS || !has_vanishing_component(*omega) {
        return Ok(());
    }
    Err(Error::Parameter {
        scene: scene.to_owned(),
        parameter: "omega".to_owned(),
        value: omega.show(),
        expected: "a component is below 1e-130 of another, and may grow beyond it in the time of a run: make it 0"
            .to_owned(),
    })
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
