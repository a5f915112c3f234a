//! The flags that ask for advice.

use clap::Args;
use measure::error::Error;
use measure::tradeoff::advice::{Question, advise_in};

use measure::tradeoff::quantity::Of;

use super::Ending;
use super::stability::{frames_per_second, positive};
use crate::options::Common;
use crate::plan::RunLength;
use crate::units::{ErrorSize, error_size};

/// What can be asked besides the study.
#[derive(Args, Clone, Copy, Debug)]
#[command(next_help_heading = "What to ask")]
pub struct Flags {
    /// Largest acceptable error at any step: 1e-3 (m or rad, or the unit of --of), 1deg, 5mm, 1%
    #[arg(long, value_name = "X", value_parser = error_size, allow_hyphen_values = true)]
    error: Option<ErrorSize>,
    /// What the error is the error of: position, velocity, attitude, angular-velocity, energy, momentum or angular-momentum
    /// [default: what has the unit of --error; without a unit positions, attitudes and angles]
    #[arg(long, value_name = "QUANTITY", value_parser = quantity)]
    of: Option<Of>,
    /// Most microseconds of computing, on one core, for each simulated second
    #[arg(long, value_name = "US", value_parser = microseconds, allow_hyphen_values = true)]
    budget_us: Option<f64>,
    /// Frames per second: steps are whole parts of a frame
    #[arg(long = "rate", value_name = "HZ", value_parser = frames_per_second, allow_hyphen_values = true)]
    rate_hz: Option<f64>,
}

fn microseconds(text: &str) -> Result<f64, String> {
    positive(text, "microseconds per simulated second, such as 5")
}

fn quantity(text: &str) -> Result<Of, String> {
    let known = Of::NAMED.map(|of| of.id().to_owned());
    let named = Of::NAMED.into_iter().find(|of| of.id() == text.trim());
    named.ok_or_else(|| scenes::error::Error::unknown("quantity", text.trim(), known).to_string())
}

/// The size of the error, whether it is a part of the quantity's own size, and the quantity: the one that has the unit.
fn sized(error: Option<ErrorSize>, of: Option<Of>) -> Result<(Option<f64>, bool, Of), Error> {
    let Some(ErrorSize { value, base }) = error else { return Ok((None, false, of.unwrap_or_default())) };
    let is_relative = base == Some("%");
    let of = match (base, of) {
        (Some(base), None) if !is_relative => Of::NAMED.into_iter().find(|of| of.named_unit() == Some(base)),
        (Some(base), Some(of)) if !is_relative && of.named_unit() != Some(base) => {
            let message = format!(
                "its unit is of {base}, and --of {} is in {}; leave one of the two out",
                of.id(),
                of.named_unit().unwrap_or_default()
            );
            return Err(Error::plan("--error", message));
        }
        _ => of,
    };
    Ok((Some(value), is_relative, of.unwrap_or_default()))
}

/// The advice, where the flags ask for it.
pub fn ask(common: &Common, flags: &Flags) -> Option<Result<Ending, Error>> {
    let Flags { error, budget_us, rate_hz, of } = *flags;
    let asked = error.is_some() || budget_us.is_some() || rate_hz.is_some() || of.is_some();
    asked.then(|| {
        let length = common.plan.length.map(|RunLength(length)| length);
        let (error, is_relative, of) = sized(error, of)?;
        let question = Question { error, is_relative, of, budget_us, length, rate_hz };
        question.check(!common.plan.scene.is_empty())?;
        common.answers()?;
        let (selection, is_chosen) = (common.selection()?, !common.plan.precision.is_empty());
        let advice = advise_in(&selection, question, is_chosen)?;
        Ok(Ending { text: advice.text, note: None, code: u8::from(!advice.possible) })
    })
}
