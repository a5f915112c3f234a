//! Work-precision diagrams and U-curves.

use integrator::methods::MethodId;
use integrator::rigid_body::Formulation;
use reports::{Axis, Figure, Layer, Line, Series};

use super::candidate::Candidate;
use super::cost_at_error::sweeps;
use super::rounding_optimum::{INDEPENDENT, Minimum, SHOWN, minima};
use super::{CostMeasure, Part, Row, overview};
use crate::names::scene_title;
use crate::study::color_of;
use scenes::run::Precision;
use scenes::scheme::Rule;

/// The charts on the page; the others are linked.
const ON_PAGE: [&str; 5] = [
    "work-evaluations-pendulum",
    "work-time-pendulum",
    "work-time-kepler",
    "work-time-tennis-racket",
    "rounding-optimum-tennis-racket",
];

/// Errors above this are no errors of a method that follows the motion at all.
const LARGEST_ERROR: f64 = 10.0;

pub(super) fn all(rows: &[Row]) -> Vec<Figure> {
    let runs: Vec<&Row> = rows.iter().filter(|row| row.part == Part::Run).collect();
    let minima = minima(rows);
    let mut figures: Vec<Figure> = overview::figure(rows).into_iter().collect();
    for of_scene in runs.chunk_by(|a, b| a.scene == b.scene) {
        let sweeps = sweeps(of_scene);
        figures.extend(CostMeasure::ALL.into_iter().filter_map(|charge| work(&sweeps, charge)));
        let of_scene: Vec<&Minimum> = minima.iter().filter(|m| m.scene == of_scene[0].scene).collect();
        figures.extend(rounding_optimum(&sweeps, &of_scene));
    }
    figures
}

fn work(sweeps: &[Vec<&Row>], charge: CostMeasure) -> Option<Figure> {
    let layers: Vec<Layer> = sweeps.iter().filter_map(|sweep| series(sweep, charge)).map(Layer::Series).collect();
    let first = sweeps.first().and_then(|sweep| sweep.first()).filter(|_| !layers.is_empty())?;
    let scene = first.scene.as_str();
    let (id, title, y, caption) = match charge {
        CostMeasure::Evaluations => (
            "evaluations",
            "error against evaluations",
            "evaluations of the force up to the horizon",
            "Lower is cheaper, further left is more accurate: the lowest line at an error is the cheapest. Counted exactly, in \
             f64. A method without any error on this scene has no line.",
        ),
        CostMeasure::Time => (
            "time",
            "error against time",
            "time for a simulated second (ns)",
            "The same in time, least over the rounds, with a whisker up to the upper quartile: what a step costs beside \
             its evaluations counts too. Of this machine and this run. A method without any error on this scene has no line.",
        ),
    };
    let id = format!("work-{id}-{}", scene.replace('/', "-"));
    Some(Figure {
        on_page: ON_PAGE.contains(&id.as_str()),
        id,
        title: format!("{}: {title}, f64", scene_title(scene)),
        caption: caption.to_owned(),
        x: Axis::log(format!("largest error up to the horizon ({})", first.unit)),
        y: Axis::log(y),
        layers,
        scene: Some(scene.to_owned()),
        data: "tradeoff.run.csv".to_owned(),
        ..Figure::default()
    })
}

/// One line of a chart; `None` for what it does not show.
fn series(sweep: &[&Row], charge: CostMeasure) -> Option<Series> {
    let candidate = Candidate::from_id(&sweep[0].method).filter(|c| is_shown(*c, charge))?;
    if sweep[0].precision != Precision::F64 {
        return None;
    }
    let shown: Vec<(&Row, [f64; 2])> = sweep
        .iter()
        .filter_map(|row| {
            let error = row.scored().filter(|e| *e > 0.0 && *e <= LARGEST_ERROR)?;
            Some((*row, [error, charge.of(row)?]))
        })
        .collect();
    if shown.is_empty() {
        return None;
    }
    let whisker = |row: &Row| Some([row.least_ns_per_step? / row.h_s, row.upper_ns_per_step? / row.h_s]);
    let whiskers = match charge {
        CostMeasure::Evaluations => Vec::new(),
        CostMeasure::Time => shown.iter().filter_map(|(row, _)| whisker(row)).collect(),
    };
    let line = match (candidate.scheme.rule, candidate.scheme.storage) {
        (Rule::Rigid(_), _) => Line::Dotted,
        (Rule::General(_), Formulation::WorldOmega) if candidate.is_rigid => Line::Dashed,
        _ => Line::Solid,
    };
    let series = Series::new(candidate.label(), candidate.color(), shown.iter().map(|(_, point)| *point).collect());
    Some(Series { whiskers, line: Some(line), marker: candidate.marker().or(series.marker), ..series })
}

/// Of a rigid body every method with the angular velocity of the body; with that of the world, of which only the time differs with
/// semi-implicit Euler, two for comparison.
fn is_shown(candidate: Candidate, charge: CostMeasure) -> bool {
    let of_world = candidate.is_rigid && candidate.scheme.storage == Formulation::WorldOmega;
    match candidate.method() {
        Some(method) if of_world => {
            charge == CostMeasure::Time && matches!(method, MethodId::SemiImplicitEuler | MethodId::Rk4)
        }
        _ => true,
    }
}

fn rounding_optimum(sweeps: &[Vec<&Row>], minima: &[&Minimum]) -> Option<Figure> {
    let mut layers = Vec::new();
    for sweep in sweeps {
        let first = sweep[0];
        let Some(candidate) = Candidate::from_id(&first.method) else { continue };
        let Some(method) = candidate.method().filter(|m| SHOWN.contains(m)) else { continue };
        if candidate.is_rigid && candidate.scheme.storage != Formulation::BodyOmega {
            continue;
        }
        let Some(minimum) = minima.iter().find(|m| m.method == first.method && m.precision == first.precision) else {
            continue;
        };
        let points = sweep
            .iter()
            .filter_map(|row| Some([row.h_s, row.scored().filter(|e| *e > 0.0 && *e <= LARGEST_ERROR)?]))
            .collect();
        let line = if first.precision == Precision::F32 { Line::Solid } else { Line::Dashed };
        let name = format!("{}, {}", method.title(), first.precision.id());
        layers.push(Layer::Series(Series { line: Some(line), ..Series::new(name, color_of(method), points) }));
        layers.push(model(minimum, sweep));
    }
    let first = sweeps.first().and_then(|sweep| sweep.first()).filter(|_| !layers.is_empty())?;
    let id = format!("rounding-optimum-{}", first.scene.replace('/', "-"));
    Some(Figure {
        on_page: ON_PAGE.contains(&id.as_str()),
        id,
        title: format!("{}: where a smaller step is worse", scene_title(&first.scene)),
        caption: "Truncation falls with the step, rounding grows with the number of steps, and between them lies the best step. \
                  Lines without marks are an estimate to which nothing was fitted, A / n^p + eps S sqrt(n) / 10: independent roundings. \
                  Where roundings add up instead, as on many rigid bodies in f32, the measured error lies above it."
            .to_owned(),
        x: Axis::log("step size h (s)"),
        y: Axis::log(format!("largest error up to the horizon ({})", first.unit)),
        layers,
        scene: Some(first.scene.to_owned()),
        data: "tradeoff.run.csv".to_owned(),
        ..Figure::default()
    })
}

/// Truncation and independent roundings, over the steps of a sweep.
fn model(minimum: &Minimum, sweep: &[&Row]) -> Layer {
    let rounding = INDEPENDENT * minimum.precision.epsilon() * sweep[0].scale.unwrap_or(1.0);
    let point = |row: &&Row| {
        let n = row.steps as f64;
        [row.h_s, minimum.truncation / n.powi(minimum.order as i32) + rounding * n.sqrt()]
    };
    Layer::Curve { name: String::new(), points: sweep.iter().map(point).collect(), color: None }
}
