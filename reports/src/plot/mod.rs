//! Figures to SVG.
//!
//! plotters maps coordinates and draws elements, onto a backend of this module that writes them as SVG with classes. Scales,
//! ticks and clipping are this module's own (plotters moves a point beyond the frame onto its edge, which bends the line), and
//! so are words and their places.
//!
//! ```text
//! axis, ticks   values to fractions of an axis        style    colours, dashes
//! frame, clip   fractions to the sheet                sheet    words as SVG
//! backend       plotters' elements as SVG paths
//! grid, layers, cells, labels, place, triangle        what is drawn, back to front
//! ```

mod axis;
mod backend;
mod cells;
mod clip;
mod frame;
mod grid;
mod labels;
mod layers;
mod markers;
mod overlap;
mod place;
mod sheet;
mod style;
mod taken;
mod tenth;
mod text;
mod ticks;
mod triangle;

use crate::{Axis, AxisName, Error, Figure, Layer, Scale};
use axis::AxisMap;
use sheet::{Anchor, Rect, Sheet, escape};
pub(crate) use style::of_page;
#[cfg(feature = "png")]
pub(crate) use text::{FAMILY, FONT};

/// The figure as a self-contained SVG document of `figure.width` by `figure.height` CSS pixels, with a title and a
/// description for those who cannot see it, light or dark as the reader prefers. The same figure gives the same bytes on
/// every machine.
///
/// Values that have no place on their axis (NaN, infinite, not positive on a logarithmic axis) are left out and break
/// the line; failed runs stand as crosses on the upper edge; a figure with nothing to draw says so.
///
/// # Errors
/// [`Error::Figure`] when a range is empty, the figure is too small or a map has the wrong number of cells.
pub fn svg(figure: &Figure) -> Result<String, Error> {
    let (width, height, style) = (figure.width, figure.height, style::of_file());
    let id: String = figure.id.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect();
    let head = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         role=\"img\" aria-labelledby=\"{id}-title {id}-desc\" font-family=\"{}\" fill=\"none\" stroke-linejoin=\"round\">\n",
        text::FAMILY
    );
    let sheet = Rect { left: 0.0, top: 0.0, right: width.into(), bottom: height.into() };
    let mut ground = Sheet::new((width, height));
    ground.rect("ground", sheet);
    let names = named(figure, &format!("{id}-title"), &format!("{id}-desc"));
    Ok(format!("{head}{names}<style>{style}</style>\n{}{}</svg>\n", ground.body, body(figure)?))
}

/// The figure as a part of a page that has the style [`of_page`]; its title and description get ids that start with `id`.
///
/// # Errors
/// As [`svg`].
pub(crate) fn inline(figure: &Figure, id: &str) -> Result<String, Error> {
    let (width, height) = (figure.width, figure.height);
    let names = named(figure, &format!("{id}-t"), &format!("{id}-d"));
    Ok(format!(
        "<svg class=\"chart\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-labelledby=\"{id}-t {id}-d\">{names}{}</svg>",
        body(figure)?
    ))
}

fn named(figure: &Figure, title: &str, desc: &str) -> String {
    let [name, caption] = [&figure.title, &figure.caption].map(|words| escape(words));
    format!("<title id=\"{title}\">{name}</title>\n<desc id=\"{desc}\">{caption}</desc>\n")
}

/// What is drawn.
fn body(figure: &Figure) -> Result<String, Error> {
    let refuse =
        |place: &str, message: String| Error::Figure { figure: figure.id.clone(), place: place.to_owned(), message };
    if figure.width.min(figure.height) < 200 || figure.width.max(figure.height) > 10_000 {
        return Err(refuse("size", format!("{} by {}: expected 200 to 10000", figure.width, figure.height)));
    }
    if figure.equal_axes && (figure.x.scale, figure.y.scale) != (Scale::Linear, Scale::Linear) {
        return Err(refuse("axes", "equal units need two linear axes".to_owned()));
    }
    for (index, layer) in figure.layers.iter().enumerate() {
        check(layer).map_err(|message| refuse(&format!("layer {}", index + 1), message))?;
    }
    let spread = extent(figure);
    let (x, any_x) = AxisMap::new(&figure.x, &spread.x, &spread.x_edges).map_err(|m| refuse("x axis", m))?;
    let (y, any_y) = AxisMap::new(&figure.y, &spread.y, &spread.y_edges).map_err(|m| refuse("y axis", m))?;
    let mut sheet = Sheet::new((figure.width, figure.height));
    let frame = grid::draw(&mut sheet, figure, [&x, &y]);
    layers::draw(&mut sheet, &frame, figure);
    let mut taken = taken::of(&frame, figure);
    place::draw(&mut sheet, &frame, figure, &mut taken);
    triangle::draw(&mut sheet, &frame, figure, &mut taken);
    labels::draw(&mut sheet, &frame, figure);
    if !(any_x && any_y) {
        sheet.text("fg", "no finite data", frame.area.middle(), grid::LABEL, Anchor::Middle);
    }
    grid::axes(&mut sheet, &frame);
    Ok(sheet.body)
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
