//! The table of [`super::which`]: a row for each kind of scene, a column for each error.

use reports::Table;
use scenes::scene::Kind;
use serde::Serialize;

use super::Row;
use super::cells::label;
use super::which::{Best, Choice, ERRORS, choices};
use crate::error::Error;
use crate::study::{Derived, distinct};

#[derive(Serialize)]
struct WhichRow {
    /// Kind of scene.
    kind: Kind,
    /// The error asked for, relative to the largest size of the configuration.
    relative_error: f64,
    /// Scenes of this kind.
    scenes: usize,
    /// The method that does the least work; empty where none reaches the error.
    method: Option<String>,
    /// On how many of the scenes it reaches the error.
    reached: usize,
    /// The largest step that reaches the error on all of these, over the scene's time scale.
    step_over_time_scale: Option<f64>,
    /// Whether the coarsest run keeps the error already, so that the step may be longer.
    step_is_at_least: bool,
    /// Evaluations over those of semi-implicit Euler at the same error, geometric mean over the scenes.
    work_over_semi_implicit: Option<f64>,
    /// Whether that is only an upper bound.
    work_is_at_most: bool,
    /// On how many scenes semi-implicit Euler does not reach the error.
    semi_implicit_never: usize,
}

/// Which method for which kind of scene and which error.
///
/// # Errors
/// Rows that have no form as CSV.
pub(super) fn which_method(rows: &[Row]) -> Result<Derived, Error> {
    let all = choices(rows);
    let heads: Vec<String> = ERRORS.iter().map(|error| format!("error {}", percent(*error))).collect();
    let mut headers = vec!["kind of motion"];
    headers.extend(heads.iter().map(String::as_str));
    let mut table = Table::new(&headers, &[]);
    for kind in distinct(all.iter().map(|choice| choice.kind)) {
        let of_kind = all.iter().filter(|choice| choice.kind == kind);
        table.push(std::iter::once(kind.title().to_owned()).chain(of_kind.map(cell)));
    }
    let lines: Vec<WhichRow> = all.iter().map(line).collect();
    Ok(Derived {
        name: "tradeoff-which-method",
        caption: "Which method when: the method with the least work, its largest step, and how many times more work semi-implicit \
                  Euler does for the same error. The error is relative to the size of the motion (1 for an attitude). τ is the \
                  time scale: a period is 2π τ, a spin turns by one radian in τ. Work counts evaluations of the force, in f64.",
        csv: reports::write_csv(&lines)?,
        table,
    })
}

/// A part as a percentage where that is short.
fn percent(error: f64) -> String {
    if error < 1e-4 { format!("{error:e}") } else { format!("{} %", error * 100.0) }
}

fn line(choice: &Choice) -> WhichRow {
    let best = choice.best.as_ref();
    WhichRow {
        kind: choice.kind,
        relative_error: choice.error,
        scenes: choice.scenes,
        method: best.map(|best| best.method.clone()),
        reached: best.map_or(0, |best| best.reached),
        step_over_time_scale: best.map(|best| best.step),
        step_is_at_least: best.is_some_and(|best| best.step_is_at_least),
        work_over_semi_implicit: best.and_then(|best| best.work),
        work_is_at_most: best.is_some_and(|best| best.work_is_at_most),
        semi_implicit_never: best.map_or(0, |best| best.never),
    }
}

fn cell(choice: &Choice) -> String {
    let Some(best) = &choice.best else { return "no method reaches it".to_owned() };
    let at_least = if best.step_is_at_least { "≥ " } else { "" };
    let mut words = format!("{}, {at_least}{}\u{a0}τ, {}", label(&best.method), two(best.step), saving(best));
    if best.reached < choice.scenes {
        words += &format!(" ({} of {} scenes)", best.reached, choice.scenes);
    }
    words
}

/// How many times less work than semi-implicit Euler.
fn saving(best: &Best) -> String {
    let at_least = if best.work_is_at_most { "≥ " } else { "" };
    match best.work {
        Some(work) => format!("{at_least}{}\u{a0}×", two(1.0 / work)),
        None => "semi-implicit Euler never".to_owned(),
    }
}

/// Two digits: what a step or a ratio is worth that stands for several scenes.
fn two(x: f64) -> String {
    let places = 1 - x.abs().log10().floor() as i32;
    let digits = places.clamp(0, 8) as usize;
    // Above a hundred the digits that are left are zeros.
    let unit = 10_f64.powi(-places.min(0));
    if places < 0 { format!("{:.0}", (x / unit).round() * unit) } else { format!("{x:.digits$}") }
}
