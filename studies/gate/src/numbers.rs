//! From rows to numbers: the runs of one scene, method and precision are made once and read by all their rows.

use std::cell::RefCell;
use std::collections::HashMap;

use faer::fx128;
use integrator::{Real, Single};

use super::candidate::Candidate;
use super::row::{Kind, Row, Subject};
use super::stepper::{Ask, Stepper};
use measure::drift::{Drift, drifts, scale};
use measure::growth;
use measure::growth::Envelope;
use measure::stability::bisect::Found;
use scenes::any::AnyScene;
use scenes::invariants::Entry;
use scenes::observation::{Observation, Quantity};
use scenes::run::{Outcome, Precision, Trajectory};
use scenes::theory::ExpectedOrder;

/// What became of one row.
#[derive(Clone, Debug, PartialEq)]
pub enum Measured {
    /// A number, which may be NaN.
    Value(f64),
    /// A run did not finish; the step at which it failed.
    Failed(Outcome, Option<u64>),
    /// The runs finished and the number does not exist: why.
    Undefined(String),
    /// The candidate cannot be asked this.
    NotAsked,
}

impl Measured {
    /// The number, where there is one.
    pub fn value(&self) -> Option<f64> {
        match self {
            Measured::Value(x) => Some(*x),
            _ => None,
        }
    }

    /// In words.
    pub fn text(&self) -> String {
        match self {
            Measured::Value(x) => format!("{x:.6e}"),
            Measured::Failed(outcome, step) => {
                let how = if *outcome == Outcome::NotConverged { "not converged" } else { "diverged" };
                step.map_or_else(|| how.to_owned(), |step| format!("{how} at step {step}"))
            }
            Measured::Undefined(why) => why.clone(),
            Measured::NotAsked => "not asked".to_owned(),
        }
    }
}

/// Observations of a long run.
const SAMPLES: u64 = 1024;
/// Stretches of a long run, of whose largest values a rate is fitted.
const STRETCHES: usize = 128;
/// A run whose step is stable up to this many time scales has no limit for the purpose of a bound.
pub const UNLIMITED: f64 = measure::stability::limits::TRIED[1];

/// The runs of one candidate on one scene in one precision.
pub struct Runs<'a> {
    candidate: &'a dyn Candidate,
    scene: &'a dyn AnyScene,
    precision: Precision,
    ends: RefCell<HashMap<(u64, u64), Option<End>>>,
    exact: RefCell<HashMap<u64, Observation>>,
    long: RefCell<HashMap<(u64, u64), Option<Long>>>,
}

/// What is left of a run to its end.
#[derive(Clone)]
struct End {
    outcome: Outcome,
    failed_step: Option<u64>,
    errors: Vec<(Quantity, f64)>,
    evaluations: u64,
}

/// What is left of a run that was looked at all along: the time and the errors of each invariant.
#[derive(Clone)]
struct Long {
    outcome: Outcome,
    failed_step: Option<u64>,
    first: Vec<Entry>,
    errors: Vec<(f64, Vec<(Drift, f64)>)>,
}

impl<'a> Runs<'a> {
    /// No run is made yet.
    pub fn new(candidate: &'a dyn Candidate, scene: &'a dyn AnyScene, precision: Precision) -> Self {
        Runs {
            candidate,
            scene,
            precision,
            ends: RefCell::default(),
            exact: RefCell::default(),
            long: RefCell::default(),
        }
    }

    /// The number that a row bounds.
    pub fn measure(&self, row: &Row) -> Measured {
        let found = match (row.quantity, row.kind) {
            (Subject::Error(quantity), Kind::Order) => self.order(quantity, row.steps, row.end_s),
            (Subject::Error(quantity), Kind::ErrorConstant) => self.constant(quantity, row),
            (Subject::Error(quantity), _) => self.error(quantity, row.steps, row.end_s),
            (Subject::Invariant(drift), kind) => self.along(drift, kind, row.steps, row.end_s),
            (Subject::Step, _) => return self.limit(),
            (Subject::Evaluations, _) => {
                self.end(row.steps, row.end_s).map(|end| end.evaluations as f64 / row.steps as f64)
            }
        };
        found.map_or_else(|other| other, Measured::Value)
    }

    fn trajectory(&self, steps: u64, end_s: f64, stride: u64) -> Option<Trajectory> {
        let (scene, precision) = (self.scene, self.precision);
        self.candidate.run(&Ask { scene, precision, end_s, steps, stride })
    }

    fn end(&self, steps: u64, end_s: f64) -> Result<End, Measured> {
        let key = (steps, end_s.to_bits());
        let known = self.ends.borrow().get(&key).cloned();
        let end = known.unwrap_or_else(|| {
            let made = self.trajectory(steps, end_s, steps).map(|trajectory| End {
                outcome: trajectory.outcome,
                failed_step: trajectory.failed_step,
                errors: trajectory.end().map(|seen| seen.distances(&self.exact(end_s))).unwrap_or_default(),
                evaluations: trajectory.evaluations,
            });
            self.ends.borrow_mut().insert(key, made.clone());
            made
        });
        let end = end.ok_or(Measured::NotAsked)?;
        if end.outcome == Outcome::Finished { Ok(end) } else { Err(Measured::Failed(end.outcome, end.failed_step)) }
    }

    fn exact(&self, end_s: f64) -> Observation {
        self.exact.borrow_mut().entry(end_s.to_bits()).or_insert_with(|| self.scene.exact(fx128::lit(end_s))).clone()
    }

    /// The error of a quantity after `steps` steps.
    ///
    /// # Errors
    /// What was found in its place.
    pub fn error(&self, quantity: Quantity, steps: u64, end_s: f64) -> Result<f64, Measured> {
        let end = self.end(steps, end_s)?;
        let error = end.errors.iter().find(|(q, _)| *q == quantity).map(|(_, error)| *error);
        error.ok_or_else(|| Measured::Undefined(format!("the scene has no {}", quantity.id())))
    }

    fn order(&self, quantity: Quantity, steps: u64, end_s: f64) -> Result<f64, Measured> {
        let [coarse, middle, fine] = [4, 2, 1].map(|part| self.error(quantity, steps / part, end_s));
        let (coarse, middle, fine) = (coarse?, middle?, fine?);
        if !(coarse > 0.0 && middle > 0.0 && fine > 0.0) {
            return Err(Measured::Undefined("an error of zero has no order".to_owned()));
        }
        Ok(2.0 * (middle / fine).log2() - (coarse / middle).log2())
    }

    fn constant(&self, quantity: Quantity, row: &Row) -> Result<f64, Measured> {
        let method = Stepper::from_id(&row.method, self.scene).ok().and_then(Stepper::of_theory);
        let theory = method.map(|method| self.scene.scene().expected_error(method, quantity, row.end_s).order);
        let Some(ExpectedOrder::Of(p)) = theory else {
            return Err(Measured::Undefined("theory names no order for a constant".to_owned()));
        };
        let constant = |steps: u64| Ok(self.error(quantity, steps, row.end_s)? / (row.end_s / steps as f64).powf(p));
        Ok(2.0 * constant(row.steps)? - constant(row.steps / 2)?)
    }

    fn limit(&self) -> Measured {
        let scale = self.scene.scene().info().time_scale_s;
        match self.candidate.limit(self.scene, self.precision) {
            None => Measured::NotAsked,
            Some(Found::NoStep { .. }) => Measured::Value(0.0),
            Some(Found::Bracket { low_s, high_s }) => Measured::Value((low_s * high_s).sqrt() / scale),
            Some(Found::Unlimited { .. }) => Measured::Value(UNLIMITED),
        }
    }

    fn along(&self, drift: Drift, kind: Kind, steps: u64, end_s: f64) -> Result<f64, Measured> {
        let long = self.long(steps, end_s)?;
        let scale = scale(&long.first, drift);
        let mut errors = Vec::with_capacity(long.errors.len());
        for (t_s, all) in &long.errors {
            let error = all.iter().find(|(d, _)| *d == drift).map(|(_, error)| error / scale);
            errors.push((*t_s, error.ok_or_else(|| Measured::Undefined(format!("no {}", drift.id())))?));
        }
        let envelope = growth::running_maximum(errors.iter().copied());
        match kind {
            Kind::GrowthLaw => self.exponent(&envelope),
            Kind::GrowthRate => rate(&errors),
            _ => Ok(envelope.last().map_or(f64::NAN, |sample| sample.error)),
        }
    }

    fn exponent(&self, envelope: &[Envelope]) -> Result<f64, Measured> {
        // Rounding of the invariant itself, as the drift study takes it.
        let seen = growth::classify(envelope, 256.0 * self.precision.epsilon());
        seen.exponent.ok_or(Measured::Undefined(format!("{}: {}", seen.law, seen.evidence)))
    }

    fn long(&self, steps: u64, end_s: f64) -> Result<Long, Measured> {
        let key = (steps, end_s.to_bits());
        let known = self.long.borrow().get(&key).cloned();
        let long = known.unwrap_or_else(|| {
            let made = self.look(steps, end_s);
            self.long.borrow_mut().insert(key, made.clone());
            made
        });
        let long = long.ok_or(Measured::NotAsked)?;
        if long.outcome == Outcome::Finished { Ok(long) } else { Err(Measured::Failed(long.outcome, long.failed_step)) }
    }

    fn look(&self, steps: u64, end_s: f64) -> Option<Long> {
        let scene = self.scene.scene();
        let trajectory = self.trajectory(steps, end_s, (steps / SAMPLES).max(1))?;
        let time = |step: u64| fx128::lit(end_s) * fx128::lit(step as f64) / fx128::lit(steps as f64);
        let first = scene.invariants(fx128::ZERO, &self.scene.exact(fx128::ZERO));
        let conserved = first.iter().all(|entry| entry.conserved);
        let errors = |(step, seen): &(u64, Observation)| {
            let t = time(*step);
            let invariants = scene.invariants(t, seen);
            let mut errors = if conserved {
                drifts(&invariants, &first)
            } else {
                drifts(&invariants, &scene.invariants(t, &self.scene.exact(t)))
            };
            if seen.rotation().is_some() {
                errors.push((Drift::QuaternionNorm, seen.norm_error));
            }
            (t.to_f64(), errors)
        };
        let errors = trajectory.seen.iter().skip(1).map(errors).collect();
        Some(Long { outcome: trajectory.outcome, failed_step: trajectory.failed_step, first, errors })
    }
}

/// The rate of E / E0 = exp(r t), fitted to the largest value of each stretch, which does not swing within a period.
fn rate(errors: &[(f64, f64)]) -> Result<f64, Measured> {
    let stretch = errors.len().div_ceil(STRETCHES).max(1);
    let largest =
        |part: &[(f64, f64)]| (part[part.len() - 1].0, part.iter().map(|e| e.1).fold(f64::NEG_INFINITY, f64::max));
    let samples: Vec<(f64, f64)> = errors.chunks(stretch).map(largest).collect();
    let line = growth::fit_exponential_rate(&samples);
    line.map(|line| line.slope).ok_or_else(|| Measured::Undefined("E / E0 is not positive and finite".to_owned()))
}
