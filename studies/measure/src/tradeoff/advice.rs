//! The answer to a user's question: which method, in which arithmetic, with which step? Nothing is advised that was not run.

use super::advice_text;
use super::asked::{Asked, Entry, Steady, timed};
pub use super::asked::{Pick, Question};
use super::budget;
use super::candidate::{Candidate, candidates};
use super::exact::ExactSamples;
use super::limit::limit;
use super::quantity::Of;
use super::search::{Need, Search, Tried, attempt, finer, most_steps, search};
use crate::error::Error;
use crate::study::Selection;
use crate::sweep::in_parallel;
use faer::fx128;
use scenes::any::AnyScene;
use scenes::observation::Value;
use scenes::run::Precision;

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

/// Samples of a run, if frames do not set another number: where one of them misses the error, the other steps are not looked at.
const SAMPLES: u64 = 64;

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
        let truth = ExactSamples::new(scene.as_ref(), end_s, frames.map_or(SAMPLES, samples_at_frames));
        let truth = truth.of(question.of);
        check_truth(&truth, scene.as_ref(), question.of)?;
        let question = absolute(question, &truth, scene.as_ref())?;
        let error = question.error.unwrap_or(f64::INFINITY);
        let truth = truth.at_every_step(question.of, error);
        let need = Need { scene: scene.as_ref(), truth: &truth, error, end_s, unit: frames.unwrap_or(2) };
        let asked = Asked { need, frames, question, is_short: !is_chosen };
        let ways = ways(&asked, selection)?;
        let entries = match question.error {
            Some(_) => by_error(&asked, selection, ways),
            None => budget::by_budget(&asked, &ways),
        };
        let pick = advice_text::answer(&asked, entries, &mut advice.text);
        advice.possible &= pick.is_some();
        advice.picks.push(pick);
    }
    Ok(advice)
}

/// Refuses a quantity that the scene does not have, and an exact motion that is not finite.
fn check_truth(truth: &ExactSamples<'_>, scene: &dyn AnyScene, of: Of) -> Result<(), Error> {
    let [has, is_finite] = truth.is_known();
    if !has {
        let start = scene.exact(fx128::ZERO);
        let has = |of: &Of| !of.values(scene, fx128::ZERO, &start).is_empty();
        let known: Vec<&str> = Of::NAMED.into_iter().filter(has).map(Of::id).collect();
        let message = format!("{} has no {}; give --of {}", scene.id(), of.id(), known.join(", or "));
        return Err(Error::plan("--of", message));
    }
    if !is_finite {
        let message =
            "the exact motion leaves the range of the numbers; shorten --for or set other parameters with --set";
        return Err(Error::plan(format!("--scene {}", scene.id()), message));
    }
    Ok(())
}

/// The question with the error in its unit, where a part was given.
fn absolute(question: Question, truth: &ExactSamples<'_>, scene: &dyn AnyScene) -> Result<Question, Error> {
    let Some(part) = question.error.filter(|_| question.is_relative) else { return Ok(question) };
    let refuse = |message: String| Err(Error::plan("--error", message));
    let start = scene.exact(fx128::ZERO);
    let values = question.of.values(scene, fx128::ZERO, &start);
    if values.iter().any(|value| matches!(**value, Value::Rotation(_))) {
        return refuse("an attitude has no size of which it could be a part; give an angle, such as 1deg".to_owned());
    }
    let size = truth.scale();
    if !(size > 0.0) {
        return refuse(format!("the {} of {} is zero all the time; give a number", question.of.id(), scene.id()));
    }
    Ok(Question { error: Some(part * size), ..question })
}

/// Looks that fall on frames: a divisor of their number.
fn samples_at_frames(frames: u64) -> u64 {
    (SAMPLES / 2..=2 * SAMPLES).rev().find(|samples| frames.is_multiple_of(*samples)).unwrap_or(SAMPLES)
}

/// Every way that can be timed, if there is one: a budget cannot do without.
fn ways(asked: &Asked<'_>, selection: &Selection) -> Result<Vec<(Candidate, Precision)>, Error> {
    let precisions = selection.precisions.iter().filter(|p| !asked.is_short || **p != Precision::DoubleDouble);
    let ways: Vec<(Candidate, Precision)> = precisions
        .flat_map(|&p| {
            candidates(asked.need.scene, &selection.methods, &selection.schemes).into_iter().map(move |c| (c, p))
        })
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
