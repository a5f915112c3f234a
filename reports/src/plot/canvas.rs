//! The sheet a figure is drawn on: pixels, colours, strokes and letters.
//!
//! Everything is drawn in units of a quarter of a CSS pixel, because the drawing library knows whole units only;
//! the header of the finished drawing is rewritten to the true size.

use super::axis::AxisMap;
use super::clip::{Point, Window};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontFamily, register_font};
use std::fmt::Write as _;
use std::sync::OnceLock;

/// Units of the drawing in a CSS pixel.
pub(super) const UNITS: f64 = 4.0;
/// What a drawing step of the library may say.
pub(super) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;
/// A point on the sheet, in units.
pub(super) type Pixel = (i32, i32);
/// Where a text has its anchor.
pub(super) const LEFT: Pos = Pos { h_pos: HPos::Left, v_pos: VPos::Center };
pub(super) const CENTER: Pos = Pos { h_pos: HPos::Center, v_pos: VPos::Center };
pub(super) const RIGHT: Pos = Pos { h_pos: HPos::Right, v_pos: VPos::Center };

pub(super) const INK: RGBColor = RGBColor(0x26, 0x26, 0x26);
pub(super) const GREY: RGBColor = RGBColor(0x5C, 0x5C, 0x5C);

/// Okabe and Ito, "Color Universal Design" (2008), told apart with any colour vision; its yellow, too light for a line
/// on white, is replaced by a dark purple, its orange, pink and sky blue are darkened for the same reason.
pub(super) const PALETTE: [RGBColor; 8] = [
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xC7, 0x6F, 0xA0),
    RGBColor(0x1A, 0x1A, 0x1A),
    RGBColor(0xB8, 0x86, 0x00),
    RGBColor(0x2E, 0x97, 0xCC),
    RGBColor(0x6A, 0x3D, 0x9A),
];

pub(super) fn palette(index: usize) -> RGBColor {
    PALETTE[index % PALETTE.len()]
}

/// The name the drawing gives for its letters; the embedded font is registered under it, so that what is measured is
/// what is meant. Verdana has nearly the same widths.
pub(crate) const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";
pub(crate) static FONT: &[u8] = include_bytes!("../../fonts/DejaVuSans-subset.ttf");

/// Makes the embedded font known to the drawing library; no font of the machine is ever asked for.
pub(super) fn prepare_font() -> Result<(), String> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let registered = REGISTERED.get_or_init(|| register_font(FAMILY, FontStyle::Normal, FONT).is_ok());
    registered.then_some(()).ok_or_else(|| "the embedded font cannot be read".to_owned())
}

/// The library divides the size it is given by 1.24 before writing it, hence the factor.
pub(super) fn font(pixels: f64) -> FontDesc<'static> {
    FontDesc::new(FontFamily::Name(FAMILY), pixels * UNITS * 1.24, FontStyle::Normal)
}

/// Width of a text in CSS pixels.
pub(super) fn text_width(text: &str, pixels: f64) -> f64 {
    // It measures with the height of a line (1.164 em in this font) where it writes 1.24.
    let measured = font(pixels).box_size(text).map(|(width, _)| f64::from(width) * 1.164 / 1.24 / UNITS);
    measured.unwrap_or(0.65 * pixels * text.chars().count() as f64)
}

/// Words set in lines no wider than `width` CSS pixels; a single word may be wider.
pub(super) fn wrap(text: &str, pixels: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), pixels) <= width => *line = format!("{line} {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The text, cut with an ellipsis where it is wider than `width` CSS pixels.
pub(super) fn shorten(text: &str, pixels: f64, width: f64) -> String {
    if text_width(text, pixels) <= width {
        return text.to_owned();
    }
    let mut kept: Vec<char> = text.chars().collect();
    while kept.pop().is_some() {
        let cut: String = kept.iter().collect::<String>().trim_end().to_owned() + "…";
        if text_width(&cut, pixels) <= width {
            return cut;
        }
    }
    String::new()
}

pub(super) fn units(pixels: f64) -> i32 {
    (pixels * UNITS).round() as i32
}

/// Line of a width in CSS pixels.
pub(super) fn stroke(color: impl Into<RGBAColor>, pixels: f64) -> ShapeStyle {
    color.into().stroke_width(units(pixels).max(1) as u32)
}

/// Greater than every width, dash and gap in units: what tells them apart in one number.
const CODE: u32 = 100;

/// The drawing with every width that tells the lengths of dash and gap taken apart.
pub(super) fn with_dashes(drawing: &str) -> String {
    const WIDTH: &str = "stroke-width=\"";
    let mut parts = drawing.split(WIDTH);
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find('"').unwrap_or(0);
        let code: u32 = part[..end].parse().unwrap_or(0);
        let (dash, width) = (code / CODE, code % CODE);
        let _ = write!(out, "{WIDTH}{width}");
        if dash > 0 {
            let _ = write!(out, "\" stroke-dasharray=\"{} {}", dash % CODE, dash / CODE);
        }
        out.push_str(&part[end..]);
    }
    out
}

/// A rectangle on the sheet, in units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) left: i32,
    pub(super) top: i32,
    pub(super) right: i32,
    pub(super) bottom: i32,
}

impl Rect {
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    pub(super) fn contains(&self, (x, y): Pixel) -> bool {
        self.left <= x && x <= self.right && self.top <= y && y <= self.bottom
    }

    pub(super) fn inside(&self, outer: &Self) -> bool {
        outer.contains((self.left, self.top)) && outer.contains((self.right, self.bottom))
    }

    /// The box of a text of `width` by `height` CSS pixels around or beside an anchor point.
    pub(super) fn of_text((x, y): Pixel, width: f64, height: f64, anchor: HPos) -> Self {
        let left = match anchor {
            HPos::Left => x,
            HPos::Center => x - units(width / 2.0),
            HPos::Right => x - units(width),
        };
        Self { left, top: y - units(height / 2.0), right: left + units(width), bottom: y + units(height / 2.0) }
    }
}

/// Where the axes lie on the sheet.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) area: Rect,
    pub(super) x: AxisMap,
    pub(super) y: AxisMap,
}

impl Frame {
    pub(super) fn window(&self) -> Window {
        Window { low: [self.x.low, self.y.low], high: [self.x.high, self.y.high] }
    }

    /// A data point in mapped coordinates, or `None` if it cannot be shown.
    pub(super) fn mapped(&self, [x, y]: Point) -> Option<Point> {
        Some([self.x.map_value(x)?, self.y.map_value(y)?])
    }

    /// The unit on the sheet of a point in mapped coordinates.
    pub(super) fn pixel(&self, [x, y]: Point) -> Pixel {
        (self.column(x), self.row(y))
    }

    pub(super) fn column(&self, x: f64) -> i32 {
        use plotters::coord::ranged1d::Ranged;
        self.x.map(&x, (self.area.left, self.area.right))
    }

    pub(super) fn row(&self, y: f64) -> i32 {
        use plotters::coord::ranged1d::Ranged;
        self.y.map(&y, (self.area.bottom, self.area.top))
    }
}

/// The sheet with its frame.
pub(super) struct Canvas<'a> {
    pub(super) root: DrawingArea<SVGBackend<'a>, Shift>,
    pub(super) frame: Frame,
}

impl Canvas<'_> {
    pub(super) fn line(&self, points: Vec<Pixel>, style: ShapeStyle) -> Drawn {
        self.root.draw(&PathElement::new(points, style))
    }

    /// A line of dashes. The library would draw every dash as a line of its own; it is given one line whose width tells the
    /// lengths of dash and gap, see [`with_dashes`].
    pub(super) fn dashed(&self, points: Vec<Pixel>, on: f64, off: f64, style: ShapeStyle) -> Drawn {
        let [on, off] = [on, off].map(|length| units(length).clamp(1, CODE as i32 - 1) as u32);
        self.line(points, ShapeStyle { stroke_width: (off * CODE + on) * CODE + style.stroke_width, ..style })
    }

    pub(super) fn fill(&self, points: Vec<Pixel>, color: impl Into<RGBAColor>) -> Drawn {
        self.root.draw(&Polygon::new(points, color.into().filled()))
    }

    pub(super) fn rect(&self, area: Rect, style: impl Into<ShapeStyle>) -> Drawn {
        self.root.draw(&Rectangle::new([(area.left, area.top), (area.right, area.bottom)], style))
    }

    pub(super) fn text(&self, text: &str, at: Pixel, pixels: f64, color: RGBColor, anchor: Pos) -> Drawn {
        self.root.draw(&Text::new(text.to_owned(), at, font(pixels).color(&color).pos(anchor)))
    }
}
