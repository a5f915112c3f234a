//! Names of series and curves in the right margin: beside their right ends, or as a list where that cannot work.

use super::canvas::{Canvas, Drawn, INK, LEFT, Pixel, UNITS, palette, shorten, stroke, text_width, units};
use super::{Refused, cells, layers, markers};
use crate::{Cells, Figure, Layer, Line, Marker};
use plotters::prelude::*;

const SIZE: f64 = 13.0;
/// From the frame to the sample, and from the sample to the words, in CSS pixels.
const GAP: f64 = 12.0;
const SAMPLE: f64 = 22.0;
const STEP: f64 = 17.0;
/// More names than this are set as a list: beside the ends they would no longer be near them.
const MOST_BESIDE: usize = 8;

/// A name with what it looks like.
struct Entry<'a> {
    name: &'a str,
    color: RGBColor,
    marker: Option<Marker>,
    line: Option<Line>,
    points: &'a [[f64; 2]],
}

fn entries(figure: &Figure) -> Vec<Entry<'_>> {
    let named = figure.layers.iter().filter_map(|layer| match layer {
        Layer::Series(series) => Some(Entry {
            name: &series.name,
            color: palette(series.color),
            marker: layers::marker_of(series),
            line: series.line,
            points: &series.points,
        }),
        Layer::Curve { name, points, color } => {
            let color = color.map_or(INK, palette);
            Some(Entry { name, color, marker: None, line: Some(Line::Dashed), points })
        }
        _ => None,
    });
    named.filter(|entry| !entry.name.is_empty()).collect()
}

fn map(figure: &Figure) -> Option<&Cells> {
    figure.layers.iter().find_map(|layer| if let Layer::Cells(cells) = layer { Some(cells) } else { None })
}

/// Room to the right of the frame that the names need, in CSS pixels.
pub(super) fn margin(figure: &Figure) -> f64 {
    let names = entries(figure).into_iter().map(|entry| text_width(entry.name, SIZE)).fold(0.0, f64::max);
    let map = map(figure).map_or(0.0, |cells| match &cells.palette {
        crate::Palette::Categories { names } => names.iter().map(|n| text_width(n, SIZE)).fold(60.0, f64::max),
        crate::Palette::Sequential { .. } => 84.0,
    });
    let words = names.max(map);
    let room = if words > 0.0 { GAP + SAMPLE + words + 10.0 } else { 24.0 };
    room.min(0.38 * f64::from(figure.width))
}

pub(super) fn draw(canvas: &Canvas<'_>, figure: &Figure) -> Result<(), Refused> {
    let entries = entries(figure);
    let area = canvas.frame.area;
    let x = area.right + units(GAP);
    let width = margin(figure) - GAP - 6.0;
    let mut top = area.top + units(8.0);
    if let Some(cells) = map(figure) {
        top = cells::legend(canvas, cells, (x, top), width)?;
    }
    let ends: Vec<Option<Pixel>> = entries.iter().map(|entry| right_end(canvas, entry)).collect();
    let beside = map(figure).is_none() && entries.len() <= MOST_BESIDE;
    let wanted = |i: usize| if beside { ends[i].map_or(area.bottom, |(_, y)| y) } else { top + units(STEP) * i as i32 };
    let wanted: Vec<f64> = (0..entries.len()).map(|i| f64::from(wanted(i))).collect();
    let places = spread(&wanted, STEP * UNITS, f64::from(top), f64::from(area.bottom - units(6.0)));
    for ((entry, place), end) in entries.iter().zip(places).zip(ends) {
        let y = place.round() as i32;
        if let Some(end) = end.filter(|_| beside) {
            leader(canvas, end, (x, y), entry.color)?;
        }
        sample(canvas, entry, (x, y))?;
        let words = shorten(entry.name, SIZE, width - SAMPLE);
        canvas.text(&words, (x + units(SAMPLE), y), SIZE, INK, LEFT)?;
    }
    Ok(())
}

/// The right end of what is visible of a line.
fn right_end(canvas: &Canvas<'_>, entry: &Entry<'_>) -> Option<Pixel> {
    let on_line = layers::visible(canvas, entry.points).into_iter().flatten();
    on_line.chain(layers::shown(canvas, entry.points)).max_by_key(|&(x, _)| x)
}

/// A thin line from a right end near the edge of the frame to a name that had to move.
fn leader(canvas: &Canvas<'_>, end: Pixel, (x, y): Pixel, color: RGBColor) -> Drawn {
    let area = canvas.frame.area;
    let near = area.right - end.0 < (area.right - area.left) / 8;
    if !near || (end.1 - y).abs() <= units(3.0) {
        return Ok(());
    }
    let bend = area.right.max(end.0 + units(6.0));
    canvas.line(vec![(end.0 + units(6.0), end.1), (bend, end.1), (x - units(2.0), y)], stroke(color.mix(0.55), 0.75))
}

fn sample(canvas: &Canvas<'_>, entry: &Entry<'_>, (x, y): Pixel) -> Drawn {
    let ends = vec![(x, y), (x + units(SAMPLE - 6.0), y)];
    match entry.line {
        Some(Line::Solid) => canvas.line(ends, stroke(entry.color, 1.8))?,
        Some(Line::Dashed) => canvas.dashed(ends, 5.0, 3.0, stroke(entry.color, 1.6))?,
        Some(Line::Dotted) => canvas.dashed(ends, 2.0, 2.5, stroke(entry.color, 1.8))?,
        None => {}
    }
    let middle = (x + units((SAMPLE - 6.0) / 2.0), y);
    entry.marker.map_or(Ok(()), |marker| markers::draw(canvas, marker, middle, entry.color))
}

/// Places as near as can be (least squares) to those wanted, in the same order, at least `step` apart and within the
/// ends: isotonic regression of the places less their rank times the step, by pooling adjacent violators.
fn spread(wanted: &[f64], step: f64, low: f64, high: f64) -> Vec<f64> {
    let last = wanted.len().saturating_sub(1) as f64;
    let step = step.min((high - low) / last.max(1.0));
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|&i, &j| wanted[i].total_cmp(&wanted[j]));
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for (rank, &i) in order.iter().enumerate() {
        let mut pool = (wanted[i] - step * rank as f64, 1);
        while let Some(&(mean, count)) = pools.last().filter(|(mean, _)| *mean > pool.0) {
            pools.pop();
            let total = count + pool.1;
            pool = ((mean * count as f64 + pool.0 * pool.1 as f64) / total as f64, total);
        }
        pools.push(pool);
    }
    let level = pools.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count));
    let mut places = vec![0.0; wanted.len()];
    for (rank, (&i, level)) in order.iter().zip(level).enumerate() {
        places[i] = level.max(low).min(high - step * last) + step * rank as f64;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_far_enough_apart_stay_beside_their_ends() {
        assert_eq!(spread(&[300.0, 10.0, 50.0], 20.0, 0.0, 400.0), [300.0, 10.0, 50.0]);
    }

    #[test]
    fn names_that_would_meet_move_apart_evenly_and_keep_their_order() {
        assert_eq!(spread(&[100.0, 100.0, 100.0, 300.0], 20.0, 0.0, 400.0), [80.0, 100.0, 120.0, 300.0]);
        assert_eq!(spread(&[104.0, 100.0], 20.0, 0.0, 400.0), [112.0, 92.0]);
    }

    #[test]
    fn names_never_leave_the_height_of_the_frame_nor_meet() {
        for wanted in [vec![0.0; 8], vec![100.0; 8], vec![-50.0, 500.0, 3.0, 3.0, 97.0]] {
            let mut places = spread(&wanted, 12.0, 0.0, 100.0);
            places.sort_by(f64::total_cmp);
            assert!(places[0] >= 0.0 && places[places.len() - 1] <= 100.0 + 1e-9, "{places:?}");
            assert!(places.windows(2).all(|pair| pair[1] - pair[0] >= 12.0 - 1e-9), "{places:?}");
        }
    }

    #[test]
    fn more_names_than_fit_still_get_a_place_each() {
        let places = spread(&[5.0; 30], 12.0, 0.0, 100.0);
        assert!(places.iter().all(|p| (0.0..=100.0 + 1e-9).contains(p)), "{places:?}");
    }
}
