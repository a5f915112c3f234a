//! What rigid bodies store, how they step, and what that does to the motion.

use std::process::ExitCode;

use measure::rotation::Rotation;

fn main() -> ExitCode {
    programs::cli::main::<Rotation>()
}
