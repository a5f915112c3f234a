//! The tables that hold semi-implicit Euler against the others.

use std::cmp::Ordering;

use reports::Table;
use serde::Serialize;

use super::candidate::Candidate;
use super::cells::cost_measure_name;
use super::cost_at_error::{CostBound, LEVELS};
use super::verdict::{Between, Comparison, Factor, comparisons};
use super::{CostMeasure, Row};
use crate::error::Error;
use crate::study::{Derived, short};
use scenes::run::Precision;

#[derive(Serialize)]
pub(super) struct QuestionRow {
    /// The error asked for, m or rad.
    pub(super) error_level: f64,
    /// What is counted: evaluations up to the horizon, or time.
    pub(super) charge: CostMeasure,
    /// Scenes that were compared.
    pub(super) scenes: usize,
    /// On how many semi-implicit Euler is the cheapest, or level with it.
    pub(super) semi_implicit_is_best_or_level: usize,
    /// On how many its cost beside RK4 is known.
    pub(super) rk4_known: usize,
    /// On how many of these it is cheaper than RK4.
    pub(super) semi_implicit_beats_rk4: usize,
    /// On how many RK4 is cheaper.
    pub(super) rk4_beats_semi_implicit: usize,
    /// Median of the cost of RK4 over its own.
    pub(super) median_rk4_over_semi_implicit: Option<f64>,
    /// On how many its cost beside implicit Euler is known.
    pub(super) implicit_euler_known: usize,
    /// On how many of these it is cheaper.
    pub(super) semi_implicit_beats_implicit_euler: usize,
    /// Median of the cost of implicit Euler over its own.
    pub(super) median_implicit_euler_over_semi_implicit: Option<f64>,
}

/// How often semi-implicit Euler is the cheapest.
pub(super) fn question(rows: &[Row]) -> Result<Derived, Error> {
    let mut lines = Vec::new();
    for charge in CostMeasure::ALL {
        let all = comparisons(rows, charge);
        lines.extend(LEVELS.map(|level| question_row(&all, level, charge)));
    }
    let [a, b, c, d, e] =
        ["scenes", "cheapest, or level", "cheaper than RK4", "RK4 costs, median", "cheaper than implicit Euler"];
    let mut table = Table::new(&["error (m, rad)", "cost in", a, b, c, d, e], &["error (m, rad)", a, b, c, d, e]);
    for line in &lines {
        table.push([
            format!("{:.0e}", line.error_level),
            cost_measure_name(line.charge).to_owned(),
            line.scenes.to_string(),
            line.semi_implicit_is_best_or_level.to_string(),
            format!("{} of {} known", line.semi_implicit_beats_rk4, line.rk4_known),
            line.median_rk4_over_semi_implicit.map_or_else(|| "–".to_owned(), |x| format!("{} x", short(Some(x)))),
            format!("{} of {} known", line.semi_implicit_beats_implicit_euler, line.implicit_euler_known),
        ]);
    }
    Ok(Derived {
        name: "tradeoff-question",
        caption: "Is semi-implicit Euler good enough? On how many scenes it is the cheapest at an error, and beside RK4 and \
                  implicit Euler alone, where the sweeps reach far enough to tell; the price of RK4 as a part of its own, \
                  where the median is no bound",
        csv: reports::write_csv(&lines)?,
        table,
    })
}

/// The same at one error, over the scenes on which it was reached.
pub(super) fn question_row(comparisons: &[Comparison], error_level: f64, charge: CostMeasure) -> QuestionRow {
    let comparisons: Vec<&Comparison> =
        comparisons.iter().filter(|comparison| comparison.level == error_level && comparison.best.is_some()).collect();
    let over = |of: fn(&Comparison) -> &CostBound| -> Vec<Between> {
        let all = comparisons.iter().map(|comparison| Between::of(of(comparison), &comparison.semi_implicit));
        all.filter(|factor| factor.beside_one().is_some()).collect()
    };
    let (rk4, implicit) = (over(|d| &d.rk4), over(|d| &d.implicit));
    let count = |factors: &[Between], order| factors.iter().filter(|f| f.beside_one() == Some(order)).count();
    QuestionRow {
        error_level,
        charge,
        scenes: comparisons.len(),
        semi_implicit_is_best_or_level: comparisons
            .iter()
            .filter(|comparison| comparison.semi_implicit_is_best())
            .count(),
        rk4_known: rk4.len(),
        semi_implicit_beats_rk4: count(&rk4, Ordering::Greater),
        rk4_beats_semi_implicit: count(&rk4, Ordering::Less),
        median_rk4_over_semi_implicit: median(&rk4),
        implicit_euler_known: implicit.len(),
        semi_implicit_beats_implicit_euler: count(&implicit, Ordering::Greater),
        median_implicit_euler_over_semi_implicit: median(&implicit),
    }
}

/// The factor in the middle; `None` where a bound sits there: the medians of the lower and the upper bounds enclose it.
fn median(factors: &[Between]) -> Option<f64> {
    let middle = |bound: fn(&Between) -> f64| {
        let mut bounds: Vec<f64> = factors.iter().map(bound).collect();
        bounds.sort_by(f64::total_cmp);
        bounds.get(bounds.len() / 2).copied()
    };
    middle(|factor| factor.low).filter(|low| low.is_finite() && middle(|factor| factor.high) == Some(*low))
}

#[derive(Serialize)]
struct ComparisonRow {
    /// Scene or preset.
    scene: String,
    /// The error asked for, m or rad.
    error_level: f64,
    /// What is counted: evaluations up to the horizon, or time.
    charge: CostMeasure,
    /// Cost of semi-implicit Euler.
    semi_implicit: Option<f64>,
    /// Whether that is known, or a bound.
    semi_implicit_is: &'static str,
    /// Cost of the cheapest method.
    best: Option<f64>,
    /// The cheapest method.
    best_method: String,
    /// Its arithmetic.
    best_precision: Option<Precision>,
    /// Cost of RK4.
    rk4: Option<f64>,
    /// Cost of implicit Euler.
    implicit_euler: Option<f64>,
    /// Cost of semi-implicit Euler over the cheapest, in words where it is a bound.
    semi_implicit_over_best: String,
}

/// On each scene and at each error: is semi-implicit Euler the cheapest, and if not, by what is it beaten?
pub(super) fn semi_implicit(rows: &[Row], charge: CostMeasure) -> Result<Derived, Error> {
    let all = comparisons(rows, charge);
    let cost = |offer: &CostBound| if let CostBound::At(price) = offer { Some(price.cost) } else { None };
    let line = |comparison: &Comparison| ComparisonRow {
        scene: comparison.scene.clone(),
        error_level: comparison.level,
        charge,
        semi_implicit: match &comparison.semi_implicit {
            CostBound::At(price) | CostBound::Above(price) => Some(price.cost),
            CostBound::Never => None,
        },
        semi_implicit_is: match &comparison.semi_implicit {
            CostBound::At(_) => "met",
            CostBound::Above(_) => "more than this",
            CostBound::Never => "never",
        },
        best: comparison.best.as_ref().map(|best| best.cost),
        best_method: comparison.best.as_ref().map_or_else(String::new, |best| best.method.clone()),
        best_precision: comparison.best.as_ref().map(|best| best.precision),
        rk4: cost(&comparison.rk4),
        implicit_euler: cost(&comparison.implicit),
        semi_implicit_over_best: comparison.beaten_by().map_or_else(String::new, Factor::show),
    };
    let headers = ["scene", "1e-1", "1e-2", "1e-3", "1e-4", "1e-6"];
    let mut table = Table::new(&headers, &[]);
    for of_scene in all.chunk_by(|a, b| a.scene == b.scene) {
        table.push(std::iter::once(of_scene[0].scene.clone()).chain(of_scene.iter().map(cell)));
    }
    let lines: Vec<ComparisonRow> = all.iter().map(line).collect();
    let (name, caption) = match charge {
        CostMeasure::Evaluations => (
            "tradeoff-semi-implicit-evaluations",
            "Cost of semi-implicit Euler in evaluations: the cheapest at this error (m, rad), or by what factor it is beaten, \
             and by what",
        ),
        CostMeasure::Time => ("tradeoff-semi-implicit-time", "The same in time on this machine"),
    };
    Ok(Derived { name, caption, csv: reports::write_csv(&lines)?, table })
}

fn cell(comparison: &Comparison) -> String {
    let Some((best, factor)) = comparison.best.as_ref().zip(comparison.beaten_by()) else {
        return "none reaches it".to_owned();
    };
    if comparison.semi_implicit_is_best() {
        return "cheapest".to_owned();
    }
    let title = Candidate::from_id(&best.method).map_or_else(String::new, |c| match c.method() {
        Some(method) => method.title().to_owned(),
        None => c.label(),
    });
    format!("{} x {title}", factor.show())
}
