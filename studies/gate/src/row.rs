//! One bound: which number of which run, between what, for what reason.

use serde::{Deserialize, Serialize};

use measure::drift::Drift;
use measure::error::Error;
use scenes::observation::Quantity;
use scenes::run::Precision;

/// How a bounded number is got from a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// 2 p(n/2, n) - p(n/4, n/2) with p(m, n) = log2 (error(m) / error(n)): the order, extrapolated to h = 0.
    Order,
    /// The error at the end of n steps.
    ErrorAtStep,
    /// 2 c(n) - c(n/2) with c = error / h^p and p the order of theory: the error constant, extrapolated to h = 0.
    ErrorConstant,
    /// The largest error of an invariant along a run, as a part of the invariant at the start.
    Drift,
    /// p of error ~ t^p over the last decade of a run.
    GrowthLaw,
    /// r of E / E0 = exp(r t).
    GrowthRate,
    /// The largest stable step over the natural time scale: 0 where every step fails, 1024 where none up to that does.
    StabilityLimit,
    /// Evaluations of the force law in n steps, divided by n.
    EvaluationsPerStep,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Kind; 8] = [
        Kind::Order,
        Kind::ErrorAtStep,
        Kind::ErrorConstant,
        Kind::Drift,
        Kind::GrowthLaw,
        Kind::GrowthRate,
        Kind::StabilityLimit,
        Kind::EvaluationsPerStep,
    ];

    /// The name in the file.
    pub fn id(self) -> &'static str {
        match self {
            Kind::Order => "order",
            Kind::ErrorAtStep => "error-at-step",
            Kind::ErrorConstant => "error-constant",
            Kind::Drift => "drift",
            Kind::GrowthLaw => "growth-law",
            Kind::GrowthRate => "growth-rate",
            Kind::StabilityLimit => "stability-limit",
            Kind::EvaluationsPerStep => "evaluations-per-step",
        }
    }

    /// The kind of that name.
    ///
    /// # Errors
    /// An unknown name, with the list.
    pub fn from_id(id: &str) -> Result<Self, Error> {
        let known = || Self::ALL.map(|kind| kind.id().to_owned());
        Self::ALL.into_iter().find(|kind| kind.id() == id).ok_or_else(|| Error::unknown("kind", id, known()))
    }

    /// Numbers of steps that it halves: n must be a multiple of this.
    pub fn divisor(self) -> u64 {
        match self {
            Kind::Order => 4,
            Kind::ErrorConstant => 2,
            _ => 1,
        }
    }

    /// Whether a small number is no merit in itself, so that a bound is judged by its width and not by its ratio.
    pub fn is_exponent(self) -> bool {
        matches!(self, Kind::Order | Kind::GrowthLaw)
    }
}

/// What is bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Subject {
    /// The error of an observed quantity.
    Error(Quantity),
    /// The error of an invariant.
    Invariant(Drift),
    /// The step.
    Step,
    /// Evaluations of the force law.
    Evaluations,
}

impl Subject {
    /// Every one.
    pub fn all() -> Vec<Subject> {
        let errors = Quantity::ALL.map(Subject::Error);
        let invariants = Drift::ALL.map(Subject::Invariant);
        errors.into_iter().chain(invariants).chain([Subject::Step, Subject::Evaluations]).collect()
    }

    /// The name in the file.
    pub fn id(self) -> &'static str {
        match self {
            Subject::Error(quantity) => quantity.id(),
            Subject::Invariant(drift) => drift.id(),
            Subject::Step => "step",
            Subject::Evaluations => "evaluations",
        }
    }

    /// The subject of that name.
    ///
    /// # Errors
    /// An unknown name, with the list.
    pub fn from_id(id: &str) -> Result<Self, Error> {
        let all = Self::all();
        let known = || all.iter().map(|subject| subject.id().to_owned());
        all.iter().copied().find(|subject| subject.id() == id).ok_or_else(|| Error::unknown("quantity", id, known()))
    }

    /// Whether a number of this kind can be got of it.
    pub fn has(self, kind: Kind) -> bool {
        match self {
            Subject::Error(_) => matches!(kind, Kind::Order | Kind::ErrorAtStep | Kind::ErrorConstant),
            Subject::Invariant(_) => matches!(kind, Kind::Drift | Kind::GrowthLaw | Kind::GrowthRate),
            Subject::Step => kind == Kind::StabilityLimit,
            Subject::Evaluations => kind == Kind::EvaluationsPerStep,
        }
    }

    /// The unit of low, high and measured; `order` is that of an error constant.
    pub fn unit(self, kind: Kind, order: f64) -> String {
        match (self, kind) {
            (Subject::Error(quantity), Kind::ErrorAtStep) => quantity.unit().to_owned(),
            (Subject::Error(quantity), Kind::ErrorConstant) => format!("{}/s^{order}", quantity.unit()),
            (Subject::Invariant(Drift::MomentumDirection | Drift::AngularMomentumDirection), Kind::Drift) => {
                "rad".to_owned()
            }
            (_, Kind::GrowthRate) => "1/s".to_owned(),
            _ => "1".to_owned(),
        }
    }
}

/// One line of the file. Lines are sorted by what comes before `low`.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Scene or preset.
    pub scene: String,
    /// Method; of a rigid body with what is stored: `rk4/body-omega`, `semi-implicit-euler/world-omega/linear`.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// What is bounded.
    pub quantity: Subject,
    /// How the number is got.
    pub kind: Kind,
    /// Number of steps n of the run, of the longest where there are several.
    pub steps: u64,
    /// End of the run, s.
    pub end_s: f64,
    /// Unit of low, high and measured.
    pub unit: String,
    /// The least number that holds.
    pub low: f64,
    /// The greatest number that holds.
    pub high: f64,
    /// The number when the bound was set.
    pub measured: f64,
    /// Why these bounds: `theory: ...`, or `measured x 1.05: ...`.
    pub reason: String,
    /// A mutation known to break it; empty where none is.
    pub mutant: String,
}

/// Which number a row bounds; no two rows have the same.
pub type Key = (String, String, Precision, Subject, Kind, u64, u64);

impl Row {
    /// Which number it bounds. Times are positive, and their bits are in the order of their values.
    pub fn key(&self) -> Key {
        let (scene, method) = (self.scene.clone(), self.method.clone());
        (scene, method, self.precision, self.quantity, self.kind, self.steps, self.end_s.to_bits())
    }

    /// The same in words: `kepler, rk4, f64: order of position (1024 steps to 2.25 s)`.
    pub fn name(&self) -> String {
        format!(
            "{} {} {} {} {} (n = {}, T = {} s)",
            self.scene,
            self.method,
            self.precision.id(),
            self.quantity.id(),
            self.kind.id(),
            self.steps,
            self.end_s
        )
    }

    /// Whether a number is inside. NaN is not.
    pub fn admits(&self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// Whether the reason is a formula and not a measurement.
    pub fn is_theory(&self) -> bool {
        self.reason.starts_with("theory: ")
    }

    /// What the reason makes of `measured`: low and high; `None` for theory, whose bounds are in its formula.
    ///
    /// # Errors
    /// What a reason should be.
    pub fn of_reason(&self) -> Result<Option<[f64; 2]>, String> {
        let form =
            "give 'theory: the formula', 'measured x FACTOR: what is known' or 'measured +- WIDTH: what is known'";
        let (how, why) = self.reason.split_once(": ").ok_or(form)?;
        if why.trim().is_empty() {
            return Err(form.to_owned());
        }
        let x = self.measured;
        if how == "theory" {
            return Ok(None);
        }
        if let Some(factor) = how.strip_prefix("measured x ") {
            let from_zero = factor.strip_suffix(", from 0");
            let text = from_zero.unwrap_or(factor);
            let factor = text.parse().ok().filter(|f: &f64| f.is_finite() && *f > 1.0);
            let factor = factor.ok_or_else(|| format!("'{text}' is no factor: give a number above 1"))?;
            return Ok(Some([if from_zero.is_some() { 0.0 } else { x / factor }, x * factor]));
        }
        let text = how.strip_prefix("measured +- ").ok_or(form)?;
        let width = text.parse().ok().filter(|w: &f64| w.is_finite() && *w >= 0.0);
        let width = width.ok_or_else(|| format!("'{text}' is no width: give a number, 0 or above"))?;
        Ok(Some([x - width, x + width]))
    }

    /// F of `measured x F: ...`.
    pub fn factor(&self) -> Option<f64> {
        let rest = self.reason.strip_prefix("measured x ")?;
        rest.split([':', ',']).next()?.trim().parse().ok()
    }
}

/// The row's line in a quick check: f64, the first preset of each scene, and what one sweep of short runs shows.
pub fn is_quick(row: &Row, first_presets: &[&str]) -> bool {
    row.precision == Precision::F64
        && first_presets.contains(&row.scene.as_str())
        && matches!(row.kind, Kind::Order | Kind::ErrorAtStep | Kind::EvaluationsPerStep)
}
