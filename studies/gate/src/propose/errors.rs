//! Bounds on errors: at a step, their order and their constant.

use faer::fx128;
use integrator::Real;
use integrator::methods::MethodId;

use super::{CLEAR, HALVINGS, Maker, ROUNDING, SINGLE_HALVINGS, TRUNCATION, around, between, from_zero};
use crate::numbers::Runs;
use crate::row::{Kind, Row, Subject};
use crate::stepper::Stepper;
use scenes::observation::Quantity;
use scenes::run::Precision;
use scenes::theory::{ExpectedOrder, Theory};

impl Maker<'_> {
    pub(super) fn error(&self, quantity: Quantity) -> Option<Row> {
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

    pub(super) fn order(&self, quantity: Quantity) -> Option<Row> {
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
                // Roundings of a few units a step: an order of these is an accident.
                let roundings = 16.0 * steps as f64 * precision.epsilon();
                let is_rounding = precision == Precision::DoubleDouble
                    && self.exact.error(quantity, steps, self.horizon()).is_ok_and(|error| error < roundings);
                let Some(x) = runs.measure(&row).value().filter(|_| !noisy && !is_rounding) else { continue };
                // Half of the tolerance is left for what a change of the arithmetic may do.
                let tolerance = [0.02, 0.05].into_iter().find(|t| (x - p).abs() <= 0.5 * t);
                if let Some(t) = tolerance {
                    return Some(between(row, x, p - t, p + t, &format!("theory: {reason}")));
                }
            }
        }
        None
    }

    pub(super) fn constant(&self, quantity: Quantity) -> Option<Row> {
        let Theory { order: ExpectedOrder::Of(p), constant, reason, .. } = self.theory(Subject::Error(quantity))?
        else {
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
    pub(super) fn single(&self, quantity: Quantity) -> Option<Row> {
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

    /// A time that is summed is wrong by up to n units in the last place: that shows where the step is no power of two, the
    /// force depends on time, and nothing else is as wrong.
    pub(super) fn summed_time(&self) -> Option<Row> {
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
