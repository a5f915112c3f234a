//! The error of a run: the largest over a number of looks of what its configuration is away from the exact motion.

use scenes::any::AnyScene;
use scenes::errors;
use scenes::observation::{Observation, Quantity};
use scenes::run::{Outcome, Trajectory};

/// Looks at a run of the study.
pub const LOOKS: u64 = 32;

/// The exact motion of a scene at the looks of every run.
pub struct Truth<'a> {
    scene: &'a dyn AnyScene,
    exact: errors::Truth,
}

/// Distances from the exact motion: of positions in m, of attitudes and angles in rad, the larger where a scene has both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// At the end of the run.
    pub end: f64,
    /// The largest at any look.
    pub largest: f64,
}

impl<'a> Truth<'a> {
    /// The exact motion at k T / `looks`.
    pub fn new(scene: &'a dyn AnyScene, end_s: f64, looks: u64) -> Self {
        Truth { scene, exact: errors::Truth::up_to(scene, end_s, looks) }
    }

    /// Steps between two looks at a run of so many steps.
    pub fn stride(&self, steps: u64) -> u64 {
        self.exact.stride(steps)
    }

    /// The errors of a finished run of `steps` steps; `None` for a failed one, or where a number is not finite.
    pub fn errors(&self, run: &Trajectory, steps: u64) -> Option<Errors> {
        if run.outcome != Outcome::Finished {
            return None;
        }
        over(run.seen.iter().map(|(step, seen)| of_configuration(seen, &self.exact.at_step(self.scene, *step, steps))))
    }

    /// The largest size of the configuration: |x| in m, an angle in rad, 1 for an attitude.
    pub fn scale(&self) -> f64 {
        let of = |quantity| self.exact.looks().iter().map(move |seen| seen.scale(quantity)).fold(0.0, f64::max);
        of(Quantity::Position).max(of(Quantity::Attitude))
    }

    /// Units of the errors of this scene: `m`, `rad`, or both.
    pub fn unit(&self) -> &'static str {
        let has = |quantity| self.exact.looks()[0].get(quantity).is_some();
        match (has(Quantity::Position), has(Quantity::Attitude)) {
            (true, true) => "m and rad",
            (false, true) => "rad",
            _ => "m",
        }
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
    of_configuration.map(|(_, d)| *d).fold(0.0, |a: f64, b| if b > a || b.is_nan() { b } else { a })
}
