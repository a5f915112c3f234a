//! The output directory: the only place of this crate that writes.

use crate::Error;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Held while files are written.
static WRITING: Mutex<()> = Mutex::new(());

fn guard() -> MutexGuard<'static, ()> {
    // It protects no data, so that a panic of its holder is no reason to stop.
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does what ends the program, but not while files are written: with [`OutputDir::write_all`] they are all old or all new.
pub fn when_written(then: impl FnOnce()) {
    let _guard = guard();
    then();
}

/// A directory that results are written to.
#[derive(Clone, Debug)]
pub struct OutputDir {
    root: PathBuf,
}

impl OutputDir {
    /// The directory at `root`, created with its parents where missing.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be created.
    pub fn create(root: impl Into<PathBuf>) -> Result<Self, Error> {
        let root = root.into();
        fs::create_dir_all(&root).map_err(|source| refused(&root, source))?;
        Ok(Self { root })
    }

    /// The directory itself.
    pub fn path(&self) -> &Path {
        &self.root
    }

    /// Writes a file whole or not at all: beside its place first, flushed to the disk, then renamed over it.
    /// `name` may hold sub-directories, which are created. Gives the path written.
    ///
    /// # Errors
    /// [`Error::OutsideOutput`] for a name that leaves the directory; [`Error::Write`] when the disk is full or
    /// refuses, in which case a file that stood there before is untouched.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> Result<PathBuf, Error> {
        self.write_with(name, |file| file.write_all(bytes.as_ref()))
    }

    /// Writes several files, all or none: every one beside its place and flushed, and only then each renamed over it, so that
    /// a disk that fills up leaves what stood there before.
    ///
    /// # Errors
    /// As [`Self::write`]; of what is written until then nothing is left.
    pub fn write_all<B: AsRef<[u8]>>(&self, files: &[(String, B)]) -> Result<(), Error> {
        let _guard = guard();
        let mut staged = Vec::with_capacity(files.len());
        for (name, bytes) in files {
            match self.stage(name, |file| file.write_all(bytes.as_ref())) {
                Ok(pair) => staged.push(pair),
                Err(error) => {
                    for (beside, _) in &staged {
                        let _ = fs::remove_file(beside);
                    }
                    return Err(error);
                }
            }
        }
        staged
            .iter()
            .try_for_each(|(beside, path)| fs::rename(beside, path).map_err(|source| refused(path, source)))?;
        self.sweep();
        Ok(())
    }

    /// Removes what programs that were killed have left beside their files. Whether a program still runs is asked of
    /// `/proc`; where there is none, nothing is removed.
    fn sweep(&self) {
        if !Path::new("/proc/self").exists() {
            return;
        }
        for entry in fs::read_dir(&self.root).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let parts = name.to_str().and_then(|name| name.strip_prefix('.')?.strip_suffix(".part")?.rsplit_once('.'));
            let process = parts.and_then(|(_, process)| process.parse::<u32>().ok());
            if process.is_some_and(|process| !Path::new(&format!("/proc/{process}")).exists()) {
                // A leftover that cannot be removed does no harm.
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    fn write_with(&self, name: &str, fill: impl FnOnce(&mut File) -> io::Result<()>) -> Result<PathBuf, Error> {
        let (beside, path) = self.stage(name, fill)?;
        fs::rename(&beside, &path).map_err(|source| {
            let _ = fs::remove_file(&beside);
            refused(&path, source)
        })?;
        Ok(path)
    }

    /// The file beside its place, whole and on the disk, and its place.
    fn stage(&self, name: &str, fill: impl FnOnce(&mut File) -> io::Result<()>) -> Result<(PathBuf, PathBuf), Error> {
        let path = self.inside(name)?;
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|source| refused(parent, source))?;
        }
        let beside = beside(&path);
        let written = File::create(&beside).and_then(|mut file| fill(&mut file).and_then(|()| file.sync_all()));
        written.map_err(|source| {
            // The half-written file is of no use; that it may be left over is the lesser trouble to report.
            let _ = fs::remove_file(&beside);
            refused(&path, source)
        })?;
        Ok((beside, path))
    }

    fn inside(&self, name: &str) -> Result<PathBuf, Error> {
        let relative = Path::new(name);
        let plain = relative.components().all(|part| matches!(part, Component::Normal(_)));
        if !plain || relative.file_name().is_none() || name.ends_with(['/', '\\']) {
            return Err(Error::OutsideOutput { name: name.to_owned(), root: self.root.clone() });
        }
        Ok(self.root.join(relative))
    }
}

/// The name written first. The process id keeps two programs that write the same report apart.
fn beside(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}

fn refused(path: &Path, source: io::Error) -> Error {
    let remedy = match source.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "free some space or choose another directory",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => "choose a directory you may write to",
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists | io::ErrorKind::IsADirectory => {
            "a file and a directory have the same name: move one, or choose another directory"
        }
        _ => "check the path, or choose another directory",
    };
    Error::Write { path: path.to_owned(), source, remedy }
}

#[cfg(test)]
mod tests {
    use super::*;

    // Fails if: files are renamed as they are written, or a staged file is left behind.
    #[test]
    fn of_several_files_all_are_written_or_none() {
        let (_temporary, output) = output();
        output.write("first", "old").expect("written");
        let good = [("first".to_owned(), "new"), ("second".to_owned(), "new")];
        let bad = [("first".to_owned(), "new"), ("../escape".to_owned(), "new")];
        assert!(output.write_all(&bad).is_err());
        assert_eq!(fs::read_to_string(output.path().join("first")).expect("still there"), "old");
        assert_eq!(fs::read_dir(output.path()).expect("a directory").count(), 1, "nothing is left beside");
        output.write_all(&good).expect("written");
        assert_eq!(fs::read_to_string(output.path().join("first")).expect("written"), "new");
        assert_eq!(fs::read_dir(output.path()).expect("a directory").count(), 2);
    }

    // Fails if: the sweep takes another program's files, or a file of the report with a name like it.
    #[cfg(target_os = "linux")]
    #[test]
    fn what_a_killed_program_left_is_swept_and_nothing_else() {
        let (_keep, output) = output();
        // No process has this number: it is above the greatest that Linux gives, 2^22. The first process always runs.
        let dead = ".rows.csv.4294967295.part";
        let others = [".rows.csv.1.part", ".rows.csv.part", "rows.4294967295.part", ".rows.4294967295"];
        for name in others.iter().chain([&dead]) {
            fs::write(output.path().join(name), "half of the").expect("writable");
        }
        output.write_all(&[("rows.csv".to_owned(), "whole")]).expect("written");
        let mut left = names(&output);
        left.sort();
        let mut expected: Vec<String> = others.iter().chain([&"rows.csv"]).map(|&name| name.to_owned()).collect();
        expected.sort();
        assert_eq!(left, expected);
    }

    fn output() -> (tempfile::TempDir, OutputDir) {
        let temporary = tempfile::tempdir().expect("a temporary directory");
        let output = OutputDir::create(temporary.path().join("a/report")).expect("created");
        (temporary, output)
    }

    fn names(output: &OutputDir) -> Vec<String> {
        let entries = fs::read_dir(output.path()).expect("listed");
        entries.map(|entry| entry.expect("entry").file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn a_file_is_replaced_and_nothing_else_is_left() {
        let (_keep, output) = output();
        output.write("rows.csv", "old").expect("written");
        let path = output.write("rows.csv", "new").expect("written");
        assert_eq!(fs::read_to_string(path).expect("read"), "new");
        assert_eq!(names(&output), ["rows.csv"]);
    }

    #[test]
    fn a_failed_write_leaves_the_earlier_file_as_it_was() {
        let (_keep, output) = output();
        output.write("rows.csv", "earlier").expect("written");
        let full = |file: &mut File| {
            file.write_all(b"half of the")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        };
        let error = output.write_with("rows.csv", full).expect_err("the disk is full");
        assert!(error.to_string().contains("rows.csv") && error.to_string().contains("free some space"), "{error}");
        assert_eq!(fs::read_to_string(output.path().join("rows.csv")).expect("read"), "earlier");
        assert_eq!(names(&output), ["rows.csv"]);
    }

    /// `/dev/full` takes every open and refuses every write: the device's own 'no space left'.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_reported_as_such() {
        let source = fs::write("/dev/full", [0_u8; 16]).expect_err("always full");
        let error = refused(Path::new("report/rows.csv"), source);
        assert!(error.to_string().contains("free some space"), "{error}");
    }

    #[test]
    fn names_that_leave_the_directory_are_refused() {
        let (keep, output) = output();
        for name in ["../x.csv", "a/../../x.csv", "/tmp/x.csv", "", ".", "..", "a/..", "a/"] {
            let refused = output.write(name, "x");
            assert!(matches!(refused, Err(Error::OutsideOutput { .. })), "'{name}': {refused:?}");
        }
        assert!(!keep.path().join("a/x.csv").exists() && names(&output).is_empty());
        assert!(output.write("figures/x.svg", "x").expect("a sub-directory").ends_with("a/report/figures/x.svg"));
    }

    #[test]
    fn a_file_in_the_place_of_the_directory_is_explained() {
        let (keep, output) = output();
        output.write("x", "x").expect("written");
        let error = OutputDir::create(output.path().join("x/y")).expect_err("x is a file");
        assert!(error.to_string().contains("same name"), "{error}");
        drop(keep);
    }
}
