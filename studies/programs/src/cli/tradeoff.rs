//! The flags that ask for advice, or for an ensemble.

use clap::Args;
use measure::error::Error;
use measure::tradeoff::advice::{Question, advise_in};

use super::{Common, Ending, ensemble};

/// What can be asked besides the study.
#[derive(Args, Clone, Copy, Debug)]
#[command(next_help_heading = "What to ask")]
pub struct Flags {
    /// Largest error that can be stood, m or rad
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    error: Option<f64>,
    /// Microseconds of computing, on one core, for each simulated second
    #[arg(long, value_name = "US", allow_negative_numbers = true)]
    budget_us: Option<f64>,
    /// Length of the run, s [default: the scene's horizon]
    #[arg(long = "for", value_name = "S", allow_negative_numbers = true)]
    duration_s: Option<f64>,
    /// Frames a second: steps are whole parts of a frame
    #[arg(long = "rate", value_name = "HZ", allow_negative_numbers = true)]
    rate_hz: Option<f64>,
    /// Instead of one start, N starts drawn by each scene's rule: median, 95 % and worst error, into target/ensemble
    #[arg(long, value_name = "N", conflicts_with_all = ["error", "budget_us", "duration_s", "rate_hz"])]
    ensemble: Option<usize>,
    /// Seed of the starts that --ensemble draws
    #[arg(long, value_name = "S", default_value_t = 1, requires = "ensemble")]
    seed: u64,
}

/// The ensemble or the advice, where the flags ask for it.
pub fn ask(common: &Common, flags: &Flags) -> Option<Result<Ending, Error>> {
    let Flags { error, budget_us, duration_s, rate_hz, .. } = *flags;
    let question = Question { error, budget_us, duration_s, rate_hz };
    if let Some(count) = flags.ensemble {
        return Some(ensemble::run(common, count, flags.seed));
    }
    (question != Question::default()).then(|| {
        question.check(!common.plan.scene.is_empty())?;
        common.answers()?;
        let (selection, is_chosen) = (common.selection()?, !common.plan.precision.is_empty());
        let advice = advise_in(&selection, question, is_chosen)?;
        Ok(Ending { text: advice.text, note: None, code: u8::from(!advice.possible) })
    })
}
