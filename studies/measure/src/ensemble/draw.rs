//! Which scenes can start elsewhere, and by which rule their starts are drawn.

use std::any::Any;
use std::ops::Range;

use integrator::methods::MethodId;
use integrator::pose::{Exponential, Pose, World};
use integrator::rigid_body::{RigidBody, WorldOmega};
use integrator::{Model, Space, State};
use nalgebra::Vector3;

use super::lanes::{Coordinates, Eight, run_pack};
use super::random::Generator;
use crate::error::Error;
use scenes::any::{AnyScene, Particles, Rigid};
use scenes::erased::{FlatSpace, Place};
use scenes::motion::{Motion, RigidMotion};
use scenes::observation::Observation;
use scenes::scene::Scene;
use scenes::{
    BoxTumbling, ChargedParticle, ConstantForce, DampedOscillator, ForcedOscillator, HeavyTop, Kepler, LinearDrag,
    Oscillator, Pendulum, SphereTorque, SymmetricTop, TorqueFreeSpin,
};

/// A scene that can start elsewhere under the same law of motion.
pub trait Drawn: Scene + Clone {
    /// How starts are drawn.
    const RULE: &'static str;

    /// The same law of motion with a start drawn by the rule.
    #[must_use]
    fn drawn(&self, random: &mut Generator) -> Self;
}

/// The members of an ensemble: one scene from many starts.
pub trait Members: Send + Sync {
    /// How they were drawn.
    fn rule(&self) -> &'static str;
    /// How many there are.
    fn count(&self) -> usize;
    /// One of them by itself.
    fn alone(&self, member: usize) -> &dyn AnyScene;
    /// What is seen of some of them, at most eight, at the end of a run in lanes, `None` for one that left the finite numbers.
    /// The outer `None`: the method does not run in lanes.
    fn ends(&self, members: Range<usize>, method: MethodId, end_s: f64, steps: u64)
    -> Option<Vec<Option<Observation>>>;
}

macro_rules! list {
    ($($kind:ident($($scene:ident),*);)*) => {
        /// `count` members drawn from the seed. The first members of a larger ensemble are those of a smaller one.
        ///
        /// # Errors
        /// A scene without a rule, with the names of those that have one.
        pub fn draw(scene: &dyn AnyScene, count: usize, seed: u64) -> Result<Box<dyn Members>, Error> {
            let any: &dyn Any = scene.scene();
            let (id, mut random) = (scene.id(), Generator::new(seed));
            $($(
                if let Some(law) = any.downcast_ref::<$scene>() {
                    let members = (0..count).map(|_| $kind { id, scene: law.drawn(&mut random) });
                    return Ok(Box::new(Drawing::new(law, members.collect())));
                }
            )*)*
            let message = format!(
                "its start is not drawn: the law of motion, its contacts or its exact motion allow one start only; \
                 scenes with a rule: {}",
                with_a_rule().join(", ")
            );
            Err(Error::plan(format!("--ensemble with scene '{id}'"), message))
        }

        /// The scenes and presets whose starts can be drawn.
        pub fn with_a_rule() -> Vec<&'static str> {
            let has = |scene: &dyn AnyScene| {
                let any: &dyn Any = scene.scene();
                false $($(|| any.is::<$scene>())*)*
            };
            scenes::all().iter().filter(|scene| has(scene.as_ref())).map(|scene| scene.id()).collect()
        }
    };
}

list! {
    Particles(ConstantForce, LinearDrag, Oscillator, DampedOscillator, ForcedOscillator, Pendulum, Kepler, ChargedParticle);
    Rigid(SphereTorque, SymmetricTop, TorqueFreeSpin, HeavyTop, BoxTumbling);
}

/// Where a scene starts, in what its model stores.
trait Start {
    type Config: Space;
    fn start(&self) -> State<Self::Config>;
}

impl<S: Motion<f64>> Start for Particles<S> {
    type Config = S::Config;
    fn start(&self) -> State<S::Config> {
        self.scene.exact(0.0)
    }
}

impl<B: RigidMotion<f64>> Start for Rigid<B> {
    type Config = Pose<f64, Exponential<World>, B::Position>;
    fn start(&self) -> State<Self::Config> {
        Motion::<f64>::exact(&WorldOmega::<&B>::new(&self.scene), 0.0)
    }
}

/// The law that all share, and the members with their starts.
struct Drawing<S, M: Start> {
    law: S,
    members: Vec<M>,
    starts: Vec<State<M::Config>>,
}

impl<S: Clone, M: Start> Drawing<S, M> {
    fn new(law: &S, members: Vec<M>) -> Self {
        let starts = members.iter().map(M::start).collect();
        Drawing { law: law.clone(), members, starts }
    }
}

macro_rules! members {
    ($rule:expr, |$drawing:ident| $law:expr) => {
        fn rule(&self) -> &'static str {
            $rule
        }
        fn count(&self) -> usize {
            self.members.len()
        }
        fn alone(&self, member: usize) -> &dyn AnyScene {
            &self.members[member]
        }
        fn ends(
            &self,
            members: Range<usize>,
            method: MethodId,
            end_s: f64,
            steps: u64,
        ) -> Option<Vec<Option<Observation>>> {
            let $drawing = self;
            let law = $law;
            let ends = run_pack::<Eight, _, _>(&law, &self.starts[members], method, end_s, steps)?;
            Some(ends.iter().map(|end| end.as_ref().map(|state| Motion::<f64>::observe(&law, state))).collect())
        }
    };
}

impl<S> Members for Drawing<S, Particles<S>>
where
    S: Drawn + Motion<f32> + Motion<f64> + Motion<faer::fx128> + Model<Eight>,
    <S as Model<f64>>::Config: Coordinates + FlatSpace,
    <S as Model<Eight>>::Config: Coordinates,
{
    members!(S::RULE, |drawing| drawing.law.clone());
}

impl<B> Members for Drawing<B, Rigid<B>>
where
    B: Drawn + RigidMotion<f32> + RigidMotion<f64, Position: Place> + RigidMotion<faer::fx128> + RigidBody<Eight>,
{
    // The world omega with the exponential map, as in every study that does not say otherwise.
    members!(B::RULE, |drawing| WorldOmega::<&B>::new(&drawing.law));
}

/// A vector of the same length in a direction uniform on the sphere.
fn turned(v: [f64; 3], random: &mut Generator) -> [f64; 3] {
    let length = Vector3::from(v).norm();
    random.direction().map(|c| c * length)
}

/// The phase of an oscillation with the angular frequency w is uniform, its amplitude sqrt(x0^2 + (v0 / w)^2) is kept.
fn phase(x0: f64, v0: f64, w: f64, random: &mut Generator) -> (f64, f64) {
    let amplitude = libm::hypot(x0, v0 / w);
    let (sine, cosine) = libm::sincos(random.angle());
    (amplitude * cosine, -amplitude * w * sine)
}

macro_rules! thrown {
    ($($scene:ident),*) => {$(
        impl Drawn for $scene {
            const RULE: &'static str = "x0 and v0 keep their lengths, their directions are uniform";
            fn drawn(&self, random: &mut Generator) -> Self {
                Self { x0: turned(self.x0, random), v0: turned(self.v0, random), ..self.clone() }
            }
        }
    )*};
}
thrown!(ConstantForce, LinearDrag, ChargedParticle);

macro_rules! swung {
    ($($scene:ident),*) => {$(
        impl Drawn for $scene {
            const RULE: &'static str = "the energy of the spring and the mass is kept, the phase uniform";
            fn drawn(&self, random: &mut Generator) -> Self {
                let (x0, v0) = phase(self.x0, self.v0, (self.stiffness / self.mass).sqrt(), random);
                Self { x0, v0, ..self.clone() }
            }
        }
    )*};
}
swung!(Oscillator, DampedOscillator, ForcedOscillator);

impl Drawn for Pendulum {
    const RULE: &'static str =
        "the energy is kept, the angle uniform among those that it reaches; a swing goes either way";
    fn drawn(&self, random: &mut Generator) -> Self {
        // k^2 = sin^2(angle / 2) + (omega / (2 w0))^2 is the energy over 2 m g l.
        let double_w0 = 2.0 * (self.gravity / self.length).sqrt();
        let height = |angle: f64| libm::sin(angle / 2.0).powi(2);
        let energy = height(self.angle) + (self.omega / double_w0).powi(2);
        let widest = 2.0 * libm::asin(energy.sqrt().min(1.0));
        let angle = random.between(-widest, widest);
        let sign = if energy < 1.0 { random.sign() } else { self.omega.signum() };
        let omega = sign * double_w0 * (energy - height(angle)).max(0.0).sqrt();
        Self { angle, omega, ..self.clone() }
    }
}

impl Drawn for Kepler {
    const RULE: &'static str = "the semi-major axis is kept, the mean anomaly uniform, the eccentricity vector uniform in the disc up to the \
                                scene's eccentricity";
    fn drawn(&self, random: &mut Generator) -> Self {
        Self { eccentricity: self.eccentricity * random.unit().sqrt(), anomaly: random.angle(), ..self.clone() }
    }
}

macro_rules! spun {
    ($($scene:ident),*) => {$(
        impl Drawn for $scene {
            const RULE: &'static str = "the attitude is uniform on SO(3), omega keeps its length and has a uniform direction";
            fn drawn(&self, random: &mut Generator) -> Self {
                Self { attitude: random.attitude(), omega: turned(self.omega, random), ..self.clone() }
            }
        }
    )*};
}
spun!(SphereTorque, SymmetricTop, TorqueFreeSpin, BoxTumbling);

impl Drawn for HeavyTop {
    const RULE: &'static str = "the attitude is uniform on SO(3), omega is kept in the body";
    fn drawn(&self, random: &mut Generator) -> Self {
        Self { attitude: random.attitude(), ..self.clone() }
    }
}
