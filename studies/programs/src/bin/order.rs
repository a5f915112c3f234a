//! The order in a table that another program computed.

use std::process::ExitCode;

use programs::cli;
use programs::cli::order::{Flags, WORDS, run};

fn main() -> ExitCode {
    cli::start(WORDS, |flags: Flags| run(&flags))
}
