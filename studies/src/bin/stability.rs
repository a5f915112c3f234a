//! Where methods fail: the largest stable step, and what happens beyond it.

use std::process::ExitCode;

use studies::cli;
use studies::stability::Stability;
use studies::stability::answer::{Question, ask};

fn main() -> ExitCode {
    cli::asking::<Stability, Question>(ask)
}
