//! The lists of methods. A new method is one file beside this one, with its step and its [`Facts`], and one line in
//! `general_list` or, if it exists for rigid bodies only, in `rigid_list`.
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
//!         let v = s.v.add_scaled(m.rate(t, &s), h);
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
//! In this crate the impl is a file `methods/mean_omega.rs` with `MeanOmega::FACTS`, and its line `MeanOmega, BodyOmega, Body;`
//! gives it a name, its claims in the rotation study and its laws in the tests.

mod adams_bashforth;
mod buss;
mod composition;
mod explicit_euler;
mod facts;
mod free_splitting;
mod heun;
mod implicit_euler;
mod implicit_gyroscopic;
mod implicit_midpoint;
mod kutta3;
mod local_linearization;
mod momentum_midpoint;
mod moser_veselov;
mod restored_momentum;
mod rk4;
mod semi_implicit_euler;
mod velocity_verlet;

pub use adams_bashforth::{
    AdamsBashforth2, AdamsBashforth2Filled, AdamsBashforth3, AdamsBashforth3Filled, AdamsBashforth4,
    AdamsBashforth4Filled, AdamsBashforth5, AdamsBashforth5Filled, MeanOfTwoSlopes,
};
pub use buss::{BussAugmented, BussSecondOrder};
pub use composition::{
    SplittingKahanLi6, SplittingKahanLi8, SplittingSuzuki4, VerletKahanLi6, VerletKahanLi8, VerletSuzuki4,
};
pub use explicit_euler::ExplicitEuler;
pub use facts::{Conserved, Facts, LinearTheory, Rational};
pub use free_splitting::FreeSplitting;
pub use heun::Heun;
pub use implicit_euler::ImplicitEuler;
pub use implicit_gyroscopic::ImplicitGyroscopic;
pub use implicit_midpoint::ImplicitMidpoint;
pub use kutta3::Kutta3;
pub use local_linearization::LocalLinearization;
pub use momentum_midpoint::MomentumMidpoint;
pub use moser_veselov::MoserVeselov;
pub use restored_momentum::RestoredMomentum;
pub use rk4::Rk4;
pub use semi_implicit_euler::SemiImplicitEuler;
pub use velocity_verlet::VelocityVerlet;

use crate::model::{Method, Model};
use crate::pose::{Body, Exponential, Linear, World};
use crate::real::{Real, Single};
use crate::rigid_body::{AttitudeUpdate, BodyOmega, Formulation, RigidBody, RigidModel, WorldMomentum};

/// Work to be done with a method that is chosen at run time: one branch a run, none a step.
pub trait Visitor<T: Real, M: Model<T>> {
    /// What the work gives.
    type Output;
    /// Does it, compiled for the one method.
    fn visit<A: Method<T, M>>(self, method: &A) -> Self::Output;
}

/// The names of a list of steps.
macro_rules! names {
    ($(#[$doc:meta])* $list:ident: $($step:ident),* $(,)?) => {
        $(#[$doc])*
        ///
        /// A match elsewhere has an arm for names that it does not know: a new one then compiles without it.
        #[non_exhaustive]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum $list {
            $(
                #[doc = concat!("[`struct@", stringify!($step), "`].")]
                $step,
            )*
        }

        impl $list {
            /// Every one, in the order in which it is shown.
            pub const ALL: &'static [$list] = &[$($list::$step),*];

            /// What is known of it.
            pub const fn facts(self) -> &'static Facts {
                match self { $($list::$step => &$step::FACTS),* }
            }

            /// The name on the command line and in tables.
            pub fn id(self) -> &'static str {
                self.facts().id
            }

            /// The name in a sentence.
            pub fn title(self) -> &'static str {
                self.facts().title
            }

            /// The order of convergence on a smooth problem.
            pub fn order(self) -> u32 {
                self.facts().order
            }
        }
    };
}

/// A list of general methods. Those of the core are compiled wherever a method is timed, the others where no time is taken;
/// an explicit method steps any [`Real`], lanes included, an implicit one a [`Single`].
macro_rules! general_list {
    ($(#[$doc:meta])* $list:ident {
        core explicit: $($core:ident),*;
        core implicit: $($core_implicit:ident),*;
        more explicit: $($more:ident),*;
    }) => {
        names! { $(#[$doc])* $list: $($core,)* $($core_implicit,)* $($more),* }

        impl $list {
            /// Whether a step solves a system of equations, and so can fail to.
            pub fn is_implicit(self) -> bool {
                self.facts().implicit
            }

            /// Whether it is one of the core, compiled wherever a method is timed.
            #[allow(clippy::match_same_arms, reason = "one arm for each part of the list")]
            pub fn is_core(self) -> bool {
                match self {
                    $($list::$core => true,)*
                    $($list::$core_implicit => true,)*
                    $($list::$more => false,)*
                }
            }

            /// Hands the method to the visitor.
            pub fn visit<T: Single, M: Model<T>, V: Visitor<T, M>>(self, visitor: V) -> V::Output {
                match self {
                    $($list::$core => visitor.visit(&$core),)*
                    $($list::$core_implicit => visitor.visit(&$core_implicit),)*
                    $($list::$more => visitor.visit(&$more),)*
                }
            }

            /// The same for an explicit method, in lanes too; `None` for an implicit one, of which no code is compiled.
            pub fn visit_explicit<T: Real, M: Model<T>, V: Visitor<T, M>>(self, visitor: V) -> Option<V::Output> {
                match self {
                    $($list::$core => Some(visitor.visit(&$core)),)*
                    $($list::$core_implicit => None,)*
                    $($list::$more => Some(visitor.visit(&$more)),)*
                }
            }

            /// As [`Self::visit`], for a method of the core; `None` for another, of which no code is compiled.
            #[allow(unused_variables, reason = "a list without a core")]
            pub fn visit_core<T: Single, M: Model<T>, V: Visitor<T, M>>(self, visitor: V) -> Option<V::Output> {
                match self {
                    $($list::$core => Some(visitor.visit(&$core)),)*
                    $($list::$core_implicit => Some(visitor.visit(&$core_implicit)),)*
                    $($list::$more => None,)*
                }
            }

            /// As [`Self::visit_explicit`], for an explicit method of the core; `None` for another.
            #[allow(unused_variables, reason = "a list without a core")]
            pub fn visit_core_explicit<T: Real, M: Model<T>, V: Visitor<T, M>>(self, visitor: V) -> Option<V::Output> {
                match self {
                    $($list::$core => Some(visitor.visit(&$core)),)*
                    $($list::$core_implicit => None,)*
                    $($list::$more => None,)*
                }
            }
        }
    };
}

general_list! {
    /// The name of a method.
    MethodId {
        core explicit: ExplicitEuler, SemiImplicitEuler, VelocityVerlet, Rk4;
        core implicit: ImplicitEuler, ImplicitMidpoint;
        more explicit: ;
    }
}

general_list! {
    /// The name of a method that no study runs by itself yet: those of engines, and yardsticks of high order.
    MoreMethod {
        core explicit: ;
        core implicit: ;
        more explicit: Heun, Kutta3, AdamsBashforth2, AdamsBashforth3, AdamsBashforth4, AdamsBashforth5, AdamsBashforth2Filled,
            AdamsBashforth3Filled, AdamsBashforth4Filled, AdamsBashforth5Filled, MeanOfTwoSlopes, VerletSuzuki4, VerletKahanLi6,
            VerletKahanLi8;
    }
}

/// Work to be done with a step for rigid bodies that is chosen at run time, and with the model it is a method for.
pub trait RigidVisitor<T: Single, B: RigidBody<T>> {
    /// What the work gives.
    type Output;
    /// Does it, compiled for the one step.
    fn visit<M: RigidModel<T, Body = B>, A: Method<T, M>>(self, method: &A, model: &M) -> Self::Output;
}

/// A list of steps that exist for rigid bodies only: the step, the model it is a method for, and the frame of that model.
macro_rules! rigid_list {
    ($(#[$doc:meta])* $list:ident { $($step:ident, $model:ident, $frame:ident;)* }) => {
        names! { $(#[$doc])* $list: $($step),* }

        impl $list {
            /// Evaluations of the torque in a step; 0 where a step iterates until its equations are solved.
            pub fn evaluations(self) -> u64 {
                self.facts().evaluations.unwrap_or(0)
            }

            /// What it stores.
            pub fn storage(self) -> Formulation {
                match self { $($list::$step => Formulation::$model),* }
            }

            /// What it keeps to rounding without a torque.
            pub fn conserves(self) -> &'static [Conserved] {
                self.facts().conserves
            }

            /// The step as a formula.
            pub fn formula(self) -> &'static str {
                self.facts().formula
            }

            /// Who described it, or uses it.
            pub fn source(self) -> &'static str {
                self.facts().source
            }

            /// Hands the step, and the body in what it stores, to the visitor.
            pub fn visit<T: Single, B: RigidBody<T>, V: RigidVisitor<T, B>>(
                self,
                update: AttitudeUpdate,
                body: B,
                visitor: V,
            ) -> V::Output {
                match (self, update) { $(
                    ($list::$step, AttitudeUpdate::Exponential) => {
                        visitor.visit(&$step, &$model::<B, Exponential<$frame>>::new(body))
                    }
                    ($list::$step, AttitudeUpdate::Linear) => {
                        visitor.visit(&$step, &$model::<B, Linear<$frame>>::new(body))
                    }
                )* }
            }
        }
    };
}

rigid_list! {
    /// The name of a step that exists for rigid bodies only.
    RigidStep {
        ImplicitGyroscopic, BodyOmega, Body;
        RestoredMomentum, BodyOmega, Body;
        MomentumMidpoint, WorldMomentum, World;
        FreeSplitting, BodyOmega, Body;
    }
}

rigid_list! {
    /// The name of a step for rigid bodies that no study runs by itself yet.
    MoreRigidStep {
        BussSecondOrder, WorldMomentum, World;
        BussAugmented, WorldMomentum, World;
        LocalLinearization, BodyOmega, Body;
        MoserVeselov, BodyOmega, Body;
        SplittingSuzuki4, BodyOmega, Body;
        SplittingKahanLi6, BodyOmega, Body;
        SplittingKahanLi8, BodyOmega, Body;
    }
}
