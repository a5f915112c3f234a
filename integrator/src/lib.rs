//! Fixed-step time integration of particles and rigid bodies, one definition of each method for every model.
//!
//! A [`Model`] gives the rate of change of its velocity, a [`Space`] says how a configuration moves along a velocity,
//! a [`Method`] turns the two into one step of length h, and [`drive`] takes n of them at the times t = i h.
//! The arithmetic is a type parameter: [`Real`] (one number or several lanes), [`Single`] (one comparable number:
//! `f32`, `f64`, `faer::fx128`).
//!
//! ```
//! use integrator::{Model, State, drive, methods::SemiImplicitEuler};
//! use nalgebra::Vector1;
//!
//! /// x'' = -x
//! struct Spring;
//! impl Model<f64> for Spring {
//!     type Config = Vector1<f64>;
//!     fn rate(&self, _t: f64, s: &State<Vector1<f64>>) -> Vector1<f64> {
//!         -s.q
//!     }
//! }
//!
//! let start = State { q: Vector1::new(1.0), v: Vector1::new(0.0) };
//! let h = 0.015625;
//! let end = drive::advance(&SemiImplicitEuler, &Spring, start, h, 64).expect("finite");
//! // theory: x is wrong by -h sin(t) / 2 to leading order
//! let constant = (end.q.x - 1.0_f64.cos()) / h;
//! assert!((constant + 0.5 * 1.0_f64.sin()).abs() < h);
//! ```
//!
//! Architecture invariants: no input or output, no clock, no scene, no global state; a step of an explicit method does
//! not allocate; nothing panics on a number.

pub mod counted;
pub mod drive;
pub mod lanes;
pub mod methods;
pub mod model;
pub mod newton;
pub mod pose;
pub mod real;
mod reduction;
pub mod rigid_body;
pub mod rotation;
pub mod space;

pub use model::{Method, Model, State, Tangent};
pub use pose::{Pose, Twist};
pub use real::{Real, Single};
pub use rotation::Rotation;
pub use space::{Space, Vector};
