//! The binaries as a user meets them: exit codes, messages, files. Numbers are other tests' business.

use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};

use verification::programs::{PROGRAMS, assert_same, files, program, run, text, untimed};

const SMALL: [&str; 3] = ["--quick", "--scene", "oscillator"];

// Fails if: a study is left out of `produce::report`, or a file is not written.
#[test]
fn report_writes_tables_charts_and_one_page() {
    let out = tempfile::tempdir().expect("a temporary directory");
    let output = run("report", &SMALL, out.path());
    assert_eq!(output.status.code(), Some(0), "{}{}", text(&output.stdout), text(&output.stderr));
    assert!(text(&output.stdout).contains("convergence"), "{}", text(&output.stdout));
    for name in ["index.html", "manifest.json", "convergence.csv", "orders.csv", "drift.csv", "growth-laws.csv"] {
        assert!(out.path().join(name).is_file(), "{name} is missing");
    }
    assert!(files(out.path()).keys().any(|name| name.ends_with(".svg")));
}

// Fails if: rows are written in the order in which threads finish.
#[test]
fn output_is_the_same_bytes_with_one_thread_and_with_two() {
    let (one, two) = (tempfile::tempdir().expect("temporary"), tempfile::tempdir().expect("temporary"));
    run("report", &[&SMALL[..], &["--threads", "1"]].concat(), one.path());
    run("report", &[&SMALL[..], &["--threads", "2"]].concat(), two.path());
    let (one, two) = (files(one.path()), files(two.path()));
    assert!(one.len() > 5);
    assert_same(&untimed(one), &untimed(two));
}

// Fails if: an error is reported with another exit code, or without the word that helps.
#[test]
fn wrong_input_is_named_with_its_remedy_and_ends_with_2() {
    let cases: [(&[&str], &str); 14] = [
        (&["--scene", "oscilator"], "did you mean 'oscillator'?"),
        (&["--method", "rk5"], "did you mean 'rk4'?"),
        (&["--precision", "f16"], "double-double"),
        (&["--steps", "0"], "at least 1 step"),
        (&["--steps", "-3"], "at least 1 step"),
        (&["--steps", "64,many"], "--steps 'many': not a number of steps; "),
        (&["--threads", "0"], "at least 1"),
        (&["--threads", "-1"], "at least 1"),
        (&["--color", "red"], "--color 'red': not one of its values; give auto, always, never"),
        (&["--qick"], "--qick: no such flag or command; did you mean '--quick'?"),
        (&["--json", "--markdown"], "cannot stand beside --markdown"),
        (&["--scene", "oscillator", "--set", "mass=-1"], "must be finite and > 0"),
        (&["--scene", "oscillator", "--set", "mass"], "NAME=VALUE"),
        (&["--scene", "torque-free-spin", "--set", "inertia=1,1,3"], "sum of the other two"),
    ];
    for binary in PROGRAMS {
        for (arguments, expected) in cases {
            let out = tempfile::tempdir().expect("a temporary directory");
            let output = run(binary, arguments, out.path());
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{binary} {arguments:?}: {message}");
            // A flag that a study cannot use is refused before its value is looked at.
            let is_unheard = message.contains("runs what it needs, whatever is given; leave it out");
            assert!(message.contains(expected) || is_unheard, "{binary} {arguments:?}: {message}");
            assert!(
                message.starts_with("error: ") && message.lines().count() == 1,
                "{binary} {arguments:?}: {message}"
            );
            assert!(files(out.path()).is_empty(), "{binary} {arguments:?} wrote something");
        }
    }
}

// Fails if: files are written as they are made, or the output directory is not looked at.
#[test]
fn an_output_that_cannot_be_written_leaves_earlier_files_alone() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let occupied = directory.path().join("file");
    fs::write(&occupied, "mine").expect("writable");
    let output = run("report", &SMALL, &occupied);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("file"), "{}", text(&output.stderr));
    assert_eq!(fs::read(&occupied).expect("still there"), b"mine");
}

// Fails if: a write to standard output that fails is ignored (full disk), or shouted about (closed pipe).
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_and_a_closed_pipe_is_not() {
    let out = tempfile::tempdir().expect("a temporary directory");
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("linux has it");
    let arguments = ["--quick", "--scene", "constant-force", "--out"];
    let output =
        program("convergence").args(arguments).arg(out.path()).stdout(full).output().expect("the binary was built");
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("standard output"), "{}", text(&output.stderr));

    let mut child = program("convergence")
        .args(arguments)
        .arg(out.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary was built");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(text(&output.stderr), "");
}

// Fails if: an error is printed on standard output, or progress where nobody watches.
#[test]
fn nothing_but_notes_goes_to_stderr_when_piped() {
    let out = tempfile::tempdir().expect("a temporary directory");
    let output = run("drift", &SMALL, out.path());
    assert_eq!(text(&output.stderr), "");
    assert!(text(&output.stdout).contains("drift.oscillator.explicit-euler.energy"));
}

#[test]
fn help_shows_examples() {
    for binary in PROGRAMS.into_iter().chain(["bounds"]) {
        let output = program(binary).arg("--help").output().expect("the binary was built");
        assert_eq!(output.status.code(), Some(0));
        assert!(text(&output.stdout).contains("Examples:"), "{binary}");
    }
}

// Fails if: an answer is printed with a macro that panics.
#[cfg(target_os = "linux")]
#[test]
fn a_question_to_stability_is_answered_and_a_full_disk_told() {
    let arguments = ["--scene", "damped-oscillator", "--method", "semi-implicit-euler", "--set", "zeta=0.1", "--step"];
    let ask = |step: &str| program("stability").args(arguments).arg(step).output().expect("the binary was built");
    // 2 (sqrt(1 + zeta^2) - zeta) / omega = 0.904988 s
    assert_eq!(ask("0.9").status.code(), Some(0));
    assert_eq!(ask("0.91").status.code(), Some(1));
    assert!(text(&ask("0.9").stdout).contains("0.904988"));
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("linux has it");
    let output = program("stability").args(arguments).arg("0.9").stdout(full).output().expect("the binary was built");
    assert_eq!(output.status.code(), Some(2));
}

// Fails if: advice that cannot be followed ends with 0, or a question without sense with anything but 2.
#[test]
fn advice_of_tradeoff_ends_as_a_ci_job_wants_it() {
    let ask = |arguments: &[&str]| {
        let output = program("tradeoff").args(arguments).output().expect("the binary was built");
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    };
    let racket = ["--scene", "tennis-racket", "--precision", "f64", "--for", "2", "--rate", "60", "--error"];
    let (code, out, _) = ask(&[&racket[..], &["1e-3"]].concat());
    assert_eq!(code, Some(0), "{out}");
    assert!(
        ["substeps per frame", "stability", "checked", "a whole frame", "runner-up"].iter().all(|w| out.contains(w)),
        "{out}"
    );
    let (code, out, _) = ask(&["--scene", "pendulum", "--error", "1e-3"]);
    assert_eq!(code, Some(0), "{out}");
    assert!(["twice the step", "missed", "natural period", "times as much"].iter().all(|w| out.contains(w)), "{out}");
    let (code, out, _) = ask(&[&racket[..], &["1e-10", "--method", "explicit-euler"]].concat());
    assert_eq!(code, Some(1), "{out}");
    assert!(out.contains("no method tried reaches the error"), "{out}");
    let wrong: [(&[&str], &str); 5] = [
        (&["--scene", "pendulum", "--error", "0"], "--error '0': not a positive number"),
        (&["--scene", "pendulum", "--error", "NaN"], "--error 'NaN': not a positive number"),
        (&["--scene", "pendulum", "--error", "-1"], "--error '-1': not a positive number"),
        (&["--scene", "pendulum", "--error", "1e-3", "--rate", "0"], "--rate '0': not a positive number"),
        (&["--error", "1e-3"], "--scene: advice needs a scene"),
    ];
    for (arguments, expected) in wrong {
        let (code, _, message) = ask(arguments);
        assert_eq!(code, Some(2), "{arguments:?}: {message}");
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
}

// Fails if: a scene given twice is swept twice, or a claim is made of a sweep that can decide nothing.
#[test]
fn a_scene_given_twice_is_one_and_two_runs_are_no_sweep() {
    let out = tempfile::tempdir().expect("a temporary directory");
    let twice = ["--quick", "--scene", "oscillator", "--scene", "oscillator", "--method", "rk4"];
    assert_eq!(run("convergence", &twice, out.path()).status.code(), Some(0));
    let output = run("convergence", &["--scene", "oscillator", "--method", "rk4", "--steps", "64,128"], out.path());
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stdout).contains("not tested"), "{}", text(&output.stdout));
}

/// `bounds` at the root of the workspace, where the committed file lies.
fn bounds(arguments: &[&str]) -> Output {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace");
    program("bounds").args(arguments).current_dir(root).output().expect("the binary was built with the workspace")
}

// Fails if: a broken bound, a malformed file or a missing reason ends with the wrong code or without its place.
#[test]
fn bounds_ends_with_0_1_or_2_and_says_where() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let (path, junit) = (directory.path().join("b.csv"), directory.path().join("b.xml"));
    let [file, xml] = [&path, &junit].map(|path| path.to_str().expect("a temporary path is text"));
    let small = ["--quick", "--scene", "oscillator", "--method", "rk4"];
    let good = bounds(&small);
    assert_eq!(good.status.code(), Some(0), "{}{}", text(&good.stdout), text(&good.stderr));
    assert!(text(&good.stdout).starts_with("0 bounds are broken, "), "{}", text(&good.stdout));

    let row = "oscillator,rk4,f64,position,error-at-step,64,2.75,m,4e-4,1e-2,2e-3,measured x 5: a test,";
    let header = "scene,method,precision,quantity,kind,steps,end_s,unit,low,high,measured,reason,mutant";
    fs::write(&path, format!("{header}\n{row}\n# end: 1 rows\n")).expect("written");
    let broken = bounds(&["--bounds", file, "--junit", xml]);
    assert_eq!(broken.status.code(), Some(1), "{}", text(&broken.stderr));
    assert!(text(&broken.stdout).starts_with("1 bounds are broken, 0 hold"), "{}", text(&broken.stdout));
    assert!(fs::read_to_string(&junit).expect("written").contains("failures=\"1\""));

    let refused = bounds(&["--bounds", file, "--update"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("--reason"), "{}", text(&refused.stderr));
    assert!(fs::read_to_string(&path).expect("untouched").contains(row));

    fs::write(&path, format!("{header}\n{row}\n")).expect("written");
    let cut = bounds(&["--bounds", file]);
    assert_eq!(cut.status.code(), Some(2));
    assert!(text(&cut.stderr).contains("b.csv:2: truncated"), "{}", text(&cut.stderr));
    assert_eq!(bounds(&["--bounds", "nowhere.csv"]).status.code(), Some(2));
    assert_eq!(bounds(&["--scene", "oscillator", "--method", "rk4/world-omega"]).status.code(), Some(2));
}
