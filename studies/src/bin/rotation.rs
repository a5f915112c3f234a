//! What rigid bodies store, how they step, and what that does to the motion.

use std::process::ExitCode;

use studies::rotation::Rotation;

fn main() -> ExitCode {
    studies::cli::main::<Rotation>()
}
