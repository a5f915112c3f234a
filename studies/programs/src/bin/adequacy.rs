//! Which terms a scene needs, and which model is enough.

use std::process::ExitCode;

use measure::adequacy::Adequacy;

fn main() -> ExitCode {
    programs::cli::main::<Adequacy>()
}
