//! The answer to a user's question: which method, in which arithmetic, with which step? Nothing is advised that was not run.

use super::candidate::{Candidate, Span, candidates};
use super::clock::{Care, Cost, Task, costs};
use super::limit::{Limit, limit};
use super::search::{MOST_STEPS, Need, Search, Tried, attempt, finer, search};
use super::speak;
use super::truth::Truth;
use crate::error::Error;
use crate::study::Selection;
use crate::sweep::in_parallel;
use scenes::any::AnyScene;
use scenes::run::Precision;

/// What is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Question {
    /// Largest error that can be stood, m or rad.
    pub error: Option<f64>,
    /// Microseconds of computing, on one core, for each simulated second.
    pub budget_us: Option<f64>,
    /// Length of the run, s; the scene's horizon if it is `None`.
    pub duration_s: Option<f64>,
    /// Frames a second: steps are whole parts of a frame.
    pub rate_hz: Option<f64>,
}

/// What is answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// For the user to read.
    pub text: String,
    /// Whether every scene asked about can be had.
    pub possible: bool,
    /// The best of each scene, where one can be had.
    pub picks: Vec<Option<Pick>>,
}

/// A method, an arithmetic and a step that were run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// What moves the scene.
    pub candidate: Candidate,
    /// The arithmetic.
    pub precision: Precision,
    /// The run.
    pub tried: Tried,
    /// The run with a step twice as large.
    pub twice: Tried,
    /// Step, s.
    pub h_s: f64,
    /// The largest stable step.
    pub limit: Limit,
    /// Time of a step; `None` for what is not timed.
    pub cost: Option<Cost>,
}

/// Steps of a timed run.
const TIMED_STEPS: u64 = 1024;
/// Looks at a run that advice rests on, if frames do not set another number.
const LOOKS: u64 = 64;

impl Question {
    /// Whether the question can be answered.
    ///
    /// # Errors
    /// A number that is not positive, or what is missing.
    pub fn check(&self, has_scene: bool) -> Result<(), Error> {
        let numbers = [
            ("--error", self.error, "an error in m or rad, such as 1e-3"),
            ("--budget-us", self.budget_us, "microseconds for a simulated second, such as 5"),
            ("--for", self.duration_s, "seconds, such as 60"),
            ("--rate", self.rate_hz, "frames a second, such as 60"),
        ];
        for (flag, value, example) in numbers {
            if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
                return Err(Error::plan(flag, format!("{value} is not a positive number; give {example}")));
            }
        }
        if !has_scene {
            return Err(Error::plan(
                "--scene",
                "advice is about a scene; name one, such as --scene pendulum".to_owned(),
            ));
        }
        if self.error.is_none() && self.budget_us.is_none() {
            let message = "say what can be stood: an error (--error 1e-3) or a budget (--budget-us 5)".to_owned();
            return Err(Error::plan(if self.rate_hz.is_some() { "--rate" } else { "--for" }, message));
        }
        Ok(())
    }

    /// End of the run and its number of frames, if frames were asked for: whole frames, at least one.
    ///
    /// # Errors
    /// More frames than a search makes steps.
    fn span(&self, scene: &dyn AnyScene) -> Result<(f64, Option<u64>), Error> {
        let end_s = self.duration_s.unwrap_or(scene.scene().info().horizon_s);
        let Some(rate) = self.rate_hz else { return Ok((end_s, None)) };
        // A product of 3600.0000000000005 is 3600 frames.
        let frames = (end_s * rate * (1.0 - 4.0 * f64::EPSILON)).ceil().max(1.0);
        if frames > MOST_STEPS as f64 {
            let message =
                format!("{end_s} s at {rate} frames a second are more than {MOST_STEPS} frames; shorten --for");
            return Err(Error::plan("--rate", message));
        }
        Ok((frames / rate, Some(frames as u64)))
    }
}

/// What was found for one candidate in one arithmetic.
pub(super) struct Entry {
    pub(super) candidate: Candidate,
    pub(super) precision: Precision,
    pub(super) found: Result<Pick, Search>,
}

/// A run that does what is asked, with the largest stable step.
type Steady = Result<(Tried, Limit), Search>;

/// A question about one scene.
pub(super) struct Asked<'a> {
    pub(super) need: Need<'a>,
    pub(super) frames: Option<u64>,
    pub(super) question: Question,
    /// Whether double-double was left out, because no arithmetic was chosen.
    pub(super) is_short: bool,
}

/// Answers for every chosen scene with every chosen method, in f32 and f64 unless one arithmetic is chosen.
///
/// # Errors
/// A question that cannot be answered.
pub fn advise(selection: &Selection, question: Question) -> Result<Advice, Error> {
    advise_in(selection, question, selection.precisions.len() < Precision::ALL.len())
}

/// The same; where the arithmetic `is_chosen`, double-double is tried too, if it is among them.
pub fn advise_in(selection: &Selection, question: Question, is_chosen: bool) -> Result<Advice, Error> {
    question.check(!selection.scenes.is_empty())?;
    let mut advice = Advice { text: String::new(), possible: true, picks: Vec::new() };
    for scene in &selection.scenes {
        let (end_s, frames) = question.span(scene.as_ref())?;
        let truth = Truth::new(scene.as_ref(), end_s, frames.map_or(LOOKS, looks_at_frames));
        let error = question.error.unwrap_or(f64::INFINITY);
        let need = Need { scene: scene.as_ref(), truth: &truth, error, end_s, unit: frames.unwrap_or(2) };
        let asked = Asked { need, frames, question, is_short: !is_chosen };
        let ways = ways(&asked, selection)?;
        let entries = match question.error {
            Some(_) => by_error(&asked, selection, ways),
            None => by_budget(&asked, &ways),
        };
        let pick = speak::answer(&asked, entries, &mut advice.text);
        advice.possible &= pick.is_some();
        advice.picks.push(pick);
    }
    Ok(advice)
}

/// Looks that fall on frames: a divisor of their number.
fn looks_at_frames(frames: u64) -> u64 {
    (LOOKS / 2..=2 * LOOKS).rev().find(|looks| frames.is_multiple_of(*looks)).unwrap_or(LOOKS)
}

/// Every way that can be timed, if there is one: a budget cannot do without.
fn ways(asked: &Asked<'_>, selection: &Selection) -> Result<Vec<(Candidate, Precision)>, Error> {
    let precisions = selection.precisions.iter().filter(|p| !asked.is_short || **p != Precision::DoubleDouble);
    let ways: Vec<(Candidate, Precision)> = precisions
        .flat_map(|&p| candidates(asked.need.scene, &selection.methods).into_iter().map(move |c| (c, p)))
        .collect();
    let timed: Vec<_> = ways.iter().copied().filter(|(c, p)| c.is_timed(*p)).collect();
    match (ways.first(), asked.question.budget_us) {
        (Some((candidate, precision)), Some(_)) if timed.is_empty() => {
            let message = format!(
                "{} is not timed in {}; choose another arithmetic, such as --precision f64, or ask with --error alone",
                candidate.label(),
                precision.id()
            );
            Err(Error::plan("--budget-us", message))
        }
        _ => Ok(if timed.is_empty() { ways } else { timed }),
    }
}

fn by_error(asked: &Asked<'_>, selection: &Selection, ways: Vec<(Candidate, Precision)>) -> Vec<Entry> {
    let weight = |(c, _): &(Candidate, Precision)| 5 - u64::from(c.scheme.order().min(4));
    let searched = in_parallel(&ways, weight, &selection.progress, |&(candidate, precision)| {
        match search(&asked.need, candidate, precision) {
            Search::Found(tried) => {
                let tried = single_step(asked, candidate, precision).unwrap_or(tried);
                stable(asked, candidate, precision, tried)
            }
            other => Err(other),
        }
    });
    timed(asked, ways.into_iter().zip(searched).collect())
}

/// A step with the largest stable one. A loop of frames goes on after the run: in it a step that is not stable gives way to the
/// largest that is, if that and finer ones keep the error.
fn stable(asked: &Asked<'_>, candidate: Candidate, precision: Precision, tried: Tried) -> Steady {
    let Need { scene, end_s, unit, error, .. } = asked.need;
    let limit = limit(scene, candidate, precision, end_s);
    if asked.frames.is_none() || limit.allows(end_s / tried.steps as f64) {
        return Ok((tried, limit));
    }
    let none = Search::Unstable { limit_s: limit.h_s };
    let m = (end_s / limit.h_s / unit as f64 * (1.0 - 4.0 * f64::EPSILON)).ceil();
    if m * unit as f64 > MOST_STEPS as f64 {
        return Err(none);
    }
    let (m, run) = (m as u64, |m: u64| attempt(&asked.need, candidate, precision, m * unit));
    let keeps = |tried: &Tried| tried.error.is_some_and(|e| e <= error);
    let (tried, finer) = (run(m), finer(m));
    if !keeps(&tried) || !finer.iter().all(|&m| keeps(&run(m))) {
        return Err(none);
    }
    Ok((Tried { finer: finer.len(), ..tried }, limit))
}

/// One step over the whole run, where even that keeps the error.
fn single_step(asked: &Asked<'_>, candidate: Candidate, precision: Precision) -> Option<Tried> {
    let keeps = |steps| {
        let tried = attempt(&asked.need, candidate, precision, steps);
        tried.error.is_some_and(|e| e <= asked.need.error).then_some(tried)
    };
    let finer = [2, 3, 4, 5, 8];
    let single = if asked.frames.is_some() { None } else { keeps(1) };
    let borne_out = single.filter(|_| finer.map(keeps).iter().all(Option::is_some));
    borne_out.map(|tried| Tried { finer: finer.len(), ..tried })
}

/// Times what was found, and runs each with its step doubled.
fn timed(asked: &Asked<'_>, found: Vec<((Candidate, Precision), Steady)>) -> Vec<Entry> {
    let step = |tried: &Tried| asked.need.end_s / tried.steps as f64;
    let mut entries: Vec<Entry> = found
        .into_iter()
        .map(|((candidate, precision), found)| {
            let pick = |(tried, limit): (Tried, Limit)| Pick {
                candidate,
                precision,
                tried,
                twice: attempt(&asked.need, candidate, precision, tried.steps.div_ceil(2)),
                h_s: step(&tried),
                limit,
                cost: None,
            };
            Entry { candidate, precision, found: found.map(pick) }
        })
        .collect();
    let picks: Vec<&mut Pick> = entries.iter_mut().filter_map(|entry| entry.found.as_mut().ok()).collect();
    let of_pick = |pick: &&mut Pick| task(asked, pick.candidate, pick.precision, pick.tried.steps, pick.h_s);
    let tasks: Vec<Task> = picks.iter().map(of_pick).collect();
    for (pick, cost) in picks.into_iter().zip(costs(asked.need.scene, &tasks, Care::ADVICE)) {
        pick.cost = cost;
    }
    entries
}

/// What is timed for a step: an explicit one costs the same whatever its length, and is timed where the scene is at home; an
/// implicit one takes more iterations when it is long, and is timed at its own length.
fn task(asked: &Asked<'_>, candidate: Candidate, precision: Precision, steps: u64, h_s: f64) -> Task {
    let span = if candidate.scheme.is_implicit() {
        let steps = steps.min(TIMED_STEPS);
        Span { end_s: h_s * steps as f64, steps }
    } else {
        Span { end_s: asked.need.scene.scene().info().horizon_s, steps: TIMED_STEPS }
    };
    Task { candidate, precision, span }
}

/// The least error of every way within the budget: the steps that it pays for, or half of them and half again where rounding
/// makes more of them worse.
fn by_budget(asked: &Asked<'_>, ways: &[(Candidate, Precision)]) -> Vec<Entry> {
    let h_s = asked.need.scene.scene().info().horizon_s / TIMED_STEPS as f64;
    let tasks: Vec<Task> = ways.iter().map(|&(c, p)| task(asked, c, p, TIMED_STEPS, h_s)).collect();
    let first = costs(asked.need.scene, &tasks, Care::FULL);
    let mut entries = timed(
        asked,
        ways.iter()
            .copied()
            .zip(first.iter().map(|cost| affordable(asked, *cost, 1.0)))
            .map(|(way, steps)| (way, best_of_halvings(asked, way, steps)))
            .collect(),
    );
    // An implicit step costs what its length makes of it: those that came out too dear take fewer steps, once.
    for (entry, first) in entries.iter_mut().zip(first) {
        let over = entry.found.as_ref().ok().and_then(|pick| over_budget(asked, pick)).unwrap_or(1.0);
        if over > 1.0 {
            let way = (entry.candidate, entry.precision);
            let again = best_of_halvings(asked, way, affordable(asked, first, 1.1 * over));
            let mut one = timed(asked, vec![(way, again)]);
            entry.found = one.remove(0).found;
        }
        if entry.found.as_ref().ok().and_then(|pick| over_budget(asked, pick)).is_some_and(|over| over > 1.0) {
            entry.found = Err(Search::OverBudget);
        }
    }
    entries
}

/// Cost over budget, if the cost is known.
pub(super) fn over_budget(asked: &Asked<'_>, pick: &Pick) -> Option<f64> {
    // The noise of a timing is not held against a step that was chosen by another one.
    const NOISE: f64 = 1.1;
    Some(pick.ns_per_simulated_second()? / (1e3 * asked.question.budget_us? * NOISE))
}

/// The steps that the budget pays for, over `dearer`: a multiple of the unit, 0 if not even one unit.
fn affordable(asked: &Asked<'_>, cost: Option<Cost>, dearer: f64) -> u64 {
    let Some((cost, budget)) = cost.zip(asked.question.budget_us) else { return 0 };
    let steps = budget * 1e3 * asked.need.end_s / (cost.least_ns * dearer);
    (steps.min(MOST_STEPS as f64) as u64) / asked.need.unit * asked.need.unit
}

fn best_of_halvings(asked: &Asked<'_>, way: (Candidate, Precision), steps: u64) -> Steady {
    let Need { scene, end_s, unit, .. } = asked.need;
    if steps < unit {
        return Err(Search::OverBudget);
    }
    let limit = limit(scene, way.0, way.1, end_s);
    let is_stable = |steps: &u64| asked.frames.is_none() || limit.allows(end_s / *steps as f64);
    if !is_stable(&steps) {
        return Err(Search::Unstable { limit_s: limit.h_s });
    }
    let ladder = (0..8).map(|k| (steps >> k) / unit * unit).filter(|&steps| steps >= unit);
    let tried = ladder.filter(is_stable).map(|steps| attempt(&asked.need, way.0, way.1, steps));
    let error = |tried: &Tried| tried.error.unwrap_or(f64::INFINITY);
    let least = tried.filter(|tried| tried.error.is_some()).min_by(|a, b| error(a).total_cmp(&error(b)));
    least.map(|least| (least, limit)).ok_or(Search::TooMany { about: None, least: None })
}

impl Pick {
    /// Time for a simulated second, ns: the least over the rounds.
    pub fn ns_per_simulated_second(&self) -> Option<f64> {
        self.cost.map(|cost| cost.least_ns / self.h_s)
    }
}
