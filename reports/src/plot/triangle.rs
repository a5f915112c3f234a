//! Slope triangles: set beside the data of their slope, over nothing that is already there.

use super::canvas::{Canvas, Drawn, INK, Pixel, Rect, UNITS, stroke, units};
use super::place::{SIZE, Taken};
use crate::{Figure, Layer};
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// A slope triangle on the sheet: `start` is the end of the hypotenuse with the smaller x, and the right angle lies
/// below the hypotenuse (at the right) or above it (at the left).
#[derive(Clone, Copy)]
struct Triangle {
    start: Pixel,
    width: i32,
    height: i32,
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
        let x = if self.below { x + self.width + units(9.0) } else { x - units(9.0) };
        (x, y - self.height / 2)
    }

    fn bounds(&self) -> Rect {
        let (x, y) = self.start;
        let (left, right) = if self.below { (0, units(18.0)) } else { (units(18.0), 0) };
        let (top, bottom) = ((y - self.height).min(y), y.max(y - self.height));
        Rect { left: x - left, top, right: x + self.width + right, bottom }
    }

    /// Whether a point lies in the triangle, in its number or within a few pixels of either.
    fn touches(&self, (px, py): Pixel) -> bool {
        let room = units(7.0);
        let Rect { left, top, right, bottom } = self.bounds();
        if px < left - room || px > right + room || py < top - room || py > bottom + room {
            return false;
        }
        // Signed distance from the hypotenuse, positive on the side of the right angle.
        let (dx, dy) = (f64::from(px - self.start.0), f64::from(py - self.start.1));
        let (w, h) = (f64::from(self.width), f64::from(-self.height));
        let distance = (dy * w - dx * h) / w.hypot(h) * if self.below { 1.0 } else { -1.0 };
        distance > -f64::from(room)
    }
}

/// Draws the triangle beside the data whose slope is nearest to the order, or anywhere free.
pub(super) fn draw(canvas: &Canvas<'_>, figure: &Figure, order: f64, taken: &mut Taken) -> Drawn {
    let frame = &canvas.frame;
    let per_decade_x = f64::from(frame.area.right - frame.area.left) / (frame.x.high - frame.x.low);
    let per_decade_y = f64::from(frame.area.bottom - frame.area.top) / (frame.y.high - frame.y.low);
    let rise = order * per_decade_y / per_decade_x;
    if !(rise.is_finite() && rise != 0.0) {
        return Ok(());
    }
    // As wide as 52 CSS pixels, unless it would then be higher than 64.
    let width = (52.0 * UNITS).min(64.0 * UNITS / rise.abs());
    let (width, height) = (width.round() as i32, (width * rise).round() as i32);
    let cost = |t: &Triangle| {
        let over = taken.points.iter().filter(|&&p| t.touches(p)).count();
        over + 50 * taken.boxes.iter().filter(|other| other.overlaps(&t.bounds())).count()
    };
    let room = Rect {
        left: frame.area.left + 8,
        top: frame.area.top + units(20.0),
        right: frame.area.right - 8,
        bottom: frame.area.bottom - 8,
    };
    let fits = candidates(canvas, figure, order, width, height).into_iter().filter(|t| t.bounds().inside(&room));
    let Some(best) = fits.min_by_key(cost) else { return Ok(()) };
    let [a, b, c] = best.corners();
    canvas.line(vec![a, b, c, a, b], stroke(INK, 1.0))?;
    let bounds = best.bounds();
    taken.boxes.push(Rect {
        left: bounds.left - 8,
        right: bounds.right + 8,
        top: bounds.top - 24,
        bottom: bounds.bottom + 24,
    });
    canvas.text(&number(order), best.number(), SIZE, INK, Pos::new(HPos::Center, VPos::Center))
}

fn number(order: f64) -> String {
    let text = format!("{order}").replace('-', "−");
    if text.len() > 5 { format!("{order:.2}").replace('-', "−") } else { text }
}

/// Triangles to choose from, the most wanted first: near segments of about this slope, then all over the frame.
fn candidates(canvas: &Canvas<'_>, figure: &Figure, order: f64, width: i32, height: i32) -> Vec<Triangle> {
    let mut spots: Vec<Triangle> = Vec::new();
    let length = f64::from(width).hypot(f64::from(height));
    for away in [11.0, 16.0, 22.0, 30.0, 40.0] {
        for middle in steep(canvas, figure, order) {
            for below in [true, false] {
                let side = if below { 1.0 } else { -1.0 } * away * UNITS / length;
                let x = f64::from(middle.0 - width / 2) + side * f64::from(height);
                let y = f64::from(middle.1 + height / 2) + side * f64::from(width);
                spots.push(Triangle { start: (x.round() as i32, y.round() as i32), width, height, below });
            }
        }
    }
    let area = canvas.frame.area;
    let grid =
        |i: i32, j: i32| (area.left + (area.right - area.left) * i / 16, area.top + (area.bottom - area.top) * j / 16);
    spots.extend(
        (1..16)
            .rev()
            .flat_map(|j| (1..16).rev().map(move |i| Triangle { start: grid(i, j), width, height, below: true })),
    );
    spots
}

/// Middles of the segments whose slope is that of the order, middle ones of a series first.
fn steep(canvas: &Canvas<'_>, figure: &Figure, order: f64) -> Vec<Pixel> {
    let frame = &canvas.frame;
    let mut found = Vec::new();
    for layer in &figure.layers {
        let Layer::Series(series) = layer else { continue };
        let mapped: Vec<_> = series.points.iter().map(|&p| frame.mapped(p)).collect();
        let middles = mapped.windows(2).filter_map(|pair| {
            let (a, b) = (pair[0]?, pair[1]?);
            let slope = (b[1] - a[1]) / (b[0] - a[0]);
            let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            ((slope - order).abs() < 0.2 && frame.window().contains(middle)).then(|| frame.pixel(middle))
        });
        let middles: Vec<Pixel> = middles.collect();
        let centre = middles.len() as i64 / 2;
        let ranked = middles.into_iter().enumerate().map(|(i, at)| ((i as i64 - centre).abs(), at));
        found.extend(ranked);
    }
    found.sort_by_key(|&(rank, _)| rank);
    found.into_iter().map(|(_, at)| at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_knows_what_lies_over_it() {
        let t = Triangle { start: (1000, 1000), width: 200, height: 100, below: true };
        assert!(t.touches((1150, 990)) && t.touches((1100, 940)) && t.touches((1236, 950)));
        assert!(!t.touches((1050, 900)) && !t.touches((1400, 950)) && !t.touches((1100, 1100)));
        let above = Triangle { below: false, ..t };
        assert!(above.touches((1050, 910)) && !above.touches((1150, 990)));
    }

    #[test]
    fn orders_are_named_without_needless_digits() {
        assert_eq!([4.0, 1.5, -2.0, 1.0 / 3.0].map(number), ["4", "1.5", "−2", "0.33"]);
    }
}
