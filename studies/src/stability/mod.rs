//! Where do methods fail? Largest stable steps, measured and held against theory; what happens beyond them.

pub mod amplification;
pub mod bisect;
pub mod displaced;
pub mod failure;
pub mod judge;
pub mod limits;

use serde::{Deserialize, Serialize};

use crate::run::Precision;
use failure::Failure;

/// What a row belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// The largest stable step of a method on a linear scene.
    Limit,
    /// Growth in one step of a method without a stable step.
    GrowthRate,
}

/// One measurement. What is measured, and its unit, stand in `quantity` and `unit`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What the row belongs to.
    pub part: Part,
    /// Scene, or what is looked at in its place.
    pub scene: String,
    /// Method, or scheme.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// Step, s.
    pub h_s: Option<f64>,
    /// Step over the natural time scale of the scene: h omega, k h.
    pub h_omega: Option<f64>,
    /// What else was varied, with its unit; empty for nothing.
    pub parameter: String,
    /// Its value.
    pub value: Option<f64>,
    /// What was measured.
    pub quantity: String,
    /// Unit of the measured numbers.
    pub unit: String,
    /// Low end of a bracket: the largest step that held.
    pub low: Option<f64>,
    /// High end of a bracket: the smallest step that failed.
    pub high: Option<f64>,
    /// What was measured, where it is one number.
    pub measured: Option<f64>,
    /// What theory says (0: no step is stable; inf: every step is).
    pub theory: Option<f64>,
    /// The same by a closed form, where there is one.
    pub closed_form: Option<f64>,
    /// What goes wrong: beyond the limit, or at this point.
    pub failure: Failure,
    /// Steps taken.
    pub steps: u64,
    /// Where the theory comes from.
    pub note: String,
}

impl Row {
    fn new(part: Part, scene: &str, method: &str, precision: Precision, quantity: &str, unit: &str) -> Self {
        Row {
            part,
            scene: scene.to_owned(),
            method: method.to_owned(),
            precision,
            h_s: None,
            h_omega: None,
            parameter: String::new(),
            value: None,
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            low: None,
            high: None,
            measured: None,
            theory: None,
            closed_form: None,
            failure: Failure::None,
            steps: 0,
            note: String::new(),
        }
    }
}
