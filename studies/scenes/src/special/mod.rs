//! Special functions generic over the arithmetic, and the exact motions of free rigid bodies built on them.
//!
//! Everything takes the complementary parameter mc = 1 - m of elliptic functions and is written so that nothing cancels:
//! f64 results are good to a few eps, double-double results to about 1e-30, up to the conditioning of the question.

pub mod carlson;
pub mod elementary;
pub mod elliptic;
mod expansion;
pub mod free_top;
pub mod jacobi;
pub mod kepler;
pub mod kummer;
pub mod lagrange_top;
pub mod sphere_torque;
pub mod symmetric_top;
