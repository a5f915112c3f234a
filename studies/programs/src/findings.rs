//! What a busy reader should take away: a sentence, the claims that carry it with their numbers, the chart that shows it.

use reports::{Block, Claim, Finding, Section, Verdict};

/// The numbers of each claim that carries a finding.
type Numbers<'a> = [&'a [f64]];

/// A finding before its numbers are known.
struct Draft {
    title: &'static str,
    number: fn(&Numbers<'_>) -> String,
    text: fn(&Numbers<'_>) -> String,
    /// Ids of the claims, or beginnings of them; without one of them there is no finding.
    claims: &'static [&'static str],
    figure: &'static str,
}

const DRAFTS: [Draft; 4] = [
    Draft {
        title: "Explicit Euler gains energy in every step; semi-implicit Euler keeps it in a band",
        number: |n| format!("E/E₀ in [{}]", list(n[0], ", ")),
        text: |n| {
            format!(
                "Both methods make the same two updates, in another order. On the oscillator the energy of explicit Euler grows \
                 exponentially (rate {} 1/s). The energy of semi-implicit Euler stays in the band that theory gives. Both evaluate \
                 the force once per step: take semi-implicit Euler wherever explicit Euler is in use.",
                list(n[1], ", ")
            )
        },
        claims: &["drift.oscillator.semi-implicit-euler.energy", "drift.oscillator.explicit-euler.energy"],
        figure: "drift-oscillator-energy",
    },
    Draft {
        title: "Semi-implicit Euler loses its advantage on spinning bodies; without the gyroscopic term no step size removes the error",
        number: |n| format!("order 0 on {} scenes", list(n[1], ", ")),
        text: |n| {
            format!(
                "Semi-implicit Euler gains energy on a free asymmetric body: h²/2 times {} W/s per step. An engine without the \
                 gyroscopic term makes an error that does not fall with the step, on {} scenes. \
                 Keep the term, and take a scheme of order 2 for bodies that spin freely.",
                list(n[0], ", "),
                list(n[1], ", ")
            )
        },
        claims: &[
            "rotation.step-law.energy.asymmetric-body.semi-implicit-euler/body-omega",
            "rotation.semi-implicit-euler/without-gyroscopic-term.order-0",
        ],
        figure: "rotation-error-torque-free-spin",
    },
    Draft {
        title: "RK4 is worth its four evaluations: at an error of 0.01 it costs less than semi-implicit Euler on almost every scene",
        number: |n| format!("cheaper on {} scenes", list(n[0], " of ")),
        text: |n| {
            format!(
                "RK4 reaches an error of 0.01 m or rad with fewer evaluations of the force on {} scenes. At an error of 0.1 \
                 semi-implicit Euler costs no more on a third of the scenes. It costs less than implicit Euler on nearly all of \
                 them. In f32 every method has a step below which its error grows. Take velocity Verlet for 1 %, \
                 RK4 for less, and a step no smaller than the error asks for.",
                list(n[0], " of ")
            )
        },
        claims: &["tradeoff.semi-implicit-or-rk4"],
        figure: "work-evaluations-pendulum",
    },
    Draft {
        title: "Semi-implicit Euler becomes unstable at h ω = 2",
        number: |n| format!("h ω = {}", list(n[0], " to ")),
        text: |n| {
            format!(
                "Below the limit the error is bounded; above it every run grows without bound. The stiffest spring of a scene sets \
                 the largest step, whether it moves or not. RK4 fails at {}; explicit Euler without damping has no stable step. \
                 Keep h ω of the stiffest spring below the limit, or take an implicit method for it.",
                list(n[1], " to ")
            )
        },
        claims: &["stability.limit.oscillator.semi-implicit-euler.f64", "stability.limit.oscillator.rk4.f64"],
        figure: "stability-map-damped-semi-implicit-euler",
    },
];

/// The findings whose claims were made; one that rests on a broken claim says so.
pub(crate) fn findings(sections: &[Section]) -> Vec<Finding> {
    let (mut claims, mut drawn) = (Vec::new(), Vec::new());
    sections.iter().for_each(|section| look(&section.blocks, &mut claims, &mut drawn));
    let find =
        |id: &&str| claims.iter().copied().find(|claim| claim.id == **id || claim.id.starts_with(&format!("{id}.")));
    let finding = |draft: &Draft| {
        let carrying: Vec<&Claim> = draft.claims.iter().map(find).collect::<Option<_>>()?;
        let numbers: Vec<&[f64]> = carrying.iter().map(|claim| &claim.numbers[..]).collect();
        let verdict = if carrying.iter().all(|claim| claim.verdict == Verdict::Holds) {
            ""
        } else {
            " A claim this rests on is broken or untested."
        };
        Some(Finding {
            title: draft.title.to_owned(),
            number: (draft.number)(&numbers),
            text: (draft.text)(&numbers) + verdict,
            figure: drawn.contains(&draft.figure).then(|| draft.figure.to_owned()),
            claim: carrying.first().map(|claim| claim.id.clone()),
        })
    };
    DRAFTS.iter().filter_map(finding).collect()
}

/// The numbers of a claim; "not measured" where a run failed and left none.
fn list(numbers: &[f64], between: &str) -> String {
    if numbers.is_empty() {
        return "not measured".to_owned();
    }
    numbers.iter().map(|&number| digits(number)).collect::<Vec<_>>().join(between)
}

/// The claims and the ids of the figures on the page.
fn look<'a>(blocks: &'a [Block], claims: &mut Vec<&'a Claim>, drawn: &mut Vec<&'a str>) {
    for block in blocks {
        match block {
            Block::Claims(made) => claims.extend(made),
            Block::Figure(figure) => drawn.push(&figure.id),
            Block::Group { blocks, .. } => look(blocks, claims, drawn),
            _ => {}
        }
    }
}

/// A number with four digits, a power of ten where it needs one.
fn digits(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e4 {
        return value.to_string();
    }
    let text = format!("{value:.3e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-3..5).contains(&exponent) {
        return format!("{value:.*}", usize::try_from(3 - exponent).unwrap_or(0));
    }
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised: String =
        exponent.to_string().chars().map(|c| c.to_digit(10).map_or('⁻', |digit| digits[digit as usize])).collect();
    format!("{mantissa} × 10{raised}")
}

#[cfg(test)]
mod tests {
    use super::*;

    // Fails if: a finding is made without one of its claims, or hides that one is broken.
    #[test]
    fn a_finding_needs_its_claims_and_says_when_one_is_broken() {
        let claim = |id: &str, numbers: [f64; 2], verdict| {
            Claim::new("stability", id.to_owned(), Default::default(), verdict).with_numbers(numbers)
        };
        let section = |claims| [Section { blocks: vec![Block::Claims(claims)], ..Section::default() }];
        let semi = claim("stability.limit.oscillator.semi-implicit-euler.f64", [2.0, 2.00542], Verdict::Holds);
        let rk4 = |verdict| claim("stability.limit.oscillator.rk4.f64", [2.82843, 2.83610], verdict);
        assert_eq!(findings(&section(vec![semi.clone()])), []);
        let [holding] = &findings(&section(vec![semi.clone(), rk4(Verdict::Holds)]))[..] else { panic!("one") };
        assert_eq!((holding.number.as_str(), &holding.figure), ("h ω = 2 to 2.005", &None));
        assert!(
            holding.text.contains("RK4 fails at 2.828 to 2.836") && !holding.text.contains("broken"),
            "{holding:?}"
        );
        let [doubtful] = &findings(&section(vec![semi, rk4(Verdict::Broken)]))[..] else { panic!("one") };
        assert!(doubtful.text.contains("broken"), "{doubtful:?}");
    }

    // Fails if: a number has too many digits for a sentence, or a missing one is shown as 0.
    #[test]
    fn numbers_have_four_digits() {
        assert_eq!(list(&[6.246_950_228e-2], ", "), "0.06247");
        assert_eq!(list(&[9.997_478e-1, 1.031_485_804], ", "), "0.9997, 1.031");
        assert_eq!(list(&[4.441e-15, -1.841e-6], "; "), "4.441 × 10⁻¹⁵; -1.841 × 10⁻⁶");
        assert_eq!(list(&[31.0, 32.0], " of "), "31 of 32");
        assert_eq!(list(&[], ", "), "not measured");
    }
}
