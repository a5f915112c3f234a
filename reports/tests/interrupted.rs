//! Output that is interrupted, refused or written by two at once: all old or all new, and nothing left beside it.
#![cfg(unix)]

use reports::files::when_written;
use reports::{Error, OutputDir};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const FILES: usize = 40;

/// A report in which every file names the version it is of; odd versions have fewer files.
fn report(version: usize) -> Vec<(String, String)> {
    let count = if version % 2 == 1 { FILES / 2 } else { FILES };
    (0..count).map(|i| (format!("part/{i}.csv"), format!("{version} {}", "x".repeat(2000)))).collect()
}

/// What a reader sees: version and number of the files.
fn seen(root: &Path) -> (BTreeSet<usize>, usize) {
    let entries = fs::read_dir(root.join("part")).into_iter().flatten();
    let texts: Vec<String> = entries.map(|e| fs::read_to_string(e.expect("entry").path()).expect("read")).collect();
    let version = |text: &String| text.split(' ').next().and_then(|v| v.parse().ok()).expect("a version");
    (texts.iter().map(version).collect(), texts.len())
}

fn is_whole((versions, count): &(BTreeSet<usize>, usize)) -> bool {
    versions.iter().all(|version| *count == report(*version).len()) && versions.len() == 1
}

/// Not a test by itself: what the tests below start in a process of its own. It writes one version after the other, for ever.
#[test]
fn writes_for_ever_when_it_is_started_to() {
    let Some(root) = std::env::var_os("REPORTS_TEST_OUTPUT") else { return };
    ctrlc::set_handler(|| when_written(|| std::process::exit(130))).expect("the only handler");
    let output = match OutputDir::create(root) {
        Ok(output) => output,
        Err(Error::Busy { .. }) => std::process::exit(2),
        Err(error) => panic!("{error}"),
    };
    for version in 0.. {
        output.replace_all("test", &report(version)).expect("written");
    }
}

fn start(root: &Path) -> Child {
    Command::new(std::env::current_exe().expect("this program"))
        .args(["--exact", "writes_for_ever_when_it_is_started_to"])
        .env("REPORTS_TEST_OUTPUT", root)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("started")
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()));
}

fn first(root: &Path) {
    OutputDir::create(root).and_then(|output| output.replace_all("test", &report(0))).expect("written");
}

// Fails if: files are renamed before all are ready, a change is not completed by the next run, or the handler does not wait.
#[test]
fn a_process_that_is_killed_at_any_moment_leaves_one_report_or_the_next_run_completes_it() {
    let keep = tempfile::tempdir().expect("a temporary directory");
    let root = keep.path();
    first(root);
    let mut versions = BTreeSet::new();
    for round in 0_u64..60 {
        let signal = ["-KILL", "-TERM", "-HUP", "-INT"][round as usize % 4];
        let mut child = start(root);
        // Long enough for the handler to stand, and then at moments spread over the writing of some versions.
        std::thread::sleep(Duration::from_millis(25) + Duration::from_micros(round * 7919 % 100_000));
        if round % 8 == 0 {
            // These are killed while files are put in their places, which random moments seldom meet.
            let end = Instant::now() + Duration::from_secs(2);
            while !root.join(".reports/placing").exists() && Instant::now() < end {}
        }
        send(signal, &child);
        let status = child.wait().expect("it ends");
        let found = seen(root);
        let is_unfinished = root.join(".reports/placing").exists();
        if signal == "-KILL" {
            assert!(is_unfinished || is_whole(&found), "round {round}: {found:?}");
        } else {
            assert_eq!(status.code(), Some(130), "round {round}, {signal}");
            assert!(
                !is_unfinished && !root.join(".reports/staged").exists() && is_whole(&found),
                "round {round}: {found:?}"
            );
        }
        drop(OutputDir::create(root).expect("the lock went with its process"));
        let found = seen(root);
        assert!(is_whole(&found), "round {round}, after the next run: {found:?}");
        let state: Vec<_> =
            fs::read_dir(root.join(".reports")).expect("listed").map(|e| e.expect("entry").file_name()).collect();
        assert!(state.iter().all(|name| name == "lock" || name == "files"), "{state:?}");
        versions.extend(found.0);
    }
    assert!(versions.len() > 2, "too few moments: {versions:?}");
}

#[test]
fn of_two_runs_at_once_one_is_refused_with_two() {
    let keep = tempfile::tempdir().expect("a temporary directory");
    let mut children: Vec<Child> = (0..8).map(|_| start(keep.path())).collect();
    std::thread::sleep(Duration::from_millis(300));
    let ended: Vec<_> = children.iter_mut().map(|child| child.try_wait().expect("it can be asked")).collect();
    let refused = ended.iter().flatten().filter(|status| status.code() == Some(2)).count();
    for child in &mut children {
        let _ = child.kill();
        child.wait().expect("it ends");
    }
    assert_eq!(refused, 7, "{ended:?}");
    drop(OutputDir::create(keep.path()).expect("free again"));
    assert!(is_whole(&seen(keep.path())));
}

/// Every file below a directory, with its bytes.
fn all(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(root).expect("listed") {
        let path = entry.expect("entry").path();
        if path.is_dir() {
            found.extend(all(&path));
        } else {
            found.insert(path.display().to_string(), fs::read(&path).expect("read"));
        }
    }
    found
}

// Fails if: a target is looked at only when it is its turn, or what was staged stays.
#[test]
fn something_else_in_the_place_of_any_one_file_leaves_all_others_as_they_were() {
    for index in 0..FILES / 2 {
        let keep = tempfile::tempdir().expect("a temporary directory");
        first(keep.path());
        let place = keep.path().join(format!("part/{index}.csv"));
        fs::remove_file(&place).expect("there");
        if index % 2 == 0 {
            fs::create_dir(&place).expect("created");
        } else {
            assert!(Command::new("mkfifo").arg(&place).status().expect("mkfifo").success());
        }
        let output = OutputDir::create(keep.path()).expect("free");
        let listed = |root: &Path| {
            let names = fs::read_dir(root.join("part")).expect("listed").map(|e| e.expect("entry").path());
            names.filter(|path| path.is_file()).map(|path| fs::read(path).expect("read")).collect::<Vec<_>>()
        };
        let before = listed(keep.path());
        let message = output.replace_all("test", &report(1)).expect_err("refused").to_string();
        assert!(message.contains(&format!("part/{index}.csv: ")) && message.contains("; "), "{message}");
        assert!(listed(keep.path()) == before && !keep.path().join(".reports/staged").exists());
    }
}

/// A file system of a megabyte; `None` where one may not be mounted.
struct Small(tempfile::TempDir);

impl Small {
    fn mount() -> Option<Self> {
        let directory = tempfile::tempdir().expect("a temporary directory");
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", "size=1m", "tmpfs"]).arg(directory.path()).stderr(Stdio::null());
        mount.status().is_ok_and(|status| status.success()).then_some(Self(directory))
    }
}

impl Drop for Small {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0.path()).status();
    }
}

#[test]
fn a_disk_that_fills_up_leaves_the_old_report() {
    let Some(small) = Small::mount() else { return };
    let root = small.0.path();
    first(root);
    let before = all(root);
    let large: Vec<_> = report(1).into_iter().map(|(name, _)| (name, vec![0_u8; 100_000])).collect();
    let output = OutputDir::create(root).expect("free");
    let message = output.replace_all("test", &large).expect_err("full").to_string();
    assert!(message.contains("free some space"), "{message}");
    assert!(all(root) == before);
    output.replace_all("test", &report(1)).expect("there is room for this one");
    assert!(is_whole(&seen(root)));
}

#[test]
fn a_smaller_report_leaves_nothing_of_a_larger_one_and_touches_nothing_else() {
    let keep = tempfile::tempdir().expect("a temporary directory");
    let root = keep.path();
    fs::create_dir(root.join("part")).expect("created");
    fs::write(root.join("part/notes.txt"), "mine").expect("writable");
    let output = OutputDir::create(root).expect("created");
    output.replace_all("test", &report(0)).expect("written");
    output.replace_all("other", &[("other.csv".to_owned(), "o")]).expect("written");
    output.write("added.csv", "a").expect("written");
    output.replace_all("test", &report(1)).expect("written");
    let names: BTreeSet<_> = all(root).into_keys().collect();
    let at = |name: &str| root.join(name).display().to_string();
    let mine = ["part/notes.txt", "other.csv", "added.csv", ".reports/lock", ".reports/files"].map(at);
    let expected: BTreeSet<_> = report(1).iter().map(|(name, _)| at(name)).chain(mine).collect();
    assert_eq!(names, expected);
}
