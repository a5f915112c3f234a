//! Table, charts and claims of an ensemble.

use integrator::methods::MethodId;
use reports::{Axis, Claim, Figure, Layer, Line, Series, Table};
use serde::Serialize;

use super::Row;
use crate::claim::{self, Evidence};
use crate::convergence::tolerance;
use crate::error::Error;
use crate::order;
use crate::order::{Expected, Limits, Sample};
use crate::study::{Derived, color_of, distinct, short};

/// The finest step of one sweep.
#[derive(Clone, Debug, Serialize)]
struct Finest {
    /// Scene or preset.
    scene: String,
    /// Method.
    method: String,
    /// What was compared.
    quantity: String,
    /// Step, s.
    h_s: f64,
    /// Number of starts.
    members: usize,
    /// Members that failed.
    failed: usize,
    /// Median of the error at the end.
    median: Option<f64>,
    /// Its 95th percentile; empty where that is a failed member.
    percentile_95: Option<f64>,
    /// The largest.
    worst: Option<f64>,
    /// The largest over the median.
    worst_over_median: Option<f64>,
    /// Unit of the errors.
    unit: String,
    /// The start of the worst, as --set takes it.
    worst_start: String,
}

/// The rows of each scene, method and quantity, from the coarsest step to the finest.
fn sweeps(rows: &[Row]) -> Vec<Vec<&Row>> {
    let key = |row: &Row| (row.scene.clone(), row.method.clone(), row.quantity);
    distinct(rows.iter().map(key))
        .iter()
        .map(|k| {
            let mut sweep: Vec<&Row> = rows.iter().filter(|row| key(row) == *k).collect();
            sweep.sort_by_key(|row| row.steps);
            sweep
        })
        .collect()
}

pub(super) fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
    let finest: Vec<Finest> = sweeps(rows)
        .iter()
        .filter_map(|sweep| sweep.last())
        .map(|row| Finest {
            scene: row.scene.clone(),
            method: row.method.clone(),
            quantity: row.quantity.id().to_owned(),
            h_s: row.h_s,
            members: row.members,
            failed: row.failed,
            median: row.median,
            percentile_95: row.percentile_95,
            worst: row.worst,
            worst_over_median: row.worst.zip(row.median).map(|(w, m)| w / m).filter(|ratio| ratio.is_finite()),
            unit: row.unit.clone(),
            worst_start: row.worst_start.clone(),
        })
        .collect();
    let headers = [
        "scene",
        "method",
        "quantity",
        "h (s)",
        "failed",
        "median",
        "95 %",
        "worst",
        "worst / median",
        "unit",
        "worst start",
    ];
    let mut table = Table::new(&headers, &["h (s)", "failed", "median", "95 %", "worst", "worst / median"]);
    for row in &finest {
        table.push([
            row.scene.clone(),
            row.method.clone(),
            row.quantity.clone(),
            short(Some(row.h_s)),
            format!("{} of {}", row.failed, row.members),
            short(row.median),
            short(row.percentile_95),
            short(row.worst),
            short(row.worst_over_median),
            row.unit.clone(),
            in_short(&row.worst_start),
        ]);
    }
    Ok(vec![Derived {
        name: "ensemble-finest",
        caption: "Errors over the ensemble with the smallest step, and the start of the worst (in full in the CSV, as --set takes it)",
        csv: reports::write_csv(&finest)?,
        table,
    }])
}

/// A start with three decimals to a number.
fn in_short(start: &str) -> String {
    let number = |text: &str| text.parse::<f64>().map_or_else(|_| text.to_owned(), |x| format!("{x:.3}"));
    let assignment = |text: &str| match text.split_once('=') {
        Some((name, value)) => format!("{name}={}", value.split(',').map(number).collect::<Vec<_>>().join(",")),
        None => text.to_owned(),
    };
    start.split(' ').map(assignment).collect::<Vec<_>>().join(" ")
}

pub(super) fn figures(rows: &[Row]) -> Vec<Figure> {
    let sweeps = sweeps(rows);
    distinct(rows.iter().map(|row| row.scene.as_str())).into_iter().filter_map(|scene| figure(scene, &sweeps)).collect()
}

/// One chart a scene: of each method the median as a line, whiskers up to 95 %, the worst dotted.
fn figure(scene: &str, sweeps: &[Vec<&Row>]) -> Option<Figure> {
    let of_scene: Vec<_> = sweeps.iter().filter(|sweep| sweep[0].scene == scene).collect();
    // Position or attitude: the quantity that a reader looks for first.
    let first = of_scene.first()?[0];
    let (quantity, members) = (first.quantity, first.members);
    let mut layers = Vec::new();
    for sweep in of_scene.iter().filter(|sweep| sweep[0].quantity == quantity) {
        let Some(&method) = MethodId::ALL.iter().find(|method| method.id() == sweep[0].method) else { continue };
        let points = |pick: fn(&Row) -> Option<f64>| -> Vec<[f64; 2]> {
            sweep.iter().filter_map(|row| Some([row.h_s, pick(row).filter(|&e| e > 0.0)?])).collect()
        };
        let median = points(|row| row.median);
        let upper = |row: &&Row| Some([row.median.filter(|&e| e > 0.0)?, row.percentile_95.or(row.median)?]);
        let whiskers: Vec<[f64; 2]> = sweep.iter().filter_map(upper).collect();
        let failed = sweep.iter().filter(|row| row.failed > 0).map(|row| row.h_s).collect();
        let line = Series::new(method.title(), color_of(method), median);
        layers.push(Layer::Series(Series { whiskers, failed, ..line }));
        let worst = Series::new("", color_of(method), points(|row| row.worst));
        layers.push(Layer::Series(Series { marker: None, line: Some(Line::Dotted), ..worst }));
    }
    layers.extend([1.0, 2.0, 4.0].map(|order| Layer::SlopeTriangle { order }));
    Some(Figure {
        id: format!("ensemble-{}-{}", scene.replace('/', "-"), quantity.id()),
        title: format!("{scene}: {} error over {members} starts", quantity.id()),
        caption: format!(
            "Lines: the median of the error at the end; whiskers reach up to the 95th percentile, dotted lines are the worst start. \
             {}.",
            capitalized(&first.rule)
        ),
        x: Axis::log("step size h (s)"),
        y: Axis::log(format!("{} error at the end ({})", quantity.id(), quantity.unit())),
        layers,
        scene: Some(scene.to_owned()),
        data: "ensemble.csv".to_owned(),
        ..Figure::default()
    })
}

fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Theory's order holds for every start, so that median and worst fall with it.
pub(super) fn claims(rows: &[Row]) -> Vec<Claim> {
    let of = |sweep: &Vec<&Row>| {
        let median = claim(sweep, "median", |row| row.median)?;
        let worst = claim(sweep, "worst", |row| row.worst)?;
        Some([median, worst])
    };
    sweeps(rows).iter().filter_map(of).flatten().collect()
}

fn is_worked_out(method: &str) -> bool {
    MethodId::ALL.iter().any(|known| known.id() == method && known.facts().worked_out)
}

fn claim(sweep: &[&Row], name: &str, pick: fn(&Row) -> Option<f64>) -> Option<Claim> {
    let first = sweep[0];
    let order = first.theory_order?;
    let scale = if first.scale > 0.0 { first.scale } else { 1.0 };
    let unit = first.precision.epsilon() * scale;
    // An ulp a step, all of one sign: rounding errors come in both, and are below this.
    let sample = |row: &&Row| Sample { h_s: row.h_s, error: pick(row), floor: unit * row.steps as f64 };
    let samples: Vec<Sample> = sweep.iter().map(sample).collect();
    let tolerance = tolerance(first.precision, samples.len());
    let limits = Limits { rounding_unit: unit, saturation: scale };
    let seen = order::observe(&samples, Expected::Order { order, tolerance }, limits);
    let evidence = match seen.verdict {
        order::Verdict::NotAsymptotic | order::Verdict::AtTheFloor => Evidence::Undecided,
        // Where no theory was worked out, the method promises its order or a higher one.
        order::Verdict::SuperConvergent if !is_worked_out(&first.method) => Evidence::Inside,
        verdict => Evidence::is(verdict.passes()),
    };
    let texts = [
        format!(
            "The {name} {} error of {} over {} starts of {} falls with its order",
            first.quantity.id(),
            first.method,
            first.members,
            first.scene
        ),
        format!("order {order} from every start"),
        seen.note,
        format!("{order} ± {tolerance}"),
    ];
    let id = format!("{}.{}.{}.{name}", first.scene, first.method, first.quantity.id());
    Some(claim::claim("ensemble", &id, texts, [evidence]).on(&first.scene).by(&first.method))
}
