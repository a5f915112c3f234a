//! SVG to PNG, with the font that is embedded and no other: the same drawing gives the same pixels on every machine.

use crate::Error;

/// Whether this build can draw PNG: feature `png`.
pub const DRAWS_PNG: bool = cfg!(feature = "png");

/// Pixels for each CSS pixel: what a chart needs on paper and on a screen of high resolution.
#[cfg(feature = "png")]
const PIXELS: f32 = 2.0;

/// The drawing, as [`crate::svg`] gives it, as a PNG with two pixels for each CSS pixel; `figure` is its id, for errors.
///
/// # Errors
/// [`Error::Drawing`] when the rasterizer refuses the drawing, and always where the feature `png` is missing.
#[cfg(feature = "png")]
pub fn png(svg: &str, figure: &str) -> Result<Vec<u8>, Error> {
    use resvg::tiny_skia::{Pixmap, Transform};
    use resvg::usvg::{Options, Tree};
    use std::sync::Arc;

    let failed = |message: String| Error::Drawing { figure: figure.to_owned(), message };
    let mut options = Options { font_family: crate::plot::FAMILY.to_owned(), ..Options::default() };
    Arc::make_mut(&mut options.fontdb).load_font_data(crate::plot::FONT.to_vec());
    let tree = Tree::from_str(svg, &options).map_err(|error| failed(error.to_string()))?;
    let size = tree.size().to_int_size().scale_by(PIXELS);
    let sheet = size.and_then(|size| Pixmap::new(size.width(), size.height()));
    let mut sheet = sheet.ok_or_else(|| failed("its size in pixels is zero or too large".to_owned()))?;
    resvg::render(&tree, Transform::from_scale(PIXELS, PIXELS), &mut sheet.as_mut());
    sheet.encode_png().map_err(|error| failed(error.to_string()))
}

/// As above; this build draws none.
///
/// # Errors
/// [`Error::Drawing`], always: the feature `png` is missing.
#[cfg(not(feature = "png"))]
pub fn png(svg: &str, figure: &str) -> Result<Vec<u8>, Error> {
    let message = format!("as PNG ({} bytes of SVG): this program was built without the feature `png`", svg.len());
    Err(Error::Drawing { figure: figure.to_owned(), message })
}
