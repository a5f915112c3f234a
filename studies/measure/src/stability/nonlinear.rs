//! Limits that no matrix tells: drag that grows with the speed, a pendulum that swings widely, a body that spins itself up.

use integrator::methods::{ExplicitEuler, ImplicitEuler, ImplicitMidpoint, SemiImplicitEuler};
use integrator::{Method, Model, State};
use nalgebra::Vector1;

use super::bisect::{Found, bracket};
use super::failure::Failure;
use super::spin::{blow_up_bound, thin_body};
use super::{Part, Row};
use scenes::run::Precision;
use scenes::{BouncingBall, Pendulum, QuadraticDrag};

/// Width of the brackets, in parts of their upper end.
const WIDTH: f64 = 0.004;
/// Steps of a run that decides.
const STEPS: u64 = 1 << 14;

/// All of them.
pub(super) fn rows(has: impl Fn(&str) -> bool) -> Vec<Row> {
    let mut rows = Vec::new();
    if has("quadratic-drag") {
        rows.extend([terminal_row(), overshoot_row(), blow_up_row()]);
    }
    if has("pendulum") {
        rows.extend(AMPLITUDES.map(pendulum_row));
    }
    if has("torque-free-spin") {
        rows.extend(SPIN_STEPS.map(spin_row));
    }
    if has("bouncing-ball") {
        rows.extend(BALL_STEPS.map(ball_row));
    }
    rows
}

fn drag_run(drag: &QuadraticDrag, h: f64, v0: f64, steps: u64) -> impl Iterator<Item = f64> {
    let mut s = State { q: Vector1::new(0.0), v: Vector1::new(v0) };
    (0..steps).map(move |_| {
        s = ExplicitEuler.step(drag, 0.0, h, s);
        s.v.x
    })
}

fn k(drag: &QuadraticDrag) -> f64 {
    drag.drag / drag.mass
}

fn from_found(row: Row, found: Found, unit: f64) -> Row {
    let (low, high) = match found {
        Found::NoStep { tried_s } => (None, Some(tried_s)),
        Found::Bracket { low_s, high_s } => (Some(low_s), Some(high_s)),
        Found::Unlimited { tried_s } => (Some(tried_s), None),
    };
    Row { low: low.map(|h| h * unit), high: high.map(|h| h * unit), ..row }
}

/// Explicit Euler near the terminal speed: v - vt is multiplied by 1 - 2 h sqrt(g k), so that h sqrt(g k) <= 1.
fn terminal_row() -> Row {
    let drag = QuadraticDrag::default();
    let rate = (drag.gravity * k(&drag)).sqrt();
    let vt = (drag.gravity / k(&drag)).sqrt();
    // Returns to within its start: beyond the limit it settles on a cycle about vt, and never comes back.
    let holds = |h: f64| {
        let end = drag_run(&drag, h, vt * 1.001, STEPS).last().unwrap_or(f64::NAN);
        (end / vt - 1.0).abs() < 0.001
    };
    let found = bracket(1.0 / 16.0 / rate, 16.0 / rate, WIDTH, holds);
    let row = Row::new(Part::QuadraticDrag, "quadratic-drag", "explicit-euler", Precision::F64, "h sqrt(g k)", "1");
    let note = "linearised at the terminal speed: |1 - 2 h sqrt(g k)| <= 1".to_owned();
    Row { theory: Some(1.0), failure: Failure::OscillatingDecay, note, steps: STEPS, ..from_found(row, found, rate) }
}

/// From far above the terminal speed one step passes below zero where k v0 h > 1 (gravity counts for g h).
fn overshoot_row() -> Row {
    let drag = QuadraticDrag::default();
    let v0 = 1.0e6 * (drag.gravity / k(&drag)).sqrt();
    let unit = k(&drag) * v0;
    let holds = |h: f64| drag_run(&drag, h, v0, 1).all(|v| v >= 0.0);
    let found = bracket(1.0 / 16.0 / unit, 16.0 / unit, WIDTH, holds);
    let row =
        Row::new(Part::QuadraticDrag, "quadratic-drag", "explicit-euler", Precision::F64, "k v0 h, one side", "1");
    let note = "v1 = v0 (1 - k v0 h): the drag turns the motion round where k v0 h > 1".to_owned();
    Row { theory: Some(1.0), failure: Failure::OscillatingDecay, note, steps: 1, ..from_found(row, found, unit) }
}

/// From far above the terminal speed the speed grows, and feeds its own growth, where k v0 h > 2.
fn blow_up_row() -> Row {
    let drag = QuadraticDrag::default();
    let v0 = 1.0e6 * (drag.gravity / k(&drag)).sqrt();
    let unit = k(&drag) * v0;
    let holds = |h: f64| drag_run(&drag, h, v0, 64).all(|v| v.abs() <= v0);
    let found = bracket(1.0 / 16.0 / unit, 16.0 / unit, WIDTH, holds);
    let beyond = match found {
        Found::Bracket { high_s, .. } => 1.05 * high_s,
        _ => f64::NAN,
    };
    let sizes: Vec<(u64, f64)> = (0..).zip(drag_run(&drag, beyond, v0, 256).map(f64::abs)).collect();
    let row = Row::new(Part::QuadraticDrag, "quadratic-drag", "explicit-euler", Precision::F64, "k v0 h, bounded", "1");
    let note = "|v1| = v0 |1 - k v0 h| > v0 where k v0 h > 2".to_owned();
    Row { theory: Some(2.0), failure: Failure::of_growth(&sizes), note, steps: 64, ..from_found(row, found, unit) }
}

/// Amplitudes of the pendulum, rad.
const AMPLITUDES: [f64; 6] = [1.0, 1.5, 2.0, 2.5, 2.75, 3.0];

/// Semi-implicit Euler on a pendulum released at rest, which is Chirikov's standard map with K = (h omega)^2: the first step
/// at which it goes over the top. Linear theory says 2 at any amplitude.
fn pendulum_row(amplitude: f64) -> Row {
    let pendulum = Pendulum::default();
    let omega = (pendulum.gravity / pendulum.length).sqrt();
    let holds = |h: f64| {
        let mut s = State { q: Vector1::new(amplitude), v: Vector1::new(0.0) };
        (0..STEPS).all(|_| {
            s = SemiImplicitEuler.step(&pendulum, 0.0, h, s);
            s.q.x.abs() <= std::f64::consts::PI
        })
    };
    // Small rungs: between them lie resonances, at which it fails earlier than a little further on.
    let (mut low, mut high) = (0.05, 0.05);
    while high < 4.0 && holds(high / omega) {
        low = high;
        high *= 1.02;
    }
    let found = match bracket(low / omega, high / omega, WIDTH, |h| h <= low / omega || holds(h)) {
        Found::Bracket { low_s, high_s } if high_s <= 1.01 * high / omega => Found::Bracket { low_s, high_s },
        _ => Found::Bracket { low_s: low / omega, high_s: high / omega },
    };
    let row = Row::new(Part::PendulumAmplitude, "pendulum", "semi-implicit-euler", Precision::F64, "h omega", "1");
    let row = Row { parameter: "amplitude (rad)".to_owned(), value: Some(amplitude), ..row };
    let note = "2 for a vanishing amplitude".to_owned();
    Row { theory: Some(2.0), failure: Failure::WrongFrequency, note, steps: STEPS, ..from_found(row, found, omega) }
}

/// Steps on the thin body, s.
const SPIN_STEPS: [f64; 4] = [1.0 / 64.0, 1.0 / 128.0, 1.0 / 256.0, 1.0 / 512.0];

/// When the angular velocity of a thin body stops being finite, against the bound before which it cannot.
fn spin_row(h: f64) -> Row {
    let speeds = thin_body(h, 1 << 22);
    let steps = speeds.len() as u64 - 1;
    let finite = speeds.last().is_some_and(|speed| speed.is_finite());
    let sizes: Vec<(u64, f64)> = (0..).zip(speeds).collect();
    Row {
        h_s: Some(h),
        measured: (!finite).then_some(steps as f64 * h),
        theory: Some(blow_up_bound(h)),
        failure: if finite { Failure::None } else { Failure::of_growth(&sizes) },
        steps,
        note: "no earlier than 4 / (h L^2 (1/I1 - 1/I3)^2)".to_owned(),
        ..Row::new(Part::BlowUp, "thin-body", "semi-implicit-euler/body-omega", Precision::F64, "time of blow-up", "s")
    }
}

/// Steps on the bouncing ball, s.
const BALL_STEPS: [f64; 5] = [1.0 / 4.0, 1.0 / 16.0, 1.0 / 64.0, 1.0 / 256.0, 1.0 / 1024.0];

/// A ball that loses nothing: how far its energy strays over 4096 steps. No step makes it unstable; every step lets it
/// gain or lose at each bounce what falls between two steps.
fn ball_row(h: f64) -> Row {
    let ball = BouncingBall::default();
    let mut s = State { q: Vector1::new(ball.x0), v: Vector1::new(ball.v0) };
    let energy = |s: &State<Vector1<f64>>| 0.5 * s.v.x * s.v.x + ball.gravity * s.q.x;
    let start = energy(&s);
    let mut errors = Vec::new();
    for i in 1..=4096_u32 {
        let before = s;
        s = ball.contact(&before, SemiImplicitEuler.step(&ball, 0.0, h, s));
        errors.push((f64::from(i) * h, energy(&s) / start - 1.0));
    }
    let worst = errors.iter().map(|(_, e)| e.abs()).fold(0.0, f64::max);
    Row {
        h_s: Some(h),
        measured: Some(worst),
        failure: Failure::of_invariant(&errors),
        steps: 4096,
        ..Row::new(Part::Ball, "bouncing-ball", "semi-implicit-euler", Precision::F64, "largest energy error", "1")
    }
}

/// Steps h omega at which the methods without a limit are watched.
pub const UNCONDITIONAL: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];

/// What the implicit methods do instead of failing, on x'' = -omega^2 x: the amplitude in one step, and the angle turned.
pub(super) fn unconditional_rows() -> Vec<Row> {
    let oscillator = scenes::Oscillator::default();
    let omega = oscillator.omega();
    let start = State { q: Vector1::new(oscillator.x0), v: Vector1::new(oscillator.v0) };
    let radius = |s: &State<Vector1<f64>>| (omega * s.q.x).hypot(s.v.x);
    let angle = |s: &State<Vector1<f64>>| (-s.v.x).atan2(omega * s.q.x);
    let row = |z: f64, method, quantity, unit, measured: f64, theory: f64| Row {
        h_s: Some(z / omega),
        h_omega: Some(z),
        measured: Some(measured),
        theory: Some(theory),
        failure: if theory.abs() < 1.0 { Failure::Drift } else { Failure::WrongFrequency },
        steps: 1,
        ..Row::new(Part::Unconditional, "oscillator", method, Precision::F64, quantity, unit)
    };
    let mut rows = Vec::new();
    for z in UNCONDITIONAL {
        let h = z / omega;
        let euler = ImplicitEuler.step(&oscillator, 0.0, h, start);
        let midpoint = ImplicitMidpoint.step(&oscillator, 0.0, h, start);
        let damping = radius(&euler) / radius(&start);
        rows.push(row(z, "implicit-euler", "amplitude after one step", "1", damping, 1.0 / z.hypot(1.0)));
        rows.push(row(
            z,
            "implicit-midpoint",
            "amplitude after one step",
            "1",
            radius(&midpoint) / radius(&start),
            1.0,
        ));
        let turned = (angle(&midpoint) - angle(&start)).rem_euclid(std::f64::consts::TAU);
        rows.push(row(z, "implicit-midpoint", "angle in one step", "rad", turned, 2.0 * (0.5 * z).atan()));
    }
    rows
}
