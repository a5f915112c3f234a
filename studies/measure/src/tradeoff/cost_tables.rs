//! Tables of what a step costs.

use integrator::methods::MethodId;
use reports::Table;
use serde::Serialize;

use super::cells::{label, runs};
use super::{Part, Row};
use crate::error::Error;
use crate::study::{Derived, distinct, short};
use scenes::run::Precision;

/// Every one for which something was timed.
pub(super) fn all(rows: &[Row]) -> Result<Vec<Derived>, Error> {
    Ok([steps(rows)?, storage(rows)?, lengths(rows)?].into_iter().flatten().collect())
}

/// What one step costs: the timed run of every sweep.
fn steps(rows: &[Row]) -> Result<Option<Derived>, Error> {
    let timed: Vec<&Row> = runs(rows).into_iter().filter(|row| row.timed_steps == Some(row.steps)).collect();
    let headers =
        ["scene", "method", "arithmetic", "steps", "ns a step", "median", "cycles a step", "evaluations a step"];
    let mut table = Table::new(&headers, &headers[3..]);
    for row in timed.iter().filter(|row| row.precision == Precision::F64) {
        table.push([
            row.scene.clone(),
            label(&row.method),
            row.precision.id().to_owned(),
            row.steps.to_string(),
            short(row.least_ns_per_step),
            short(row.median_ns_per_step),
            row.cycles_per_step.map_or_else(String::new, |c| format!("{c:.1}")),
            short(Some(row.evaluations as f64 / row.steps as f64)),
        ]);
    }
    Ok((!timed.is_empty()).then_some(Derived {
        name: "tradeoff-steps",
        caption: "What a step costs: least and median over interleaved rounds, with a chain of four-cycle links as the clock of \
                  each round; shown in f64, f32 and double-double are in the file",
        csv: reports::write_csv(&timed)?,
        table,
    }))
}

#[derive(Serialize)]
struct StorageRow {
    /// Scene or preset.
    scene: String,
    /// Method.
    method: String,
    /// Number of steps.
    steps: u64,
    /// Error with the angular velocity of the world frame, rad.
    world_error: f64,
    /// The same in the body frame, rad.
    body_error: f64,
    /// Cycles per step in the world frame.
    world_cycles_per_step: f64,
    /// The same in the body frame.
    body_cycles_per_step: f64,
    /// Their ratio.
    world_over_body: f64,
}

/// The same method with the angular velocity of the world and with that of the body.
fn storage(rows: &[Row]) -> Result<Option<Derived>, Error> {
    let runs = runs(rows);
    let mut lines = Vec::new();
    for world in runs.iter().filter(|row| row.precision == Precision::F64 && row.timed_steps == Some(row.steps)) {
        let Some(method) = world.method.strip_suffix("/world-omega") else { continue };
        let name = format!("{method}/body-omega");
        let is_pair = |row: &&&Row| {
            (&row.scene, row.precision, row.steps) == (&world.scene, world.precision, world.steps) && row.method == name
        };
        lines.extend(runs.iter().find(is_pair).and_then(|body| {
            let (of_world, of_body) = (world.cycles_per_step?, body.cycles_per_step?);
            Some(StorageRow {
                scene: world.scene.clone(),
                method: method.to_owned(),
                steps: world.steps,
                world_error: world.error?,
                body_error: body.error?,
                world_cycles_per_step: of_world,
                body_cycles_per_step: of_body,
                world_over_body: of_world / of_body,
            })
        }));
    }
    let headers =
        ["scene", "method", "steps", "error, world ω", "error, body ω", "cycles, world ω", "cycles, body ω", "ratio"];
    let mut table = Table::new(&headers, &headers[2..]);
    for line in &lines {
        table.push([
            line.scene.clone(),
            MethodId::ALL.iter().find(|m| m.id() == line.method).map_or("", |m| m.title()).to_owned(),
            line.steps.to_string(),
            short(Some(line.world_error)),
            short(Some(line.body_error)),
            format!("{:.0}", line.world_cycles_per_step),
            format!("{:.0}", line.body_cycles_per_step),
            format!("{:.1}", line.world_over_body),
        ]);
    }
    Ok((!lines.is_empty()).then_some(Derived {
        name: "tradeoff-formulation",
        caption: "The angular velocity of the body beside that of the world: the same motion with semi-implicit Euler, at a part of \
                  the cost of a step",
        csv: reports::write_csv(&lines)?,
        table,
    }))
}

/// Whether a step of a long run costs what one of a short run costs.
fn lengths(rows: &[Row]) -> Result<Option<Derived>, Error> {
    let seen: Vec<&Row> = rows.iter().filter(|row| row.part == Part::Length).collect();
    let steps = distinct(seen.iter().map(|row| row.steps));
    let names: Vec<String> = steps.iter().map(|n| format!("{n} steps")).collect();
    let headers: Vec<&str> = ["scene", "method"].into_iter().chain(names.iter().map(String::as_str)).collect();
    let mut table = Table::new(&headers, &headers[2..]);
    for of_method in seen.chunk_by(|a, b| a.scene == b.scene && a.method == b.method) {
        let cells = of_method.iter().map(|row| short(row.least_ns_per_step));
        table.push([of_method[0].scene.clone(), label(&of_method[0].method)].into_iter().chain(cells));
    }
    Ok((!seen.is_empty()).then_some(Derived {
        name: "tradeoff-lengths",
        caption: "Cost grows linearly with the number of steps: ns a step in runs of every length, least over the rounds",
        csv: reports::write_csv(&seen)?,
        table,
    }))
}
