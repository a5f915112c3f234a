//! The error against the step, and the order observed.

use std::process::ExitCode;

use clap::Parser;
use studies::cli::{Common, finish};
use studies::convergence::Convergence;
use studies::produce::{study, verdicts};

/// Sweeps the step on scenes with exact solutions and measures the order of convergence.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  convergence --scene oscillator --method rk4
  convergence --scene torque-free-spin --precision f64 --out /tmp/spin
  convergence --scene oscillator --set stiffness=24 --steps 64,128,256,512"
)]
struct Cli {
    #[command(flatten)]
    common: Common,
}

fn main() -> ExitCode {
    finish(study::<Convergence>(&Cli::parse().common), verdicts)
}
