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
