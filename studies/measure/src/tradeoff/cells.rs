//! What the tables of the trade-off share: the runs among the rows, and names.

use super::candidate::Candidate;
use super::{CostMeasure, Part, Row};
use crate::study::distinct;

/// The runs of one scene, with what makes scenes comparable.
pub(super) struct OfScene<'a> {
    pub(super) scene: &'a str,
    pub(super) time_scale_s: f64,
    /// The largest size of the configuration.
    pub(super) scale: f64,
    pub(super) runs: Vec<&'a Row>,
}

/// The scenes among the rows, but for those without a size or a time scale.
pub(super) fn by_scene(rows: &[Row]) -> Vec<OfScene<'_>> {
    let all = runs(rows);
    let one = |scene| {
        let runs: Vec<&Row> = all.iter().copied().filter(|row| row.scene == scene).collect();
        Some(OfScene {
            scene,
            time_scale_s: runs.iter().find_map(|row| row.time_scale_s)?,
            scale: runs.iter().find_map(|row| row.scale).filter(|scale| *scale > 0.0 && scale.is_finite())?,
            runs,
        })
    };
    distinct(all.iter().map(|row| row.scene.as_str())).into_iter().filter_map(one).collect()
}

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
