//! The error against the step, and the order observed.

use std::process::ExitCode;

use measure::convergence::Convergence;

fn main() -> ExitCode {
    programs::cli::main::<Convergence>()
}
