//! The one list of scenes. A new scene is one file beside this one, and one line in [`catalogue`].

pub mod box_tumbling;
pub mod constant_force;
pub mod heavy_top;
pub mod manufactured;
pub mod oscillator;
pub mod parameters;
pub mod principal_axis_torque;
mod rigid;
pub mod sphere_torque;
pub mod symmetric_top;
pub mod torque_free_spin;

pub use box_tumbling::BoxTumbling;
pub use constant_force::ConstantForce;
pub use heavy_top::HeavyTop;
pub use manufactured::Manufactured;
pub use oscillator::Oscillator;
pub use principal_axis_torque::PrincipalAxisTorque;
pub use sphere_torque::SphereTorque;
pub use symmetric_top::SymmetricTop;
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
    "principal-axis-torque" => Rigid(PrincipalAxisTorque::default());
    "sphere-torque" => Rigid(SphereTorque::default());
    "symmetric-top/disc" => Rigid(SymmetricTop::disc());
    "symmetric-top/rod" => Rigid(SymmetricTop::rod());
    "torque-free-spin" => Rigid(TorqueFreeSpin::default());
    "tennis-racket" => Rigid(TorqueFreeSpin::tennis_racket());
    "heavy-top" => Rigid(HeavyTop::default());
    "manufactured" => Rigid(Manufactured::default());
    "box-tumbling" => Rigid(BoxTumbling::default());
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
