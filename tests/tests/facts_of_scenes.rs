//! What a scene states of its motion, against the exact motion itself.

use integrator::Vector;
use nalgebra::Vector3;
use scenes::any::AnyScene;
use scenes::erased::{AnyMotion, BodyMotion};
use scenes::scene::Scene;
use scenes::{DampedOscillator, Pendulum, SymmetricTop, TorqueFreeSpin};

/// |omega x I omega| and the part of omega across the principal axis nearest to it, the largest of 16 times, each in parts of
/// the largest that it could be.
fn spin<P: Vector<f64>>(motion: BodyMotion<'_, P>, end_s: f64) -> [f64; 2] {
    let inertia = motion.inertia();
    (0..16).fold([0.0, 0.0], |[gyroscopic, across], k| {
        let omega: Vector3<f64> = motion.exact(end_s * f64::from(k) / 16.0).omega_body;
        let momentum = inertia.component_mul(&omega);
        let off = omega.norm_squared() - omega.amax().powi(2);
        [
            gyroscopic.max(omega.cross(&momentum).norm() / (omega.norm() * momentum.norm())),
            across.max(off / omega.norm_squared()),
        ]
    })
}

fn spin_of(any: &dyn AnyScene) -> Option<[f64; 2]> {
    let end_s = any.scene().info().horizon_s;
    match any.any_motion() {
        AnyMotion::Pivoted(motion) => Some(spin(motion, end_s)),
        AnyMotion::Flying(motion) => Some(spin(motion, end_s)),
        AnyMotion::Few(_) | AnyMotion::Many(_) => None,
    }
}

// Fails if: a scene states that its gyroscopic term vanishes, or that it turns about one axis, where it does not; or does not state
// it where it does.
#[test]
fn the_gyroscopic_term_vanishes_along_the_motions_that_say_so_and_no_others() {
    let mut without = Vec::new();
    for any in scenes::all() {
        let Some([gyroscopic, across]) = spin_of(any.as_ref()) else {
            assert!(!any.is_rigid() && any.exact(faer::fx128::ZERO).rotation().is_none(), "{}", any.id());
            continue;
        };
        assert!(any.is_rigid() && any.exact(faer::fx128::ZERO).rotation().is_some(), "{}", any.id());
        // A vector product of two rounded vectors: a few eps of their lengths. Where it does not vanish it is no accident.
        let vanishes = |part: f64| {
            assert!(part <= 16.0 * f64::EPSILON || part > 1e-3, "{}: {part:e} is neither", any.id());
            part <= 16.0 * f64::EPSILON
        };
        assert_eq!(any.scene().gyroscopic_term_vanishes(), vanishes(gyroscopic), "{}", any.id());
        assert_eq!(any.scene().turns_about_one_axis(), across <= 16.0 * f64::EPSILON, "{}", any.id());
        without.extend(vanishes(gyroscopic).then(|| any.id()));
    }
    assert_eq!(without.len(), 2, "{without:?}");
}

// Fails if: a fact is that of the name of a scene and not of its parameters.
#[test]
fn facts_follow_the_parameters() {
    let even = TorqueFreeSpin { inertia: [1.25; 3], ..TorqueFreeSpin::default() };
    let about_axis = TorqueFreeSpin { omega: [0.0, 1.5, 0.0], ..TorqueFreeSpin::default() };
    let sphere = SymmetricTop { inertia_3: 1.25, ..SymmetricTop::disc() };
    assert!([&even as &dyn Scene, &about_axis, &sphere].iter().all(|scene| scene.gyroscopic_term_vanishes()));
    assert!(!TorqueFreeSpin::default().gyroscopic_term_vanishes() && !SymmetricTop::rod().gyroscopic_term_vanishes());

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
