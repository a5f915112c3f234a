//! What every study has: a plan, rows, figures and claims.

use reports::{Claim, Figure};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::run::Precision;
use crate::scene::AnyScene;
use crate::sweep::Progress;
use integrator::methods::MethodId;

/// What to look at, for every study.
pub struct Selection {
    /// The scenes, with their parameters set.
    pub scenes: Vec<Box<dyn AnyScene>>,
    /// The methods.
    pub methods: Vec<MethodId>,
    /// The precisions.
    pub precisions: Vec<Precision>,
    /// The numbers of steps of a sweep; empty for the halvings that each scene suggests.
    pub steps: Vec<u64>,
    /// Fewer and shorter runs.
    pub quick: bool,
    /// The bar to be shown.
    pub progress: Progress,
}

/// One question, from the runs to the verdicts. Everything after [`Study::measure`] can start from the CSV of its rows.
pub trait Study {
    /// One line of its CSV.
    type Row: Serialize + DeserializeOwned + Clone;

    /// The name: of the binary, and of the CSV.
    const ID: &'static str;

    /// Runs what it needs.
    fn measure(selection: &Selection) -> Vec<Self::Row>;

    /// Charts of the rows.
    fn figures(rows: &[Self::Row]) -> Vec<Figure>;

    /// What the rows show, against theory.
    fn claims(rows: &[Self::Row]) -> Vec<Claim>;
}

/// The palette index of a method: the same in every chart.
pub fn color_of(method: MethodId) -> usize {
    MethodId::ALL.iter().position(|m| *m == method).unwrap_or(0)
}

/// The command that makes a figure of one scene again.
pub fn command(study: &str, scene: &str) -> String {
    format!("cargo run --release --bin {study} -- --scene {scene}")
}

/// The different values, in the order in which they first appear.
pub fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut seen = Vec::new();
    for value in values {
        if !seen.contains(&value) {
            seen.push(value);
        }
    }
    seen
}
