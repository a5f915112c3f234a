//! One measured number of a loop, with what theory says of it.

use serde::{Deserialize, Serialize};

use crate::claim::Evidence;
use scenes::run::Outcome;

/// What was done to get a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Experiment {
    /// A sweep of the frame on a scene: the error at the end.
    Error,
    /// A case of which theory knows the number.
    Law,
    /// Steps drawn at random on an oscillator: the rate at which an error grows.
    Jitter,
    /// A number that somebody printed.
    Published,
}

/// One measured number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What was done.
    pub experiment: Experiment,
    /// The law, the choice that a sweep was made for, or the name of a printed number.
    pub choice: String,
    /// The settings of the loop, as `--loop` takes them.
    pub settings: String,
    /// Scene, or the case in words.
    pub subject: String,
    /// Method.
    pub method: String,
    /// Mean length of a frame, s.
    pub h_s: f64,
    /// Frames.
    pub frames: u64,
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
    /// Of an error, the order that theory predicts.
    pub theory_order: Option<f64>,
    /// How the run ended.
    pub outcome: Outcome,
}

impl Row {
    /// What its number says of its law.
    pub fn evidence(&self) -> Evidence {
        let value = self.value.filter(|_| self.outcome == Outcome::Finished);
        self.tolerance.map_or(Evidence::Outside, |tolerance| Evidence::near(value, self.theory, tolerance))
    }
}
