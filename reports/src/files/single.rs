//! One file at a path that a user has given.

use super::{guard, refused};
use crate::Error;
use std::ffi::OsString;
use std::fs::{self, File, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes a file whole or not at all, with its directories where missing. A link is followed, and the file it leads to is
/// written; a file that is there keeps its mode. Gives the path written.
///
/// # Errors
/// [`Error::NotAFile`] for a directory, a device, a pipe or a socket; [`Error::Write`] when the system refuses: then a file that
/// was there before is untouched.
pub fn write_file(path: &Path, bytes: impl AsRef<[u8]>) -> Result<PathBuf, Error> {
    let _guard = guard();
    let target = target(path).map_err(|source| refused(path, source))?;
    let mode = match fs::metadata(&target) {
        Ok(found) if found.is_file() => Some(found.permissions()),
        Ok(found) => {
            return Err(Error::NotAFile {
                path: path.to_owned(),
                found: if found.is_dir() { "a directory" } else { "no regular file" },
            });
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(source) => return Err(refused(path, source)),
    };
    let Some(name) = target.file_name() else {
        return Err(Error::NotAFile { path: path.to_owned(), found: "no name of a file" });
    };
    let directory = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(directory).map_err(|source| refused(directory, source))?;
    sweep(directory, name.as_encoded_bytes());
    let beside = directory.join(beside(name.to_owned()));
    let written = fill(&beside, bytes.as_ref(), mode).and_then(|_locked| fs::rename(&beside, &target));
    written.map_err(|source| {
        let _ = fs::remove_file(&beside);
        refused(path, source)
    })?;
    Ok(target)
}

/// The name of the file while it is written: hidden, with the number of this process.
fn beside(name: OsString) -> OsString {
    let mut hidden = OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}.part", std::process::id()));
    hidden
}

/// The new file, flushed; it is locked until it is in its place, by which a run tells it from what a killed one has left.
fn fill(path: &Path, bytes: &[u8], mode: Option<Permissions>) -> io::Result<File> {
    let mut file = File::create(path)?;
    // Where there are no locks, nothing is swept either.
    let _ = file.try_lock();
    file.write_all(bytes)?;
    if let Some(mode) = mode {
        file.set_permissions(mode)?;
    }
    file.sync_all()?;
    Ok(file)
}

/// Where a path leads by links; the last one may lead to a file that is not there yet.
fn target(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    // As many links as Linux follows.
    for _ in 0..40 {
        match fs::read_link(&path) {
            Ok(to) => path = path.parent().unwrap_or(Path::new("")).join(to),
            // No link: the file itself, or nothing yet.
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("the links go round in a circle"))
}

/// Removes what killed runs have left of this file.
fn sweep(directory: &Path, name: &[u8]) {
    for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
        let found = entry.file_name();
        let rest = found.as_encoded_bytes().strip_prefix(b".").and_then(|rest| rest.strip_prefix(name));
        let process = rest.and_then(|rest| rest.strip_prefix(b".")?.strip_suffix(b".part"));
        if process.is_some_and(|digits| !digits.is_empty() && digits.iter().all(u8::is_ascii_digit)) {
            let is_left = File::options().write(true).open(entry.path()).is_ok_and(|file| file.try_lock().is_ok());
            if is_left {
                // A leftover that cannot be removed does no harm.
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let entries = fs::read_dir(directory).expect("listed");
        let mut names: Vec<_> =
            entries.map(|entry| entry.expect("entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_made_with_its_directories_and_replaced_whole() {
        let keep = tempfile::tempdir().expect("a temporary directory");
        let path = keep.path().join("a/b/rows.csv");
        for text in ["long text", "new"] {
            assert_eq!(write_file(&path, text).expect("written"), path);
            assert_eq!(fs::read_to_string(&path).expect("read"), text);
        }
        assert_eq!(names(&keep.path().join("a/b")), ["rows.csv"]);
    }

    // Fails if: the link is replaced, or one that leads to nothing yet is taken for a name.
    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_its_file_keeps_its_mode() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let keep = tempfile::tempdir().expect("a temporary directory");
        let at = |name: &str| keep.path().join(name);
        fs::create_dir(at("real")).expect("created");
        fs::write(at("real/rows.csv"), "old").expect("writable");
        fs::set_permissions(at("real/rows.csv"), Permissions::from_mode(0o640)).expect("mode");
        symlink("real/rows.csv", at("one")).expect("linked");
        symlink("one", at("two")).expect("linked");
        symlink("real/later.csv", at("dangling")).expect("linked");
        write_file(&at("two"), "new").expect("written");
        write_file(&at("dangling"), "new").expect("written");
        let is_link = |name| fs::symlink_metadata(at(name)).expect("there").is_symlink();
        assert!(["one", "two", "dangling"].into_iter().all(is_link));
        assert_eq!(fs::read_to_string(at("real/rows.csv")).expect("read"), "new");
        assert_eq!(fs::metadata(at("real/rows.csv")).expect("there").permissions().mode() & 0o777, 0o640);
        assert_eq!(names(&at("real")), ["later.csv", "rows.csv"]);
        symlink("round", at("round")).expect("linked");
        assert!(write_file(&at("round"), "new").expect_err("endless").to_string().contains("circle"));
    }

    // No device of the machine is named here: a fault of the code would replace it.
    #[cfg(target_os = "linux")]
    #[test]
    fn what_is_no_regular_file_is_refused_and_untouched() {
        let keep = tempfile::tempdir().expect("a temporary directory");
        let at = |name: &str| keep.path().join(name);
        let make = |program: &str, name: &str, kind: &[&str]| {
            std::process::Command::new(program)
                .arg(at(name))
                .args(kind)
                .output()
                .is_ok_and(|made| made.status.success())
        };
        assert!(make("mkfifo", "pipe", &[]));
        let _socket = std::os::unix::net::UnixListener::bind(at("socket")).expect("bound");
        std::os::unix::fs::symlink("pipe", at("link")).expect("linked");
        fs::create_dir(at("directory")).expect("created");
        // Only root may make one.
        let device = make("mknod", "full", &["c", "1", "7"]).then_some("full");
        let kinds = ["pipe", "socket", "link", "directory"].into_iter().chain(device);
        let before = names(keep.path());
        for path in kinds.map(at).chain([PathBuf::from("/")]) {
            let error = write_file(&path, "new").expect_err("no file").to_string();
            assert!(
                error.contains(&path.display().to_string()) && error.contains("give the name of a file"),
                "{error}"
            );
        }
        assert_eq!(names(keep.path()), before);
        assert!(fs::symlink_metadata(at("link")).expect("there").is_symlink());
    }

    // Fails if: what another run is writing is swept, or a file with a name like it.
    #[test]
    fn what_a_killed_run_left_is_swept_and_nothing_else() {
        let keep = tempfile::tempdir().expect("a temporary directory");
        let others =
            [".rows.csv..part", ".rows.csv.7x.part", ".other.csv.7.part", "rows.csv.7.part", ".rows.csv.8.part"];
        for name in others.iter().chain([&".rows.csv.7.part"]) {
            fs::write(keep.path().join(name), "half of the").expect("writable");
        }
        let live = File::open(keep.path().join(".rows.csv.8.part")).expect("there");
        live.try_lock().expect("free");
        write_file(&keep.path().join("rows.csv"), "whole").expect("written");
        let mut expected: Vec<&str> = others.into_iter().chain(["rows.csv"]).collect();
        expected.sort_unstable();
        assert_eq!(names(keep.path()), expected);
    }
}
