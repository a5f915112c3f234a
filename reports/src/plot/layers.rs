//! What lies inside the frame: bands, lines, points, failed runs.

use super::backend::{Area, Drawn, STYLE, line};
use super::clip::{Point, clip_segment};
use super::frame::{Frame, along};
use super::overlap::{self, Tracks};
use super::sheet::{Anchor, Pixel, Sheet};
use super::style::{COLORS, fill, stroke};
use super::text::text_width;
use super::{cells, markers};
use crate::{Figure, Layer, Line, Marker, Series};
use plotters::element::PathElement;

/// Everything but the words, back to front.
pub(super) fn draw(sheet: &mut Sheet, frame: &Frame, figure: &Figure) {
    for layer in &figure.layers {
        if let Layer::Cells(cells) = layer {
            cells::draw(sheet, frame, cells);
        }
    }
    for layer in &figure.layers {
        match layer {
            Layer::Floor { y, .. } => {
                if let Some(area) = frame.below(*y) {
                    sheet.rect("floor", area);
                    sheet.line("edge sg", &[(area.left, area.top), (area.right, area.top)]);
                }
            }
            Layer::Band { axis, from, to, .. } => {
                if let Some(area) = frame.stripe(*axis, [*from, *to]) {
                    sheet.rect("band", area);
                }
            }
            _ => {}
        }
    }
    for layer in &figure.layers {
        match layer {
            Layer::Guide { axis, at, .. } => {
                if let Some(ends) = frame.guide(*axis, *at) {
                    sheet.line("guide sg", &ends);
                }
            }
            Layer::Curve { points, .. } => sheet.path("halo", |area| curve(area, frame, points)),
            _ => {}
        }
    }
    let series: Vec<&Series> = series(figure).collect();
    lines(sheet, frame, &series);
    for layer in &figure.layers {
        // Theory lies on the measured line, whose colour shows between its dashes.
        if let Layer::Curve { points, color, .. } = layer {
            sheet.path(format_args!("curve {}", ink_or(*color)), |area| curve(area, frame, points));
        }
    }
    points(sheet, frame, &series);
    failed(sheet, frame, &series);
}

pub(super) fn series(figure: &Figure) -> impl Iterator<Item = &Series> {
    figure.layers.iter().filter_map(|layer| if let Layer::Series(series) = layer { Some(series) } else { None })
}

/// The class of a line in a palette colour, or in dark ink.
pub(super) fn ink_or(color: Option<usize>) -> String {
    color.map_or_else(|| "si".to_owned(), stroke)
}

/// Colour and dashes of a line. A second and third round through the palette are told apart by their dashes.
pub(super) fn look(color: usize, line: Line) -> String {
    let dashes = match (line, color / COLORS) {
        (Line::Dotted, _) => " dotted",
        (Line::Dashed, _) | (Line::Solid, 1) => " dashed",
        (Line::Solid, 0) => "",
        (Line::Solid, _) => " mixed",
    };
    format!("line {}{dashes}", stroke(color))
}

/// What is visible of a line through data points.
fn curve(area: &Area<'_>, frame: &Frame, points: &[Point]) -> Drawn {
    let inside = frame.inside(area);
    let coordinates = |piece: &Vec<Point>| piece.iter().map(|&[x, y]| (x, y)).collect::<Vec<_>>();
    frame.pieces(points).iter().try_for_each(|piece| inside.draw(&PathElement::new(coordinates(piece), STYLE)))
}

/// The lines of all series; where one lies on earlier ones it is drawn in dashes, and they show between.
fn lines(sheet: &mut Sheet, frame: &Frame, series: &[&Series]) {
    let visible: Vec<_> = series.iter().map(|s| s.line.map_or_else(Vec::new, |_| frame.visible(&s.points))).collect();
    let mut tracks = Tracks::default();
    for (i, pieces) in visible.iter().enumerate() {
        tracks.add(i, pieces.iter().flat_map(|piece| along(piece, 1.0)));
    }
    for (i, (one, pieces)) in series.iter().zip(&visible).enumerate() {
        let Some(kind) = one.line else { continue };
        let look = look(one.color, kind);
        // A line with dashes of its own lets the lower ones show already.
        if look.contains(' ') && !look.ends_with(&stroke(one.color)) {
            sheet.path(&look, |area| curve(area, frame, &one.points));
            continue;
        }
        let mut lines = [const { Vec::new() }; 4];
        for (under, part) in pieces.iter().flat_map(|piece| overlap::parts(&tracks, i, piece)) {
            lines[under.min(3)].push(line(&part));
        }
        for (under, lines) in lines.iter().enumerate() {
            let over = if under == 0 { String::new() } else { format!(" over{under}") };
            sheet.path(format_args!("{look}{over}"), |area| lines.iter().try_for_each(|line| area.draw(line)));
        }
    }
    for one in series {
        sheet.path(format_args!("whisker {}", stroke(one.color)), |area| whiskers(area, frame, one));
    }
}

fn whiskers(area: &Area<'_>, frame: &Frame, series: &Series) -> Drawn {
    for ([x, _], [low, high]) in series.points.iter().zip(&series.whiskers) {
        // A whisker that reaches zero on a log axis reaches the edge of the frame.
        let bottom = frame.y.map_value(*low).or((*low <= 0.0 && high.is_finite()).then_some(frame.y.low));
        let ends = (frame.x.map_value(*x), bottom, frame.y.map_value(*high));
        let (Some(x), Some(low), Some(high)) = ends else { continue };
        let Some([a, b]) = clip_segment([x, low], [x, high], frame.window()) else { continue };
        area.draw(&line(&[frame.pixel(a), frame.pixel(b)]))?;
        for (end, cut) in [(a, a[1] != low), (b, b[1] != high)] {
            let (x, y) = frame.pixel(end);
            if !cut {
                area.draw(&line(&[(x - 3.0, y), (x + 3.0, y)]))?;
            }
        }
    }
    Ok(())
}

/// The marker a series shows its points with: one with neither marker nor line would show nothing.
pub(super) fn marker_of(series: &Series) -> Option<Marker> {
    series.marker.or_else(|| series.line.is_none().then(|| Marker::of_color(series.color)))
}

/// The marks of all series; one that later ones lie on is larger, and its rim shows around them.
fn points(sheet: &mut Sheet, frame: &Frame, series: &[&Series]) {
    let shown: Vec<_> = series.iter().map(|s| marker_of(s).map(|marker| (marker, frame.shown(&s.points)))).collect();
    let mut tracks = Tracks::default();
    for (i, places) in shown.iter().enumerate().filter_map(|(i, one)| Some((i, &one.as_ref()?.1))) {
        tracks.add(i, places.iter().copied());
    }
    for (i, one) in shown.iter().enumerate() {
        let Some((marker, places)) = one else { continue };
        let scale = |at: Pixel| 1.0 + 0.45 * tracks.over(i, at).min(3) as f64;
        sheet.path(format_args!("mark {}", fill(series[i].color)), |area| {
            places.iter().try_for_each(|&at| markers::draw(area, *marker, at, scale(at)))
        });
    }
}

/// Distance between two crosses set one under the other, and of the first from the upper edge, in CSS pixels.
const FAILED_STEP: f64 = 12.0;
const FAILED_EDGE: f64 = 9.0;

/// Where the crosses of failed runs stand: along the upper edge, one under the other where they would meet.
pub(super) fn failed_places(frame: &Frame, series: &[&Series]) -> Vec<(Pixel, usize)> {
    let mut places: Vec<(Pixel, usize)> = Vec::new();
    let all = series.iter().flat_map(|one| one.failed.iter().map(|&x| (x, one.color)));
    for (x, color) in all {
        // A failed run is never hidden: one that lies outside the frame is shown at its edge.
        let mapped = frame.x.map_value(x).unwrap_or(if x <= 0.0 { frame.x.low } else { frame.x.high });
        let column = frame.column(mapped.clamp(frame.x.low, frame.x.high));
        let free = |row: f64| !places.iter().any(|((c, r), _)| (c - column).abs() < 9.0 && *r == row);
        let rows = (0..).map(|i| frame.area.top + FAILED_EDGE + FAILED_STEP * f64::from(i));
        let row = rows.take_while(|&row| row < frame.area.bottom).find(|&row| free(row));
        places.push(((column, row.unwrap_or(frame.area.top + FAILED_EDGE)), color));
    }
    places
}

fn failed(sheet: &mut Sheet, frame: &Frame, series: &[&Series]) {
    let places = failed_places(frame, series);
    for &(at, color) in &places {
        sheet.path(format_args!("failed {}", stroke(color)), |area| markers::draw_failed(area, at));
    }
    if !places.is_empty() {
        let (words, size, at) = ("run failed", 11.5, (frame.area.right, frame.area.top - 9.0));
        sheet.text("fg", words, at, size, Anchor::End);
        let mark = (at.0 - text_width(words, size) - 9.0, at.1);
        sheet.path("failed sg", |area| markers::draw_failed(area, mark));
    }
}
