//! The error of a run: the largest distance of what is asked for from the exact motion, at a number of samples or at every step.

use std::cell::{Cell, RefCell};

use faer::fx128;
use integrator::Real;

use super::path::{Coordinates, Path};
use super::quantity::{Of, largest_distance};
use scenes::any::AnyScene;
use scenes::errors;
use scenes::observation::{Observation, Quantity, largest, worse};
use scenes::run::{Outcome, Trajectory};

/// Samples of a run of the study.
pub const SAMPLES: u64 = 32;
/// The error of the exact motion's polynomials, in parts of the error that is asked for.
const TARGET: f64 = 1.0 / 1024.0;
/// The same in parts of the motion's size, where no error is asked for: what rounding allows.
const FINEST: f64 = 1e-13;
/// An error that is larger by this factor than that of the polynomials is known to two digits.
const KNOWN: f64 = 64.0;

/// The exact motion of a scene at the samples of every run, and, where asked for, at every step.
pub struct ExactSamples<'a> {
    scene: &'a dyn AnyScene,
    exact: errors::ExactSamples,
    of: Of,
    end_s: f64,
    level: f64,
    path: Option<Path>,
}

/// Distances from the exact motion: of positions in m, of attitudes and angles in rad, the larger where a scene has both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// At the end of the run.
    pub end: f64,
    /// The largest at any sample.
    pub largest: f64,
}

impl<'a> ExactSamples<'a> {
    /// The exact motion at k T / `samples`.
    pub fn new(scene: &'a dyn AnyScene, end_s: f64, samples: u64) -> Self {
        let exact = errors::ExactSamples::up_to(scene, end_s, samples);
        ExactSamples { scene, exact, of: Of::Configuration, end_s, level: f64::INFINITY, path: None }
    }

    /// The same for the errors of a quantity.
    #[must_use]
    pub fn of(self, of: Of) -> Self {
        ExactSamples { of, ..self }
    }

    /// The same for the errors of a quantity, prepared to be compared with errors near `level` at every step of a run.
    #[must_use]
    pub fn at_every_step(self, of: Of, level: f64) -> Self {
        let truth = ExactSamples { of, level, ..self };
        let target = if level.is_finite() { TARGET * level } else { FINEST * truth.scale() };
        let path = Path::new(truth.scene, of, truth.end_s, target);
        // Polynomials that are no better than the level decide nothing.
        ExactSamples { path: path.filter(|path| level > KNOWN * path.margin), ..truth }
    }

    /// Steps between two samples of a run of so many steps.
    pub fn stride(&self, steps: u64) -> u64 {
        self.exact.stride(steps)
    }

    /// The errors of a finished run of `steps` steps at its samples; `None` for a failed one, or where a number is not finite.
    pub fn errors(&self, run: &Trajectory, steps: u64) -> Option<Errors> {
        if run.outcome != Outcome::Finished {
            return None;
        }
        over(run.seen.iter().map(|(step, seen)| self.distance(*step, steps, seen)))
    }

    /// The largest error of the attitude of a rigid body at the samples of a finished run, rad; `None` for another scene.
    pub fn attitude_error(&self, run: &Trajectory, steps: u64) -> Option<f64> {
        if run.outcome != Outcome::Finished || !self.scene.is_rigid() {
            return None;
        }
        let attitude = Of::Quantity(Quantity::Attitude);
        over(run.seen.iter().map(|(step, seen)| self.distance_of(attitude, *step, steps, seen))).map(|e| e.largest)
    }

    /// The distance from the exact motion at a step.
    fn distance(&self, step: u64, steps: u64, seen: &Observation) -> f64 {
        self.distance_of(self.of, step, steps, seen)
    }

    fn distance_of(&self, of: Of, step: u64, steps: u64, seen: &Observation) -> f64 {
        let (t, exact) = (self.time(step, steps), self.exact.at_step(self.scene, step, steps));
        largest_distance(&of.values(self.scene, t, seen), &of.values(self.scene, t, &exact))
    }

    fn time(&self, step: u64, steps: u64) -> fx128 {
        fx128::lit(self.end_s) * fx128::lit(step as f64) / fx128::lit(steps as f64)
    }

    /// The largest size of what is asked for along the exact motion: |x| in m, an angle in rad, 1 for an attitude.
    pub fn scale(&self) -> f64 {
        let samples = self.exact.samples();
        if let Of::Invariant(_) = self.of {
            let size = |(i, seen): (usize, &Observation)| {
                let t = self.time(i as u64, samples.len() as u64 - 1);
                Coordinates::of(&self.of.values(self.scene, t, seen)).values.into_iter().fold(0.0, f64::hypot)
            };
            return largest(samples.iter().enumerate().map(size)).unwrap_or(f64::NAN);
        }
        let of = |quantity| largest(samples.iter().map(move |seen| seen.scale(quantity))).unwrap_or(f64::NAN);
        match self.of {
            Of::Quantity(quantity) => of(quantity),
            _ => worse(of(Quantity::Position), of(Quantity::Attitude)),
        }
    }

    /// Units of the errors of this scene: `m`, `rad`, or both.
    pub fn unit(&self) -> &'static str {
        self.of.unit(&self.exact.samples()[0])
    }

    /// Whether the scene has what is asked for, and whether its exact motion is finite.
    pub fn is_known(&self) -> [bool; 2] {
        let samples = self.exact.samples();
        let values = |i: usize| {
            let t = self.time(i as u64, samples.len() as u64 - 1);
            Coordinates::of(&self.of.values(self.scene, t, &samples[i])).values
        };
        [!values(0).is_empty(), (0..samples.len()).all(|i| values(i).iter().all(|x| x.is_finite()))]
    }
}

/// Watches a run, step after step.
pub struct Watch<'t, 'a> {
    truth: &'t ExactSamples<'a>,
    path: Option<&'t Path>,
    steps: u64,
    cursor: Cell<usize>,
    largest: RefCell<Option<(f64, u64, Observation)>>,
}

impl<'t, 'a> Watch<'t, 'a> {
    /// Of a run of so many steps.
    pub fn new(truth: &'t ExactSamples<'a>, steps: u64) -> Self {
        let path = truth.path.as_ref();
        Watch { truth, path, steps, cursor: Cell::new(0), largest: RefCell::new(None) }
    }

    /// Of the same run again, with the exact motion evaluated at every step.
    pub fn exactly(truth: &'t ExactSamples<'a>, steps: u64) -> Self {
        Watch { path: None, ..Self::new(truth, steps) }
    }

    /// One step of the run.
    pub fn see(&self, step: u64, seen: Observation) {
        let distance = self.distance(step, &seen);
        let mut largest = self.largest.borrow_mut();
        if largest.as_ref().is_none_or(|(most, ..)| distance > *most || distance.is_nan()) {
            *largest = Some((distance, step, seen));
        }
    }

    /// By the polynomial; by the exact motion where the polynomial leaves open on which side of the level the distance lies.
    fn distance(&self, step: u64, seen: &Observation) -> f64 {
        let exactly = || self.truth.distance(step, self.steps, seen);
        let Some(path) = self.path else { return exactly() };
        let mut cursor = self.cursor.get();
        let exact = path.at(step, self.steps, &mut cursor);
        self.cursor.set(cursor);
        let Some(exact) = exact else { return exactly() };
        let t = self.truth.time(step, self.steps);
        let distance = Coordinates::of(&self.truth.of.values(self.truth.scene, t, seen)).distance(&exact);
        if (distance - self.truth.level).abs() <= path.margin { exactly() } else { distance }
    }

    /// The largest distance of a finished run: that of the exact motion at the step where it was met. `None` where a number is not
    /// finite; the flag says whether the polynomials were near enough for it.
    pub fn largest(&self) -> (Option<f64>, bool) {
        let largest = self.largest.borrow();
        let Some((_, step, seen)) = largest.as_ref() else { return (None, true) };
        let distance = self.truth.distance(*step, self.steps, seen);
        let near = self.truth.level.is_finite() || self.path.is_none_or(|path| distance > KNOWN * path.margin);
        (Some(distance).filter(|d| d.is_finite()), near)
    }
}

/// The largest distance between two runs of the same steps: the rounding of the coarser arithmetic.
pub fn apart(a: &Trajectory, b: &Trajectory) -> Option<f64> {
    if a.outcome != Outcome::Finished || b.outcome != Outcome::Finished {
        return None;
    }
    over(a.seen.iter().zip(&b.seen).map(|((_, a), (_, b))| of_configuration(a, b))).map(|errors| errors.largest)
}

/// A NaN stays, and makes the whole not a number.
fn over(distances: impl Iterator<Item = f64>) -> Option<Errors> {
    let (mut largest, mut end) = (0.0_f64, f64::NAN);
    for distance in distances {
        largest = if distance > largest || distance.is_nan() { distance } else { largest };
        end = distance;
        if largest.is_nan() {
            return None;
        }
    }
    (largest.is_finite() && end.is_finite()).then_some(Errors { end, largest })
}

fn of_configuration(a: &Observation, b: &Observation) -> f64 {
    let distances = a.distances(b);
    let of_configuration = distances.iter().filter(|(q, _)| matches!(q, Quantity::Position | Quantity::Attitude));
    of_configuration.map(|(_, d)| *d).reduce(worse).unwrap_or(f64::NAN)
}
