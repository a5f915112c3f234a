//! What is lost over a long run, and the law of its growth.

use std::process::ExitCode;

use measure::drift::DriftStudy;

fn main() -> ExitCode {
    programs::cli::main::<DriftStudy>()
}
