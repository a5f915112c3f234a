//! What can go wrong while showing results: the place, what was expected there, and what to do about it.

use std::path::PathBuf;

/// Every error of this crate.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file or directory could not be written; whatever stood at `path` before is untouched.
    #[error("cannot write {}: {source}; {remedy}", path.display())]
    Write {
        /// The file or directory that was to be written.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
        /// What to do about it.
        remedy: &'static str,
    },
    /// Another process has the lock of an output directory.
    #[error("another run is writing into {}; wait until it has ended, or choose another directory", path.display())]
    Busy {
        /// The directory.
        path: PathBuf,
    },
    /// A path that was given for a file and leads to something else.
    #[error("cannot write {}: it is {found}; give the name of a file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
        /// What is there.
        found: &'static str,
    },
    /// A file name that would leave the output directory, or that names no file.
    #[error("'{name}' is not a name inside {}: give a relative path without '..'", root.display())]
    OutsideOutput {
        /// The name asked for.
        name: String,
        /// The output directory.
        root: PathBuf,
    },
    /// A CSV text that cannot be read as the rows asked for.
    #[error("{place}:{line}:{column}: {message}; correct it, or have the file written anew")]
    Csv {
        /// The file the text came from.
        place: String,
        /// Line, from 1 (the header is line 1).
        line: u64,
        /// Column (field), from 1; 0 when the whole line is meant.
        column: u64,
        /// What was found and what was expected.
        message: String,
    },
    /// Rows that have no form as CSV.
    #[error("rows cannot be written as CSV: {message}")]
    Rows {
        /// What the writer said.
        message: String,
    },
    /// A figure whose data contradict themselves.
    #[error("figure '{figure}', {place}: {message}")]
    Figure {
        /// The figure's id.
        figure: String,
        /// The layer or axis.
        place: String,
        /// What was found and what was expected.
        message: String,
    },
    /// A drawing that cannot be made a PNG.
    #[error("figure '{figure}' cannot be drawn: {message}")]
    Drawing {
        /// The figure's id.
        figure: String,
        /// What the library said.
        message: String,
    },
    /// A formula that cannot be typeset.
    #[error("formula '{latex}': {message}")]
    Formula {
        /// The formula.
        latex: String,
        /// What cannot be read, and where.
        message: String,
    },
    /// A page that refers to something it does not hold.
    #[error("page, {place}: {message}")]
    Page {
        /// The finding, section or block.
        place: String,
        /// What was found and what was expected.
        message: String,
    },
}
