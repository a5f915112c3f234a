//! Tables of prices: what an error costs, and who holds the front.

use reports::Table;
use serde::Serialize;

use super::cells::{cost_measure_name, label, runs};
use super::cost_at_error::{CostAtError, LEVELS, prices};
use super::front::front;
use super::{CostMeasure, Part, Row, comparison_tables, cost_tables, peers, rounding_optimum, step_rate, which_table};
use crate::error::Error;
use crate::study::{Derived, distinct, short};
use scenes::run::Precision;

/// Every table.
///
/// # Errors
/// Rows that have no form as CSV.
pub(super) fn all(rows: &[Row]) -> Result<Vec<Derived>, Error> {
    let mut tables = vec![which_table::which_method(rows)?];
    tables.extend(step_rate::table(rows)?);
    tables.push(comparison_tables::question(rows)?);
    for charge in CostMeasure::ALL {
        tables.push(comparison_tables::semi_implicit(rows, charge)?);
    }
    tables.extend([cost_at_error(rows)?, fronts(rows)?, rounding_optimum::table(rows)?]);
    tables.extend(stagnation(rows)?);
    tables.extend(cost_tables::all(rows)?);
    tables.extend(peers::table(rows)?);
    Ok(tables)
}

#[derive(Serialize)]
struct IsoRow {
    /// Scene or preset.
    scene: String,
    /// The error asked for, m or rad.
    error_level: f64,
    /// What is counted: evaluations up to the horizon, or time.
    charge: CostMeasure,
    /// The cheapest method.
    method: String,
    /// Its arithmetic.
    precision: Precision,
    /// Its step, s.
    h_s: f64,
    /// Its cost.
    cost: f64,
    /// Unit of the costs.
    cost_unit: &'static str,
    /// Whether the cost is only an upper bound, because no coarser run was made.
    is_at_most: bool,
    /// The next method.
    runner_up: Option<String>,
    /// Its arithmetic.
    runner_up_precision: Option<Precision>,
    /// Its cost.
    runner_up_cost: Option<f64>,
    /// Its cost over the best.
    runner_up_over_best: Option<f64>,
}

/// The cheapest method at each error, and the next.
fn cost_at_error(rows: &[Row]) -> Result<Derived, Error> {
    let runs = runs(rows);
    let mut lines = Vec::new();
    for scene in distinct(runs.iter().map(|row| row.scene.as_str())) {
        let of_scene: Vec<&Row> = runs.iter().copied().filter(|row| row.scene == scene).collect();
        for level in LEVELS {
            for charge in CostMeasure::ALL {
                lines.extend(iso_row(scene, level, charge, &prices(&of_scene, level, charge)));
            }
        }
    }
    let headers = ["scene", "error (m, rad)", "cost in", "cheapest", "step (s)", "price", "next", "times as much"];
    let mut table = Table::new(&headers, &["error (m, rad)", "step (s)", "price", "times as much"]);
    for line in &lines {
        let at_most = if line.is_at_most { "≤ " } else { "" };
        let next = line.runner_up.as_deref().map_or_else(String::new, label);
        let price = match line.charge {
            CostMeasure::Evaluations => format!("{at_most}{:.0}", line.cost),
            CostMeasure::Time => format!("{at_most}{} µs/s", short(Some(line.cost / 1e3))),
        };
        let method = match line.charge {
            CostMeasure::Evaluations => label(&line.method),
            CostMeasure::Time => format!("{}, {}", label(&line.method), line.precision.id()),
        };
        table.push([
            line.scene.clone(),
            format!("{:.0e}", line.error_level),
            cost_measure_name(line.charge).to_owned(),
            method,
            short(Some(line.h_s)),
            price,
            next,
            line.runner_up_over_best.map_or_else(String::new, |x| format!("{x:.2}")),
        ]);
    }
    Ok(Derived {
        name: "tradeoff-cost-at-error",
        caption: "The cheapest method at an error (the largest up to the horizon), in evaluations up to the horizon and in time \
                  for a simulated second; '≤' where the coarsest run keeps the error already",
        csv: reports::write_csv(&lines)?,
        table,
    })
}

fn iso_row(scene: &str, error_level: f64, charge: CostMeasure, prices: &[CostAtError]) -> Option<IsoRow> {
    let best = prices.first()?;
    let next = prices.iter().find(|price| price.rule != best.rule);
    Some(IsoRow {
        scene: scene.to_owned(),
        error_level,
        charge,
        method: best.method.clone(),
        precision: best.precision,
        h_s: best.h_s,
        cost: best.cost,
        cost_unit: match charge {
            CostMeasure::Evaluations => "evaluations",
            CostMeasure::Time => "ns per simulated second",
        },
        is_at_most: best.is_at_most,
        runner_up: next.map(|price| price.method.clone()),
        runner_up_precision: next.map(|price| price.precision),
        runner_up_cost: next.map(|price| price.cost),
        runner_up_over_best: next.map(|price| price.cost / best.cost),
    })
}

#[derive(Serialize)]
struct FrontRow {
    /// Scene or preset.
    scene: String,
    /// What is counted: evaluations up to the horizon, or time.
    charge: CostMeasure,
    /// Cost: evaluations, or ns per simulated second.
    cost: f64,
    /// Error, m or rad: no cheaper run has a smaller one.
    error: f64,
    /// Method.
    method: String,
    /// Arithmetic.
    precision: Precision,
    /// Number of steps.
    steps: u64,
    /// Step, s.
    h_s: f64,
}

/// The Pareto fronts; shown are the stretches that one method holds.
fn fronts(rows: &[Row]) -> Result<Derived, Error> {
    let runs = runs(rows);
    let mut lines: Vec<FrontRow> = Vec::new();
    let headers = ["scene", "cost in", "errors of", "down to", "cheapest"];
    let mut table = Table::new(&headers, &["errors of", "down to"]);
    for scene in distinct(runs.iter().map(|row| row.scene.as_str())) {
        let of_scene: Vec<&Row> = runs.iter().copied().filter(|row| row.scene == scene).collect();
        for charge in CostMeasure::ALL {
            let front: Vec<&Row> = front(&of_scene, charge).into_iter().map(|i| of_scene[i]).collect();
            for stretch in front.chunk_by(|a, b| a.method == b.method) {
                let error = |row: Option<&&Row>| short(row.and_then(|row| row.error));
                table.push([
                    scene.to_owned(),
                    cost_measure_name(charge).to_owned(),
                    error(stretch.first()),
                    error(stretch.last()),
                    label(&stretch[0].method),
                ]);
            }
            lines.extend(front.into_iter().filter_map(|row| {
                Some(FrontRow {
                    scene: scene.to_owned(),
                    charge,
                    cost: charge.of(row)?,
                    error: row.error?,
                    method: row.method.clone(),
                    precision: row.precision,
                    steps: row.steps,
                    h_s: row.h_s,
                })
            }));
        }
    }
    Ok(Derived {
        name: "tradeoff-fronts",
        caption: "Pareto fronts: the runs that no other run beats in both error and price, joined where one method holds several",
        csv: reports::write_csv(&lines)?,
        table,
    })
}

/// The step below which f32 and f64 stand still.
fn stagnation(rows: &[Row]) -> Result<Option<Derived>, Error> {
    let seen: Vec<&Row> = rows.iter().filter(|row| row.part == Part::Stagnation).collect();
    let headers = ["arithmetic", "let go at (m)", "stands still at (s)", "moves at (s)", "theory (s)"];
    let mut table = Table::new(&headers, &headers[1..]);
    for row in &seen {
        let numbers = [row.position_m, row.at_rest_h_s, row.moving_h_s, row.theory_h_s];
        table.push(std::iter::once(row.precision.id().to_owned()).chain(numbers.map(short)));
    }
    Ok((!seen.is_empty()).then_some(Derived {
        name: "tradeoff-stagnation",
        caption: "A body at rest at x m under 9.75 m/s²: below sqrt(ulp(x) / 2g) the first step of semi-implicit Euler moves it \
                  by less than half the distance to the next number, and not at all",
        csv: reports::write_csv(&seen)?,
        table,
    }))
}
