//! Numbers that others printed about loops: read from a table, run, and compared in their last digit.

use faer::fx128;
use integrator::{Real, Single, State};
use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use super::row::{Experiment, Row};
use crate::error::Error;
use crate::game_loop::description::{Clock, Loop};
use crate::game_loop::drive::{Job, Seen, Until};
use scenes::any::AnyScene;
use scenes::erased::{AnyMotion, FlatMotion};
use scenes::invariants::Invariant;
use scenes::run::{Outcome, method_from_id};

/// The table of this study.
const CSV: &str = include_str!("../../data/published-loops.csv");
/// Where it stands, for errors.
const PLACE: &str = "studies/measure/data/published-loops.csv";
/// Frames of a run, at most.
const MOST_FRAMES: f64 = 1e8;

/// One printed number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// Its name.
    pub id: String,
    /// Where it stands.
    pub source: String,
    /// The scene.
    pub scene: String,
    /// Parameters, `name=value` separated by blanks.
    pub set: String,
    /// The method.
    pub method: String,
    /// The loop, `key=value` separated by blanks.
    #[serde(rename = "loop")]
    pub settings: String,
    /// Length of a frame, s.
    pub step_s: f64,
    /// Length of the run, s.
    pub for_s: f64,
    /// What was printed: see `Quantity` in this file.
    pub quantity: String,
    /// The number.
    pub value: f64,
    /// How many significant digits of it are printed, trailing zeros counted.
    pub printed_digits: i32,
}

/// What a number can be, as `quantity` names it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Quantity {
    /// `end position`, `end velocity`, `largest position`, .., with ` x`, ` y`, ` z` for a component other than the first.
    Component { pick: Pick, is_velocity: bool, index: usize },
    /// `largest energy error`, `least energy error`: (E - E_0) / E_0.
    Energy(Pick),
    /// `end error`: distance of what is drawn from the exact motion at the time of the frames.
    Error,
    /// `time lost`: the frames' time less the simulated one, s.
    TimeLost,
    /// `steps`.
    Steps,
}

/// Which value of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pick {
    End,
    Largest,
    Least,
}

const QUANTITIES: &str =
    "end|largest|least position|velocity [x|y|z], largest|least energy error, end error, time lost, steps";

impl Quantity {
    fn read(text: &str) -> Option<Self> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let pick = |word: &str| match word {
            "end" => Some(Pick::End),
            "largest" => Some(Pick::Largest),
            "least" => Some(Pick::Least),
            _ => None,
        };
        let index = |word: &str| ["x", "y", "z"].iter().position(|name| *name == word);
        match words[..] {
            ["end", "error"] => Some(Quantity::Error),
            ["time", "lost"] => Some(Quantity::TimeLost),
            ["steps"] => Some(Quantity::Steps),
            [which, "energy", "error"] => Some(Quantity::Energy(pick(which).filter(|pick| *pick != Pick::End)?)),
            [which, what @ ("position" | "velocity"), ref component @ ..] if component.len() < 2 => {
                let index = component.first().map_or(Some(0), |word| index(word))?;
                Some(Quantity::Component { pick: pick(which)?, is_velocity: what == "velocity", index })
            }
            _ => None,
        }
    }

    fn unit(self) -> &'static str {
        match self {
            Quantity::Component { is_velocity: true, .. } => "m/s",
            Quantity::Component { .. } | Quantity::Error => "m",
            Quantity::Energy(_) | Quantity::Steps => "1",
            Quantity::TimeLost => "s",
        }
    }
}

/// The table of this study.
///
/// # Errors
/// A line that cannot be read.
pub fn built_in() -> Result<Vec<Row>, Error> {
    rows(CSV, PLACE)
}

/// The printed numbers of a table with ours beside them.
///
/// # Errors
/// A line that cannot be read, or names what is unknown, with its place.
pub fn rows(csv: &str, place: &str) -> Result<Vec<Row>, Error> {
    let all: Vec<Published> = reports::read_csv(csv, place)?;
    all.iter()
        .enumerate()
        .map(|(i, one)| one.row().map_err(|error| Error::plan(format!("{place}:{}", i + 2), error.to_string())))
        .collect()
}

impl Published {
    fn row(&self) -> Result<Row, Error> {
        let mut scene = scenes::by_id(&self.scene)?;
        for setting in self.set.split_whitespace() {
            let (name, value) = setting
                .split_once('=')
                .ok_or_else(|| Error::plan("set", format!("'{setting}' is not of the form NAME=VALUE")))?;
            scene.scene_mut().set(&self.scene, name, value)?;
        }
        scene.scene().check()?;
        let settings = Loop::read(&self.settings.split_whitespace().collect::<Vec<_>>())?;
        let method = method_from_id(&self.method)?;
        settings.suits(method)?;
        settings.fits(self.step_s)?;
        let quantity = Quantity::read(&self.quantity).ok_or_else(|| {
            Error::plan("quantity", format!("'{}' is unknown; give one of: {QUANTITIES}", self.quantity))
        })?;
        let is_positive = |x: f64| x.is_finite() && x > 0.0;
        if !is_positive(self.step_s) || !is_positive(self.for_s) || self.for_s / self.step_s > MOST_FRAMES {
            return Err(Error::plan(
                "step_s, for_s",
                format!("give seconds above 0, and at most {MOST_FRAMES:e} frames"),
            ));
        }
        if !(1..=17).contains(&self.printed_digits) || !self.value.is_finite() {
            return Err(Error::plan(
                "value, printed_digits",
                "give a number and how many digits of it are printed, 1 to 17",
            ));
        }
        let runs = Case { one: self, scene: scene.as_ref(), settings: &settings, method, quantity };
        let found = match scene.any_motion() {
            AnyMotion::Few(flat) => runs.on(flat.motion(), flat.dimension)?,
            AnyMotion::Many(flat) => runs.on(flat.motion(), flat.dimension)?,
            AnyMotion::Pivoted(_) | AnyMotion::Flying(_) => {
                return Err(Error::plan("scene", format!("{} is a rigid body; a loop runs on particles", self.scene)));
            }
        };
        // Half a unit of the last printed digit; of a number on the border of two, a millionth of it more.
        let magnitude = if self.value == 0.0 { 0.0 } else { self.value.abs().log10().floor() };
        let tolerance = 0.500_000_5 * 10.0_f64.powf(magnitude + 1.0 - f64::from(self.printed_digits));
        Ok(Row {
            experiment: Experiment::Published,
            choice: self.id.clone(),
            settings: settings.to_string(),
            subject: self.source.clone(),
            method: method.id().to_owned(),
            h_s: self.step_s,
            frames: found.map_or(1, |(_, frames)| frames),
            quantity: format!("{}: {}", self.scene, self.quantity),
            unit: quantity.unit().to_owned(),
            value: found.map(|(value, _)| value),
            theory: Some(self.value),
            tolerance: Some(tolerance),
            theory_order: None,
            outcome: if found.is_some() { Outcome::Finished } else { Outcome::Diverged },
        })
    }
}

struct Case<'a> {
    one: &'a Published,
    scene: &'a dyn AnyScene,
    settings: &'a Loop,
    method: integrator::methods::MethodId,
    quantity: Quantity,
}

impl Case<'_> {
    /// The number and the frames it took; `None` for a run that diverged.
    fn on<const N: usize>(&self, motion: FlatMotion<'_, N>, dimension: usize) -> Result<Option<(f64, u64)>, Error> {
        if let Quantity::Component { index, .. } = self.quantity
            && index >= dimension
        {
            let message =
                format!("{} has {dimension} coordinates; '{}' is none of them", self.one.scene, self.one.quantity);
            return Err(Error::plan("quantity", message));
        }
        let (step_s, end_s) = (self.one.step_s, self.one.for_s);
        let frames = (end_s / self.settings.mean_s(step_s)).round().max(1.0) as u64;
        let until = match self.settings.clock {
            Clock::Exact => Until::Frames(frames),
            Clock::SumF64 | Clock::SumF32 => Until::Clock(end_s, 4 * frames),
        };
        let start = motion.exact(0.0);
        let energy = |t: f64, s: &State<SVector<f64, N>>| {
            let entries = self.scene.scene().invariants(fx128::lit(t), &motion.observe(s));
            let found = entries.iter().find(|entry| entry.invariant == Invariant::Energy)?;
            Some(found.value.first()?.to_f64())
        };
        let first = energy(0.0, &start);
        let of = |seen: &Seen<N>| match self.quantity {
            Quantity::Component { is_velocity, index, .. } => {
                if is_velocity {
                    seen.state.v[index]
                } else {
                    seen.state.q[index]
                }
            }
            Quantity::Energy(_) => {
                let now = energy(seen.drawn_s, &seen.state);
                now.zip(first).map_or(f64::NAN, |(now, first)| now / first - 1.0)
            }
            Quantity::Error => (seen.state.q - motion.exact(seen.wall_s).q).norm(),
            Quantity::TimeLost => seen.wall_s - seen.simulated_s,
            Quantity::Steps => seen.steps as f64,
        };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let job = Job { model: &motion, method: self.method, plan: self.settings, h_s: step_s, start };
        let end = job.run(until, |seen| {
            let value = of(seen);
            (low, high) = (low.min(value), high.max(value));
        });
        let pick = match self.quantity {
            Quantity::Component { pick, .. } | Quantity::Energy(pick) => pick,
            Quantity::Error | Quantity::TimeLost | Quantity::Steps => Pick::End,
        };
        Ok(end.ok().map(|seen| {
            let value = match pick {
                Pick::End => of(&seen),
                Pick::Largest => high,
                Pick::Least => low,
            };
            (value, seen.frame)
        }))
    }
}
