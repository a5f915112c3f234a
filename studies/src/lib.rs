//! Accuracy studies of fixed-step integrators on scenes with exact solutions: how wrong, at what cost, and where it breaks.
//!
//! A [`scene::Scene`] is plain data with an exact motion; [`run`] drives one trajectory, [`sweep`] many; a
//! [`study::Study`] turns them into rows, and rows into figures and claims.
//!
//! Architecture invariants: every number shown is in a CSV; the same plan gives the same bytes, but for the times of
//! `tradeoff`; a failed run never scores; figures and claims need no run, only rows.

//! Without the feature `programs` only what one run needs is left: scenes, their exact motion, runs and their errors.
//! It is what a web page runs.

// What only the studies call is no waste where they are left out.
#![cfg_attr(not(feature = "programs"), allow(dead_code))]

#[macro_use]
pub mod run;
pub mod displaced;
pub mod erased;
pub mod error;
pub mod errors;
pub mod fit;
pub mod growth;
pub mod observation;
pub mod residual;
pub mod scene;
pub mod scenes;
pub mod special;

#[cfg(feature = "programs")]
pub mod adequacy;
#[cfg(feature = "programs")]
pub mod bounds;
#[cfg(feature = "programs")]
pub mod cli;
#[cfg(feature = "programs")]
pub mod convergence;
#[cfg(feature = "programs")]
pub mod drift;
#[cfg(feature = "programs")]
pub mod ensemble;
#[cfg(feature = "programs")]
mod findings;
#[cfg(feature = "programs")]
pub mod formulas;
#[cfg(feature = "programs")]
pub mod operations;
#[cfg(feature = "programs")]
pub mod order;
#[cfg(feature = "programs")]
pub mod page;
#[cfg(feature = "programs")]
pub mod plan;
#[cfg(feature = "programs")]
pub mod produce;
#[cfg(feature = "programs")]
pub mod provenance;
#[cfg(feature = "programs")]
mod reference;
#[cfg(feature = "programs")]
pub mod rotation;
#[cfg(feature = "programs")]
pub mod stability;
#[cfg(feature = "programs")]
pub mod study;
#[cfg(feature = "programs")]
pub mod summary;
#[cfg(feature = "programs")]
pub mod sweep;
#[cfg(feature = "programs")]
pub mod teach;
#[cfg(feature = "programs")]
pub mod tradeoff;
