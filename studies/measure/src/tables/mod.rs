//! Tables of errors, or of values, that another program computed with several steps: what order they show.
//!
//! [`read`] makes columns of a text, [`judge()`] says of each column what order it shows and what is wrong with it, and
//! [`richardson`] extrapolates values of which no truth is known.

pub mod judge;
mod read;
pub mod richardson;
mod trouble;

pub use judge::{Ask, Judged, judge};
pub use read::{Cell, Column, Layout, Of, Table, read};
pub use trouble::{Trouble, TroubleKind};
