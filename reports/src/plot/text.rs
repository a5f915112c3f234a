//! Words: how wide they are in the font that is embedded, and how they are set in lines.

use std::sync::LazyLock;
use ttf_parser::Face;

/// The families a drawing asks for; Verdana has nearly the same widths as the embedded font.
pub(crate) const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";
/// The letters that words are measured with, and drawn with as PNG; no font of the machine is ever asked for.
pub(crate) static FONT: &[u8] = include_bytes!("../../fonts/DejaVuSans-subset.ttf");

/// Width of a text in CSS pixels, without kerning; a letter that the font lacks counts 0.65 em.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    static FACE: LazyLock<Option<Face<'static>>> = LazyLock::new(|| Face::parse(FONT, 0).ok());
    let em = |letter: char| {
        let face = FACE.as_ref()?;
        let advance = face.glyph_hor_advance(face.glyph_index(letter)?)?;
        Some(f64::from(advance) / f64::from(face.units_per_em()))
    };
    size * text.chars().map(|letter| em(letter).unwrap_or(0.65)).sum::<f64>()
}

/// Words set in lines no wider than `width` CSS pixels. A word that is wider is broken; nothing is left out.
pub(super) fn wrap(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => *line = format!("{line} {word}"),
            _ => lines.extend(broken(word, size, width)),
        }
    }
    lines
}

/// A word in pieces no wider than `width`, each of at least one letter.
fn broken(word: &str, size: f64, width: f64) -> Vec<String> {
    let mut pieces = vec![String::new()];
    for letter in word.chars() {
        let last = pieces
            .last_mut()
            .filter(|piece| piece.is_empty() || text_width(&format!("{piece}{letter}"), size) <= width);
        match last {
            Some(piece) => piece.push(letter),
            None => pieces.push(letter.to_string()),
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    // DejaVu Sans: advances of 1401 (A), 569 (i), 651 (blank), 1716 (minus) in 2048 units per em, from its `hmtx` table.
    #[test]
    fn words_are_as_wide_as_the_advances_of_their_letters() {
        assert_eq!(text_width("Ai −", 2048.0), 1401.0 + 569.0 + 651.0 + 1716.0);
        assert_eq!(text_width("\u{4e00}", 100.0), 65.0);
    }

    #[test]
    fn lines_keep_to_their_width_and_lose_no_letter() {
        let text = "a step of semi-implicit-Euler with a veryveryverylongword, and more";
        for width in [1.0, 20.0, 60.0, 200.0, 1e6] {
            let lines = wrap(text, 13.0, width);
            assert!(lines.iter().all(|l| text_width(l, 13.0) <= width || l.chars().count() == 1), "{lines:?}");
            let letters = |text: &str| text.split_whitespace().collect::<String>();
            assert_eq!(letters(&lines.concat()), letters(text));
        }
        assert!(wrap("", 13.0, 100.0).is_empty());
    }
}
