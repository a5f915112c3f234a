//! The loop around a step: how a program uses it. [`Loop`] describes one, [`drive`] runs it on any law of motion on a flat space.

pub mod description;
pub mod drive;
mod frames;
pub mod settings;

pub use description::Loop;
