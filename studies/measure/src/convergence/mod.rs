//! How wrong is it? The error against the step, and the order observed.

mod envelope;
mod figures;
mod limit;
mod order_row;
mod orders;
mod rounding;

pub use limit::{Approach, Limit, RESOLVED, judge, limit};
pub use order_row::{Measure, OrderRow};
pub use orders::{orders, tolerance};

use integrator::methods::MethodId;
use reports::{Claim, Figure};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::study::{Derived, Selection, Study, check_method, check_scene, check_steps};
use crate::sweep::in_parallel;
use scenes::any::AnyScene;
use scenes::errors;
use scenes::errors::{Errors, ExactSamples};
use scenes::observation::Quantity;
use scenes::run::{Outcome, Precision, Trajectory, method_from_id};
use scenes::theory::ExpectedOrder;
use scenes::variation::Leading;

/// Halvings of the step from the coarsest to the finest run.
pub const HALVINGS: u32 = 12;
/// The same with `--quick`.
pub const QUICK_HALVINGS: u32 = 9;

/// The error of one quantity in one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Scene or preset.
    pub scene: String,
    /// Method.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// Number of steps.
    pub steps: u64,
    /// Step, s.
    pub h_s: f64,
    /// Natural time scale of the scene, s.
    pub time_scale_s: f64,
    /// What was compared.
    pub quantity: Quantity,
    /// Unit of the errors.
    pub unit: String,
    /// How the run ended.
    pub outcome: Outcome,
    /// The first step that failed.
    pub failed_step: Option<u64>,
    /// Error at the end.
    pub error_end: Option<f64>,
    /// Largest error at 32 evenly spaced times.
    pub error_max: Option<f64>,
    /// Rounding error at the end: distance from the double-double run of the same step.
    pub rounding_end: Option<f64>,
    /// Largest rounding error at the same times.
    pub rounding_max: Option<f64>,
    /// Largest size of the quantity along the exact motion, in the same unit.
    pub scale: f64,
    /// Evaluations of the force law.
    pub evaluations: u64,
    /// The order that theory predicts; empty where it predicts no error but rounding.
    pub theory_order: Option<f64>,
    /// Whether the error is only bounded by theory_constant h^theory_order, and jumps below it from step to step.
    pub theory_is_envelope: bool,
    /// lim error_end / h^order (or its bound) that theory predicts, where it does.
    pub theory_constant: Option<f64>,
    /// How far it may be off by the rounding of its formula.
    pub theory_doubt: f64,
    /// The step below which the bound of an envelope, or an exact result, holds, s; empty for no limit.
    #[serde(default)]
    pub theory_below_h_s: Option<f64>,
    /// The same limit by the equation of first variation, in double-double, for the methods whose local error it knows.
    pub leading_end: Option<f64>,
    /// That of error_max.
    pub leading_max: Option<f64>,
    /// How far both may be off.
    pub leading_doubt: Option<f64>,
}

/// The study.
pub struct Convergence;

impl Study for Convergence {
    type Row = Row;
    const ID: &'static str = "convergence";
    const HEEDS: &'static [&'static str] = &["precision", "steps", "for"];
    const ABOUT: &'static str = "Sweeps the step on scenes with exact solutions and measures the order of convergence";
    const EXAMPLES: &'static str = "convergence --scene oscillator --method rk4
        convergence --scene torque-free-spin --precision f64 --out /tmp/spin
        convergence --scene oscillator --set stiffness=24 --steps 64,128,256,512
        convergence --from target/convergence --format both";
    const TITLE: &'static str = "How wrong is it? Convergence";
    const INTRO: &'static str = "Each method runs each scene with a step that is halved again and again, in three precisions, \
        and is compared with the exact motion. The slope of error against step is the observed order; where the slope ends \
        in f32 and f64, rounding has taken over.";

    fn measure(selection: &Selection) -> Vec<Row> {
        measure(selection)
    }
    fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
        Ok(vec![orders::table(rows)?])
    }
    fn figures(rows: &[Row]) -> Vec<Figure> {
        figures::figures(rows)
    }
    fn claims(rows: &[Row]) -> Vec<Claim> {
        let mut claims = orders::claims(rows);
        claims.extend(rounding::claims(rows));
        claims
    }
    fn check(row: &Row) -> Result<(), String> {
        check_scene(&row.scene)?;
        check_method(&row.method, method_from_id(&row.method).is_ok())?;
        check_steps(row.steps, row.h_s)
    }
}

struct Job<'a> {
    scene: &'a dyn AnyScene,
    known: &'a Known,
    method: MethodId,
    steps: u64,
}

/// Runs every scene, method and step in every precision.
fn measure(selection: &Selection) -> Vec<Row> {
    let halvings = if selection.quick { QUICK_HALVINGS } else { HALVINGS };
    let scenes: Vec<&dyn AnyScene> = selection.scenes.iter().map(AsRef::as_ref).collect();
    let known = in_parallel(
        &scenes,
        |_| 1,
        &crate::sweep::Progress::silent(),
        |&scene| Known::of(scene, selection.end_s(scene)),
    );
    let mut jobs = Vec::new();
    for (&scene, known) in scenes.iter().zip(&known) {
        for &method in &selection.methods {
            for steps in selection.sweep(scene, 0..=halvings) {
                jobs.push(Job { scene, known, method, steps });
            }
        }
    }
    let cost = |job: &Job<'_>| job.steps * if job.method.is_implicit() { 20 } else { u64::from(job.method.order()) };
    selection.rows(&jobs, 2.4e-7, cost, |job| job.rows(&selection.precisions))
}

/// What is known of a scene before it is run.
struct Known {
    end_s: f64,
    truth: ExactSamples,
    leading: Vec<Leading>,
}

impl Known {
    fn of(scene: &dyn AnyScene, end_s: f64) -> Self {
        // Where the motion is not smooth the error has another leading term.
        let smooth = scene.scene().nonsmooth_times_s(end_s).is_empty();
        let leading = if smooth { scene.leading(end_s) } else { Vec::new() };
        Known { end_s, truth: ExactSamples::of(scene, end_s), leading }
    }
}

impl Job<'_> {
    fn rows(&self, precisions: &[Precision]) -> Vec<Row> {
        let run = |precision| errors::run(self.scene, self.method, precision, self.known.end_s, self.steps);
        let Some(reference) = run(Precision::DoubleDouble) else { return Vec::new() };
        let row = |&precision: &Precision| match precision {
            Precision::DoubleDouble => self.compare(precision, &reference, &reference),
            _ => run(precision).map_or_else(Vec::new, |run| self.compare(precision, &run, &reference)),
        };
        precisions.iter().flat_map(row).collect()
    }

    fn compare(&self, precision: Precision, run: &Trajectory, reference: &Trajectory) -> Vec<Row> {
        let compared = self.known.truth.compare(self.scene, self.steps, run, reference);
        let rate = compared.iter().find(|errors| errors.quantity == Quantity::AngularVelocity);
        let turned = rate.map_or(1.0, |errors| (errors.scale * self.known.end_s).max(1.0));
        let amplified = self.scene.scene().amplification(self.known.end_s);
        let row = |errors: Errors| {
            let theory = self.scene.scene().expected_error(self.method, errors.quantity, self.known.end_s);
            let mut known = self.known.leading.iter();
            let leading = known.find(|one| (one.method, one.quantity) == (self.method, errors.quantity));
            Row {
                scene: self.scene.id().to_owned(),
                method: self.method.id().to_owned(),
                precision,
                steps: self.steps,
                h_s: self.known.end_s / self.steps as f64,
                time_scale_s: self.scene.scene().info().time_scale_s,
                quantity: errors.quantity,
                unit: errors.quantity.unit().to_owned(),
                outcome: run.outcome,
                failed_step: run.failed_step,
                error_end: errors.end,
                error_max: errors.max,
                rounding_end: errors.rounding_end,
                rounding_max: errors.rounding_max,
                // What has no error but rounding is rounded as the angle is that the body has turned.
                scale: if theory.order == ExpectedOrder::Exact || amplified > 1.0 {
                    turned * amplified * errors.scale
                } else {
                    errors.scale
                },
                evaluations: run.evaluations,
                theory_order: match theory.order {
                    ExpectedOrder::Exact => None,
                    ExpectedOrder::Of(order) | ExpectedOrder::Envelope(order) => Some(order),
                },
                theory_is_envelope: matches!(theory.order, ExpectedOrder::Envelope(_)),
                theory_constant: theory.constant,
                theory_doubt: theory.doubt,
                theory_below_h_s: Some(theory.below_h_s).filter(|h| h.is_finite()),
                leading_end: leading.map(|one| one.end),
                leading_max: leading.map(|one| one.max),
                leading_doubt: leading.map(|one| one.doubt),
            }
        };
        compared.into_iter().map(row).collect()
    }
}
