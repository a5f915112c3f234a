//! Which terms a scene needs, and which model is enough.

use std::process::ExitCode;

use studies::adequacy::Adequacy;

fn main() -> ExitCode {
    studies::cli::main::<Adequacy>()
}
