//! Work against accuracy over all scenes in one chart.

use integrator::methods::MethodId;
use integrator::rigid_body::Formulation;
use reports::{Axis, Figure, Layer, Series};
use scenes::run::Precision;

use super::candidate::Candidate;
use super::cells::runs;
use super::cost_at_error::{CostBound, offer, sweeps};
use super::{CostMeasure, Row};
use crate::study::{color_of, distinct};

/// Errors at which the work is read off: from a tenth down, three in a decade.
const POINTS: i32 = 24;
/// Fewer scenes than this are not 'all scenes'.
const FEWEST: usize = 2;

/// The sweeps of one scene with what makes them comparable.
struct OfScene<'a> {
    scale: f64,
    time_scale_s: f64,
    sweeps: Vec<(MethodId, Vec<&'a Row>)>,
}

/// A line for each general method: the median over the scenes of its work per time scale.
pub(super) fn figure(rows: &[Row]) -> Option<Figure> {
    let runs = runs(rows);
    let scenes: Vec<OfScene<'_>> = distinct(runs.iter().map(|row| row.scene.as_str()))
        .into_iter()
        .filter_map(|scene| of_scene(&runs.iter().copied().filter(|row| row.scene == scene).collect::<Vec<_>>()))
        .collect();
    if scenes.len() < FEWEST {
        return None;
    }
    let line = |&method: &MethodId| {
        let point = |k| {
            let error = 10.0_f64.powf(-1.0 - f64::from(k) / 3.0);
            Some([error, median(scenes.iter().map(|scene| work(scene, method, error)).collect())?])
        };
        let points: Vec<[f64; 2]> = (0..=POINTS).filter_map(point).collect();
        (!points.is_empty()).then(|| Layer::Series(Series::new(method.title(), color_of(method), points)))
    };
    let layers: Vec<Layer> = MethodId::ALL.iter().filter_map(line).collect();
    (!layers.is_empty()).then(|| Figure {
        id: "work-all-scenes".to_owned(),
        title: "Work against accuracy, all scenes, f64".to_owned(),
        caption: format!(
            "The median over {} scenes of the evaluations per time scale that a method needs for an error relative to the size of \
             the motion. Lower is cheaper. A line ends where half of the scenes do not reach the error; rigid bodies store the \
             angular velocity of the body.",
            scenes.len()
        ),
        x: Axis::log("error relative to the size of the motion (1)"),
        y: Axis::log("evaluations of the force per time scale (1)"),
        layers,
        data: "tradeoff.run.csv".to_owned(),
        height: 480,
        ..Figure::default()
    })
}

fn of_scene<'a>(rows: &[&'a Row]) -> Option<OfScene<'a>> {
    let general = |sweep: Vec<&'a Row>| {
        let candidate = Candidate::from_id(&sweep[0].method)?;
        let is_shown = !candidate.is_rigid || candidate.scheme.storage == Formulation::BodyOmega;
        candidate.method().filter(|_| is_shown && sweep[0].precision == Precision::F64).map(|method| (method, sweep))
    };
    Some(OfScene {
        scale: rows.iter().find_map(|row| row.scale).filter(|scale| *scale > 0.0 && scale.is_finite())?,
        time_scale_s: rows.iter().find_map(|row| row.time_scale_s)?,
        sweeps: sweeps(rows).into_iter().filter_map(general).collect(),
    })
}

/// Evaluations per time scale; infinite where the error is not reached.
fn work(scene: &OfScene<'_>, method: MethodId, error: f64) -> f64 {
    let sweep = scene.sweeps.iter().find(|(known, _)| *known == method).map(|(_, sweep)| sweep);
    let Some((sweep, first)) = sweep.and_then(|sweep| Some((sweep, sweep.first()?))) else { return f64::INFINITY };
    let end_s = first.h_s * first.steps as f64;
    match offer(sweep, error * scene.scale, CostMeasure::Evaluations) {
        CostBound::At(price) => price.cost * scene.time_scale_s / end_s,
        CostBound::Above(_) | CostBound::Never => f64::INFINITY,
    }
}

/// The upper median, where it is finite.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().filter(|value| value.is_finite())
}
