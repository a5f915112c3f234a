//! Parameters that users set and that once got a wrong verdict, each by name.

use integrator::methods::MethodId;
use measure::convergence::{Convergence, Measure, OrderRow, orders};
use measure::study::{Selection, Study};
use measure::sweep::Progress;
use reports::{Claim, Verdict};
use scenes::observation::Quantity;
use scenes::run::Precision;
use scenes::scheme::Scheme;
use verification::programs::{program, run, text};

const ALL: &[MethodId] = MethodId::ALL;

fn selection(id: &str, set: &[(&str, &str)], methods: &[MethodId]) -> Selection {
    let mut scene = scenes::by_id(id).expect("a scene");
    for (name, value) in set {
        scene.scene_mut().set(id, name, value).expect("an allowed value");
    }
    scene.scene().check().expect("a motion");
    Selection {
        scenes: vec![scene],
        methods: methods.to_vec(),
        schemes: Vec::new(),
        precisions: vec![Precision::DoubleDouble],
        steps: Vec::new(),
        length: None,
        quick: false,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    }
}

/// Every claim holds.
fn assert_holds(claims: &[Claim], what: &str) {
    assert!(!claims.is_empty(), "{what}: no claim");
    for claim in claims {
        assert_eq!(claim.verdict, Verdict::Holds, "{what}: {}: {}", claim.id, claim.measured);
    }
}

fn converges(id: &str, set: &[(&str, &str)], methods: &[MethodId]) -> Vec<OrderRow> {
    let rows = Convergence::measure(&selection(id, set, methods));
    assert_holds(&Convergence::claims(&rows), &format!("{id} {set:?}"));
    orders(&rows)
}

/// All that theory says of a sweep in one quantity, the largest error of the run.
fn largest(orders: &[OrderRow], method: MethodId, quantity: Quantity) -> &OrderRow {
    let of = |o: &&OrderRow| (o.method.as_str(), o.quantity, o.measure) == (method.id(), quantity, Measure::Max);
    orders.iter().find(of).expect("a sweep")
}

// Fails if: an error is called saturated beside the end of a motion that has died away, or a constant that decayed taken for zero.
#[test]
fn a_motion_that_has_died_away_is_judged_by_what_it_was() {
    let seen = converges(
        "damped-oscillator",
        &[("mass", "1"), ("stiffness", "200"), ("zeta", "0.5")],
        &[MethodId::SemiImplicitEuler],
    );
    assert!(
        (largest(&seen, MethodId::SemiImplicitEuler, Quantity::Position).order.expect("a slope") - 1.0).abs() < 0.1
    );
    let seen = converges("linear-drag", &[("mass", "1"), ("drag", "15")], &[MethodId::ExplicitEuler]);
    assert!(seen.iter().all(|o| o.theory_order == Some(1.0)), "{seen:?}");
}

// Fails if: theory does not know that a start from rest, or from the force-free point, gains an order in one quantity.
#[test]
fn a_start_from_rest_gains_an_order_in_the_velocity() {
    let (method, position, velocity) = (MethodId::SemiImplicitEuler, Quantity::Position, Quantity::Velocity);
    let order = |seen: &[OrderRow], quantity| largest(seen, method, quantity).order.expect("a slope");
    let seen = converges("oscillator", &[("v0", "0")], ALL);
    assert!((order(&seen, velocity) - 2.0).abs() < 0.1 && (order(&seen, position) - 1.0).abs() < 0.1);
    let seen = converges("oscillator", &[("x0", "0")], ALL);
    assert!((order(&seen, position) - 2.0).abs() < 0.1 && (order(&seen, velocity) - 1.0).abs() < 0.1);
    // Between the two the slope of a sweep is neither 1 nor 2, and the constant is theory's all the same.
    let rows = Convergence::measure(&selection("oscillator", &[("v0", "1e-3")], ALL));
    assert!(Convergence::claims(&rows).iter().all(|claim| claim.verdict != Verdict::Broken));
    let seen = orders(&rows);
    let slow = largest(&seen, method, velocity);
    let (measured, theory) = (slow.constant.expect("a limit"), slow.leading.expect("a constant"));
    // (w / 2) |v0| at most, which sin(w t) reaches to a thousandth at one of the checkpoints.
    assert!((theory - 1e-3).abs() < 1e-5, "{theory}");
    assert!((measured.abs() - theory).abs() <= slow.constant_change.expect("a bound"), "{slow:?}");
    converges("pendulum", &[("omega", "0")], ALL);
    converges("pendulum", &[("angle", "0"), ("omega", "1")], ALL);
    converges("heavy-top", &[("omega", "0,0,0")], ALL);
}

/// Motions that some or all methods reproduce exactly: scene and parameters.
const EXACT: [(&str, &[(&str, &str)]); 9] = [
    ("principal-axis-torque", &[("torque", "0")]),
    ("constant-force", &[("force", "0,0,0")]),
    ("oscillator", &[("x0", "0"), ("v0", "0")]),
    ("torque-free-spin", &[("inertia", "1,1,1"), ("omega", "1,0,0")]),
    ("torque-free-spin", &[("omega", "0,0,1")]),
    ("sphere-torque", &[("torque", "0,0,0")]),
    ("box-tumbling", &[("omega", "0,0,0")]),
    ("symmetric-top/rod", &[("omega", "0,0,1")]),
    ("symmetric-top/disc", &[("omega", "0,0,1")]),
];

// Fails if: no error but rounding is held against a method.
#[test]
fn methods_that_are_exact_for_the_given_parameters_are_not_broken() {
    for (id, set) in EXACT {
        converges(id, set, ALL);
    }
}

// Fails if: a constant spin, on which the linear quaternion update is of order 2, is taken for any motion.
#[test]
fn every_scheme_for_rigid_bodies_holds_on_a_constant_spin() {
    for (id, set) in EXACT.iter().filter(|(id, _)| !["constant-force", "oscillator"].contains(id)) {
        let selection = selection(id, set, ALL);
        let rows = measure::rotation::orders::measure(&selection, &Scheme::all());
        assert_holds(&measure::rotation::Rotation::claims(&rows), &format!("{id} {set:?}"));
    }
}

// Fails if: a constant is extrapolated from rounding. Right value: 0.2 k^5 T exp(-k T) / 120, computed with 50 digits.
#[test]
fn a_constant_is_taken_where_the_differences_stand_clear_of_rounding() {
    let set =
        [("mass", "1"), ("drag", "0.01005033585350145"), ("gravity", "0,0,0"), ("x0", "0,0,0"), ("v0", "0.2,0,0")];
    let rows = Convergence::measure(&Selection { quick: false, ..selection("linear-drag", &set, &[MethodId::Rk4]) });
    assert_holds(&Convergence::claims(&rows), "linear-drag");
    let seen = orders(&rows);
    let end = seen.iter().find(|o| o.quantity == Quantity::Velocity && o.measure == Measure::End).expect("a sweep");
    let (constant, bound) = (end.constant.expect("a limit"), end.constant_change.expect("a bound"));
    assert!((constant - 3.759_354_925_7e-13).abs() <= bound && bound <= 1e-4 * constant, "{constant:e} +- {bound:e}");
}

// Fails if: the horizon, or the floor, is that of the default body.
#[test]
fn a_slow_body_is_not_at_the_floor() {
    let set = [("inertia", "1,3.0836,3.235"), ("omega", "6.8e-6,-2.0e-5,2.9e-6")];
    let seen = converges("torque-free-spin", &set, &[MethodId::Rk4]);
    let order = largest(&seen, MethodId::Rk4, Quantity::Attitude).order.expect("a slope");
    assert!((order - 4.0).abs() < 0.2, "{order}");
}

// Fails if: a step for rigid bodies cannot be chosen by its name, others come with it, or a study that cannot take it ignores it.
#[test]
fn steps_for_rigid_bodies_are_chosen_by_their_name() {
    let scene = ["--scene", "torque-free-spin", "--method", "restored-momentum", "--method", "rk4/world-momentum"];
    let directory = tempfile::tempdir().expect("a temporary directory");
    let output = run("rotation", &[&scene[..], &["--quick"]].concat(), directory.path());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let rows = std::fs::read_to_string(directory.path().join("rotation.csv")).expect("written");
    let mut schemes: Vec<&str> = rows
        .lines()
        .filter(|row| row.starts_with("error,") || row.starts_with("step-law,"))
        .filter_map(|row| row.split(',').nth(2))
        .collect();
    schemes.sort_unstable();
    schemes.dedup();
    assert_eq!(schemes, ["restored-momentum", "rk4/world-momentum"]);
    let advice = program("tradeoff").args(scene).args(["--error", "1e-2"]).output().expect("the binary was built");
    assert_eq!(advice.status.code(), Some(0), "{}", text(&advice.stderr));
    for study in ["convergence", "drift", "adequacy", "stability"] {
        let refused = program(study).args(scene).output().expect("the binary was built");
        let message = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{study}: {message}");
        assert!(message.contains("restored-momentum moves rigid bodies only"), "{study}: {message}");
    }
}
