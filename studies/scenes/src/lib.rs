//! Scenes with exact motions, and one run of a method on them.
//!
//! A [`scene::Scene`] is plain data. Its exact motion is a [`motion::Motion`] or a [`motion::RigidMotion`] in any
//! arithmetic. [`run`] drives one trajectory, [`errors`] compares it with the exact motion, and [`any::AnyScene`] does both
//! for a scene that is chosen at run time.
//!
//! Architecture invariants: no file, no clock but in [`timed`], no thread; a failed run never scores.

#[macro_use]
pub mod run;
pub mod any;
pub mod catalogue;
pub mod displaced;
pub mod erased;
pub mod error;
pub mod errors;
pub mod invariants;
pub mod motion;
pub mod observation;
pub mod parameters;
pub mod residual;
pub mod scene;
pub mod scheme;
pub mod settings;
pub mod special;
pub mod stepping;
pub mod theory;
pub mod timed;
pub mod variation;

pub use catalogue::*;
