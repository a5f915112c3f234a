//! The flags that ask about stability.

use clap::Args;
use measure::stability::answer::{Answer, Question, answer};

use super::Ending;
use crate::options::Common;
use crate::produce::refuse_schemes;
use crate::units;
use measure::error::Error;
use measure::stability::Stability;

/// A step, or a rate, to judge: positive numbers, as the flags are read.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "What to ask")]
pub struct Flags {
    /// A step to judge: seconds, 5ms or 1/60
    #[arg(long = "step", value_name = "S", value_parser = seconds_per_step, allow_hyphen_values = true)]
    pub step_s: Option<f64>,
    /// Frames per second: how many substeps does each need?
    #[arg(long = "rate", value_name = "HZ", value_parser = frames_per_second, allow_hyphen_values = true)]
    pub rate_hz: Option<f64>,
    /// Steps that follow one another in turn, s: are they stable together?
    #[arg(long = "frames", value_name = "S,S,..", value_delimiter = ',', value_parser = seconds_per_step, allow_hyphen_values = true)]
    pub frames_s: Vec<f64>,
    /// The step after --step varies at random by this part, either way: do errors grow?
    #[arg(long, value_name = "PART", value_parser = part, requires = "step_s", allow_hyphen_values = true)]
    pub jitter: Option<f64>,
}

fn part(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|x: &f64| (0.0..1.0).contains(x));
    number.ok_or_else(|| "not a part from 0 to below 1; give a part of the step, such as 0.2".to_owned())
}

fn seconds_per_step(text: &str) -> Result<f64, String> {
    units::seconds(text)
}

pub(super) fn frames_per_second(text: &str) -> Result<f64, String> {
    positive(text, "frames per second, such as 60")
}

pub(super) fn positive(text: &str, such_as: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0);
    number.ok_or_else(|| format!("not a positive number; give {such_as}"))
}

/// The answer, where the flags ask for one: a step, a rate, or a scene with a method.
pub fn ask(common: &Common, flags: &Flags) -> Option<Result<Ending, Error>> {
    let (frames_s, jitter) = (flags.frames_s.clone(), flags.jitter);
    let question = Question { step_s: flags.step_s, rate_hz: flags.rate_hz, frames_s, jitter };
    let plan = &common.plan;
    let asked = question.step_s.is_some()
        || question.rate_hz.is_some()
        || !question.frames_s.is_empty()
        || !(plan.scene.is_empty() || plan.method.is_empty());
    asked.then(|| {
        common.answers()?;
        let selection = common.selection()?;
        refuse_schemes::<Stability>(&selection)?;
        let Answer { text, stable } = answer(&selection, &question);
        Ok(Ending { text, note: None, code: u8::from(!stable) })
    })
}
