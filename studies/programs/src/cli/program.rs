//! A binary from its study: flags in, files and verdicts out, an exit code.

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{Args, Command, CommandFactory, FromArgMatches, Parser, Subcommand};
use clap_complete::Shell;
use reports::{Block, Claim};

use super::messages::{complain, note, of_flags, print};
use super::{color, front, list};
use crate::options::Common;
use crate::parts;
use crate::produce;
use crate::produce::{Judged, REPORT, study};
use crate::provenance::Manifest;
use crate::shards::is_whole;
use measure::error::Error;

use crate::summary;
use measure::study::Study;

/// What a binary says of itself.
#[derive(Clone, Copy, Debug)]
pub struct ProgramInfo {
    /// Its name.
    pub name: &'static str,
    /// What it does, in a line or two.
    pub about: &'static str,
    /// Command lines worth trying, one a line.
    pub examples: &'static str,
}

impl ProgramInfo {
    fn of<S: Study>() -> Self {
        ProgramInfo { name: S::ID, about: S::ABOUT, examples: S::EXAMPLES }
    }
}

/// How a program ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Ending {
    /// For standard output.
    pub text: String,
    /// For standard error, where notes are welcome.
    pub note: Option<String>,
    /// 0 if all is well, 1 if a claim is broken or the answer is no.
    pub code: u8,
}

impl Ending {
    /// The claims as they were asked for: Markdown, JSON, or as `plain` tells them.
    ///
    /// # Errors
    /// None that is known: claims have a form in JSON.
    pub fn of(common: &Common, judged: &Judged, plain: impl Fn(&[Claim]) -> String) -> Result<Self, Error> {
        let text = if common.json {
            summary::json(judged)?
        } else if common.markdown {
            summary::markdown(judged)
        } else {
            color::painted(&plain(&judged.claims))
        };
        Ok(Ending { text, note: None, code: judged.code() })
    }
}

/// No flags but the common ones.
#[derive(Args, Clone, Copy, Debug)]
pub struct NoFlags {}

#[derive(Parser)]
#[command(version, args_conflicts_with_subcommands = true, disable_help_subcommand = true)]
struct Cli<F: Args> {
    #[command(flatten)]
    flags: F,
    #[command(subcommand)]
    aside: Option<Aside>,
}

/// The flags of a binary that runs studies.
#[derive(Args)]
struct Flags<F: Args> {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    own: F,
}

/// What can be asked besides a run.
#[derive(Subcommand)]
enum Aside {
    /// Scenes, methods and precisions, one line each; or the parameters of the scenes named
    List {
        /// Scene, or scene/preset
        #[arg(value_name = "SCENE")]
        scenes: Vec<String>,
    },
    /// The script by which a shell completes flags and names
    Completions {
        /// The shell
        shell: Shell,
    },
    /// The manual page, in the form that `man` reads
    Man,
}

/// A binary that runs one study.
pub fn main<S: Study>() -> ExitCode {
    of_studies(ProgramInfo::of::<S>(), |common, _: &NoFlags| run::<S>(common))
}

/// A binary that runs one study, or answers a question put by its own flags: where `ask` gives `None`, it is the study.
pub fn asking<S: Study, F: Args>(ask: impl Fn(&Common, &F) -> Option<Result<Ending, Error>>) -> ExitCode {
    of_studies(ProgramInfo::of::<S>(), |common, own: &F| ask(common, own).unwrap_or_else(|| run::<S>(common)))
}

/// The binary of the whole report.
pub fn report() -> ExitCode {
    let words = ProgramInfo {
        name: REPORT,
        about: "Runs every study, prints the verdicts and writes the report: CSV, charts and one page, index.html",
        examples: "report                                     everything, into target/report/
            report --quick --scene oscillator          one scene, fewer runs
            report --plan target/report/plan.toml --out /tmp/again
            report --from target/report --format png --figures-only --out /tmp/charts
            report --quick --markdown > comment.md
            report list heavy-top",
    };
    of_studies(words, |common, _: &NoFlags| {
        if let Some(ending) = beside(common, REPORT) {
            return ending;
        }
        let ending = Ending::of(common, &produce::report(common)?, summary::summary)?;
        let (out, page) = (common.out(REPORT), "index.html");
        let written = if common.figures_only { out } else { out.join(page) };
        Ok(Ending { note: Some(format!("report: {}", written.display())), ..ending })
    })
}

fn run<S: Study>(common: &Common) -> Result<Ending, Error> {
    parts::heeds::<S>(common)?;
    if let Some(ending) = beside(common, S::ID) {
        return ending;
    }
    Ending::of(common, &study::<S>(common)?.0, summary::verdicts)
}

/// What is done in the place of a whole run: nothing, because it is there; a part of it; a forecast.
fn beside(common: &Common, program: &str) -> Option<Result<Ending, Error>> {
    let said = |text| Ending { text, note: None, code: 0 };
    let out = common.out(program);
    if common.dry_run {
        return Some(parts::forecast(common, program).map(said));
    }
    if common.resume && is_whole(&out, &Manifest::of(&common.plan), common.shard, program) {
        let note = format!("{program}: {} holds it whole already; nothing was run", out.display());
        return Some(Ok(Ending { note: Some(note), ..said(String::new()) }));
    }
    Some(parts::shard(common, program, common.shard?).map(said))
}

/// A binary that runs one study and prints its tables before its claims.
pub fn with_tables<S: Study>() -> ExitCode {
    of_studies(ProgramInfo::of::<S>(), |common, _: &NoFlags| {
        parts::heeds::<S>(common)?;
        if let Some(ending) = beside(common, S::ID) {
            return ending;
        }
        let (judged, section) = study::<S>(common)?;
        Ending::of(common, &judged, |claims| {
            let tables: String = section.blocks.iter().flat_map(tables).collect();
            format!("{tables}{}", summary::verdicts(claims))
        })
    })
}

/// The tables of a block, also of those within a group, as text.
fn tables(block: &Block) -> Vec<String> {
    match block {
        Block::Table { caption, table, .. } => vec![format!("{caption}\n\n{}\n", table.to_text())],
        Block::Group { blocks, .. } => blocks.iter().flat_map(tables).collect(),
        _ => Vec::new(),
    }
}

fn of_studies<F: Args>(words: ProgramInfo, run: impl Fn(&Common, &F) -> Result<Ending, Error>) -> ExitCode {
    start(words, |Flags { common, own }: Flags<F>| {
        let common = common.with_plan_file()?;
        let ending = run(&common, &own)?;
        Ok(Ending { note: ending.note.filter(|_| !common.quiet), ..ending })
    })
}

/// Reads the flags, does what they ask for and ends: 0 all is well, 1 a claim is broken, 2 the input or the output was wrong,
/// 130 interrupted.
pub fn start<F: Args>(words: ProgramInfo, run: impl Fn(F) -> Result<Ending, Error>) -> ExitCode {
    let arguments: Vec<String> = front::arguments().iter().map(|a| a.to_string_lossy().into_owned()).collect();
    color::choose(&arguments);
    // Ctrl-C, SIGTERM and SIGHUP let files that are being put in their places arrive. Without a handler they would still end the
    // program.
    let _ = ctrlc::set_handler(|| reports::files::when_written(|| std::process::exit(130)));
    let ended = perform(&words, run).and_then(|ending| {
        print(&ending.text)?;
        ending.note.as_deref().map(note);
        Ok(ending.code)
    });
    ended.map_or_else(
        |error| {
            complain(&error);
            ExitCode::from(2)
        },
        ExitCode::from,
    )
}

fn perform<F: Args>(words: &ProgramInfo, run: impl Fn(F) -> Result<Ending, Error>) -> Result<Ending, Error> {
    let said = |text| Ok(Ending { text, note: None, code: 0 });
    let parsed = command::<F>(words)
        .try_get_matches_from(front::arguments())
        .and_then(|matches| Cli::<F>::from_arg_matches(&matches));
    match parsed {
        Err(error) if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => {
            said(error.render().ansi().to_string())
        }
        Err(error) => Err(of_flags(&error)),
        Ok(Cli { aside: Some(Aside::List { scenes }), .. }) => said(list::of(&scenes)?),
        Ok(Cli { aside: Some(Aside::Completions { shell }), .. }) => {
            said(completions(named::<F>(words), words.name, shell))
        }
        Ok(Cli { aside: Some(Aside::Man), .. }) => said(manual(named::<F>(words))?),
        Ok(Cli { flags, .. }) => run(flags),
    }
}

const CODES: &str = "Exit codes: 0 all claims hold, 1 a claim is broken or, with the default plan, not tested (the files are written all the same), or an answer is no, \
    2 wrong input, 130 interrupted.";

fn command<F: Args>(words: &ProgramInfo) -> Command {
    let examples = words.examples.lines().map(|line| format!("\n  {}", line.trim())).collect::<String>();
    Cli::<F>::command()
        .name(words.name)
        .bin_name(words.name)
        .about(words.about)
        .long_about(None)
        .after_help(format!("Examples:{examples}\n\n{CODES}"))
}

/// The command with the names that its flags take, for a shell to complete.
fn named<F: Args>(words: &ProgramInfo) -> Command {
    use clap::builder::PossibleValuesParser as Names;
    let methods = integrator::methods::MethodId::ALL.iter().map(|m| m.id());
    let precisions = scenes::run::Precision::ALL.iter().map(|p| p.id());
    let list =
        [("scene", Names::new(scenes::IDS)), ("method", Names::new(methods)), ("precision", Names::new(precisions))];
    list.into_iter().fold(command::<F>(words), |command, (flag, names)| {
        if !command.get_arguments().any(|arg| arg.get_id() == flag) {
            return command;
        }
        command.mut_arg(flag, |arg| arg.value_parser(names).hide_possible_values(true))
    })
}

fn completions(mut command: Command, name: &str, shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, name, &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

fn manual(command: Command) -> Result<String, Error> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page).map_err(|error| Error::plan("manual page", error.to_string()))?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}
