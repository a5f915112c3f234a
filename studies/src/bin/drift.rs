//! What is lost over a long run, and the law of its growth.

use std::process::ExitCode;

use clap::Parser;
use studies::cli::{Common, finish, print, run_study};
use studies::drift::DriftStudy;

/// Follows energy, momenta and the quaternion norm over a long run and names the law of their growth.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:\n  drift --scene oscillator --method rk4\n  drift --scene torque-free-spin --precision f64 --out /tmp/spin"
)]
struct Cli {
    #[command(flatten)]
    common: Common,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let claims = run_study::<DriftStudy>(&cli.common);
    if let Ok(claims) = &claims {
        for c in claims {
            print(&format!("{} {} | {} | {}\n", c.verdict, c.id, c.theory, c.measured));
        }
    }
    finish(claims)
}
