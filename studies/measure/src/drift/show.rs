//! Charts of what is lost over time.

use integrator::methods::MethodId;
use reports::{Axis, Figure, Layer, Series};

use super::{Drift, Row};
use crate::names::scene_title;
use crate::study::{color_of, distinct};
use scenes::run::Precision;

/// One chart for each scene and drift: the largest error so far, of every method in f64.
pub(super) fn figures(rows: &[Row]) -> Vec<Figure> {
    let mut figures = Vec::new();
    for scene in distinct(rows.iter().map(|row| row.scene.as_str())) {
        let of_scene: Vec<&Row> = rows.iter().filter(|row| row.scene == scene).collect();
        for drift in distinct(of_scene.iter().map(|row| row.drift)) {
            let chosen: Vec<&Row> = of_scene.iter().copied().filter(|row| row.drift == drift).collect();
            figures.push(figure(scene, drift, &chosen));
        }
    }
    figures
}

fn figure(scene: &str, drift: Drift, rows: &[&Row]) -> Figure {
    let precision = [Precision::F64, Precision::F32]
        .into_iter()
        .find(|&p| rows.iter().any(|row| row.precision == p))
        .unwrap_or(Precision::F64);
    let mut layers = Vec::new();
    let mut exact = Vec::new();
    for method in MethodId::ALL {
        let run: Vec<&Row> =
            rows.iter().copied().filter(|r| r.method == method.id() && r.precision == precision).collect();
        if run.is_empty() {
            continue;
        }
        let mut largest = 0.0_f64;
        let points: Vec<[f64; 2]> = run
            .iter()
            .filter_map(|row| {
                largest = largest.max(row.error_min?.abs()).max(row.error_max?.abs());
                (largest > 0.0).then_some([row.t_s, largest])
            })
            .collect();
        let failed: Vec<f64> = run.first().and_then(|row| row.failed_at_s).into_iter().collect();
        // Less than the last bit of the invariant itself: no error that f64 could show, and decades of empty chart.
        if failed.is_empty() && largest < 0.5 * f64::EPSILON * run[0].scale {
            exact.push(method.title());
            continue;
        }
        let series = Series::new(method.title(), color_of(*method), points);
        layers.push(Layer::Series(Series { failed, marker: None, ..series }));
    }
    let unit = drift.unit();
    let (name, caption) = match drift {
        Drift::Energy => (
            "energy error",
            "A flat line is a bounded error, slope 1 a steady loss or gain, a steepening curve exponential growth.",
        ),
        Drift::MomentumNorm => ("error of |p|", "A flat line is a bounded error, slope 1 a steady loss or gain."),
        Drift::MomentumDirection => {
            ("direction error of p", "How far the momentum has turned away from where it should point.")
        }
        Drift::AngularMomentumNorm => {
            ("error of |L|", "A flat line is a bounded error, slope 1 a steady loss or gain.")
        }
        Drift::AngularMomentumDirection => {
            ("direction error of L", "How far the angular momentum has turned away from where it should point.")
        }
        Drift::QuaternionNorm => (
            "error of |q|",
            "The quaternion's norm is renewed every 64 steps, so that only the rounding in between shows.",
        ),
    };
    Figure {
        id: format!("drift-{}-{}", scene.replace('/', "-"), drift.id()),
        title: format!("{}: {name} over a long run, {}", scene_title(scene), precision.id()),
        caption: if exact.is_empty() {
            caption.to_owned()
        } else {
            format!("{caption} Less than one rounding: {}.", exact.join(", "))
        },
        x: Axis::log("time (s)"),
        y: Axis::log(format!("largest {name} so far ({unit})")),
        layers,
        scene: Some(scene.to_owned()),
        on_page: drift == Drift::Energy,
        data: "drift.csv".to_owned(),
        ..Figure::default()
    }
}
