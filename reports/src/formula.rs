//! Formulas, written in LaTeX, as MathML: browsers set it without a script or a font of ours.

use crate::Error;
use math_core::{LatexToMathML, MathCoreConfig, MathDisplay};

/// A LaTeX formula as a `<math>` element, displayed on a line of its own.
///
/// # Errors
/// [`Error::Formula`] for a command or a syntax that is not known.
pub fn mathml(latex: &str) -> Result<String, Error> {
    let refuse = |message: String| Error::Formula { latex: latex.to_owned(), message };
    let converter = LatexToMathML::new(MathCoreConfig::default()).map_err(|e| refuse(format!("{e:?}")))?;
    let converted = converter.convert_with_local_state(latex, MathDisplay::Block);
    converted.map(|result| bold_by_style(&result.mathml)).map_err(|e| refuse(format!("{e:?}")))
}

/// Bold Latin letters as letters that the page's style makes bold: few fonts have the code points of their own.
fn bold_by_style(mathml: &str) -> String {
    let plain = |c: char| {
        let (upper, lower) = ((c as u32).wrapping_sub(0x1D400), (c as u32).wrapping_sub(0x1D41A));
        let letter = if upper < 26 { 'A' as u32 + upper } else { 'a' as u32 + lower };
        (upper < 26 || lower < 26).then(|| char::from_u32(letter)).flatten()
    };
    let mut out = String::with_capacity(mathml.len());
    let mut rest = mathml;
    while let Some((before, after)) = rest.split_once("<mi>") {
        out.push_str(before);
        match after.chars().next().and_then(|c| Some((c, plain(c)?))) {
            Some((c, letter)) => {
                out.push_str("<mi class=\"vector\" mathvariant=\"normal\">");
                out.push(letter);
                rest = &after[c.len_utf8()..];
            }
            None => {
                out.push_str("<mi>");
                rest = after;
            }
        }
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_equation_of_motion_keeps_its_dots_signs_and_indices() {
        let math = mathml(r"m\ddot{x}_i = -k x").expect("plain LaTeX");
        for part in ["<math display=\"block\">", "<mi>k</mi>", "<mo>¨</mo>", "−", "<msub>", "</math>"] {
            assert!(math.contains(part), "{part} in {math}");
        }
    }

    #[test]
    fn a_vector_is_a_plain_letter_that_the_style_makes_bold() {
        let math = mathml(r"m \mathbf x = \mathbf F + \mathbf z \mathbf A").expect("plain LaTeX");
        let bold = |c| format!("<mi class=\"vector\" mathvariant=\"normal\">{c}</mi>");
        assert!(["x", "F", "z", "A"].iter().all(|c| math.contains(&bold(c))), "{math}");
        assert!(!math.chars().any(|c| ('\u{1D400}'..'\u{1D434}').contains(&c)), "{math}");
    }

    #[test]
    fn a_formula_that_cannot_be_read_is_named() {
        let message = mathml(r"x = \nosuchthing{y}").expect_err("no such command").to_string();
        assert!(message.contains(r"formula 'x = \nosuchthing{y}'") && message.contains("nosuchthing"), "{message}");
    }
}
