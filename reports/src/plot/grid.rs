//! Title, axes and grid, and the frame that they leave for the data.

use super::axis::AxisMap;
use super::backend::{STYLE, line};
use super::frame::Frame;
use super::labels;
use super::sheet::{Anchor, Rect, Sheet};
use super::text::{text_width, wrap};
use crate::{Figure, Scale};
use plotters::coord::ranged1d::BoldPoints;

const TITLE: f64 = 17.0;
pub(super) const LABEL: f64 = 14.0;
const TICK: f64 = 12.5;
/// Length of a tick.
const MARK: f64 = 4.5;
/// From one line of a title, and of the words along an axis, to the next.
const TITLE_LINE: f64 = 22.0;
const LABEL_LINE: f64 = 17.0;

/// Draws all that stands around the data, and says where the frame lies.
pub(super) fn draw(sheet: &mut Sheet, figure: &Figure, [x, y]: [&AxisMap; 2]) -> Frame {
    let (width, height) = (f64::from(figure.width), f64::from(figure.height));
    let mut top = 24.0;
    for line in wrap(&figure.title, TITLE, width - 32.0) {
        sheet.text("fi", &line, (16.0, top), TITLE, Anchor::Start);
        top += TITLE_LINE;
    }
    let right = width - labels::margin(figure);
    let x_label = wrap(&figure.x.label, LABEL, 0.75 * width);
    let bottom = height - 58.0 - LABEL_LINE * x_label.len().saturating_sub(1) as f64;
    let y_label = wrap(&figure.y.label, LABEL, (bottom - top + 40.0).max(60.0));
    let y = y.clone().with_ticks(((bottom - top) / if figure.y.scale == Scale::Log { 30.0 } else { 44.0 }) as usize);
    let tick_width = y.major.iter().map(|tick| text_width(&tick.label, TICK)).fold(0.0, f64::max);
    let left = 44.0 + tick_width + LABEL_LINE * y_label.len().saturating_sub(1) as f64;
    let area = Rect { left, top, right: right.max(left + 40.0), bottom: bottom.max(top + 40.0) };
    let area = if figure.equal_axes { equal(area, x, &y) } else { area };
    let frame = Frame { area: area.in_tenths(), x: fitting(x, area.width()), y };
    mesh(sheet, &frame);
    let middle = area.middle();
    for (i, line) in x_label.iter().enumerate() {
        sheet.text("fi", line, (middle.0, area.bottom + 39.0 + LABEL_LINE * i as f64), LABEL, Anchor::Middle);
    }
    for (i, line) in y_label.iter().enumerate() {
        let place = (19.0 + LABEL_LINE * i as f64, middle.1.max(text_width(line, LABEL) / 2.0 + 4.0));
        sheet.upright_text("fi", line, place, LABEL);
    }
    frame
}

/// The largest part of the area in which one unit is as long on either axis, in its upper left corner.
fn equal(area: Rect, x: &AxisMap, y: &AxisMap) -> Rect {
    let (across, up) = (x.high - x.low, y.high - y.low);
    let unit = (area.width() / across).min(area.height() / up);
    // No less than can hold the ticks, however long and thin the ranges are.
    let [width, height] = [unit * across, unit * up].map(|length| length.max(40.0));
    Rect { right: area.left + width, bottom: area.top + height, ..area }
}

/// As many ticks as leave a gap between their labels.
fn fitting(axis: &AxisMap, width: f64) -> AxisMap {
    let ticked = |most| axis.clone().with_ticks(most);
    let fits = |axis: &AxisMap| {
        let end = |at: f64, label: &str, side: f64| axis.fraction(at) * width + side * text_width(label, TICK) / 2.0;
        axis.major.windows(2).all(|t| end(t[1].at, &t[1].label, -1.0) - end(t[0].at, &t[0].label, 1.0) >= 14.0)
    };
    (3..=12).rev().map(ticked).find(fits).unwrap_or_else(|| ticked(2))
}

fn mesh(sheet: &mut Sheet, frame: &Frame) {
    let Rect { left, bottom, .. } = frame.area;
    let all = usize::MAX;
    sheet.path("minor", |area| frame.inside(area).draw_mesh(|backend, line| line.draw(backend, &STYLE), all, all));
    sheet.path("major", |area| {
        let bold = || BoldPoints(all);
        frame.inside(area).draw_mesh(|backend, line| line.draw(backend, &STYLE), bold(), bold())
    });
    for tick in &frame.x.major {
        sheet.text("fi", &tick.label, (frame.column(tick.at), bottom + 15.0), TICK, Anchor::Middle);
    }
    for tick in &frame.y.major {
        sheet.text("fi", &tick.label, (left - 9.0, frame.row(tick.at)), TICK, Anchor::End);
    }
}

/// The two axes with their ticks, drawn last, over the data that reach them.
pub(super) fn axes(sheet: &mut Sheet, frame: &Frame) {
    let Rect { left, top, right, bottom } = frame.area;
    let columns = frame.x.major.iter().map(|tick| frame.column(tick.at));
    let rows = frame.y.major.iter().map(|tick| frame.row(tick.at));
    sheet.path("axis", |area| {
        area.draw(&line(&[(left, top), (left, bottom), (right, bottom)]))?;
        for x in columns {
            area.draw(&line(&[(x, bottom), (x, bottom + MARK)]))?;
        }
        for y in rows {
            area.draw(&line(&[(left - MARK, y), (left, y)]))?;
        }
        Ok(())
    });
}
