//! Shared helpers of the tests. The tests themselves are the files of `tests/tests/`.

pub mod chromium;
mod decimal;
mod difference;
pub mod invariants;
pub mod programs;
pub mod reference;
pub mod schema;
pub mod table;

pub use decimal::parse_fx128;
pub use difference::derivative;
