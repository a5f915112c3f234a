//! Fixed-step time integration of particles and rigid bodies, one definition of each method for every model.
//!
//! A [`Model`] gives the rate of change of its velocity, a [`Space`] says how a configuration moves along a velocity,
//! a [`Method`] turns the two into one step of length h, and [`drive`] takes n of them at the times t = i h.
//! The arithmetic is a type parameter: [`Real`] (one number or several lanes), [`Single`] (one comparable number:
//! `f32`, `f64`, [`DoubleDouble`]).
//!
//! # Map
//!
//! | module | contents |
//! |---|---|
//! | [`model`] | [`State`], [`Model`], [`Method`], [`Steps`]: what moves, by which law, by which rule |
//! | [`methods`] | the methods, the steps for rigid bodies only, what is known of each, choice at run time |
//! | [`drive`] | n steps, observed or not; where a run leaves the finite numbers |
//! | [`space`], [`pose`], [`rotation`] | R^n, R^3 x SO(3), unit quaternions |
//! | [`rigid_body`] | one physics of a rigid body, four models that differ in what they store |
//! | [`real`], [`lanes`] | arithmetic: `f32`, `f64`, double-double; fused and SIMD lanes |
//! | [`counted`] | counts the evaluations of a force law |
//!
//! # Methods
//!
//! Evaluations of the force law in one step; 'iterates' until its equations are solved. 'Symplectic' and 'reversible' hold
//! where the force derives from a potential, for a step of rigid bodies without a torque (symplectic: a Poisson map).
//!
//! | method | order | evaluations | symplectic | reversible |
//! |---|---|---|---|---|
//! | [Explicit Euler](methods::ExplicitEuler) | 1 | 1 | no | no |
//! | [Semi-implicit Euler](methods::SemiImplicitEuler) | 1 | 1 | yes | no |
//! | [Velocity Verlet](methods::VelocityVerlet) | 2 | 2 | yes | yes |
//! | [RK4](methods::Rk4) | 4 | 4 | no | no |
//! | [Implicit Euler](methods::ImplicitEuler) | 1 | iterates | no | no |
//! | [Implicit midpoint](methods::ImplicitMidpoint) | 2 | iterates | yes | yes |
//! | [Implicit gyroscopic torque](methods::ImplicitGyroscopic) | 1 | 1 | - | no |
//! | [Explicit gyroscopic torque, \|L\| restored](methods::RestoredMomentum) | 1 | 1 | - | no |
//! | [Stored momentum, midpoint attitude](methods::MomentumMidpoint) | 2 | 2 | - | no |
//! | [Splitting into axis rotations](methods::FreeSplitting) | 2 | 2 | yes | yes |
//!
//! # A particle
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
//! # A rigid body
//!
//! ```
//! use integrator::pose::Fixed;
//! use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, RigidModel, Torque};
//! use integrator::{Rotation, Vector, drive, methods::FreeSplitting};
//! use nalgebra::Vector3;
//!
//! /// A free body with a fixed centre of mass.
//! struct Brick;
//! impl RigidBody<f64> for Brick {
//!     type Position = Fixed<f64>;
//!     fn inertia(&self) -> Vector3<f64> {
//!         Vector3::new(1.25, 0.75, 1.75)
//!     }
//!     fn torque(&self, _t: f64, _at: &Kinematics<f64, Fixed<f64>>) -> Torque<f64> {
//!         Torque::None
//!     }
//! }
//!
//! // The model stores the angular velocity in the body frame.
//! let model = BodyOmega::<Brick>::new(Brick);
//! let start = model.state(&Kinematics {
//!     position: Fixed::zero(),
//!     velocity: Fixed::zero(),
//!     attitude: Rotation::identity(),
//!     omega_body: Vector3::new(1.5, -0.75, 1.0),
//! });
//! let end = drive::advance(&FreeSplitting, &model, start, 0.0625, 1000).expect("finite");
//! // The angular momentum in the world frame is kept to rounding: a few per turn, five turns per step.
//! let momentum = |s| {
//!     let at = model.kinematics(s);
//!     at.attitude.rotate(Brick.inertia().component_mul(&at.omega_body))
//! };
//! assert!((momentum(&end) - momentum(&start)).norm() < 1000.0 * 20.0 * f64::EPSILON);
//! ```
//!
//! # Lanes
//!
//! ```
//! use integrator::lanes::{FromLanes, Pack};
//! use integrator::{Model, Real, State, drive, methods::VelocityVerlet};
//! use nalgebra::Vector1;
//!
//! /// x'' = -x, in any arithmetic.
//! struct Spring;
//! impl<T: Real> Model<T> for Spring {
//!     type Config = Vector1<T>;
//!     fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
//!         -s.q
//!     }
//! }
//!
//! // Eight oscillators side by side, each with a start of its own.
//! type Eight = Pack<wide::f64x4, 2>;
//! let x0 = |i: usize| 1.0 + i as f64;
//! let start = State { q: Vector1::new(Eight::from_lanes(x0)), v: Vector1::new(Eight::lit(0.0)) };
//! let ends = drive::advance(&VelocityVerlet, &Spring, start, Eight::lit(0.125), 100).expect("finite");
//! for i in 0..8 {
//!     let start = State { q: Vector1::new(x0(i)), v: Vector1::new(0.0) };
//!     let end = drive::advance(&VelocityVerlet, &Spring, start, 0.125, 100).expect("finite");
//!     // A lane has the bits of the run of its member alone.
//!     assert_eq!(ends.q.x.lane(i), end.q.x);
//! }
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

pub use model::{Method, Model, State, Steps, Tangent};
pub use pose::{Pose, Twist};
pub use real::{DoubleDouble, Real, Single};
pub use rotation::Rotation;
pub use space::{Space, Vector};
