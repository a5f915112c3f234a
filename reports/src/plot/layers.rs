//! What lies inside the frame: bands, lines, points, failed runs.

use super::canvas::{Canvas, Drawn, GREY, INK, Pixel, Rect, palette, stroke, units};
use super::clip::{Point, clip_line, clip_segment};
use super::markers;
use crate::{AxisName, Figure, Layer, Line, Marker, Series};
use plotters::prelude::*;

/// Everything but the maps (below) and the words (above), back to front.
pub(super) fn draw(canvas: &Canvas<'_>, figure: &Figure) -> Drawn {
    for layer in &figure.layers {
        match layer {
            Layer::Floor { y, .. } => floor(canvas, *y)?,
            Layer::Band { axis, from, to, .. } => band(canvas, *axis, [*from, *to])?,
            _ => {}
        }
    }
    for layer in &figure.layers {
        match layer {
            Layer::Guide { axis, at, .. } => guide(canvas, *axis, *at)?,
            Layer::Curve { points, color, .. } => curve(canvas, points, color.map_or(INK, palette))?,
            _ => {}
        }
    }
    let series = || figure.layers.iter().filter_map(|layer| if let Layer::Series(s) = layer { Some(s) } else { None });
    for one in series() {
        line(canvas, one)?;
    }
    for one in series() {
        points(canvas, one)?;
    }
    failed(canvas, &series().collect::<Vec<_>>())
}

/// The visible pieces of a line through data points, in units of the sheet.
pub(super) fn visible(canvas: &Canvas<'_>, points: &[Point]) -> Vec<Vec<Pixel>> {
    let mapped: Vec<_> = points.iter().map(|&p| canvas.frame.mapped(p)).collect();
    let pieces = clip_line(&mapped, canvas.frame.window());
    pieces.into_iter().map(|piece| piece.into_iter().map(|p| canvas.frame.pixel(p)).collect()).collect()
}

/// The data points inside the frame, in units of the sheet.
pub(super) fn shown(canvas: &Canvas<'_>, points: &[Point]) -> Vec<Pixel> {
    let window = canvas.frame.window();
    let inside = points.iter().filter_map(|&p| canvas.frame.mapped(p)).filter(|&p| window.contains(p));
    inside.map(|p| canvas.frame.pixel(p)).collect()
}

/// The rectangle between two values of an axis, cut at the frame; `None` if nothing of it is in sight.
pub(super) fn stripe(canvas: &Canvas<'_>, axis: AxisName, [from, to]: [f64; 2]) -> Option<Rect> {
    let frame = &canvas.frame;
    let map = match axis {
        AxisName::X => &frame.x,
        AxisName::Y => &frame.y,
    };
    // An end without a place on the axis (zero on a log axis, infinity) means: as far as the frame goes.
    let low = map.map_value(from.min(to)).unwrap_or(map.low).max(map.low);
    let high = map.map_value(from.max(to)).unwrap_or(map.high).min(map.high);
    (low < high).then(|| match axis {
        AxisName::X => Rect { left: frame.column(low), right: frame.column(high), ..frame.area },
        AxisName::Y => Rect { top: frame.row(high), bottom: frame.row(low), ..frame.area },
    })
}

fn floor(canvas: &Canvas<'_>, y: f64) -> Drawn {
    let Some(area) = canvas.frame.y.map_value(y).and_then(|_| stripe(canvas, AxisName::Y, [f64::NEG_INFINITY, y]))
    else {
        return Ok(());
    };
    canvas.rect(area, RGBColor(110, 110, 110).mix(0.13).filled())?;
    canvas.line(vec![(area.left, area.top), (area.right, area.top)], stroke(GREY.mix(0.6), 0.75))
}

fn band(canvas: &Canvas<'_>, axis: AxisName, ends: [f64; 2]) -> Drawn {
    stripe(canvas, axis, ends).map_or(Ok(()), |area| canvas.rect(area, RGBColor(0x00, 0x72, 0xB2).mix(0.09).filled()))
}

fn guide(canvas: &Canvas<'_>, axis: AxisName, at: f64) -> Drawn {
    guide_line(canvas, axis, at).map_or(Ok(()), |ends| canvas.dashed(ends.to_vec(), 2.0, 3.0, stroke(GREY, 1.1)))
}

/// The ends of a guide, if its value is in sight.
pub(super) fn guide_line(canvas: &Canvas<'_>, axis: AxisName, at: f64) -> Option<[Pixel; 2]> {
    let frame = &canvas.frame;
    let (map, vertical) = match axis {
        AxisName::X => (&frame.x, true),
        AxisName::Y => (&frame.y, false),
    };
    let m = map.map_value(at).filter(|m| map.low <= *m && *m <= map.high)?;
    Some(if vertical {
        [(frame.column(m), frame.area.bottom), (frame.column(m), frame.area.top)]
    } else {
        [(frame.area.left, frame.row(m)), (frame.area.right, frame.row(m))]
    })
}

fn curve(canvas: &Canvas<'_>, points: &[Point], color: RGBColor) -> Drawn {
    for piece in visible(canvas, points) {
        canvas.line(piece.clone(), stroke(WHITE.mix(0.75), 4.0))?;
        canvas.dashed(piece, 7.0, 4.0, stroke(color, 1.4))?;
    }
    Ok(())
}

fn line(canvas: &Canvas<'_>, series: &Series) -> Drawn {
    let color = palette(series.color);
    let style = stroke(color, 1.8);
    for piece in visible(canvas, &series.points) {
        match series.line {
            Some(Line::Solid) => canvas.line(piece, style)?,
            Some(Line::Dashed) => canvas.dashed(piece, 8.0, 4.0, style)?,
            Some(Line::Dotted) => canvas.dashed(piece, 2.0, 3.0, style)?,
            None => {}
        }
    }
    whiskers(canvas, series, color)
}

fn whiskers(canvas: &Canvas<'_>, series: &Series, color: RGBColor) -> Drawn {
    let frame = &canvas.frame;
    for ([x, _], [low, high]) in series.points.iter().zip(&series.whiskers) {
        // A whisker that reaches zero on a log axis reaches the edge of the frame.
        let bottom = if *low <= 0.0 && high.is_finite() {
            frame.y.map_value(*low).or(Some(frame.y.low))
        } else {
            frame.y.map_value(*low)
        };
        let ends = (frame.x.map_value(*x), bottom, frame.y.map_value(*high));
        let (Some(x), Some(low), Some(high)) = ends else { continue };
        let Some([a, b]) = clip_segment([x, low], [x, high], frame.window()) else { continue };
        let (foot, head) = (frame.pixel(a), frame.pixel(b));
        canvas.line(vec![foot, head], stroke(color, 1.2))?;
        for ((cx, cy), cut) in [(foot, a[1] != low), (head, b[1] != high)] {
            if !cut {
                canvas.line(vec![(cx - units(3.0), cy), (cx + units(3.0), cy)], stroke(color, 1.2))?;
            }
        }
    }
    Ok(())
}

/// The marker a series shows its points with: one with neither marker nor line would show nothing.
pub(super) fn marker_of(series: &Series) -> Option<Marker> {
    series.marker.or_else(|| series.line.is_none().then(|| Marker::of_color(series.color)))
}

fn points(canvas: &Canvas<'_>, series: &Series) -> Drawn {
    let Some(marker) = marker_of(series) else { return Ok(()) };
    shown(canvas, &series.points)
        .into_iter()
        .try_for_each(|at| markers::draw(canvas, marker, at, palette(series.color)))
}

/// Distance between two crosses set one under the other, and of the first from the upper edge, in CSS pixels.
const FAILED_STEP: f64 = 12.0;
const FAILED_EDGE: f64 = 9.0;

/// Where the crosses of failed runs stand: along the upper edge, one under the other where they would meet.
pub(super) fn failed_places(canvas: &Canvas<'_>, series: &[&Series]) -> Vec<(Pixel, usize)> {
    let frame = &canvas.frame;
    let mut places: Vec<(Pixel, usize)> = Vec::new();
    for one in series {
        for &x in &one.failed {
            // A failed run is never hidden: one that lies outside the frame is shown at its edge.
            let mapped = frame.x.map_value(x).unwrap_or(if x <= 0.0 { frame.x.low } else { frame.x.high });
            let column = frame.column(mapped.clamp(frame.x.low, frame.x.high));
            let free = |row: i32| !places.iter().any(|((c, r), _)| (c - column).abs() < units(9.0) && *r == row);
            let rows = (0..).map(|i| frame.area.top + units(FAILED_EDGE + FAILED_STEP * f64::from(i)));
            let row = rows.take_while(|&row| row < frame.area.bottom).find(|&row| free(row));
            places.push(((column, row.unwrap_or(frame.area.top + units(FAILED_EDGE))), one.color));
        }
    }
    places
}

fn failed(canvas: &Canvas<'_>, series: &[&Series]) -> Drawn {
    let places = failed_places(canvas, series);
    places.iter().try_for_each(|&(at, color)| markers::draw_failed(canvas, at, palette(color)))?;
    if places.is_empty() {
        return Ok(());
    }
    let area = canvas.frame.area;
    let (x, y) = (area.right, area.top - units(9.0));
    let words = "run failed";
    let mark = x - units(super::canvas::text_width(words, 11.5) + 9.0);
    markers::draw_failed(canvas, (mark, y), GREY)?;
    canvas.text(words, (x, y), 11.5, GREY, super::canvas::RIGHT)
}
