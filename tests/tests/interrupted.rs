//! A run that is interrupted leaves the report that was there before.
#![cfg(unix)]

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use verification::programs::{assert_same, files, program, run, untimed};

/// A run without an end that could be waited for.
const ENDLESS: [&str; 5] = ["--scene", "kepler", "--steps", "1000000000000", "--quiet"];

fn start(arguments: &[&str], out: &Path) -> Child {
    let mut command = program("report");
    command.args(arguments).arg("--out").arg(out).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("the binary was built")
}

// Fails if: a signal has another exit code, or anything is written before all is known.
#[test]
fn a_signal_ends_a_run_with_130_and_leaves_the_report() {
    let out = tempfile::tempdir().expect("a temporary directory");
    run("report", &["--quick", "--scene", "constant-force"], out.path());
    let before = files(out.path());
    assert!(before.contains_key("index.html"));
    for signal in ["-INT", "-TERM", "-HUP"] {
        let mut child = start(&ENDLESS, out.path());
        // Long enough for the handler to stand; the run itself goes on for years.
        std::thread::sleep(Duration::from_secs(1));
        let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
        assert!(sent.is_ok_and(|status| status.success()));
        assert_eq!(child.wait().expect("it ends").code(), Some(130), "{signal}");
        assert_same(&before, &files(out.path()));
        assert!(!out.path().join(".reports/staged").exists());
    }
}

// Fails if: a file is written in its place, or the files of one study before those of the next are known. A mixture of old
// and new is seen in the instant of putting the files in their places alone; the rest of them lie in `.reports/placing` then, and the next run completes it.
#[test]
fn a_killed_run_leaves_the_old_report_or_the_new_one() {
    let plan = ["--quick", "--scene", "constant-force", "--method", "rk4"];
    let (fresh, out) = (tempfile::tempdir().expect("temporary"), tempfile::tempdir().expect("temporary"));
    run("report", &plan, fresh.path());
    run("report", &[&plan[..], &["--set", "mass=1.75"]].concat(), out.path());
    let (new, old) = (untimed(files(fresh.path())), untimed(files(out.path())));
    assert!(new.keys().eq(old.keys()) && new["convergence.csv"] != old["convergence.csv"]);
    for milliseconds in (0..12).map(|i| 5 << i) {
        let mut child = start(&plan, out.path());
        std::thread::sleep(Duration::from_millis(milliseconds));
        let ended = child.try_wait().expect("it can be asked").is_some();
        let _ = child.kill();
        child.wait().expect("it ends");
        let found = untimed(files(out.path()));
        assert!(found.keys().eq(old.keys()), "after {milliseconds} ms: {:?}", found.keys());
        for (name, bytes) in &found {
            assert!(
                *bytes == old[name] || *bytes == new[name],
                "after {milliseconds} ms {name} is neither old nor new"
            );
        }
        let is_unfinished = out.path().join(".reports/placing").exists();
        assert!(found == old || found == new || is_unfinished, "after {milliseconds} ms: a mixture");
        if ended {
            return assert_same(&new, &found);
        }
    }
    panic!("the run never ended, and so was never seen to replace the report");
}
