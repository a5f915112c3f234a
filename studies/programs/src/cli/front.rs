//! One command in front of all programs: `fixed-step NAME ...` is the program NAME, and without a name it is the report.

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::OnceLock;

use measure::adequacy::Adequacy;
use measure::convergence::Convergence;
use measure::drift::DriftStudy;
use measure::ensemble::Ensemble;
use measure::error::Error;
use measure::loops::Loops;
use measure::rotation::Rotation;
use measure::stability::Stability;
use measure::tradeoff::Tradeoff;

use super::messages::{complain, print};
use super::{asking, bounds, exact, loops, main, merge, order, report, stability, start, tradeoff, with_tables};

/// A program: its name, what it does, and how it is run.
struct Command {
    name: &'static str,
    about: &'static str,
    run: fn() -> ExitCode,
}

/// The commands, grouped by the question that they answer.
const GROUPS: [(&str, &[Command]); 4] = [
    (
        "I have an engine",
        &[
            Command {
                name: "audit",
                about: "judges a trajectory from its file: faults, error, the step that computed it",
                run: audit_files,
            },
            Command {
                name: "exact",
                about: "prints the exact motion of a scene, to compare with",
                run: || start(exact::WORDS, |flags| exact::run(&flags)),
            },
            Command {
                name: "order",
                about: "judges the order in a table of errors or values",
                run: || start(order::WORDS, |flags| order::run(&flags)),
            },
        ],
    ),
    (
        "Which method, which step?",
        &[
            Command {
                name: "tradeoff",
                about: "cost at equal error; advice for --scene and --error",
                run: || asking::<Tradeoff, _>(tradeoff::ask),
            },
            Command {
                name: "stability",
                about: "largest stable steps; an answer for --scene and --method",
                run: || asking::<Stability, _>(stability::ask),
            },
            Command { name: "adequacy", about: "what a simpler model costs and loses", run: main::<Adequacy> },
        ],
    ),
    (
        "How accurate is it?",
        &[
            Command { name: "report", about: "every study, one page (also without a name)", run: report },
            Command { name: "convergence", about: "orders and error constants", run: main::<Convergence> },
            Command { name: "drift", about: "energy and momenta over long runs", run: main::<DriftStudy> },
            Command {
                name: "rotation",
                about: "every step for rigid bodies in use, side by side",
                run: main::<Rotation>,
            },
            Command {
                name: "loops",
                about: "what frames, substeps, damping and clocks do to a step",
                run: || asking::<Loops, _>(loops::ask),
            },
            Command {
                name: "merge",
                about: "puts the shards of a run together (--shard K/N)",
                run: || start(merge::WORDS, |flags| merge::run(&flags)),
            },
            Command { name: "ensemble", about: "errors over many starts", run: with_tables::<Ensemble> },
        ],
    ),
    (
        "I have a CI",
        &[Command {
            name: "bounds",
            about: "checks every committed error bound",
            run: || start(bounds::WORDS, |flags| bounds::run(&flags)),
        }],
    ),
];

/// The name of the command.
pub const NAME: &str = "fixed-step";

static SHIFTED: OnceLock<Vec<OsString>> = OnceLock::new();

/// The arguments of the program that runs: those of the process, without the name of a command in front.
pub(super) fn arguments() -> Vec<OsString> {
    SHIFTED.get().cloned().unwrap_or_else(|| std::env::args_os().collect())
}

fn audit_files() -> ExitCode {
    audit::cli::main(arguments())
}

/// The commands by question, as help.
pub fn help() -> String {
    let mut text = format!(
        "Measures how accurate, stable and costly fixed-step integration is\n\nUsage: {NAME} [COMMAND] [OPTIONS]\n"
    );
    for (question, commands) in GROUPS {
        text += &format!("\n{question}\n");
        for command in commands {
            text += &format!("  {:<12} {}\n", command.name, command.about);
        }
    }
    text + &format!("\nWithout a command it runs the report. '{NAME} COMMAND --help' shows the options of a command.\n")
}

/// Runs the program that the first argument names.
pub fn run() -> ExitCode {
    let all: Vec<OsString> = std::env::args_os().collect();
    let first = all.get(1).map(|argument| argument.to_string_lossy().into_owned()).unwrap_or_default();
    if ["--help", "-h", "help"].contains(&first.as_str()) {
        return print(&help()).map_or(ExitCode::from(2), |()| ExitCode::SUCCESS);
    }
    let mut known = GROUPS.iter().flat_map(|(_, commands)| *commands);
    if let Some(command) = known.find(|command| command.name == first) {
        let rest = std::iter::once(OsString::from(command.name)).chain(all.into_iter().skip(2));
        let _ = SHIFTED.set(rest.collect());
        return (command.run)();
    }
    // What is beside a run of the report: `list`, `completions`, `man`, and every option.
    if first.is_empty() || first.starts_with('-') || ["list", "completions", "man"].contains(&first.as_str()) {
        return report();
    }
    let names = GROUPS.iter().flat_map(|(_, commands)| *commands).map(|command| command.name.to_owned());
    complain(&Error::unknown("command", &first, names));
    ExitCode::from(2)
}

/// Every command, for a shell and for tests.
pub fn names() -> Vec<&'static str> {
    GROUPS.iter().flat_map(|(_, commands)| *commands).map(|command| command.name).collect()
}
