//! Figures to SVG.

use crate::{Error, Figure};

/// The figure as a self-contained SVG document.
///
/// # Errors
/// [`Error::Figure`] when its data contradict themselves.
pub fn svg(figure: &Figure) -> Result<String, Error> {
    Err(Error::Drawing { figure: figure.id.clone(), message: "no backend yet".to_owned() })
}
