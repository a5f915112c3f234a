//! A run in parts: put together it is the run, and what is not all of one run is refused.

use std::fs;
use std::path::{Path, PathBuf};

use verification::programs::{assert_same, files, program, run, text, untimed};

const PLAN: [&str; 10] = [
    "--quick",
    "--scene",
    "oscillator",
    "--scene",
    "torque-free-spin",
    "--method",
    "semi-implicit-euler",
    "--method",
    "rk4",
    "--quiet",
];

fn shard(name: &str, plan: &[&str], part: &str, out: &Path) {
    let output = run(name, &[plan, &["--shard", part]].concat(), out);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

fn merge(parts: &[PathBuf], out: &Path) -> (Option<i32>, String) {
    let output =
        program("merge").args(parts).arg("--quiet").arg("--out").arg(out).output().expect("the binary was built");
    (output.status.code(), text(&output.stderr))
}

/// The directories of all parts of a run.
fn all_parts(name: &str, plan: &[&str], count: usize, root: &Path) -> Vec<PathBuf> {
    (1..=count)
        .map(|index| {
            let out = root.join(format!("{name}-{index}-of-{count}"));
            shard(name, plan, &format!("{index}/{count}"), &out);
            out
        })
        .collect()
}

// Fails if: a group of work is lost, done twice or put in another place.
#[test]
fn a_report_in_parts_is_the_report() {
    let root = tempfile::tempdir().expect("a temporary directory");
    let whole = root.path().join("whole");
    run("report", &PLAN, &whole);
    for count in [1, 3, 16] {
        let mut parts = all_parts("report", &PLAN, count, root.path());
        parts.reverse();
        let out = root.path().join(format!("merged-{count}"));
        let (code, error) = merge(&parts, &out);
        assert!(matches!(code, Some(0 | 1)), "{code:?} {error}");
        assert_same(&untimed(files(&out)), &untimed(files(&whole)));
    }
}

// Fails if: a study of its own, or the ensemble, is given out otherwise than it is put together.
#[test]
fn each_study_in_parts_is_the_study() {
    let root = tempfile::tempdir().expect("a temporary directory");
    for name in ["convergence", "drift", "rotation", "adequacy", "stability", "loops", "ensemble"] {
        let plan: &[&str] = match name {
            "ensemble" => &["--quick", "--scene", "kepler", "--members", "64", "--quiet"],
            "loops" => &["--quick", "--scene", "pendulum", "--quiet"],
            // With a method it would answer a question.
            "stability" => &["--quick", "--scene", "damped-oscillator", "--quiet"],
            _ => &PLAN,
        };
        let whole = root.path().join(name);
        run(name, plan, &whole);
        let out = root.path().join(format!("{name}-merged"));
        let (code, error) = merge(&all_parts(name, plan, 4, root.path()), &out);
        assert!(matches!(code, Some(0 | 1)), "{name}: {code:?} {error}");
        let mut whole = files(&whole);
        // Times of an ensemble follow from no row.
        whole.remove("ensemble-cost.csv");
        assert_same(&untimed(files(&out)), &untimed(whole));
    }
}

// Fails if: parts that are not all of one run are put together, or the error does not say which.
#[test]
fn what_is_not_all_of_one_run_is_refused() {
    let root = tempfile::tempdir().expect("a temporary directory");
    let plan = ["--quick", "--scene", "oscillator", "--method", "rk4", "--quiet"];
    let parts = all_parts("convergence", &plan, 3, root.path());
    let out = root.path().join("out");
    let refused = |parts: &[PathBuf], said: &str| {
        let (code, error) = merge(parts, &out);
        assert!(code == Some(2) && error.contains(said), "{code:?} {error}");
        assert!(files(&out).is_empty(), "something was written");
    };
    refused(&parts[..2], "shard 3/3 is missing");
    let again = root.path().join("again");
    shard("convergence", &plan, "2/3", &again);
    refused(&[&parts[..], std::slice::from_ref(&again)].concat(), "shard 2/3 is there twice");
    let other = root.path().join("other");
    shard("convergence", &["--quick", "--scene", "kepler", "--method", "rk4", "--quiet"], "3/3", &other);
    refused(&[&parts[..2], std::slice::from_ref(&other)].concat(), "another plan than");
    let study = root.path().join("study");
    shard("drift", &plan, "3/3", &study);
    refused(&[&parts[..2], &[study]].concat(), "another program than");
    let four = root.path().join("four");
    shard("convergence", &plan, "3/4", &four);
    refused(&[&parts[..2], &[four]].concat(), "another number of shards than");
    let whole = root.path().join("whole");
    run("convergence", &plan, &whole);
    refused(&[whole], "a whole run, not a part of one");
    let rows = parts[1].join("convergence.rows.csv");
    let text = fs::read_to_string(&rows).expect("written");
    fs::write(&rows, &text[..text.len() / 2]).expect("writable");
    refused(&parts, "convergence.rows.csv: ");
    fs::remove_file(&rows).expect("there");
    refused(&parts, "convergence.rows.csv: cannot be read");
    // The part that was broken, run again, changes nothing else.
    shard("convergence", &plan, "2/3", &parts[1]);
    let (code, error) = merge(&parts, &out);
    assert!(matches!(code, Some(0 | 1)), "{code:?} {error}");
}

// Fails if: a part that is there whole is run again, or one that is not is taken for whole.
#[test]
fn a_part_that_is_there_whole_is_not_run_again() {
    let root = tempfile::tempdir().expect("a temporary directory");
    let out = root.path().join("part");
    let plan = ["--quick", "--scene", "oscillator", "--method", "rk4"];
    let resume = |part: &str, plan: &[&str]| {
        let output = run("convergence", &[plan, &["--shard", part, "--resume"]].concat(), &out);
        assert!(output.status.success());
        text(&output.stderr).contains("holds it whole already")
    };
    assert!(!resume("1/2", &plan), "there was nothing");
    let before = files(&out);
    assert!(resume("1/2", &plan));
    assert_same(&files(&out), &before);
    assert!(!resume("2/2", &plan), "another part");
    assert!(!resume("2/2", &["--quick", "--scene", "kepler", "--method", "rk4"]), "another plan");
    let rows = out.join("convergence.rows.csv");
    let text = fs::read_to_string(&rows).expect("written");
    fs::write(&rows, &text[..text.len() - 2]).expect("writable");
    assert!(!resume("2/2", &["--quick", "--scene", "kepler", "--method", "rk4"]), "truncated");
    assert_eq!(fs::read_to_string(&rows).expect("written"), text);
}

// Fails if: a forecast runs the work, or writes something; or a part that is none is taken.
#[test]
fn a_forecast_counts_and_a_wrong_part_is_refused() {
    let root = tempfile::tempdir().expect("a temporary directory");
    let out = root.path().join("out");
    let output = run("convergence", &["--scene", "oscillator", "--method", "rk4", "--dry-run"], &out);
    let said = text(&output.stdout);
    // 13 halvings of one method on one scene.
    assert!(said.contains("convergence                13") && said.contains("suggested: 1 shard"), "{said}");
    assert!(!out.exists());
    for part in ["0/3", "4/3", "1", "a/b", "1/0"] {
        let output = run("convergence", &["--shard", part], &out);
        assert_eq!(output.status.code(), Some(2), "{part}");
        assert!(text(&output.stderr).contains("give K/N with 1 <= K <= N"), "{}", text(&output.stderr));
    }
}
