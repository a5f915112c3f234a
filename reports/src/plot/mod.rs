//! Figures to SVG. The drawing library (plotters) is named in this module and nowhere else.
//!
//! Its known faults are met here, each with a test: a point outside the frame would be moved onto its edge and bend
//! the slope (`clip`), an infinite range would never end and its logarithmic axis loses ticks (`axis`, `ticks`), NaN
//! would be drawn at the lower edge (`Frame::mapped`), and text would be measured with a font of the machine
//! (`canvas::prepare_font`).

mod axis;
mod canvas;
mod cells;
mod clip;
mod inline;
mod labels;
mod layers;
mod markers;
mod place;
mod ticks;
mod triangle;

use crate::{Axis, AxisName, Error, Figure, Layer, Scale};
use axis::AxisMap;
use canvas::{CENTER, Canvas, Frame, GREY, INK, LEFT, Rect, UNITS, font, stroke, text_width, units, wrap};
#[cfg(feature = "png")]
pub(crate) use canvas::{FAMILY, FONT};
use plotters::prelude::*;

pub(crate) use inline::inline;

/// What the drawing library says when it refuses.
type Refused = DrawingAreaErrorKind<std::io::Error>;
/// What the library draws on.
type Sheet<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

const TITLE: f64 = 17.0;
const LABEL: f64 = 14.0;
const TICK: f64 = 12.5;
const LINE_HEIGHT: f64 = 22.0;

/// The figure as a self-contained SVG document of `figure.width` by `figure.height` CSS pixels, with a title and a
/// description for those who cannot see it. The same figure gives the same bytes on every machine.
///
/// Values that have no place on their axis (NaN, infinite, not positive on a logarithmic axis) are left out and break
/// the line; failed runs stand as crosses on the upper edge; a figure with nothing to draw says so.
///
/// # Errors
/// [`Error::Figure`] when a range is empty, the figure is too small or a map has the wrong number of cells;
/// [`Error::Drawing`] when the drawing library refuses.
pub fn svg(figure: &Figure) -> Result<String, Error> {
    let refuse =
        |place: &str, message: String| Error::Figure { figure: figure.id.clone(), place: place.to_owned(), message };
    if figure.width.min(figure.height) < 200 || figure.width.max(figure.height) > 10_000 {
        return Err(refuse("size", format!("{} by {}: expected 200 to 10000", figure.width, figure.height)));
    }
    for (index, layer) in figure.layers.iter().enumerate() {
        check(layer).map_err(|message| refuse(&format!("layer {}", index + 1), message))?;
    }
    let spread = extent(figure);
    let (x, any_x) = AxisMap::new(&figure.x, &spread.x, &spread.x_edges).map_err(|m| refuse("x axis", m))?;
    let (y, any_y) = AxisMap::new(&figure.y, &spread.y, &spread.y_edges).map_err(|m| refuse("y axis", m))?;
    let failed = |message: String| Error::Drawing { figure: figure.id.clone(), message };
    canvas::prepare_font().map_err(failed)?;
    let mut drawing = String::new();
    let size = (figure.width * UNITS as u32, figure.height * UNITS as u32);
    draw(figure, SVGBackend::with_string(&mut drawing, size), [&x, &y], any_x && any_y)
        .map_err(|e| failed(e.to_string()))?;
    Ok(finish(figure, &drawing))
}

fn check(layer: &Layer) -> Result<(), String> {
    match layer {
        Layer::Cells(cells) => cells::check(cells),
        Layer::Series(s) if !s.whiskers.is_empty() && s.whiskers.len() != s.points.len() => {
            Err(format!("series '{}' has {} whiskers for {} points", s.name, s.whiskers.len(), s.points.len()))
        }
        _ => Ok(()),
    }
}

/// The values that the axes must show.
#[derive(Default)]
struct Extent {
    x: Vec<f64>,
    y: Vec<f64>,
    x_edges: Vec<f64>,
    y_edges: Vec<f64>,
}

fn extent(figure: &Figure) -> Extent {
    let mut all = Extent::default();
    let measured = figure.layers.iter().any(|layer| matches!(layer, Layer::Series(_) | Layer::Cells(_)));
    for layer in &figure.layers {
        match layer {
            Layer::Series(series) => {
                add_points(&mut all, figure, &series.points);
                all.x.extend(&series.failed);
                all.y.extend(series.whiskers.iter().flatten());
            }
            // Theory may run off the chart; what was measured decides how much is shown.
            Layer::Curve { points, .. } if !measured => add_points(&mut all, figure, points),
            Layer::Floor { y, .. } => {
                // Some of the band has to be seen.
                let below = if figure.y.scale == Scale::Log { y / 10.0 } else { *y };
                all.y.extend([*y, below]);
            }
            Layer::Guide { axis: AxisName::X, at, .. } => all.x.push(*at),
            Layer::Guide { axis: AxisName::Y, at, .. } => all.y.push(*at),
            Layer::Cells(cells) => {
                all.x_edges.extend([cells.x0, cells.x1]);
                all.y_edges.extend([cells.y0, cells.y1]);
            }
            _ => {}
        }
    }
    all
}

/// A point counts only if both its coordinates can be shown.
fn add_points(all: &mut Extent, figure: &Figure, points: &[[f64; 2]]) {
    let shown = |axis: &Axis, v: f64| v.is_finite() && (axis.scale == Scale::Linear || v > 0.0);
    for [x, y] in points.iter().filter(|[x, y]| shown(&figure.x, *x) && shown(&figure.y, *y)) {
        all.x.push(*x);
        all.y.push(*y);
    }
}

fn draw(figure: &Figure, backend: SVGBackend<'_>, [x, y]: [&AxisMap; 2], any: bool) -> Result<(), Refused> {
    let root = backend.into_drawing_area();
    root.fill(&WHITE)?;
    let title = wrap(&figure.title, TITLE, f64::from(figure.width) - 32.0);
    for (i, line) in title.iter().enumerate() {
        let at = (units(16.0), units(24.0 + LINE_HEIGHT * i as f64));
        root.draw(&Text::new(line.clone(), at, font(TITLE).color(&INK).pos(LEFT)))?;
    }
    let frame = axes(figure, &root, [x, y], 24.0 + LINE_HEIGHT * title.len() as f64)?;
    let canvas = Canvas { root, frame };
    fill_frame(&canvas, figure, any)?;
    canvas.root.present()
}

/// Draws grid, axes and their labels below `top` (CSS pixels), and says where the frame then lies.
fn axes(figure: &Figure, root: &Sheet<'_>, [x, y]: [&AxisMap; 2], top: f64) -> Result<Frame, Refused> {
    let height = f64::from(figure.height) - top - 58.0;
    let tick_height = if y.scale == Scale::Log { 30.0 } else { 44.0 };
    let y = y.clone().with_ticks((height / tick_height) as usize);
    let tick_width = y.major.iter().map(|tick| text_width(&tick.label, TICK)).fold(0.0, f64::max);
    let (left, right) = (44.0 + tick_width, labels::margin(figure));
    let width = f64::from(figure.width) - left - right;
    let x = fitting(x, width);
    let label_size = fitted(&figure.x.label, &figure.y.label, width, height);
    let mut chart = ChartBuilder::on(root)
        .margin_top(units(top))
        .margin_right(units(right))
        .margin_bottom(units(10.0))
        .margin_left(units(12.0))
        .x_label_area_size(units(48.0))
        .y_label_area_size(units(left - 12.0))
        .build_cartesian_2d(x.clone(), y.clone())?;
    chart
        .configure_mesh()
        .x_desc(&figure.x.label)
        .y_desc(&figure.y.label)
        .axis_desc_style(font(label_size).color(&INK))
        .label_style(font(TICK).color(&INK))
        .bold_line_style(stroke(BLACK.mix(0.15), 0.5))
        .light_line_style(stroke(BLACK.mix(0.06), 0.5))
        .axis_style(stroke(INK, 1.0))
        .set_all_tick_mark_size(units(4.5))
        .draw()?;
    let (low, high) = (chart.backend_coord(&(x.low, y.low)), chart.backend_coord(&(x.high, y.high)));
    Ok(Frame { area: Rect { left: low.0, bottom: low.1, right: high.0, top: high.1 }, x, y })
}

fn fill_frame(canvas: &Canvas<'_>, figure: &Figure, any: bool) -> Result<(), Refused> {
    for layer in &figure.layers {
        if let Layer::Cells(cells) = layer {
            cells::draw(canvas, cells)?;
        }
    }
    layers::draw(canvas, figure)?;
    place::draw(canvas, figure)?;
    labels::draw(canvas, figure)?;
    let Rect { left, top, right, bottom } = canvas.frame.area;
    if !any {
        canvas.text("no finite data", ((left + right) / 2, (top + bottom) / 2), LABEL, GREY, CENTER)?;
    }
    canvas.line(vec![(left, top), (left, bottom), (right, bottom)], stroke(INK, 1.0))
}

/// As many ticks as leave a gap between their labels, and no end label that would be cut.
fn fitting(axis: &AxisMap, width: f64) -> AxisMap {
    let mut most = 12;
    loop {
        let ticked = axis.clone().with_ticks(most);
        let ends: Vec<[f64; 2]> = ticked
            .major
            .iter()
            .map(|tick| {
                let (middle, half) = (ticked.fraction(tick.at) * width, text_width(&tick.label, TICK) / 2.0);
                [middle - half, middle + half]
            })
            .collect();
        if most <= 2 || ends.windows(2).all(|pair| pair[1][0] - pair[0][1] >= 14.0) {
            return ticked;
        }
        most -= 1;
    }
}

/// The size at which both axis labels fit beside their axes.
fn fitted(x_label: &str, y_label: &str, width: f64, height: f64) -> f64 {
    let scale = |text: &str, room: f64| room / text_width(text, LABEL).max(1.0);
    (LABEL * scale(x_label, width + 80.0).min(scale(y_label, height + 40.0)).min(1.0)).max(9.0)
}

/// The header rewritten to the true size, with a name and a description; round joins, so that a noisy line has no spikes.
fn finish(figure: &Figure, drawing: &str) -> String {
    let id: String = figure.id.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect();
    let (width, height) = (figure.width, figure.height);
    let body = drawing.split_once(">\n").map_or("", |(_header, body)| body);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {} {}\" role=\"img\" \
         aria-labelledby=\"{id}-title {id}-desc\" stroke-linejoin=\"round\">\n\
         <title id=\"{id}-title\">{}</title>\n<desc id=\"{id}-desc\">{}</desc>\n{}",
        width * UNITS as u32,
        height * UNITS as u32,
        escape(&figure.title),
        escape(&figure.caption),
        canvas::with_dashes(&printable(body)).replace(" opacity=\"1\"", "").replace(" stroke=\"none\"", "")
    )
}

/// Text as it may stand between tags.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Without the control characters that XML cannot carry.
fn printable(text: &str) -> String {
    text.chars().filter(|&c| !c.is_control() || c == '\n' || c == '\t').collect()
}
