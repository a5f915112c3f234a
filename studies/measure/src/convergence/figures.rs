//! Charts of the error against the step.

use integrator::methods::MethodId;
use reports::{Axis, Figure, Layer, Series};

use super::Row;
use crate::names::scene_title;
use crate::study::{color_of, command, distinct};
use scenes::observation::Quantity;
use scenes::run::{Outcome, Precision};

/// Two charts a scene: all methods in f64 with the rounding floor, and three precisions of the same two methods.
pub(super) fn figures(rows: &[Row]) -> Vec<Figure> {
    let mut figures = Vec::new();
    for scene in distinct(rows.iter().map(|row| row.scene.as_str())) {
        let of_scene: Vec<&Row> = rows.iter().filter(|row| row.scene == scene).collect();
        let quantities = distinct(of_scene.iter().map(|row| row.quantity));
        // Position or attitude: the quantity that a reader looks for first, and that no method gets right by chance.
        let Some(&quantity) = quantities.first() else { continue };
        let chosen: Vec<&Row> = of_scene.into_iter().filter(|row| row.quantity == quantity).collect();
        figures.push(methods(scene, quantity, &chosen));
        figures.push(precisions(scene, quantity, &chosen));
    }
    figures
}

fn axes(quantity: Quantity) -> (Axis, Axis) {
    let name = match quantity {
        Quantity::Position => "position",
        Quantity::Velocity => "velocity",
        Quantity::Attitude => "angle",
        Quantity::AngularVelocity => "angular velocity",
    };
    (Axis::log("step size h (s)"), Axis::log(format!("{name} error at the end ({})", quantity.unit())))
}

fn series(name: String, color: usize, rows: &[&Row]) -> Layer {
    let points = rows.iter().filter_map(|row| Some([row.h_s, row.error_end.filter(|&e| e > 0.0)?])).collect();
    let failed = rows.iter().filter(|row| row.outcome != Outcome::Finished).map(|row| row.h_s).collect();
    Layer::Series(Series { failed, ..Series::new(name, color, points) })
}

/// Whether every run ended with an error of zero: there is nothing to draw.
fn is_exact(rows: &[&Row]) -> bool {
    rows.iter().all(|row| row.error_end == Some(0.0))
}

/// What to see: the slopes that are there, and who is missing because it makes no error.
fn caption(slopes: impl Iterator<Item = f64>, exact: &[&str]) -> String {
    let falls: Vec<String> = slopes
        .map(|order| match order {
            1.0 => "halves an error of order 1".to_owned(),
            2.0 => "quarters one of order 2".to_owned(),
            order => format!("divides one of order {order} by {}", order.exp2()),
        })
        .collect();
    let slopes = if falls.is_empty() {
        "What is left is rounding.".to_owned()
    } else {
        format!("Halving the step {}, until rounding takes over.", falls.join(", "))
    };
    let missing = match exact {
        [] => String::new(),
        [one] => format!(" {one} is exact here to the last bit and has no points."),
        [first @ .., last] => {
            format!(" {} and {last} are exact here to the last bit and have no points.", first.join(", "))
        }
    };
    slopes + &missing
}

fn methods(scene: &str, quantity: Quantity, rows: &[&Row]) -> Figure {
    let precision = [Precision::F64, Precision::DoubleDouble, Precision::F32]
        .into_iter()
        .find(|&p| rows.iter().any(|row| row.precision == p))
        .unwrap_or(Precision::F64);
    let rows: Vec<&Row> = rows.iter().copied().filter(|row| row.precision == precision).collect();
    let mut layers = Vec::new();
    let rounding = rows.iter().filter_map(|row| row.rounding_end).fold(0.0, f64::max);
    if rounding > 0.0 {
        layers.push(Layer::Floor { y: rounding, label: format!("largest rounding error ({})", precision.id()) });
    }
    let mut exact = Vec::new();
    let mut orders = Vec::new();
    for method in MethodId::ALL {
        let of_method: Vec<&Row> = rows.iter().copied().filter(|row| row.method == method.id()).collect();
        if of_method.is_empty() {
            continue;
        }
        if is_exact(&of_method) {
            exact.push(method.title());
            continue;
        }
        orders.extend(of_method.iter().find_map(|row| row.theory_order));
        layers.push(series(method.title().to_owned(), color_of(*method), &of_method));
    }
    let slopes = [1.0, 2.0, 3.0, 4.0].into_iter().filter(|order| orders.contains(order));
    layers.extend(slopes.clone().map(|order| Layer::SlopeTriangle { order }));
    let (x, y) = axes(quantity);
    Figure {
        id: format!("convergence-{}-{}", scene.replace('/', "-"), quantity.id()),
        title: format!("{}: error against step, {}", scene_title(scene), precision.id()),
        caption: caption(slopes, &exact),
        x,
        y,
        layers,
        command: command("convergence", scene),
        data: "convergence.csv".to_owned(),
        ..Figure::default()
    }
}

fn precisions(scene: &str, quantity: Quantity, rows: &[&Row]) -> Figure {
    let mut layers = Vec::new();
    for (method, first_color) in [(MethodId::SemiImplicitEuler, 0), (MethodId::Rk4, 3)] {
        for (i, precision) in Precision::ALL.into_iter().enumerate() {
            let chosen: Vec<&Row> =
                rows.iter().copied().filter(|r| r.precision == precision && r.method == method.id()).collect();
            if !chosen.is_empty() && !is_exact(&chosen) {
                layers.push(series(format!("{}, {}", method.title(), precision.id()), first_color + i, &chosen));
            }
        }
    }
    let (x, y) = axes(quantity);
    Figure {
        id: format!("precision-{}-{}", scene.replace('/', "-"), quantity.id()),
        title: format!("{}: the same step in three precisions", scene_title(scene)),
        caption:
            "f32 and f64 leave the straight line where rounding outweighs the method's error; double-double keeps \
                  its slope."
                .to_owned(),
        x,
        y,
        layers,
        command: command("convergence", scene),
        data: "convergence.csv".to_owned(),
        ..Figure::default()
    }
}
