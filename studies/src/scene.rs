//! What a scene is: a model with its exact motion in any arithmetic, and what is known about it beforehand.

use std::any::Any;

use faer::fx128;
use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::{Kinematics, RigidBody, RigidModel, WorldOmega};
use integrator::{Model, Real, Single, State};
use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};

use crate::displaced::run_displaced;
use crate::erased::{AnyMotion, FlatSpace, Place};
use crate::error::Error;
use crate::growth::Law;
use crate::observation::{Observation, Quantity};
use crate::residual::{Residual, residual};
use crate::run::{Precision, Run, Trajectory, run_body, run_model, run_step};
use crate::scenes::parameters::Parameters;
#[cfg(feature = "programs")]
use crate::tradeoff::timed::{self, Lap, Laps};

/// What a reader should know of a scene before looking at its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Info {
    /// One line: what moves, and why it is looked at.
    pub about: &'static str,
    /// The equation of motion, in LaTeX.
    pub equation: &'static str,
    /// Where the exact motion comes from.
    pub source: &'static str,
    /// End of an error run, s: dyadic, and neither a period nor half of one.
    pub horizon_s: f64,
    /// Natural time scale, s: 1/omega, 1/k, ...
    pub time_scale_s: f64,
    /// Steps of the coarsest run of a sweep, a power of two.
    pub coarsest_steps: u64,
}

/// A quantity that a scene keeps account of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Balance {
    /// Kinetic plus potential energy, J.
    Energy,
    /// Linear momentum, kg m/s.
    Momentum,
    /// Angular momentum about the centre of mass, the fixed point or the centre of force, kg m^2/s.
    AngularMomentum,
}

impl Balance {
    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            Balance::Energy => "energy",
            Balance::Momentum => "momentum",
            Balance::AngularMomentum => "angular-momentum",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Balance::Energy => "J",
            Balance::Momentum => "kg m/s",
            Balance::AngularMomentum => "kg m^2/s",
        }
    }
}

/// One line of a scene's account.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What is accounted for.
    pub balance: Balance,
    /// Its value: one component for a scalar, three for a vector.
    pub value: Vec<fx128>,
    /// Whether the exact motion conserves it.
    pub conserved: bool,
}

/// What theory predicts for one method and quantity of a scene, beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theory {
    /// The order of convergence at the horizon.
    pub order: ExpectedOrder,
    /// lim error(T) / h^order, in the quantity's unit / s^order, where known.
    pub constant: Option<f64>,
    /// Where it comes from, or why it is not the method's own order.
    pub reason: &'static str,
}

/// The order that theory predicts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExpectedOrder {
    /// No error but rounding.
    Exact,
    /// error ~ h^order.
    Of(f64),
    /// error <= C h^order, and no better than that over a sweep: an event that falls anywhere in a step (a bounce, a kink of
    /// the force) makes error / h^order jump from step to step between its bounds. The constant of [`Theory`] is C.
    Envelope(f64),
}

impl Theory {
    /// The order that the method has on every smooth problem.
    pub fn usual(method: MethodId) -> Self {
        Theory {
            order: ExpectedOrder::Of(f64::from(method.order())),
            constant: None,
            reason: "the method's order on a smooth problem",
        }
    }

    /// No error but rounding.
    pub fn exact(reason: &'static str) -> Self {
        Theory { order: ExpectedOrder::Exact, constant: None, reason }
    }

    /// The usual order with a known error constant; a constant of zero would mean a higher order.
    pub fn with_constant(method: MethodId, constant: f64, reason: &'static str) -> Self {
        Theory { constant: Some(constant.abs()), reason, ..Self::usual(method) }
    }
}

/// How theory says that the error of a balance grows over a long run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedGrowth {
    /// The law.
    pub law: Law,
    /// For a bounded law the bounds of value / start, for an exponential one its rate in 1/s twice.
    pub bounds: Option<[f64; 2]>,
    /// Where it comes from.
    pub reason: &'static str,
}

/// The largest step with which a method does not fail on a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StabilityLimit {
    /// Every step fails, sooner or later.
    NoStep,
    /// Steps below this fail not, steps above do; s.
    Below(f64),
    /// No step fails.
    Unlimited,
}

/// What every scene states about itself, in no particular arithmetic.
pub trait Scene: Parameters + Any + Send + Sync {
    /// Horizon, time scale, source.
    fn info(&self) -> Info;

    /// Whether the parameters fit together.
    ///
    /// # Errors
    /// What does not, naming the parameter, its value and what is allowed.
    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    /// Energy and momenta of an observed state.
    fn account(&self, t: fx128, seen: &Observation) -> Vec<Entry>;

    /// Times up to the horizon at which the exact motion is not smooth: bounces, kinks of the force.
    fn breaks_s(&self) -> Vec<f64> {
        Vec::new()
    }

    /// What theory says of a method's error in a quantity at the horizon.
    fn theory(&self, method: MethodId, quantity: Quantity) -> Theory {
        let _ = quantity;
        Theory::usual(method)
    }

    /// What theory says of the error of a balance over a long run with the step `h_s`, where it says anything.
    fn growth(&self, method: MethodId, balance: Balance, h_s: f64) -> Option<ExpectedGrowth> {
        let _ = (method, balance, h_s);
        None
    }

    /// The largest stable step of a method and where the formula comes from, where theory says anything.
    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        let _ = method;
        None
    }
}

/// A model with its exact motion in the arithmetic `T`.
pub trait Motion<T: Single>: Model<T> {
    /// The exact state at the time `t`, in what the model stores.
    fn exact(&self, t: T) -> State<Self::Config>;
    /// What can be seen of a state.
    fn observe(&self, s: &State<Self::Config>) -> Observation;
}

/// A state that was computed in double-double, rounded once. Exact motions are evaluated so in every arithmetic: the truth
/// then has no rounding but the last, whatever the time and however the formula is conditioned.
pub(crate) fn rounded<T: Single, const R: usize, const C: usize>(
    q: SMatrix<fx128, R, C>,
    v: SMatrix<fx128, R, C>,
) -> State<SMatrix<T, R, C>> {
    State { q: q.map(T::narrow), v: v.map(T::narrow) }
}

/// A rigid body with its exact motion in the arithmetic `T`.
pub trait RigidMotion<T: Single>: RigidBody<T> {
    /// The exact motion at the time `t`.
    fn exact(&self, t: T) -> Kinematics<T, Self::Position>;
}

/// The model whose equation of motion a rigid body's exact motion is held against.
impl<T: Single, B: RigidMotion<T>> Motion<T> for WorldOmega<&B> {
    fn exact(&self, t: T) -> State<Self::Config> {
        self.state(&self.0.exact(t))
    }
    fn observe(&self, s: &State<Self::Config>) -> Observation {
        Observation::of_body(self, s)
    }
}

/// A scene whose arithmetic is chosen at run time: one virtual call a trajectory, none a step.
pub trait AnyScene: Send + Sync {
    /// The name on the command line and in tables; a preset is `scene/preset`.
    fn id(&self) -> &'static str;

    /// What it states about itself.
    fn scene(&self) -> &dyn Scene;

    /// The same, to set its parameters.
    fn scene_mut(&mut self) -> &mut dyn Scene;

    /// The exact motion, in double-double.
    fn exact(&self, t: fx128) -> Observation;

    /// The exact motion in an arithmetic.
    fn exact_in(&self, precision: Precision, t_s: f64) -> Observation;

    /// By how much the exact motion fails its own equation of motion at the time `t`; see [`residual`].
    fn residual(&self, t: fx128, h_s: f64) -> Residual;

    /// Runs one trajectory and observes it at every multiple of `stride` steps, and at the end.
    fn run(&self, run: &Run, stride: u64) -> Trajectory;

    /// The same with a step that exists for rigid bodies only; `None` where the scene is not a rigid body.
    fn run_step(&self, run: &Run<RigidStep>, stride: u64) -> Option<Trajectory> {
        let _ = (run, stride);
        None
    }

    /// Times a run that nobody observes, in code compiled for it alone; `None` for what is not compiled so: see
    /// [`timed`].
    #[cfg(feature = "programs")]
    fn time(&self, run: &Run, laps: Laps) -> Option<Lap>;

    /// The same with a step that exists for rigid bodies only.
    #[cfg(feature = "programs")]
    fn time_step(&self, run: &Run<RigidStep>, laps: Laps) -> Option<Lap> {
        let _ = (run, laps);
        None
    }

    /// Runs one trajectory from the start moved by `displacement` (configuration, then velocity) and observes it at the
    /// steps `looks`; `None` on a curved space.
    fn run_displaced(&self, run: &Run, displacement: &[f64], looks: &[u64]) -> Option<Trajectory> {
        let _ = (run, displacement, looks);
        None
    }

    /// The model and its exact motion in f64, of which only the space is known: for methods and models from outside.
    fn any_motion(&self) -> AnyMotion<'_>;
}

/// Particles, or coordinates of a flat space: the scene is the model.
pub(crate) struct Particles<S> {
    pub(crate) id: &'static str,
    pub(crate) scene: S,
}

/// A rigid body: the scene is the physics, and a model stores one or another quantity of it.
pub(crate) struct Rigid<B> {
    pub(crate) id: &'static str,
    pub(crate) scene: B,
}

impl<S: Scene + Motion<f32> + Motion<f64, Config: FlatSpace> + Motion<fx128>> AnyScene for Particles<S> {
    fn id(&self) -> &'static str {
        self.id
    }
    fn scene(&self) -> &dyn Scene {
        &self.scene
    }
    fn scene_mut(&mut self) -> &mut dyn Scene {
        &mut self.scene
    }
    fn exact(&self, t: fx128) -> Observation {
        Motion::<fx128>::observe(&self.scene, &self.scene.exact(t))
    }
    fn exact_in(&self, precision: Precision, t_s: f64) -> Observation {
        in_precision!(precision, T => Motion::<T>::observe(&self.scene, &self.scene.exact(T::lit(t_s))))
    }
    fn residual(&self, t: fx128, h_s: f64) -> Residual {
        residual(&self.scene, t, h_s)
    }
    fn run(&self, run: &Run, stride: u64) -> Trajectory {
        in_precision!(run.precision, T => run_model::<T, S>(&self.scene, run, stride))
    }
    #[cfg(feature = "programs")]
    fn time(&self, run: &Run, laps: Laps) -> Option<Lap> {
        match run.precision {
            Precision::F32 => timed::particles_explicit::<f32, S>(&self.scene, run, laps),
            Precision::F64 => Some(timed::particles(&self.scene, run, laps)),
            Precision::DoubleDouble => None,
        }
    }
    fn run_displaced(&self, run: &Run, displacement: &[f64], looks: &[u64]) -> Option<Trajectory> {
        Some(in_precision!(run.precision, T => run_displaced::<T, S>(&self.scene, run, displacement, looks)))
    }
    fn any_motion(&self) -> AnyMotion<'_> {
        <S as Model<f64>>::Config::erase(&self.scene)
    }
}

impl<B: Scene + RigidMotion<f32> + RigidMotion<f64, Position: Place> + RigidMotion<fx128>> AnyScene for Rigid<B> {
    fn id(&self) -> &'static str {
        self.id
    }
    fn scene(&self) -> &dyn Scene {
        &self.scene
    }
    fn scene_mut(&mut self) -> &mut dyn Scene {
        &mut self.scene
    }
    fn exact(&self, t: fx128) -> Observation {
        Observation::of_motion(&RigidMotion::<fx128>::exact(&self.scene, t))
    }
    fn exact_in(&self, precision: Precision, t_s: f64) -> Observation {
        let model = WorldOmega::<&B>::new(&self.scene);
        in_precision!(precision, T => Motion::<T>::observe(&model, &Motion::<T>::exact(&model, T::lit(t_s))))
    }
    fn residual(&self, t: fx128, h_s: f64) -> Residual {
        residual(&WorldOmega::<&B>::new(&self.scene), t, h_s)
    }
    fn run(&self, run: &Run, stride: u64) -> Trajectory {
        in_precision!(run.precision, T => run_body::<T, B>(&self.scene, run, stride))
    }
    #[cfg(feature = "programs")]
    fn time(&self, run: &Run, laps: Laps) -> Option<Lap> {
        match run.precision {
            _ if run.update != integrator::rigid_body::AttitudeUpdate::Exponential => None,
            Precision::F32 => timed::body_explicit::<f32, B>(&self.scene, run, laps),
            Precision::F64 => timed::body(&self.scene, run, laps),
            Precision::DoubleDouble => None,
        }
    }
    #[cfg(feature = "programs")]
    fn time_step(&self, run: &Run<RigidStep>, laps: Laps) -> Option<Lap> {
        match run.precision {
            Precision::F32 => Some(timed::step::<f32, B>(&self.scene, run, laps)),
            Precision::F64 => Some(timed::step::<f64, B>(&self.scene, run, laps)),
            Precision::DoubleDouble => None,
        }
    }
    fn run_step(&self, run: &Run<RigidStep>, stride: u64) -> Option<Trajectory> {
        Some(in_precision!(run.precision, T => run_step::<T, B>(&self.scene, run, stride)))
    }
    fn any_motion(&self) -> AnyMotion<'_> {
        <B as RigidBody<f64>>::Position::erase(&self.scene)
    }
}
