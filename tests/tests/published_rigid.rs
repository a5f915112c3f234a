//! Numbers that Gazebo's benchmark and MuJoCo's tests print for rigid bodies, from this integrator.

use measure::rotation::published::{Comparison, comparisons};

fn of(id: &str) -> Vec<Comparison> {
    let all = comparisons().expect("the embedded data are well-formed");
    all.into_iter().filter(|comparison| comparison.published.id == id).collect()
}

fn assert_agrees(comparison: &Comparison) {
    let Comparison { published, ours } = comparison;
    assert!(
        comparison.agrees(),
        "{} {} at h = {:?}: printed {}, ours {ours}",
        published.id,
        published.quantity,
        published.step_s,
        published.value
    );
}

// Fails if: the gyroscopic term uses the attitude after the step, the linear update uses the old omega or is not normalised,
// Newton's Jacobian lacks a term, or position moves with the old velocity.
#[test]
fn all_sixty_gazebo_values_are_found_to_their_printed_digits() {
    let all = of("gazebo-boxes");
    assert_eq!(all.len(), 60);
    all.iter().for_each(assert_agrees);
}

// Fails if: the gyroscopic torque has the wrong sign, or the implicit one is iterated to the end.
#[test]
fn both_mujoco_energy_ratios_are_found_to_their_printed_digits() {
    let all = of("mujoco-box");
    assert_eq!(all.len(), 2);
    all.iter().for_each(assert_agrees);
    // More digits, from another implementation of the same setting.
    let more = [1.0869, 0.9260];
    for (comparison, digits) in all.iter().zip(more) {
        assert!((comparison.ours - digits).abs() <= 0.5e-4, "{} against {digits}", comparison.ours);
    }
}

/// The numbers tell the schemes apart: those of one method are not those printed for the other. (The position is: both move
/// the centre of mass alike.)
#[test]
fn the_printed_numbers_of_one_scheme_are_not_those_of_the_other() {
    let all = of("gazebo-boxes");
    let (world, body) = all.split_at(30);
    assert!(world[0].published.method != body[0].published.method);
    let rotational = world.iter().zip(body).filter(|(a, _)| !a.published.quantity.contains('p'));
    let mut compared = 0;
    for (a, b) in rotational {
        assert_eq!((a.published.step_s, &a.published.quantity), (b.published.step_s, &b.published.quantity));
        let swapped = Comparison { published: a.published.clone(), ours: b.ours };
        assert!(!swapped.agrees(), "{} at {:?}", a.published.quantity, a.published.step_s);
        compared += 1;
    }
    assert_eq!(compared, 20);
}

/// Half a unit of the last printed digit, and no more.
#[test]
fn agreement_ends_at_half_a_unit_of_the_last_digit() {
    for comparison in of("gazebo-boxes").into_iter().chain(of("mujoco-box")) {
        let printed = comparison.published.value;
        let inside = Comparison { ours: printed + 0.999 * comparison.tolerance(), ..comparison.clone() };
        let outside = Comparison { ours: printed - 1.001 * comparison.tolerance(), ..comparison };
        assert!(inside.agrees() && !outside.agrees(), "{printed}");
    }
}
