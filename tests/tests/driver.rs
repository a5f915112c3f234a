//! The driver: times, numbers of steps, what is observed, where a run fails, when a constraint is settled.
//!
//! Not seen here: whether a step is right (one_step.rs), and the cost of a run.

use std::cell::RefCell;

use integrator::methods::{ExplicitEuler, Rk4};
use integrator::pose::{Exponential, World};
use integrator::{Method, Model, Pose, Rotation, Space, State, Twist, drive};
use nalgebra::{Vector1, Vector3};

/// x'' = -x, noting the times at which it is asked, and infinite at one of them.
#[derive(Default)]
struct Recorder {
    times: RefCell<Vec<f64>>,
    fails_at: Option<f64>,
}

impl Model<f64> for Recorder {
    type Config = Vector1<f64>;
    fn rate(&self, t: f64, s: &State<Vector1<f64>>) -> Vector1<f64> {
        self.times.borrow_mut().push(t);
        if self.fails_at == Some(t) { Vector1::new(f64::INFINITY) } else { -s.q }
    }
}

fn start() -> State<Vector1<f64>> {
    State { q: Vector1::new(0.75), v: Vector1::new(-1.25) }
}

const STEPS: [u64; 9] = [0, 1, 2, 63, 64, 65, 127, 128, 1000];

// Fails if: advance or integrate sums the steps, or counts i from 1.
#[test]
fn step_i_starts_at_the_time_i_h() {
    let h = 0.1;
    for steps in STEPS {
        let expected: Vec<f64> = (0..steps).map(|i| i as f64 * h).collect();
        let recorder = Recorder::default();
        drive::advance(&ExplicitEuler, &recorder, start(), h, steps).expect("finite");
        assert_eq!(recorder.times.take(), expected);
        drive::integrate(&ExplicitEuler, &recorder, start(), h, steps, |_, _| ()).expect("finite");
        assert_eq!(recorder.times.take(), expected);
    }
    // What this excludes: a thousand sums of 0.1 are not 100.
    assert_ne!((0..1000).fold(0.0, |t, _| t + h), 1000.0 * h);
}

// Fails if: integrate shows the state before the step, or not the start.
#[test]
fn the_observer_sees_the_start_and_every_step_once() {
    for steps in STEPS {
        let mut seen = Vec::new();
        let end = drive::integrate(&Rk4, &Recorder::default(), start(), 0.125, steps, |i, s| seen.push((i, *s)));
        assert!(seen.iter().map(|(i, _)| *i).eq(0..=steps));
        assert_eq!(seen[0].1, start());
        assert_eq!(seen.last().map(|(_, s)| *s), end.ok());
        for pair in seen.windows(2) {
            let t = pair[0].0 as f64 * 0.125;
            assert_eq!(Rk4.step(&Recorder::default(), t, 0.125, pair[0].1), pair[1].1);
        }
    }
}

// Fails if: first_non_finite starts counting at the block's second step, or does not count the failed one.
#[test]
fn both_drivers_name_the_step_that_failed() {
    let h = 0.375;
    for failed in [1, 2, 63, 64, 65, 66, 127, 128, 129, 190] {
        let recorder = Recorder { fails_at: Some((failed - 1) as f64 * h), ..Recorder::default() };
        let mut seen = 0;
        let found = drive::integrate(&ExplicitEuler, &recorder, start(), h, 200, |_, _| seen += 1);
        assert_eq!(found, Err(drive::Diverged { step: failed }));
        assert_eq!(seen, failed, "the start and the steps before the failed one");
        let found = drive::advance(&ExplicitEuler, &recorder, start(), h, 200);
        assert_eq!(found, Err(drive::Diverged { step: failed }));
        // The same run, one step short of the failure.
        assert!(drive::advance(&ExplicitEuler, &recorder, start(), h, failed - 1).is_ok());
    }
}

// Fails if: first_non_finite looks at the state before it has taken a step (it would say step 0).
#[test]
fn a_start_that_is_not_finite_fails_in_the_first_step() {
    let s = State { q: Vector1::new(f64::NAN), v: Vector1::new(1.0) };
    let expected = Err(drive::Diverged { step: 1 });
    assert_eq!(drive::integrate(&ExplicitEuler, &Recorder::default(), s, 0.5, 3, |_, _| ()), expected);
    assert_eq!(drive::advance(&ExplicitEuler, &Recorder::default(), s, 0.5, 3), expected);
}

type Body = Pose<f64, Exponential<World>>;

/// A body in a field that changes its spin and its velocity.
struct Tumbling;

impl Model<f64> for Tumbling {
    type Config = Body;
    fn rate(&self, t: f64, s: &State<Body>) -> Twist<f64> {
        let body = s.q.attitude.rotate_back(s.v.angular);
        let angular = s.q.attitude.rotate(Vector3::new(0.7 * body.y * body.z, -0.4 * body.z * body.x, 0.2 * body.x));
        Twist { linear: Vector3::new(t, -s.q.position.x, 0.5), angular }
    }
}

fn tumbling() -> State<Body> {
    State {
        q: Pose::new(Vector3::new(0.5, -0.25, 1.0), Rotation::from_wxyz([0.5, -0.75, 1.0, 0.25])),
        v: Twist { linear: Vector3::new(1.0, 2.0, -0.5), angular: Vector3::new(1.5, -0.75, 1.0) },
    }
}

// Fails if: advance settles at the end of every block, also of a shorter one; or never.
#[test]
fn advance_and_integrate_give_the_same_bits() {
    for steps in STEPS {
        let advanced = drive::advance(&ExplicitEuler, &Tumbling, tumbling(), 0.015625, steps).expect("finite");
        let mut last = None;
        let integrated =
            drive::integrate(&ExplicitEuler, &Tumbling, tumbling(), 0.015625, steps, |_, s| last = Some(*s));
        assert_eq!(Ok(advanced), integrated, "{steps} steps");
        assert_eq!(last, Some(advanced));
    }
    assert_eq!(drive::advance(&Rk4, &Tumbling, tumbling(), 0.5, 0), Ok(tumbling()));
}

/// A ball over a floor, thrown back with the speed that it arrives with; with `breaks`, the floor makes it NaN.
struct Ball {
    breaks: bool,
}

impl Model<f64> for Ball {
    type Config = Vector1<f64>;
    fn rate(&self, _t: f64, _s: &State<Vector1<f64>>) -> Vector1<f64> {
        Vector1::new(-1.0)
    }
    fn contact(&self, _before: &State<Vector1<f64>>, after: State<Vector1<f64>>) -> State<Vector1<f64>> {
        let back = if self.breaks { f64::NAN } else { -1.0 };
        if after.q.x < 0.0 && after.v.x < 0.0 { State { q: after.q, v: after.v * back } } else { after }
    }
}

// Fails if: either driver, or the search for the step that failed, leaves out the contact.
#[test]
fn both_drivers_let_the_model_change_the_state_after_every_step() {
    let start = State { q: Vector1::new(0.5), v: Vector1::new(0.0) };
    for steps in STEPS.into_iter().chain([1000]) {
        let mut lowest = f64::INFINITY;
        let ball = Ball { breaks: false };
        let advanced = drive::advance(&ExplicitEuler, &ball, start, 0.015625, steps).expect("finite");
        let see = |_, s: &State<Vector1<f64>>| lowest = lowest.min(s.q.x);
        assert_eq!(Ok(advanced), drive::integrate(&ExplicitEuler, &ball, start, 0.015625, steps, see));
        // A bounce is seen within the step in which it falls: at most |v| h below the floor, and |v| stays below 2.
        assert!(lowest > -2.0 * 0.015625, "{steps} steps: {lowest}");
    }
    let ball = Ball { breaks: true };
    let failed = drive::integrate(&ExplicitEuler, &ball, start, 0.015625, 1000, |_, _| ());
    // x = (1 - t^2) / 2 + t h / 2 meets the floor at t = 1 + h / 2, in step 65.
    assert_eq!(failed.expect_err("it meets the floor").step, 65);
    assert_eq!(drive::advance(&ExplicitEuler, &ball, start, 0.015625, 1000), failed);
}

// Fails if: SETTLE_EVERY steps are not followed by a settling; settled changes the position, or the attitude's direction.
#[test]
fn settling_after_64_steps_changes_the_norm_and_nothing_else() {
    let h = 0.015625;
    let raw = (0..64).fold(tumbling(), |s, i| Rk4.step(&Tumbling, f64::from(i) * h, h, s));
    let run = drive::advance(&Rk4, &Tumbling, tumbling(), h, 64).expect("finite");
    assert_eq!((run.v, run.q.position), (raw.v, raw.q.position));
    assert_eq!(run.q.attitude, raw.q.settled().attitude);
    // A start that is off the unit sphere shows what is taken away.
    let mut long = tumbling();
    long.q.attitude = Rotation { w: long.q.attitude.w * 1.5, v: long.q.attitude.v * 1.5 };
    let after = |steps| drive::advance(&ExplicitEuler, &Tumbling, long, h, steps).expect("finite").q.attitude;
    let norm = |q: Rotation<f64>| q.norm_squared().sqrt();
    assert!((norm(after(63)) - 1.5).abs() < 64.0 * 4.0 * f64::EPSILON, "{}", norm(after(63)));
    assert!((norm(after(64)) - 1.0).abs() <= 2.0 * f64::EPSILON, "{}", norm(after(64)));
    assert!((norm(after(65)) - 1.0).abs() <= 8.0 * f64::EPSILON, "{}", norm(after(65)));
}
