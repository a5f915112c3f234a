//! A set of files put in their places, all or none.
//!
//! ```text
//! 1. staged/new, staged/old   the new files, flushed, and second names of those that they replace
//! 2. staged -> placing        by one rename: from here on the change is to be completed
//! 3. placing/new/x -> x       one rename a file; stale files are removed
//! 4. placing -> staged         by one rename, and removed
//! ```
//!
//! An error in 1 changes nothing; one in 3 brings the old files back. A process that is killed in 3, a matter of milliseconds,
//! leaves `placing`, and the next run completes it; one that is killed before or after leaves `staged`, and the next run removes it.

use super::{STATE, refused};
use crate::Error;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What is to be done, one line a file: `+` and the name of a new one, `-` and the name of a stale one.
const PLAN: &str = "plan";

fn staged(root: &Path) -> PathBuf {
    root.join(STATE).join("staged")
}

fn placing(root: &Path) -> PathBuf {
    root.join(STATE).join("placing")
}

/// Puts the files in their places below `root` and removes the stale ones, all or none.
///
/// # Errors
/// [`Error::Write`]: every file is as it was before.
pub(super) fn put(root: &Path, files: &[(&str, &[u8])], stale: &[String]) -> Result<(), Error> {
    let (staged, placing) = (staged(root), placing(root));
    let ready = stage(root, files, stale)
        .and_then(|()| fs::rename(&staged, &placing).map_err(|source| refused(&placing, source)));
    if ready.is_err() {
        // What is left of it, the next run removes.
        let _ = fs::remove_dir_all(&staged);
    }
    ready?;
    complete(root)
}

fn stage(root: &Path, files: &[(&str, &[u8])], stale: &[String]) -> Result<(), Error> {
    let staged = staged(root);
    clear(&staged).map_err(|source| refused(&staged, source))?;
    for (name, bytes) in files {
        let (path, new) = (root.join(name), staged.join("new").join(name));
        let present = is_file(&path).and_then(|present| parents(&path).map(|()| present));
        let present = present.map_err(|source| refused(&path, source))?;
        let written = parents(&new).and_then(|()| {
            let mut file = File::create(&new)?;
            file.write_all(bytes)?;
            file.sync_all()
        });
        written.map_err(|source| refused(&path, source))?;
        if present {
            keep(root, name).map_err(|source| refused(&path, source))?;
        }
    }
    for name in stale {
        keep(root, name).map_err(|source| refused(&root.join(name), source))?;
    }
    let lines = files.iter().map(|(name, _)| format!("+{name}\n")).chain(stale.iter().map(|name| format!("-{name}\n")));
    let plan = staged.join(PLAN);
    fs::write(&plan, lines.collect::<String>()).map_err(|source| refused(&plan, source))
}

/// Whether a file is there; an error where something else is.
fn is_file(path: &Path) -> io::Result<bool> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_file() || found.is_symlink() => Ok(true),
        Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(_) => Err(io::Error::new(io::ErrorKind::AlreadyExists, "a device or a pipe is in its place")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

fn parents(path: &Path) -> io::Result<()> {
    path.parent().map_or(Ok(()), fs::create_dir_all)
}

/// Gives a file a second name, by which it can be brought back; where the system has no second names, a copy.
fn keep(root: &Path, name: &str) -> io::Result<()> {
    let (path, old) = (root.join(name), staged(root).join("old").join(name));
    parents(&old)?;
    fs::hard_link(&path, &old).or_else(|_| fs::copy(&path, &old).map(drop))
}

fn clear(directory: &Path) -> io::Result<()> {
    match fs::remove_dir_all(directory) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Does what the plan in `placing` says, or, if that fails, undoes it.
fn complete(root: &Path) -> Result<(), Error> {
    let placing = placing(root);
    let plan = fs::read_to_string(placing.join(PLAN)).map_err(|source| refused(&placing, source))?;
    let done = plan.lines().try_for_each(|line| {
        let (sign, name) = line.split_at(1);
        let path = root.join(name);
        let moved = match sign {
            "+" => fs::rename(placing.join("new").join(name), &path),
            _ => fs::remove_file(&path),
        };
        // A run that was killed had done it already.
        moved.or_else(missing).map_err(|source| refused(&path, source))
    });
    if done.is_err() {
        plan.lines().for_each(|line| undo(root, &line[1..]));
    }
    // Removed under the name of what the next run removes, since a run may be killed in the midst of it.
    let staged = staged(root);
    let _ = fs::rename(&placing, &staged).and_then(|()| fs::remove_dir_all(&staged));
    done
}

fn missing(error: io::Error) -> io::Result<()> {
    if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) }
}

/// Brings an old file back, or removes a new one that replaced none. An error has to be passed over: the first one is told.
fn undo(root: &Path, name: &str) {
    let (path, placing) = (root.join(name), placing(root));
    let (new, old) = (placing.join("new").join(name), placing.join("old").join(name));
    let was_there = fs::symlink_metadata(&old).is_ok();
    let is_placed = fs::symlink_metadata(&new).is_err();
    let _ = match (was_there, is_placed) {
        (true, _) => fs::rename(&old, &path),
        (false, true) => fs::remove_file(&path),
        (false, false) => Ok(()),
    };
}

/// Completes what a killed run had ready, and removes what it had not.
pub(super) fn recover(root: &Path) {
    // Neither can be told to anybody who could mend it: what cannot be completed is undone, and what lies in `staged` is no
    // part of the results.
    let _ = clear(&staged(root));
    if placing(root).exists() {
        let _ = complete(root);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A directory with files `a` and `b`, and a change of `a`, `b` and `new` that is ready to be placed.
    fn ready() -> tempfile::TempDir {
        let temporary = tempfile::tempdir().expect("a temporary directory");
        let root = temporary.path();
        ["a", "b", "stale"].iter().for_each(|name| fs::write(root.join(name), "old").expect("writable"));
        stage(root, &[("a", b"new"), ("new", b"new"), ("b", b"new")], &["stale".to_owned()]).expect("staged");
        fs::rename(staged(root), placing(root)).expect("renamed");
        temporary
    }

    fn contents(root: &Path) -> [Option<String>; 4] {
        ["a", "b", "new", "stale"].map(|name| fs::read_to_string(root.join(name)).ok())
    }

    fn is(words: [&str; 4]) -> [Option<String>; 4] {
        words.map(|word| (!word.is_empty()).then(|| word.to_owned()))
    }

    // Fails if: what was placed before the error stays, or a file that replaced none does.
    #[test]
    fn an_error_halfway_brings_every_old_file_back() {
        let temporary = ready();
        let root = temporary.path();
        fs::remove_file(root.join("b")).expect("there");
        fs::create_dir_all(root.join("b/full")).expect("created");
        let error = complete(root).expect_err("a directory is in the way").to_string();
        assert!(error.contains("/b: ") && error.contains("move one"), "{error}");
        assert_eq!(contents(root), is(["old", "", "", "old"]));
        assert!(root.join("b/full").is_dir() && !placing(root).exists());
    }

    #[test]
    fn what_a_killed_run_had_ready_is_completed_from_wherever_it_was() {
        for done in 0..=4 {
            let temporary = ready();
            let root = temporary.path();
            for name in ["a", "new", "b"].iter().take(done) {
                fs::rename(placing(root).join("new").join(name), root.join(name)).expect("renamed");
            }
            if done == 4 {
                fs::remove_file(root.join("stale")).expect("there");
            }
            recover(root);
            assert_eq!(contents(root), is(["new", "new", "new", ""]), "{done}");
            assert!(!placing(root).exists());
        }
    }

    #[test]
    fn what_a_killed_run_had_not_ready_is_removed() {
        let temporary = tempfile::tempdir().expect("a temporary directory");
        let root = temporary.path();
        fs::write(root.join("a"), "old").expect("writable");
        stage(root, &[("a", b"new")], &[]).expect("staged");
        recover(root);
        assert_eq!(contents(root), is(["old", "", "", ""]));
        assert!(!staged(root).exists());
    }
}
