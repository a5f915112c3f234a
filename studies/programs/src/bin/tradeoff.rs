//! What accuracy costs: work-precision, and advice for a scene and an error.

use std::process::ExitCode;

use measure::tradeoff::Tradeoff;
use programs::cli;
use programs::cli::tradeoff::{Flags, ask};

fn main() -> ExitCode {
    cli::asking::<Tradeoff, Flags>(ask)
}
