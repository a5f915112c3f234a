//! Rows as CSV, and small tables as text, Markdown and HTML.

use crate::Error;
use serde::{Serialize, de::DeserializeOwned};

/// Rows as CSV with a header. A field is written so that reading it gives the same value back.
///
/// # Errors
/// [`Error::Rows`] when a row has no flat form.
pub fn write_csv<R: Serialize>(rows: &[R]) -> Result<String, Error> {
    let refuse = |message: String| Error::Rows { message };
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(|e| refuse(e.to_string()))?;
    }
    let bytes = writer.into_inner().map_err(|e| refuse(e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| refuse(e.to_string()))
}

/// The rows of a CSV text with a header; `place` is the file it came from, for errors.
///
/// # Errors
/// [`Error::Csv`] with line and column.
pub fn read_csv<R: DeserializeOwned>(text: &str, place: &str) -> Result<Vec<R>, Error> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.deserialize().map(|row| row.map_err(|e| locate(&e, place))).collect()
}

fn locate(error: &csv::Error, place: &str) -> Error {
    let line = error.position().map_or(0, csv::Position::line);
    let column = match error.kind() {
        csv::ErrorKind::Deserialize { err, .. } => err.field().map_or(0, |field| field + 1),
        _ => 0,
    };
    let message = match error.kind() {
        csv::ErrorKind::Deserialize { err, .. } => err.kind().to_string(),
        _ => error.to_string(),
    };
    Error::Csv { place: place.to_owned(), line, column, message }
}

/// How a column is set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Words.
    #[default]
    Left,
    /// Numbers.
    Right,
}

/// A small table of texts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Column headings, each with its unit.
    pub headers: Vec<String>,
    /// How each column is set; `Left` where missing.
    pub align: Vec<Align>,
    /// Rows; a missing cell is empty.
    pub rows: Vec<Vec<String>>,
}
