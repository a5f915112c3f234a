//! Accuracy studies of fixed-step integrators on scenes with exact solutions.

pub mod fit;
pub mod growth;
pub mod order;
