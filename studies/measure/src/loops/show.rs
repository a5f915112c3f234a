//! Tables and charts.

use reports::{Axis, Figure, Layer, Series, Table};
use serde::Serialize;

use super::growth::{PARTS, small};
use super::orders::order_of;
use super::row::{Experiment, Row};
use crate::error::Error;
use crate::names::scene_title;
use crate::study::{Derived, distinct, short};
use scenes::run::method_from_id;

/// One measured order.
#[derive(Serialize)]
struct OrderLine<'a> {
    /// The choice that the sweep was made for.
    choice: &'a str,
    /// The settings of the loop, as `--loop` takes them, for frames of 1 s.
    settings: &'a str,
    /// Scene.
    scene: &'a str,
    /// Method.
    method: &'a str,
    /// Configuration or velocity.
    quantity: &'a str,
    /// The slope of the error over the frame in the window that shows one.
    order: Option<f64>,
    /// The order that theory predicts; empty where it predicts none.
    theory: Option<f64>,
    /// The error at the smallest frame, in the unit of the quantity; empty where the run failed.
    error_at_finest: Option<f64>,
}

fn order_lines(rows: &[Row]) -> Vec<OrderLine<'_>> {
    let errors: Vec<&Row> = rows.iter().filter(|r| r.experiment == Experiment::Error).collect();
    let key = |r: &'_ Row| (r.choice.clone(), r.subject.clone(), r.method.clone(), r.quantity.clone());
    distinct(errors.iter().map(|r| key(r)))
        .into_iter()
        .filter_map(|of| {
            let sweep: Vec<&Row> = errors.iter().copied().filter(|r| key(r) == of).collect();
            let finest = sweep.iter().min_by(|a, b| a.h_s.total_cmp(&b.h_s))?;
            Some(OrderLine {
                choice: &finest.choice,
                settings: &finest.settings,
                scene: &finest.subject,
                method: &finest.method,
                quantity: &finest.quantity,
                order: order_of(&sweep, 1.0).slope,
                theory: finest.theory_order,
                error_at_finest: finest.value,
            })
        })
        .collect()
}

pub(super) fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
    let lines = order_lines(rows);
    let mut orders = Table::new(
        &["loop", "scene", "method", "quantity", "order", "theory", "error at the finest step"],
        &["order", "theory", "error at the finest step"],
    );
    for line in &lines {
        orders.push([
            line.choice.to_owned(),
            scene_title(line.scene).to_owned(),
            line.method.to_owned(),
            line.quantity.to_owned(),
            short(line.order),
            short(line.theory),
            short(line.error_at_finest),
        ]);
    }
    let mut derived = vec![Derived {
        name: "loops-orders",
        caption: "The order that is left of a method in a loop",
        csv: reports::write_csv(&lines)?,
        table: orders,
    }];
    for (experiment, name, caption) in [
        (Experiment::Law, "loops-laws", "Cases of which theory knows the number"),
        (Experiment::Published, "loops-published", "Numbers that others printed about loops, and ours"),
    ] {
        let laws: Vec<&Row> = rows.iter().filter(|r| r.experiment == experiment).collect();
        if laws.is_empty() {
            continue;
        }
        let mut table = Table::new(
            &["name", "loop", "case", "method", "h (s)", "quantity", "measured", "theory, or printed"],
            &["h (s)", "measured", "theory, or printed"],
        );
        for row in &laws {
            let unit = if row.unit == "1" { String::new() } else { format!(" ({})", row.unit) };
            table.push([
                row.choice.clone(),
                row.settings.clone(),
                row.subject.clone(),
                row.method.clone(),
                short(Some(row.h_s)),
                format!("{}{unit}", row.quantity),
                row.value.map_or_else(|| "failed".to_owned(), |v| format!("{v:.7}")),
                row.theory.map_or_else(String::new, |v| format!("{v:.7}")),
            ]);
        }
        derived.push(Derived { name, caption, csv: reports::write_csv(&laws)?, table });
    }
    Ok(derived)
}

pub(super) fn figures(rows: &[Row]) -> Vec<Figure> {
    let scenes = distinct(rows.iter().filter(|r| r.experiment == Experiment::Error).map(|r| r.subject.as_str()));
    let mut figures: Vec<Figure> = scenes.into_iter().flat_map(|scene| errors(rows, scene)).collect();
    figures.extend(growth(rows));
    figures
}

/// The error of each choice over the frame, a chart for each method.
fn errors(rows: &[Row], scene: &str) -> Vec<Figure> {
    let of_scene: Vec<&Row> = rows
        .iter()
        .filter(|r| r.experiment == Experiment::Error && r.subject == scene && r.quantity == "configuration")
        .collect();
    distinct(of_scene.iter().map(|r| r.method.as_str()))
        .into_iter()
        .map(|method| {
            let of_method: Vec<&&Row> = of_scene.iter().filter(|r| r.method == method).collect();
            let choices = distinct(of_method.iter().map(|r| r.choice.as_str()));
            let mut layers: Vec<Layer> = choices
                .iter()
                .enumerate()
                .map(|(color, choice)| {
                    let own = of_method.iter().filter(|r| r.choice == *choice);
                    let points = own.filter_map(|r| Some([r.h_s, r.value.filter(|e| *e > 0.0)?])).collect();
                    Layer::Series(Series::new((*choice).to_owned(), color, points))
                })
                .collect();
            layers.extend([1.0, 2.0].map(|order| Layer::SlopeTriangle { order }));
            let title = method_from_id(method).map_or(method, |m| m.facts().title);
            Figure {
                id: format!("loops-error-{scene}-{method}"),
                title: format!("{}, {title}: the error that a loop leaves", scene_title(scene)),
                caption: "A force held over the frame makes every method of order 1; an interpolated picture is of order 2 at best; \
                          fresh substeps and uneven frames keep the order."
                    .to_owned(),
                x: Axis::log("mean frame h (s)"),
                y: Axis::log("error at the end"),
                layers,
                scene: Some(scene.to_owned()),
                data: "loops.csv".to_owned(),
                on_page: scene == "pendulum" || choices.contains(&"yours"),
                ..Figure::default()
            }
        })
        .collect()
}

/// The growth of an error under jitter.
fn growth(rows: &[Row]) -> Option<Figure> {
    let jitter: Vec<&Row> = rows.iter().filter(|r| r.experiment == Experiment::Jitter).collect();
    let mut layers = Vec::new();
    for (index, part) in PARTS.iter().enumerate() {
        let of_part = jitter.iter().filter(|r| r.settings == format!("jitter={part}"));
        let points: Vec<[f64; 2]> =
            of_part.filter_map(|r| Some([r.h_s, r.value.filter(|v| *v > r.tolerance.unwrap_or(3e-5))?])).collect();
        layers.push(Layer::Series(Series::new(format!("steps vary by {} %", 100.0 * part), index, points)));
    }
    let curve =
        (1..=90).map(|i| 0.02 * f64::from(i)).map(|z| [z, small(z, PARTS[0])]).filter(|p| p[1] > 1e-7).collect();
    layers.push(Layer::Curve { name: "theory for 10 %".to_owned(), points: curve, color: None });
    (!jitter.is_empty()).then(|| Figure {
        id: "loops-jitter".to_owned(),
        title: "Uneven steps make a stable spring unstable".to_owned(),
        caption: "Every step of semi-implicit Euler is stable alone below h ω = 2. Drawn at random, the steps let an error grow; \
                  a growth that the draws do not resolve is left out."
            .to_owned(),
        x: Axis::linear("h ω"),
        y: Axis::log("growth of an error per step"),
        layers,
        scene: None,
        data: "loops.csv".to_owned(),
        ..Figure::default()
    })
}
