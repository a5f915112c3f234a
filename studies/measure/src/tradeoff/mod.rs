//! What does accuracy cost? Work-precision: error against evaluations, and against time.
//!
//! Times are the only numbers of a report that are not the same from run to run. They stand in the rows of this study alone,
//! and no claim rests on them.

pub mod advice;
mod advice_text;
mod asked;
mod budget;
pub mod candidate;
mod cells;
mod claims;
pub mod clock;
mod comparison_tables;
pub mod cost_at_error;
mod cost_tables;
pub mod exact;
mod figures;
pub mod front;
pub mod limit;
mod overview;
pub mod path;
mod peers;
pub mod quantity;
pub mod rounding_optimum;
pub mod runs;
pub mod search;
pub mod stagnation;
pub mod step_rate;
mod tables;
pub mod verdict;
pub mod which;
mod which_table;

use reports::{Claim, Figure};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::study::{Derived, Kind, Selection, Study, check_method, check_scene, check_steps};
use candidate::Candidate;
use scenes::run::{Outcome, Precision};

/// What a row belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// A run with its error, its evaluations and the time of its steps.
    Run,
    /// The same run timed with ever more steps, for the cost of a step.
    Length,
    /// The step below which a body at rest does not begin to fall.
    Stagnation,
}

/// One run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What the row belongs to.
    pub part: Part,
    /// Scene or preset.
    pub scene: String,
    /// Method, on a rigid body with what is stored.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// Number of steps.
    pub steps: u64,
    /// Step, s.
    pub h_s: f64,
    /// The natural time scale of the scene, s: 1/omega of an oscillation, 1/k of a damping.
    #[serde(default)]
    pub time_scale_s: Option<f64>,
    /// Unit of the errors.
    #[serde(default)]
    pub unit: String,
    /// How the run ended.
    pub outcome: Outcome,
    /// Error at the end.
    #[serde(default)]
    pub error_end: Option<f64>,
    /// Largest error at 32 evenly spaced times, the end among them.
    #[serde(default)]
    pub error: Option<f64>,
    /// Largest error of the attitude of a rigid body at the same times, rad.
    #[serde(default)]
    pub attitude_error: Option<f64>,
    /// Largest distance from the run of the same step in the next finer arithmetic, at the same times.
    #[serde(default)]
    pub rounding: Option<f64>,
    /// The largest size of the configuration in the exact motion, in the same unit; 1 for an attitude.
    #[serde(default)]
    pub scale: Option<f64>,
    /// Evaluations of the force law.
    pub evaluations: u64,
    /// Number of steps of the run that was timed.
    #[serde(default)]
    pub timed_steps: Option<u64>,
    /// Time of a step, least over the rounds.
    #[serde(default)]
    pub least_ns_per_step: Option<f64>,
    /// The same, median.
    #[serde(default)]
    pub median_ns_per_step: Option<f64>,
    /// The same, upper quartile.
    #[serde(default)]
    pub upper_ns_per_step: Option<f64>,
    /// The same in cycles of the clock chain of the same round, least.
    #[serde(default)]
    pub cycles_per_step: Option<f64>,
    /// Height at which a body is let go.
    #[serde(default)]
    pub position_m: Option<f64>,
    /// The largest step tried after which it has not moved.
    #[serde(default)]
    pub at_rest_h_s: Option<f64>,
    /// The smallest step tried after which it has.
    #[serde(default)]
    pub moving_h_s: Option<f64>,
    /// The step between the two by theory.
    #[serde(default)]
    pub theory_h_s: Option<f64>,
}

/// The study.
pub struct Tradeoff;

impl Study for Tradeoff {
    type Row = Row;
    const ID: &'static str = "tradeoff";
    const HEEDS: &'static [&'static str] = &["precision", "steps", "for"];
    const TAKES_SCHEMES: bool = true;
    const ABOUT: &'static str = "Compares methods by cost at equal error, in evaluations and in time. Given --error or --budget-us it prints advice for a \
        scene, which it has run, and writes no files. Errors are the largest over the run, at every step in advice and at 32 times in the \
        study: of positions in m, of attitudes and angles in rad, the larger where a scene has both, or of the quantity after --of";
    const EXAMPLES: &'static str =
        "tradeoff                                                       the whole study, into target/tradeoff/
        tradeoff --scene pendulum --error 1e-3                         the cheapest method, precision and step
        tradeoff --scene pendulum --budget-us 5                        the smallest error for 5 us of computing per simulated second
        tradeoff --scene tennis-racket --error 1e-3 --for 60 --rate 60 every method in a loop of 60 frames per second, for a minute
        tradeoff --scene kepler --error 1e-3 --of energy               an error in the energy instead of the position
        tradeoff --ensemble 1000 --scene torque-free-spin              errors over many starts instead of one";
    const TITLE: &'static str = "What does accuracy cost? Work-precision";
    const INTRO: &'static str = "The cost of every method at its error, in three precisions and, on rigid bodies, for what is stored. \
        Cost is counted in evaluations of the force law, which are the same on every machine, and measured in time on this machine, \
        in runs apart from those that gave the errors. The error is the largest at 32 times up to the horizon, of positions in m and \
        of angles in rad.";

    const KINDS: &'static [Kind] = &[
        Kind {
            part: "run",
            columns: "scene,method,precision,steps,h_s,time_scale_s,unit,outcome,error_end,error,attitude_error,rounding,\
                      scale,evaluations,timed_steps,least_ns_per_step,median_ns_per_step,upper_ns_per_step,cycles_per_step",
        },
        Kind {
            part: "length",
            columns: "scene,method,precision,steps,h_s,outcome,evaluations,\
                      timed_steps,least_ns_per_step,median_ns_per_step,upper_ns_per_step,cycles_per_step",
        },
        Kind {
            part: "stagnation",
            columns: "scene,method,precision,steps,h_s,unit,outcome,evaluations,\
                      position_m,at_rest_h_s,moving_h_s,theory_h_s",
        },
    ];

    fn part(row: &Row) -> &'static str {
        match row.part {
            Part::Run => "run",
            Part::Length => "length",
            Part::Stagnation => "stagnation",
        }
    }

    fn measure(selection: &Selection) -> Vec<Row> {
        let mut rows = runs::errors(selection);
        rows.extend(selection.rows(&[()], 0.01, |()| 1, |()| stagnation::rows(selection)));
        runs::time(selection, &mut rows);
        rows
    }
    fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
        tables::all(rows)
    }
    fn figures(rows: &[Row]) -> Vec<Figure> {
        figures::all(rows)
    }
    fn claims(rows: &[Row]) -> Vec<Claim> {
        claims::all(rows)
    }
    fn check(row: &Row) -> Result<(), String> {
        check_scene(&row.scene)?;
        check_method(&row.method, Candidate::from_id(&row.method).is_some())?;
        check_steps(row.steps, row.h_s)
    }
}

impl Row {
    /// A row of which nothing is known yet.
    fn new(part: Part, scene: &str, method: String, precision: Precision, steps: u64, h_s: f64) -> Self {
        Row {
            part,
            scene: scene.to_owned(),
            method,
            precision,
            steps,
            h_s,
            time_scale_s: None,
            unit: String::new(),
            outcome: Outcome::Finished,
            error_end: None,
            error: None,
            attitude_error: None,
            rounding: None,
            scale: None,
            evaluations: 0,
            timed_steps: None,
            least_ns_per_step: None,
            median_ns_per_step: None,
            upper_ns_per_step: None,
            cycles_per_step: None,
            position_m: None,
            at_rest_h_s: None,
            moving_h_s: None,
            theory_h_s: None,
        }
    }

    /// The error of a run that counts: it finished, and its error is a number.
    pub fn scored(&self) -> Option<f64> {
        let scores = self.part == Part::Run && self.outcome == Outcome::Finished;
        self.error.filter(|error| scores && error.is_finite() && *error >= 0.0)
    }
}

/// What a run costs in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CostMeasure {
    /// Evaluations of the force law up to the horizon.
    Evaluations,
    /// Time for a simulated second, ns: the least over the rounds.
    Time,
}

impl CostMeasure {
    /// Both.
    pub const ALL: [CostMeasure; 2] = [CostMeasure::Evaluations, CostMeasure::Time];

    /// What a run costs. Evaluations do not know what arithmetic costs: only f64 costs in them.
    pub fn of(self, row: &Row) -> Option<f64> {
        match self {
            CostMeasure::Evaluations => (row.precision == Precision::F64).then_some(row.evaluations as f64),
            CostMeasure::Time => row.least_ns_per_step.map(|ns| ns / row.h_s),
        }
    }
}
