//! Lengths in whole tenths of a CSS pixel, as the drawings have them.

use std::fmt::Display;

/// CSS pixels in whole tenths.
pub(super) fn tenths(pixels: f64) -> i32 {
    (10.0 * pixels).round() as i32
}

/// A length in whole tenths of a CSS pixel.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Tenth(pub(super) i32);

impl Tenth {
    pub(super) fn of(pixels: f64) -> Self {
        Self(tenths(pixels))
    }
}

impl Display for Tenth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (sign, size) = (if self.0 < 0 { "-" } else { "" }, self.0.unsigned_abs());
        match (size / 10, size % 10) {
            (whole, 0) => write!(f, "{sign}{whole}"),
            (0, part) => write!(f, "{sign}.{part}"),
            (whole, part) => write!(f, "{sign}{whole}.{part}"),
        }
    }
}
