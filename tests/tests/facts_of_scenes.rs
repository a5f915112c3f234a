//! What a scene states of its motion, against the exact motion itself.

use integrator::Vector;
use nalgebra::Vector3;
use scenes::erased::{AnyMotion, BodyMotion};
use scenes::scene::Scene;
use scenes::{DampedOscillator, Pendulum};

/// The part of omega across the principal axis nearest to it, the largest of 16 times, as a part of omega.
fn across<P: Vector<f64>>(motion: BodyMotion<'_, P>, end_s: f64) -> f64 {
    let at = |k: u32| -> Vector3<f64> { motion.exact(end_s * f64::from(k) / 16.0).omega_body };
    let across = |omega: Vector3<f64>| (omega.norm_squared() - omega.amax().powi(2)) / omega.norm_squared();
    (0..16).map(at).map(across).fold(0.0, f64::max)
}

// Fails if: a scene states that it turns about one axis where it does not, or does not state it where it does; a rigid body has no
// attitude.
#[test]
fn a_body_turns_about_one_axis_where_it_says_so_and_nowhere_else() {
    let mut about_one = Vec::new();
    for any in scenes::all() {
        let end_s = any.scene().info().horizon_s;
        let across = match any.any_motion() {
            AnyMotion::Pivoted(motion) => Some(across(motion, end_s)),
            AnyMotion::Flying(motion) => Some(across(motion, end_s)),
            AnyMotion::Few(_) | AnyMotion::Many(_) => None,
        };
        let has_attitude = any.exact(faer::fx128::ZERO).rotation().is_some();
        assert_eq!((any.is_rigid(), across.is_some()), (has_attitude, has_attitude), "{}", any.id());
        // A difference of two rounded squares: a few eps. Where it is not that, it is no accident.
        let along = across.is_some_and(|across| across <= 16.0 * f64::EPSILON);
        assert!(along || across.is_none_or(|across| across > 1e-3), "{}: {across:?} is neither", any.id());
        assert_eq!(any.scene().turns_about_one_axis(), along, "{}", any.id());
        about_one.extend(along.then(|| any.id()));
    }
    assert_eq!(about_one, ["principal-axis-torque"]);
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
