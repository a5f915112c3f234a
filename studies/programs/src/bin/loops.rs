//! What the loop around a step does to its order, its energy and its stability.

use std::process::ExitCode;

use measure::loops::Loops;
use programs::cli;
use programs::cli::loops::{Flags, ask};

fn main() -> ExitCode {
    cli::asking::<Loops, Flags>(ask)
}
