//! Work against accuracy over all scenes in one chart.

use integrator::methods::MethodId;
use integrator::rigid_body::Formulation;
use reports::{Axis, Figure, Layer, Series};
use scenes::run::Precision;

use super::candidate::Candidate;
use super::cells::{OfScene, by_scene};
use super::cost_at_error::{CostBound, offer, sweeps};
use super::{CostMeasure, Row};
use crate::study::color_of;

/// Errors at which the work is read off: from a tenth down, three in a decade.
const POINTS: i32 = 24;
/// Fewer scenes than this are not 'all scenes'.
const FEWEST: usize = 2;

/// A scene with its sweeps of general methods.
type Swept<'a> = (OfScene<'a>, Vec<(MethodId, Vec<&'a Row>)>);

/// A line for each general method: the median over the scenes of its work per time scale.
pub(super) fn figure(rows: &[Row]) -> Option<Figure> {
    let scenes: Vec<Swept<'_>> = by_scene(rows).into_iter().map(swept).collect();
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

fn swept(scene: OfScene<'_>) -> Swept<'_> {
    let general = |sweep: Vec<_>| {
        let first: &Row = sweep[0];
        let candidate = Candidate::from_id(&first.method)?;
        let is_shown = !candidate.is_rigid || candidate.scheme.storage == Formulation::BodyOmega;
        candidate.method().filter(|_| is_shown && first.precision == Precision::F64).map(|method| (method, sweep))
    };
    let sweeps = sweeps(&scene.runs).into_iter().filter_map(general).collect();
    (scene, sweeps)
}

/// Evaluations per time scale; infinite where the error is not reached.
fn work((scene, sweeps): &Swept<'_>, method: MethodId, error: f64) -> f64 {
    let sweep = sweeps.iter().find(|(known, _)| *known == method).map(|(_, sweep)| sweep);
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
