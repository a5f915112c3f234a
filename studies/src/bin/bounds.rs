//! The gate: committed error bounds against what is measured now.

use std::process::ExitCode;

use studies::bounds::program::{Flags, WORDS, run};
use studies::cli;

fn main() -> ExitCode {
    cli::start(WORDS, |flags: Flags| run(&flags))
}
