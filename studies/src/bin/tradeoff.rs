//! What accuracy costs: work-precision, and advice for a scene and an error.

use std::process::ExitCode;

use clap::Parser;
use studies::cli::{Common, finish, print};
use studies::error::Error;
use studies::produce::{study, verdicts};
use studies::tradeoff::Tradeoff;
use studies::tradeoff::advice::{Question, advise};

/// Charges methods for their errors, in evaluations and in time. With --error or --budget-us it gives advice for a scene.
///
/// Errors are the largest over the run: of positions in m, of attitudes and angles in rad, the larger where a scene has both.
/// Advice is run before it is given, and writes no files.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  tradeoff                                                       the whole study, into target/tradeoff/
  tradeoff --scene pendulum --error 1e-3                         the cheapest method, precision and step
  tradeoff --scene pendulum --budget-us 5                        the least error for 5 us of computing a simulated second
  tradeoff --scene tennis-racket --error 1e-3 --for 60 --rate 60 every method in a loop of 60 frames a second, for a minute
  tradeoff --scene kepler --error 1e-3 --method semi-implicit-euler

Exit codes: 0 all claims hold, or the advice can be followed; 1 a claim is broken, or no method chosen can do it; 2 wrong input."
)]
struct Cli {
    #[command(flatten)]
    common: Common,

    /// Largest error that can be stood, in m or rad
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    error: Option<f64>,

    /// Microseconds of computing, on one core, for each simulated second
    #[arg(long, value_name = "US", allow_negative_numbers = true)]
    budget_us: Option<f64>,

    /// Length of the run, s [default: the scene's horizon]
    #[arg(long = "for", value_name = "S", allow_negative_numbers = true)]
    duration: Option<f64>,

    /// Frames a second: steps are whole parts of a frame
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    rate: Option<f64>,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let question = Question { error: cli.error, budget_us: cli.budget_us, duration_s: cli.duration, rate_hz: cli.rate };
    if question == Question::default() {
        return finish(study::<Tradeoff>(&cli.common), verdicts);
    }
    match ask(&cli.common, question) {
        Ok(possible) => ExitCode::from(u8::from(!possible)),
        Err(error) => finish(Err(error), verdicts),
    }
}

fn ask(common: &Common, question: Question) -> Result<bool, Error> {
    question.check(!common.scene.is_empty())?;
    let advice = advise(&common.selection()?, question)?;
    print(&advice.text)?;
    Ok(advice.possible)
}
