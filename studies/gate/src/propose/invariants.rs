//! Bounds on invariants: how far they stray, and by which law.

use faer::fx128;
use integrator::methods::{Conserved, MethodId};
use integrator::rigid_body::{AttitudeUpdate, Formulation};

use super::{CLEAR, HALVINGS, Maker, TRUNCATION, around, between, from_zero};
use crate::row::{Kind, Row, Subject};
use crate::stepper::Stepper;
use measure::drift::{Drift, drifts, scale};
use measure::rotation::claims::conserved;
use measure::rotation::laws::energy_changes_with_one_sign;
use scenes::invariants::Invariant;
use scenes::run::Precision;
use scenes::theory::ExpectedGrowth;
use scenes::theory::Law;

/// Length of a run along which an invariant is followed, in time scales, and its steps in one.
const TIME_SCALES: u64 = 128;
const STEPS_A_TIME_SCALE: u64 = 32;

impl Maker<'_> {
    /// What theory says of the invariants of a long run.
    pub(super) fn growth(&self) -> Vec<Row> {
        let Some(method) = self.stepper.of_theory() else { return Vec::new() };
        let scene = self.scene.scene();
        let h_s = (scene.info().time_scale_s / STEPS_A_TIME_SCALE as f64).log2().round().exp2();
        let steps = TIME_SCALES * STEPS_A_TIME_SCALE;
        let invariants = [
            (Invariant::Energy, Drift::Energy),
            (Invariant::Momentum, Drift::MomentumNorm),
            (Invariant::AngularMomentum, Drift::AngularMomentumNorm),
        ];
        let mut rows = Vec::new();
        for (invariant, drift) in invariants {
            let Some(growth) = scene.expected_growth(method, invariant, h_s) else { continue };
            let row = |kind| self.row(Precision::F64, Subject::Invariant(drift), kind, steps, h_s * steps as f64);
            let measured = |kind| self.double.measure(&row(kind)).value().map(|x| (row(kind), x));
            rows.extend(grown(growth, measured));
        }
        rows
    }

    /// The invariants of a free body under every scheme.
    pub(super) fn turning(&self) -> Vec<Row> {
        let Stepper::Turning(scheme) = self.stepper else { return Vec::new() };
        if self.scene.id() != "torque-free-spin" {
            return Vec::new();
        }
        let (steps, end_s) = if self.stepper.is_implicit() { (1024, 16.0) } else { (4096, 16.0) };
        let kept = conserved(scheme);
        let momentum = kept.contains(&Conserved::Momentum);
        let invariants = [
            (Drift::Energy, kept.contains(&Conserved::Energy), "T"),
            (Drift::AngularMomentumNorm, momentum || kept.contains(&Conserved::MomentumNorm), "|L|"),
            (Drift::AngularMomentumDirection, momentum, "the direction of L"),
        ];
        let eps = Precision::F64.epsilon();
        let mut rows = Vec::new();
        for (drift, is_kept, name) in invariants {
            let row = self.row(Precision::F64, Subject::Invariant(drift), Kind::Drift, steps, end_s);
            let Some(x) = self.double.measure(&row).value() else { continue };
            rows.push(if is_kept {
                from_zero(row, x, eps, &format!("the scheme keeps {name} of a free body but for rounding"))
            } else {
                around(row, x, TRUNCATION, &self.change_of(name))
            });
        }
        // The driver restores the norm, whatever the scheme: one scheme for each attitude update is enough.
        let norm = self.row(Precision::F64, Subject::Invariant(Drift::QuaternionNorm), Kind::Drift, steps, end_s);
        let is_one =
            self.stepper.method() == Some(MethodId::SemiImplicitEuler) && scheme.storage == Formulation::WorldOmega;
        if let Some(x) = self.double.measure(&norm).value().filter(|x| is_one && *x <= 16.0 * eps) {
            let reason =
                "theory: |q| is restored every 64 steps, between which rounding moves it by sqrt(64) units: 16 eps";
            rows.push(between(norm, x, 0.0, 16.0 * eps, reason));
        }
        if energy_changes_with_one_sign(scheme) {
            let row = self.row(Precision::F64, Subject::Invariant(Drift::Energy), Kind::GrowthLaw, steps, end_s);
            if let Some(x) = self.double.measure(&row).value().filter(|x| (0.8..=1.25).contains(x)) {
                let reason =
                    "theory: linear, dT = +- h^2/2 v . J v or less a step with v = omega x I omega has one sign";
                rows.push(between(row, x, 0.8, 1.25, reason));
            }
        }
        rows
    }

    /// By what a step changes an invariant of a free body.
    fn change_of(&self, name: &str) -> String {
        let Stepper::Turning(scheme) = self.stepper else { return String::new() };
        // In the body frame omega does not hear of the attitude, and so not of how that is advanced.
        let plain = self.stepper.method() == Some(MethodId::SemiImplicitEuler)
            && match scheme.storage {
                Formulation::BodyOmega => true,
                Formulation::WorldOmega => scheme.update == AttitudeUpdate::Exponential,
                _ => false,
            };
        match name {
            "T" if plain => "every step adds h^2/2 v . I^-1 v to T, v = omega x I omega".to_owned(),
            "|L|" if plain => "every step adds h^2 |omega x I omega|^2 to |L|^2".to_owned(),
            _ => format!("every step changes {name} by a term of h^{}", self.stepper.order() + 1),
        }
    }

    /// The invariants that the exact motion conserves, along the error run, of whose growth theory says nothing.
    pub(super) fn invariants(&self, covered: &[Row]) -> Vec<Row> {
        let scene = self.scene.scene();
        let first = scene.invariants(fx128::ZERO, &self.scene.exact(fx128::ZERO));
        if !first.iter().all(|entry| entry.conserved) {
            return Vec::new();
        }
        let mut rows = Vec::new();
        for (drift, _) in drifts(&first, &first) {
            if scale(&first, drift) == 0.0 || covered.iter().any(|row| row.quantity == Subject::Invariant(drift)) {
                continue;
            }
            let row =
                self.row(Precision::F64, Subject::Invariant(drift), Kind::Drift, self.steps(HALVINGS), self.horizon());
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
}

/// Rows of an invariant of whose growth theory speaks.
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
