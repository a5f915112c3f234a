//! The flags that ask for advice.

use clap::Args;
use measure::error::Error;
use measure::tradeoff::advice::{Question, advise_in};

use measure::tradeoff::quantity::Of;

use super::Ending;
use super::stability::{frames_per_second, positive};
use crate::options::Common;

/// What can be asked besides the study.
#[derive(Args, Clone, Copy, Debug)]
#[command(next_help_heading = "What to ask")]
pub struct Flags {
    /// Largest acceptable error at any step, m or rad, or the unit of --of
    #[arg(long, value_name = "X", value_parser = error_size, allow_hyphen_values = true)]
    error: Option<f64>,
    /// What the error is the error of [default: positions, attitudes and angles]
    #[arg(long, value_name = "QUANTITY", value_parser = quantity)]
    of: Option<Of>,
    /// Most microseconds of computing, on one core, for each simulated second
    #[arg(long, value_name = "US", value_parser = microseconds, allow_hyphen_values = true)]
    budget_us: Option<f64>,
    /// Frames per second: steps are whole parts of a frame
    #[arg(long = "rate", value_name = "HZ", value_parser = frames_per_second, allow_hyphen_values = true)]
    rate_hz: Option<f64>,
}

fn error_size(text: &str) -> Result<f64, String> {
    positive(text, "an error in m or rad, such as 1e-3")
}

fn microseconds(text: &str) -> Result<f64, String> {
    positive(text, "microseconds per simulated second, such as 5")
}

fn quantity(text: &str) -> Result<Of, String> {
    let known = || Of::NAMED.map(Of::id).join(", ");
    Of::NAMED
        .into_iter()
        .find(|of| of.id() == text.trim())
        .ok_or_else(|| format!("not a quantity; choose from {}", known()))
}

/// The advice, where the flags ask for it.
pub fn ask(common: &Common, flags: &Flags) -> Option<Result<Ending, Error>> {
    let Flags { error, budget_us, rate_hz, .. } = *flags;
    let duration_s = common.plan.for_s.map(f64::from);
    let question = Question { error, of: flags.of.unwrap_or_default(), budget_us, duration_s, rate_hz };
    (Question { duration_s: None, ..question } != Question::default()).then(|| {
        question.check(!common.plan.scene.is_empty())?;
        common.answers()?;
        let (selection, is_chosen) = (common.selection()?, !common.plan.precision.is_empty());
        let advice = advise_in(&selection, question, is_chosen)?;
        Ok(Ending { text: advice.text, note: None, code: u8::from(!advice.possible) })
    })
}
