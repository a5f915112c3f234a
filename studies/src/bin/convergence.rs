//! The error against the step, and the order observed.

use std::process::ExitCode;

use clap::Parser;
use studies::cli::{Common, finish, print, run_study};
use studies::convergence::Convergence;

/// Sweeps the step on scenes with exact solutions and measures the order of convergence.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:\n  convergence --scene oscillator --method rk4\n  convergence --scene torque-free-spin --precision f64 --out /tmp/spin"
)]
struct Cli {
    #[command(flatten)]
    common: Common,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let claims = run_study::<Convergence>(&cli.common);
    if let Ok(claims) = &claims {
        for c in claims {
            print(&format!("{} {} | {} | {}\n", c.verdict, c.id, c.theory, c.measured));
        }
    }
    finish(claims)
}
