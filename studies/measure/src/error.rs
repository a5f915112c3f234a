//! What can go wrong in a study: wrong input, or a result that has no form.

/// Every error of this crate.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Wrong input, with its place and its remedy.
    #[error(transparent)]
    Input(#[from] scenes::error::Error),
    /// A result that cannot be shown or written.
    #[error(transparent)]
    Report(#[from] reports::Error),
}

impl Error {
    /// The error at a place of the input, with what was found there and what would be right.
    pub fn plan(place: impl Into<String>, message: impl Into<String>) -> Self {
        Error::Input(scenes::error::Error::plan(place, message))
    }

    /// The error for a name that is not among `known`.
    pub fn unknown(kind: &'static str, name: &str, known: impl IntoIterator<Item = String>) -> Self {
        Error::Input(scenes::error::Error::unknown(kind, name, known))
    }
}
