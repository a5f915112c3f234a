//! The answer to a user's question: which method, in which arithmetic, with which step? Nothing is advised that was not run.

use super::budget;
use super::candidate::{Candidate, Span, candidates};
use super::clock::{Care, Cost, Task, costs};
use super::limit::{Limit, limit};
use super::quantity::Of;
use super::search::{Need, Search, Tried, attempt, finer, most_steps, search, watched};
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
    /// Largest acceptable error, in the unit of `of`.
    pub error: Option<f64>,
    /// What the error is the error of.
    pub of: Of,
    /// Microseconds of computing, on one core, for each simulated second.
    pub budget_us: Option<f64>,
    /// Length of the run, s; the scene's horizon if it is `None`.
    pub duration_s: Option<f64>,
    /// Frames per second: steps are whole parts of a frame.
    pub rate_hz: Option<f64>,
}

/// What is answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// For the user to read.
    pub text: String,
    /// Whether some method does what is asked on every scene.
    pub possible: bool,
    /// The best of each scene, where there is one.
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

/// Most frames of a run, and steps of a run within a budget.
pub(super) const MOST_FRAMES: u64 = 1 << 20;
/// Steps of a timed run.
pub(super) const TIMED_STEPS: u64 = 1024;
/// Samples of a run, if frames do not set another number: where one of them misses the error, the other steps are not looked at.
const LOOKS: u64 = 64;

impl Question {
    /// Whether the question can be answered.
    ///
    /// # Errors
    /// A number that is not positive, or what is missing.
    pub fn check(&self, has_scene: bool) -> Result<(), Error> {
        let numbers = [
            ("--error", self.error, "an error in m or rad, such as 1e-3"),
            ("--budget-us", self.budget_us, "microseconds per simulated second, such as 5"),
            ("--for", self.duration_s, "seconds, such as 60"),
            ("--rate", self.rate_hz, "frames per second, such as 60"),
        ];
        for (flag, value, example) in numbers {
            if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
                return Err(Error::plan(flag, format!("{value} is not a positive number; give {example}")));
            }
        }
        if !has_scene {
            return Err(Error::plan("--scene", "advice needs a scene; give one, such as --scene pendulum".to_owned()));
        }
        if self.error.is_none() && self.budget_us.is_none() {
            let message = "needs an error or a budget; give --error 1e-3 or --budget-us 5".to_owned();
            let flags = [(self.rate_hz.is_some(), "--rate"), (self.duration_s.is_some(), "--for"), (true, "--of")];
            return Err(Error::plan(
                flags.iter().find(|(is_given, _)| *is_given).map_or("--error", |(_, flag)| flag),
                message,
            ));
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
        if frames > MOST_FRAMES as f64 {
            let message =
                format!("{end_s} s at {rate} frames per second are more than {MOST_FRAMES} frames; shorten --for");
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
pub(super) type Steady = Result<(Tried, Limit), Search>;

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
        let error = question.error.unwrap_or(f64::INFINITY);
        let truth = Truth::new(scene.as_ref(), end_s, frames.map_or(LOOKS, looks_at_frames));
        let truth = truth.at_every_step(question.of, error);
        check_truth(&truth, scene.id(), question.of)?;
        let need = Need { scene: scene.as_ref(), truth: &truth, error, end_s, unit: frames.unwrap_or(2) };
        let asked = Asked { need, frames, question, is_short: !is_chosen };
        let ways = ways(&asked, selection)?;
        let entries = match question.error {
            Some(_) => by_error(&asked, selection, ways),
            None => budget::by_budget(&asked, &ways),
        };
        let pick = speak::answer(&asked, entries, &mut advice.text);
        advice.possible &= pick.is_some();
        advice.picks.push(pick);
    }
    Ok(advice)
}

/// Refuses a quantity that the scene does not have, and an exact motion that is not finite.
fn check_truth(truth: &Truth<'_>, scene: &str, of: Of) -> Result<(), Error> {
    let [has, is_finite] = truth.is_known();
    if !has {
        let message = format!("{scene} has no {}; choose another quantity", of.id());
        return Err(Error::plan("--of", message));
    }
    if !is_finite {
        let message =
            "the exact motion leaves the range of the numbers; shorten --for or set other parameters with --set";
        return Err(Error::plan(format!("--scene {scene}"), message));
    }
    Ok(())
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
    if limit.h_s == 0.0 {
        return Err(none);
    }
    let m = (end_s / limit.h_s / unit as f64 * (1.0 - 4.0 * f64::EPSILON)).ceil();
    if m * unit as f64 > most_steps(candidate, precision) as f64 {
        return Err(none);
    }
    let (m, run) = (m as u64, |m: u64| attempt(&asked.need, candidate, precision, m * unit));
    let keeps = |tried: &Tried| tried.error.is_some_and(|e| e <= error);
    let (tried, finer) = (run(m), finer(m, unit));
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
pub(super) fn timed(asked: &Asked<'_>, found: Vec<((Candidate, Precision), Steady)>) -> Vec<Entry> {
    let step = |tried: &Tried| asked.need.end_s / tried.steps as f64;
    let mut entries: Vec<Entry> = found
        .into_iter()
        .map(|((candidate, precision), found)| {
            let pick = |(tried, limit): (Tried, Limit)| Pick {
                candidate,
                precision,
                tried,
                twice: watched(&asked.need, candidate, precision, tried.steps.div_ceil(2)),
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
pub(super) fn task(asked: &Asked<'_>, candidate: Candidate, precision: Precision, steps: u64, h_s: f64) -> Task {
    let span = if candidate.scheme.is_implicit() {
        let steps = steps.min(TIMED_STEPS);
        Span { end_s: h_s * steps as f64, steps }
    } else {
        Span { end_s: asked.need.scene.scene().info().horizon_s, steps: TIMED_STEPS }
    };
    Task { candidate, precision, span }
}

impl Pick {
    /// Time for a simulated second, ns: the least over the rounds.
    pub fn ns_per_simulated_second(&self) -> Option<f64> {
        self.cost.map(|cost| cost.least_ns / self.h_s)
    }
}
