//! The gate: committed error bounds against what is measured now.

use std::process::ExitCode;

use programs::cli;
use programs::cli::bounds::{Flags, WORDS, run};

fn main() -> ExitCode {
    cli::start(WORDS, |flags: Flags| run(&flags))
}
