//! The eight shapes of a point.

use super::canvas::{Canvas, Drawn, Pixel, UNITS, stroke, units};
use crate::Marker;
use plotters::prelude::*;
use std::f64::consts::PI;

/// Half the size of a marker in CSS pixels; the shapes are scaled to look equally heavy.
const RADIUS: f64 = 3.6;

/// Draws one marker. A thin white edge keeps markers apart where they overlap.
pub(super) fn draw(canvas: &Canvas<'_>, marker: Marker, at: Pixel, color: RGBColor) -> Drawn {
    match marker {
        Marker::Circle => {
            canvas.root.draw(&Circle::new(at, units(RADIUS + 0.7), WHITE.filled()))?;
            canvas.root.draw(&Circle::new(at, units(RADIUS), color.filled()))
        }
        Marker::Cross => strokes(canvas, at, color, &[0.25, 0.75]),
        Marker::Plus => strokes(canvas, at, color, &[0.0, 0.5]),
        filled => {
            let outline = outline(filled);
            canvas.fill(corners(at, &outline, RADIUS + 0.8), WHITE)?;
            canvas.fill(corners(at, &outline, RADIUS), color)
        }
    }
}

/// The cross in a ring that stands for a run that failed: no series has this shape.
pub(super) fn draw_failed(canvas: &Canvas<'_>, at: Pixel, color: RGBColor) -> Drawn {
    canvas.root.draw(&Circle::new(at, units(5.6), WHITE.filled()))?;
    canvas.root.draw(&Circle::new(at, units(4.8), stroke(color, 1.3)))?;
    bars(canvas, at, 4.6, &[0.25, 0.75], stroke(color, 1.6))
}

fn strokes(canvas: &Canvas<'_>, at: Pixel, color: RGBColor, turns: &[f64]) -> Drawn {
    bars(canvas, at, RADIUS * 1.35, turns, stroke(WHITE, 3.6))?;
    bars(canvas, at, RADIUS * 1.25, turns, stroke(color, 2.0))
}

/// Bars through a point; a turn of 1/2 is a right angle.
fn bars(canvas: &Canvas<'_>, (x, y): Pixel, half: f64, turns: &[f64], style: ShapeStyle) -> Drawn {
    for turn in turns {
        let (sin, cos) = (turn * PI).sin_cos();
        let (dx, dy) = (units(half * cos), units(half * sin));
        canvas.line(vec![(x - dx, y - dy), (x + dx, y + dy)], style)?;
    }
    Ok(())
}

/// Corners in units of the radius, y downwards.
fn outline(marker: Marker) -> Vec<[f64; 2]> {
    let regular = |corners: u32, size: f64, start: f64, waist: f64| {
        let corner = move |i: u32| {
            let (sin, cos) = (start + 2.0 * PI * f64::from(i) / f64::from(corners)).sin_cos();
            let radius = if i % 2 == 1 { size * waist } else { size };
            [radius * cos, radius * sin]
        };
        (0..corners).map(corner).collect()
    };
    match marker {
        Marker::Square => regular(4, 1.27, PI / 4.0, 1.0),
        Marker::Diamond => regular(4, 1.4, 0.0, 1.0),
        Marker::Triangle => regular(3, 1.4, -PI / 2.0, 1.0),
        Marker::InvertedTriangle => regular(3, 1.4, PI / 2.0, 1.0),
        Marker::Star => regular(10, 1.55, -PI / 2.0, 0.45),
        Marker::Circle | Marker::Cross | Marker::Plus => regular(24, 1.0, 0.0, 1.0),
    }
}

fn corners((x, y): Pixel, outline: &[[f64; 2]], radius: f64) -> Vec<Pixel> {
    let scale = radius * UNITS;
    outline.iter().map(|[dx, dy]| (x + (dx * scale).round() as i32, y + (dy * scale).round() as i32)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_filled_shapes_are_the_same() {
        let shapes =
            [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::InvertedTriangle, Marker::Star];
        let drawn: std::collections::HashSet<_> =
            shapes.map(|m| corners((0, 0), &outline(m), RADIUS)).into_iter().collect();
        assert_eq!(drawn.len(), shapes.len());
    }
}
