//! The whole report: every study, one page.

use std::process::ExitCode;

use clap::Parser;
use studies::cli::{Common, finish};
use studies::produce::{report, summary};

/// Runs every study, prints the verdicts and writes the report: CSV, SVG and one page, index.html.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  report                                    everything, into target/report/
  report --quick --scene oscillator         one scene, fewer runs
  report --method explicit-euler --method rk4 --out /tmp/two-methods

Exit codes: 0 all claims hold, 1 a claim is broken (the report is written all the same), 2 wrong input."
)]
struct Cli {
    #[command(flatten)]
    common: Common,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let claims = report(&cli.common);
    if claims.is_ok() && !cli.common.quiet {
        eprintln!("report: {}", cli.common.out.join("index.html").display());
    }
    finish(claims, summary)
}
