//! What a scene states of its motion, against the exact motion itself.

use integrator::Vector;
use nalgebra::Vector3;
use scenes::erased::{AnyMotion, BodyMotion};
use scenes::scene::Scene;
use scenes::{DampedOscillator, Pendulum};

/// Of omega at 17 times: the largest part across the principal axis nearest to it, and the largest second difference, both as
/// parts of omega.
fn bent<P: Vector<f64>>(motion: BodyMotion<'_, P>, end_s: f64) -> [f64; 2] {
    let at = |k: u32| -> Vector3<f64> { motion.exact(end_s * f64::from(k) / 16.0).omega_body };
    let across = |omega: Vector3<f64>| (omega.norm_squared() - omega.amax().powi(2)) / omega.norm_squared();
    let second = |k: u32| (at(k + 1) - at(k) * 2.0 + at(k - 1)).norm() / at(k).norm();
    [(0..17).map(at).map(across).fold(0.0, f64::max), (1..16).map(second).fold(0.0, f64::max)]
}

// Fails if: a scene states that it turns about one axis with a constant acceleration where it does not, or does not state it where it
// does; a rigid body has no attitude.
#[test]
fn a_body_is_spun_up_evenly_where_it_says_so_and_nowhere_else() {
    let mut evenly = Vec::new();
    for any in scenes::all() {
        let end_s = any.scene().info().horizon_s;
        let bent = match any.any_motion() {
            AnyMotion::Pivoted(motion) => Some(bent(motion, end_s)),
            AnyMotion::Flying(motion) => Some(bent(motion, end_s)),
            AnyMotion::Few(_) | AnyMotion::Many(_) => None,
        };
        let has_attitude = any.exact(faer::fx128::ZERO).rotation().is_some();
        assert_eq!((any.is_rigid(), bent.is_some()), (has_attitude, has_attitude), "{}", any.id());
        // Differences of a few rounded numbers of the same size: a few eps. Where it is not that, it is no accident.
        let is_even = bent.is_some_and(|bent| bent.iter().all(|part| *part <= 16.0 * f64::EPSILON));
        assert!(is_even || bent.is_none_or(|bent| bent.iter().any(|part| *part > 1e-4)), "{}: {bent:?}", any.id());
        assert_eq!(any.scene().has_constant_angular_acceleration(), is_even, "{}", any.id());
        evenly.extend(is_even.then(|| any.id()));
    }
    assert!(evenly.contains(&"principal-axis-torque"), "{evenly:?}");
}

// Fails if: a fact is that of the name of a scene and not of its parameters.
#[test]
fn facts_follow_the_parameters() {
    let damped = |zeta| DampedOscillator { zeta, ..DampedOscillator::default() };
    assert_eq!([0.0, 0.5, 1.0, 1.5].map(|zeta| damped(zeta).is_periodic()), [true, true, false, false]);
    assert_eq!([0.0, 0.5].map(|zeta| damped(zeta).rounding_accumulates()), [true, false]);
    // Over the top at omega^2 = 4 g / l from the lowest position: 4 where g / l = 4.
    let pushed = |omega| Pendulum { gravity: 6.0, length: 1.5, angle: 0.0, omega, ..Pendulum::default() };
    assert_eq!([3.875, -3.875, 4.125, -4.125].map(|w| pushed(w).rounding_accumulates()), [true, true, false, false]);
    for id in ["bouncing-ball", "bouncing-ball/inelastic"] {
        let any = scenes::by_id(id).expect("a scene");
        assert!(!any.scene().is_periodic() && !any.scene().rounding_accumulates(), "{id}");
    }
}
