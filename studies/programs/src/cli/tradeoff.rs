//! The flags that ask for advice, or for an ensemble.

use clap::Args;
use measure::error::Error;
use measure::tradeoff::advice::{Question, advise_in};

use measure::tradeoff::quantity::Of;

use super::stability::{frames_per_second, positive};
use super::{Common, Ending, ensemble};

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
    /// Instead of one start, N starts drawn by each scene's rule: median, 95 % and worst error, into target/ensemble
    #[arg(long, value_name = "N", value_parser = starts, allow_hyphen_values = true,
        conflicts_with_all = ["error", "of", "budget_us", "for_s", "rate_hz"])]
    ensemble: Option<usize>,
    /// Seed of the starts that --ensemble draws
    #[arg(long, value_name = "S", default_value_t = 1, value_parser = seed, allow_hyphen_values = true, requires = "ensemble")]
    seed: u64,
}

fn error_size(text: &str) -> Result<f64, String> {
    positive(text, "an error in m or rad, such as 1e-3")
}

fn microseconds(text: &str) -> Result<f64, String> {
    positive(text, "microseconds per simulated second, such as 5")
}

fn starts(text: &str) -> Result<usize, String> {
    let number = text.trim().parse().ok().filter(|n| *n > 0);
    number.ok_or_else(|| "not a whole number greater than 0; give a number of starts, such as 1000".to_owned())
}

fn seed(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| format!("not a whole number from 0 to {}; give a seed, such as 1", u64::MAX))
}

fn quantity(text: &str) -> Result<Of, String> {
    let known = || Of::NAMED.map(Of::id).join(", ");
    Of::NAMED
        .into_iter()
        .find(|of| of.id() == text.trim())
        .ok_or_else(|| format!("not a quantity; choose from {}", known()))
}

/// The ensemble or the advice, where the flags ask for it.
pub fn ask(common: &Common, flags: &Flags) -> Option<Result<Ending, Error>> {
    let Flags { error, budget_us, rate_hz, .. } = *flags;
    let duration_s = common.plan.for_s.map(f64::from);
    let question = Question { error, of: flags.of.unwrap_or_default(), budget_us, duration_s, rate_hz };
    if let Some(count) = flags.ensemble {
        return Some(ensemble::run(common, count, flags.seed));
    }
    (Question { duration_s: None, ..question } != Question::default()).then(|| {
        question.check(!common.plan.scene.is_empty())?;
        common.answers()?;
        let (selection, is_chosen) = (common.selection()?, !common.plan.precision.is_empty());
        let advice = advise_in(&selection, question, is_chosen)?;
        Ok(Ending { text: advice.text, note: None, code: u8::from(!advice.possible) })
    })
}
