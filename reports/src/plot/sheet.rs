//! The sheet: its SVG, and the words on it; outlines come from `backend`. Lengths are CSS pixels, written to a tenth.

use super::tenth::{Tenth, tenths};
use super::text::wrap;
use std::fmt::Write as _;

/// A point on the sheet: from the left, from the top.
pub(super) type Pixel = (f64, f64);

/// Where words have their anchor; upright it is always the middle of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A rectangle on the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Rect {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub(super) fn middle(&self) -> Pixel {
        (0.5 * (self.left + self.right), 0.5 * (self.top + self.bottom))
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    pub(super) fn contains(&self, (x, y): Pixel) -> bool {
        self.left <= x && x <= self.right && self.top <= y && y <= self.bottom
    }

    pub(super) fn inside(&self, outer: &Self) -> bool {
        outer.contains((self.left, self.top)) && outer.contains((self.right, self.bottom))
    }

    /// The same with its edges on whole tenths of a pixel.
    pub(super) fn in_tenths(&self) -> Self {
        let [left, top, right, bottom] =
            [self.left, self.top, self.right, self.bottom].map(|edge| f64::from(tenths(edge)) / 10.0);
        Self { left, top, right, bottom }
    }

    /// The box of this size around a point.
    pub(super) fn around((x, y): Pixel, width: f64, height: f64) -> Self {
        Self { left: x - width / 2.0, right: x + width / 2.0, top: y - height / 2.0, bottom: y + height / 2.0 }
    }
}

/// What is drawn, back to front, as SVG elements.
pub(super) struct Sheet {
    /// Width and height in CSS pixels.
    pub(super) size: (u32, u32),
    pub(super) body: String,
}

impl Sheet {
    pub(super) fn new(size: (u32, u32)) -> Self {
        Self { size, body: String::new() }
    }

    /// A line of words, the middle of its height at `at`.
    pub(super) fn text(&mut self, class: &str, words: &str, (x, y): Pixel, size: f64, anchor: Anchor) {
        let place = format!("x=\"{}\" y=\"{}\"", Tenth::of(x), Tenth::of(y + MIDDLE * size));
        self.words(class, words, &place, size, anchor);
    }

    /// A line of words that runs upwards, its middle at `at`.
    pub(super) fn upright_text(&mut self, class: &str, words: &str, (x, y): Pixel, size: f64) {
        let place = format!(
            "y=\"{}\" transform=\"translate({} {})rotate(-90)\"",
            Tenth::of(MIDDLE * size),
            Tenth::of(x),
            Tenth::of(y)
        );
        self.words(class, words, &place, size, Anchor::Middle);
    }

    fn words(&mut self, class: &str, words: &str, place: &str, size: f64, anchor: Anchor) {
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let words = escape(words);
        let _ = writeln!(self.body, "<text class=\"{class}\" font-size=\"{size}\" {place}{anchor}>{words}</text>");
    }

    /// Words in lines no wider than `width`, the middle of the first at `at`; gives the middle of the line after the last.
    pub(super) fn paragraph(&mut self, words: &str, (x, mut y): Pixel, size: f64, width: f64) -> f64 {
        for line in wrap(words, size, width) {
            self.text("fi", &line, (x, y), size, Anchor::Start);
            y += 1.3 * size;
        }
        y
    }
}

/// From the middle of the capital letters down to the base line, in em.
const MIDDLE: f64 = 0.36;

/// Text as it may stand between tags, without the characters that XML cannot carry.
pub(super) fn escape(text: &str) -> String {
    let carried = |&c: &char| !(c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}')) || c == '\n' || c == '\t';
    let text: String = text.chars().filter(carried).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_escaped_and_what_xml_cannot_carry_is_left_out() {
        assert_eq!(escape("a < b & c\u{0}\u{7f}\u{ffff}\n> d"), "a &lt; b &amp; c\n&gt; d");
    }
}
