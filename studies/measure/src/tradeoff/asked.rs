//! A question about cost and error, and what was found for it.

use super::candidate::{Candidate, Span};
use super::clock::{Cost, Task, TimingEffort, costs};
use super::limit::Limit;
use super::quantity::Of;
use super::search::{Need, Search, Tried, watched};
use crate::error::Error;
use crate::study::Length;
use scenes::any::AnyScene;
use scenes::run::Precision;

/// What is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Question {
    /// Largest acceptable error, in the unit of `of`, or a part of its size.
    pub error: Option<f64>,
    /// Whether the error is a part of the largest size of `of` along the exact motion.
    pub is_relative: bool,
    /// What the error is the error of.
    pub of: Of,
    /// Microseconds of computing, on one core, for each simulated second.
    pub budget_us: Option<f64>,
    /// Length of the run; the scene's horizon if it is `None`.
    pub length: Option<Length>,
    /// Frames per second: steps are whole parts of a frame.
    pub rate_hz: Option<f64>,
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

impl Question {
    /// Whether the question can be answered.
    ///
    /// # Errors
    /// A number that is not positive, or what is missing.
    pub fn check(&self, has_scene: bool) -> Result<(), Error> {
        let numbers = [
            ("--error", self.error, "an error in m or rad, such as 1e-3"),
            ("--budget-us", self.budget_us, "microseconds per simulated second, such as 5"),
            ("--for", self.length.map(Length::number), "seconds, such as 60"),
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
            let flags = [(self.rate_hz.is_some(), "--rate"), (self.length.is_some(), "--for"), (true, "--of")];
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
    pub(super) fn span(&self, scene: &dyn AnyScene) -> Result<(f64, Option<u64>), Error> {
        let end_s = self.length.unwrap_or(Length::Seconds(scene.scene().info().horizon_s)).end_s(scene)?;
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
    for (pick, cost) in picks.into_iter().zip(costs(asked.need.scene, &tasks, TimingEffort::ADVICE)) {
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
