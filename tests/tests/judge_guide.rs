//! The guide for the author of an engine without Rust, followed by its letter in Python and in C++.
//!
//! Ignored, because it needs `python3` and `c++`, which a machine with Rust may lack:
//! `cargo test --release --workspace --test judge_guide -- --ignored`.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use verification::programs::{program, text};

const GUIDE: &str = include_str!("../../reports/guides/judge-your-engine.md");
const SCENE: [&str; 4] = ["--scene", "torque-free-spin", "--inertia", "1.25,0.75,1.75"];

/// The block of code in a language.
fn block(language: &str) -> &'static str {
    let start = GUIDE.split(&format!("```{language}\n")).nth(1).expect("a block of code");
    start.split("```").next().expect("its end")
}

fn written(directory: &Path, file: &str, command: &mut Command) {
    let output = command.current_dir(directory).stderr(Stdio::inherit()).output().expect("the command is installed");
    assert!(output.status.success(), "{command:?}");
    fs::write(directory.join(file), output.stdout).expect("writable");
}

fn audited(directory: &Path, files: &[&str]) -> String {
    let output =
        program("audit").args(files).args(SCENE).current_dir(directory).output().expect("the binary was built");
    text(&output.stdout)
}

// Fails if: a command or the code of the guide does not run, or the findings are not those that the guide shows.
#[test]
#[ignore = "needs python3 and a C++ compiler"]
fn the_guide_leads_to_its_findings_in_python_and_in_cpp() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path();
    fs::write(path.join("engine.py"), block("python")).expect("writable");
    fs::write(path.join("engine.cpp"), block("cpp")).expect("writable");
    written(path, "built.txt", Command::new("c++").args(["-O2", "-ffp-contract=off", "engine.cpp", "-o", "engine"]));
    let python = || {
        let mut command = Command::new("python3");
        command.arg("engine.py");
        command
    };
    let cpp = || Command::new(path.join("engine"));
    let shown: Vec<&str> = GUIDE.split("```text\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    for engine in [&python as &dyn Fn() -> Command, &cpp] {
        written(path, "mine.csv", engine().arg("60"));
        let verdict = audited(path, &["mine.csv"]);
        assert_eq!(verdict.lines().next(), Some(shown[0].trim_end()), "{verdict}");
        written(path, "h60.csv", engine().args(["60", "--gyroscopic"]));
        written(path, "h120.csv", engine().args(["120", "--gyroscopic"]));
        let order = audited(path, &["h60.csv", "h120.csv"]);
        assert!(order.contains(shown[1].trim_end()) && order.starts_with("h60.csv: no fault found"), "{order}");
    }
}
