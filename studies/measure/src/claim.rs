//! The one place where a claim is judged.
//!
//! A claim lists as [`Evidence`] every number that it needs. A number that is missing, not a number or outside its bound breaks it,
//! and a claim that needs nothing is not tested: it cannot hold.

use reports::{Claim, Verdict};

/// What one needed number says of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// It is there and inside its bound.
    Inside,
    /// It is outside its bound, missing or not a number.
    Outside,
    /// The run finished, and its numbers cannot decide: two laws fit alike, or two runs have a slope that nothing contradicts.
    Undecided,
}

impl Evidence {
    /// Inside for a number with `low` <= number <= `high`.
    pub fn within(value: Option<f64>, [low, high]: [f64; 2]) -> Self {
        Self::is(value.is_some_and(|value| low <= value && value <= high))
    }

    /// Inside for |number - `theory`| <= `tolerance`.
    pub fn near(value: Option<f64>, theory: Option<f64>, tolerance: f64) -> Self {
        Self::is(value.zip(theory).is_some_and(|(value, theory)| (value - theory).abs() <= tolerance))
    }

    /// Inside for what holds: comparisons with NaN are false.
    pub fn is(holds: bool) -> Self {
        if holds { Self::Inside } else { Self::Outside }
    }
}

/// Holds where there is evidence and all of it is inside; broken where any is outside; not tested otherwise.
pub fn verdict(evidence: impl IntoIterator<Item = Evidence>) -> Verdict {
    let (mut any, mut undecided, mut outside) = (false, false, false);
    for one in evidence {
        any = true;
        undecided |= one == Evidence::Undecided;
        outside |= one == Evidence::Outside;
    }
    match (outside, any && !undecided) {
        (true, _) => Verdict::Broken,
        (false, true) => Verdict::Holds,
        (false, false) => Verdict::NotTested,
    }
}

/// The claim of a study with its statement, theory, measurement and bound in words, judged by its evidence. Its full name is
/// `study.id`.
pub fn claim(study: &str, id: &str, texts: [String; 4], evidence: impl IntoIterator<Item = Evidence>) -> Claim {
    Claim::new(study, format!("{study}.{id}"), texts, verdict(evidence))
}

/// The name that two of the claims have, where two have one: rows of one run then stand twice, or under another's name.
pub fn repeated(claims: &[Claim]) -> Option<&str> {
    let mut ids: Vec<&str> = claims.iter().map(|claim| claim.id.as_str()).collect();
    ids.sort_unstable();
    ids.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0])
}

/// The largest of some sizes: NaN if any of them is, `None` if any is missing or there is none.
pub fn largest(sizes: impl IntoIterator<Item = Option<f64>>) -> Option<f64> {
    let sizes: Option<Vec<f64>> = sizes.into_iter().collect();
    scenes::observation::largest(sizes?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    // Fails if: a verdict starts from 'holds'.
    #[test]
    fn a_claim_over_nothing_is_not_tested() {
        assert_eq!(verdict([]), Verdict::NotTested);
        assert_eq!(verdict([Evidence::Undecided, Evidence::Inside]), Verdict::NotTested);
    }

    // Fails if: a missing number, or a bound that is not a number, is skipped.
    #[test]
    fn what_is_missing_or_not_a_number_breaks() {
        let inside = Evidence::within(Some(1.0), [0.0, 2.0]);
        assert_eq!(verdict([inside]), Verdict::Holds);
        for bad in [
            Evidence::within(None, [0.0, 2.0]),
            Evidence::within(Some(f64::NAN), [f64::NEG_INFINITY, f64::INFINITY]),
            Evidence::within(Some(1.0), [f64::NAN, 2.0]),
            Evidence::within(Some(1.0), [0.0, f64::NAN]),
            Evidence::near(Some(1.0), None, 1.0),
            Evidence::near(Some(f64::NAN), Some(f64::NAN), 1.0),
            Evidence::near(Some(1.0), Some(1.0), f64::NAN),
        ] {
            assert_eq!(verdict([inside, bad, inside, Evidence::Undecided]), Verdict::Broken);
        }
    }

    proptest! {
        // Fails if: one of the two sides of a bound is not looked at.
        #[test]
        fn a_bound_has_two_sides(theory in -1e3..1e3_f64, off in -2.0..2.0_f64) {
            let near = Evidence::near(Some(theory + off), Some(theory), 1.0);
            let within = Evidence::within(Some(theory + off), [theory - 1.0, theory + 1.0]);
            prop_assume!((off.abs() - 1.0).abs() > 1e-9);
            prop_assert_eq!(near, Evidence::is(off.abs() < 1.0));
            prop_assert_eq!(within, near);
        }
    }

    // Fails if: a name that stands twice is not seen, or one that only begins like another is.
    #[test]
    fn a_name_that_two_claims_have_is_found() {
        let named = |id: &str| claim("s", id, [(); 4].map(|()| String::new()), []);
        assert_eq!(repeated(&["b", "a", "ab"].map(named)), None);
        assert_eq!(repeated(&["b", "a", "b"].map(named)), Some("s.b"));
    }

    // Fails if: the largest starts from 0, or skips what is missing or not a number.
    #[test]
    fn the_largest_of_nothing_is_nothing_and_of_a_nan_is_nan() {
        assert_eq!(largest([]), None);
        assert_eq!(largest([Some(1.0), None]), None);
        for numbers in [[Some(f64::NAN), Some(1.0)], [Some(1.0), Some(f64::NAN)]] {
            assert!(largest(numbers).is_some_and(f64::is_nan));
        }
        assert_eq!(largest([Some(1.0), Some(3.0), Some(2.0)]), Some(3.0));
    }
}
