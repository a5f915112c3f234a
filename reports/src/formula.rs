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
    converted.map(|result| result.mathml).map_err(|e| refuse(format!("{e:?}")))
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
    fn a_formula_that_cannot_be_read_is_named() {
        let message = mathml(r"x = \nosuchthing{y}").expect_err("no such command").to_string();
        assert!(message.contains(r"formula 'x = \nosuchthing{y}'") && message.contains("nosuchthing"), "{message}");
    }
}
