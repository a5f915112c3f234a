//! One command in front of all programs.

use std::process::ExitCode;

fn main() -> ExitCode {
    programs::cli::front::run()
}
