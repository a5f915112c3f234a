//! What accuracy costs: work-precision, and advice for a scene and an error.

use std::process::ExitCode;

use studies::cli;
use studies::tradeoff::Tradeoff;
use studies::tradeoff::advice::{Question, ask};

fn main() -> ExitCode {
    cli::asking::<Tradeoff, Question>(ask)
}
