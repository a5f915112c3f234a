//! What the tables of the trade-off share: the runs among the rows, and names.

use super::candidate::Candidate;
use super::{CostMeasure, Part, Row};

pub(super) fn runs(rows: &[Row]) -> Vec<&Row> {
    rows.iter().filter(|row| row.part == Part::Run).collect()
}

pub(super) fn label(method: &str) -> String {
    Candidate::from_id(method).map_or_else(|| method.to_owned(), Candidate::label)
}

pub(super) fn cost_measure_name(charge: CostMeasure) -> &'static str {
    match charge {
        CostMeasure::Evaluations => "evaluations",
        CostMeasure::Time => "time",
    }
}
