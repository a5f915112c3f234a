//! A scene of which nothing is known at compile time, and the two kinds of scene that become one.

use faer::fx128;
use integrator::rigid_body::{AttitudeUpdate, RigidBody, WorldOmega};
use integrator::{Model, Real};

use crate::displaced::run_displaced;
use crate::erased::{AnyMotion, ErasedPlace, FlatSpace};
use crate::motion::{Motion, RigidMotion};
use crate::observation::Observation;
use crate::residual::{Residual, residual};
use crate::run::{Place, Precision, Run, Shown, Trajectory, run_flat};
use crate::scene::Scene;
use crate::timed;
use crate::timed::{Repetitions, Timing};
use crate::variation::{Leading, leading};

/// A scene whose arithmetic is chosen at run time: one virtual call a trajectory, none a step.
pub trait AnyScene: Send + Sync {
    /// The name on the command line and in tables; a preset is `scene/preset`.
    fn id(&self) -> &'static str;

    /// What it states about itself.
    fn scene(&self) -> &dyn Scene;

    /// The same, to set its parameters.
    fn scene_mut(&mut self) -> &mut dyn Scene;

    /// Whether it is a rigid body: there is then something to choose of what is stored.
    fn is_rigid(&self) -> bool;

    /// The exact motion, in double-double.
    fn exact(&self, t: fx128) -> Observation;

    /// The exact motion in an arithmetic.
    fn exact_in(&self, precision: Precision, t_s: f64) -> Observation;

    /// By how much the exact motion fails its own equation of motion at the time `t`; see [`residual`].
    fn residual(&self, t: fx128, h_s: f64) -> Residual;

    /// Runs one trajectory and observes it at every multiple of `stride` steps, and at the end; `None` for a step that the
    /// scene cannot take, because it is no rigid body.
    fn run(&self, run: &Run, stride: u64) -> Option<Trajectory> {
        self.show(run, Shown::Every(stride))
    }

    /// Runs one trajectory and shows of it what is asked for; `None` as for [`Self::run`].
    fn show(&self, run: &Run, shown: Shown<'_>) -> Option<Trajectory>;

    /// Times a run that nobody observes, in code compiled for it alone; `None` for what is not compiled so: see
    /// [`timed`].
    fn time(&self, run: &Run, laps: Repetitions) -> Option<Timing>;

    /// Runs one trajectory from the start moved by `displacement` (configuration, then velocity) and observes it at the
    /// steps `samples`; `None` on a curved space.
    fn run_displaced(&self, run: &Run, displacement: &[f64], samples: &[u64]) -> Option<Trajectory> {
        let _ = (run, displacement, samples);
        None
    }

    /// The leading errors of the methods whose local errors theory knows, up to `end_s`: see [`leading`].
    fn leading(&self, end_s: f64) -> Vec<Leading>;

    /// The model and its exact motion in f64, of which only the space is known: for methods and models from outside.
    fn any_motion(&self) -> AnyMotion<'_>;
}

/// Particles, or coordinates of a flat space: the scene is the model.
pub struct Particles<S> {
    /// The name of the scene or preset.
    pub id: &'static str,
    /// The scene.
    pub scene: S,
}

/// A rigid body: the scene is the physics, and a model stores one or another quantity of it.
pub struct Rigid<B> {
    /// The name of the scene or preset.
    pub id: &'static str,
    /// The scene.
    pub scene: B,
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
    fn is_rigid(&self) -> bool {
        false
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
    fn show(&self, run: &Run, shown: Shown<'_>) -> Option<Trajectory> {
        in_precision!(run.precision, T => run_flat::<T, <S as Model<T>>::Config>(&self.scene, run, shown))
    }
    fn time(&self, run: &Run, laps: Repetitions) -> Option<Timing> {
        match run.precision {
            Precision::F32 => timed::particles_explicit::<f32, S>(&self.scene, run, laps),
            Precision::F64 => timed::particles(&self.scene, run, laps),
            Precision::DoubleDouble => None,
        }
    }
    fn run_displaced(&self, run: &Run, displacement: &[f64], samples: &[u64]) -> Option<Trajectory> {
        in_precision!(run.precision, T => {
            run_displaced::<T, <S as Model<T>>::Config>(&self.scene, run, displacement, samples)
        })
    }
    fn leading(&self, end_s: f64) -> Vec<Leading> {
        leading::<<S as Model<fx128>>::Config>(&self.scene, end_s, self.scene.info().time_scale_s)
    }
    fn any_motion(&self) -> AnyMotion<'_> {
        <S as Model<f64>>::Config::erase(&self.scene)
    }
}

impl<B> AnyScene for Rigid<B>
where
    B: Scene
        + RigidMotion<f32, Position: Place<f32>>
        + RigidMotion<f64, Position: Place<f64> + ErasedPlace>
        + RigidMotion<fx128, Position: Place<fx128>>,
{
    fn id(&self) -> &'static str {
        self.id
    }
    fn scene(&self) -> &dyn Scene {
        &self.scene
    }
    fn scene_mut(&mut self) -> &mut dyn Scene {
        &mut self.scene
    }
    fn is_rigid(&self) -> bool {
        true
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
    fn show(&self, run: &Run, shown: Shown<'_>) -> Option<Trajectory> {
        Some(in_precision!(run.precision, T => {
            let start = RigidMotion::<T>::exact(&self.scene, T::lit(0.0));
            <B as RigidBody<T>>::Position::show(&self.scene, start, run, shown)
        }))
    }
    fn time(&self, run: &Run, laps: Repetitions) -> Option<Timing> {
        match run.precision {
            _ if run.scheme.update != AttitudeUpdate::Exponential => None,
            Precision::F32 => timed::body_explicit::<f32, B>(&self.scene, run, laps),
            Precision::F64 => timed::body(&self.scene, run, laps),
            Precision::DoubleDouble => None,
        }
    }
    fn leading(&self, end_s: f64) -> Vec<Leading> {
        leading(&WorldOmega::<&B>::new(&self.scene), end_s, self.scene.info().time_scale_s)
    }
    fn any_motion(&self) -> AnyMotion<'_> {
        <B as RigidBody<f64>>::Position::erase(&self.scene)
    }
}
