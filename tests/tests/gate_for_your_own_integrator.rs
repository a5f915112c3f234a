//! The gate for an integrator of your own: a method defined here, outside the workspace's crates, held to the committed bounds
//! of the method it claims to be. These lines are all that another crate needs.

use gate::{Bounds, Candidate, Flat, Held, InBody, InWorld};
use integrator::{Method, Model, Real, Space, State, Vector};

/// Semi-implicit Euler as somebody else would write it: a backward difference of the position.
struct Mine;

impl<T: Real, M: Model<T>> Method<T, M> for Mine {
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let v = s.v + m.rate(t, &s) * h;
        State { q: s.q.retract(m.velocity(s.q, v), h), v }
    }
}

fn bounds() -> Bounds {
    Bounds::committed().expect("the committed bounds can be read")
}

#[test]
fn my_method_keeps_the_bounds_of_semi_implicit_euler() {
    bounds().hold("semi-implicit-euler", &Flat(Mine)).expect("there are such bounds").assert();
}

#[test]
fn my_method_keeps_the_bounds_of_semi_implicit_euler_on_rigid_bodies() {
    bounds().hold("semi-implicit-euler/world-omega", &InWorld(Mine)).expect("there are such bounds").assert();
    bounds().hold("semi-implicit-euler/body-omega", &InBody(Mine)).expect("there are such bounds").assert();
    // The plain name will do: the wrapper says what is stored.
    for (candidate, rows) in [(&InWorld(Mine) as &dyn Candidate, "world-omega"), (&InBody(Mine), "body-omega")] {
        let held = bounds().hold("semi-implicit-euler", candidate).expect("there are such bounds");
        assert_eq!(held.method, format!("semi-implicit-euler/{rows}"));
        assert!(
            held.judged.iter().filter(|one| one.measured.value().is_some() && !one.is_broken()).count() > 20,
            "{rows}"
        );
    }
}

/// The same with the fault that is made most often: the old velocity moves the position.
struct MineWithTheOldVelocity;

impl<T: Real, M: Model<T>> Method<T, M> for MineWithTheOldVelocity {
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        State { q: s.q.retract(m.velocity(s.q, s.v), h), v: s.v.add_scaled(m.rate(t, &s), h) }
    }
}

// Fails if: a method from outside is not run, or a broken row is not told.
#[test]
fn the_gate_is_red_for_a_method_that_moves_with_the_old_velocity() {
    let held: Held =
        bounds().hold("semi-implicit-euler", &Flat(MineWithTheOldVelocity)).expect("there are such bounds");
    let broken = held.broken();
    // Both quantities of every oscillator, at least: its error constants are of opposite signs and sizes.
    for scene in ["oscillator", "damped-oscillator", "pendulum", "kepler", "spring-chain"] {
        let seen = broken.iter().any(|one| one.row.scene == scene && one.row.mutant == "old-velocity");
        assert!(seen, "no row of {scene} sees it");
    }
}

// Fails if: the message of a failed test does not begin with the counts, is long, or does not name the fault.
#[test]
fn the_message_has_counts_the_fault_and_the_worst_rows() {
    let held: Held =
        bounds().hold("semi-implicit-euler", &Flat(MineWithTheOldVelocity)).expect("there are such bounds");
    let message = held.summary();
    let lines: Vec<&str> = message.lines().collect();
    assert!(lines[0].starts_with("semi-implicit-euler: ") && lines[0].contains("bounds are broken"), "{message}");
    assert!(lines[1].starts_with("looks like: old-velocity"), "{message}");
    assert!(lines.len() <= 24 && lines.iter().all(|line| line.chars().count() <= 160), "{message}");
}

// Fails if: a candidate that can run nothing is held to nothing, or the message does not say what would.
#[test]
fn a_candidate_that_runs_no_row_is_an_error_that_names_the_wrapper() {
    for (method, wrapper) in [("semi-implicit-euler/body-omega", "InBody"), ("rk4/world-omega", "InWorld")] {
        let error = bounds().hold(method, &Flat(Mine)).expect_err("flat methods move no body").to_string();
        assert!(error.contains(wrapper), "{error}");
    }
}

// Fails if: a name without rows is an empty gate, which always holds.
#[test]
fn a_method_without_bounds_is_an_error() {
    let error = bounds().hold("leapfrog", &Flat(Mine)).expect_err("no such bounds").to_string();
    assert!(error.contains("leapfrog") && error.contains("velocity-verlet"), "{error}");
}

// Fails if: a scene that a candidate cannot run counts as held.
#[test]
#[should_panic(expected = "bounds are broken")]
fn a_gate_that_is_broken_fails_its_test() {
    bounds().hold("semi-implicit-euler", &Flat(MineWithTheOldVelocity)).expect("there are such bounds").assert();
}
