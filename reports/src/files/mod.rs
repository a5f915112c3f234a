//! Where results are written: the only part of this crate that touches the disk.
//!
//! ```text
//! OutputDir    many files, all old or all new; one run at a time         <- place, list
//! write_file   one file that a user has named, whole or not at all
//! ```
//!
//! A directory keeps what it needs for this in `.reports` below it: the lock, the list of files that were written, and, while
//! they are put in their places, the new files and the old ones.

mod list;
mod place;
mod single;

use crate::Error;
use list::List;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

pub use single::write_file;

/// The directory of the lock and the list, inside the output directory.
const STATE: &str = ".reports";

/// Held while files are written.
static WRITING: Mutex<()> = Mutex::new(());

fn guard() -> MutexGuard<'static, ()> {
    // It protects no data, so that a panic of its holder is no reason to stop.
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does what ends the program, but not while files are written, which are then all new and have nothing beside them. A handler
/// of SIGINT, SIGTERM and SIGHUP needs no more: `when_written(|| std::process::exit(130))`.
pub fn when_written(then: impl FnOnce()) {
    let _guard = guard();
    then();
}

/// A directory that results are written to, by one run at a time.
#[derive(Clone, Debug)]
pub struct OutputDir {
    root: PathBuf,
    /// Held until the last clone goes, or the process ends in whatever way.
    _lock: Arc<Lock>,
}

#[derive(Debug)]
struct Lock(File);

impl Drop for Lock {
    fn drop(&mut self) {
        // Closing is not enough: a process that is just being started may hold a copy of the file for a moment.
        let _ = self.0.unlock();
    }
}

impl OutputDir {
    /// The directory at `root`, created with its parents where missing, and locked. What a killed run has left is completed
    /// if all its files were ready, and removed if not.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be created or written to; [`Error::Busy`] when another run writes into it.
    pub fn create(root: impl Into<PathBuf>) -> Result<Self, Error> {
        let root = root.into();
        let state = root.join(STATE);
        fs::create_dir_all(&root).map_err(|source| refused(&root, source))?;
        fs::create_dir_all(&state).map_err(|source| refused(&state, source))?;
        let path = state.join("lock");
        let lock = File::options().create(true).truncate(false).write(true).open(&path);
        let lock = lock.map_err(|source| refused(&path, source))?;
        match lock.try_lock() {
            // A file system that knows no locks cannot be helped.
            Err(TryLockError::Error(source)) if source.kind() != io::ErrorKind::Unsupported => {
                return Err(refused(&path, source));
            }
            Err(TryLockError::WouldBlock) => return Err(Error::Busy { path: root }),
            _ => {}
        }
        let _guard = guard();
        place::recover(&root);
        Ok(Self { root, _lock: Arc::new(Lock(lock)) })
    }

    /// The directory itself.
    pub fn path(&self) -> &Path {
        &self.root
    }

    /// Writes one file as [`Self::write_all`] writes several. Gives the path written.
    ///
    /// # Errors
    /// As [`Self::write_all`].
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> Result<PathBuf, Error> {
        self.write_all(&[(name.to_owned(), bytes)])?;
        Ok(self.root.join(name))
    }

    /// Writes files beside those that are there, all of them or none. Names may hold sub-directories, which are created.
    ///
    /// # Errors
    /// [`Error::OutsideOutput`] for a name that leaves the directory; [`Error::Write`] when the disk is full, a directory or a
    /// device is in the place of a file, or the system refuses: then every file is as it was before.
    pub fn write_all<B: AsRef<[u8]>>(&self, files: &[(String, B)]) -> Result<(), Error> {
        self.put(files, None)
    }

    /// Writes files in place of those that `owner` wrote here earlier, all of them or none: what it wrote and does not write
    /// again is removed. Files of other owners and of nobody stay.
    ///
    /// # Errors
    /// As [`Self::write_all`].
    pub fn replace_all<B: AsRef<[u8]>>(&self, owner: &str, files: &[(String, B)]) -> Result<(), Error> {
        self.put(files, Some(owner))
    }

    fn put<B: AsRef<[u8]>>(&self, files: &[(String, B)], owner: Option<&str>) -> Result<(), Error> {
        let _guard = guard();
        let mut list = List::read(&self.root);
        files.iter().try_for_each(|(name, _)| self.check(name))?;
        let stale = list.replace(owner, files.iter().map(|(name, _)| name.as_str()));
        let stale: Vec<String> = stale.into_iter().filter(|name| self.root.join(name).is_file()).collect();
        let text = list.text();
        let listed = (list::NAME, text.as_bytes());
        let files = files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_ref())).chain([listed]);
        place::put(&self.root, &files.collect::<Vec<_>>(), &stale)
    }

    fn check(&self, name: &str) -> Result<(), Error> {
        let relative = Path::new(name);
        let plain = relative.components().all(|part| matches!(part, Component::Normal(part) if part != STATE));
        if !plain || relative.file_name().is_none() || name.ends_with(['/', '\\']) || name.contains(char::is_control) {
            return Err(Error::OutsideOutput { name: name.to_owned(), root: self.root.clone() });
        }
        Ok(())
    }
}

fn refused(path: &Path, source: io::Error) -> Error {
    let remedy = match source.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "free some space or choose another directory",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => "choose a directory you may write to",
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists | io::ErrorKind::IsADirectory => {
            "a file and a directory have the same name: move one, or choose another directory"
        }
        io::ErrorKind::ResourceBusy => "it is a mount point or in use: free it, or choose another directory",
        _ => "check the path, or choose another directory",
    };
    Error::Write { path: path.to_owned(), source, remedy }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;

    fn output() -> (tempfile::TempDir, OutputDir) {
        let temporary = tempfile::tempdir().expect("a temporary directory");
        let output = OutputDir::create(temporary.path().join("a/report")).expect("created");
        (temporary, output)
    }

    /// `/dev/full` takes every open and refuses every write: the device's own 'no space left'.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_reported_as_such() {
        let mut full = File::options().write(true).open("/dev/full").expect("a device");
        let source = full.write_all(&[0_u8; 16]).expect_err("always full");
        let error = refused(Path::new("report/rows.csv"), source);
        assert!(error.to_string().contains("free some space"), "{error}");
    }

    #[test]
    fn names_that_leave_the_directory_are_refused() {
        let (keep, output) = output();
        for name in ["../x.csv", "a/../../x.csv", "/tmp/x.csv", "", ".", "..", "a/..", "a/", ".reports/lock", "a\nb"] {
            let refused = output.write(name, "x");
            assert!(matches!(refused, Err(Error::OutsideOutput { .. })), "'{name}': {refused:?}");
        }
        assert!(!keep.path().join("a/x.csv").exists());
        assert!(output.write("figures/x.svg", "x").expect("a sub-directory").ends_with("a/report/figures/x.svg"));
    }

    #[test]
    fn a_file_in_the_place_of_the_directory_is_explained() {
        let (_keep, output) = output();
        output.write("x", "x").expect("written");
        let error = OutputDir::create(output.path().join("x/y")).expect_err("x is a file");
        assert!(error.to_string().contains("same name"), "{error}");
    }

    #[test]
    fn a_second_run_is_refused_until_the_first_has_ended() {
        let (_keep, output) = output();
        let again = || OutputDir::create(output.path());
        let message = again().expect_err("locked").to_string();
        assert!(message.starts_with("another run is writing into ") && message.contains("a/report; "), "{message}");
        let path = output.path().to_owned();
        drop(output.clone());
        assert!(again().is_err(), "a clone that goes leaves the lock");
        drop(output);
        assert!(OutputDir::create(path).is_ok());
    }
}
