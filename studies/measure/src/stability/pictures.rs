//! One picture for every kind of failure: a run that shows it, and the kind that the run is seen to have.

use faer::fx128;
use integrator::methods::{ExplicitEuler, ImplicitMidpoint, MethodId, SemiImplicitEuler, VelocityVerlet};
use integrator::rigid_body::{RigidModel, WorldMomentum, WorldOmega};
use integrator::{Method, Real, Single, State};
use nalgebra::{Vector1, Vector3};

use super::failure::{Failure, Signal};
use super::models::Damped;
use super::spin::{Free, at_rest, thin_body};
use super::{Part, Row};
use crate::order::local_order;
use scenes::ForcedOscillator;
use scenes::motion::Motion;
use scenes::observation::{Observation, Quantity};
use scenes::run::{Outcome, Precision, Run};

/// A curve of a picture: its name, its points (time or step in s, value), and the failure it shows.
struct Curve {
    name: String,
    points: Vec<[f64; 2]>,
    failure: Failure,
}

/// The pictures that the chosen scenes allow.
pub(super) fn rows(has: impl Fn(&str) -> bool) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut add = |id: &str, unit: &str, curves: Vec<Curve>| {
        for curve in curves {
            for [t, y] in curve.points {
                rows.push(Row {
                    parameter: "across (s)".to_owned(),
                    value: Some(t),
                    measured: Some(y),
                    failure: curve.failure,
                    ..Row::new(Part::Picture, id, &curve.name, Precision::F64, "up", unit)
                });
            }
        }
    };
    if has("oscillator") {
        add("exponential-growth", "m", exponential_growth());
        add("wrong-frequency", "m", wrong_frequency());
    }
    if has("linear-drag") {
        add("oscillating-decay", "m/s", oscillating_decay());
    }
    if has("forced-oscillator") {
        add("aliasing", "m", aliasing());
    }
    if has("torque-free-spin") {
        add("finite-time-blow-up", "rad/s", blow_up());
        add("flipped-axis", "1", flipped_axis());
        add("drift", "1", drift());
    }
    if has("pendulum") {
        add("newton-not-converging", "rad/s", newton());
    }
    if has("quadratic-drag") {
        add("order-lost", "m", order_lost());
    }
    rows
}

/// Displacement of x'' = -x - 2 zeta x' from x = 1 at rest, after every step.
fn oscillation<A: Method<f64, Damped>>(method: &A, zeta: f64, h: f64, steps: usize) -> Vec<f64> {
    let mut s = State { q: Vector1::new(1.0), v: Vector1::new(0.0) };
    let mut x = vec![1.0];
    for _ in 0..steps {
        s = method.step(&Damped { zeta }, 0.0, h, s);
        x.push(s.q.x);
    }
    x
}

fn timed(values: &[f64], h: f64) -> Vec<[f64; 2]> {
    values.iter().enumerate().map(|(i, &y)| [i as f64 * h, y]).collect()
}

fn exact_points(end: f64, value: impl Fn(f64) -> f64) -> Curve {
    let points = (0..=240).map(|i| f64::from(i) * end / 240.0).map(|t| [t, value(t)]).collect();
    Curve { name: "exact".to_owned(), points, failure: Failure::None }
}

fn signal(name: String, h: f64, numeric: &[f64], exact: impl Fn(f64) -> f64, turn_per_step: f64) -> Curve {
    let truth: Vec<f64> = (0..numeric.len()).map(|i| exact(i as f64 * h)).collect();
    let failure = Failure::of_signal(&Signal { numeric, exact: &truth, turn_per_step, unsolved: false });
    Curve { name, points: timed(numeric, h), failure }
}

fn exponential_growth() -> Vec<Curve> {
    let verlet = |h: f64, steps| {
        signal(format!("Verlet, h omega = {h}"), h, &oscillation(&VelocityVerlet, 0.0, h, steps), f64::cos, h)
    };
    let h = 0.25;
    let euler = oscillation(&ExplicitEuler, 0.0, h, 240);
    let mut curves = vec![verlet(1.97, 30), verlet(2.03, 30)];
    curves.push(signal(format!("Explicit Euler, h omega = {h}"), h, &euler, f64::cos, h));
    // Sizes: the chart is logarithmic, and a displacement passes through zero.
    for curve in &mut curves {
        let mut largest = 0.0_f64;
        for point in &mut curve.points {
            largest = largest.max(point[1].abs());
            point[1] = largest;
        }
    }
    curves
}

fn wrong_frequency() -> Vec<Curve> {
    let h = 2.5;
    let x = oscillation(&ImplicitMidpoint, 0.0, h, 16);
    vec![exact_points(40.0, f64::cos), signal(format!("Implicit midpoint, h omega = {h}"), h, &x, f64::cos, h)]
}

fn oscillating_decay() -> Vec<Curve> {
    // v' = -v: the velocity of the oscillator without its spring.
    let euler = |h: f64, steps: usize| {
        let v: Vec<f64> = (0..=steps).scan(1.0, |v, _| Some(std::mem::replace(v, *v + h * -*v))).collect();
        signal(format!("Explicit Euler, k h = {h}"), h, &v, |t| (-t).exp(), 0.0)
    };
    vec![exact_points(12.0, |t| (-t).exp()), euler(0.5, 24), euler(1.75, 6), euler(2.125, 5)]
}

fn aliasing() -> Vec<Curve> {
    let forced =
        ForcedOscillator { mass: 1.0, stiffness: 1.0, damping: 0.375, force: 1.0, drive: 4.0, x0: 0.5, v0: 0.0 };
    let h = std::f64::consts::TAU / forced.drive;
    let exact = |t: f64| Motion::<f64>::exact(&forced, t).q.x;
    let mut s = Motion::<f64>::exact(&forced, 0.0);
    let mut x = vec![s.q.x];
    for i in 0..24 {
        s = SemiImplicitEuler.step(&forced, f64::from(i) * h, h, s);
        x.push(s.q.x);
    }
    let name = "Semi-implicit Euler, one step a period of the force".to_owned();
    vec![exact_points(24.0 * h, exact), signal(name, h, &x, exact, forced.drive * h)]
}

fn blow_up() -> Vec<Curve> {
    [1.0 / 64.0, 1.0 / 128.0, 1.0 / 256.0]
        .map(|h| {
            let speeds = thin_body(h, 1 << 20);
            let sizes: Vec<(u64, f64)> = (0..).zip(speeds.iter().copied()).collect();
            let failure = Failure::of_growth(&sizes);
            let stride = (speeds.len() / 300).max(1);
            let mut points: Vec<[f64; 2]> = timed(&speeds, h).into_iter().step_by(stride).collect();
            points.extend(timed(&speeds, h).into_iter().rev().take(12).rev());
            points.retain(|[_, y]| y.is_finite() && *y < 1e12);
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            points.dedup();
            Curve { name: format!("h = 1/{} s", 1.0 / h), points, failure }
        })
        .into()
}

/// The disc of a game: 60 rad/s at 60 steps a second, tilted by a hundredth.
fn flipped_axis() -> Vec<Curve> {
    let disc = Free { inertia: [1.0, 1.0, 2.0] };
    let (h, omega) = (1.0 / 60.0, Vector3::new(0.6, 0.0, 60.0));
    let cosines = |explicit: bool| {
        let model = WorldOmega::<_>::new(disc);
        let mut s = model.state(&at_rest(omega));
        let mut cosines = vec![1.0];
        for _ in 0..90 {
            s = if explicit { ExplicitEuler.step(&model, 0.0, h, s) } else { ImplicitMidpoint.step(&model, 0.0, h, s) };
            cosines.push(s.q.attitude.normalized().rotate(Vector3::z()).z);
        }
        cosines
    };
    [("Explicit Euler", true), ("Implicit midpoint", false)]
        .map(|(name, explicit)| {
            let cosines = cosines(explicit);
            Curve { name: name.to_owned(), failure: Failure::of_axis(&cosines), points: timed(&cosines, h) }
        })
        .into()
}

/// Kinetic energy of a free body whose angular momentum is stored: |L| is kept to rounding, and T is not.
fn drift() -> Vec<Curve> {
    let body = Free { inertia: [1.0, 2.0, 3.0] };
    let model = WorldMomentum::<_>::new(body);
    let h = 1.0 / 64.0;
    let run = |midpoint: bool, name: &str| {
        let mut s = model.state(&at_rest(Vector3::new(0.25, 0.5, 1.5)));
        let energy = |s: &State<_>| {
            let omega = model.kinematics(s).omega_body;
            0.5 * omega.dot(&omega.component_mul(&Vector3::from(body.inertia)))
        };
        let start = energy(&s);
        let mut points = Vec::new();
        let steps = if midpoint { 12_800 } else { 25_600 };
        for i in 1..=steps {
            s = if midpoint {
                ImplicitMidpoint.step(&model, 0.0, h, s)
            } else {
                SemiImplicitEuler.step(&model, 0.0, h, s)
            };
            if i % 128 == 0 {
                points.push([f64::from(i) * h, energy(&s) / start]);
            }
        }
        let errors: Vec<(f64, f64)> = points.iter().map(|[t, e]| (*t, e - 1.0)).collect();
        Curve { name: name.to_owned(), points, failure: Failure::of_invariant(&errors) }
    };
    vec![run(false, "Euler, L stored"), run(true, "Implicit midpoint, L stored")]
}

/// Implicit methods on a pendulum: the first of a few steps, each twice the one before, at which Newton's iteration finds
/// nothing, beside a step at which it does. No picture where it always finds a solution.
fn newton() -> Vec<Curve> {
    let Ok(scene) = scenes::by_id("pendulum") else { return Vec::new() };
    let scale = scene.scene().info().time_scale_s;
    let swing = |method: MethodId, z: f64| {
        let steps = (256.0 / z).clamp(64.0, 1024.0) as u64;
        let run = Run::new(method, Precision::F64, z * scale * steps as f64, steps);
        let trajectory = scene.run(&run, 1)?;
        let rate = |seen: &Observation| seen.vector(Quantity::AngularVelocity).first().map_or(f64::NAN, |w| w.to_f64());
        let numeric: Vec<f64> = trajectory.seen.iter().map(|(_, seen)| rate(seen)).collect();
        let exact: Vec<f64> = (0..=steps).map(|i| rate(&scene.exact(fx128::lit(i as f64 * run.h_s())))).collect();
        let unsolved = trajectory.outcome == Outcome::NotConverged;
        let failure = Failure::of_signal(&Signal { numeric: &numeric, exact: &exact, turn_per_step: z, unsolved });
        Some(Curve { name: format!("{}, h omega = {z}", method.title()), points: timed(&numeric, run.h_s()), failure })
    };
    let failing = [MethodId::ImplicitMidpoint, MethodId::ImplicitEuler].into_iter().find_map(|method| {
        let steps = (1..10).filter_map(|i| swing(method, f64::from(i).exp2()));
        steps.into_iter().find(|curve| curve.failure == Failure::NewtonNotConverging).map(|curve| (method, curve))
    });
    failing.map_or_else(Vec::new, |(method, curve)| swing(method, 0.25).into_iter().chain([curve]).collect())
}

/// RK4 on a body thrown upwards against quadratic drag: at the apex the force has no second derivative.
fn order_lost() -> Vec<Curve> {
    ["quadratic-drag/fall", "quadratic-drag/rise"]
        .into_iter()
        .filter_map(|id| {
            let scene = scenes::by_id(id).ok()?;
            let end_s = scene.scene().info().horizon_s;
            let truth = scene.exact(fx128::lit(end_s));
            let error = |steps: u64| {
                let run = Run::new(MethodId::Rk4, Precision::DoubleDouble, end_s, steps);
                let end = scene.run(&run, steps)?.end()?.distances(&truth);
                end.iter()
                    .find(|(quantity, _)| *quantity == Quantity::Position)
                    .map(|(_, e)| [end_s / steps as f64, *e])
            };
            let points: Vec<[f64; 2]> = (4..14).filter_map(|j| error(1 << j)).collect();
            // The best of the coarse against the worst of the fine half: an error that jumps about its trend.
            let ([h_coarse, coarse], [h_fine, fine]) = (*points.first()?, *points.last()?);
            let observed = local_order((h_coarse, coarse), (h_fine, fine))?;
            Some(Curve { name: format!("RK4, {id}"), points, failure: Failure::of_order(observed, 4.0) })
        })
        .collect()
}
