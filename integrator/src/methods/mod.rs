//! The one list of methods. A new method is one file beside this one, and one line in `for_each_method` or, if it exists
//! for rigid bodies only, in `for_each_rigid_step`.
//!
//! A step for rigid bodies is a [`Method`] for one of the models of [`rigid_body`](crate::rigid_body). This one turns the
//! body with the mean of its old and new angular velocity:
//!
//! ```
//! use integrator::pose::{Body, Fixed, Pose, Update};
//! use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, RigidModel, Torque};
//! use integrator::{Method, Model, Real, Rotation, Space, State, Twist, Vector, drive};
//! use nalgebra::Vector3;
//!
//! /// v1 = v0 + h rate(t0, q0, v0), q1 = q0 exp(h (v0 + v1) / 2). Order 1, one evaluation.
//! #[derive(Clone, Copy, Debug, Default)]
//! struct MeanOmega;
//!
//! impl<T: Real, B: RigidBody<T>, U: Update<Frame = Body>> Method<T, BodyOmega<B, U>> for MeanOmega {
//!     fn step(
//!         &self,
//!         m: &BodyOmega<B, U>,
//!         t: T,
//!         h: T,
//!         s: State<Pose<T, U, B::Position>>,
//!     ) -> State<Pose<T, U, B::Position>> {
//!         let v = s.v.plus(m.rate(t, &s), h);
//!         State { q: s.q.retract((s.v + v) * T::lit(0.5), h), v }
//!     }
//! }
//!
//! /// A free brick.
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
//! let model = BodyOmega::<Brick>::new(Brick);
//! let start = State {
//!     q: Pose::new(Fixed::zero(), Rotation::identity()),
//!     v: Twist { linear: Fixed::zero(), angular: Vector3::new(1.5, -0.75, 1.0) },
//! };
//! let twice_energy = |omega: Vector3<f64>| omega.dot(&Brick.inertia().component_mul(&omega));
//! let gained = |steps: u64| {
//!     let end = drive::advance(&MeanOmega, &model, start, 2.0 / steps as f64, steps).expect("finite");
//!     twice_energy(end.v.angular) - twice_energy(start.v.angular)
//! };
//! // order 1: half the step, half the energy gained
//! assert!((gained(512) / gained(1024) - 2.0).abs() < 0.02);
//! ```
//!
//! In this crate the impl is a file `methods/mean_omega.rs`, and its line
//! `MeanOmega, BodyOmega, Body, "mean-omega", "Mean angular velocity", 1, 1, [], "omega1 = ...", "source";` gives it a name,
//! its claims in the rotation study and its laws in the tests.

mod explicit_euler;
mod free_splitting;
mod implicit_euler;
mod implicit_gyroscopic;
mod implicit_midpoint;
mod momentum_midpoint;
mod restored_momentum;
mod rk4;
mod semi_implicit_euler;
mod velocity_verlet;

pub use explicit_euler::ExplicitEuler;
pub use free_splitting::FreeSplitting;
pub use implicit_euler::ImplicitEuler;
pub use implicit_gyroscopic::ImplicitGyroscopic;
pub use implicit_midpoint::ImplicitMidpoint;
pub use momentum_midpoint::MomentumMidpoint;
pub use restored_momentum::RestoredMomentum;
pub use rk4::Rk4;
pub use semi_implicit_euler::SemiImplicitEuler;
pub use velocity_verlet::VelocityVerlet;

use crate::model::{Method, Model};
use crate::pose::{Body, Exponential, Linear, World};
use crate::real::Single;
use crate::rigid_body::{AttitudeUpdate, BodyOmega, RigidBody, RigidModel, Storage, WorldMomentum};

/// Calls a macro with every general method: type, id, order, whether it solves equations.
macro_rules! for_each_method {
    ($call:ident) => {
        $call! {
            ExplicitEuler, "explicit-euler", "Explicit Euler", 1, false;
            SemiImplicitEuler, "semi-implicit-euler", "Semi-implicit Euler", 1, false;
            VelocityVerlet, "velocity-verlet", "Velocity Verlet", 2, false;
            Rk4, "rk4", "RK4", 4, false;
            ImplicitEuler, "implicit-euler", "Implicit Euler", 1, true;
            ImplicitMidpoint, "implicit-midpoint", "Implicit midpoint", 2, true;
        }
    };
}

/// Work to be done with a method that is chosen at run time: one branch a run, none a step.
pub trait Visitor<T: Single, M: Model<T>> {
    /// What the work gives.
    type Output;
    /// Does it, compiled for the one method.
    fn visit<A: Method<T, M>>(self, method: &A) -> Self::Output;
}

macro_rules! define_list {
    ($($method:ident, $id:literal, $title:literal, $order:literal, $implicit:literal;)*) => {
        /// The name of a method.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum MethodId {
            $(
                #[doc = concat!($title, ".")]
                $method,
            )*
        }

        impl MethodId {
            /// Every method, in the order in which it is shown.
            pub const ALL: &'static [MethodId] = &[$(MethodId::$method),*];

            /// The name on the command line and in tables.
            pub fn id(self) -> &'static str {
                match self { $(MethodId::$method => $id),* }
            }

            /// The name in a sentence.
            pub fn title(self) -> &'static str {
                match self { $(MethodId::$method => $title),* }
            }

            /// The order of convergence on a smooth problem.
            pub fn order(self) -> u32 {
                match self { $(MethodId::$method => $order),* }
            }

            /// Whether a step solves a system of equations, and so can fail to.
            pub fn is_implicit(self) -> bool {
                match self { $(MethodId::$method => $implicit),* }
            }

            /// Hands the method to the visitor.
            pub fn visit<T: Single, M: Model<T>, V: Visitor<T, M>>(self, visitor: V) -> V::Output {
                match self { $(MethodId::$method => visitor.visit(&$method)),* }
            }
        }
    };
}
for_each_method!(define_list);

/// What a step keeps to rounding on every torque-free rigid body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Conserved {
    /// T = omega . I omega / 2.
    Energy,
    /// |L|.
    MomentumNorm,
    /// L in the world frame, as a vector.
    Momentum,
}

/// Calls a macro with every step that exists for rigid bodies only: type, the model it is a method for and the frame of
/// that model, id, title, order, evaluations of the torque in a step, what it conserves, formula, source.
macro_rules! for_each_rigid_step {
    ($call:ident) => {
        $call! {
            ImplicitGyroscopic, BodyOmega, Body, "implicit-gyroscopic", "Implicit gyroscopic torque", 1, 1, [],
                "omega1 = u - f'(u)^-1 f(u), f(w) = I (w - u) + h w x I w, u = omega0 + h I^-1 tau0",
                "E. Catto, Numerical Methods, GDC 2015; Bullet, MuJoCo's implicit integrator";
            RestoredMomentum, BodyOmega, Body, "restored-momentum", "Explicit gyroscopic torque, |L| restored", 1, 1, [MomentumNorm],
                "l* = l + h l x omega0, I omega1 = l* |l| / |l*| + h tau0",
                "PhysX, Jolt, Rapier, Avian";
            MomentumMidpoint, WorldMomentum, World, "momentum-midpoint", "Stored momentum, midpoint attitude", 2, 2, [Momentum],
                "qm = q0 exp(h omega(q0, L0) / 2), Lm = L0 + h tau0 / 2, L1 = L0 + h taum, q1 = q0 exp(h omega(qm, Lm))",
                "C. Runge, Math. Ann. 46 (1895) 167; S. R. Buss, J. Comput. Phys. 164 (2000) 377";
            FreeSplitting, BodyOmega, Body, "free-splitting", "Splitting into axis rotations", 2, 2, [Momentum],
                "kick h/2, X(h/2) Y(h/2) Z(h) Y(h/2) X(h/2), kick h/2; X(h): turn by h l_x / I_x about the body's x axis",
                "R. I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043; S. Reich, Physica D 76 (1994) 375";
        }
    };
}

/// Work to be done with a step for rigid bodies that is chosen at run time, and with the model it is a method for.
pub trait RigidVisitor<T: Single, B: RigidBody<T>> {
    /// What the work gives.
    type Output;
    /// Does it, compiled for the one step.
    fn visit<M: RigidModel<T, Body = B>, A: Method<T, M>>(self, method: &A, model: &M) -> Self::Output;
}

macro_rules! define_rigid_list {
    ($($step:ident, $model:ident, $frame:ident, $id:literal, $title:literal, $order:literal, $evaluations:literal,
        [$($conserved:ident),*], $formula:literal, $source:literal;)*) => {
        /// The name of a step that exists for rigid bodies only.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum RigidStep {
            $(
                #[doc = concat!($title, ".")]
                $step,
            )*
        }

        impl RigidStep {
            /// Every one, in the order in which it is shown.
            pub const ALL: &'static [RigidStep] = &[$(RigidStep::$step),*];

            /// The name on the command line and in tables.
            pub fn id(self) -> &'static str {
                match self { $(RigidStep::$step => $id),* }
            }

            /// The name in a sentence.
            pub fn title(self) -> &'static str {
                match self { $(RigidStep::$step => $title),* }
            }

            /// The order of convergence on a smooth problem.
            pub fn order(self) -> u32 {
                match self { $(RigidStep::$step => $order),* }
            }

            /// Evaluations of the torque in a step.
            pub fn evaluations(self) -> u64 {
                match self { $(RigidStep::$step => $evaluations),* }
            }

            /// What it stores.
            pub fn storage(self) -> Storage {
                match self { $(RigidStep::$step => Storage::$model),* }
            }

            /// What it keeps to rounding without a torque.
            pub fn conserves(self) -> &'static [Conserved] {
                match self { $(RigidStep::$step => &[$(Conserved::$conserved),*]),* }
            }

            /// The step as a formula.
            pub fn formula(self) -> &'static str {
                match self { $(RigidStep::$step => $formula),* }
            }

            /// Who described it, or uses it.
            pub fn source(self) -> &'static str {
                match self { $(RigidStep::$step => $source),* }
            }

            /// Hands the step, and the body in what it stores, to the visitor.
            pub fn visit<T: Single, B: RigidBody<T>, V: RigidVisitor<T, B>>(
                self,
                update: AttitudeUpdate,
                body: B,
                visitor: V,
            ) -> V::Output {
                match (self, update) { $(
                    (RigidStep::$step, AttitudeUpdate::Exponential) => {
                        visitor.visit(&$step, &$model::<B, Exponential<$frame>>::new(body))
                    }
                    (RigidStep::$step, AttitudeUpdate::Linear) => {
                        visitor.visit(&$step, &$model::<B, Linear<$frame>>::new(body))
                    }
                )* }
            }
        }
    };
}
for_each_rigid_step!(define_rigid_list);
