//! What accuracy costs: work-precision, and advice for a scene and an error.

use std::process::ExitCode;

use studies::cli;
use studies::tradeoff::Tradeoff;
use studies::tradeoff::advice::{Flags, ask};

fn main() -> ExitCode {
    cli::asking::<Tradeoff, Flags>(ask)
}
