//! The tables of function values in `tests/data/special`.

use std::path::PathBuf;

use faer::fx128;

use crate::decimal::parse_fx128;

/// One line: the function's name (empty where the table is of one function), and the numbers.
#[derive(Clone, Debug)]
pub struct Entry {
    /// First column, if it is not a number.
    pub function: String,
    /// Arguments (IEEE doubles) and values (36 digits) in the order of the columns.
    pub numbers: Vec<fx128>,
    /// The numbers as IEEE doubles, exact for arguments.
    pub arguments: Vec<f64>,
}

/// All lines of `tests/data/special/{name}.csv`.
///
/// # Panics
/// If the table is missing, malformed or empty.
pub fn load(name: &str) -> Vec<Entry> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("data/special/{name}.csv"));
    let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let named = reader.headers().expect("a header").get(0) == Some("function");
    let entries: Vec<Entry> = reader
        .records()
        .map(|record| {
            let record = record.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            let fields = || record.iter().skip(usize::from(named));
            Entry {
                function: if named { record[0].to_owned() } else { String::new() },
                numbers: fields().map(parse_fx128).collect(),
                arguments: fields().map(|x| x.parse().expect("a number")).collect(),
            }
        })
        .collect();
    assert!(!entries.is_empty(), "{} is empty", path.display());
    entries
}
