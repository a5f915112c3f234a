//! The whole report: every study, one page.

use std::process::ExitCode;

fn main() -> ExitCode {
    programs::cli::report()
}
