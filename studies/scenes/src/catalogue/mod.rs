//! The one list of scenes. A new scene is one file beside this one, and one line in `list!`.

mod answerable;
pub mod bouncing_ball;
pub mod box_tumbling;
pub mod charged_particle;
pub mod constant_force;
pub mod damped_oscillator;
pub mod forced_oscillator;
pub mod heavy_top;
pub mod kepler;
mod linear;
pub mod linear_drag;
pub mod manufactured;
mod oscillation;
pub mod oscillator;
pub mod pendulum;
pub mod principal_axis_torque;
pub mod quadratic_drag;
mod rigid;
pub mod sphere_torque;
pub mod spring_chain;
pub mod symmetric_top;
pub mod torque_free_spin;

pub use bouncing_ball::BouncingBall;
pub use box_tumbling::BoxTumbling;
pub use charged_particle::ChargedParticle;
pub use constant_force::ConstantForce;
pub use damped_oscillator::DampedOscillator;
pub use forced_oscillator::ForcedOscillator;
pub use heavy_top::HeavyTop;
pub use kepler::Kepler;
pub use linear_drag::LinearDrag;
pub use manufactured::Manufactured;
pub use oscillator::Oscillator;
pub use pendulum::Pendulum;
pub use principal_axis_torque::PrincipalAxisTorque;
pub use quadratic_drag::QuadraticDrag;
pub use sphere_torque::SphereTorque;
pub use spring_chain::SpringChain;
pub use symmetric_top::SymmetricTop;
pub use torque_free_spin::TorqueFreeSpin;

use crate::any::{AnyScene, Particles, Rigid};
use crate::scene::Scene;
use std::any::Any;

use crate::error::Error;

macro_rules! list {
    ($($id:literal => $kind:ident($scene:expr) $($taught:ident)?;)*) => {
        /// The names of all scenes and presets, in the order in which they are shown.
        pub const IDS: &[&str] = &[$($id),*];

        /// Every scene and preset with its default parameters.
        pub fn all() -> Vec<Box<dyn AnyScene>> {
            vec![$(Box::new($kind { id: $id, scene: $scene })),*]
        }

        /// Those of the teaching page. A module that asks for no others holds no others.
        pub fn taught() -> Vec<Box<dyn AnyScene>> {
            let all: [Option<Box<dyn AnyScene>>; IDS.len()] =
                [$( if_taught!($($taught)?; Box::new($kind { id: $id, scene: $scene })) ),*];
            all.into_iter().flatten().collect()
        }
    };
}

macro_rules! if_taught {
    (; $scene:expr) => {
        None
    };
    (taught; $scene:expr) => {
        Some($scene)
    };
}

list! {
    "constant-force" => Particles(ConstantForce::default());
    "linear-drag" => Particles(LinearDrag::default());
    "quadratic-drag/fall" => Particles(QuadraticDrag::default());
    "quadratic-drag/rise" => Particles(QuadraticDrag::rise());
    "oscillator" => Particles(Oscillator::default()) taught;
    "oscillator/decimal" => Particles(Oscillator::decimal());
    "damped-oscillator" => Particles(DampedOscillator::default()) taught;
    "damped-oscillator/critical" => Particles(DampedOscillator::critical());
    "damped-oscillator/over-damped" => Particles(DampedOscillator::over_damped());
    "forced-oscillator" => Particles(ForcedOscillator::default());
    "forced-oscillator/resonance" => Particles(ForcedOscillator::resonance());
    "forced-oscillator/near-resonance" => Particles(ForcedOscillator::near_resonance());
    "pendulum" => Particles(Pendulum::default()) taught;
    "pendulum/rotation" => Particles(Pendulum::rotation());
    "pendulum/near-separatrix" => Particles(Pendulum::near_separatrix());
    "kepler" => Particles(Kepler::default()) taught;
    "kepler/circular" => Particles(Kepler::circular());
    "kepler/pericentre" => Particles(Kepler::pericentre());
    "kepler/decimal" => Particles(Kepler::decimal());
    "kepler/eccentric" => Particles(Kepler::eccentric()) taught;
    "charged-particle" => Particles(ChargedParticle::default());
    "charged-particle/magnetic" => Particles(ChargedParticle::magnetic()) taught;
    "spring-chain" => Particles(SpringChain::default());
    "bouncing-ball" => Particles(BouncingBall::default()) taught;
    "bouncing-ball/inelastic" => Particles(BouncingBall::inelastic());
    "principal-axis-torque" => Rigid(PrincipalAxisTorque::default());
    "sphere-torque" => Rigid(SphereTorque::default());
    "symmetric-top/disc" => Rigid(SymmetricTop::disc());
    "symmetric-top/rod" => Rigid(SymmetricTop::rod());
    "torque-free-spin" => Rigid(TorqueFreeSpin::default()) taught;
    "tennis-racket" => Rigid(TorqueFreeSpin::tennis_racket()) taught;
    "heavy-top" => Rigid(HeavyTop::default());
    "manufactured" => Rigid(Manufactured::default());
    "box-tumbling" => Rigid(BoxTumbling::default());
}

/// The scene of that name, with its default parameters.
///
/// # Errors
/// [`Error::UnknownName`] with the list and the nearest name.
pub fn by_id(id: &str) -> Result<Box<dyn AnyScene>, Error> {
    all()
        .into_iter()
        .find(|scene| scene.id() == id)
        .ok_or_else(|| Error::unknown("scene", id, IDS.iter().map(|&known| known.to_owned())))
}

/// A scene of the catalogue with this law and start in the place of its own.
///
/// # Panics
/// Where the catalogue has a scene of another kind, or none, under that name.
pub fn boxed<S: Scene>(id: &str, scene: S) -> Box<dyn AnyScene> {
    let mut any = all().into_iter().find(|any| any.id() == id).expect("the name is one of the catalogue's");
    let own: &mut dyn Any = any.scene_mut();
    *own.downcast_mut::<S>().expect("the catalogue has a scene of this kind under the name") = scene;
    any
}
