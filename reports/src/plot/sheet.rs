//! The sheet: SVG written as it is meant. Lengths are CSS pixels, written to a tenth.

use super::text::wrap;
use std::fmt::{Display, Write as _};

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

    /// The box of this size around a point.
    pub(super) fn around((x, y): Pixel, width: f64, height: f64) -> Self {
        Self { left: x - width / 2.0, right: x + width / 2.0, top: y - height / 2.0, bottom: y + height / 2.0 }
    }
}

/// What is drawn, back to front, as SVG elements.
#[derive(Default)]
pub(super) struct Sheet {
    pub(super) body: String,
}

impl Sheet {
    /// Outlines of one look; `class` names it, see `style`.
    pub(super) fn path(&mut self, class: impl Display, path: &Path) {
        self.element(format_args!("class=\"{class}\""), path);
    }

    /// Areas that share their edges: without the light seams that smoothing leaves between them. `look` is a whole attribute.
    pub(super) fn tiles(&mut self, look: &str, path: &Path) {
        self.element(format_args!("{look} shape-rendering=\"crispEdges\""), path);
    }

    fn element(&mut self, attributes: impl Display, path: &Path) {
        if !path.d.is_empty() {
            let _ = writeln!(self.body, "<path {attributes} d=\"{}\"/>", path.d);
        }
    }

    pub(super) fn line(&mut self, class: impl Display, points: &[Pixel]) {
        self.path(class, &Path::default().line(points));
    }

    pub(super) fn rect(&mut self, class: impl Display, area: Rect) {
        self.path(class, &Path::default().rect(area));
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

/// A length in whole tenths of a CSS pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tenth(i64);

impl Tenth {
    fn of(pixels: f64) -> Self {
        Self((10.0 * pixels).round() as i64)
    }
}

impl Display for Tenth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (sign, size) = (if self.0 < 0 { "-" } else { "" }, self.0.unsigned_abs());
        match (size / 10, size % 10) {
            (whole, 0) => write!(f, "{sign}{whole}"),
            (0, part) => write!(f, "{sign}.{part}"),
            (whole, part) => write!(f, "{sign}{whole}.{part}"),
        }
    }
}

/// Outlines as the `d` of an SVG path: from the second point of each on relative, so that no rounding adds up.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Path {
    d: String,
}

impl Path {
    /// A line through points.
    #[must_use]
    pub(super) fn line(mut self, points: &[Pixel]) -> Self {
        let mut points = points.iter().map(|&(x, y)| (Tenth::of(x), Tenth::of(y)));
        let Some(mut at) = points.next() else { return self };
        let _ = write!(self.d, "M{} {}", at.0, at.1);
        let mut last = ' ';
        for point in points {
            let step = [Tenth(point.0.0 - at.0.0), Tenth(point.1.0 - at.1.0)];
            at = point;
            let (command, values) = match step {
                [Tenth(0), Tenth(0)] => continue,
                [_, Tenth(0)] => ('h', &step[..1]),
                [Tenth(0), _] => ('v', &step[1..]),
                _ => ('l', &step[..]),
            };
            if command != last {
                self.d.push(command);
            }
            for (i, value) in values.iter().enumerate() {
                let gap = if value.0 >= 0 && (i > 0 || command == last) { " " } else { "" };
                let _ = write!(self.d, "{gap}{value}");
            }
            last = command;
        }
        self
    }

    /// A closed outline.
    #[must_use]
    pub(super) fn polygon(self, corners: &[Pixel]) -> Self {
        let mut closed = self.line(corners);
        closed.d.push('z');
        closed
    }

    #[must_use]
    pub(super) fn rect(self, Rect { left, top, right, bottom }: Rect) -> Self {
        self.polygon(&[(left, top), (right, top), (right, bottom), (left, bottom)])
    }

    #[must_use]
    pub(super) fn circle(mut self, (x, y): Pixel, radius: f64) -> Self {
        let (r, across) = (Tenth::of(radius), Tenth(2 * Tenth::of(radius).0));
        let left = Tenth(Tenth::of(x).0 - r.0);
        let _ = write!(self.d, "M{left} {}a{r} {r} 0 1 0 {across} 0a{r} {r} 0 1 0 -{across} 0z", Tenth::of(y));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every point of a path of M, l, h, v and z in tenths.
    fn places(path: &str) -> Vec<(i64, i64)> {
        let mut places = Vec::new();
        let mut at = (0, 0);
        let parts: Vec<&str> = path.trim_end_matches('z').split_inclusive(|c: char| c.is_ascii_alphabetic()).collect();
        for part in parts.windows(2) {
            let command = part[0].chars().last().expect("a command");
            let numbers = part[1].trim_end_matches(|c: char| c.is_ascii_alphabetic()).replace('-', " -");
            let tenths = |n: &str| (10.0 * n.parse::<f64>().expect("a number")).round() as i64;
            let numbers: Vec<i64> = numbers.split_whitespace().map(tenths).collect();
            for step in numbers.chunks(if matches!(command, 'h' | 'v') { 1 } else { 2 }) {
                at = match command {
                    'M' => (step[0], step[1]),
                    'h' => (at.0 + step[0], at.1),
                    'v' => (at.0, at.1 + step[0]),
                    _ => (at.0 + step[0], at.1 + step[1]),
                };
                places.push(at);
            }
        }
        places
    }

    #[test]
    fn a_path_goes_through_its_points_and_no_rounding_adds_up() {
        let points: [Pixel; 7] =
            [(5.0, 7.0), (5.0, -0.3), (12.5, -0.3), (12.5, 0.4), (-0.8, -9.0), (0.0, 0.0), (0.3, -2.0)];
        let tenths = points.map(|(x, y)| ((10.0 * x).round() as i64, (10.0 * y).round() as i64));
        assert_eq!(places(&Path::default().line(&points).d), tenths);
        let closed = Path::default().polygon(&points).d;
        assert!(places(&closed) == tenths && closed.ends_with('z'));
        let fine: Vec<Pixel> = (0..1000).map(|i| (0.04 * f64::from(i), 0.06 * f64::from(i))).collect();
        assert_eq!(places(&Path::default().line(&fine).d).last(), Some(&(400, 599)));
    }

    #[test]
    fn words_are_escaped_and_what_xml_cannot_carry_is_left_out() {
        assert_eq!(escape("a < b & c\u{0}\u{7f}\u{ffff}\n> d"), "a &lt; b &amp; c\n&gt; d");
    }
}
