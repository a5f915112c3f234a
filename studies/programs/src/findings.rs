//! What a busy reader should take away: a sentence, the claims that carry it with their numbers, the chart that shows it.

use reports::{Block, Claim, Finding, Section, Verdict};

/// A finding before its numbers are known. `{0}`, `{1}`, .. stand for what the claims measured, `{0:count}` for the number of
/// its parts.
struct Draft {
    title: &'static str,
    number: &'static str,
    text: &'static str,
    /// Beginnings of the ids of the claims; without one of them there is no finding.
    claims: &'static [&'static str],
    figure: &'static str,
}

const DRAFTS: [Draft; 4] = [
    Draft {
        title: "Explicit Euler gains energy at every step; semi-implicit Euler keeps it in a band",
        number: "E/E₀ {0}",
        text: "The same two updates in another order. On the oscillator the energy of explicit Euler grows exponentially \
               ({1}), that of semi-implicit Euler stays in the band that theory gives, for ever, for the same one evaluation of the force.",
        claims: &["drift.oscillator.semi-implicit-euler.energy", "drift.oscillator.explicit-euler.energy"],
        figure: "drift-oscillator-energy",
    },
    Draft {
        title: "A spinning body is not a spring: there the advantage is gone, and without the gyroscopic term no step helps",
        number: "order 0 on {1:count} scenes",
        text: "Semi-implicit Euler, too, gains energy on a free asymmetric body, h²/2 times {0} in every step. An engine that \
               leaves the gyroscopic term out makes an error that does not fall with the step at all, on {1:count} scenes.",
        claims: &[
            "rotation.step-law.energy.asymmetric-body.semi-implicit-euler/body-omega",
            "rotation.semi-implicit-euler/without-gyroscopic-term.order-0",
        ],
        figure: "rotation-error-torque-free-spin",
    },
    Draft {
        title: "RK4 is worth its four evaluations: at an error of 0.01 it is cheaper than semi-implicit Euler on almost every scene",
        number: "cheaper on {0} scenes",
        text: "To reach an error of 0.01 m or rad RK4 evaluates the force less often on {0} scenes. At 0.1 semi-implicit Euler can keep up on a \
               third of the scenes, and against implicit Euler it nearly always wins. In f32 no method gets better below a certain step.",
        claims: &["tradeoff.semi-implicit-or-rk4"],
        figure: "work-evaluations-pendulum",
    },
    Draft {
        title: "Semi-implicit Euler breaks at h ω = 2, all at once",
        number: "h ω = {0}",
        text: "Below the limit the error is bounded, above it every run blows up: the stiffest spring of a scene sets the \
               largest step, whether it moves or not. RK4 fails at {1}; explicit Euler without damping has no stable step.",
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
        let filled = |text: &str| {
            carrying
                .iter()
                .enumerate()
                .fold(text.to_owned(), |text, (i, claim)| with_measured(&text, i, &claim.measured))
        };
        let verdict = if carrying.iter().all(|claim| claim.verdict == Verdict::Holds) {
            ""
        } else {
            " A claim this rests on is broken or untested."
        };
        Some(Finding {
            title: draft.title.to_owned(),
            number: filled(draft.number),
            text: filled(draft.text) + verdict,
            figure: drawn.contains(&draft.figure).then(|| draft.figure.to_owned()),
            claim: carrying.first().map(|claim| claim.id.clone()),
        })
    };
    DRAFTS.iter().filter_map(finding).collect()
}

/// The text with what the claim number `i` measured in its place.
fn with_measured(text: &str, i: usize, measured: &str) -> String {
    let parts: Vec<&str> = measured.split("; ").collect();
    text.replace(&format!("{{{i}}}"), &readable(measured)).replace(&format!("{{{i}:count}}"), &parts.len().to_string())
}

/// The claims and the ids of the figures on the page.
fn look<'a>(blocks: &'a [Block], claims: &mut Vec<&'a Claim>, drawn: &mut Vec<&'a str>) {
    for block in blocks {
        match block {
            Block::Claims(made) => claims.extend(made),
            Block::Figure { figure, .. } => drawn.push(&figure.id),
            Block::Group { blocks, .. } => look(blocks, claims, drawn),
            _ => {}
        }
    }
}

/// A text with every number of more than four digits cut to four, and powers of ten written as such.
fn readable(text: &str) -> String {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | '-');
    let mut out = String::new();
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, number) = rest.split_at(start);
        out.push_str(before);
        let end = number.find(|c: char| !is_part(c)).unwrap_or(number.len());
        let digits = number[..end].trim_end_matches(['.', '-', 'e']);
        let long = digits.contains('e') || digits.len() > 5;
        match digits.parse::<f64>() {
            Ok(value) if long => out.push_str(&rounded(value)),
            _ => out.push_str(digits),
        }
        rest = &number[digits.len()..];
    }
    (out + rest).replace(" .. ", " to ")
}

fn rounded(value: f64) -> String {
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

    #[test]
    fn a_finding_needs_its_claims_and_says_when_one_is_broken() {
        let claim = |id: &str, measured: &str, verdict| Claim {
            id: id.to_owned(),
            study: String::new(),
            statement: String::new(),
            theory: String::new(),
            measured: measured.to_owned(),
            bound: String::new(),
            verdict,
        };
        let section = |claims| [Section { blocks: vec![Block::Claims(claims)], ..Section::default() }];
        let semi = claim("stability.limit.oscillator.semi-implicit-euler.f64", "2.00000 .. 2.00542", Verdict::Holds);
        let rk4 = |verdict| claim("stability.limit.oscillator.rk4.f64", "2.82843 .. 2.83610", verdict);
        assert_eq!(findings(&section(vec![semi.clone()])), []);
        let [holding] = &findings(&section(vec![semi.clone(), rk4(Verdict::Holds)]))[..] else { panic!("one") };
        assert_eq!((holding.number.as_str(), &holding.figure), ("h ω = 2.000 to 2.005", &None));
        assert!(
            holding.text.contains("RK4 fails at 2.828 to 2.836") && !holding.text.contains("broken"),
            "{holding:?}"
        );
        let [doubtful] = &findings(&section(vec![semi, rk4(Verdict::Broken)]))[..] else { panic!("one") };
        assert!(doubtful.text.contains("broken"), "{doubtful:?}");
    }

    #[test]
    fn the_words_of_a_list_are_its_first_number_and_its_length() {
        let measured = "attitude (end) 3.997; attitude (max) 3.99812";
        assert_eq!(with_measured("{0:count} parts", 0, measured), "2 parts");
        assert_eq!(with_measured("{1} stays", 0, measured), "{1} stays");
    }

    #[test]
    fn numbers_are_cut_to_four_digits_and_words_are_left() {
        assert_eq!(readable("rate 6.246950228e-2 1/s"), "rate 0.06247 1/s");
        assert_eq!(readable("in [9.997478023e-1, 1.031485804e0]"), "in [0.9997, 1.031]");
        assert_eq!(readable("box 4.441e-15; top -1.841e-6"), "box 4.441 × 10⁻¹⁵; top -1.841 × 10⁻⁶");
        assert_eq!(readable("2.00000 .. 2.00542"), "2.000 to 2.005");
        assert_eq!(readable("at 1024 still, rk4"), "at 1024 still, rk4");
    }
}
