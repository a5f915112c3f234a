//! Charts.

use reports::{Axis, AxisName, Figure, Layer, Series};

use super::laws::{self, nutation_factor};
use super::row::{Experiment, Row};
use super::scheme::Scheme;
use crate::names::scene_title;
use crate::study::distinct;

/// Schemes drawn in the charts, in the order of their colours.
const DRAWN: [&str; 8] = [
    "semi-implicit-euler/body-omega",
    "explicit-euler/world-omega",
    "semi-implicit-euler/world-momentum",
    "semi-implicit-euler/without-gyroscopic-term",
    "implicit-gyroscopic",
    "restored-momentum",
    "momentum-midpoint",
    "free-splitting",
];

fn name(id: &str) -> String {
    match id {
        "semi-implicit-euler/body-omega" => "semi-implicit, ω".to_owned(),
        "explicit-euler/world-omega" => "explicit, world ω".to_owned(),
        "semi-implicit-euler/world-momentum" => "Euler, world L".to_owned(),
        "semi-implicit-euler/without-gyroscopic-term" => "no gyroscopic term".to_owned(),
        other => other.replace('-', " "),
    }
}

pub(super) fn figures(rows: &[Row]) -> Vec<Figure> {
    let mut figures: Vec<Figure> = ["torque-free-spin", "heavy-top", "sphere-torque"]
        .into_iter()
        .filter_map(|scene| errors(rows, scene))
        .collect();
    figures.extend(
        distinct(rows.iter().filter(|r| r.experiment == Experiment::LongRun).map(|r| r.subject.as_str()))
            .into_iter()
            .map(|s| axis(rows, s)),
    );
    figures.push(nutation(rows));
    figures
        .retain(|figure| figure.layers.iter().any(|layer| matches!(layer, Layer::Series(s) if !s.points.is_empty())));
    figures
}

fn command() -> String {
    "cargo run --release --bin rotation".to_owned()
}

fn errors(rows: &[Row], scene: &str) -> Option<Figure> {
    let of_scene: Vec<&Row> = rows
        .iter()
        .filter(|row| row.experiment == Experiment::Error && row.subject == scene && row.quantity == "attitude")
        .collect();
    let mut layers: Vec<Layer> = DRAWN
        .iter()
        .enumerate()
        .map(|(color, id)| {
            let of_scheme = of_scene.iter().filter(|row| row.scheme == *id);
            let points = of_scheme.filter_map(|row| Some([row.h_s, row.value.filter(|e| *e > 0.0)?])).collect();
            Layer::Series(Series::new(name(id), color, points))
        })
        .collect();
    layers.extend([1.0, 2.0].map(|order| Layer::SlopeTriangle { order }));
    (!of_scene.is_empty()).then(|| Figure {
        id: format!("rotation-error-{scene}"),
        title: format!("{}: attitude error of eight schemes", scene_title(scene)),
        caption: "First-order schemes differ by a factor, second-order ones fall twice as fast; where the gyroscopic term matters, \
                  a scheme without it does not converge at all."
            .to_owned(),
        x: Axis::log("step size h (s)"),
        y: Axis::log("attitude error at the end (rad)"),
        layers,
        command: command(),
        data: "rotation.csv".to_owned(),
        ..Figure::default()
    })
}

fn axis(rows: &[Row], subject: &str) -> Figure {
    let mut layers: Vec<Layer> = DRAWN
        .iter()
        .enumerate()
        .map(|(color, id)| {
            let of = rows.iter().filter(|r| {
                r.experiment == Experiment::LongRun
                    && r.subject == subject
                    && r.scheme == *id
                    && r.quantity == "axis coordinate"
            });
            let points = of.filter_map(|row| Some([row.t_s, row.value?])).collect();
            Layer::Series(Series { marker: None, ..Series::new(name(id), color, points) })
        })
        .collect();
    // Moments 1, 2, 3: (1/2 - 1/3) / (1 - 1/3).
    layers.push(Layer::Guide { axis: AxisName::Y, at: 0.25, label: "separatrix".to_owned() });
    Figure {
        id: format!("rotation-axis-{}", subject.replace(' ', "-")),
        title: format!("Where a free body ends up: {subject}"),
        caption: "0: it spins about the axis of most inertia, 1: of least. The exact motion keeps the value; the scheme decides \
                  where the body drifts."
            .to_owned(),
        x: Axis::linear("time (s)"),
        y: Axis::linear("axis coordinate (1)").with_range(-0.05, 1.05),
        layers,
        command: command(),
        data: "rotation.csv".to_owned(),
        ..Figure::default()
    }
}

/// The size of theory's curve.
const CURVE: u32 = 64;

/// The factor against the step: theory's curves, and what was measured.
fn nutation(rows: &[Row]) -> Figure {
    let mut layers = vec![Layer::Guide { axis: AxisName::Y, at: 1.0, label: "kept".to_owned() }];
    for (color, id) in DRAWN.iter().enumerate() {
        let Some(scheme) = Scheme::from_id(id) else { continue };
        let of = rows.iter().filter(|r| r.experiment == Experiment::Nutation && r.subject == "disc" && r.scheme == *id);
        let mut points: Vec<[f64; 2]> = of.filter_map(|row| Some([laws::DISC_SPIN * row.h_s, row.value?])).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        layers.push(Layer::Series(Series { line: None, ..Series::new(name(id), color, points) }));
        let curve = (1..=CURVE).filter_map(|i| {
            let x = 2.0 * f64::from(i) / f64::from(CURVE);
            Some([x, nutation_factor(scheme, 2.0, x)?])
        });
        let points: Vec<[f64; 2]> = curve.collect();
        if !points.is_empty() {
            layers.push(Layer::Curve { name: String::new(), points, color: Some(color) });
        }
    }
    Figure {
        id: "rotation-nutation-disc".to_owned(),
        title: "Nutation of a spinning disc: its factor in one step".to_owned(),
        caption: "Above 1 the wobble grows in every step, below 1 it is damped, at 1 it is kept. Points are eigenvalues of the \
                  linearised step, dashed curves the formulas."
            .to_owned(),
        x: Axis::linear("ω h (rad in a step)"),
        y: Axis::linear("nutation factor a step (1)"),
        layers,
        command: command(),
        data: "rotation.csv".to_owned(),
        ..Figure::default()
    }
}
