//! The studies: from a selection of scenes, methods and steps to rows, and from rows to tables, figures and claims.
//!
//! Architecture invariants: everything after [`study::Study::measure`] follows from the rows alone; the same selection gives
//! the same rows, measured times excepted; a failed run never scores. This crate knows no page and no flag.

pub mod adequacy;
pub mod claim;
pub mod convergence;
pub mod drift;
pub mod ensemble;
pub mod error;
pub mod files;
pub mod fit;
pub mod game_loop;
pub mod growth;
pub mod loops;
pub mod names;
pub mod operations;
pub mod order;
pub mod random;
pub mod rotation;
pub mod shard;
pub mod stability;
pub mod study;
pub mod sweep;
pub mod tables;
pub mod tradeoff;
