//! What is lost over a long run? Energy, momenta and the quaternion's norm against time, and the law of their growth.

mod laws;
mod show;

pub use laws::{LawRow, laws};

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Real, Single};
use reports::{Claim, Figure};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::study::{Derived, Selection, Study, check_method, check_scene, check_steps};
use crate::sweep::{Progress, in_parallel};
use scenes::any::AnyScene;
use scenes::invariants::{Entry, Invariant};
use scenes::observation::{Observation, Value, largest, norm};
use scenes::run::{Outcome, Precision, Run, method_from_id};
use scenes::theory::ExpectedGrowth;
use scenes::theory::Law;

/// Length of a run in natural time scales of the scene; a power of two.
const TIME_SCALES: f64 = 1024.0;
/// The same with `--quick`.
const QUICK_TIME_SCALES: f64 = 128.0;
/// Steps in one natural time scale.
const STEPS_A_TIME_SCALE: u64 = 32;
/// Rows of a run: each tells the least, the greatest and the last error of its stretch.
const STRETCHES: u64 = 128;
/// Observations in a stretch.
const OBSERVATIONS: u64 = 16;
/// The same with `--quick`.
const QUICK_OBSERVATIONS: u64 = 8;

/// What an error is taken of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Drift {
    /// E - E*, J.
    Energy,
    /// |p| - |p*|, kg m/s.
    MomentumNorm,
    /// Angle between p and p*, rad.
    MomentumDirection,
    /// |L| - |L*|, kg m^2/s.
    AngularMomentumNorm,
    /// Angle between L and L*, rad.
    AngularMomentumDirection,
    /// |q| - 1.
    QuaternionNorm,
}

impl Drift {
    /// Every one.
    pub const ALL: [Drift; 6] = [
        Drift::Energy,
        Drift::MomentumNorm,
        Drift::MomentumDirection,
        Drift::AngularMomentumNorm,
        Drift::AngularMomentumDirection,
        Drift::QuaternionNorm,
    ];

    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            Drift::Energy => "energy",
            Drift::MomentumNorm => "momentum-norm",
            Drift::MomentumDirection => "momentum-direction",
            Drift::AngularMomentumNorm => "angular-momentum-norm",
            Drift::AngularMomentumDirection => "angular-momentum-direction",
            Drift::QuaternionNorm => "quaternion-norm",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Drift::Energy => "J",
            Drift::MomentumNorm => "kg m/s",
            Drift::AngularMomentumNorm => "kg m^2/s",
            Drift::MomentumDirection | Drift::AngularMomentumDirection => "rad",
            Drift::QuaternionNorm => "1",
        }
    }
}

/// The error of one invariant in one stretch of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Scene or preset.
    pub scene: String,
    /// Method.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// Step, s.
    pub h_s: f64,
    /// What the error is of.
    pub drift: Drift,
    /// Unit of the errors.
    pub unit: String,
    /// Size of the invariant at the start, in the same unit; 1 for an angle and for the quaternion.
    pub scale: f64,
    /// Size of the terms that the invariant is a sum of, at most, in the same unit: what it is rounded by is a part of them.
    pub terms: f64,
    /// End of the stretch, s.
    pub t_s: f64,
    /// Least error in the stretch.
    pub error_min: Option<f64>,
    /// Greatest error in the stretch.
    pub error_max: Option<f64>,
    /// How the run ended.
    pub outcome: Outcome,
    /// When it failed, s.
    pub failed_at_s: Option<f64>,
    /// The law that theory predicts, where it does.
    pub theory_law: Option<Law>,
    /// The length of a run from which on that law is to be seen, s.
    pub theory_seen_after_s: Option<f64>,
    /// Low end of what theory predicts: (value / start) of a bounded law, rate in 1/s of an exponential one.
    pub theory_low: Option<f64>,
    /// High end of the same.
    pub theory_high: Option<f64>,
}

/// The study.
pub struct DriftStudy;

impl Study for DriftStudy {
    type Row = Row;
    const ID: &'static str = "drift";
    const HEEDS: &'static [&'static str] = &["precision", "for"];
    const ABOUT: &'static str =
        "Follows energy, momenta and the quaternion's norm over a long run and names the law of their growth";
    const EXAMPLES: &'static str = "drift --scene oscillator --method rk4
        drift --scene torque-free-spin --precision f64 --out /tmp/spin
        drift --scene oscillator --set stiffness=24";
    const TITLE: &'static str = "What is lost over a long run? Drift";
    const INTRO: &'static str = "Energy, momenta and the quaternion's norm are followed for a thousand natural time scales \
        of each scene, 32 steps each. The law by which an error grows tells more than its size: a bounded error stays harmless, \
        a linear one does not, an exponential one ruins every run that is long enough.";

    fn measure(selection: &Selection) -> Vec<Row> {
        let (scales, observations) =
            if selection.quick { (QUICK_TIME_SCALES, QUICK_OBSERVATIONS) } else { (TIME_SCALES, OBSERVATIONS) };
        let scenes: Vec<&dyn AnyScene> = selection.scenes.iter().map(AsRef::as_ref).collect();
        let tracks = in_parallel(
            &scenes,
            |_| 1,
            &Progress::silent(),
            |&scene| Track::of(scene, selection.given_end_s(scene), scales, observations),
        );
        let mut jobs = Vec::new();
        for track in &tracks {
            for &method in &selection.methods {
                // Rounding is not the question here, except that a run without any shows a law undisturbed.
                for &precision in selection.precisions.iter().filter(|p| **p != Precision::DoubleDouble) {
                    jobs.push((track, method, precision));
                }
            }
        }
        let cost = |job: &(&Track<'_>, MethodId, Precision)| {
            if job.1.is_implicit() { 20 } else { u64::from(job.1.order()) }
        };
        selection.rows(&jobs, 1.2e-3, cost, |&(track, method, precision)| track.rows(method, precision))
    }
    fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
        Ok(vec![laws::table(rows)?])
    }
    fn figures(rows: &[Row]) -> Vec<Figure> {
        show::figures(rows)
    }
    fn claims(rows: &[Row]) -> Vec<Claim> {
        laws::claims(rows)
    }
    fn check(row: &Row) -> Result<(), String> {
        check_scene(&row.scene)?;
        check_method(&row.method, method_from_id(&row.method).is_ok())?;
        if !(row.terms >= 0.0 && row.terms.is_finite()) {
            return Err(format!("'terms' is {}, and a size is finite and not negative", row.terms));
        }
        check_steps(1, row.h_s)
    }
}

/// A long run of one scene, and the exact invariants at each of its observations.
struct Track<'a> {
    scene: &'a dyn AnyScene,
    h_s: f64,
    steps: u64,
    /// Steps from one observation to the next.
    stride: u64,
    /// One set of invariants, if all are conserved; else one for each observation.
    truth: Vec<Vec<Entry>>,
    kinds: Vec<(Drift, f64)>,
}

impl<'a> Track<'a> {
    fn of(scene: &'a dyn AnyScene, end_s: Option<f64>, time_scales: f64, observations: u64) -> Self {
        // Dyadic, so that every precision takes the same step.
        let h_s = (scene.scene().info().time_scale_s / STEPS_A_TIME_SCALE as f64).log2().round().exp2();
        let steps = time_scales as u64 * STEPS_A_TIME_SCALE;
        let (h_s, steps) = end_s.map_or((h_s, steps), |end_s| {
            let steps = (end_s / h_s / STRETCHES as f64).ceil().max(1.0) as u64 * STRETCHES;
            (end_s / steps as f64, steps)
        });
        let stride = (steps / STRETCHES / observations).max(1);
        let start = scene.exact(fx128::ZERO);
        let first = scene.scene().invariants(fx128::ZERO, &start);
        let at = |step: u64| {
            let t = fx128::lit(step as f64 * h_s);
            scene.scene().invariants(t, &scene.exact(t))
        };
        let conserved = first.iter().all(|entry| entry.conserved);
        let norm = start.rotation().map(|_| Drift::QuaternionNorm);
        let kinds = drifts(&first, &first).into_iter().map(|(drift, _)| drift).chain(norm);
        let seen: Vec<Vec<(Drift, f64)>> = (0..=SAMPLES)
            .map(|k| terms(scene, fx128::lit(steps as f64 * h_s) * fx128::lit(k as f64 / SAMPLES as f64)))
            .collect();
        let largest = |drift| seen.iter().flatten().filter(|(d, _)| *d == drift).map(|(_, x)| *x).fold(0.0, f64::max);
        let kinds = kinds.map(|drift| (drift, largest(drift))).collect();
        let truth = if conserved { vec![first] } else { (0..=steps / stride).map(|k| at(k * stride)).collect() };
        Track { scene, h_s, steps, stride, truth, kinds }
    }

    fn errors(&self, step: u64, seen: &Observation) -> Vec<(Drift, f64)> {
        let invariants = self.scene.scene().invariants(fx128::lit(step as f64 * self.h_s), seen);
        let truth = if self.truth.len() == 1 { &self.truth[0] } else { &self.truth[(step / self.stride) as usize] };
        let mut errors = drifts(&invariants, truth);
        if seen.rotation().is_some() {
            errors.push((Drift::QuaternionNorm, seen.norm_error));
        }
        errors
    }

    fn rows(&self, method: MethodId, precision: Precision) -> Vec<Row> {
        let run = Run::new(method, precision, self.h_s * self.steps as f64, self.steps);
        let Some(trajectory) = self.scene.run(&run, self.stride) else { return Vec::new() };
        let seen = trajectory.seen.iter().skip(1);
        let measured: Vec<(u64, Vec<(Drift, f64)>)> =
            seen.map(|(step, seen)| (*step, self.errors(*step, seen))).collect();
        let failed_at_s = trajectory.failed_step.map(|step| step as f64 * self.h_s);
        let mut rows = Vec::new();
        for (i, &(drift, terms)) in self.kinds.iter().enumerate() {
            let theory = self.theory(method, drift);
            for stretch in 0..STRETCHES {
                let [begin, end] = [stretch, stretch + 1].map(|k| self.steps * k / STRETCHES);
                let inside = measured.partition_point(|(step, _)| *step <= begin)
                    ..measured.partition_point(|(step, _)| *step <= end);
                let values = measured[inside].iter().map(|(_, errors)| errors[i].1);
                let complete = failed_at_s.is_none_or(|t| t > end as f64 * self.h_s);
                // The least is the negative of the largest negative: a NaN stays in either.
                let most = |sign: f64| largest(values.clone().map(|x| sign * x)).filter(|x| complete && x.is_finite());
                rows.push(Row {
                    scene: self.scene.id().to_owned(),
                    method: method.id().to_owned(),
                    precision,
                    h_s: self.h_s,
                    drift,
                    unit: drift.unit().to_owned(),
                    scale: scale(&self.truth[0], drift),
                    terms,
                    t_s: end as f64 * self.h_s,
                    error_min: most(-1.0).map(|x| -x),
                    error_max: most(1.0),
                    outcome: trajectory.outcome,
                    failed_at_s,
                    theory_law: theory.map(|t| t.law),
                    theory_seen_after_s: theory.map(|t| t.seen_after_s),
                    theory_low: theory.and_then(|t| t.bounds).map(|b| b[0]),
                    theory_high: theory.and_then(|t| t.bounds).map(|b| b[1]),
                });
            }
        }
        rows
    }

    fn theory(&self, method: MethodId, drift: Drift) -> Option<ExpectedGrowth> {
        let invariant = match drift {
            Drift::Energy => Invariant::Energy,
            Drift::MomentumNorm => Invariant::Momentum,
            Drift::AngularMomentumNorm => Invariant::AngularMomentum,
            _ => return None,
        };
        self.scene.scene().expected_growth(method, invariant, self.h_s)
    }
}

/// Times at which the terms of the invariants are looked at.
const SAMPLES: u64 = 16;

/// Size of the terms of each invariant on the exact motion: how much it changes for the relative change of each component of what is
/// seen.
fn terms(scene: &dyn AnyScene, t: fx128) -> Vec<(Drift, f64)> {
    const CHANGE: f64 = 1.0 / 1_048_576.0;
    let seen = scene.exact(t);
    let at = |seen: &Observation| scene.scene().invariants(t, seen);
    let own = at(&seen);
    let mut sizes: Vec<(Drift, f64)> = drifts(&own, &own);
    let mut add = |moved: &Observation| {
        for (sum, (_, change)) in sizes.iter_mut().zip(drifts(&at(moved), &own)) {
            sum.1 += change.abs() / CHANGE;
        }
    };
    for (i, (quantity, value)) in seen.values.iter().enumerate() {
        let mut moved = seen.clone();
        match value {
            Value::Vector(components) => {
                for c in 0..components.len() {
                    let mut other = components.clone();
                    let change = other[c] * fx128::lit(CHANGE);
                    other[c] += change;
                    moved.values[i] = (*quantity, Value::Vector(other));
                    add(&moved);
                }
            }
            Value::Rotation(q) => {
                for axis in 0..3 {
                    let mut by = nalgebra::Vector3::from([fx128::ZERO; 3]);
                    by[axis] = fx128::lit(CHANGE);
                    moved.values[i] = (*quantity, Value::Rotation(integrator::Rotation::exp(by) * *q));
                    add(&moved);
                }
            }
        }
    }
    sizes
}

/// Errors of the invariants against the exact ones, scalars as they are, vectors by norm and direction.
pub fn drifts(seen: &[Entry], truth: &[Entry]) -> Vec<(Drift, f64)> {
    let mut errors = Vec::new();
    for (a, b) in seen.iter().zip(truth) {
        let norms = || (norm(a.value.iter().copied()) - norm(b.value.iter().copied())).to_f64();
        match a.invariant {
            Invariant::Energy => errors.push((Drift::Energy, (a.value[0] - b.value[0]).to_f64())),
            Invariant::Momentum => {
                errors.push((Drift::MomentumNorm, norms()));
                errors.push((Drift::MomentumDirection, angle(&a.value, &b.value)));
            }
            Invariant::AngularMomentum => {
                errors.push((Drift::AngularMomentumNorm, norms()));
                // A plane motion has one component, and no direction to lose.
                if a.value.len() > 1 {
                    errors.push((Drift::AngularMomentumDirection, angle(&a.value, &b.value)));
                }
            }
        }
    }
    errors
}

/// The angle between two vectors by Kahan's formula, 2 atan2(|a/|a| - b/|b||, |a/|a| + b/|b||), accurate at 0 and at pi.
fn angle(a: &[fx128], b: &[fx128]) -> f64 {
    let (na, nb) = (norm(a.iter().copied()), norm(b.iter().copied()));
    let pairs: Vec<(fx128, fx128)> = a.iter().zip(b).map(|(&x, &y)| (x / na, y / nb)).collect();
    let difference = norm(pairs.iter().map(|(x, y)| *x - *y));
    let sum = norm(pairs.iter().map(|(x, y)| *x + *y));
    2.0 * difference.atan2(sum).to_f64()
}

/// Size of an invariant at the start; 1 for an angle and for the quaternion.
pub fn scale(reference: &[Entry], drift: Drift) -> f64 {
    let invariant = match drift {
        Drift::Energy => Invariant::Energy,
        Drift::MomentumNorm => Invariant::Momentum,
        Drift::AngularMomentumNorm => Invariant::AngularMomentum,
        Drift::MomentumDirection | Drift::AngularMomentumDirection | Drift::QuaternionNorm => return 1.0,
    };
    let value =
        reference.iter().find(|entry| entry.invariant == invariant).map(|entry| norm(entry.value.iter().copied()));
    value.map_or(1.0, Single::to_f64)
}
