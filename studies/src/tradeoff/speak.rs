//! Advice in words.

use std::f64::consts::TAU;
use std::fmt::Write;

use reports::Table;

use super::advice::{Asked, Entry, Pick, over_budget};
use super::limit::{Limit, limit};
use super::search::{FINER, Search, attempt};
use crate::scene::AnyScene;
use crate::study::short;

/// Scenes whose motion does not go round or to and fro, so that no period of theirs can be told.
const APERIODIC: [&str; 7] = [
    "constant-force",
    "linear-drag",
    "quadratic-drag/fall",
    "quadratic-drag/rise",
    "damped-oscillator/critical",
    "damped-oscillator/over-damped",
    "bouncing-ball",
];

/// Writes the answer about one scene and returns the best pick.
pub(super) fn answer(asked: &Asked<'_>, mut entries: Vec<Entry>, text: &mut String) -> Option<Pick> {
    entries.sort_by(|a, b| rank(asked, a).total_cmp(&rank(asked, b)));
    // Writing to a string does not fail.
    let _ = writeln!(text, "{}", headline(asked));
    let possible: Vec<&Pick> =
        entries.iter().filter_map(|entry| entry.found.as_ref().ok()).filter(|p| allowed(asked, p)).collect();
    let best = possible.first().copied();
    match best {
        Some(best) => {
            let other = possible.iter().find(|pick| pick.candidate.rule_id() != best.candidate.rule_id());
            advice(asked, best, other.copied(), text);
        }
        None => {
            let _ = writeln!(text, "  cannot be had with {}", if entries.len() > 1 { "any of these" } else { "this" });
        }
    }
    let _ = writeln!(text, "\n{}", table(asked, &entries).to_text());
    best.copied()
}

/// Whether a pick keeps the budget, where error and budget are both given.
fn allowed(asked: &Asked<'_>, pick: &Pick) -> bool {
    over_budget(asked, pick).is_none_or(|over| over <= 1.0)
}

/// Less is better: time where the error was given (evaluations where nothing is timed), error where the budget was.
fn rank(asked: &Asked<'_>, entry: &Entry) -> f64 {
    match &entry.found {
        Err(_) => f64::INFINITY,
        Ok(pick) if asked.question.error.is_none() => pick.tried.error.unwrap_or(f64::MAX),
        Ok(pick) => pick.ns_per_simulated_second().unwrap_or(1e200 * pick.tried.evaluations as f64),
    }
}

fn headline(asked: &Asked<'_>) -> String {
    let scene = asked.need.scene;
    let unit = asked.need.truth.unit();
    let mut words = vec![];
    if let Some(error) = asked.question.error {
        words.push(format!("an error of at most {error} {unit}"));
    }
    if let Some(budget) = asked.question.budget_us {
        words.push(format!("at most {budget} us of computing a simulated second"));
    }
    let frames = asked.frames.map_or_else(String::new, |frames| format!(", in {frames} frames"));
    format!("{}: {} over {} s{frames}", scene.id(), words.join(" and "), asked.need.end_s)
}

fn advice(asked: &Asked<'_>, best: &Pick, other: Option<&Pick>, text: &mut String) {
    let mut line = |name: &str, words: String| {
        let _ = writeln!(text, "  {name:<10} {words}");
    };
    let unit = asked.need.truth.unit();
    line("method", format!("{} in {}", best.candidate.label(), best.precision.id()));
    line(
        "step",
        format!("{:.6} s, {}; {}", best.h_s, counted(best.tried.steps), in_a_period(asked.need.scene, best.h_s)),
    );
    if let Some(frames) = asked.frames {
        let substeps = best.tried.steps / frames;
        let plural = if substeps == 1 { "" } else { "s" };
        line("frame", format!("{substeps} substep{plural}, {}", cost_of_frame(asked, best)));
    }
    line("cost", cost(best));
    let limit = limit(asked.need.scene, best.candidate, best.precision);
    line("stability", limit.margin(best.h_s));
    for (i, words) in checks(asked, best, unit).into_iter().enumerate() {
        line(if i == 0 { "checked" } else { "" }, words);
    }
    if let Some(other) = other {
        line("runner-up", runner_up(asked, best, other, unit));
    }
}

fn counted(steps: u64) -> String {
    if steps == 1 { "1 step".to_owned() } else { format!("{steps} steps") }
}

fn in_a_period(scene: &dyn AnyScene, h_s: f64) -> String {
    let scale = scene.scene().info().time_scale_s;
    if APERIODIC.contains(&scene.id()) {
        format!("{:.1} in its time scale of {scale:.4} s", scale / h_s)
    } else {
        format!("{:.1} in its shortest natural period, 2 pi x {scale:.4} s", TAU * scale / h_s)
    }
}

fn cost(pick: &Pick) -> String {
    let evaluations = format!("{} evaluations of the force", pick.tried.evaluations);
    match (pick.cost, pick.ns_per_simulated_second()) {
        (Some(cost), Some(ns)) => format!(
            "{} us a simulated second ({:.1} ns and {:.0} cycles a step, median {:.1} ns); {evaluations}",
            short(Some(ns / 1e3)),
            cost.least_ns,
            cost.cycles,
            cost.median_ns
        ),
        _ => format!("{evaluations}; not timed"),
    }
}

fn cost_of_frame(asked: &Asked<'_>, pick: &Pick) -> String {
    let ns = pick.ns_per_simulated_second().zip(asked.question.rate_hz).map(|(ns, rate)| ns / rate / 1e3);
    ns.map_or_else(|| "not timed".to_owned(), |us| format!("{} us", short(Some(us))))
}

/// The advice, run again, and with its step doubled.
fn checks(asked: &Asked<'_>, pick: &Pick, unit: &str) -> Vec<String> {
    let again = attempt(&asked.need, pick.candidate, pick.precision, pick.tried.steps);
    let error =
        |error: Option<f64>| error.map_or("the run fails".to_owned(), |e| format!("error {} {unit}", short(Some(e))));
    let twice = pick.twice;
    let level = asked.question.error;
    let verdict = |e: Option<f64>| match level {
        None => "",
        Some(level) if e.is_some_and(|e| e <= level) => " - met",
        Some(_) => " - missed",
    };
    let mut lines = vec![format!("{}: {}{}", counted(again.steps), error(again.error), verdict(again.error))];
    if pick.tried.steps == 1 {
        lines.push("one step is the whole run".to_owned());
    } else if asked.frames == Some(pick.tried.steps) {
        lines.push("a step is a whole frame, and cannot be larger".to_owned());
    } else {
        let luck = if level.is_some_and(|level| twice.error.is_some_and(|e| e <= level)) {
            " by luck: a step between the two misses"
        } else {
            ""
        };
        lines.push(format!(
            "twice the step, {}: {}{}{luck}",
            counted(twice.steps),
            error(twice.error),
            verdict(twice.error)
        ));
    }
    if level.is_some() {
        lines.push(format!("{} finer steps, down to a quarter of it, keep the error too", FINER.len()));
    }
    lines
}

fn runner_up(asked: &Asked<'_>, best: &Pick, other: &Pick, unit: &str) -> String {
    let name = format!("{} in {}, step {:.6} s", other.candidate.label(), other.precision.id(), other.h_s);
    if asked.question.error.is_none() {
        let factor = other.tried.error.zip(best.tried.error).map(|(a, b)| a / b);
        return format!("{name}: error {} {unit}, {} times as large", short(other.tried.error), short(factor));
    }
    match other.ns_per_simulated_second().zip(best.ns_per_simulated_second()) {
        Some((a, b)) => format!("{name}: {} us a simulated second, {:.2} times as much", short(Some(a / 1e3)), a / b),
        None => format!("{name}: {} evaluations", other.tried.evaluations),
    }
}

/// Every method with what is stored, in the arithmetic that suits it best.
fn table(asked: &Asked<'_>, entries: &[Entry]) -> Table {
    let (frame, step) = ("substeps a frame", "step (s)");
    let headers = match asked.frames {
        Some(_) => ["method", "arithmetic", frame, step, "error", "us a frame", "of the stability limit"],
        None => ["method", "arithmetic", "steps", step, "error", "us a second", "of the stability limit"],
    };
    let mut table = Table::new(&headers, &headers[2..6]);
    let mut seen = Vec::new();
    for entry in entries {
        if seen.contains(&entry.candidate) {
            continue;
        }
        seen.push(entry.candidate);
        table.push(line(asked, entry));
    }
    table
}

fn line(asked: &Asked<'_>, entry: &Entry) -> Vec<String> {
    let name = [entry.candidate.label(), entry.precision.id().to_owned()];
    let Ok(pick) = &entry.found else {
        let blanks = ["–"; 4].map(str::to_owned);
        return name.into_iter().chain(blanks).chain([refusal(asked, entry)]).collect();
    };
    let limit: Limit = limit(asked.need.scene, pick.candidate, pick.precision);
    let (steps, us) = match asked.frames.zip(asked.question.rate_hz) {
        Some((frames, rate)) => (pick.tried.steps / frames, pick.ns_per_simulated_second().map(|ns| ns / rate / 1e3)),
        None => (pick.tried.steps, pick.ns_per_simulated_second().map(|ns| ns / 1e3)),
    };
    let over = if allowed(asked, pick) { "" } else { " over budget" };
    let cells = [
        steps.to_string(),
        format!("{:.6}", pick.h_s),
        short(pick.tried.error),
        format!("{}{over}", short(us)),
        limit.part(pick.h_s),
    ];
    name.into_iter().chain(cells).collect()
}

fn refusal(asked: &Asked<'_>, entry: &Entry) -> String {
    match &entry.found {
        Err(Search::TooMany { about: Some(steps) }) => format!("cannot be had: about {steps:.1e} steps"),
        Err(Search::TooMany { about: None }) if asked.question.error.is_none() => "not within the budget".to_owned(),
        Err(Search::TooMany { about: None }) => "cannot be had".to_owned(),
        Err(Search::Never { least }) => match least.and_then(|t| t.error.map(|e| (e, t.steps))) {
            Some((error, steps)) => {
                format!("cannot be had: rounding; least error {} at {steps} steps", short(Some(error)))
            }
            None => "cannot be had".to_owned(),
        },
        _ => String::new(),
    }
}
