//! What every study has: a plan, rows, figures and claims.

use reports::{Claim, Figure, Table};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::Error;
use crate::sweep::Progress;
use integrator::methods::MethodId;
use scenes::any::AnyScene;
use scenes::run::Precision;

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
    /// What its binary does, in one line.
    const ABOUT: &'static str = Self::TITLE;
    /// Command lines worth trying, one a line.
    const EXAMPLES: &'static str = Self::ID;
    /// The question it answers.
    const TITLE: &'static str;
    /// How it answers it, for a reader of the report.
    const INTRO: &'static str;

    /// Runs what it needs.
    fn measure(selection: &Selection) -> Vec<Self::Row>;

    /// What follows from the rows, as tables.
    ///
    /// # Errors
    /// A table that has no form as CSV.
    fn tables(rows: &[Self::Row]) -> Result<Vec<Derived>, Error>;

    /// Charts of the rows.
    fn figures(rows: &[Self::Row]) -> Vec<Figure>;

    /// Whether a figure stands on the page itself; the others are files that the page links to.
    fn is_on_page(figure: &Figure) -> bool {
        let _ = figure;
        true
    }

    /// What the rows show, against theory.
    fn claims(rows: &[Self::Row]) -> Vec<Claim>;
}

/// A table that follows from the rows of a study.
#[derive(Clone, Debug)]
pub struct Derived {
    /// Name of its CSV, without the ending.
    pub name: &'static str,
    /// What it shows.
    pub caption: &'static str,
    /// All of it, as CSV.
    pub csv: String,
    /// What a reader is shown of it.
    pub table: Table,
}

/// A number for a reader: four digits, and a power of ten where it needs one.
pub fn short(x: Option<f64>) -> String {
    match x {
        None => "–".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(x) if !x.is_finite() => x.to_string(),
        Some(x) if (1e-3..1e5).contains(&x.abs()) => {
            let digits = (3 - x.abs().log10().floor() as i32).max(0) as usize;
            format!("{x:.digits$}")
        }
        Some(x) => format!("{x:.3e}"),
    }
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
