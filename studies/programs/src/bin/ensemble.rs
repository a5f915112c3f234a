//! The error over many starts of one law of motion.

use std::process::ExitCode;

use measure::ensemble::Ensemble;

fn main() -> ExitCode {
    programs::cli::with_tables::<Ensemble>()
}
