//! Slope triangles: set beside the data of their slope, over nothing that is already there.

use super::backend::polygon;
use super::frame::Frame;
use super::layers;
use super::sheet::{Anchor, Pixel, Rect, Sheet};
use super::taken::Taken;
use crate::{Figure, Layer, Scale};

/// Size of the number.
const SIZE: f64 = 12.0;

/// A slope triangle on the sheet: `start` is the end of the hypotenuse with the smaller x, and the right angle lies
/// below the hypotenuse (at the right) or above it (at the left).
#[derive(Clone, Copy)]
struct Triangle {
    start: Pixel,
    width: f64,
    height: f64,
    below: bool,
}

impl Triangle {
    fn corners(&self) -> [Pixel; 3] {
        let (x, y) = self.start;
        let end = (x + self.width, y - self.height);
        [self.start, end, if self.below { (end.0, y) } else { (x, end.1) }]
    }

    /// Middle of the number beside the upright leg.
    fn number(&self) -> Pixel {
        let (x, y) = self.start;
        let x = if self.below { x + self.width + 9.0 } else { x - 9.0 };
        (x, y - self.height / 2.0)
    }

    fn bounds(&self) -> Rect {
        let (x, y) = self.start;
        let (left, right) = if self.below { (0.0, 18.0) } else { (18.0, 0.0) };
        let (top, bottom) = ((y - self.height).min(y), y.max(y - self.height));
        Rect { left: x - left, top, right: x + self.width + right, bottom }
    }

    /// Whether a point lies in the triangle, in its number or within a few pixels of either.
    fn touches(&self, (px, py): Pixel) -> bool {
        let room = 7.0;
        let Rect { left, top, right, bottom } = self.bounds();
        if px < left - room || px > right + room || py < top - room || py > bottom + room {
            return false;
        }
        // Signed distance from the hypotenuse, positive on the side of the right angle.
        let (dx, dy) = (px - self.start.0, py - self.start.1);
        let (w, h) = (self.width, -self.height);
        let distance = (dy * w - dx * h) / w.hypot(h) * if self.below { 1.0 } else { -1.0 };
        distance > -room
    }
}

/// Draws the triangles of a figure, if both its axes are logarithmic.
pub(super) fn draw(sheet: &mut Sheet, frame: &Frame, figure: &Figure, taken: &mut Taken) {
    if (frame.x.scale, frame.y.scale) != (Scale::Log, Scale::Log) {
        return;
    }
    for layer in &figure.layers {
        if let Layer::SlopeTriangle { order } = layer {
            one(sheet, frame, figure, *order, taken);
        }
    }
}

/// Draws a triangle beside the data whose slope is nearest to the order, or anywhere free.
fn one(sheet: &mut Sheet, frame: &Frame, figure: &Figure, order: f64, taken: &mut Taken) {
    let per_decade_x = frame.area.width() / (frame.x.high - frame.x.low);
    let per_decade_y = frame.area.height() / (frame.y.high - frame.y.low);
    let rise = order * per_decade_y / per_decade_x;
    if !(rise.is_finite() && rise != 0.0) {
        return;
    }
    // As wide as 52 CSS pixels, unless it would then be higher than 64.
    let width = 52.0_f64.min(64.0 / rise.abs());
    let size = (width, width * rise);
    let area = frame.area;
    let room = Rect { left: area.left + 2.0, top: area.top + 20.0, right: area.right - 2.0, bottom: area.bottom - 2.0 };
    let fits = candidates(frame, figure, order, size).into_iter().filter(|t| t.bounds().inside(&room));
    let Some(best) = fits.min_by_key(|t| taken.cost(&t.bounds(), |p| t.touches(p))) else { return };
    sheet.path("axis", |area| area.draw(&polygon(&best.corners())));
    let Rect { left, top, right, bottom } = best.bounds();
    taken.boxes.push(Rect { left: left - 2.0, right: right + 2.0, top: top - 6.0, bottom: bottom + 6.0 });
    sheet.text("fi", &number(order), best.number(), SIZE, Anchor::Middle);
}

fn number(order: f64) -> String {
    let text = format!("{order}").replace('-', "−");
    if text.len() > 5 { format!("{order:.2}").replace('-', "−") } else { text }
}

/// Triangles to choose from, the most wanted first: near segments of about this slope, then all over the frame.
fn candidates(frame: &Frame, figure: &Figure, order: f64, (width, height): (f64, f64)) -> Vec<Triangle> {
    let mut spots: Vec<Triangle> = Vec::new();
    let length = width.hypot(height);
    for away in [11.0, 16.0, 22.0, 30.0, 40.0] {
        for middle in steep(frame, figure, order) {
            for below in [true, false] {
                let side = if below { 1.0 } else { -1.0 } * away / length;
                let x = middle.0 - width / 2.0 + side * height;
                let y = middle.1 + height / 2.0 + side * width;
                spots.push(Triangle { start: (x, y), width, height, below });
            }
        }
    }
    let area = frame.area;
    let place = |part: i32, from: f64, length: f64| from + length * f64::from(part) / 16.0;
    let grid = |i, j| (place(i, area.left, area.width()), place(j, area.top, area.height()));
    let row = |j| (1..16).rev().map(move |i| Triangle { start: grid(i, j), width, height, below: true });
    spots.extend((1..16).rev().flat_map(row));
    spots
}

/// Middles of the segments whose slope is that of the order, middle ones of a series first.
fn steep(frame: &Frame, figure: &Figure, order: f64) -> Vec<Pixel> {
    let mut found = Vec::new();
    for series in layers::series(figure) {
        let mapped: Vec<_> = series.points.iter().map(|&p| frame.mapped(p)).collect();
        let middles = mapped.windows(2).filter_map(|pair| {
            let (a, b) = (pair[0]?, pair[1]?);
            let slope = (b[1] - a[1]) / (b[0] - a[0]);
            let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            ((slope - order).abs() < 0.2 && frame.window().contains(middle)).then(|| frame.pixel(middle))
        });
        let middles: Vec<Pixel> = middles.collect();
        let centre = middles.len() / 2;
        found.extend(middles.into_iter().enumerate().map(|(i, at)| (i.abs_diff(centre), at)));
    }
    found.sort_by_key(|&(rank, _)| rank);
    found.into_iter().map(|(_, at)| at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_knows_what_lies_over_it() {
        let t = Triangle { start: (250.0, 250.0), width: 50.0, height: 25.0, below: true };
        assert!(t.touches((287.5, 247.5)) && t.touches((275.0, 235.0)) && t.touches((309.0, 237.5)));
        assert!(!t.touches((262.5, 225.0)) && !t.touches((350.0, 237.5)) && !t.touches((275.0, 275.0)));
        let above = Triangle { below: false, ..t };
        assert!(above.touches((262.5, 227.5)) && !above.touches((287.5, 247.5)));
    }

    #[test]
    fn orders_are_named_without_needless_digits() {
        assert_eq!([4.0, 1.5, -2.0, 1.0 / 3.0].map(number), ["4", "1.5", "−2", "0.33"]);
    }
}
