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
    ($($id:literal => $kind:ident($scene:expr) $($taught:ident)? $(, $about:literal)?;)*) => {
        /// The names of all scenes and presets, in the order in which they are shown.
        pub const IDS: &[&str] = &[$($id),*];

        /// A line about each preset in the order of [`IDS`]; none where the scene's own line is about it.
        const ABOUT: &[&[&str]] = &[$(&[$($about)?]),*];

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
    "quadratic-drag/fall" => Particles(QuadraticDrag::default()), "a fall from rest with quadratic drag, up to the terminal speed";
    "quadratic-drag/rise" => Particles(QuadraticDrag::rise()), "a throw upwards with quadratic drag: the drag has a kink at the top";
    "oscillator" => Particles(Oscillator::default()) taught;
    "oscillator/decimal" => Particles(Oscillator::decimal()), "a mass on a spring whose numbers no binary arithmetic has: rounded parameters show";
    "damped-oscillator" => Particles(DampedOscillator::default()) taught, "a damped mass on a spring, under-damped: zeta = 1/8";
    "damped-oscillator/critical" => Particles(DampedOscillator::critical()), "a damped mass on a spring at zeta = 1: a double root, the quickest return without an overshoot";
    "damped-oscillator/over-damped" => Particles(DampedOscillator::over_damped()), "a damped mass on a spring at zeta = 5/2: two rates, a factor 23 apart";
    "forced-oscillator" => Particles(ForcedOscillator::default()), "a damped mass on a spring with a periodic force, away from resonance";
    "forced-oscillator/resonance" => Particles(ForcedOscillator::resonance()), "an undamped mass on a spring, driven at its own frequency: the amplitude grows as t";
    "forced-oscillator/near-resonance" => Particles(ForcedOscillator::near_resonance()), "an undamped mass on a spring, driven 2^-20 beside its own frequency: the textbook formula cancels";
    "pendulum" => Particles(Pendulum::default()) taught, "a pendulum that swings widely, up to 110 degrees";
    "pendulum/rotation" => Particles(Pendulum::rotation()), "a pendulum that goes over the top, round and round";
    "pendulum/near-separatrix" => Particles(Pendulum::near_separatrix()), "a pendulum that nearly reaches the top: slow there, fast below";
    "kepler" => Particles(Kepler::default()) taught, "a planet on an ellipse, e = 0.44, started away from an apsis";
    "kepler/circular" => Particles(Kepler::circular()), "a planet on a circle";
    "kepler/pericentre" => Particles(Kepler::pericentre()), "a planet on an ellipse, e = 0.44, started at the pericentre";
    "kepler/decimal" => Particles(Kepler::decimal()), "a planet on an ellipse whose numbers no binary arithmetic has: rounded parameters show";
    "kepler/eccentric" => Particles(Kepler::eccentric()) taught, "a comet, e = 0.91: its time scale at the pericentre is 1/35 of the mean one";
    "charged-particle" => Particles(ChargedParticle::default()), "a charge in crossed fields: the force depends on the velocity, and both Eulers gain energy alike";
    "charged-particle/magnetic" => Particles(ChargedParticle::magnetic()) taught, "a charge in a magnetic field alone, across it: a circle at constant speed";
    "spring-chain" => Particles(SpringChain::default());
    "bouncing-ball" => Particles(BouncingBall::default()) taught, "an elastic ball whose bounces are seen at the end of a step: no method is better than first order";
    "bouncing-ball/inelastic" => Particles(BouncingBall::inelastic()), "a ball that loses speed at each bounce and comes to rest after infinitely many";
    "principal-axis-torque" => Rigid(PrincipalAxisTorque::default());
    "sphere-torque" => Rigid(SphereTorque::default());
    "symmetric-top/disc" => Rigid(SymmetricTop::disc()), "a free body as flat as a disc, I3 > I1: it precesses about the momentum at a constant rate";
    "symmetric-top/rod" => Rigid(SymmetricTop::rod()), "a free body as long as a rod, I3 < I1: it precesses about the momentum at a constant rate";
    "torque-free-spin" => Rigid(TorqueFreeSpin::default()) taught;
    "tennis-racket" => Rigid(TorqueFreeSpin::tennis_racket()) taught;
    "heavy-top" => Rigid(HeavyTop::default());
    "manufactured" => Rigid(Manufactured::default());
    "box-tumbling" => Rigid(BoxTumbling::default());
}

/// One line about a scene or preset: what moves, and why it is looked at.
pub fn about(scene: &dyn AnyScene) -> &'static str {
    let own = IDS.iter().position(|id| *id == scene.id()).and_then(|i| ABOUT[i].first());
    own.copied().unwrap_or(scene.scene().info().about)
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
