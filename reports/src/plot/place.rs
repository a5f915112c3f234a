//! Words inside the frame, set where they cover no data.

use super::canvas::{CENTER, Canvas, Drawn, GREY, INK, LEFT, Pixel, Rect, text_width, units};
use super::{layers, triangle};
use crate::{AxisName, Figure, Layer, Scale};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, WHITE};

/// Size of words inside the frame.
pub(super) const SIZE: f64 = 12.0;

/// What is already on the sheet: points along every line, and the boxes of what was set.
pub(super) struct Taken {
    pub(super) points: Vec<Pixel>,
    pub(super) boxes: Vec<Rect>,
    /// Whether there is a map below.
    pub(super) map: bool,
}

impl Taken {
    fn cost(&self, area: &Rect) -> usize {
        let points = self.points.iter().filter(|&&p| area.contains(p)).count();
        points + 50 * self.boxes.iter().filter(|other| other.overlaps(area)).count()
    }
}

pub(super) fn draw(canvas: &Canvas<'_>, figure: &Figure) -> Drawn {
    let mut taken = taken(canvas, figure);
    for layer in &figure.layers {
        match layer {
            Layer::Text { at, text } => words_at(canvas, *at, text, &mut taken)?,
            Layer::Floor { y, label } => {
                let stripe = canvas
                    .frame
                    .y
                    .map_value(*y)
                    .and_then(|_| layers::stripe(canvas, AxisName::Y, [f64::NEG_INFINITY, *y]));
                stripe.map_or(Ok(()), |area| words_in(canvas, area, AxisName::Y, label, &mut taken))?;
            }
            Layer::Band { axis, from, to, label } => {
                let stripe = layers::stripe(canvas, *axis, [*from, *to]);
                stripe.map_or(Ok(()), |area| words_in(canvas, area, *axis, label, &mut taken))?;
            }
            Layer::Guide { axis, at, label } => {
                let line = layers::guide_line(canvas, *axis, *at);
                line.map_or(Ok(()), |line| words_along(canvas, line, *axis, label, &mut taken))?;
            }
            _ => {}
        }
    }
    let both_log = canvas.frame.x.scale == Scale::Log && canvas.frame.y.scale == Scale::Log;
    for layer in &figure.layers {
        match layer {
            Layer::SlopeTriangle { order } if both_log => triangle::draw(canvas, figure, *order, &mut taken)?,
            _ => {}
        }
    }
    Ok(())
}

fn taken(canvas: &Canvas<'_>, figure: &Figure) -> Taken {
    let mut points = Vec::new();
    let mut series = Vec::new();
    for layer in &figure.layers {
        let line = match layer {
            Layer::Series(one) => {
                series.push(one);
                &one.points
            }
            Layer::Curve { points, .. } => points,
            _ => continue,
        };
        points.extend(layers::shown(canvas, line));
        for piece in layers::visible(canvas, line) {
            points.extend(piece.windows(2).flat_map(|pair| along(pair[0], pair[1])));
        }
    }
    points.extend(layers::failed_places(canvas, &series).into_iter().map(|(at, _)| at));
    let map = figure.layers.iter().any(|layer| matches!(layer, Layer::Cells(_)));
    Taken { points, boxes: Vec::new(), map }
}

/// Points of a segment, three CSS pixels apart.
fn along((x0, y0): Pixel, (x1, y1): Pixel) -> impl Iterator<Item = Pixel> {
    let steps = ((x1 - x0).abs().max((y1 - y0).abs()) / units(3.0)).max(1);
    (0..=steps).map(move |i| (x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps))
}

/// Sets words with their middle left end at a data point, moved inside the frame if they would leave it.
fn words_at(canvas: &Canvas<'_>, at: [f64; 2], text: &str, taken: &mut Taken) -> Drawn {
    let area = canvas.frame.area;
    let Some(point) = canvas.frame.mapped(at).filter(|&p| canvas.frame.window().contains(p)) else { return Ok(()) };
    let (x, y) = canvas.frame.pixel(point);
    let width = units(text_width(text, SIZE));
    let x = x.min(area.right - width - units(4.0)).max(area.left + units(4.0));
    let y = y.clamp(area.top + units(9.0), area.bottom - units(9.0));
    let around = Rect::of_text((x - units(2.0), y), text_width(text, SIZE) + 4.0, 15.0, HPos::Left);
    taken.boxes.push(around);
    canvas.rect(around, WHITE.mix(0.8).filled())?;
    canvas.text(text, (x, y), SIZE, INK, LEFT)
}

/// Sets words in a stripe where they cover least; those of a narrow vertical stripe may reach beyond it.
fn words_in(canvas: &Canvas<'_>, stripe: Rect, axis: AxisName, text: &str, taken: &mut Taken) -> Drawn {
    let width = text_width(text, SIZE);
    let across = units(width / 2.0 + 8.0);
    let columns: Vec<i32> = match axis {
        AxisName::Y => {
            (0..=8).map(|i| stripe.left + across + (stripe.right - stripe.left - 2 * across) * i / 8).collect()
        }
        AxisName::X => vec![(stripe.left + stripe.right) / 2],
    };
    let rows: Vec<i32> = match axis {
        AxisName::Y => {
            let low = stripe.bottom - units(11.0);
            vec![(stripe.top + units(11.0)).min(low), low, (stripe.top + stripe.bottom) / 2]
        }
        AxisName::X => {
            (0..=12).map(|i| stripe.top + units(24.0) + (stripe.bottom - stripe.top - units(48.0)) * i / 12).collect()
        }
    };
    let spots = rows.into_iter().flat_map(|y| columns.iter().map(move |&x| (x, y)));
    best(canvas, text, spots, taken)
}

/// Sets words just beside a straight line.
fn words_along(canvas: &Canvas<'_>, [start, end]: [Pixel; 2], axis: AxisName, text: &str, taken: &mut Taken) -> Drawn {
    let (half, side) = (units(text_width(text, SIZE) / 2.0 + 6.0), units(10.0));
    let spots: Vec<Pixel> = (0..=12)
        .flat_map(|i| match axis {
            AxisName::X => {
                let y = end.1 + units(28.0) + (start.1 - end.1 - units(52.0)) * i / 12;
                [(start.0 + half, y), (start.0 - half, y)]
            }
            AxisName::Y => {
                let x = start.0 + half + (end.0 - start.0 - 2 * half) * i / 12;
                [(x, start.1 - side), (x, start.1 + side)]
            }
        })
        .collect();
    best(canvas, text, spots.into_iter(), taken)
}

/// Sets words at the first of the spots inside the frame that cover least.
fn best(canvas: &Canvas<'_>, text: &str, spots: impl Iterator<Item = Pixel>, taken: &mut Taken) -> Drawn {
    let place = |at: Pixel| Rect::of_text(at, text_width(text, SIZE) + 8.0, 15.0, HPos::Center);
    let inside = spots.filter(|&at| place(at).inside(&canvas.frame.area));
    let Some(at) = inside.min_by_key(|&at| taken.cost(&place(at))) else { return Ok(()) };
    if text.is_empty() {
        return Ok(());
    }
    taken.boxes.push(place(at));
    if taken.map {
        // No ink can be read on every colour of a map.
        let around = Rect::of_text(at, text_width(text, SIZE) + 6.0, 15.0, HPos::Center);
        canvas.rect(around, WHITE.mix(0.85).filled())?;
    }
    canvas.text(text, at, SIZE, GREY, CENTER)
}
