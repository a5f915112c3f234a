//! Tables of prices.

use integrator::methods::MethodId;
use reports::Table;
use serde::Serialize;

use super::candidate::Candidate;
use super::front::front;
use super::iso::{LEVELS, Offer, Price, prices};
use super::verdict::{Duel, Factor, duels, factor};
use super::{Charge, Part, Row, ucurve};
use crate::error::Error;
use crate::run::Precision;
use crate::study::{Derived, distinct, short};

/// Every table.
///
/// # Errors
/// Rows that have no form as CSV.
pub(super) fn all(rows: &[Row]) -> Result<Vec<Derived>, Error> {
    let mut tables = vec![question(rows)?];
    for charge in Charge::ALL {
        tables.push(semi_implicit(rows, charge)?);
    }
    tables.extend([iso(rows)?, fronts(rows)?, ucurve::table(rows)?]);
    tables.extend([vanish(rows)?, steps(rows)?, storage(rows)?, lengths(rows)?].into_iter().flatten());
    Ok(tables)
}

fn runs(rows: &[Row]) -> Vec<&Row> {
    rows.iter().filter(|row| row.part == Part::Run).collect()
}

fn label(method: &str) -> String {
    Candidate::from_id(method).map_or_else(|| method.to_owned(), Candidate::label)
}

#[derive(Serialize)]
struct QuestionRow {
    error_level: f64,
    charge: Charge,
    scenes: usize,
    semi_implicit_is_best_or_level: usize,
    semi_implicit_beats_rk4: usize,
    median_rk4_over_semi_implicit: Option<f64>,
    semi_implicit_beats_implicit_euler: usize,
    median_implicit_euler_over_semi_implicit: Option<f64>,
}

/// How often semi-implicit Euler is the best buy.
fn question(rows: &[Row]) -> Result<Derived, Error> {
    let mut lines = Vec::new();
    for charge in Charge::ALL {
        let all = duels(rows, charge);
        for level in LEVELS {
            lines.push(question_row(
                all.iter().filter(|d| d.level == level && d.best.is_some()).collect(),
                level,
                charge,
            ));
        }
    }
    let [a, b, c, d, e] =
        ["scenes", "best buy, or level", "cheaper than RK4", "RK4 costs, median", "cheaper than implicit Euler"];
    let mut table = Table::new(&["error (m, rad)", "charged in", a, b, c, d, e], &["error (m, rad)", a, b, c, d, e]);
    for line in &lines {
        table.push([
            format!("{:.0e}", line.error_level),
            charge_name(line.charge).to_owned(),
            line.scenes.to_string(),
            line.semi_implicit_is_best_or_level.to_string(),
            line.semi_implicit_beats_rk4.to_string(),
            line.median_rk4_over_semi_implicit.map_or_else(|| "–".to_owned(), |x| format!("{} x", short(Some(x)))),
            line.semi_implicit_beats_implicit_euler.to_string(),
        ]);
    }
    Ok(Derived {
        name: "tradeoff-question",
        caption: "Is semi-implicit Euler good enough? On how many scenes it is the best buy at an error, and beside RK4 and \
                  implicit Euler alone; the price of RK4 as a part of its own",
        csv: reports::write_csv(&lines)?,
        table,
    })
}

fn question_row(duels: Vec<&Duel>, error_level: f64, charge: Charge) -> QuestionRow {
    // A method that never reaches the level is beaten by any factor.
    let over = |of: fn(&Duel) -> &Offer| -> Vec<f64> {
        let one = |duel: &&Duel| match (factor(of(duel), &duel.semi_implicit), &duel.semi_implicit) {
            (Some(Factor::Of(x) | Factor::AtLeast(x)), _) => Some(x),
            (Some(Factor::Never), _) => Some(f64::INFINITY),
            (None, own) => factor(own, of(duel)).map(|f| if let Factor::AtLeast(x) = f { 1.0 / x } else { 0.0 }),
        };
        duels.iter().filter_map(one).collect()
    };
    let (rk4, implicit) = (over(|d| &d.rk4), over(|d| &d.implicit));
    let beats = |factors: &[f64]| factors.iter().filter(|x| **x > 1.0).count();
    QuestionRow {
        error_level,
        charge,
        scenes: duels.len(),
        semi_implicit_is_best_or_level: duels.iter().filter(|duel| duel.semi_implicit_is_best()).count(),
        semi_implicit_beats_rk4: beats(&rk4),
        semi_implicit_beats_implicit_euler: beats(&implicit),
        median_rk4_over_semi_implicit: median(rk4),
        median_implicit_euler_over_semi_implicit: median(implicit),
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

fn charge_name(charge: Charge) -> &'static str {
    match charge {
        Charge::Evaluations => "evaluations",
        Charge::Time => "time",
    }
}

#[derive(Serialize)]
struct DuelRow {
    scene: String,
    error_level: f64,
    charge: Charge,
    semi_implicit: Option<f64>,
    semi_implicit_is: &'static str,
    best: Option<f64>,
    best_method: String,
    best_precision: Option<Precision>,
    rk4: Option<f64>,
    implicit_euler: Option<f64>,
    semi_implicit_over_best: String,
}

/// On each scene and at each error: is semi-implicit Euler the best buy, and if not, by what is it beaten?
fn semi_implicit(rows: &[Row], charge: Charge) -> Result<Derived, Error> {
    let all = duels(rows, charge);
    let cost = |offer: &Offer| if let Offer::At(price) = offer { Some(price.cost) } else { None };
    let line = |duel: &Duel| DuelRow {
        scene: duel.scene.clone(),
        error_level: duel.level,
        charge,
        semi_implicit: match &duel.semi_implicit {
            Offer::At(price) | Offer::Above(price) => Some(price.cost),
            Offer::Never => None,
        },
        semi_implicit_is: match &duel.semi_implicit {
            Offer::At(_) => "met",
            Offer::Above(_) => "more than this",
            Offer::Never => "never",
        },
        best: duel.best.as_ref().map(|best| best.cost),
        best_method: duel.best.as_ref().map_or_else(String::new, |best| best.method.clone()),
        best_precision: duel.best.as_ref().map(|best| best.precision),
        rk4: cost(&duel.rk4),
        implicit_euler: cost(&duel.implicit),
        semi_implicit_over_best: duel.beaten_by().map_or_else(String::new, Factor::show),
    };
    let headers = ["scene", "1e-2", "1e-3", "1e-4", "1e-6"];
    let mut table = Table::new(&headers, &[]);
    for of_scene in all.chunk_by(|a, b| a.scene == b.scene) {
        table.push(std::iter::once(of_scene[0].scene.clone()).chain(of_scene.iter().map(cell)));
    }
    let lines: Vec<DuelRow> = all.iter().map(line).collect();
    let (name, caption) = match charge {
        Charge::Evaluations => (
            "tradeoff-semi-implicit-evaluations",
            "Semi-implicit Euler charged in evaluations: the best buy at this error (m, rad), or by what factor it is beaten, \
             and by what",
        ),
        Charge::Time => ("tradeoff-semi-implicit-time", "The same charged in time on this machine"),
    };
    Ok(Derived { name, caption, csv: reports::write_csv(&lines)?, table })
}

fn cell(duel: &Duel) -> String {
    let Some((best, factor)) = duel.best.as_ref().zip(duel.beaten_by()) else { return "none reaches it".to_owned() };
    if duel.semi_implicit_is_best() {
        return "best buy".to_owned();
    }
    let title = Candidate::from_id(&best.method).map_or_else(String::new, |c| match c.method() {
        Some(method) => method.title().to_owned(),
        None => c.label(),
    });
    format!("{} x {title}", factor.show())
}

#[derive(Serialize)]
struct IsoRow {
    scene: String,
    error_level: f64,
    charge: Charge,
    method: String,
    precision: Precision,
    h_s: f64,
    cost: f64,
    cost_unit: &'static str,
    is_at_most: bool,
    runner_up: Option<String>,
    runner_up_precision: Option<Precision>,
    runner_up_cost: Option<f64>,
    runner_up_over_best: Option<f64>,
}

/// The cheapest method at each error, and the next.
fn iso(rows: &[Row]) -> Result<Derived, Error> {
    let runs = runs(rows);
    let mut lines = Vec::new();
    for scene in distinct(runs.iter().map(|row| row.scene.as_str())) {
        let of_scene: Vec<&Row> = runs.iter().copied().filter(|row| row.scene == scene).collect();
        for level in LEVELS {
            for charge in Charge::ALL {
                lines.extend(iso_row(scene, level, charge, &prices(&of_scene, level, charge)));
            }
        }
    }
    let headers = ["scene", "error (m, rad)", "charged in", "cheapest", "step (s)", "price", "next", "times as much"];
    let mut table = Table::new(&headers, &["error (m, rad)", "step (s)", "price", "times as much"]);
    for line in &lines {
        let at_most = if line.is_at_most { "≤ " } else { "" };
        let next = line.runner_up.as_deref().map_or_else(String::new, label);
        let price = match line.charge {
            Charge::Evaluations => format!("{at_most}{:.0}", line.cost),
            Charge::Time => format!("{at_most}{} µs/s", short(Some(line.cost / 1e3))),
        };
        let method = match line.charge {
            Charge::Evaluations => label(&line.method),
            Charge::Time => format!("{}, {}", label(&line.method), line.precision.id()),
        };
        table.push([
            line.scene.clone(),
            format!("{:.0e}", line.error_level),
            charge_name(line.charge).to_owned(),
            method,
            short(Some(line.h_s)),
            price,
            next,
            line.runner_up_over_best.map_or_else(String::new, |x| format!("{x:.2}")),
        ]);
    }
    Ok(Derived {
        name: "tradeoff-iso-error",
        caption: "The cheapest method at an error (the largest up to the horizon), in evaluations up to the horizon and in time \
                  for a simulated second; '≤' where the coarsest run keeps the error already",
        csv: reports::write_csv(&lines)?,
        table,
    })
}

fn iso_row(scene: &str, error_level: f64, charge: Charge, prices: &[Price]) -> Option<IsoRow> {
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
            Charge::Evaluations => "evaluations",
            Charge::Time => "ns per simulated second",
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
    scene: String,
    charge: Charge,
    cost: f64,
    error: f64,
    method: String,
    precision: Precision,
    steps: u64,
    h_s: f64,
}

/// The Pareto fronts; shown are the stretches that one method holds.
fn fronts(rows: &[Row]) -> Result<Derived, Error> {
    let runs = runs(rows);
    let mut lines: Vec<FrontRow> = Vec::new();
    let headers = ["scene", "charged in", "errors of", "down to", "cheapest"];
    let mut table = Table::new(&headers, &["errors of", "down to"]);
    for scene in distinct(runs.iter().map(|row| row.scene.as_str())) {
        let of_scene: Vec<&Row> = runs.iter().copied().filter(|row| row.scene == scene).collect();
        for charge in Charge::ALL {
            let front: Vec<&Row> = front(&of_scene, charge).into_iter().map(|i| of_scene[i]).collect();
            for stretch in front.chunk_by(|a, b| a.method == b.method) {
                let error = |row: Option<&&Row>| short(row.and_then(|row| row.error));
                table.push([
                    scene.to_owned(),
                    charge_name(charge).to_owned(),
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
fn vanish(rows: &[Row]) -> Result<Option<Derived>, Error> {
    let seen: Vec<&Row> = rows.iter().filter(|row| row.part == Part::Vanish).collect();
    let headers = ["arithmetic", "let go at (m)", "stands still at (s)", "moves at (s)", "theory (s)"];
    let mut table = Table::new(&headers, &headers[1..]);
    for row in &seen {
        let numbers = [row.position_m, row.at_rest_h_s, row.moving_h_s, row.theory_h_s];
        table.push(std::iter::once(row.precision.id().to_owned()).chain(numbers.map(short)));
    }
    Ok((!seen.is_empty()).then_some(Derived {
        name: "tradeoff-vanish",
        caption: "A body at rest at x m under 9.75 m/s²: below sqrt(ulp(x) / 2g) the first step of semi-implicit Euler moves it \
                  by less than half the distance to the next number, and not at all",
        csv: reports::write_csv(&seen)?,
        table,
    }))
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
    scene: String,
    method: String,
    steps: u64,
    world_error: f64,
    body_error: f64,
    world_cycles_per_step: f64,
    body_cycles_per_step: f64,
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
        name: "tradeoff-storage",
        caption: "The angular velocity of the body beside that of the world, which makes the same motion for both Eulers: what a \
                  step costs",
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
