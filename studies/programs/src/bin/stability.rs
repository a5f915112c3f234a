//! Where methods fail: the largest stable step, and what happens beyond it.

use std::process::ExitCode;

use measure::stability::Stability;
use programs::cli;
use programs::cli::stability::{Flags, ask};

fn main() -> ExitCode {
    cli::asking::<Stability, Flags>(ask)
}
