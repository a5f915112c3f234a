//! From a file to a table of numbers: dialect, rows, the digits that were printed.

mod dialect;
pub mod names;
mod rows;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

pub use dialect::{Dialect, Separator};
pub use rows::Digits;

use crate::error::Error;

/// A table of numbers, column by column: eight bytes a number.
#[derive(Clone, Debug)]
pub struct Table {
    /// Where it was read.
    pub path: PathBuf,
    /// How it is written.
    pub dialect: Dialect,
    /// The columns.
    pub columns: Vec<Column>,
    /// The line of each row is this plus the number of the row, where no line between rows is blank or a comment.
    pub first_line: usize,
}

/// One column of a table.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its name; `column N` without a header.
    pub name: String,
    /// The unit in a line of units.
    pub unit: Option<String>,
    /// Its numbers, less `origin`; empty for a column of text.
    pub values: Vec<f64>,
    /// A whole number that was taken off every value, so that a stamp of nineteen digits keeps its last ones.
    pub origin: i64,
    /// The digits with which it was printed.
    pub digits: Digits,
}

impl Column {
    /// Whether it holds numbers.
    pub fn is_numeric(&self) -> bool {
        !self.values.is_empty()
    }
}

/// Bytes of the beginning of a file from which its dialect is found.
const HEAD: u64 = 256 * 1024;

/// Reads a table.
///
/// # Errors
/// A file that cannot be read, is no table, or has a broken row; with line and column.
pub fn read(path: &Path, names_given: Option<&[String]>, most_rows: usize) -> Result<Table, Error> {
    let io = |source| Error::File { path: path.to_owned(), source };
    let mut file = File::open(path).map_err(io)?;
    let mut head = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut head).map_err(io)?;
    let whole = (head.len() as u64) < HEAD;
    rows::refuse_long_line(path, &head, 1)?;
    let mut dialect = dialect::find(path, &head, whole)?;
    if let Some(names) = names_given {
        if names.len() != dialect.cells {
            let message = format!(
                "{} names are given and {} has {} columns; give one for each, - for a column to be left out",
                names.len(),
                path.display(),
                dialect.cells
            );
            return Err(Error::flag("--columns", message));
        }
        dialect.names = names.to_vec();
    }
    let start = head.len() - dialect::without_bom(&head).len();
    rows::read(path, dialect, (&head[start..]).chain(file), most_rows)
}
