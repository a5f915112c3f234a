//! The shards of a run, put together.

use std::process::ExitCode;

use programs::cli;
use programs::cli::merge;

fn main() -> ExitCode {
    cli::start(merge::WORDS, |flags| merge::run(&flags))
}
