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
use crate::growth::Law;
use crate::observation::{Observation, norm};
use crate::run::{Outcome, Precision, Run};
use crate::scene::{AnyScene, Balance, Entry};
use crate::study::{Derived, Selection, Study};
use crate::sweep::in_parallel;

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

/// The error of one balance in one stretch of a run.
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
    /// Size of the balance at the start, in the same unit; 1 for an angle and for the quaternion.
    pub scale: f64,
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
    const TITLE: &'static str = "What is lost over a long run? Drift";
    const INTRO: &'static str = "Energy, momenta and the quaternion's norm are followed for a thousand natural time scales \
        of each scene, 32 steps each. The law by which an error grows tells more than its size: a bounded error stays harmless, \
        a linear one does not, an exponential one ruins every run that is long enough.";

    fn measure(selection: &Selection) -> Vec<Row> {
        let mut jobs = Vec::new();
        for scene in &selection.scenes {
            for &method in &selection.methods {
                // Rounding is not the question here, except that a run without any shows a law undisturbed.
                for &precision in selection.precisions.iter().filter(|p| **p != Precision::DoubleDouble) {
                    jobs.push(Job { scene: scene.as_ref(), method, precision, quick: selection.quick });
                }
            }
        }
        let cost = |job: &Job<'_>| if job.method.is_implicit() { 20 } else { u64::from(job.method.order()) };
        in_parallel(&jobs, cost, &selection.progress, Job::rows).into_iter().flatten().collect()
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
}

struct Job<'a> {
    scene: &'a dyn AnyScene,
    method: MethodId,
    precision: Precision,
    quick: bool,
}

impl Job<'_> {
    fn rows(&self) -> Vec<Row> {
        let scales = if self.quick { QUICK_TIME_SCALES } else { TIME_SCALES };
        // Dyadic, so that every precision takes the same step.
        let h_s = (self.scene.scene().info().time_scale_s / STEPS_A_TIME_SCALE as f64).log2().round().exp2();
        let steps = scales as u64 * STEPS_A_TIME_SCALE;
        let run = Run::new(self.method, self.precision, h_s * steps as f64, steps);
        let trajectory = self.scene.run(&run, (steps / STRETCHES / OBSERVATIONS).max(1));
        let start = self.scene.exact(fx128::ZERO);
        let account = |t_s: f64, seen: &Observation| self.scene.scene().account(fx128::lit(t_s), seen);
        let reference = account(0.0, &start);
        let errors = |step: u64, seen: &Observation| {
            let t_s = step as f64 * h_s;
            let truth = if reference.iter().all(|entry| entry.conserved) {
                reference.clone()
            } else {
                account(t_s, &self.scene.exact(fx128::lit(t_s)))
            };
            let mut errors = drifts(&account(t_s, seen), &truth);
            if seen.rotation().is_some() {
                errors.push((Drift::QuaternionNorm, seen.norm_error));
            }
            errors
        };
        let measured: Vec<(u64, Vec<(Drift, f64)>)> =
            trajectory.seen.iter().skip(1).map(|(step, seen)| (*step, errors(*step, seen))).collect();
        let failed_at_s = trajectory.failed_step.map(|step| step as f64 * h_s);
        let kinds: Vec<Drift> = drifts(&reference, &reference)
            .into_iter()
            .map(|(drift, _)| drift)
            .chain(start.rotation().map(|_| Drift::QuaternionNorm))
            .collect();
        let mut rows = Vec::new();
        for drift in kinds {
            let theory = self.theory(drift, h_s);
            for stretch in 0..STRETCHES {
                let ends = steps * stretch / STRETCHES..=steps * (stretch + 1) / STRETCHES;
                let inside = measured.iter().filter(|(step, _)| ends.contains(step) && step != ends.start());
                let values: Vec<f64> =
                    inside.flat_map(|(_, e)| e.iter().filter(|(d, _)| *d == drift).map(|(_, x)| *x)).collect();
                let complete = failed_at_s.is_none_or(|t| t > *ends.end() as f64 * h_s) && !values.is_empty();
                let fold = |f: fn(f64, f64) -> f64| complete.then(|| values.iter().copied().fold(values[0], f));
                rows.push(Row {
                    scene: self.scene.id().to_owned(),
                    method: self.method.id().to_owned(),
                    precision: self.precision,
                    h_s,
                    drift,
                    unit: drift.unit().to_owned(),
                    scale: scale(&reference, drift),
                    t_s: *ends.end() as f64 * h_s,
                    error_min: fold(f64::min),
                    error_max: fold(f64::max),
                    outcome: trajectory.outcome,
                    failed_at_s,
                    theory_law: theory.map(|t| t.law),
                    theory_low: theory.and_then(|t| t.bounds).map(|b| b[0]),
                    theory_high: theory.and_then(|t| t.bounds).map(|b| b[1]),
                });
            }
        }
        rows
    }

    fn theory(&self, drift: Drift, h_s: f64) -> Option<crate::scene::ExpectedGrowth> {
        let balance = match drift {
            Drift::Energy => Balance::Energy,
            Drift::MomentumNorm => Balance::Momentum,
            Drift::AngularMomentumNorm => Balance::AngularMomentum,
            _ => return None,
        };
        self.scene.scene().growth(self.method, balance, h_s)
    }
}

/// Errors of an account against the true one, scalars as they are, vectors by norm and direction.
fn drifts(seen: &[Entry], truth: &[Entry]) -> Vec<(Drift, f64)> {
    let mut errors = Vec::new();
    for (a, b) in seen.iter().zip(truth) {
        let norms = || (norm(a.value.iter().copied()) - norm(b.value.iter().copied())).to_f64();
        match a.balance {
            Balance::Energy => errors.push((Drift::Energy, (a.value[0] - b.value[0]).to_f64())),
            Balance::Momentum => {
                errors.push((Drift::MomentumNorm, norms()));
                errors.push((Drift::MomentumDirection, angle(&a.value, &b.value)));
            }
            Balance::AngularMomentum => {
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

fn scale(reference: &[Entry], drift: Drift) -> f64 {
    let balance = match drift {
        Drift::Energy => Balance::Energy,
        Drift::MomentumNorm => Balance::Momentum,
        Drift::AngularMomentumNorm => Balance::AngularMomentum,
        Drift::MomentumDirection | Drift::AngularMomentumDirection | Drift::QuaternionNorm => return 1.0,
    };
    let value = reference.iter().find(|entry| entry.balance == balance).map(|entry| norm(entry.value.iter().copied()));
    value.map_or(1.0, Single::to_f64)
}
