//! The `audit` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    audit::cli::main(std::env::args_os())
}
