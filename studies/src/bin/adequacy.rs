//! Which terms a scene needs, and which model is enough.

use std::process::ExitCode;

use clap::Parser;
use studies::adequacy::Adequacy;
use studies::cli::{Common, finish};
use studies::produce::{study, verdicts};

/// Compares models of a scene, from the least to the full one, with the full exact motion.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  adequacy --scene heavy-top
  adequacy --scene pendulum --scene kepler --out /tmp/adequacy"
)]
struct Cli {
    #[command(flatten)]
    common: Common,
}

fn main() -> ExitCode {
    finish(study::<Adequacy>(&Cli::parse().common), verdicts)
}
