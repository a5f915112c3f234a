//! The one list of methods. A new method is one file beside this one, and one line in [`for_each_method`].

mod explicit_euler;
mod implicit_euler;
mod implicit_midpoint;
mod rk4;
mod semi_implicit_euler;
mod velocity_verlet;

pub use explicit_euler::ExplicitEuler;
pub use implicit_euler::ImplicitEuler;
pub use implicit_midpoint::ImplicitMidpoint;
pub use rk4::Rk4;
pub use semi_implicit_euler::SemiImplicitEuler;
pub use velocity_verlet::VelocityVerlet;

use crate::model::{Method, Model};
use crate::real::Single;

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
