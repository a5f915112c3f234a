//! One run against the exact motion: the errors at the end and at evenly spaced times.

use std::borrow::Cow;
use std::collections::BTreeMap;

use faer::fx128;
use integrator::Real;

use crate::any::AnyScene;
use crate::observation::{Observation, Quantity};
use crate::run::{Outcome, Precision, Run, Trajectory};
use crate::scheme::Scheme;

pub use crate::run::CHECKPOINTS;

/// The exact motion of a scene at evenly spaced times of every run, k T / n for k = 0..n.
pub struct ExactSamples {
    end_s: f64,
    samples: Vec<Observation>,
}

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
    /// Largest size of the quantity along the exact motion, in the same unit: a motion that has died away is judged by what it
    /// was.
    pub scale: f64,
}

impl ExactSamples {
    /// Evaluates the exact motion of a scene at the checkpoints up to `end_s`.
    pub fn of(scene: &dyn AnyScene, end_s: f64) -> Self {
        Self::up_to(scene, end_s, CHECKPOINTS)
    }

    /// Evaluates the exact motion of a scene at k T / `samples`.
    pub fn up_to(scene: &dyn AnyScene, end_s: f64, samples: u64) -> Self {
        ExactSamples { end_s, samples: (0..=samples).map(|k| exact_at(scene, end_s, k, samples)).collect() }
    }

    /// The exact motion at the samples, the start and the end among them.
    pub fn samples(&self) -> &[Observation] {
        &self.samples
    }

    /// Steps between two looks at a run of so many steps.
    pub fn stride(&self, steps: u64) -> u64 {
        (steps / self.parts()).max(1)
    }

    fn parts(&self) -> u64 {
        self.samples.len() as u64 - 1
    }

    /// The exact motion at a step. Where the number of steps is a multiple of the samples, the samples are steps.
    pub fn at_step(&self, scene: &dyn AnyScene, step: u64, steps: u64) -> Cow<'_, Observation> {
        let scaled = u128::from(step) * u128::from(self.parts());
        if scaled.is_multiple_of(u128::from(steps)) {
            Cow::Borrowed(&self.samples[(scaled / u128::from(steps)) as usize])
        } else {
            Cow::Owned(exact_at(scene, self.end_s, step, steps))
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
            scale: self.samples.iter().map(|look| look.scale(quantity)).fold(last.scale(quantity), f64::max),
        };
        last.values.iter().map(of).collect()
    }
}

/// Steps between two looks at a run that is to be compared.
pub fn stride(steps: u64) -> u64 {
    (steps / CHECKPOINTS).max(1)
}

/// Runs a scene up to `end_s`, observed where it is to be compared; `None` for a step that the scene cannot take.
pub fn run(
    scene: &dyn AnyScene,
    scheme: impl Into<Scheme>,
    precision: Precision,
    end_s: f64,
    steps: u64,
) -> Option<Trajectory> {
    let run = Run::new(scheme, precision, end_s, steps);
    scene.run(&run, stride(steps))
}

/// The exact motion at the part k / n of the time up to the end.
fn exact_at(scene: &dyn AnyScene, end_s: f64, k: u64, n: u64) -> Observation {
    scene.exact(fx128::lit(end_s) * fx128::lit(k as f64) / fx128::lit(n as f64))
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
