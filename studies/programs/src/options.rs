//! The flags that every program shares.

use std::path::PathBuf;
use std::sync::OnceLock;

use clap::{Args, ColorChoice, ValueEnum};

use crate::plan::Plan;
use measure::error::Error;
use measure::study::Selection;
use measure::sweep::Progress;

/// What to run, where to write it, and what to print.
#[derive(Args, Clone, Debug, Default)]
pub struct Common {
    /// What to run.
    #[command(flatten)]
    pub plan: Plan,

    /// Run the plan in this TOML file (each report has its plan.toml); flags given too take its place
    #[arg(long = "plan", value_name = "FILE", help_heading = "What to run")]
    pub plan_file: Option<PathBuf>,

    /// Run nothing: draw, judge and write anew from the CSV rows in DIR, into DIR unless --out is given
    #[arg(long, value_name = "DIR", help_heading = "What to run",
        conflicts_with_all = ["scene", "method", "precision", "set", "steps", "length", "looped", "quick", "plan_file"])]
    pub from: Option<PathBuf>,

    /// Do the part K of N of the work and write its rows; `merge` puts the parts together
    #[arg(long, value_name = "K/N", help_heading = "What to run", value_parser = shard,
        conflicts_with_all = ["from", "figures_only", "markdown", "json"])]
    pub shard: Option<(usize, usize)>,

    /// Do nothing where the directory already holds this run whole
    #[arg(long, help_heading = "What to run", conflicts_with_all = ["from", "figures_only"])]
    pub resume: bool,

    /// Run nothing: tell how much work it is, how long it takes here, and a number of shards
    #[arg(long, help_heading = "What to run", conflicts_with_all = ["from", "shard", "resume", "figures_only", "markdown", "json"])]
    pub dry_run: bool,

    /// Directory for the results [default: target/report for the report, target/NAME for the study NAME]
    #[arg(long, value_name = "DIR", help_heading = "What to write")]
    pub out: Option<PathBuf>,

    /// Form of the charts; PNG needs a program built with `--features png`
    #[arg(long, value_enum, default_value = "svg", help_heading = "What to write")]
    pub format: Format,

    /// Write the charts and nothing else
    #[arg(long, help_heading = "What to write")]
    pub figures_only: bool,

    /// Print Markdown: verdicts, broken claims, provenance; for a pull request's comment
    #[arg(long, help_heading = "What to print", conflicts_with = "json")]
    pub markdown: bool,

    /// Print JSON: provenance, plan, counts, claims; for machines
    #[arg(long, help_heading = "What to print")]
    pub json: bool,

    /// Colours; auto means on a terminal, and not where NO_COLOR is set
    #[arg(long, value_enum, value_name = "WHEN", default_value = "auto", help_heading = "What to print")]
    pub color: ColorChoice,

    /// No progress and no notes on stderr
    #[arg(long, help_heading = "What to print")]
    pub quiet: bool,

    /// Threads to run on; the results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads, allow_hyphen_values = true)]
    pub threads: Option<usize>,
}

/// The form of a chart's file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Vector drawings, in which text is text.
    #[default]
    Svg,
    /// Pixels, two for each of the SVG.
    Png,
    /// Each chart in both forms.
    Both,
}

impl Format {
    /// The ending of the file that a page links to.
    pub(crate) fn ending(self) -> &'static str {
        if self == Format::Png { "png" } else { "svg" }
    }
}

/// More parts than any plan has work for.
const MOST_SHARDS: usize = 65_536;

fn shard(text: &str) -> Result<(usize, usize), String> {
    let remedy = format!("give K/N with 1 <= K <= N <= {MOST_SHARDS}, such as 1/8");
    let numbers = text.split_once('/').and_then(|(k, n)| Some((k.trim().parse().ok()?, n.trim().parse().ok()?)));
    let allowed = |(k, n): &(usize, usize)| (1..=*n).contains(k) && *n <= MOST_SHARDS;
    numbers.filter(allowed).ok_or_else(|| format!("not a part of the work; {remedy}"))
}

/// More threads than any machine has cores.
const MOST_THREADS: usize = 1024;

pub(crate) fn threads(text: &str) -> Result<usize, String> {
    let remedy = format!("give at least 1 and at most {MOST_THREADS}, or leave the flag out for all cores");
    let number = text.trim().parse().ok().filter(|n| (1..=MOST_THREADS).contains(n));
    number.ok_or_else(|| format!("not a number of threads; {remedy}"))
}

/// Starts the threads that everything runs on: as many as given, else one a core.
///
/// # Errors
/// The system refuses to start them.
pub fn use_threads(threads: Option<usize>) -> Result<(), Error> {
    static STARTED: OnceLock<Result<(), String>> = OnceLock::new();
    let start = || {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
        pool.build_global().map_err(|error| error.to_string())
    };
    STARTED.get_or_init(start).clone().map_err(|message| {
        let remedy = "give fewer threads, or raise the limits of processes and memory (ulimit -u, ulimit -v)";
        Error::plan("--threads", format!("the system starts no more threads: {message}; {remedy}"))
    })
}

impl Common {
    /// The directory for the results of the study (or the report) of that name.
    pub fn out(&self, name: &str) -> PathBuf {
        let default = || self.from.clone().unwrap_or_else(|| PathBuf::from("target").join(name));
        self.out.clone().unwrap_or_else(default)
    }

    /// The scenes, methods and precisions that were asked for; and threads as many as asked for.
    ///
    /// # Errors
    /// An unknown name, a parameter outside its range, or a number of steps that is zero.
    pub fn selection(&self) -> Result<Selection, Error> {
        use_threads(self.threads)?;
        Ok(Selection { progress: Progress::on_terminal("", self.quiet), ..self.plan.selection()? })
    }

    /// Refuses what a question beside it leaves no room for: an answer is a text, and runs what it needs.
    ///
    /// # Errors
    /// The first flag that would go unheard.
    pub fn answers(&self) -> Result<(), Error> {
        let (form, files, runs) =
            ("an answer has no such form", "an answer writes no files", "an answer runs what it needs");
        let given = [
            ("--json", self.json, form),
            ("--markdown", self.markdown, form),
            ("--out", self.out.is_some(), files),
            ("--figures-only", self.figures_only, files),
            ("--format", self.format != Format::default(), files),
            ("--steps", !self.plan.steps.is_empty(), runs),
            ("--from", self.from.is_some(), runs),
            ("--shard", self.shard.is_some(), runs),
            ("--resume", self.resume, files),
            ("--dry-run", self.dry_run, runs),
        ];
        let unheard = given.into_iter().find(|(_, is_given, _)| *is_given);
        unheard.map_or(Ok(()), |(flag, _, why)| Err(Error::plan(flag, format!("{why}; leave it out"))))
    }

    /// The same with the plan of the file, where one is named.
    pub(crate) fn with_plan_file(mut self) -> Result<Self, Error> {
        if let Some(path) = &self.plan_file {
            self.plan = Plan::read(path)?.overridden_by(self.plan);
        }
        Ok(self)
    }
}
