//! The bounds of a scene and a method that have none yet: from theory where it says something, else from a measurement.

mod errors;
mod invariants;

use std::collections::HashSet;

use faer::fx128;
use integrator::methods::MethodId;
use integrator::rigid_body::Formulation;

use crate::candidate::Candidate;
use crate::known::Known;
use crate::mutants::Mutant;
use crate::numbers::{Measured, Runs, UNLIMITED};
use crate::row::{Key, Kind, Row, Subject};
use crate::stepper::Stepper;
use measure::stability::limits::number;
use measure::sweep::{Progress, in_parallel};
use scenes::any::AnyScene;
use scenes::observation::Quantity;
use scenes::run::Precision;
use scenes::theory::{ExpectedOrder, StabilityLimit, Theory};

/// A bound on a measured error is the measured number divided and multiplied by this: the same bits come out on every machine,
/// and what a harmless change of the arithmetic moves is far less.
pub const TRUNCATION: f64 = 1.05;
/// The same where the number is rounding, which any change of the arithmetic throws anew.
pub const ROUNDING: f64 = 3.0;
/// An error is told from its rounding where it is this many times as large.
const CLEAR: f64 = 1000.0;
/// Halvings of the coarsest step at which an error is bounded.
const HALVINGS: u32 = 5;
/// Halvings at which a f32 run is bounded: its rounding shows there.
const SINGLE_HALVINGS: u32 = 8;

/// The rows that would be written for the catalogue and are not among these: another kind, precision, number of steps or end
/// is another row.
pub fn missing(known: &Known, rows: &[Row], progress: &Progress) -> Vec<Row> {
    let have: HashSet<Key> = rows.iter().map(Row::key).collect();
    let steppers = |scene| Stepper::all(scene).into_iter().map(move |stepper| (scene, stepper));
    let all: Vec<(&dyn AnyScene, Stepper)> = known.in_order().into_iter().flat_map(steppers).collect();
    let cost = |(scene, stepper): &(&dyn AnyScene, Stepper)| {
        scene.scene().info().coarsest_steps * if stepper.is_implicit() { 50 } else { 1 }
    };
    let of = |&(scene, stepper): &(&dyn AnyScene, Stepper)| {
        let mut rows = without_mutants(scene, stepper);
        rows.retain(|row| !have.contains(&row.key()));
        name_mutants(scene, stepper, &mut rows);
        rows
    };
    in_parallel(&all, cost, progress, of).concat()
}

/// Every bound of a method on a scene.
pub fn rows(scene: &dyn AnyScene, stepper: Stepper) -> Vec<Row> {
    let mut rows = without_mutants(scene, stepper);
    name_mutants(scene, stepper, &mut rows);
    rows
}

fn without_mutants(scene: &dyn AnyScene, stepper: Stepper) -> Vec<Row> {
    let maker = Maker {
        scene,
        stepper,
        double: Runs::new(&stepper, scene, Precision::F64),
        exact: Runs::new(&stepper, scene, Precision::DoubleDouble),
    };
    let mut rows = vec![];
    for (quantity, _) in &scene.exact(fx128::ZERO).values {
        rows.extend(maker.error(*quantity));
        rows.extend(maker.order(*quantity));
        rows.extend(maker.constant(*quantity));
        rows.extend(maker.single(*quantity));
    }
    rows.extend(maker.evaluations());
    rows.extend(maker.growth());
    rows.extend(maker.turning());
    rows.extend(maker.invariants(&rows));
    rows.extend(maker.limit());
    rows.extend(maker.summed_time());
    rows
}

struct Maker<'a> {
    scene: &'a dyn AnyScene,
    stepper: Stepper,
    double: Runs<'a>,
    exact: Runs<'a>,
}

/// Six digits are enough for a bound.
pub(crate) fn six(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

impl Maker<'_> {
    fn row(&self, precision: Precision, quantity: Subject, kind: Kind, steps: u64, end_s: f64) -> Row {
        let order = match self.theory(quantity).map(|theory| theory.order) {
            Some(ExpectedOrder::Of(p)) => p,
            _ => 0.0,
        };
        Row {
            scene: self.scene.id().to_owned(),
            method: self.stepper.id(),
            precision,
            quantity,
            kind,
            steps,
            end_s,
            unit: quantity.unit(kind, order),
            low: f64::NAN,
            high: f64::NAN,
            measured: f64::NAN,
            reason: String::new(),
            mutant: String::new(),
        }
    }

    fn theory(&self, quantity: Subject) -> Option<Theory> {
        let Subject::Error(quantity) = quantity else { return None };
        Some(self.scene.scene().expected_error(self.stepper.of_theory()?, quantity, self.horizon()))
    }

    fn horizon(&self) -> f64 {
        self.scene.scene().info().horizon_s
    }

    fn steps(&self, halvings: u32) -> u64 {
        self.scene.scene().info().coarsest_steps << halvings
    }

    /// The error in f64 and what of it is rounding.
    fn both(&self, quantity: Quantity, steps: u64) -> Option<(f64, f64)> {
        let error = |runs: &Runs<'_>| runs.error(quantity, steps, self.horizon()).ok();
        let (double, exact) = (error(&self.double)?, error(&self.exact)?);
        Some((double, (double - exact).abs()))
    }

    /// What theory says of the error, in words.
    fn why(&self, quantity: Quantity) -> String {
        match self.theory(Subject::Error(quantity)) {
            Some(Theory { order: ExpectedOrder::Of(p), reason, .. }) => format!("C h^{p}; {reason}"),
            Some(Theory { order: ExpectedOrder::Envelope(p), reason, .. }) => format!("at most C h^{p}; {reason}"),
            Some(Theory { order: ExpectedOrder::Exact, reason, .. }) => reason.to_owned(),
            None if self.lacks_gyroscopic_term() => "omega x I omega is left out of the model".to_owned(),
            None => format!("C h^{}; {}", self.stepper.order(), self.equation()),
        }
    }

    /// The equation of motion in what a rigid body stores: what a scheme has to be consistent with.
    fn equation(&self) -> String {
        let Stepper::Turning(scheme) = self.stepper else { return "the method's order on a smooth problem".to_owned() };
        let equation = match scheme.storage {
            Formulation::WorldOmega => "I_w omega' = tau - omega x I_w omega, q' = (0, omega) q / 2",
            Formulation::BodyOmega => "I omega' = tau - omega x I omega, q' = q (0, omega) / 2",
            Formulation::WorldMomentum => "L' = tau, omega = I_w^-1 L, q' = (0, omega) q / 2",
            Formulation::WithoutGyroscopicTerm => "omega' = I_w^-1 tau, as where omega x I omega vanishes",
        };
        let brackets =
            if self.stepper.method() == Some(MethodId::Rk4) { ", stages joined by the brackets of SO(3)" } else { "" };
        format!("{equation}{brackets}")
    }

    fn lacks_gyroscopic_term(&self) -> bool {
        matches!(self.stepper, Stepper::Turning(scheme) if scheme.lacks_gyroscopic_term())
    }

    fn evaluations(&self) -> Option<Row> {
        let row = self.row(
            Precision::F64,
            Subject::Evaluations,
            Kind::EvaluationsPerStep,
            self.steps(HALVINGS),
            self.horizon(),
        );
        let x = self.double.measure(&row).value()?;
        Some(if self.stepper.is_implicit() {
            around(row, x, 1.1, "evaluations of Newton's iterations, and of the differences that make their matrix")
        } else {
            between(row, x, x, x, &format!("theory: {x} evaluations make a step"))
        })
    }

    fn limit(&self) -> Option<Row> {
        let Stepper::Flat(method) = self.stepper else { return None };
        let info = self.scene.scene().info();
        let (limit, reason) = self.scene.scene().expected_limit(method)?;
        let row = self.row(Precision::F64, Subject::Step, Kind::StabilityLimit, 1, info.horizon_s);
        let x = self.double.measure(&row).value()?;
        let reason = format!("theory: {reason}");
        let theory = if limit == StabilityLimit::Unlimited { UNLIMITED } else { number(limit)? / info.time_scale_s };
        // The bracket of the bisection is 0.4 % wide.
        let tolerance = if matches!(limit, StabilityLimit::Below(_)) { 0.005 } else { 0.0 };
        Some(between(row, x, theory * (1.0 - tolerance), theory * (1.0 + tolerance), &reason))
    }
}

fn between(row: Row, measured: f64, low: f64, high: f64, reason: &str) -> Row {
    Row { low, high, measured, reason: reason.to_owned(), ..row }
}

/// Measured / factor to measured * factor.
fn around(row: Row, measured: f64, factor: f64, why: &str) -> Row {
    let reason = format!("measured x {factor}: {why}");
    between(row, measured, six(measured / factor), six(measured * factor), &reason)
}

/// Rounding: 0 to measured * factor. A number below `least`, one rounding of it, is luck: one rounding is granted.
fn from_zero(row: Row, measured: f64, least: f64, why: &str) -> Row {
    if measured < least {
        let reason = format!("theory: no error but the last rounding, at most {ROUNDING} eps; {why}");
        return between(row, measured, 0.0, six(least * ROUNDING), &reason);
    }
    between(row, measured, 0.0, six(measured * ROUNDING), &format!("measured x {ROUNDING}, from 0: rounding; {why}"))
}

/// Names with each row the first mutant that breaks it.
fn name_mutants(scene: &dyn AnyScene, stepper: Stepper, rows: &mut [Row]) {
    if rows.is_empty() {
        return;
    }
    let mut open: Vec<usize> = (0..rows.len()).collect();
    // Most rows that see one fault of the gyroscopic term see the other: the velocities are for the sign.
    let left_to_sign = |row: &Row, mutant| {
        mutant == Mutant::GyroscopicMissing && row.quantity == Subject::Error(Quantity::AngularVelocity)
    };
    for &mutant in Mutant::ALL {
        let candidate: Box<dyn Candidate> = mutant.of(stepper);
        for precision in Precision::ALL.into_iter().filter(|&p| mutant.applies(stepper, scene, p)) {
            let runs = Runs::new(candidate.as_ref(), scene, precision);
            open.retain(|&i| {
                let spared = rows[i].precision != precision
                    || left_to_sign(&rows[i], mutant)
                    || match runs.measure(&rows[i]) {
                        Measured::NotAsked => true,
                        Measured::Value(x) => rows[i].admits(x),
                        _ => false,
                    };
                if !spared {
                    mutant.id().clone_into(&mut rows[i].mutant);
                }
                spared
            });
        }
    }
}
