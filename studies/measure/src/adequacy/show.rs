//! Tables, recommendations and charts.

use reports::{Axis, Figure, Layer, Series, Table};
use serde::Serialize;

use super::{ObservedOrder, Row, rungs};
use crate::error::Error;
use crate::study::{Derived, distinct, short};
use scenes::run::Outcome;

/// Error levels of the recommendations, in the unit of the quantity.
const LEVELS: [f64; 5] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-6];

/// The cheapest way to an error level on one scene.
#[derive(Clone, Debug, Serialize)]
struct Recommendation {
    /// Scene or preset.
    scene: String,
    /// Unit of the errors.
    unit: String,
    /// The error asked for, in the unit.
    error_level: f64,
    /// The cheapest model that reaches the error.
    model: String,
    /// Method.
    method: String,
    /// Its step, s; empty where no run reaches the error.
    h_s: Option<f64>,
    /// Its error.
    error: Option<f64>,
    /// Its operations.
    operations: Option<u64>,
    /// Operations of the cheapest run of the full model that reaches it.
    operations_of_full_model: Option<u64>,
}

#[derive(Clone, Debug, Serialize)]
struct ModelError {
    /// Scene or preset.
    scene: String,
    /// Model.
    model: String,
    /// Whether its error vanishes with the step.
    consistent: bool,
    /// Method.
    method: String,
    /// The order observed.
    order: Option<f64>,
    /// Error with the smallest step.
    error_at_finest: Option<f64>,
    /// Unit of the errors.
    unit: String,
    /// Step below which the model's own error is the larger part, s.
    refining_is_wasted_below_h_s: Option<f64>,
    /// Operations per step.
    operations_a_step: u64,
    /// Evaluations of the force law per step.
    evaluations_a_step: f64,
    /// Operations of the full model per step.
    operations_of_full_model_a_step: Option<u64>,
}

pub(super) fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
    Ok(vec![recommendations(rows)?, models(rows)?])
}

/// The cheapest finished run with an error at most the level.
fn cheapest<'a>(rows: impl Iterator<Item = &'a Row>, level: f64) -> Option<&'a Row> {
    let reaching = rows.filter(|row| row.outcome == Outcome::Finished && row.error.is_some_and(|e| e <= level));
    reaching.min_by_key(|row| row.operations)
}

fn recommendations(rows: &[Row]) -> Result<Derived, Error> {
    let mut all = Vec::new();
    for scene in distinct(rows.iter().map(|row| row.scene.as_str())) {
        let of_scene = || rows.iter().filter(move |row| row.scene == scene);
        let Some(unit) = of_scene().next().map(|row| row.unit.clone()) else { continue };
        for level in LEVELS {
            let best = stable(rows, scene, level);
            let full = cheapest(of_scene().filter(|row| row.model == "full"), level);
            all.push(Recommendation {
                scene: scene.to_owned(),
                unit: unit.clone(),
                error_level: level,
                model: best.map_or("none of these".to_owned(), |row| row.model.clone()),
                method: best.map_or_else(String::new, |row| row.method.clone()),
                h_s: best.map(|row| row.h_s),
                error: best.and_then(|row| row.error),
                operations: best.map(|row| row.operations),
                operations_of_full_model: full.map(|row| row.operations),
            });
        }
    }
    let headers =
        ["scene", "error level", "unit", "cheapest model", "method", "h (s)", "error", "operations", "full model"];
    let mut table = Table::new(&headers, &["error level", "h (s)", "error", "operations", "full model"]);
    for r in &all {
        let number = |n: Option<u64>| n.map_or_else(|| "–".to_owned(), |n| n.to_string());
        table.push([
            r.scene.clone(),
            format!("{:.0e}", r.error_level),
            r.unit.clone(),
            r.model.clone(),
            r.method.clone(),
            short(r.h_s),
            short(r.error),
            number(r.operations),
            number(r.operations_of_full_model),
        ]);
    }
    Ok(Derived {
        name: "adequacy-recommendations",
        caption: "The cheapest model, method and step that reach an error level at the scene's horizon, by arithmetic operations; \
                  the last column is what the full model needs",
        csv: reports::write_csv(&all)?,
        table,
    })
}

/// The cheapest run that reaches the level by itself: every finer run of the same model and method does too, so that it is no
/// zero of an error that changes its sign.
fn stable<'a>(rows: &'a [Row], scene: &str, level: f64) -> Option<&'a Row> {
    let lasting = rows.iter().filter(|row| row.scene == scene).filter(|row| {
        let finer = rows.iter().filter(|other| {
            other.scene == row.scene && other.model == row.model && other.method == row.method && other.h_s <= row.h_s
        });
        finer.into_iter().all(|other| other.error.is_some_and(|e| e <= level))
    });
    cheapest(lasting, level)
}

fn models(rows: &[Row]) -> Result<Derived, Error> {
    let all: Vec<ObservedOrder> = rungs(rows);
    let full = |seen: &ObservedOrder| {
        let same = all.iter().find(|s| s.scene == seen.scene && s.method == seen.method && s.model == "full");
        same.map(|s| s.operations_a_step)
    };
    let errors: Vec<ModelError> = all
        .iter()
        .map(|seen| ModelError {
            scene: seen.scene.clone(),
            model: seen.model.clone(),
            consistent: seen.consistent,
            method: seen.method.clone(),
            order: seen.order,
            error_at_finest: seen.finest,
            unit: seen.unit.clone(),
            refining_is_wasted_below_h_s: seen.plateau_h_s.filter(|_| !seen.consistent),
            operations_a_step: seen.operations_a_step,
            evaluations_a_step: seen.evaluations_a_step,
            operations_of_full_model_a_step: full(seen),
        })
        .collect();
    let headers = [
        "scene",
        "model",
        "method",
        "order",
        "error at the finest step",
        "unit",
        "refining is wasted below h (s)",
        "operations a step",
        "of the full model",
    ];
    let numbers = [headers[3], headers[4], headers[6], headers[7], headers[8]];
    let mut table = Table::new(&headers, &numbers);
    for e in &errors {
        table.push([
            e.scene.clone(),
            e.model.clone(),
            e.method.clone(),
            if e.consistent { short(e.order) } else { "none: inconsistent".to_owned() },
            short(e.error_at_finest),
            e.unit.clone(),
            short(e.refining_is_wasted_below_h_s),
            e.operations_a_step.to_string(),
            e.operations_of_full_model_a_step.map_or_else(|| "–".to_owned(), |n| n.to_string()),
        ]);
    }
    Ok(Derived {
        name: "adequacy-models",
        caption: "What each model costs and how wrong it stays",
        csv: reports::write_csv(&errors)?,
        table,
    })
}

/// One chart a scene: every model with semi-implicit Euler and with RK4.
pub(super) fn figures(rows: &[Row]) -> Vec<Figure> {
    distinct(rows.iter().map(|row| row.scene.as_str())).into_iter().map(|scene| figure(rows, scene)).collect()
}

fn figure(rows: &[Row], scene: &str) -> Figure {
    let of_scene: Vec<&Row> = rows.iter().filter(|row| row.scene == scene).collect();
    let mut layers = Vec::new();
    for model in distinct(of_scene.iter().map(|row| row.model.as_str())) {
        for (method, name) in [("semi-implicit-euler", "semi-implicit"), ("rk4", "RK4")] {
            let of = of_scene.iter().filter(|row| row.model == model && row.method == method);
            let points = of.filter_map(|row| Some([row.operations as f64, row.error.filter(|e| *e > 0.0)?])).collect();
            layers.push(Layer::Series(Series::new(format!("{}, {name}", brief(model)), layers.len(), points)));
        }
    }
    let (quantity, unit) = of_scene.first().map_or(("", ""), |row| (row.quantity.as_str(), row.unit.as_str()));
    Figure {
        id: format!("adequacy-{}", scene.replace(' ', "-")),
        title: format!("{}: what each model buys", crate::names::scene_title(scene)),
        caption: "A model that leaves out what matters goes flat: from there on every operation is wasted. The full model goes on."
            .to_owned(),
        x: Axis::log("operations of the run (1)"),
        y: Axis::log(format!("{quantity} error at the end ({unit})")),
        layers,
        scene: Some(super::base(scene).to_owned()),
        data: "adequacy.csv".to_owned(),
        ..Figure::default()
    }
}

fn brief(model: &str) -> &str {
    match model {
        "one angle instead of an attitude" => "one angle",
        "sphere instead of tensor" => "sphere",
        "no gyroscopic term" => "no gyroscopic",
        other => other,
    }
}
