//! Long runs: where a body ends up, what becomes of a fast disc, and how T and L drift.

use faer::fx128;
use integrator::{Real, Single};

use super::free::{Free, dot, run};
use super::laws::symmetric;
use super::row::{Experiment, Row};
use scenes::TorqueFreeSpin;
use scenes::any::AnyScene;
use scenes::observation::{Quantity, largest};
use scenes::run::{Outcome, Precision, Run, Trajectory};
use scenes::scheme::Scheme;

/// Step of the long runs, s.
pub const LONG_STEP_S: f64 = 0.01;
/// Points kept of a long run.
pub(super) const POINTS: u64 = 64;

/// The starts of the long runs: moments 1, 2 and 3 kg m^2, near the axis of most inertia, near that of least, and neither.
pub fn long_starts() -> [(&'static str, TorqueFreeSpin); 3] {
    let start = |omega| TorqueFreeSpin { inertia: [1.0, 2.0, 3.0], attitude: [1.0, 0.0, 0.0, 0.0], omega };
    [
        ("start near most inertia", start([0.1, 0.05, 1.0])),
        ("start near least inertia", start([1.0, 0.05, 0.1])),
        ("start far from all axes", start([1.0, 0.8, -0.6])),
    ]
}

/// Where every scheme takes a free body in `end_s`.
pub fn long_run(name: &str, body: &TorqueFreeSpin, end_s: f64, schemes: &[Scheme]) -> Vec<Row> {
    let steps = (end_s / LONG_STEP_S).round() as u64;
    schemes.iter().flat_map(|&scheme| long_run_of(name, body, steps, scheme)).collect()
}

fn long_run_of(name: &str, body: &TorqueFreeSpin, steps: u64, scheme: Scheme) -> Vec<Row> {
    let trajectory = run::<f64>(scheme, body, LONG_STEP_S * steps as f64, steps, steps / POINTS);
    let all: Vec<(u64, Free)> =
        trajectory.seen.iter().filter_map(|(step, seen)| Some((*step, Free::of(body.inertia, seen)?))).collect();
    let row = Row::new(Experiment::LongRun, name, scheme, LONG_STEP_S, &trajectory);
    let Some((_, start)) = all.first().copied() else { return Vec::new() };
    all.into_iter()
        .flat_map(|(step, at)| {
            let row = Row { t_s: step as f64 * LONG_STEP_S, ..row.clone() };
            let length = (at.momentum_squared() / start.momentum_squared()).sqrt().to_f64();
            let energy = (at.twice_energy() / start.twice_energy()).to_f64();
            [
                row.measured("axis coordinate", "1", Some(at.axis_coordinate())),
                row.measured("|L| / |L0|", "1", Some(length)),
                row.measured("T / T0", "1", Some(energy)),
            ]
        })
        .collect()
}

/// A thin disc (0.25, 0.25, 0.5) kg m^2 at 60 rad/s about its axis, tilted by a hundredth: x = (rho - 1) omega3 h = 1.
pub fn disc() -> TorqueFreeSpin {
    symmetric(0.25, 0.5, [0.6, 0.0, 60.0])
}

/// Step of the disc, s, and number of its steps.
const DISC_STEP_S: f64 = 1.0 / 60.0;
const DISC_STEPS: u64 = 3600;

/// What every scheme makes of the disc in a minute.
pub fn disc_runs(schemes: &[Scheme]) -> Vec<Row> {
    let body = disc();
    schemes.iter().flat_map(|&scheme| disc_run(&body, scheme)).collect()
}

fn disc_run(body: &TorqueFreeSpin, scheme: Scheme) -> Vec<Row> {
    let trajectory = run::<f64>(scheme, body, DISC_STEP_S * DISC_STEPS as f64, DISC_STEPS, 1);
    let all: Vec<(u64, Free)> =
        trajectory.seen.iter().filter_map(|(step, seen)| Some((*step, Free::of(body.inertia, seen)?))).collect();
    let row = Row::new(Experiment::Disc, "disc, 60 rad/s, h = 1/60 s", scheme, DISC_STEP_S, &trajectory);
    let Some((_, start)) = all.first().copied() else { return Vec::new() };
    let tilt = |at: &Free| {
        let l = at.momentum();
        (l.x * l.x + l.y * l.y).sqrt().to_f64().atan2(l.z.to_f64())
    };
    // Ten times the energy is an explosion for every purpose, whether the numbers stay finite or not.
    let blown = all
        .iter()
        .find(|(_, at)| at.twice_energy().to_f64() > 10.0 * start.twice_energy().to_f64())
        .map(|(step, _)| *step)
        .or(trajectory.failed_step);
    let flipped = all.iter().find(|(_, at)| at.omega.z.to_f64() < 0.0).map(|(step, _)| *step);
    let widest = largest(all.iter().map(|(_, at)| tilt(at))).filter(|x| x.is_finite());
    let last = all.last().map(|(_, at)| tilt(at));
    let event = |name: &str, step: Option<u64>| Row {
        at_step: step,
        ..row.measured(name, "steps", step.map(|step| step as f64))
    };
    vec![
        event("steps to tenfold energy", blown),
        event("steps to the first flip", flipped),
        row.measured("largest angle between L and the axis", "rad", widest),
        row.measured("last angle between L and the axis", "rad", last.filter(|_| trajectory.failed_step.is_none())),
    ]
}

/// What became of the disc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiscOutcome {
    /// The energy grew tenfold.
    BlowsUp(u64),
    /// The spin changed its sign in the body.
    Flips(u64),
    /// The nutation vanished.
    Damps,
    /// The nutation grew to an angle of order 1 and stayed there.
    Saturates,
    /// The nutation stayed as small as it is in the exact motion.
    Survives,
}

impl DiscOutcome {
    /// From the four rows of one scheme.
    pub fn of(rows: &[&Row]) -> Option<DiscOutcome> {
        let get = |name: &str| rows.iter().find(|row| row.quantity.contains(name));
        if let Some(step) = get("tenfold")?.at_step {
            return Some(DiscOutcome::BlowsUp(step));
        }
        if let Some(step) = get("flip")?.at_step {
            return Some(DiscOutcome::Flips(step));
        }
        let start = 0.15 / 30.0_f64;
        let (widest, last) = (get("largest angle")?.value?, get("last angle")?.value?);
        Some(match (widest, last) {
            (_, last) if last < 0.1 * start => DiscOutcome::Damps,
            (widest, _) if widest > 20.0 * start => DiscOutcome::Saturates,
            _ => DiscOutcome::Survives,
        })
    }

    /// In words.
    pub fn words(self) -> String {
        match self {
            DiscOutcome::BlowsUp(step) => format!("blows up: tenfold energy at step {step}"),
            DiscOutcome::Flips(step) => format!("flips at step {step}"),
            DiscOutcome::Damps => "damps the nutation".to_owned(),
            DiscOutcome::Saturates => "nutation grows, then saturates".to_owned(),
            DiscOutcome::Survives => "survives".to_owned(),
        }
    }
}

/// Stretches of a drift run.
pub(super) const STRETCHES: u64 = 128;

/// End of a drift run, s.
pub(super) const DRIFT_END_S: f64 = 32.0;

/// Drift of T, |L| and the direction of L on the generic body: first-order schemes lose a few per cent at the end.
pub fn drift(body: &TorqueFreeSpin, schemes: &[Scheme]) -> Vec<Row> {
    // Some ten periods of the body: a law of growth is not seen in two.
    schemes.iter().flat_map(|&scheme| drift_of(body, scheme, DRIFT_END_S)).collect()
}

fn drift_of(body: &TorqueFreeSpin, scheme: Scheme, end_s: f64) -> Vec<Row> {
    let h_s = if scheme.is_implicit() { 1.0 / 64.0 } else { 1.0 / 512.0 };
    let steps = (end_s / h_s) as u64;
    let trajectory = run::<f64>(scheme, body, end_s, steps, steps / STRETCHES / 4);
    let all: Vec<(u64, Free)> =
        trajectory.seen.iter().filter_map(|(step, seen)| Some((*step, Free::of(body.inertia, seen)?))).collect();
    let Some((_, start)) = all.first().copied() else { return Vec::new() };
    let row = Row::new(Experiment::Drift, "torque-free-spin", scheme, h_s, &trajectory);
    all.into_iter()
        .skip(1)
        .flat_map(|(step, at)| {
            let row = Row { t_s: step as f64 * h_s, ..row.clone() };
            let energy = (at.twice_energy() / start.twice_energy() - fx128::ONE).to_f64();
            let length = ((at.momentum_squared() / start.momentum_squared()).sqrt() - fx128::ONE).to_f64();
            [
                row.measured("T / T0 - 1", "1", Some(energy)),
                row.measured("|L| / |L0| - 1", "1", Some(length)),
                row.measured("angle of L", "rad", Some(angle(&at, &start))),
            ]
        })
        .collect()
}

/// The angle between two momenta: atan2(|a x b|, a . b), accurate for small ones.
fn angle(a: &Free, b: &Free) -> f64 {
    let (a, b) = (a.momentum_world, b.momentum_world);
    let across = integrator::rotation::cross(a, b);
    dot(across, across).sqrt().to_f64().atan2(dot(a, b).to_f64())
}

/// The largest distance between the motions of two schemes on one scene: angle in rad.
pub fn same_motion(scene: &dyn AnyScene, schemes: [Scheme; 2], end_s: f64, steps: u64) -> Vec<Row> {
    let [Some(one), Some(other)] = schemes.map(|scheme| scene.run(&Run::new(scheme, Precision::F64, end_s, steps), 1))
    else {
        return Vec::new();
    };
    let runs = [one, other];
    let finished = runs.iter().all(|run| run.outcome == Outcome::Finished);
    let apart = |[a, b]: &[Trajectory; 2]| {
        let both = a.seen.iter().zip(&b.seen);
        largest(both.flat_map(|((_, x), (_, y))| x.distances(y)).map(|(_, d)| d)).filter(|d| finished && d.is_finite())
    };
    let row = Row::new(Experiment::SameMotion, scene.id(), schemes[0], end_s / steps as f64, &runs[0]);
    let (turning, fastest) = turning(scene, end_s);
    // Either form rounds a few units in the last place a step, and the motion carries earlier roundings along.
    let tolerance = 64.0 * f64::EPSILON * steps as f64 * fastest.max(1.0);
    let row = row.measured(&format!("largest distance to {}", schemes[1].id()), "rad or rad/s", apart(&runs));
    vec![row.against(turning * end_s / steps as f64, tolerance)]
}

/// The integral of |omega x omega'| in rad^2/s^2, by which explicit Euler differs between the frames, times 1 / h; and the largest
/// |omega|, rad/s.
fn turning(scene: &dyn AnyScene, end_s: f64) -> (f64, f64) {
    let omega = |k: u32| {
        let seen = scene.exact(fx128::lit(end_s * f64::from(k) / 64.0));
        nalgebra::Vector3::from_iterator(seen.vector(Quantity::AngularVelocity).iter().map(|x| x.to_f64()))
    };
    let all: Vec<nalgebra::Vector3<f64>> = (0..=64).map(omega).collect();
    let turned = all.windows(2).map(|w| w[0].cross(&w[1]).norm()).sum();
    (turned, all.iter().map(nalgebra::Matrix::norm).fold(0.0, f64::max))
}
