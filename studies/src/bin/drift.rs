//! What is lost over a long run, and the law of its growth.

use std::process::ExitCode;

use studies::drift::DriftStudy;

fn main() -> ExitCode {
    studies::cli::main::<DriftStudy>()
}
