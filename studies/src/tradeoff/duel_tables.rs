//! The tables that hold semi-implicit Euler against the others.

use reports::Table;
use serde::Serialize;

use super::candidate::Candidate;
use super::iso::{LEVELS, Offer};
use super::tables::charge_name;
use super::verdict::{Duel, Factor, duels, factor};
use super::{Charge, Row};
use crate::error::Error;
use crate::run::Precision;
use crate::study::{Derived, short};

#[derive(Serialize)]
pub(super) struct QuestionRow {
    pub(super) error_level: f64,
    pub(super) charge: Charge,
    pub(super) scenes: usize,
    pub(super) semi_implicit_is_best_or_level: usize,
    pub(super) semi_implicit_beats_rk4: usize,
    pub(super) median_rk4_over_semi_implicit: Option<f64>,
    pub(super) semi_implicit_beats_implicit_euler: usize,
    pub(super) median_implicit_euler_over_semi_implicit: Option<f64>,
}

/// How often semi-implicit Euler is the best buy.
pub(super) fn question(rows: &[Row]) -> Result<Derived, Error> {
    let mut lines = Vec::new();
    for charge in Charge::ALL {
        let all = duels(rows, charge);
        lines.extend(LEVELS.map(|level| question_row(&all, level, charge)));
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

/// The same at one error, over the scenes on which it was reached.
pub(super) fn question_row(duels: &[Duel], error_level: f64, charge: Charge) -> QuestionRow {
    let duels: Vec<&Duel> = duels.iter().filter(|duel| duel.level == error_level && duel.best.is_some()).collect();
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
pub(super) fn semi_implicit(rows: &[Row], charge: Charge) -> Result<Derived, Error> {
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
    let headers = ["scene", "1e-1", "1e-2", "1e-3", "1e-4", "1e-6"];
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
