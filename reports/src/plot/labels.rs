//! Names of series and curves in the right margin: beside their right ends, or as a list where that cannot work.

use super::frame::Frame;
use super::sheet::{Anchor, Pixel, Sheet};
use super::style::fill;
use super::text::{text_width, wrap};
use super::{cells, layers, markers};
use crate::{Cells, Figure, Layer, Marker, Palette};

const SIZE: f64 = 13.0;
/// From the frame to the sample, and from the sample to the words, in CSS pixels.
const GAP: f64 = 12.0;
const SAMPLE: f64 = 22.0;
/// Height of a line of words.
const STEP: f64 = 17.0;
/// More names than this are set as a list: beside the ends they would no longer be near them.
const MOST_BESIDE: usize = 8;

/// A name with what it looks like.
struct Entry<'a> {
    name: &'a str,
    /// Class of the line, if there is one.
    line: Option<String>,
    color: Option<usize>,
    marker: Option<Marker>,
    points: &'a [[f64; 2]],
}

fn entries(figure: &Figure) -> Vec<Entry<'_>> {
    let named = figure.layers.iter().filter_map(|layer| match layer {
        Layer::Series(s) => Some(Entry {
            name: &s.name,
            line: s.line.map(|line| layers::look(s.color, line)),
            color: Some(s.color),
            marker: layers::marker_of(s),
            points: &s.points,
        }),
        Layer::Curve { name, points, color } => {
            let line = Some(format!("curve {}", layers::ink_or(*color)));
            Some(Entry { name, line, color: *color, marker: None, points })
        }
        _ => None,
    });
    named.filter(|entry| !entry.name.is_empty()).collect()
}

fn map(figure: &Figure) -> Option<&Cells> {
    figure.layers.iter().find_map(|layer| if let Layer::Cells(cells) = layer { Some(cells) } else { None })
}

/// Room to the right of the frame that the names need, in CSS pixels; longer names are set in lines.
pub(super) fn margin(figure: &Figure) -> f64 {
    let names = entries(figure).into_iter().map(|entry| text_width(entry.name, SIZE)).fold(0.0, f64::max);
    let map = map(figure).map_or(0.0, |cells| match &cells.palette {
        Palette::Categories { names } => names.iter().map(|n| text_width(n, SIZE)).fold(60.0, f64::max),
        Palette::Sequential { .. } => 84.0,
    });
    let words = names.max(map);
    let room = if words > 0.0 { GAP + SAMPLE + words + 10.0 } else { 24.0 };
    room.min(0.38 * f64::from(figure.width))
}

pub(super) fn draw(sheet: &mut Sheet, frame: &Frame, figure: &Figure) {
    let entries = entries(figure);
    let area = frame.area;
    let x = area.right + GAP;
    let width = margin(figure) - GAP - 6.0;
    let mut top = area.top + 8.0;
    if let Some(cells) = map(figure) {
        top = cells::legend(sheet, cells, (x, top), width, area.height());
    }
    let words: Vec<Vec<String>> = entries.iter().map(|entry| wrap(entry.name, SIZE, width - SAMPLE)).collect();
    let heights: Vec<f64> = words.iter().map(|lines| STEP * lines.len() as f64).collect();
    let ends: Vec<Option<Pixel>> = entries.iter().map(|entry| right_end(frame, entry.points)).collect();
    let beside = map(figure).is_none() && entries.len() <= MOST_BESIDE;
    let listed = heights.iter().scan(top - STEP / 2.0, |y, height| {
        *y += height;
        Some(*y - height / 2.0)
    });
    let wanted: Vec<f64> =
        if beside { ends.iter().map(|end| end.map_or(area.bottom, |(_, y)| y)).collect() } else { listed.collect() };
    // Where a list is long, the room below the frame is free too.
    let bottom = if beside { area.bottom - 6.0 } else { f64::from(figure.height) - 12.0 };
    let places = spread(&wanted, &heights, top - STEP / 2.0, bottom);
    for (((entry, lines), y), end) in entries.iter().zip(&words).zip(places).zip(ends) {
        let first = y - STEP / 2.0 * (lines.len() as f64 - 1.0);
        if let Some(end) = end.filter(|_| beside) {
            leader(sheet, frame, end, (x, first), entry.color);
        }
        sample(sheet, entry, (x, first));
        for (i, line) in lines.iter().enumerate() {
            sheet.text("fi", line, (x + SAMPLE, first + STEP * i as f64), SIZE, Anchor::Start);
        }
    }
}

/// The right end of what is visible of a line.
fn right_end(frame: &Frame, points: &[[f64; 2]]) -> Option<Pixel> {
    let on_line = frame.visible(points).into_iter().flatten();
    on_line.chain(frame.shown(points)).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// A thin line from a right end near the edge of the frame to a name that had to move.
fn leader(sheet: &mut Sheet, frame: &Frame, end: Pixel, (x, y): Pixel, color: Option<usize>) {
    let area = frame.area;
    if area.right - end.0 < area.width() / 8.0 && (end.1 - y).abs() > 3.0 {
        let bend = area.right.max(end.0 + 6.0);
        let class = format!("leader {}", layers::ink_or(color));
        sheet.line(class, &[(end.0 + 6.0, end.1), (bend, end.1), (x - 2.0, y)]);
    }
}

fn sample(sheet: &mut Sheet, entry: &Entry<'_>, (x, y): Pixel) {
    if let Some(line) = &entry.line {
        sheet.line(line, &[(x, y), (x + SAMPLE - 6.0, y)]);
    }
    if let (Some(marker), Some(color)) = (entry.marker, entry.color) {
        let middle = (x + (SAMPLE - 6.0) / 2.0, y);
        sheet.path(format_args!("mark {}", fill(color)), |area| markers::draw(area, marker, middle, 1.0));
    }
}

/// Places as near as can be (least squares) to those wanted, in the same order, so that boxes of these heights around them
/// do not meet and stay between the ends: isotonic regression of the places less the heights before them, by pooling
/// adjacent violators. Where the boxes need more room than there is they are all made flatter.
fn spread(wanted: &[f64], heights: &[f64], low: f64, high: f64) -> Vec<f64> {
    let scale = ((high - low) / heights.iter().sum::<f64>().max(1.0)).min(1.0);
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|&i, &j| wanted[i].total_cmp(&wanted[j]));
    // From the upper edge of the first box to the middle of each, packed without gaps.
    let mut total = 0.0;
    let offsets: Vec<f64> = order
        .iter()
        .map(|&i| {
            total += scale * heights[i];
            total - scale * heights[i] / 2.0
        })
        .collect();
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for (&i, offset) in order.iter().zip(&offsets) {
        let mut pool = (wanted[i] - offset, 1);
        while let Some(&(mean, count)) = pools.last().filter(|(mean, _)| *mean > pool.0) {
            pools.pop();
            let both = count + pool.1;
            pool = ((mean * count as f64 + pool.0 * pool.1 as f64) / both as f64, both);
        }
        pools.push(pool);
    }
    let level = pools.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count));
    let mut places = vec![0.0; wanted.len()];
    for ((&i, offset), level) in order.iter().zip(offsets).zip(level) {
        places[i] = level.min(high - total).max(low) + offset;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_far_enough_apart_stay_beside_their_ends() {
        assert_eq!(spread(&[300.0, 10.0, 50.0], &[20.0; 3], 0.0, 400.0), [300.0, 10.0, 50.0]);
    }

    #[test]
    fn names_that_would_meet_move_apart_evenly_and_keep_their_order() {
        assert_eq!(spread(&[100.0, 100.0, 100.0, 300.0], &[20.0; 4], 0.0, 400.0), [80.0, 100.0, 120.0, 300.0]);
        assert_eq!(spread(&[104.0, 100.0], &[20.0; 2], 0.0, 400.0), [112.0, 92.0]);
    }

    #[test]
    fn names_never_leave_the_height_of_the_frame_nor_meet() {
        for wanted in [vec![0.0; 8], vec![100.0; 8], vec![-50.0, 500.0, 3.0, 3.0, 97.0]] {
            let mut places = spread(&wanted, &vec![12.0; wanted.len()], 0.0, 100.0);
            places.sort_by(f64::total_cmp);
            assert!(places[0] >= 0.0 && places[places.len() - 1] <= 100.0 + 1e-9, "{places:?}");
            assert!(places.windows(2).all(|pair| pair[1] - pair[0] >= 12.0 - 1e-9), "{places:?}");
        }
    }

    #[test]
    fn more_names_than_fit_still_get_a_place_each() {
        let places = spread(&[5.0; 30], &[12.0; 30], 0.0, 100.0);
        assert!(places.iter().all(|p| (0.0..=100.0 + 1e-9).contains(p)), "{places:?}");
    }
}
