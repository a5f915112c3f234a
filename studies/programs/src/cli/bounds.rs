//! The flags of the binary, and what they ask for.

use std::path::{Path, PathBuf};

use clap::{Args, ColorChoice, ValueEnum};

use super::{Ending, ProgramInfo};
use crate::options::{threads, use_threads};
use gate::known::{Known, without_settings};
use gate::{Bounds, Judged, Row, audit, baseline, check, deaths, format, read, row, update};
use measure::error::Error;

use measure::sweep::Progress;

/// What the binary says of itself.
pub const WORDS: ProgramInfo = ProgramInfo {
    name: "bounds",
    about: "Checks every committed error bound, and the bounds themselves",
    examples: "bounds                                             every committed bound
        bounds --quick                                     f64, the first preset of each scene: orders, errors at a step, evaluations
        bounds --format csv > now.csv                      every verdict, for a program
        bounds --junit target/bounds.xml                   the table, and JUnit's XML for a CI server
        bounds --update --reason \"RK4 sums its stages in another order\"
        bounds --baseline before.csv now.csv               two results of --format csv
        bounds --audit                                     margins, vacuous and too tight rows, what no row covers
        bounds --mutants                                   which row kills each built-in wrong method",
};

/// What to check, and how to tell it.
#[derive(Args, Clone, Debug)]
pub struct Flags {
    /// The file of bounds [default: the committed bounds; for --update studies/gate/data/bounds.csv]
    #[arg(long, value_name = "FILE")]
    bounds: Option<PathBuf>,

    /// Only rows of this scene, or scene/preset; may be given again
    #[arg(long, value_name = "ID")]
    scene: Vec<String>,

    /// Only rows of this method; may be given again
    #[arg(long, value_name = "ID")]
    method: Vec<String>,

    /// Only rows in f64 of the first preset of each scene, of kind order, error-at-step or evaluations-per-step
    #[arg(long)]
    quick: bool,

    /// How the verdicts are printed
    #[arg(long, value_enum, default_value = "table", conflicts_with_all = ["update", "baseline", "audit", "mutants"])]
    format: Format,

    /// Write the verdicts as JUnit's XML too
    #[arg(long, value_name = "FILE", conflicts_with_all = ["update", "baseline", "audit", "mutants"])]
    junit: Option<PathBuf>,

    /// Set the bounds of broken rows anew and add the rows that are missing; needs --reason
    #[arg(long, conflicts_with_all = ["quick", "scene", "method", "audit", "mutants"])]
    update: bool,

    /// Why bounds move, for --update
    #[arg(long, value_name = "TEXT", requires = "update")]
    reason: Option<String>,

    /// With --update: move broken rows whose bounds are theory's too
    #[arg(long, requires = "update")]
    theory: bool,

    /// Compare two results of --format csv
    #[arg(long, num_args = 2, value_names = ["OLD", "NEW"],
          conflicts_with_all = ["update", "audit", "mutants", "quick", "scene", "method", "bounds"])]
    baseline: Option<Vec<PathBuf>>,

    /// Look at the bounds themselves
    #[arg(long, conflicts_with_all = ["mutants", "quick", "scene", "method"])]
    audit: bool,

    /// Hold the built-in wrong methods to the rows that name them
    #[arg(long, conflicts_with_all = ["quick", "scene", "method"])]
    mutants: bool,

    /// Threads to run on [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads, allow_hyphen_values = true)]
    threads: Option<usize>,

    /// Colours; auto means on a terminal, and not where NO_COLOR is set
    #[arg(long, value_enum, value_name = "WHEN", default_value = "auto")]
    color: ColorChoice,

    /// No progress on stderr
    #[arg(long)]
    quiet: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum Format {
    /// The counts, the ten rows that are broken by most, and how many of each kind hold
    Table,
    /// Every row
    Csv,
    /// Every row
    Json,
}

/// The committed bounds, from the root of the workspace.
const COMMITTED: &str = "studies/gate/data/bounds.csv";

/// Does what the flags ask for.
///
/// # Errors
/// A file that is not one of bounds, or cannot be written; a name that is not known; rows that match no run.
pub fn run(cli: &Flags) -> Result<Ending, Error> {
    let ending = |text, good: bool| Ok(Ending { text, note: None, code: u8::from(!good) });
    use_threads(cli.threads)?;
    if let Some([old, new]) = cli.baseline.as_deref() {
        let comparison = baseline::compare(&baseline::read(old)?, &baseline::read(new)?);
        return ending(comparison.text(), !comparison.is_worse());
    }
    let progress = Progress::on_terminal("bounds", cli.quiet);
    if cli.update {
        let path = cli.bounds.as_deref().unwrap_or(Path::new(COMMITTED));
        let bounds = Bounds::read(path)?;
        let update = update::update(&bounds, cli.reason.as_deref(), cli.theory, &progress)?;
        reports::files::write_file(path, read::write(&update.rows)?)?;
        return ending(update.diff(), update.kept.is_empty());
    }
    let bounds = cli.bounds.as_ref().map_or_else(Bounds::committed, Bounds::read)?;
    if cli.audit {
        let audit = audit::audit(&bounds, &progress)?;
        return ending(audit.text(), audit.is_good());
    }
    let rows = chosen(cli, &bounds)?;
    if cli.mutants {
        let deaths = deaths::deaths(&bounds, &rows, &progress)?;
        return ending(deaths::summary(&deaths), !deaths.iter().any(deaths::Death::fails));
    }
    let judged = bounds.check(&rows, &progress)?;
    if let Some(path) = &cli.junit {
        reports::files::write_file(path, format::junit(&judged))?;
    }
    let text = match cli.format {
        Format::Table => check::report(&judged),
        Format::Csv => format::csv(&judged)?,
        Format::Json => format::json(&judged)?,
    };
    ending(text, !judged.iter().any(Judged::is_broken))
}

/// The rows that were asked for; a name of which there is none is wrong input.
fn chosen<'a>(cli: &Flags, bounds: &'a Bounds) -> Result<Vec<&'a Row>, Error> {
    cli.scene.iter().try_for_each(|id| scenes::by_id(id).map(drop))?;
    cli.method.iter().try_for_each(|id| bounds.known.is_method(id))?;
    let first = Known::first_presets();
    let wanted = |row: &&Row| {
        (cli.scene.is_empty() || cli.scene.iter().any(|id| id == without_settings(&row.scene).0))
            && (cli.method.is_empty() || cli.method.contains(&row.method))
            && (!cli.quick || row::is_quick(row, &first))
    };
    let rows: Vec<&Row> = bounds.rows.iter().filter(wanted).collect();
    if rows.is_empty() {
        let message = "no row of the file is chosen: a gate without rows holds nothing".to_owned();
        let place = cli.bounds.as_ref().map_or_else(|| "bounds".to_owned(), |path| path.display().to_string());
        return Err(Error::plan(place, message));
    }
    Ok(rows)
}
