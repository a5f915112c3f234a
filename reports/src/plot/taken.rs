//! What is already on the sheet, for words and triangles that look for a free place.

use super::frame::{Frame, along};
use super::layers;
use super::sheet::{Pixel, Rect};
use crate::{Figure, Layer, Series};

/// Points along every line, and the boxes of what was set.
pub(super) struct Taken {
    pub(super) points: Vec<Pixel>,
    pub(super) boxes: Vec<Rect>,
    /// Whether there is a map below.
    pub(super) map: bool,
}

impl Taken {
    /// How much would be covered by something in this box that touches the points for which `touches` holds.
    pub(super) fn cost(&self, area: &Rect, touches: impl Fn(Pixel) -> bool) -> usize {
        let points = self.points.iter().filter(|&&p| touches(p)).count();
        points + 50 * self.boxes.iter().filter(|other| other.overlaps(area)).count()
    }
}

/// What the data of a figure take.
pub(super) fn of(frame: &Frame, figure: &Figure) -> Taken {
    let mut points = Vec::new();
    for layer in &figure.layers {
        let (Layer::Series(Series { points: line, .. }) | Layer::Curve { points: line, .. }) = layer else { continue };
        points.extend(frame.shown(line));
        points.extend(frame.visible(line).iter().flat_map(|piece| along(piece, 3.0)));
    }
    let series: Vec<&Series> = layers::series(figure).collect();
    points.extend(layers::failed_places(frame, &series).into_iter().map(|(at, _)| at));
    let map = figure.layers.iter().any(|layer| matches!(layer, Layer::Cells(_)));
    Taken { points, boxes: Vec::new(), map }
}
