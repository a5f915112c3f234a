//! The answer to a user's question: what is the largest step, and what happens beyond it?

use std::fmt::Write;

use faer::fx128;
use integrator::Real;

use super::amplification;
use super::bisect::{Found, bracket};
use super::frames;
use super::limits;
use crate::study::{Selection, short};
use scenes::any::AnyScene;
use scenes::observation::Value;
use scenes::run::{Outcome, Precision, Run, Trajectory};
use scenes::stepping::Stepping;

/// A step, or a rate, to judge: positive numbers.
#[derive(Clone, Debug, Default)]
pub struct Question {
    /// A step to judge, s.
    pub step_s: Option<f64>,
    /// Frames per second: how many substeps does each need?
    pub rate_hz: Option<f64>,
    /// Steps that follow one another in turn, s.
    pub frames_s: Vec<f64>,
    /// Part by which the step to judge varies at random, either way.
    pub jitter: Option<f64>,
}

/// The text of an answer, and whether every step asked about is stable.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// For the user to read.
    pub text: String,
    /// False if a step asked about is not stable.
    pub stable: bool,
}

/// Answers for every chosen scene and method, in the first chosen precision (f64 if all are).
pub fn answer(selection: &Selection, question: &Question) -> Answer {
    let all = selection.precisions.len() == Precision::ALL.len();
    let precision = if all { Precision::F64 } else { selection.precisions[0] };
    let mut answer = Answer { text: String::new(), stable: true };
    for scene in &selection.scenes {
        for &method in &selection.methods {
            let stepping = Stepping { scene: scene.as_ref(), method, precision };
            one(&stepping, question, &mut answer);
        }
    }
    answer
}

/// What is said of a scene whose steps are no linear maps: nothing is known, and nothing is called stable.
const NOT_LINEAR: &str = "not known: the steps of this scene are no linear maps";

/// Steps in turn: a line, and whether they are stable.
fn in_turn(stepping: &Stepping<'_>, frames_s: &[f64]) -> (String, bool) {
    let all: Vec<String> = frames_s.iter().map(|h| format!("{h} s")).collect();
    let all = all.join(", ");
    let count = frames_s.len();
    let Some(found) = frames::pattern(stepping, frames_s) else {
        return (format!("  frames {all} in turn: {NOT_LINEAR}"), false);
    };
    let alone = |h: &f64| match frames::pattern(stepping, &[*h]) {
        Some(one) if one.is_stable => format!("{h} s is stable"),
        _ => format!("{h} s is not"),
    };
    let alone: Vec<String> = frames_s.iter().map(alone).collect();
    let verdict = if found.is_stable { "stable" } else { "NOT stable" };
    let each = found.factor.powf(1.0 / count as f64);
    let factor = format!("factor {:.6} per {count} frames, {each:.6} per frame", found.factor);
    (format!("  frames {all} in turn: {verdict}: {factor}; alone {}", alone.join(", ")), found.is_stable)
}

/// Steps that vary at random: a line, and whether errors do not grow.
fn at_random(stepping: &Stepping<'_>, step_s: f64, part: f64) -> (String, bool) {
    let Some(found) = frames::jitter(stepping, step_s, part, 1) else {
        return (format!("  steps of {step_s} s +- {} %: {NOT_LINEAR}", 100.0 * part), false);
    };
    let verdict = if found.grows() { "NOT stable" } else { "no growth seen" };
    let rate = format!("errors grow by a factor exp({:.3e} +- {:.1e}) per step", found.rate, found.half_width);
    (
        format!("  steps of {step_s} s +- {} %: {verdict}: {rate}, over {} steps", 100.0 * part, found.steps),
        !found.grows(),
    )
}

fn one(stepping: &Stepping<'_>, question: &Question, answer: &mut Answer) {
    let scale = stepping.scene.scene().info().time_scale_s;
    let mut line = |text: String| {
        // Writing to a string does not fail.
        let _ = writeln!(answer.text, "{text}");
    };
    line(format!("{} with {} in {}", stepping.scene.id(), stepping.method.title(), stepping.precision.id()));
    let linear = amplification::limit(stepping);
    let theory = linear.and_then(limits::number);
    let trial = linear.map(|limit| limits::Trial::of(stepping, limit));
    let found = match linear {
        Some(limit) => limits::measure(stepping, limit),
        None => measure_nonlinear(stepping.scene, 0.0, |end_s, steps| {
            stepping.scene.run(&Run::new(stepping.method, stepping.precision, end_s, steps), 1)
        }),
    };
    match theory {
        Some(limit) => line(format!("  theory (amplification matrix): {}", seconds(limit))),
        None => line(format!(
            "  no linear theory; judged by running {TIME_SCALES} time scales: a run fails that leaves the range of the exact motion {LEAVES} times over"
        )),
    }
    if let Some((limit, reason)) = stepping.scene.scene().expected_limit(stepping.method) {
        line(format!("  closed form: {} ({reason})", limits::number(limit).map_or_else(String::new, seconds)));
    }
    let limit_s = match found {
        _ if trial.is_some_and(|trial| !trial.sees) => {
            line("  not measured: the growth beyond the limit is too slow to show in a run".to_owned());
            theory.unwrap_or(0.0)
        }
        Found::NoStep { tried_s } => {
            line(format!("  measured: no stable step; {} s fails already", significant(tried_s)));
            theory.unwrap_or(0.0)
        }
        Found::Bracket { low_s, high_s } => {
            line(format!(
                "  measured: holds at {} s, fails at {} s (h / time scale {} .. {})",
                significant(low_s),
                significant(high_s),
                significant(low_s / scale),
                significant(high_s / scale)
            ));
            theory.unwrap_or(low_s)
        }
        Found::Unlimited { tried_s } => {
            line(format!("  measured: no limit found; {} s holds still", significant(tried_s)));
            theory.unwrap_or(f64::INFINITY)
        }
    };
    if let Some(trial) = trial.filter(|trial| trial.sees) {
        line(format!(
            "  judged over {} steps: growth of less than {:.1e} per step would not show",
            trial.patience,
            trial.growth()
        ));
    }
    if !question.frames_s.is_empty() {
        let (text, stable) = in_turn(stepping, &question.frames_s);
        answer.stable &= stable;
        line(text);
    }
    if let (Some(part), Some(step)) = (question.jitter, question.step_s) {
        let (text, stable) = at_random(stepping, step, part);
        answer.stable &= stable;
        line(text);
    }
    if let Some(step) = question.step_s {
        let stable = step <= limit_s;
        answer.stable &= stable;
        let verdict = match (stable, linear.is_some()) {
            (false, _) => "NOT stable".to_owned(),
            (true, true) => "stable".to_owned(),
            (true, false) => format!("did not fail within {TIME_SCALES} time scales"),
        };
        let margin = if limit_s == 0.0 || limit_s.is_infinite() {
            String::new()
        } else {
            format!(", {} of the limit", short(Some(step / limit_s)))
        };
        let _ = writeln!(answer.text, "  step {step} s: {verdict}{margin}{}", substeps_words(step, limit_s, "step"));
    }
    if let Some(rate) = question.rate_hz {
        let frame = 1.0 / rate;
        let _ = writeln!(answer.text, "  {rate} frames per second{}", substeps_words(frame, limit_s, "frame"));
        answer.stable &= limit_s > 0.0;
    }
}

/// Six significant digits, without the zeros behind them.
pub(crate) fn significant(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if rounded == 0.0 || (1e-3..1e7).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

fn seconds(limit: f64) -> String {
    if limit == 0.0 {
        "no step is stable".to_owned()
    } else if limit.is_infinite() {
        "every step is stable".to_owned()
    } else {
        format!("h <= {} s", significant(limit))
    }
}

/// Substeps that a step of `h_s` must be cut into, at least one; `None` where no number helps.
pub fn substeps(h_s: f64, limit_s: f64) -> Option<u64> {
    // At the limit itself a step is marginal and counts as stable; a quotient of 2 + 1e-16 is 2.
    (limit_s > 0.0).then(|| ((h_s / limit_s * (1.0 - 4.0 * f64::EPSILON)).ceil() as u64).max(1))
}

fn substeps_words(h_s: f64, limit_s: f64, of: &str) -> String {
    match substeps(h_s, limit_s) {
        Some(1) => format!(": 1 substep per {of} is enough for stability"),
        Some(n) => format!(": {n} substeps per {of} are needed for stability"),
        None => ": no number of substeps makes this method stable".to_owned(),
    }
}

/// Length of a run on a scene without a linear theory, in natural time scales.
pub(crate) const TIME_SCALES: f64 = 64.0;
/// A run has failed whose coordinates exceed the largest of the exact motion by this factor.
const LEAVES: f64 = 4.0;

/// Steps of the longest run that stability is measured with.
const MOST_STEPS: f64 = (1_u64 << 20) as f64;

/// The largest step with which a scene stays within a multiple of the range of its exact motion, over 64 time scales or the
/// duration asked for, if that is longer; `run` takes so many steps to the end and shows how it went.
pub(crate) fn measure_nonlinear(
    scene: &dyn AnyScene,
    asked_s: f64,
    run: impl Fn(f64, u64) -> Option<Trajectory>,
) -> Found {
    let scale = scene.scene().info().time_scale_s;
    let end = asked_s.max(TIME_SCALES * scale);
    let sizes = |seen: &scenes::observation::Observation| -> Vec<f64> {
        seen.values
            .iter()
            .map(|(quantity, value)| match value {
                Value::Vector(_) => seen.scale(*quantity),
                Value::Rotation(_) => 1.0,
            })
            .collect()
    };
    let mut range: Vec<f64> = Vec::new();
    for i in 0..=512 {
        let at = sizes(&scene.exact(fx128::lit(end * f64::from(i) / 512.0)));
        range.resize(at.len(), 0.0);
        for (largest, x) in range.iter_mut().zip(at) {
            *largest = largest.max(x);
        }
    }
    let holds = |h: f64| {
        let steps = ((end / h).ceil() as u64).max(4);
        let Some(trajectory) = run(h * steps as f64, steps) else { return false };
        trajectory.outcome == Outcome::Finished
            && trajectory
                .seen
                .iter()
                .all(|(_, seen)| sizes(seen).iter().zip(&range).all(|(x, most)| *x <= LEAVES * most))
    };
    bracket((scale / 64.0).max(end / MOST_STEPS), 64.0 * scale, 0.01, holds)
}
