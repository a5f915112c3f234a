//! Charts as data: what is drawn, in the units of the data, without a word on how.

use serde::{Deserialize, Serialize};

/// One chart. [`crate::plot::svg`] draws it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// File stem, unique within a report: `convergence_kepler`.
    pub id: String,
    /// Title above the chart.
    pub title: String,
    /// One sentence: what to see. Also the description read to those who cannot see the chart.
    pub caption: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, from the back to the front within each kind.
    pub layers: Vec<Layer>,
    /// The scene that it is about, if it is about one.
    #[serde(default)]
    pub scene: Option<String>,
    /// Whether the page shows it; if not, the page links to it.
    #[serde(default = "yes")]
    pub on_page: bool,
    /// The command that makes this figure again.
    pub command: String,
    /// Name of the CSV file that holds every number drawn.
    pub data: String,
    /// Width in CSS pixels.
    pub width: u32,
    /// Height in CSS pixels.
    pub height: u32,
    /// One unit is as long on either axis, so that a disc is round; both axes linear.
    #[serde(default)]
    pub equal_axes: bool,
}

impl Default for Figure {
    fn default() -> Self {
        Self {
            id: String::new(),
            title: String::new(),
            caption: String::new(),
            x: Axis::default(),
            y: Axis::default(),
            layers: Vec::new(),
            scene: None,
            on_page: true,
            command: String::new(),
            data: String::new(),
            width: 800,
            height: 560,
            equal_axes: false,
        }
    }
}

fn yes() -> bool {
    true
}

/// How an axis maps its values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Equal differences take equal room.
    #[default]
    Linear,
    /// Equal ratios take equal room; only positive values can be shown.
    Log,
}

/// One axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Quantity and unit: `step size h (s)`.
    pub label: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// The ends shown, low then high; from the data when `None`.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis whose range follows the data.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None }
    }

    /// A logarithmic axis whose range follows the data.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log, range: None }
    }

    /// The same axis with fixed ends.
    #[must_use]
    pub fn with_range(self, low: f64, high: f64) -> Self {
        Self { range: Some([low, high]), ..self }
    }
}

/// Which axis a line or a band belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AxisName {
    /// The horizontal axis: a guide `X` is a vertical line.
    X,
    /// The vertical axis: a guide `Y` is a horizontal line.
    Y,
}

/// Shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "the names say all there is")]
pub enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
    Plus,
    InvertedTriangle,
    Star,
}

impl Marker {
    /// All shapes, in the order in which series take them.
    pub const ALL: [Self; 8] = [
        Self::Circle,
        Self::Square,
        Self::Triangle,
        Self::Diamond,
        Self::Cross,
        Self::Plus,
        Self::InvertedTriangle,
        Self::Star,
    ];

    /// The shape that goes with a palette colour, so that a series is known by either.
    pub fn of_color(color: usize) -> Self {
        Self::ALL[color % Self::ALL.len()]
    }
}

/// Style of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "the names say all there is")]
pub enum Line {
    Solid,
    Dashed,
    Dotted,
}

/// Measured points, usually joined by a line.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Label set beside its right end.
    pub name: String,
    /// (x, y), in the order in which they are joined. A point that cannot be shown breaks the line.
    pub points: Vec<[f64; 2]>,
    /// Palette index, 0 to 7; counted on from the start beyond.
    pub color: usize,
    /// Shape of the points; none drawn when `None`.
    pub marker: Option<Marker>,
    /// Style of the line; none drawn when `None`.
    pub line: Option<Line>,
    /// x of the runs that failed: shown as crosses on the upper edge.
    pub failed: Vec<f64>,
    /// (low, high) of every point, or empty for no whiskers.
    pub whiskers: Vec<[f64; 2]>,
}

impl Series {
    /// Points joined by a solid line, with the shape that goes with the colour.
    pub fn new(name: impl Into<String>, color: usize, points: Vec<[f64; 2]>) -> Self {
        Self {
            name: name.into(),
            points,
            color,
            marker: Some(Marker::of_color(color)),
            line: Some(Line::Solid),
            ..Self::default()
        }
    }
}

/// How the values of [`Cells`] become colours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Palette {
    /// From light (least) to dark (greatest), with a scale beside the chart.
    Sequential {
        /// What the colour means, with its unit.
        label: String,
        /// How values map to colour.
        scale: Scale,
    },
    /// One colour a kind, with a legend beside the chart. The value is the index of the name.
    Categories {
        /// The kinds, in order.
        names: Vec<String>,
    },
}

/// A map of `nx` by `ny` cells. On a logarithmic axis the cells have equal ratios instead of equal differences.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cells {
    /// Left edge of the first column.
    pub x0: f64,
    /// Right edge of the last column.
    pub x1: f64,
    /// Number of columns.
    pub nx: usize,
    /// Lower edge of the first row.
    pub y0: f64,
    /// Upper edge of the last row.
    pub y1: f64,
    /// Number of rows.
    pub ny: usize,
    /// Row after row from `y0` up, `nx * ny` in all; a cell without a value is grey.
    pub values: Vec<Option<f64>>,
    /// How values become colours.
    pub palette: Palette,
}

/// One thing drawn in a chart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layer {
    /// Measured points.
    Series(Series),
    /// A triangle that shows the slope y ~ x^order, set near the data but not over them; both axes logarithmic.
    SlopeTriangle {
        /// The exponent; its number stands beside the triangle.
        order: f64,
    },
    /// A shaded band under `y`, below which nothing can be measured.
    Floor {
        /// Upper edge.
        y: f64,
        /// What floor it is.
        label: String,
    },
    /// A straight line across the chart at one value.
    Guide {
        /// The axis `at` is read on.
        axis: AxisName,
        /// The value.
        at: f64,
        /// What it marks.
        label: String,
    },
    /// A shaded stripe across the chart between two values.
    Band {
        /// The axis the ends are read on.
        axis: AxisName,
        /// Lower end.
        from: f64,
        /// Upper end.
        to: f64,
        /// What it marks.
        label: String,
    },
    /// A heat map or a map of kinds.
    Cells(Cells),
    /// A curve of theory: thin, dark, dashed.
    Curve {
        /// Label set beside its right end.
        name: String,
        /// (x, y), in the order in which they are joined.
        points: Vec<[f64; 2]>,
        /// Palette index, or dark ink when `None`.
        color: Option<usize>,
    },
    /// Words at a point of the chart.
    Text {
        /// Left end of the words, at half their height.
        at: [f64; 2],
        /// The words.
        text: String,
    },
}
