//! The whole report: every study, one page.

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;
use studies::cli::{Common, finish};
use studies::produce::{REPORT, report, summary};

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
    let written = claims.is_ok() && !cli.common.quiet;
    let code = finish(claims, summary);
    if written {
        // Nobody is left to be told where standard error is closed too.
        let _ = writeln!(std::io::stderr(), "report: {}", cli.common.out(REPORT).join("index.html").display());
    }
    code
}
