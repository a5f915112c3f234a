//! The files of a study's rows: each file holds rows of one kind, with the columns that this kind has.
//!
//! A study of one kind of row writes `STUDY.csv`. A study of several kinds writes `STUDY.KIND.csv` for each kind of which
//! there are rows. The column `part` is then the file's name and stands in no record.

use reports::{columns_of_csv, read_csv_with, write_csv};

use crate::study::{Kind, Study};

/// The column that the name of a file stands for.
const PART: &str = "part";

/// A file of rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowFile {
    /// Its name.
    pub name: String,
    kind: Option<&'static Kind>,
}

/// The files that a study can write, in the order of their rows.
pub fn of<S: Study>() -> Vec<RowFile> {
    if S::KINDS.is_empty() {
        return vec![RowFile { name: format!("{}.csv", S::ID), kind: None }];
    }
    S::KINDS.iter().map(|kind| RowFile { name: format!("{}.{}.csv", S::ID, kind.part), kind: Some(kind) }).collect()
}

/// The rows with those of one kind together, kinds in the order of their files.
pub fn in_order<S: Study>(mut rows: Vec<S::Row>) -> Vec<S::Row> {
    rows.sort_by_key(|row| place::<S>(row));
    rows
}

fn place<S: Study>(row: &S::Row) -> usize {
    S::KINDS.iter().position(|kind| kind.part == S::part(row)).unwrap_or(0)
}

/// Name and content of each file of these rows. A kind without rows has no file.
///
/// # Errors
/// Rows that have no form as CSV.
pub fn write<S: Study>(rows: &[S::Row]) -> Result<Vec<(String, String)>, reports::Error> {
    let mut files = Vec::new();
    for (index, file) in of::<S>().into_iter().enumerate() {
        let Some(kind) = file.kind else {
            files.push((file.name, write_csv(rows)?));
            continue;
        };
        let own: Vec<S::Row> = rows.iter().filter(|row| place::<S>(row) == index).cloned().collect();
        if !own.is_empty() {
            files.push((file.name, columns_of_csv(&write_csv(&own)?, &columns(kind))?));
        }
    }
    Ok(files)
}

fn columns(kind: &Kind) -> Vec<&'static str> {
    kind.columns.split(',').map(str::trim).collect()
}

impl RowFile {
    /// The rows in the text of this file; `place` is where it came from, for errors.
    ///
    /// # Errors
    /// As [`reports::read_csv`].
    pub fn read<S: Study>(&self, text: &str, place: &str) -> Result<Vec<S::Row>, reports::Error> {
        let part: Vec<(&str, &str)> = self.kind.map(|kind| (PART, kind.part)).into_iter().collect();
        read_csv_with(text, place, &part)
    }

    /// The header that the file of these rows has.
    ///
    /// # Errors
    /// Rows that have no form as CSV.
    pub fn header<S: Study>(&self, rows: &[S::Row]) -> Result<String, reports::Error> {
        if let Some(kind) = self.kind {
            return Ok(columns(kind).join(","));
        }
        let text = write_csv(&rows[..rows.len().min(1)])?;
        Ok(text.lines().next().unwrap_or_default().to_owned())
    }
}
