//! Advice in words.

use std::f64::consts::TAU;
use std::fmt::Write;

use reports::Table;

use super::asked::{Asked, Entry, Pick};
use super::budget::over_budget;
use super::quantity::Of;
use super::search::{Search, Tried, watched};
use crate::stability::answer::significant;
use crate::study::short;
use scenes::any::AnyScene;

/// Writes the answer about one scene and returns the best pick.
pub(super) fn answer(asked: &Asked<'_>, mut entries: Vec<Entry>, text: &mut String) -> Option<Pick> {
    entries.sort_by(|a, b| {
        let ((failed_a, a), (failed_b, b)) = (rank(asked, a), rank(asked, b));
        failed_a.cmp(&failed_b).then(a.total_cmp(&b))
    });
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
            let _ = writeln!(text, "  {}", nearest(asked, &entries));
        }
    }
    let _ = writeln!(text, "\n{}", table(asked, &entries).to_text());
    if asked.is_short && entries.iter().any(|entry| matches!(entry.found, Err(Search::Never { .. }))) {
        let _ = writeln!(text, "double-double was not tried: --precision double-double");
    }
    best.copied()
}

/// Whether a pick keeps the budget, where error and budget are both given.
fn allowed(asked: &Asked<'_>, pick: &Pick) -> bool {
    over_budget(asked, pick).is_none_or(|over| over <= 1.0)
}

/// Less is better: time where the error was given (evaluations where nothing is timed), error where the budget was; behind them
/// what does not do what is asked, by the least error that it came to.
fn rank(asked: &Asked<'_>, entry: &Entry) -> (bool, f64) {
    match &entry.found {
        Err(Search::TooMany { least: Some(least), .. } | Search::Never { least: Some(least), .. }) => {
            (true, least.error.unwrap_or(f64::INFINITY))
        }
        // They met the error, and fail for another reason.
        Err(Search::Never { least: None, .. } | Search::Unstable { .. }) => (true, asked.need.error),
        Err(_) => (true, f64::INFINITY),
        Ok(pick) if asked.question.error.is_none() => (false, pick.tried.error.unwrap_or(f64::MAX)),
        Ok(pick) => (false, pick.ns_per_simulated_second().unwrap_or(1e200 * pick.tried.evaluations as f64)),
    }
}

/// What came nearest, and why it does not do what is asked.
fn nearest(asked: &Asked<'_>, entries: &[Entry]) -> String {
    let does = if asked.question.error.is_some() { "reaches the error" } else { "keeps the budget" };
    let nearest = entries.first().map_or_else(String::new, |entry| {
        let why = entry.found.as_ref().map_or_else(|_| reason(asked, entry), |_| "over the budget".to_owned());
        format!("; nearest: {} in {}: {why}", entry.candidate.label(), entry.precision.id())
    });
    format!("no method tried {does}{nearest}")
}

fn headline(asked: &Asked<'_>) -> String {
    let scene = asked.need.scene;
    let unit = asked.need.truth.unit();
    let mut words = vec![];
    if let Some(error) = asked.question.error {
        words.push(format!("an error of at most {} {unit}{}", significant(error), of(asked)));
    }
    if let Some(budget) = asked.question.budget_us {
        words.push(format!("at most {} us of computing per simulated second", significant(budget)));
    }
    let frames = asked.frames.map_or_else(String::new, |frames| format!(", in {}", counted(frames, "frame")));
    let end = significant(asked.need.end_s);
    format!("{}: {} over {end} s{frames}", scene.id(), words.join(" and "))
}

/// ` in the velocity`, where something else than the configuration was asked for.
fn of(asked: &Asked<'_>) -> String {
    let of = asked.question.of;
    if of == Of::Configuration { String::new() } else { format!(" in the {}", of.id().replace('-', " ")) }
}

fn advice(asked: &Asked<'_>, best: &Pick, other: Option<&Pick>, text: &mut String) {
    let mut line = |name: &str, words: String| {
        let _ = writeln!(text, "  {name:<10} {words}");
    };
    let unit = asked.need.truth.unit();
    line("method", format!("{} in {}", best.candidate.label(), best.precision.id()));
    line(
        "step",
        format!(
            "{} s, {}; {}",
            significant(best.h_s),
            counted(best.tried.steps, "step"),
            in_a_period(asked.need.scene, best.h_s)
        ),
    );
    if let Some(frames) = asked.frames {
        let substeps = counted(best.tried.steps / frames, "substep");
        line("frame", format!("{substeps}, {}", cost_of_frame(asked, best)));
    }
    line("cost", cost(best));
    line("stability", best.limit.margin(best.h_s));
    for (i, words) in checks(asked, best, unit).into_iter().enumerate() {
        line(if i == 0 { "checked" } else { "" }, words);
    }
    if let Some(other) = other {
        line("runner-up", runner_up(asked, best, other, unit));
    }
}

fn counted(number: u64, of: &str) -> String {
    format!("{number} {of}{}", if number == 1 { "" } else { "s" })
}

fn in_a_period(scene: &dyn AnyScene, h_s: f64) -> String {
    let scale = scene.scene().info().time_scale_s;
    if !scene.scene().is_periodic() {
        format!("{} in its time scale of {} s", short(Some(scale / h_s)), significant(scale))
    } else {
        let in_period = TAU * scale / h_s;
        let warning = if in_period < 2.0 { " - TOO FEW to show it: give a smaller --error" } else { "" };
        let (in_period, scale) = (short(Some(in_period)), significant(scale));
        format!("{in_period} in its shortest natural period, 2 pi x {scale} s{warning}")
    }
}

fn cost(pick: &Pick) -> String {
    let evaluations = format!("{} of the force", counted(pick.tried.evaluations, "evaluation"));
    match (pick.cost, pick.ns_per_simulated_second()) {
        (Some(cost), Some(ns)) => format!(
            "{} us per simulated second ({:.1} ns and {:.0} cycles per step, median {:.1} ns); {evaluations}",
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

/// The advice, run again and watched at every step, and with its step doubled.
fn checks(asked: &Asked<'_>, pick: &Pick, unit: &str) -> Vec<String> {
    let again = watched(&asked.need, pick.candidate, pick.precision, pick.tried.steps);
    let error =
        |error: Option<f64>| error.map_or("the run fails".to_owned(), |e| format!("error {} {unit}", short(Some(e))));
    let twice = pick.twice;
    let level = asked.question.error;
    let verdict = |e: Option<f64>| match level {
        None => "",
        Some(level) if e.is_some_and(|e| e <= level) => " - met",
        Some(_) => " - missed",
    };
    let mut lines = vec![format!(
        "{}: {} at worst over all of them{}",
        counted(again.steps, "step"),
        error(again.error),
        verdict(again.error)
    )];
    if pick.tried.steps == 1 {
        lines.push("one step is the whole run".to_owned());
    } else if asked.frames == Some(pick.tried.steps) {
        lines.push("a step is a whole frame, and cannot be larger".to_owned());
    } else {
        let is_met = level.is_some_and(|level| twice.error.is_some_and(|e| e <= level));
        let luck = match (is_met, asked.frames.is_none() || pick.limit.allows(2.0 * pick.h_s)) {
            (true, true) => ", but a step between the two misses it",
            (true, false) => ", but not stable",
            _ => "",
        };
        lines.push(format!(
            "twice the step, {}: {}{}{luck}",
            counted(twice.steps, "step"),
            error(twice.error),
            verdict(twice.error)
        ));
    }
    if level.is_some() {
        let finer = pick.tried.finer;
        lines.push(format!(
            "{} keep{} the error too",
            counted(finer as u64, "finer step"),
            if finer == 1 { "s" } else { "" }
        ));
    }
    lines
}

fn runner_up(asked: &Asked<'_>, best: &Pick, other: &Pick, unit: &str) -> String {
    let name = format!("{} in {}, step {} s", other.candidate.label(), other.precision.id(), significant(other.h_s));
    if asked.question.error.is_none() {
        let factor = other.tried.error.zip(best.tried.error).map(|(a, b)| a / b);
        return format!("{name}: error {} {unit}, {} times as large", short(other.tried.error), short(factor));
    }
    match other.ns_per_simulated_second().zip(best.ns_per_simulated_second()) {
        Some((a, b)) => format!("{name}: {} us per simulated second, {:.2} times as much", short(Some(a / 1e3)), a / b),
        None => format!("{name}: {}", counted(other.tried.evaluations, "evaluation")),
    }
}

/// Every method with what is stored, in the arithmetic that suits it best.
fn table(asked: &Asked<'_>, entries: &[Entry]) -> Table {
    let (frame, step) = ("substeps per frame", "step (s)");
    let headers = match asked.frames {
        Some(_) => ["method", "arithmetic", frame, step, "error", "us per frame", "of the stability limit"],
        None => ["method", "arithmetic", "steps", step, "error", "us per second", "of the stability limit"],
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
        return name.into_iter().chain(blanks).chain([reason(asked, entry)]).collect();
    };
    let (steps, us) = match asked.frames.zip(asked.question.rate_hz) {
        Some((frames, rate)) => (pick.tried.steps / frames, pick.ns_per_simulated_second().map(|ns| ns / rate / 1e3)),
        None => (pick.tried.steps, pick.ns_per_simulated_second().map(|ns| ns / 1e3)),
    };
    let over = if allowed(asked, pick) { "" } else { " over budget" };
    let cells = [
        steps.to_string(),
        significant(pick.h_s),
        short(pick.tried.error),
        format!("{}{over}", short(us)),
        pick.limit.part(pick.h_s),
    ];
    name.into_iter().chain(cells).collect()
}

/// Why a method does not do what is asked.
fn reason(asked: &Asked<'_>, entry: &Entry) -> String {
    let least_of = |least: &Option<Tried>, searched: &u64| {
        let least = least.map(|t| format!("least error {} at {}", short(t.error), counted(t.steps, "step")));
        format!(
            "{}; searched up to {}",
            least.unwrap_or_else(|| "every run fails".to_owned()),
            counted(*searched, "step")
        )
    };
    match &entry.found {
        Err(Search::TooMany { about: Some(steps), searched, .. }) => {
            format!("about {steps:.1e} steps; searched up to {}", counted(*searched, "step"))
        }
        Err(Search::TooMany { about: None, least, searched }) => least_of(least, searched),
        Err(Search::Never { least, searched }) => format!("rounding; {}", least_of(least, searched)),
        Err(Search::OverBudget) => "not within the budget".to_owned(),
        Err(Search::Unstable { limit_s: 0.0 }) => "no stable step".to_owned(),
        Err(Search::Unstable { limit_s }) => {
            let does = if asked.question.error.is_some() { "keeps the error" } else { "is within the budget" };
            format!("no stable step, of at most {} s, {does}", significant(*limit_s))
        }
        Err(Search::Found(_)) | Ok(_) => String::new(),
    }
}
