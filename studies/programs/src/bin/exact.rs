//! The exact motion of a scene.

use std::process::ExitCode;

use programs::cli;
use programs::cli::exact::{Flags, WORDS, run};

fn main() -> ExitCode {
    cli::start(WORDS, |flags: Flags| run(&flags))
}
