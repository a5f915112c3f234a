//! Claims: a statement, what theory says, what was measured, the bound between them, and whether it holds.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Whether a claim stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The measurement lies inside the bound.
    Holds,
    /// The measurement lies outside the bound, or is not a number.
    Broken,
    /// Nothing was measured that could decide it.
    NotTested,
}

impl Verdict {
    /// All of them, the best first.
    pub const ALL: [Self; 3] = [Self::Holds, Self::Broken, Self::NotTested];

    /// `Holds` if the comparison with the bound came out true, `Broken` if not; comparisons with NaN are false.
    pub fn from_comparison(inside: bool) -> Self {
        if inside { Self::Holds } else { Self::Broken }
    }

    /// The sign set before the word, so that a verdict is readable without colour.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Holds => "✓",
            Self::Broken => "✗",
            Self::NotTested => "–",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Holds => "holds",
            Self::Broken => "broken",
            Self::NotTested => "not tested",
        })
    }
}

/// One line of a report that can be true or false. The texts carry their units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Claim {
    /// Short stable name, unique within a report: `convergence.rk4.order`.
    pub id: String,
    /// The study it belongs to: `convergence`.
    pub study: String,
    /// The scene it is about, or empty: `kepler/circular`; a base name stands for all presets of a scene.
    #[serde(default)]
    pub scene: Option<String>,
    /// The method or scheme it is about, or empty: `rk4`.
    #[serde(default)]
    pub method: Option<String>,
    /// What is claimed, one sentence.
    pub statement: String,
    /// What theory predicts.
    pub theory: String,
    /// What was measured.
    pub measured: String,
    /// The bound the measurement has to keep.
    pub bound: String,
    /// Whether it did.
    pub verdict: Verdict,
    /// The numbers that were measured, for a sentence that quotes them.
    #[serde(skip)]
    pub numbers: Vec<f64>,
}

impl Claim {
    /// A claim about no scene and no method in particular.
    pub fn new(study: &str, id: String, [statement, theory, measured, bound]: [String; 4], verdict: Verdict) -> Self {
        let study = study.to_owned();
        Claim { id, study, scene: None, method: None, statement, theory, measured, bound, verdict, numbers: Vec::new() }
    }

    /// The same about a scene.
    #[must_use]
    pub fn on(self, scene: &str) -> Self {
        Claim { scene: Some(scene.to_owned()), ..self }
    }

    /// The same about a method or scheme.
    #[must_use]
    pub fn by(self, method: &str) -> Self {
        Claim { method: Some(method.to_owned()), ..self }
    }

    /// The same with its numbers.
    #[must_use]
    pub fn with_numbers(self, numbers: impl IntoIterator<Item = f64>) -> Self {
        Claim { numbers: numbers.into_iter().collect(), ..self }
    }
}

/// How many claims hold, are broken, were not tested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Claims that hold.
    pub holds: usize,
    /// Claims that are broken.
    pub broken: usize,
    /// Claims that nothing was measured for.
    pub not_tested: usize,
}

/// The verdicts of `claims`, counted.
pub fn counts<'a>(claims: impl IntoIterator<Item = &'a Claim>) -> Counts {
    claims.into_iter().fold(Counts::default(), |mut sum, claim| {
        match claim.verdict {
            Verdict::Holds => sum.holds += 1,
            Verdict::Broken => sum.broken += 1,
            Verdict::NotTested => sum.not_tested += 1,
        }
        sum
    })
}

/// The exit code of a program that made these claims: 1 if any is broken, else 0. A run of everything has to hold everything:
/// with `is_full`, a claim that was not tested and a run without claims are 1, too.
pub fn exit_code(claims: &[Claim], is_full: bool) -> u8 {
    let Counts { holds, broken, not_tested } = counts(claims);
    u8::from(broken > 0 || is_full && (holds == 0 || not_tested > 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(verdict: Verdict) -> Claim {
        Claim::new("", String::new(), Default::default(), verdict)
    }

    #[test]
    fn only_a_broken_claim_sets_the_exit_code() {
        assert_eq!(exit_code(&[], false), 0);
        assert_eq!(exit_code(&[claim(Verdict::Holds), claim(Verdict::NotTested)], false), 0);
        assert_eq!(exit_code(&[claim(Verdict::Holds), claim(Verdict::Broken), claim(Verdict::Holds)], false), 1);
    }

    // Fails if: a full run is green that has claimed nothing, or has left a claim untested.
    #[test]
    fn a_full_run_holds_everything_it_claims() {
        assert_eq!(exit_code(&[claim(Verdict::Holds)], true), 0);
        assert_eq!(exit_code(&[], true), 1);
        assert_eq!(exit_code(&[claim(Verdict::Holds), claim(Verdict::NotTested)], true), 1);
    }

    #[test]
    fn verdicts_are_counted_each_under_its_own_name() {
        let claims = [Verdict::Holds, Verdict::Broken, Verdict::Broken, Verdict::NotTested, Verdict::NotTested]
            .map(claim)
            .into_iter()
            .chain([claim(Verdict::NotTested)])
            .collect::<Vec<_>>();
        assert_eq!(counts(&claims), Counts { holds: 1, broken: 2, not_tested: 3 });
    }

    #[test]
    fn a_comparison_with_nan_breaks_the_claim() {
        let measured = f64::NAN;
        assert_eq!(Verdict::from_comparison(measured <= 1.0), Verdict::Broken);
        assert_eq!(Verdict::from_comparison(0.5 <= 1.0), Verdict::Holds);
    }
}
