//! The one list of scenes. A new scene is one file beside this one, and one line in [`catalogue`].

pub mod constant_force;
pub mod oscillator;
pub mod parameters;
mod rigid;
pub mod torque_free_spin;

pub use constant_force::ConstantForce;
pub use oscillator::Oscillator;
pub use torque_free_spin::TorqueFreeSpin;

use crate::error::Error;
use crate::scene::{AnyScene, Particles, Rigid};

macro_rules! list {
    ($($id:literal => $kind:ident($scene:expr);)*) => {
        /// The names of all scenes and presets, in the order in which they are shown.
        pub const IDS: &[&str] = &[$($id),*];

        /// Every scene and preset with its default parameters.
        pub fn catalogue() -> Vec<Box<dyn AnyScene>> {
            vec![$(Box::new($kind { id: $id, scene: $scene })),*]
        }
    };
}

list! {
    "constant-force" => Particles(ConstantForce::default());
    "oscillator" => Particles(Oscillator::default());
    "torque-free-spin" => Rigid(TorqueFreeSpin::default());
}

/// The scene of that name, with its default parameters.
///
/// # Errors
/// [`Error::UnknownName`] with the list and the nearest name.
pub fn by_id(id: &str) -> Result<Box<dyn AnyScene>, Error> {
    catalogue()
        .into_iter()
        .find(|scene| scene.id() == id)
        .ok_or_else(|| Error::unknown("scene", id, IDS.iter().map(|&known| known.to_owned())))
}
