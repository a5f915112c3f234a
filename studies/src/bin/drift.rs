//! What is lost over a long run, and the law of its growth.

use std::process::ExitCode;

use clap::Parser;
use studies::cli::{Common, finish};
use studies::drift::DriftStudy;
use studies::produce::{study, verdicts};

/// Follows energy, momenta and the quaternion norm over a long run and names the law of their growth.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  drift --scene oscillator --method rk4
  drift --scene torque-free-spin --precision f64 --out /tmp/spin
  drift --scene oscillator --set stiffness=24"
)]
struct Cli {
    #[command(flatten)]
    common: Common,
}

fn main() -> ExitCode {
    finish(study::<DriftStudy>(&Cli::parse().common), verdicts)
}
