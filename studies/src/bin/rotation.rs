//! What rigid bodies store, how they step, and what that does to the motion.

use std::process::ExitCode;

use clap::Parser;
use studies::cli::{Common, finish};
use studies::produce::{study, verdicts};
use studies::rotation::Rotation;

/// Compares every scheme in use for rigid bodies: error, order, drift, nutation, where the body ends up.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  rotation --scene torque-free-spin --scene heavy-top
  rotation --method semi-implicit-euler --out /tmp/rotation"
)]
struct Cli {
    #[command(flatten)]
    common: Common,
}

fn main() -> ExitCode {
    finish(study::<Rotation>(&Cli::parse().common), verdicts)
}
