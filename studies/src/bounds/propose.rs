//! The bounds of a scene and a method that have none yet: from theory where it says something, else from a measurement.

use faer::fx128;
use integrator::Real;
use integrator::methods::{Conserved, MethodId};
use integrator::rigid_body::{AttitudeUpdate, Storage};

use super::candidate::Candidate;
use super::measure::{Measured, Runs, UNLIMITED};
use super::mutants::Mutant;
use super::row::{Kind, Row, Subject};
use super::stepper::Stepper;
use crate::drift::{Drift, drifts, scale};
use crate::growth::Law;
use crate::observation::Quantity;
use crate::rotation::claims::conserved;
use crate::rotation::laws::energy_changes_with_one_sign;
use crate::run::Precision;
use crate::scene::{AnyScene, Balance, ExpectedGrowth, ExpectedOrder, StabilityLimit, Theory};
use crate::stability::limits::number;

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
/// Length of a run along which a balance is followed, in time scales, and its steps in one.
const TIME_SCALES: u64 = 128;
const STEPS_A_TIME_SCALE: u64 = 32;

/// Every bound of a method on a scene.
pub fn rows(scene: &dyn AnyScene, stepper: Stepper) -> Vec<Row> {
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
    rows.extend(maker.balances(&rows));
    rows.extend(maker.limit());
    rows.extend(maker.summed_time());
    name_mutants(scene, stepper, &mut rows);
    rows
}

struct Maker<'a> {
    scene: &'a dyn AnyScene,
    stepper: Stepper,
    double: Runs<'a>,
    exact: Runs<'a>,
}

/// Six digits are enough for a bound.
fn six(x: f64) -> f64 {
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
        Some(self.scene.scene().theory(self.stepper.of_theory()?, quantity))
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
            Storage::WorldOmega => "I_w omega' = tau - omega x I_w omega, q' = (0, omega) q / 2",
            Storage::BodyOmega => "I omega' = tau - omega x I omega, q' = q (0, omega) / 2",
            Storage::WorldMomentum => "L' = tau, omega = I_w^-1 L, q' = (0, omega) q / 2",
            Storage::WithoutGyroscopicTerm => "omega' = I_w^-1 tau, as where omega x I omega vanishes",
        };
        let brackets =
            if self.stepper.method() == Some(MethodId::Rk4) { ", stages joined by the brackets of SO(3)" } else { "" };
        format!("{equation}{brackets}")
    }

    fn lacks_gyroscopic_term(&self) -> bool {
        matches!(self.stepper, Stepper::Turning(scheme) if scheme.lacks_gyroscopic_term())
    }

    fn error(&self, quantity: Quantity) -> Option<Row> {
        let subject = Subject::Error(quantity);
        let row = |halvings| self.row(Precision::F64, subject, Kind::ErrorAtStep, self.steps(halvings), self.horizon());
        for halvings in (1..=HALVINGS).rev() {
            let (error, rounding) = self.both(quantity, self.steps(halvings))?;
            if error > CLEAR * rounding {
                return Some(around(row(halvings), error, TRUNCATION, &self.why(quantity)));
            }
        }
        let (error, _) = self.both(quantity, self.steps(HALVINGS))?;
        let scale = self.scene.exact(fx128::lit(self.horizon())).scale(quantity).max(1.0);
        Some(from_zero(row(HALVINGS), error, Precision::F64.epsilon() * scale, &self.why(quantity)))
    }

    /// What theory says of the order; of a scheme of which a scene knows nothing, its own, or none without the gyroscopic term.
    fn expected(&self, quantity: Quantity) -> Vec<(f64, String)> {
        let own = f64::from(self.stepper.order());
        match self.theory(Subject::Error(quantity)) {
            Some(Theory { order: ExpectedOrder::Of(p), reason, .. }) => {
                let equation = if matches!(self.stepper, Stepper::Turning(_)) {
                    format!("; {}", self.equation())
                } else {
                    String::new()
                };
                vec![(p, format!("order {p}: {reason}{equation}"))]
            }
            Some(_) => vec![],
            None if self.lacks_gyroscopic_term() => vec![
                (0.0, "order 0: without omega x I omega the model is inconsistent and no step mends it".to_owned()),
                (own, format!("order {own}: omega x I omega vanishes along this motion")),
            ],
            None => vec![(own, format!("order {own}: {}", self.equation()))],
        }
    }

    fn order(&self, quantity: Quantity) -> Option<Row> {
        let in_double = (3..=7).rev().map(|k| (Precision::F64, k));
        let exactly = if self.stepper.is_implicit() { 5..=7 } else { 5..=10 };
        for (p, reason) in self.expected(quantity) {
            for (precision, halvings) in in_double.clone().chain(exactly.clone().map(|k| (Precision::DoubleDouble, k)))
            {
                let steps = self.steps(halvings);
                let noisy = precision == Precision::F64
                    && self.both(quantity, steps).is_none_or(|(error, rounding)| error < CLEAR * rounding);
                let row = self.row(precision, Subject::Error(quantity), Kind::Order, steps, self.horizon());
                let runs = if precision == Precision::F64 { &self.double } else { &self.exact };
                let Some(x) = runs.measure(&row).value().filter(|_| !noisy) else { continue };
                // Half of the tolerance is left for what a change of the arithmetic may do.
                let tolerance = [0.02, 0.05].into_iter().find(|t| (x - p).abs() <= 0.5 * t);
                if let Some(t) = tolerance {
                    return Some(between(row, x, p - t, p + t, &format!("theory: {reason}")));
                }
            }
        }
        None
    }

    fn constant(&self, quantity: Quantity) -> Option<Row> {
        let Theory { order: ExpectedOrder::Of(p), constant, reason } = self.theory(Subject::Error(quantity))? else {
            return None;
        };
        let c = constant.filter(|c| *c > 0.0)?;
        let in_double = (4..=7).rev().map(|k| (Precision::F64, k));
        for (precision, halvings) in in_double.chain((6..=8).map(|k| (Precision::DoubleDouble, k))) {
            let steps = self.steps(halvings);
            let row = self.row(precision, Subject::Error(quantity), Kind::ErrorConstant, steps, self.horizon());
            let runs = if precision == Precision::F64 { &self.double } else { &self.exact };
            let Some(x) = runs.measure(&row).value() else { continue };
            let tolerance = [0.002, 0.01].into_iter().find(|t| (x / c - 1.0).abs() <= 0.5 * t);
            if let Some(t) = tolerance {
                let reason = format!("theory: lim error / h^{p} = {c:.6e}, +-{} %: {reason}", 100.0 * t);
                return Some(between(row, x, c * (1.0 - t), c * (1.0 + t), &reason));
            }
        }
        None
    }

    /// In f32, at a step so small that rounding is seen.
    fn single(&self, quantity: Quantity) -> Option<Row> {
        let method = self.stepper.of_theory()?;
        if !matches!(method, MethodId::SemiImplicitEuler | MethodId::Rk4) {
            return None;
        }
        let row = self.row(
            Precision::F32,
            Subject::Error(quantity),
            Kind::ErrorAtStep,
            self.steps(SINGLE_HALVINGS),
            self.horizon(),
        );
        let x = Runs::new(&self.stepper, self.scene, Precision::F32).measure(&row).value()?;
        let exact = self.exact.error(quantity, row.steps, self.horizon()).ok()?;
        let rounding = (x - exact).abs();
        let n = row.steps;
        Some(if rounding < 0.01 * x {
            around(row, x, TRUNCATION, &self.why(quantity))
        } else if rounding < x {
            around(
                row,
                x,
                ROUNDING,
                &format!("rounding of {n} steps in f32, eps = 2^-23, on top of {}", self.why(quantity)),
            )
        } else {
            let least = Precision::F32.epsilon();
            from_zero(
                row,
                x,
                least,
                &format!("rounding of {n} steps in f32, eps = 2^-23, outweighs the method's error"),
            )
        })
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

    /// What theory says of the balances of a long run.
    fn growth(&self) -> Vec<Row> {
        let Some(method) = self.stepper.of_theory() else { return Vec::new() };
        let scene = self.scene.scene();
        let h_s = (scene.info().time_scale_s / STEPS_A_TIME_SCALE as f64).log2().round().exp2();
        let steps = TIME_SCALES * STEPS_A_TIME_SCALE;
        let balances = [
            (Balance::Energy, Drift::Energy),
            (Balance::Momentum, Drift::MomentumNorm),
            (Balance::AngularMomentum, Drift::AngularMomentumNorm),
        ];
        let mut rows = Vec::new();
        for (balance, drift) in balances {
            let Some(growth) = scene.growth(method, balance, h_s) else { continue };
            let row = |kind| self.row(Precision::F64, Subject::Balance(drift), kind, steps, h_s * steps as f64);
            let measured = |kind| self.double.measure(&row(kind)).value().map(|x| (row(kind), x));
            rows.extend(grown(growth, measured));
        }
        rows
    }

    /// The balances of a free body under every scheme.
    fn turning(&self) -> Vec<Row> {
        let Stepper::Turning(scheme) = self.stepper else { return Vec::new() };
        if self.scene.id() != "torque-free-spin" {
            return Vec::new();
        }
        let (steps, end_s) = if self.stepper.is_implicit() { (1024, 16.0) } else { (4096, 16.0) };
        let kept = conserved(scheme);
        let momentum = kept.contains(&Conserved::Momentum);
        let balances = [
            (Drift::Energy, kept.contains(&Conserved::Energy), "T"),
            (Drift::AngularMomentumNorm, momentum || kept.contains(&Conserved::MomentumNorm), "|L|"),
            (Drift::AngularMomentumDirection, momentum, "the direction of L"),
        ];
        let eps = Precision::F64.epsilon();
        let mut rows = Vec::new();
        for (drift, is_kept, name) in balances {
            let row = self.row(Precision::F64, Subject::Balance(drift), Kind::Drift, steps, end_s);
            let Some(x) = self.double.measure(&row).value() else { continue };
            rows.push(if is_kept {
                from_zero(row, x, eps, &format!("the scheme keeps {name} of a free body but for rounding"))
            } else {
                around(row, x, TRUNCATION, &self.change_of(name))
            });
        }
        // The driver restores the norm, whatever the scheme: one scheme for each attitude update is enough.
        let norm = self.row(Precision::F64, Subject::Balance(Drift::QuaternionNorm), Kind::Drift, steps, end_s);
        let is_one =
            self.stepper.method() == Some(MethodId::SemiImplicitEuler) && scheme.storage == Storage::WorldOmega;
        if let Some(x) = self.double.measure(&norm).value().filter(|x| is_one && *x <= 16.0 * eps) {
            let reason =
                "theory: |q| is restored every 64 steps, between which rounding moves it by sqrt(64) units: 16 eps";
            rows.push(between(norm, x, 0.0, 16.0 * eps, reason));
        }
        if energy_changes_with_one_sign(scheme) {
            let row = self.row(Precision::F64, Subject::Balance(Drift::Energy), Kind::GrowthLaw, steps, end_s);
            if let Some(x) = self.double.measure(&row).value().filter(|x| (0.8..=1.25).contains(x)) {
                let reason =
                    "theory: linear, dT = +- h^2/2 v . J v or less a step with v = omega x I omega has one sign";
                rows.push(between(row, x, 0.8, 1.25, reason));
            }
        }
        rows
    }

    /// By what a step changes a balance of a free body.
    fn change_of(&self, name: &str) -> String {
        let Stepper::Turning(scheme) = self.stepper else { return String::new() };
        let plain = self.stepper.method() == Some(MethodId::SemiImplicitEuler)
            && matches!(scheme.storage, Storage::WorldOmega | Storage::BodyOmega)
            && scheme.update == AttitudeUpdate::Exponential;
        match name {
            "T" if plain => "every step adds h^2/2 v . I^-1 v to T, v = omega x I omega".to_owned(),
            "|L|" if plain => "every step adds h^2 |omega x I omega|^2 to |L|^2".to_owned(),
            _ => format!("every step changes {name} by a term of h^{}", self.stepper.order() + 1),
        }
    }

    /// The balances that the exact motion conserves, along the error run, of whose growth theory says nothing.
    fn balances(&self, covered: &[Row]) -> Vec<Row> {
        let scene = self.scene.scene();
        let first = scene.account(fx128::ZERO, &self.scene.exact(fx128::ZERO));
        if !first.iter().all(|entry| entry.conserved) {
            return Vec::new();
        }
        let mut rows = Vec::new();
        for (drift, _) in drifts(&first, &first) {
            if scale(&first, drift) == 0.0 || covered.iter().any(|row| row.quantity == Subject::Balance(drift)) {
                continue;
            }
            let row =
                self.row(Precision::F64, Subject::Balance(drift), Kind::Drift, self.steps(HALVINGS), self.horizon());
            let Some(x) = self.double.measure(&row).value().filter(|x| x.is_finite()) else { continue };
            let eps = Precision::F64.epsilon();
            // The rounding of a run of some hundred steps is below this.
            rows.push(if x > CLEAR * 64.0 * eps {
                around(row, x, TRUNCATION, "conserved by the exact motion, lost by the method's local error")
            } else {
                from_zero(row, x, eps, "conserved by the exact motion, and by the method to rounding")
            });
        }
        rows
    }

    fn limit(&self) -> Option<Row> {
        let Stepper::Flat(method) = self.stepper else { return None };
        let info = self.scene.scene().info();
        let (limit, reason) = self.scene.scene().stability_limit(method)?;
        let row = self.row(Precision::F64, Subject::Step, Kind::StabilityLimit, 1, info.horizon_s);
        let x = self.double.measure(&row).value()?;
        let reason = format!("theory: {reason}");
        let theory = if limit == StabilityLimit::Unlimited { UNLIMITED } else { number(limit)? / info.time_scale_s };
        // The bracket of the bisection is 0.4 % wide.
        let tolerance = if matches!(limit, StabilityLimit::Below(_)) { 0.005 } else { 0.0 };
        Some(between(row, x, theory * (1.0 - tolerance), theory * (1.0 + tolerance), &reason))
    }

    /// A time that is summed is wrong by up to n units in the last place: that shows where the step is no power of two, the
    /// force depends on time, and nothing else is as wrong.
    fn summed_time(&self) -> Option<Row> {
        if (self.scene.id(), self.stepper) != ("forced-oscillator", Stepper::Flat(MethodId::Rk4)) {
            return None;
        }
        let steps = 3 << 16;
        let row =
            self.row(Precision::F64, Subject::Error(Quantity::Velocity), Kind::ErrorAtStep, steps, self.horizon());
        let x = self.double.measure(&row).value()?;
        let reason = "t = i h is rounded once, so that n = 3 2^16 steps leave the sqrt(n) roundings of the state alone";
        Some(from_zero(row, x, Precision::F64.epsilon(), reason))
    }
}

/// Rows of a balance of whose growth theory speaks.
fn grown(growth: ExpectedGrowth, measured: impl Fn(Kind) -> Option<(Row, f64)>) -> Vec<Row> {
    let reason = growth.reason;
    let drift = || measured(Kind::Drift);
    let law = |low: f64, high: f64, name: &str| {
        let (row, x) = measured(Kind::GrowthLaw)?;
        (low <= x && x <= high).then(|| between(row, x, low, high, &format!("theory: {name}: {reason}")))
    };
    match (growth.law, growth.bounds) {
        (Law::AtTheFloor, _) => {
            drift().map(|(row, x)| from_zero(row, x, Precision::F64.epsilon(), reason)).into_iter().collect()
        }
        (Law::Bounded, Some([low, high])) => {
            // The widest swing of value / start is reached, all but what falls between two steps.
            let widest = (low - 1.0).abs().max((high - 1.0).abs());
            let reason = format!("theory: at most {widest:.6e}, and reached to 5 %: {reason}");
            drift()
                .map(|(row, x)| between(row, x, 0.95 * widest, widest * (1.0 + 1e-9), &reason))
                .filter(|row| row.admits(row.measured))
                .into_iter()
                .collect()
        }
        (Law::Bounded, None) => {
            let size = drift().map(|(row, x)| around(row, x, TRUNCATION, &format!("bounded: {reason}")));
            size.into_iter().chain(law(-0.15, 0.15, "bounded, t^0")).collect()
        }
        (Law::Exponential, Some([rate, _])) => measured(Kind::GrowthRate)
            .and_then(|(row, x)| {
                let t = [0.001, 0.01].into_iter().find(|t| (x / rate - 1.0).abs() <= 0.5 * t)?;
                let reason = format!("theory: rate {rate:.6e} 1/s, +-{} %: {reason}", 100.0 * t);
                Some(between(row, x, rate - t * rate.abs(), rate + t * rate.abs(), &reason))
            })
            .into_iter()
            .collect(),
        (Law::Linear, _) => law(0.8, 1.25, "linear, t^1").into_iter().collect(),
        (Law::Quadratic, _) => law(1.7, 2.4, "quadratic, t^2").into_iter().collect(),
        _ => Vec::new(),
    }
}

fn between(row: Row, measured: f64, low: f64, high: f64, reason: &str) -> Row {
    Row { low, high, measured, reason: reason.to_owned(), ..row }
}

/// Measured / factor to measured * factor.
pub(super) fn around(row: Row, measured: f64, factor: f64, why: &str) -> Row {
    let reason = format!("measured x {factor}: {why}");
    between(row, measured, six(measured / factor), six(measured * factor), &reason)
}

/// Rounding: 0 to measured * factor. A number below `least`, one rounding of it, is luck: one rounding is granted.
pub(super) fn from_zero(row: Row, measured: f64, least: f64, why: &str) -> Row {
    if measured < least {
        let reason = format!("theory: no error but the last rounding, at most {ROUNDING} eps; {why}");
        return between(row, measured, 0.0, six(least * ROUNDING), &reason);
    }
    between(row, measured, 0.0, six(measured * ROUNDING), &format!("measured x {ROUNDING}, from 0: rounding; {why}"))
}

/// Names with each row the first mutant that breaks it.
fn name_mutants(scene: &dyn AnyScene, stepper: Stepper, rows: &mut [Row]) {
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
