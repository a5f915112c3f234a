//! Accuracy studies of fixed-step integrators on scenes with exact solutions: how wrong, at what cost, and where it breaks.
//!
//! A [`scene::Scene`] is plain data with an exact motion; [`run`] drives one trajectory, [`sweep`] many; a
//! [`study::Study`] turns them into rows, and rows into figures and claims.
//!
//! Architecture invariants: every number shown is in a CSV; the same plan gives the same bytes; a failed run never scores;
//! figures and claims need no run, only rows.

#[macro_use]
pub mod run;
pub mod adequacy;
pub mod cli;
pub mod convergence;
pub mod drift;
pub mod error;
mod findings;
pub mod fit;
pub mod formulas;
pub mod growth;
pub mod observation;
pub mod operations;
pub mod order;
pub mod page;
pub mod produce;
mod provenance;
mod reference;
pub mod residual;
pub mod rotation;
pub mod scene;
pub mod scenes;
pub mod special;
pub mod stability;
pub mod study;
pub mod sweep;
