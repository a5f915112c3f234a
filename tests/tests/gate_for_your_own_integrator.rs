//! The gate for an integrator of your own: a method defined here, outside the workspace's crates, held to the committed bounds
//! of the method it claims to be. These lines are all that another crate needs.

use gate::{Bounds, Flat, Held, InBody, InWorld};
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
    Bounds::read(concat!(env!("CARGO_MANIFEST_DIR"), "/data/bounds.csv")).expect("the committed bounds can be read")
}

#[test]
fn my_method_keeps_the_bounds_of_semi_implicit_euler() {
    bounds().hold("semi-implicit-euler", &Flat(Mine)).expect("there are such bounds").assert();
}

#[test]
fn my_method_keeps_the_bounds_of_semi_implicit_euler_on_rigid_bodies() {
    bounds().hold("semi-implicit-euler/world-omega", &InWorld(Mine)).expect("there are such bounds").assert();
    bounds().hold("semi-implicit-euler/body-omega", &InBody(Mine)).expect("there are such bounds").assert();
}

/// The same with the fault that is made most often: the old velocity moves the position.
struct MineWithTheOldVelocity;

impl<T: Real, M: Model<T>> Method<T, M> for MineWithTheOldVelocity {
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        State { q: s.q.retract(m.velocity(s.q, s.v), h), v: s.v.plus(m.rate(t, &s), h) }
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

// Fails if: a name without rows is an empty gate, which always holds.
#[test]
fn a_method_without_bounds_is_an_error() {
    let error = bounds().hold("leapfrog", &Flat(Mine)).expect_err("no such bounds").to_string();
    assert!(error.contains("leapfrog") && error.contains("velocity-verlet"), "{error}");
}

// Fails if: a scene that a candidate cannot run counts as held.
#[test]
#[should_panic(expected = "bounds are broken")]
fn a_gate_that_nothing_was_run_for_does_not_hold() {
    bounds().hold("semi-implicit-euler/body-omega", &Flat(Mine)).expect("there are such bounds").assert();
}
