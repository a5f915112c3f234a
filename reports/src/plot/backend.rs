//! plotters draws onto the sheet: its elements become the outlines of one SVG path.
//!
//! The pixel of this backend is a tenth of a CSS pixel, the finest that the sheet writes, so that whole coordinates lose
//! nothing. How an element looks (colour by day and by night, width, dashes) is the class of the path, which the backend
//! holds while the path is drawn; colour and width of plotters' own styles are not used.

use super::sheet::{Pixel, Rect, Sheet};
use super::tenth::{Tenth, tenths};
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Polygon, Rectangle};
use plotters::style::{RGBAColor, ShapeStyle};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, DrawingBackend, DrawingErrorKind};
use std::convert::Infallible;
use std::fmt::{Display, Write as _};

/// One SVG path in the making.
pub(super) struct Backend<'a> {
    sheet: &'a mut Sheet,
    attributes: String,
    outlines: Outlines,
}

/// The whole sheet, in tenths of a CSS pixel from its upper left corner.
pub(super) type Area<'a> = DrawingArea<Backend<'a>, Shift>;

/// What drawing gives; it fails only where one drawing begins inside another.
pub(super) type Drawn = Result<(), DrawingAreaErrorKind<Infallible>>;

/// The style of every element: the class says how it looks.
pub(super) const STYLE: ShapeStyle = ShapeStyle { color: RGBAColor(0, 0, 0, 1.0), filled: true, stroke_width: 1 };

impl Sheet {
    /// Elements of one look as one path; `class` names the look, see `style`.
    pub(super) fn path(&mut self, class: impl Display, elements: impl FnOnce(&Area<'_>) -> Drawn) {
        self.element(format!("class=\"{class}\""), elements);
    }

    /// Areas that share their edges: without the light seams that smoothing leaves between them. `look` is a whole attribute.
    pub(super) fn tiles(&mut self, look: &str, elements: impl FnOnce(&Area<'_>) -> Drawn) {
        self.element(format!("{look} shape-rendering=\"crispEdges\""), elements);
    }

    fn element(&mut self, attributes: String, elements: impl FnOnce(&Area<'_>) -> Drawn) {
        let area = Backend { sheet: self, attributes, outlines: Outlines::default() }.into_drawing_area();
        elements(&area)
            .and_then(|()| area.present())
            .expect("no drawing begins inside another, and text takes every path");
    }

    pub(super) fn line(&mut self, class: impl Display, points: &[Pixel]) {
        self.path(class, |area| area.draw(&line(points)));
    }

    pub(super) fn rect(&mut self, class: impl Display, rect: Rect) {
        self.path(class, |area| area.draw(&rectangle(rect)));
    }
}

/// A line through points of the sheet.
pub(super) fn line(points: &[Pixel]) -> PathElement<BackendCoord> {
    PathElement::new(whole(points), STYLE)
}

/// A closed outline through points of the sheet.
pub(super) fn polygon(corners: &[Pixel]) -> Polygon<BackendCoord> {
    Polygon::new(whole(corners), STYLE)
}

pub(super) fn rectangle(Rect { left, top, right, bottom }: Rect) -> Rectangle<BackendCoord> {
    Rectangle::new([(tenths(left), tenths(top)), (tenths(right), tenths(bottom))], STYLE)
}

pub(super) fn circle((x, y): Pixel, radius: f64) -> Circle<BackendCoord, i32> {
    Circle::new((tenths(x), tenths(y)), tenths(radius), STYLE)
}

fn whole(points: &[Pixel]) -> Vec<BackendCoord> {
    points.iter().map(|&(x, y)| (tenths(x), tenths(y))).collect()
}

type Done = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for Backend<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        let (width, height) = self.sheet.size;
        (10 * width, 10 * height)
    }

    fn ensure_prepared(&mut self) -> Done {
        Ok(())
    }

    /// Writes the path, if anything was drawn.
    fn present(&mut self) -> Done {
        let d = std::mem::take(&mut self.outlines.d);
        if !d.is_empty() {
            let _ = writeln!(self.sheet.body, "<path {} d=\"{d}\"/>", self.attributes);
        }
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, _: BackendColor) -> Done {
        self.outlines.polygon([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]);
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, _: &S) -> Done {
        self.outlines.line([from, to]);
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        _: &S,
        _: bool,
    ) -> Done {
        self.outlines.polygon([(left, top), (right, top), (right, bottom), (left, bottom)]);
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, _: &S) -> Done {
        self.outlines.line(path);
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(&mut self, center: BackendCoord, radius: u32, _: &S, _: bool) -> Done {
        self.outlines.circle(center, radius as i32);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, vert: I, _: &S) -> Done {
        self.outlines.polygon(vert);
        Ok(())
    }
}

/// Outlines as the `d` of an SVG path: from the second point of each on relative, so that no rounding adds up.
#[derive(Default)]
struct Outlines {
    d: String,
}

impl Outlines {
    /// A line through points.
    fn line(&mut self, points: impl IntoIterator<Item = BackendCoord>) {
        let mut points = points.into_iter();
        let Some(mut at) = points.next() else { return };
        let _ = write!(self.d, "M{} {}", Tenth(at.0), Tenth(at.1));
        let mut last = ' ';
        for point in points {
            let step = [Tenth(point.0 - at.0), Tenth(point.1 - at.1)];
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
    }

    /// A closed outline.
    fn polygon(&mut self, corners: impl IntoIterator<Item = BackendCoord>) {
        self.line(corners);
        self.d.push('z');
    }

    fn circle(&mut self, (x, y): BackendCoord, radius: i32) {
        let [left, y, r, across] = [x - radius, y, radius, 2 * radius].map(Tenth);
        let _ = write!(self.d, "M{left} {y}a{r} {r} 0 1 0 {across} 0a{r} {r} 0 1 0 -{across} 0z");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::element::{Drawable, PointCollection};

    /// The `d` of the path that an element becomes on a sheet of 100 by 100 CSS pixels.
    fn drawn<E>(element: &E) -> String
    where
        for<'a> E: Drawable<Backend<'a>>,
        for<'e> &'e E: PointCollection<'e, BackendCoord>,
    {
        let mut sheet = Sheet::new((100, 100));
        sheet.path("line", |area| area.draw(element));
        let d = sheet.body.strip_prefix("<path class=\"line\" d=\"").and_then(|rest| rest.strip_suffix("\"/>\n"));
        d.expect("one path").to_owned()
    }

    /// Every point of a path of M, l, h, v and z in tenths.
    fn places(path: &str) -> Vec<(i32, i32)> {
        let mut places = Vec::new();
        let mut at = (0, 0);
        let parts: Vec<&str> = path.trim_end_matches('z').split_inclusive(|c: char| c.is_ascii_alphabetic()).collect();
        for part in parts.windows(2) {
            let command = part[0].chars().last().expect("a command");
            let numbers = part[1].trim_end_matches(|c: char| c.is_ascii_alphabetic()).replace('-', " -");
            let tenths = |n: &str| (10.0 * n.parse::<f64>().expect("a number")).round() as i32;
            let numbers: Vec<i32> = numbers.split_whitespace().map(tenths).collect();
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
            [(5.0, 17.0), (5.0, 9.7), (12.5, 9.7), (12.5, 10.4), (0.8, 1.0), (0.0, 0.0), (0.3, 8.0)];
        let whole = points.map(|(x, y)| (tenths(x), tenths(y)));
        assert_eq!(places(&drawn(&line(&points))), whole);
        let closed = drawn(&polygon(&points));
        assert!(places(&closed) == whole && closed.ends_with('z'));
        let fine: Vec<Pixel> = (0..1000).map(|i| (0.04 * f64::from(i), 0.06 * f64::from(i))).collect();
        assert_eq!(places(&drawn(&line(&fine))).last(), Some(&(400, 599)));
    }

    #[test]
    fn every_element_of_plotters_is_an_outline_and_its_colour_and_width_are_not_used() {
        let thick = ShapeStyle { color: RGBAColor(200, 10, 10, 0.0), filled: false, stroke_width: 7 };
        let [a, b] = [(10, 20), (35, 60)];
        assert_eq!(drawn(&Rectangle::new([b, a], thick)), "M1 2h2.5v4h-2.5z");
        assert_eq!(drawn(&Circle::new(b, 12, thick)), "M2.3 6a1.2 1.2 0 1 0 2.4 0a1.2 1.2 0 1 0 -2.4 0z");
        assert_eq!(drawn(&PathElement::new([a, b], thick)), "M1 2l2.5 4");
        assert_eq!(drawn(&Polygon::new([a, b, (10, 60)], thick)), "M1 2l2.5 4h-2.5z");
        assert_eq!(drawn(&plotters::element::Pixel::new(a, thick)), "M1 2h.1v.1h-.1z");
    }

    #[test]
    fn what_draws_nothing_leaves_no_path() {
        let mut sheet = Sheet::new((100, 100));
        sheet.path("line", |_| Ok(()));
        sheet.line("line", &[]);
        assert_eq!(sheet.body, "");
    }
}
