//! One measured number, with what theory says of it.

use reports::{Claim, Verdict};
use serde::{Deserialize, Serialize};

use super::scheme::Scheme;
use scenes::run::{Outcome, Trajectory};

/// What was done to get a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Experiment {
    /// A sweep of the step on a scene: the error at the end.
    Error,
    /// One step of a free body in double-double: what it does to T and |L|^2.
    StepLaw,
    /// One step of a symmetric top that hardly nutates, in double-double: the factor of the nutation.
    Nutation,
    /// A disc at 60 rad/s, 60 steps a second.
    Disc,
    /// A long run of a free body with three unequal moments.
    LongRun,
    /// The energy and momentum of a free body over time.
    Drift,
    /// Two schemes, the distance of their motions.
    SameMotion,
    /// A number printed by another project.
    Published,
}

/// One measured number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What was done.
    pub experiment: Experiment,
    /// Scene, or body.
    pub subject: String,
    /// Scheme.
    pub scheme: String,
    /// Step, s.
    pub h_s: f64,
    /// Time at which the number was read, s.
    pub t_s: f64,
    /// What the number is.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// The number; empty where the run failed.
    pub value: Option<f64>,
    /// What theory, or the publication, says.
    pub theory: Option<f64>,
    /// The largest accepted |value - theory|.
    pub tolerance: Option<f64>,
    /// How the run ended.
    pub outcome: Outcome,
    /// The step at which it failed, or at which the event was seen.
    pub at_step: Option<u64>,
    /// Evaluations of the torque up to the end.
    pub evaluations: u64,
}

impl Row {
    /// A number of a run, as yet without theory.
    pub fn new(experiment: Experiment, subject: &str, scheme: Scheme, h_s: f64, run: &Trajectory) -> Self {
        Row {
            experiment,
            subject: subject.to_owned(),
            scheme: scheme.id(),
            h_s,
            t_s: h_s * run.seen.last().map_or(0.0, |(step, _)| *step as f64),
            quantity: String::new(),
            unit: String::new(),
            value: None,
            theory: None,
            tolerance: None,
            outcome: run.outcome,
            at_step: run.failed_step,
            evaluations: run.evaluations,
        }
    }

    /// The same row of another quantity.
    pub fn measured(&self, quantity: &str, unit: &str, value: Option<f64>) -> Self {
        Row { quantity: quantity.to_owned(), unit: unit.to_owned(), value, ..self.clone() }
    }

    /// The same row, with what theory says of it.
    pub fn against(self, theory: f64, tolerance: f64) -> Self {
        Row { theory: Some(theory), tolerance: Some(tolerance), ..self }
    }

    /// Whether the number agrees with theory, where theory says anything.
    pub fn agrees(&self) -> Option<bool> {
        let (theory, tolerance) = (self.theory?, self.tolerance?);
        Some(self.value.is_some_and(|value| (value - theory).abs() <= tolerance))
    }

    /// As a claim.
    pub fn claim(&self, id: String, statement: String) -> Option<Claim> {
        let (theory, tolerance) = (self.theory?, self.tolerance?);
        Some(Claim {
            id,
            study: "rotation".to_owned(),
            statement,
            theory: format!("{theory:.12e} {}", self.unit),
            measured: self.value.map_or_else(|| "the run failed".to_owned(), |v| format!("{v:.12e} {}", self.unit)),
            bound: format!("within {tolerance:.1e} of theory"),
            verdict: Verdict::from_comparison(self.agrees() == Some(true)),
        })
    }
}
