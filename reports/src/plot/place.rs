//! Words inside the frame, set where they cover no data.

use super::frame::Frame;
use super::sheet::{Anchor, Pixel, Rect, Sheet};
use super::taken::Taken;
use super::text::text_width;
use crate::{AxisName, Figure, Layer};

/// Size of words inside the frame, and the height they need.
const SIZE: f64 = 12.0;
const HEIGHT: f64 = 15.0;

pub(super) fn draw(sheet: &mut Sheet, frame: &Frame, figure: &Figure, taken: &mut Taken) {
    for layer in &figure.layers {
        let (spots, label) = match layer {
            Layer::Text { at, text } => {
                words_at(sheet, frame, *at, text, taken);
                continue;
            }
            Layer::Floor { y, label } => (frame.below(*y).map(|area| in_stripe(area, AxisName::Y, label)), label),
            Layer::Band { axis, from, to, label } => {
                (frame.stripe(*axis, [*from, *to]).map(|area| in_stripe(area, *axis, label)), label)
            }
            Layer::Guide { axis, at, label } => {
                (frame.guide(*axis, *at).map(|ends| beside_line(ends, *axis, label)), label)
            }
            _ => continue,
        };
        spots.iter().for_each(|spots| best(sheet, frame, label, spots, taken));
    }
}

/// Sets words with their middle left end at a data point, moved inside the frame if they would leave it.
fn words_at(sheet: &mut Sheet, frame: &Frame, at: [f64; 2], text: &str, taken: &mut Taken) {
    let Some(point) = frame.mapped(at).filter(|&p| frame.window().contains(p)) else { return };
    let (x, y) = frame.pixel(point);
    let width = text_width(text, SIZE);
    let around = within(frame.area, Rect::around((x + width / 2.0, y), width + 4.0, HEIGHT));
    taken.boxes.push(around);
    sheet.rect("veil", around);
    sheet.text("fi", text, around.middle(), SIZE, Anchor::Middle);
}

/// The box, moved inside another; where it is larger, its left and upper edges are inside.
fn within(outer: Rect, inner: Rect) -> Rect {
    let (width, height) = (inner.width(), inner.height());
    let left = inner.left.min(outer.right - width - 2.0).max(outer.left + 2.0);
    let top = inner.top.min(outer.bottom - height - 2.0).max(outer.top + 2.0);
    Rect { left, top, right: left + width, bottom: top + height }
}

/// `count + 1` places from `first` to `last`.
fn steps(first: f64, last: f64, count: i32) -> impl Iterator<Item = f64> + Clone {
    (0..=count).map(move |i| first + (last - first) * f64::from(i) / f64::from(count))
}

/// Places for words in a stripe; those of a narrow upright stripe may reach beyond it.
fn in_stripe(stripe: Rect, axis: AxisName, text: &str) -> Vec<Pixel> {
    let middle = stripe.middle();
    match axis {
        AxisName::Y => {
            let half = text_width(text, SIZE) / 2.0 + 8.0;
            let low = stripe.bottom - 11.0;
            let rows = [(stripe.top + 11.0).min(low), low, middle.1];
            let columns = steps(stripe.left + half, stripe.right - half, 8);
            rows.into_iter().flat_map(|y| columns.clone().map(move |x| (x, y))).collect()
        }
        AxisName::X => steps(stripe.top + 24.0, stripe.bottom - 24.0, 12).map(|y| (middle.0, y)).collect(),
    }
}

/// Places for words just beside a straight line.
fn beside_line([start, end]: [Pixel; 2], axis: AxisName, text: &str) -> Vec<Pixel> {
    let half = text_width(text, SIZE) / 2.0 + 6.0;
    match axis {
        AxisName::X => {
            let rows = steps(end.1 + 28.0, start.1 - 24.0, 12);
            rows.flat_map(|y| [(start.0 + half, y), (start.0 - half, y)]).collect()
        }
        AxisName::Y => {
            let columns = steps(start.0 + half, end.0 - half, 12);
            columns.flat_map(|x| [(x, start.1 - 10.0), (x, start.1 + 10.0)]).collect()
        }
    }
}

/// Sets words at the first of the places that cover least; one that lies partly outside the frame is moved inside.
fn best(sheet: &mut Sheet, frame: &Frame, text: &str, spots: &[Pixel], taken: &mut Taken) {
    let spots = spots.iter().map(|&at| Rect::around(at, text_width(text, SIZE) + 6.0, HEIGHT));
    // One that has to be moved may come to lie on what it names.
    let cost = |&(moved, place): &(bool, Rect)| 5 * usize::from(moved) + taken.cost(&place, |p| place.contains(p));
    let placed = spots.map(|wanted| (!wanted.inside(&frame.area), within(frame.area, wanted)));
    let Some((_, place)) = placed.min_by_key(cost).filter(|_| !text.is_empty()) else { return };
    taken.boxes.push(place);
    if taken.map {
        // No ink can be read on every colour of a map.
        sheet.rect("veil", place);
    }
    sheet.text("fg", text, place.middle(), SIZE, Anchor::Middle);
}
