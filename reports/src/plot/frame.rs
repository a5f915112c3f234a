//! Where the axes lie on the sheet, and what of the data lies between them.

use super::axis::AxisMap;
use super::backend::{Area, Backend};
use super::clip::{Point, Window, clip_line};
use super::sheet::{Pixel, Rect};
use super::tenth::tenths;
use crate::AxisName;
use plotters::coord::cartesian::Cartesian2d;
use plotters::drawing::DrawingArea;

/// A point as plotters takes it.
pub(super) type Mapped = (f64, f64);

/// The sheet, on which elements are drawn in the mapped coordinates of two axes.
pub(super) type Inside<'a> = DrawingArea<Backend<'a>, Cartesian2d<AxisMap, AxisMap>>;

/// The area between the axes, its edges on whole tenths of a pixel.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) area: Rect,
    pub(super) x: AxisMap,
    pub(super) y: AxisMap,
}

impl Frame {
    pub(super) fn window(&self) -> Window {
        Window { low: [self.x.low, self.y.low], high: [self.x.high, self.y.high] }
    }

    /// A data point in mapped coordinates, or `None` if it cannot be shown.
    pub(super) fn mapped(&self, [x, y]: Point) -> Option<Point> {
        Some([self.x.map_value(x)?, self.y.map_value(y)?])
    }

    /// The place of a point in mapped coordinates.
    pub(super) fn pixel(&self, [x, y]: Point) -> Pixel {
        (self.column(x), self.row(y))
    }

    pub(super) fn column(&self, x: f64) -> f64 {
        self.x.place(x, [self.area.left, self.area.right])
    }

    pub(super) fn row(&self, y: f64) -> f64 {
        self.y.place(y, [self.area.bottom, self.area.top])
    }

    /// Mapped coordinates on the sheet.
    pub(super) fn inside<'a>(&self, sheet: &Area<'a>) -> Inside<'a> {
        let Rect { left, top, right, bottom } = self.area;
        let place = (tenths(left)..tenths(right), tenths(bottom)..tenths(top));
        sheet.apply_coord_spec(Cartesian2d::new(self.x.clone(), self.y.clone(), place))
    }

    /// The visible pieces of a line through data points, in mapped coordinates.
    pub(super) fn pieces(&self, points: &[Point]) -> Vec<Vec<Point>> {
        let mapped: Vec<_> = points.iter().map(|&p| self.mapped(p)).collect();
        clip_line(&mapped, self.window())
    }

    /// The visible pieces of a line through data points, on the sheet.
    pub(super) fn visible(&self, points: &[Point]) -> Vec<Vec<Pixel>> {
        self.pieces(points).into_iter().map(|piece| piece.into_iter().map(|p| self.pixel(p)).collect()).collect()
    }

    /// The data points inside the frame.
    pub(super) fn shown(&self, points: &[Point]) -> Vec<Pixel> {
        let window = self.window();
        let inside = points.iter().filter_map(|&p| self.mapped(p)).filter(|&p| window.contains(p));
        inside.map(|p| self.pixel(p)).collect()
    }

    /// The rectangle between two values of an axis, cut at the frame; `None` if nothing of it is in sight.
    pub(super) fn stripe(&self, axis: AxisName, [from, to]: [f64; 2]) -> Option<Rect> {
        let map = self.axis(axis);
        // An end without a place on the axis (zero on a log axis, infinity) means: as far as the frame goes.
        let low = map.map_value(from.min(to)).unwrap_or(map.low).max(map.low);
        let high = map.map_value(from.max(to)).unwrap_or(map.high).min(map.high);
        (low < high).then(|| match axis {
            AxisName::X => Rect { left: self.column(low), right: self.column(high), ..self.area },
            AxisName::Y => Rect { top: self.row(high), bottom: self.row(low), ..self.area },
        })
    }

    /// The stripe below a floor; `None` if nothing of it is in sight.
    pub(super) fn below(&self, y: f64) -> Option<Rect> {
        self.y.map_value(y).and_then(|_| self.stripe(AxisName::Y, [f64::NEG_INFINITY, y]))
    }

    /// The ends of a straight line across the frame, lower or left first, if its value is in sight.
    pub(super) fn guide(&self, axis: AxisName, at: f64) -> Option<[Pixel; 2]> {
        let Rect { left, top, right, bottom } = self.area;
        let map = self.axis(axis);
        let m = map.map_value(at).filter(|m| map.low <= *m && *m <= map.high)?;
        Some(match axis {
            AxisName::X => [(self.column(m), bottom), (self.column(m), top)],
            AxisName::Y => [(left, self.row(m)), (right, self.row(m))],
        })
    }

    fn axis(&self, name: AxisName) -> &AxisMap {
        match name {
            AxisName::X => &self.x,
            AxisName::Y => &self.y,
        }
    }
}

/// Places along a line, about `step` CSS pixels apart, its points among them.
pub(super) fn along(line: &[Pixel], step: f64) -> impl Iterator<Item = Pixel> {
    line.windows(2).flat_map(move |pair| {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        let count = ((x1 - x0).abs().max((y1 - y0).abs()) / step).ceil().max(1.0);
        (0..=count as usize).map(move |i| (x0 + (x1 - x0) * i as f64 / count, y0 + (y1 - y0) * i as f64 / count))
    })
}
