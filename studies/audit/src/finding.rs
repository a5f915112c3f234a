//! What a check says: one finding a statement, with its number, its bound and its evidence.

use serde::Serialize;

/// The question that a finding answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Check {
    /// How the columns were read.
    Reading,
    /// The clock.
    Time,
    /// Position against velocity, attitude against angular velocity.
    Kinematics,
    /// Energy, angular momentum, norms, clamps.
    Conservation,
    /// The equation of motion.
    Dynamics,
    /// The exact motion.
    Error,
    /// The step that computed the file.
    Step,
}

impl Check {
    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            Check::Reading => "reading",
            Check::Time => "time",
            Check::Kinematics => "kinematics",
            Check::Conservation => "conservation",
            Check::Dynamics => "dynamics",
            Check::Error => "error",
            Check::Step => "step",
        }
    }
}

/// What a finding means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Something is wrong, or a bound is broken.
    Fault,
    /// The file does not decide.
    Tie,
    /// Worth knowing; no fault in itself.
    Note,
    /// As it should be.
    Pass,
}

impl Verdict {
    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            Verdict::Fault => "fault",
            Verdict::Tie => "tie",
            Verdict::Note => "note",
            Verdict::Pass => "pass",
        }
    }
}

/// One statement about a file.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// The question.
    pub check: Check,
    /// A short name of what was found, the same in every file: `repeated-row`, `gyroscopic-term-missing`.
    pub id: &'static str,
    /// What was measured.
    pub quantity: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What the value may be at most, where there is a limit.
    pub bound: Option<f64>,
    /// What it means.
    pub verdict: Verdict,
    /// The numbers behind it, in one sentence.
    pub evidence: String,
}

impl Finding {
    /// A finding without a bound.
    pub fn new(
        check: Check,
        id: &'static str,
        verdict: Verdict,
        (quantity, value, unit): (impl Into<String>, f64, &'static str),
        evidence: impl Into<String>,
    ) -> Self {
        Finding { check, id, quantity: quantity.into(), value, unit, bound: None, verdict, evidence: evidence.into() }
    }

    /// The same with a bound.
    #[must_use]
    pub fn within(mut self, bound: f64) -> Self {
        self.bound = Some(bound);
        self
    }
}

/// The middle value; NaN of none.
pub(crate) fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value below which a share of the others lies; NaN of none.
pub(crate) fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    if sorted.is_empty() {
        return f64::NAN;
    }
    let place = ((sorted.len() - 1) as f64 * share).round() as usize;
    *sorted.select_nth_unstable_by(place, f64::total_cmp).1
}
