//! One run against the exact motion: the errors at the end and at evenly spaced times.

use std::borrow::Cow;
use std::collections::BTreeMap;

use faer::fx128;
use integrator::Real;
use integrator::methods::MethodId;

use crate::observation::{Observation, Quantity};
use crate::run::{Outcome, Precision, Run, Trajectory};
use crate::scene::AnyScene;

/// Times at which a run is compared with the exact motion, evenly spaced; also the end.
pub const CHECKPOINTS: u64 = 32;

/// The exact motion of a scene at the checkpoints of every run, k T / 32.
pub struct Truth(Vec<Observation>);

/// The errors of one quantity in one run. What a failed run leaves open is `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// What was compared.
    pub quantity: Quantity,
    /// Error at the end.
    pub end: Option<f64>,
    /// Largest error at the checkpoints.
    pub max: Option<f64>,
    /// Distance at the end from the run in the reference's arithmetic.
    pub rounding_end: Option<f64>,
    /// Largest such distance at the checkpoints.
    pub rounding_max: Option<f64>,
    /// Size of the quantity at the end of the exact motion, in the same unit.
    pub scale: f64,
}

impl Truth {
    /// Evaluates the exact motion of a scene up to its horizon.
    pub fn of(scene: &dyn AnyScene) -> Self {
        Truth((0..=CHECKPOINTS).map(|k| exact_at(scene, k, CHECKPOINTS)).collect())
    }

    /// The exact motion at a step. Where the number of steps is a power of two the step is a checkpoint.
    fn at_step(&self, scene: &dyn AnyScene, step: u64, steps: u64) -> Cow<'_, Observation> {
        if (step * CHECKPOINTS).is_multiple_of(steps) {
            Cow::Borrowed(&self.0[(step * CHECKPOINTS / steps) as usize])
        } else {
            Cow::Owned(exact_at(scene, step, steps))
        }
    }

    /// The errors of a run of so many steps, and its distance from the run `reference` of the same steps.
    pub fn compare(&self, scene: &dyn AnyScene, steps: u64, run: &Trajectory, reference: &Trajectory) -> Vec<Errors> {
        let errors = largest(run.seen.iter().map(|(step, seen)| seen.distances(&self.at_step(scene, *step, steps))));
        let rounding = largest(run.seen.iter().zip(&reference.seen).map(|((_, a), (_, b))| a.distances(b)));
        let last = self.at_step(scene, steps, steps);
        let end = run.end().map(|seen| seen.distances(&last));
        let rounding_end = run.end().zip(reference.end()).map(|(a, b)| a.distances(b));
        let pick = |list: &Option<Vec<(Quantity, f64)>>, quantity| {
            list.as_ref()?.iter().find(|(q, _)| *q == quantity).map(|(_, x)| *x).filter(|x| x.is_finite())
        };
        let finished = run.outcome == Outcome::Finished;
        let of = |&(quantity, _): &(Quantity, _)| Errors {
            quantity,
            end: pick(&end, quantity),
            max: if finished { errors.get(&quantity).copied() } else { None },
            rounding_end: pick(&rounding_end, quantity),
            rounding_max: if finished { rounding.get(&quantity).copied() } else { None },
            scale: last.scale(quantity),
        };
        last.values.iter().map(of).collect()
    }
}

/// Steps between two looks at a run that is to be compared.
pub fn stride(steps: u64) -> u64 {
    (steps / CHECKPOINTS).max(1)
}

/// Runs a scene up to its horizon, observed where it is to be compared.
pub fn run(scene: &dyn AnyScene, method: MethodId, precision: Precision, steps: u64) -> Trajectory {
    let run = Run::new(method, precision, scene.scene().info().horizon_s, steps);
    scene.run(&run, stride(steps))
}

/// The exact motion at the part k / n of the horizon.
fn exact_at(scene: &dyn AnyScene, k: u64, n: u64) -> Observation {
    let end = fx128::lit(scene.scene().info().horizon_s);
    scene.exact(end * fx128::lit(k as f64) / fx128::lit(n as f64))
}

/// The largest distance of each quantity; a NaN stays.
fn largest(distances: impl Iterator<Item = Vec<(Quantity, f64)>>) -> BTreeMap<Quantity, f64> {
    let mut largest = BTreeMap::new();
    for (quantity, distance) in distances.flatten() {
        let entry = largest.entry(quantity).or_insert(distance);
        if distance > *entry || distance.is_nan() {
            *entry = distance;
        }
    }
    largest
}
