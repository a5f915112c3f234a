//! Judges a trajectory that another program computed, from its file.

pub mod checks;
pub mod error;
pub mod finding;
pub mod physics;
pub mod read;
pub mod step;
pub mod trajectory;

pub use error::Error;
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
