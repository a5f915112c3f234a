//! What can go wrong before a file can be judged: each error names its place and its remedy.

use std::path::{Path, PathBuf};

/// Every error of this crate.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file that cannot be opened, read or written.
    #[error("{}: {source}; check the path and its permissions", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file that is no table of numbers.
    #[error("{}:{line}:{column}: {message}; {remedy}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The column of the table, counted from 1.
        column: usize,
        /// What is wrong there.
        message: String,
        /// What to do.
        remedy: String,
    },
    /// A flag whose value cannot be used.
    #[error("{flag}: {message}")]
    Flag {
        /// The flag.
        flag: &'static str,
        /// What is wrong with it, and what to give instead.
        message: String,
    },
}

impl Error {
    /// An error at one cell.
    pub(crate) fn at(
        path: &Path,
        line: usize,
        column: usize,
        message: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Error::Table { path: path.to_owned(), line, column, message: message.into(), remedy: remedy.into() }
    }

    /// An error of a flag.
    pub(crate) fn flag(flag: &'static str, message: impl Into<String>) -> Self {
        Error::Flag { flag, message: message.into() }
    }
}
