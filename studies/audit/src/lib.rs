//! Judges a trajectory that another program computed, from its file: how wrong it is, which law is broken, which step
//! computed it.
//!
//! [`read`] makes a table of a text file, [`trajectory`] makes a motion of the table and says why each column was read as it
//! was, [`checks`] ask one question each, [`step`] tries every known step on every row, [`run`] does all of it.
//!
//! Architecture invariants: no guess is silent, a tie is reported as a tie; nothing panics on a file.

pub mod checks;
pub mod cli;
pub mod clock;
pub mod error;
pub mod exact;
pub mod finding;
pub mod judge;
pub mod order;
pub mod physics;
pub mod read;
pub mod report;
pub mod step;
pub mod subject;
pub mod trajectory;

pub use error::Error;
pub use judge::{Args, FileReport, judge};
pub use report::Report;
pub use trajectory::{Choices, Trajectory};

use std::path::Path;

/// Reads a file as a trajectory.
///
/// # Errors
/// A file that is no table, or whose columns are no trajectory.
pub fn load(path: &Path, choices: &Choices) -> Result<Trajectory, Error> {
    let table = read::read(path, choices.columns.as_deref(), choices.rows.unwrap_or(usize::MAX))?;
    trajectory::of_table(&table, choices)
}

/// Judges every file.
///
/// # Errors
/// The first file that cannot be read, or a flag that cannot be used.
pub fn run(args: &Args) -> Result<Report, Error> {
    let files: Vec<FileReport> = args.files.iter().map(|path| judge(path, args)).collect::<Result<_, _>>()?;
    let order = order::orders(&files);
    Ok(Report { files, order })
}
