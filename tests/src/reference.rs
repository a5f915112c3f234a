//! The reference solutions in `tests/data/reference`: 30 digits, settings and conventions in its `cases.json`.

use std::fs;
use std::path::PathBuf;

use faer::fx128;
use serde_json::Value;

use crate::decimal::parse_fx128;

/// One setting of one case with its tabulated solution.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The setting's parameters, all IEEE doubles.
    pub params: Value,
    /// Names of the columns after the time.
    pub columns: Vec<String>,
    /// The tabulated times, in order.
    pub rows: Vec<Row>,
}

/// The solution at one time.
#[derive(Clone, Debug)]
pub struct Row {
    /// Time in s, an exact double.
    pub t: f64,
    /// The values of the columns.
    pub values: Vec<fx128>,
}

impl Reference {
    /// A parameter that is a number.
    pub fn number(&self, name: &str) -> f64 {
        self.params[name].as_f64().unwrap_or_else(|| panic!("no number {name:?} in {}", self.params))
    }

    /// A parameter that is an array of N numbers.
    pub fn vector<const N: usize>(&self, name: &str) -> [f64; N] {
        std::array::from_fn(|i| {
            self.params[name][i].as_f64().unwrap_or_else(|| panic!("no {name}[{i}]: {}", self.params))
        })
    }

    /// The N columns from `first` on, in one row.
    pub fn values<const N: usize>(&self, row: &Row, first: &str) -> [fx128; N] {
        let start = self.columns.iter().position(|c| c == first).unwrap_or_else(|| panic!("no column {first:?}"));
        std::array::from_fn(|i| row.values[start + i])
    }
}

/// The names of all sets of a case, in the order of `cases.json`.
pub fn sets(case: &str) -> Vec<String> {
    let of_case = |set: &&Value| set["case"] == case;
    let name = |set: &Value| set["set"].as_str().expect("a set has a name").to_owned();
    cases().iter().filter(of_case).map(name).collect()
}

/// The settings and the table of one set.
///
/// # Panics
/// If there is no such set, or its table is malformed or empty.
pub fn load(case: &str, set: &str) -> Reference {
    let all = cases();
    let found = all.iter().find(|entry| entry["case"] == case && entry["set"] == set);
    let entry = found.unwrap_or_else(|| panic!("no set {set:?} of case {case:?} in cases.json"));
    let path = directory().join(entry["file"].as_str().expect("a set names its file"));
    let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let columns = reader.headers().expect("a header").iter().skip(2).map(str::to_owned).collect();
    let records = reader.records().map(|r| r.unwrap_or_else(|e| panic!("{}: {e}", path.display())));
    let rows: Vec<Row> = records
        .filter(|record| &record[0] == set)
        .map(|record| Row {
            t: record[1].parse().expect("a time"),
            values: record.iter().skip(2).map(parse_fx128).collect(),
        })
        .collect();
    assert!(!rows.is_empty(), "{} has no rows of {set:?}", path.display());
    Reference { params: entry["params"].clone(), columns, rows }
}

fn directory() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data/reference")
}

fn cases() -> Vec<Value> {
    let path = directory().join("cases.json");
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let cases: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    cases["sets"].as_array().expect("cases.json lists its sets").clone()
}
