//! The error against the step, and the order observed.

use std::process::ExitCode;

use studies::convergence::Convergence;

fn main() -> ExitCode {
    studies::cli::main::<Convergence>()
}
