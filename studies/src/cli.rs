//! The flags that all binaries share, and how they end.

use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use integrator::methods::MethodId;
use reports::{Claim, exit_code};

use crate::error::Error;
use crate::run::{Precision, method_from_id};
use crate::scenes;
use crate::study::{Selection, distinct};
use crate::sweep::Progress;

/// What to run, and where to write it.
#[derive(Args, Clone, Debug)]
pub struct Common {
    /// Scene, or scene/preset, to look at; may be given again [default: all]
    #[arg(long, value_name = "ID")]
    pub scene: Vec<String>,

    /// Method to look at; may be given again [default: all]
    #[arg(long, value_name = "ID")]
    pub method: Vec<String>,

    /// Arithmetic: f32, f64 or double-double; may be given again [default: all]
    #[arg(long, value_name = "ID")]
    pub precision: Vec<String>,

    /// Set a parameter of every chosen scene that has it; may be given again
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,

    /// Numbers of steps of a sweep, at least 1 each [default: 12 halvings from the scene's coarsest]
    #[arg(long, value_name = "N,N,..", value_delimiter = ',')]
    pub steps: Vec<u64>,

    /// One preset of each scene, fewer halvings and shorter runs
    #[arg(long)]
    pub quick: bool,

    /// Directory for the results [default: target/report for the report, target/NAME for the study NAME]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Threads to run on [default: all cores]
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,

    /// No progress and no notes on stderr
    #[arg(long)]
    pub quiet: bool,
}

/// More threads than any machine has cores.
const MOST_THREADS: usize = 1024;

impl Common {
    /// The directory for the results of the study (or the report) of that name.
    pub fn out(&self, name: &str) -> PathBuf {
        self.out.clone().unwrap_or_else(|| PathBuf::from("target").join(name))
    }

    /// The scenes, methods and precisions that were asked for.
    ///
    /// # Errors
    /// An unknown name, a parameter outside its range, or a number of steps or threads that is zero.
    pub fn selection(&self) -> Result<Selection, Error> {
        if self.steps.contains(&0) {
            return Err(plan("--steps", "a run has at least 1 step; give numbers such as 64,128,256"));
        }
        use_threads(self.threads)?;
        let mut chosen = if self.scene.is_empty() {
            let mut all = scenes::catalogue();
            if self.quick {
                // One preset of each scene.
                all.dedup_by_key(|scene| scene.id().split('/').next());
            }
            all
        } else {
            distinct(&self.scene).into_iter().map(|id| scenes::by_id(id)).collect::<Result<_, _>>()?
        };
        self.apply_settings(&mut chosen)?;
        let label = (!self.quiet && std::io::stderr().is_terminal()).then(String::new);
        Ok(Selection {
            scenes: chosen,
            methods: named(&self.method, method_from_id, MethodId::ALL)?,
            precisions: named(&self.precision, Precision::from_id, &Precision::ALL)?,
            steps: distinct(self.steps.iter().copied()),
            quick: self.quick,
            progress: Progress { label },
        })
    }

    fn apply_settings(&self, chosen: &mut [Box<dyn crate::scene::AnyScene>]) -> Result<(), Error> {
        for setting in &self.set {
            let (name, value) = setting
                .split_once('=')
                .ok_or_else(|| plan("--set", &format!("'{setting}' is not of the form NAME=VALUE")))?;
            let mut refusal = None;
            let mut taken = false;
            for scene in chosen.iter_mut() {
                let id = scene.id();
                match scene.scene_mut().set(id, name, value) {
                    Ok(()) => taken = true,
                    // Another scene may have the parameter; a wrong value is wrong at once.
                    Err(error @ Error::UnknownName { .. }) => refusal = Some(error),
                    Err(error) => return Err(error),
                }
            }
            if let (false, Some(error)) = (taken, refusal) {
                return Err(error);
            }
        }
        chosen.iter().try_for_each(|scene| scene.scene().check())
    }
}

/// Runs what follows on this many threads; on all cores where none is given.
///
/// # Errors
/// A number that is zero, or more than any machine has.
pub fn use_threads(threads: Option<usize>) -> Result<(), Error> {
    let Some(threads) = threads else { return Ok(()) };
    if !(1..=MOST_THREADS).contains(&threads) {
        let message = format!("give at least 1 and at most {MOST_THREADS}, or leave the flag out for all cores");
        return Err(plan("--threads", &message));
    }
    // Fails only if a pool exists already, and then its size was chosen by the same flag.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    Ok(())
}

fn plan(place: &str, message: &str) -> Error {
    Error::Plan { place: place.to_owned(), message: message.to_owned() }
}

/// The values of the given names in the order given, each once; all values if no name is given.
fn named<V: Copy + PartialEq>(
    names: &[String],
    by_name: impl Fn(&str) -> Result<V, Error>,
    all: &[V],
) -> Result<Vec<V>, Error> {
    if names.is_empty() {
        return Ok(all.to_vec());
    }
    Ok(distinct(names.iter().map(|name| by_name(name)).collect::<Result<Vec<_>, _>>()?))
}

/// Prints to stdout. A reader that has gone away (`| head`) is no error; a disk that is full is one.
///
/// # Errors
/// Standard output that cannot be written.
pub fn print(text: &str) -> Result<(), Error> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(plan("standard output", &format!("cannot be written: {error}; free some space, or send it elsewhere")))
        }
        _ => Ok(()),
    }
}

/// Prints the claims and ends a program: 0 if all claims hold, 1 if one is broken, 2 if the input or the output was wrong.
pub fn finish(result: Result<Vec<Claim>, Error>, show: impl Fn(&[Claim]) -> String) -> ExitCode {
    match result.and_then(|claims| print(&show(&claims)).map(|()| claims)) {
        Ok(claims) => ExitCode::from(exit_code(&claims)),
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::from(2)
        }
    }
}
