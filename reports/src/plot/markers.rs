//! The eight shapes of a point, all of them filled outlines, and the sign of a run that failed.

use super::backend::{Area, Drawn, circle, line, polygon};
use super::sheet::Pixel;
use crate::Marker;
use std::f64::consts::PI;

/// Half the size of a marker in CSS pixels; the shapes are scaled to look equally heavy.
const RADIUS: f64 = 3.6;

/// The outline of a marker, `scale` times as large as usual.
pub(super) fn draw(sheet: &Area<'_>, marker: Marker, at: Pixel, scale: f64) -> Drawn {
    let radius = RADIUS * scale;
    match marker {
        Marker::Circle => sheet.draw(&circle(at, radius)),
        _ => {
            let corner = |[dx, dy]: [f64; 2]| (at.0 + radius * dx, at.1 + radius * dy);
            sheet.draw(&polygon(&outline(marker).into_iter().map(corner).collect::<Vec<_>>()))
        }
    }
}

/// The cross in a ring that stands for a run that failed: no series has this shape.
pub(super) fn draw_failed(sheet: &Area<'_>, (x, y): Pixel) -> Drawn {
    let arm = 3.4;
    sheet.draw(&circle((x, y), 4.8))?;
    sheet.draw(&line(&[(x - arm, y - arm), (x + arm, y + arm)]))?;
    sheet.draw(&line(&[(x - arm, y + arm), (x + arm, y - arm)]))
}

/// Corners in units of the radius, y downwards.
fn outline(marker: Marker) -> Vec<[f64; 2]> {
    // Distances of the corners from the middle, taken in turn, and where the first lies.
    let (distances, corners, start): (&[f64], usize, f64) = match marker {
        Marker::Square => (&[1.27], 4, PI / 4.0),
        Marker::Diamond => (&[1.4], 4, 0.0),
        Marker::Triangle => (&[1.4], 3, -PI / 2.0),
        Marker::InvertedTriangle => (&[1.4], 3, PI / 2.0),
        Marker::Star => (&[1.55, 0.7], 10, -PI / 2.0),
        Marker::Cross => return cross(PI / 4.0),
        Marker::Plus => return cross(0.0),
        Marker::Circle => (&[1.0], 24, 0.0),
    };
    let corner = |(i, r): (usize, &f64)| polar(*r, start + 2.0 * PI * i as f64 / corners as f64);
    distances.iter().cycle().take(corners).enumerate().map(corner).collect()
}

/// Two bars at right angles.
fn cross(turn: f64) -> Vec<[f64; 2]> {
    let (long, half): (f64, f64) = (1.35, 0.3);
    let quarter = [[long, -half], [long, half], [half, half]];
    let corner = |i: usize| {
        let [x, y] = quarter[i % 3];
        polar(x.hypot(y), y.atan2(x) + turn + PI / 2.0 * (i / 3) as f64)
    };
    (0..12).map(corner).collect()
}

fn polar(r: f64, angle: f64) -> [f64; 2] {
    [r * angle.cos(), r * angle.sin()]
}

#[cfg(test)]
mod tests {
    use super::super::sheet::Sheet;
    use super::*;

    #[test]
    fn no_two_shapes_are_the_same() {
        let drawn = Marker::ALL.map(|marker| {
            let mut sheet = Sheet::new((100, 100));
            sheet.path("mark", |area| draw(area, marker, (50.0, 50.0), 1.0));
            sheet.body
        });
        assert!((0..8).all(|i| (0..i).all(|j| drawn[i] != drawn[j])));
    }
}
