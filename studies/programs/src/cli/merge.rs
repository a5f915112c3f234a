//! `merge`: the parts of a run, put together.

use std::path::PathBuf;

use clap::Args;
use measure::error::Error;

use super::{Ending, ProgramInfo};
use crate::options::{Common, Format};
use crate::plan::Plan;
use crate::produce;
use crate::shards::Shards;
use crate::summary;

/// What the program says of itself.
pub const WORDS: ProgramInfo = ProgramInfo {
    name: "merge",
    about: "Puts the shards of a run together: the same files as one run writes, times excepted",
    examples: "report --shard 1/2 --out part1
        report --shard 2/2 --out part2
        merge part1 part2 --out target/report",
};

/// The flags.
#[derive(Args, Clone, Debug)]
pub struct Flags {
    /// The directories of all shards, in any order
    #[arg(value_name = "DIR", required = true)]
    directories: Vec<PathBuf>,
    /// Directory for the results [default: target/report for the report, target/NAME for the study NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Form of the charts; PNG needs a program built with `--features png`
    #[arg(long, value_enum, default_value = "svg")]
    format: Format,
    /// Print Markdown: verdicts, broken claims, provenance
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Print JSON: provenance, plan, counts, claims
    #[arg(long)]
    json: bool,
    /// Colours; auto means on a terminal, and not where NO_COLOR is set
    #[arg(long, value_enum, value_name = "WHEN", default_value = "auto")]
    color: clap::ColorChoice,
    /// No notes on stderr
    #[arg(long)]
    quiet: bool,
}

/// Puts the shards together.
///
/// # Errors
/// Directories that do not hold all parts of one run, or an output that cannot be written.
pub fn run(flags: &Flags) -> Result<Ending, Error> {
    let shards = Shards::read(&flags.directories)?;
    let program = shards.program().to_owned();
    let plan: Plan = shards.manifest().plan;
    let common = Common {
        plan,
        out: flags.out.clone(),
        format: flags.format,
        markdown: flags.markdown,
        json: flags.json,
        color: flags.color,
        quiet: flags.quiet,
        ..Common::default()
    };
    if flags.directories.contains(&common.out(&program)) {
        let message = "is the directory of a shard, which would be replaced; give another";
        return Err(Error::plan("--out", message));
    }
    let judged = produce::merged(&common, shards)?;
    let plain = if program == produce::REPORT { summary::summary } else { summary::verdicts };
    let note = format!("{program}: {}", common.out(&program).display());
    Ok(Ending { note: Some(note).filter(|_| !flags.quiet), ..Ending::of(&common, &judged, plain)? })
}
