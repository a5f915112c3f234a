//! Every command of README and of the guides is run as it is written, and says what is shown below it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use verification::programs::{directory, text};

/// Commands that are not run here, and why.
const NOT_RUN: [(&str, &str); 4] = [
    (
        "cargo run --release                      # the whole report, into target/report/: index.html, and teach.html to play with",
        "it takes half a minute; .ci/run runs it",
    ),
    ("cargo test --release --workspace         # every law, order, oracle and published number", "it is this test"),
    (
        "cargo run --release --features png -- --from target/report --format png --figures-only --out charts",
        "it builds half a minute; .ci/run tests the feature",
    ),
    (
        "cargo run --release -- completions bash > ~/.local/share/bash-completion/completions/report",
        "it writes into the home directory; exports.rs runs it",
    ),
];

/// Stands in for `cargo run --release [--bin NAME] -- FLAGS`: the binaries of this very build, without building again.
const CARGO: &str = r#"#!/bin/sh
[ "$1 $2" = "run --release" ] || { echo "not a command of a guide: cargo $*" >&2; exit 99; }
shift 2
name=fixed-step
if [ "$1" = --bin ]; then name=$2; shift 2; fi
[ "$1" = -- ] && shift
exec "$BINARIES/$name" "$@"
"#;

/// A block of commands, and what it is said to print.
#[derive(Debug)]
struct Example {
    place: String,
    commands: String,
    shown: String,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace").to_owned()
}

fn documents() -> Vec<PathBuf> {
    let guides = fs::read_dir(root().join("reports/guides")).expect("there are guides");
    let mut all: Vec<PathBuf> = guides.map(|guide| guide.expect("readable").path()).collect();
    all.sort();
    all.push(root().join("README.md"));
    all
}

/// The blocks marked `sh`, each with the block marked `text` that follows it at once.
fn examples(document: &Path) -> Vec<Example> {
    let markdown = fs::read_to_string(document).expect("readable");
    let lines: Vec<&str> = markdown.lines().collect();
    let block = |from: usize| {
        let length = lines[from..].iter().position(|line| *line == "```").expect("every block ends");
        (lines[from..from + length].join("\n"), from + length + 1)
    };
    let starts = lines.iter().enumerate().filter(|(_, line)| **line == "```sh").map(|(i, _)| i);
    starts
        .map(|start| {
            let (commands, next) = block(start + 1);
            let shown = if lines.get(next) == Some(&"```text") { block(next + 1).0 } else { String::new() };
            Example { place: format!("{}:{}", document.display(), start + 1), commands, shown }
        })
        .collect()
}

/// The files that a document says its commands write: `target/.../name.ending`.
fn files_named(document: &Path) -> Vec<String> {
    let markdown = fs::read_to_string(document).expect("readable");
    let spans = markdown.split('`').filter(|span| span.starts_with("target/") && !span.contains(char::is_whitespace));
    spans.filter(|span| Path::new(span).extension().is_some()).map(str::to_owned).collect()
}

/// The commands of a document, in order, in one directory of their own.
fn run(document: &Path) {
    let temporary = tempfile::tempdir().expect("a temporary directory");
    let tools = temporary.path().join("tools");
    fs::create_dir(&tools).expect("writable");
    let cargo = tools.join("cargo");
    fs::write(&cargo, CARGO).expect("writable");
    assert!(Command::new("chmod").arg("+x").arg(&cargo).status().is_ok_and(|status| status.success()));
    // What a guide takes from the root of the workspace.
    let data = temporary.path().join("studies/gate/data");
    fs::create_dir_all(&data).expect("writable");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace");
    fs::copy(root.join("studies/gate/data/bounds.csv"), data.join("bounds.csv")).expect("it is committed");
    let engine = "studies/engines/data/rapier_f64";
    fs::create_dir_all(temporary.path().join(engine)).expect("writable");
    let file = format!("{engine}/A_240_nogyro.csv");
    fs::copy(root.join(&file), temporary.path().join(&file)).expect("it is committed");
    let path = format!("{}:{}", tools.display(), std::env::var("PATH").unwrap_or_default());
    for Example { place, commands, shown } in examples(document) {
        let kept = commands.lines().filter(|line| !NOT_RUN.iter().any(|(not, _)| not == line));
        let script = kept.collect::<Vec<_>>().join("\n");
        let output = Command::new("bash")
            .args(["-euc", &script])
            .env("PATH", &path)
            .env("BINARIES", directory())
            .current_dir(temporary.path())
            .output()
            .expect("bash is there");
        let said = text(&output.stdout);
        assert!(output.status.success(), "{place}: {:?}\n{script}\n{said}{}", output.status, text(&output.stderr));
        for line in shown.lines() {
            assert!(
                said.lines().any(|other| other.trim_end() == line.trim_end()),
                "{place}: not printed:\n{line}\n{said}"
            );
        }
    }
    for file in files_named(document) {
        assert!(temporary.path().join(&file).is_file(), "{}: {file} was not written", document.display());
    }
}

// Fails if: a place that was to be filled in is published empty.
#[test]
fn no_line_is_a_placeholder() {
    for document in documents() {
        let text = fs::read_to_string(&document).expect("readable");
        let blank = |line: &&str| line.contains('_') && line.chars().all(|c| c.is_ascii_uppercase() || c == '_');
        assert_eq!(text.lines().find(blank), None, "{}", document.display());
    }
}

// Fails if: a flag, a scene or a file of a guide has another name than in the programs, or the output shown is not theirs.
#[cfg(unix)]
#[test]
fn every_command_of_the_guides_runs_as_it_is_written() {
    let documents = documents();
    // These describe, and have nothing to run.
    let describes = |document: &&PathBuf| {
        ["architecture.md", "columns.md", "lesson.md", "worksheet.md"].iter().any(|name| document.ends_with(name))
    };
    assert_eq!(documents.iter().filter(|document| !describes(document)).count(), 9, "{documents:?}");
    for document in documents.iter().filter(|document| !describes(document)) {
        assert!(examples(document).len() > 1, "{} has no commands", document.display());
        run(document);
    }
    for (command, why) in NOT_RUN {
        println!("not run: {command}: {why}");
        let known = documents.iter().flat_map(|document| examples(document));
        assert!(known.into_iter().any(|e| e.commands.lines().any(|line| line == command)), "no guide has: {command}");
    }
}

// Fails if: a guide speaks of a chart or a table that no report has.
#[test]
fn every_link_of_readme_and_guides_leads_to_a_file() {
    for document in documents() {
        let markdown = fs::read_to_string(&document).expect("readable");
        let targets = markdown.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for target in targets.filter(|target| !target.contains("://") && !target.starts_with('#')) {
            let file = document.parent().expect("a directory").join(target);
            assert!(file.exists(), "{}: {target}", document.display());
        }
    }
}
