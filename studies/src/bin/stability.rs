//! Where methods fail: the largest stable step, and what happens beyond it.

use std::process::ExitCode;

use clap::Parser;
use studies::cli::{Common, finish, print};
use studies::error::Error;
use studies::produce::{study, verdicts};
use studies::stability::Stability;
use studies::stability::answer::{Question, answer};

/// Measures the largest stable step of methods on scenes and holds it against theory.
///
/// With --step or --rate, or with both --scene and --method, it answers for these and writes no files.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  stability                                                      the whole study, into target/stability/
  stability --scene damped-oscillator --method semi-implicit-euler --set zeta=0.1
  stability --scene oscillator --method velocity-verlet --step 0.01 --rate 60

Exit codes: 0 all claims hold and every step asked about is stable, 1 not so, 2 wrong input."
)]
struct Cli {
    #[command(flatten)]
    common: Common,

    /// A step to be judged, s
    #[arg(long, value_name = "S")]
    step: Option<f64>,

    /// Frames a second: how many substeps does each need?
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let asked =
        cli.step.is_some() || cli.rate.is_some() || !(cli.common.scene.is_empty() || cli.common.method.is_empty());
    if !asked {
        return finish(study::<Stability>(&cli.common), verdicts);
    }
    match ask(&cli) {
        Ok(stable) => ExitCode::from(u8::from(!stable)),
        Err(error) => finish(Err(error), verdicts),
    }
}

fn ask(cli: &Cli) -> Result<bool, Error> {
    let selection = cli.common.selection()?;
    let answer = answer(&selection, Question { step_s: cli.step, rate_hz: cli.rate })?;
    print(&answer.text)?;
    Ok(answer.stable)
}
