//! How results are shown: tables and CSV, charts (SVG), claims and their verdicts, one page (HTML).
//!
//! This crate knows no physics and integrates nothing. It is given plain data and gives back text:
//!
//! ```text
//! rows    -> table::write_csv  -> CSV       the only hand-over between measuring and showing
//! Figure  -> plot::svg         -> SVG   -> png -> PNG
//! Claim   -> claim::exit_code  -> 0 or 1
//! Page    -> Page::html        -> one self-contained HTML file
//! bytes   -> OutputDir         -> files, all of them or none
//! ```
//!
//! Invariants:
//! - The same input gives the same bytes: no clock, no random number, no font of the machine, no hash order.
//! - Nothing but [`files`] touches the disk.
//! - Drawings name looks by class; colours and line styles stand in one list.
//! - The feature `pages` (on by default) has what draws. Without it a crate that only measures pulls in no chart library.
//! - A value that cannot be drawn (NaN, infinite, not positive on a logarithmic axis) is left out, never moved.

pub mod claim;
pub mod error;
pub mod figure;
pub mod files;
#[cfg(feature = "pages")]
pub mod formula;
#[cfg(feature = "pages")]
pub mod page;
#[cfg(feature = "pages")]
pub mod plot;
#[cfg(feature = "pages")]
mod png;
pub mod table;

pub use claim::{Claim, Verdict, exit_code};
pub use error::Error;
pub use figure::{Axis, AxisName, Cells, Figure, Layer, Line, Marker, Palette, Scale, Series};
pub use files::OutputDir;
#[cfg(feature = "pages")]
pub use formula::mathml;
#[cfg(feature = "pages")]
pub use page::{Block, Finding, Page, Section};
#[cfg(feature = "pages")]
pub use plot::svg;
#[cfg(feature = "pages")]
pub use png::{DRAWS_PNG, png};
pub use table::{Align, Table, columns_of_csv, read_csv, read_csv_with, write_csv};
