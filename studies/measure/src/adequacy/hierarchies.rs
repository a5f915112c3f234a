//! For each scene a ladder of models, from the least that one might get away with to the full one.

use std::any::Any;

use faer::fx128;
use integrator::counted::Counted;
use integrator::methods::{MethodId, Rk4, SemiImplicitEuler, VelocityVerlet};
use integrator::pose::Fixed;
use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, RigidModel, Torque, WithoutGyroscopicTerm};
use integrator::{Model, Real, Rotation, State, Vector, drive};
use nalgebra::{Vector1, Vector2, Vector3};

use crate::operations;
use crate::operations::{Counting, Lift};
use scenes::any::AnyScene;
use scenes::motion::{Motion, RigidMotion};
use scenes::observation::{Observation, Quantity};
use scenes::scene::Scene;
use scenes::{
    BoxTumbling, HeavyTop, Kepler, LinearDrag, Pendulum, PrincipalAxisTorque, QuadraticDrag, SphereTorque,
    TorqueFreeSpin,
};

/// The methods that a ladder is climbed with: explicit ones, of which an operation count says what a step costs.
pub const METHODS: [MethodId; 3] = [MethodId::SemiImplicitEuler, MethodId::VelocityVerlet, MethodId::Rk4];

/// The end of a run: what is seen, and how often the force law was evaluated.
pub struct End {
    /// What is seen; `None` where the run left the finite numbers.
    pub seen: Option<Observation>,
    /// Evaluations of the force law.
    pub evaluations: u64,
}

type Run = Box<dyn Fn(MethodId, f64, u64) -> Option<End> + Send + Sync>;
type Cost = Box<dyn Fn(MethodId) -> Option<u64> + Send + Sync>;

/// One model of a scene.
pub struct Level {
    /// What it models, or leaves out.
    pub model: &'static str,
    /// Whether its motion is the scene's, as far as the quantity of the ladder goes.
    pub consistent: bool,
    /// Runs it: method, end in s, steps. `None` for a method that is not among [`METHODS`].
    pub run: Run,
    /// Operations of one step.
    pub operations: Cost,
}

/// The models of one scene, the least first, the full one last.
pub struct ModelHierarchy {
    /// The scene.
    pub scene: Box<dyn AnyScene>,
    /// Its name among hierarchies.
    pub name: &'static str,
    /// What is asked of the scene.
    pub quantity: Quantity,
    /// The models.
    pub rungs: Vec<Level>,
}

fn rung<M>(
    model: &'static str,
    consistent: bool,
    m: M,
    start: State<<M as Model<f64>>::Config>,
    see: impl Fn(&State<<M as Model<f64>>::Config>) -> Observation + Send + Sync + 'static,
) -> Level
where
    M: Model<f64> + Model<Counting> + Clone + Send + Sync + 'static,
    State<<M as Model<f64>>::Config>: Lift<Lifted = State<<M as Model<Counting>>::Config>>,
{
    let costed = m.clone();
    let run = move |method: MethodId, end_s: f64, steps: u64| {
        let counted = Counted::new(&m);
        let h = end_s / steps as f64;
        let end = match method {
            MethodId::SemiImplicitEuler => drive::advance(&SemiImplicitEuler, &counted, start, h, steps),
            MethodId::VelocityVerlet => drive::advance(&VelocityVerlet, &counted, start, h, steps),
            MethodId::Rk4 => drive::advance(&Rk4, &counted, start, h, steps),
            _ => return None,
        };
        Some(End { seen: end.ok().map(|s| see(&s)), evaluations: counted.evaluations() })
    };
    let operations = move |method: MethodId| match method {
        MethodId::SemiImplicitEuler => Some(operations::of_step(&SemiImplicitEuler, &costed, start.lift())),
        MethodId::VelocityVerlet => Some(operations::of_step(&VelocityVerlet, &costed, start.lift())),
        MethodId::Rk4 => Some(operations::of_step(&Rk4, &costed, start.lift())),
        _ => None,
    };
    Level { model, consistent, run: Box::new(run), operations: Box::new(operations) }
}

/// theta'' = acceleration, about one fixed axis.
#[derive(Clone, Copy, Debug)]
struct OneAngle {
    acceleration: f64,
}

impl<T: Real> Model<T> for OneAngle {
    type Config = Vector1<T>;
    fn rate(&self, _t: T, _s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(T::lit(self.acceleration))
    }
}

/// x'' = gravity.
#[derive(Clone, Copy, Debug)]
struct Fall<const N: usize> {
    gravity: [f64; N],
}

impl<T: Real, const N: usize> Model<T> for Fall<N> {
    type Config = nalgebra::SVector<T, N>;
    fn rate(&self, _t: T, _s: &State<Self::Config>) -> Self::Config {
        Self::Config::from_fn(|i, _| T::lit(self.gravity[i]))
    }
}

/// theta'' = -w^2 theta.
#[derive(Clone, Copy, Debug)]
struct SmallAngle {
    w_squared: f64,
}

impl<T: Real> Model<T> for SmallAngle {
    type Config = Vector1<T>;
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        s.q * T::lit(-self.w_squared)
    }
}

/// The body turns about the axis it spins about at the start, and nothing changes that.
fn one_angle<B: RigidMotion<f64>>(body: &B, acceleration: f64, consistent: bool) -> Level {
    let at = body.exact(0.0);
    let rate = at.omega_body.norm();
    // A body at rest begins to turn about the axis of its torque.
    let begins = match body.torque(0.0, &at) {
        Torque::World(torque) => at.attitude.rotate_back(torque),
        Torque::Body(torque) => torque,
        Torque::None => Vector3::z(),
    };
    let along = if rate > 0.0 { at.omega_body } else { begins };
    let axis = (along / along.norm().max(f64::MIN_POSITIVE)).map(fx128::lit);
    let acceleration = if rate > 0.0 { acceleration } else { acceleration.abs() };
    let attitude = Rotation { w: fx128::lit(at.attitude.w), v: at.attitude.v.map(fx128::lit) };
    let start = State { q: Vector1::new(0.0), v: Vector1::new(rate) };
    rung("one angle instead of an attitude", consistent, OneAngle { acceleration }, start, move |s| {
        Observation::of_motion(&Kinematics {
            position: Fixed::<fx128>::zero(),
            velocity: Fixed::zero(),
            attitude: attitude * Rotation::exp(axis * fx128::lit(s.q.x)),
            omega_body: axis * fx128::lit(s.v.x),
        })
    })
}

trait Body: RigidMotion<f64> + RigidBody<Counting> + Clone + Send + Sync + 'static {}
impl<B: RigidMotion<f64> + RigidBody<Counting> + Clone + Send + Sync + 'static> Body for B {}

fn rigid<M, B: Body>(name: &'static str, consistent: bool, model: M, body: &B) -> Level
where
    M: RigidModel<f64> + Model<Counting> + Clone + Send + Sync + 'static,
    M::Body: RigidBody<f64, Position = <B as RigidBody<f64>>::Position>,
    State<<M as Model<f64>>::Config>: Lift<Lifted = State<<M as Model<Counting>>::Config>>,
{
    let start = model.state(&body.exact(0.0));
    let seen = model.clone();
    rung(name, consistent, model, start, move |s| Observation::of_body(&seen, s))
}

const FULL: &str = "full";
const NO_GYROSCOPIC_TERM: &str = "no gyroscopic term";
const SPHERE: &str = "sphere instead of tensor";

macro_rules! full {
    ($scene:expr) => {
        rigid(FULL, true, BodyOmega::<_>::new($scene.clone()), &$scene)
    };
}
macro_rules! no_gyroscopic_term {
    ($scene:expr, $consistent:expr) => {
        rigid(NO_GYROSCOPIC_TERM, $consistent, WithoutGyroscopicTerm::<_>::new($scene.clone()), &$scene)
    };
}

fn ladder(name: &'static str, scene: Box<dyn AnyScene>, quantity: Quantity, rungs: Vec<Level>) -> ModelHierarchy {
    ModelHierarchy { scene, name, quantity, rungs }
}

/// Every ladder, with the parameters of the first of `scenes` that is its own, or the default ones.
pub fn all(scenes: &[Box<dyn AnyScene>]) -> Vec<ModelHierarchy> {
    let mut all = rotations(scenes);
    all.extend(translations(scenes));
    let swing: Pendulum = own(scenes, "pendulum");
    // A swing of a thousandth of a radian: what the small angle leaves out is a part in 10^7 of it.
    let small = Pendulum { angle: 1e-3, omega: 1e-3, ..swing.clone() };
    let at_rest = swing.angle == 0.0 && swing.omega == 0.0;
    all.extend([pendulum("pendulum", swing, at_rest)]);
    all.extend([pendulum("pendulum-1-mrad", small, false)]);
    all
}

/// The scene of that name, of whatever preset.
fn own<S: Scene + Default + Clone>(scenes: &[Box<dyn AnyScene>], base: &str) -> S {
    let of_base = scenes.iter().filter(|scene| scene.id().split('/').next() == Some(base));
    let mut own = of_base.filter_map(|scene| (scene.scene() as &dyn Any).downcast_ref::<S>());
    own.next().cloned().unwrap_or_default()
}

/// Whether omega x I omega vanishes along the exact motion of a body: nothing is lost without it.
fn keeps_its_axis<B: RigidMotion<f64> + Scene>(body: &B) -> bool {
    let (i, end_s) = (RigidBody::<f64>::inertia(body), body.info().horizon_s);
    (0..=32).all(|k| {
        let w = body.exact(end_s * f64::from(k) / 32.0).omega_body;
        let turned = [(i.z - i.y) * w.y * w.z, (i.x - i.z) * w.z * w.x, (i.y - i.x) * w.x * w.y];
        Vector3::from(turned).component_div(&i).norm() * end_s * end_s <= UNSEEN
    })
}

/// A turn that no run in f64 shows, rad.
const UNSEEN: f64 = 1e-13;

fn rotations(scenes: &[Box<dyn AnyScene>]) -> Vec<ModelHierarchy> {
    let attitude = Quantity::Attitude;
    let free: TorqueFreeSpin = own(scenes, "torque-free-spin");
    let top: HeavyTop = own(scenes, "heavy-top");
    let [steady, top_steady] = [keeps_its_axis(&free), keeps_its_axis(&top)];
    let upright = top_steady && scenes_still(&top);
    let round_is_right = top.inertia_1 == top.inertia_3 || top.omega[2] == 0.0 || upright;
    let round_top = HeavyTop { inertia_3: top.inertia_1, ..top.clone() };
    let spun: PrincipalAxisTorque = own(scenes, "principal-axis-torque");
    let sphere: SphereTorque = own(scenes, "sphere-torque");
    let boxed: BoxTumbling = own(scenes, "box-tumbling");
    let box_steady = keeps_its_axis(&boxed);
    // Along the axis of the spin; a body at rest starts about that of the torque.
    let sense = if spun.omega < 0.0 { -1.0 } else { 1.0 };
    let acceleration = spun.torque / spun.inertia[spun.axis as usize] * sense;
    let rungs = vec![one_angle(&free, 0.0, steady), no_gyroscopic_term!(free, steady), full!(free)];
    let of_free = ladder("torque-free-spin", scenes::boxed("torque-free-spin", free), attitude, rungs);
    let round = rigid(SPHERE, round_is_right, BodyOmega::<_>::new(round_top), &top);
    let rungs = vec![one_angle(&top, 0.0, upright), round, no_gyroscopic_term!(top, top_steady), full!(top)];
    let of_top = ladder("heavy-top", scenes::boxed("heavy-top", top), attitude, rungs);
    let rungs = vec![one_angle(&spun, acceleration, true), no_gyroscopic_term!(spun, true), full!(spun)];
    let of_spun = ladder("principal-axis-torque", scenes::boxed("principal-axis-torque", spun), attitude, rungs);
    let rungs =
        vec![one_angle(&sphere, 0.0, sphere.torque == [0.0; 3]), no_gyroscopic_term!(sphere, true), full!(sphere)];
    let of_sphere = ladder("sphere-torque", scenes::boxed("sphere-torque", sphere), attitude, rungs);
    let rungs = vec![no_gyroscopic_term!(boxed, box_steady), full!(boxed)];
    let of_box = ladder("box-tumbling attitude", scenes::boxed("box-tumbling", boxed.clone()), attitude, rungs);
    let start = State { q: Vector3::from(boxed.x0), v: Vector3::from(boxed.v0) };
    let point = rung("translation only", true, Fall { gravity: boxed.gravity }, start, Observation::particles);
    let rungs = vec![point, full!(boxed)];
    let of_point = ladder("box-tumbling position", scenes::boxed("box-tumbling", boxed), Quantity::Position, rungs);
    vec![of_free, of_top, of_spun, of_sphere, of_box, of_point]
}

/// Whether the axis of a top stands still.
fn scenes_still(top: &HeavyTop) -> bool {
    let end_s = top.info().horizon_s;
    let up = |t: f64| {
        let at: Kinematics<f64, Fixed<f64>> = top.exact(t);
        at.attitude.rotate_back(Vector3::new(0.0, 0.0, 1.0))
    };
    let start = up(0.0);
    (0..=32).all(|k| up(end_s * f64::from(k) / 32.0).z.abs() >= 1.0 - f64::EPSILON)
        && start.z.abs() >= 1.0 - f64::EPSILON
}

fn translations(scenes: &[Box<dyn AnyScene>]) -> Vec<ModelHierarchy> {
    let position = Quantity::Position;
    let linear: LinearDrag = own(scenes, "linear-drag");
    let quadratic: QuadraticDrag = own(scenes, "quadratic-drag");
    let planet: Kepler = own(scenes, "kepler");
    let start = Motion::<f64>::exact(&linear, 0.0);
    let fall = rung("no drag", false, Fall { gravity: linear.gravity }, start, Observation::particles);
    let full = rung(FULL, true, linear.clone(), start, Observation::particles);
    let of_linear = ladder("linear-drag", scenes::boxed("linear-drag", linear), position, vec![fall, full]);
    let start = Motion::<f64>::exact(&quadratic, 0.0);
    let fall = rung("no drag", false, Fall { gravity: [quadratic.gravity] }, start, Observation::particles);
    let full = rung(FULL, true, quadratic.clone(), start, Observation::particles);
    let of_quadratic =
        ladder("quadratic-drag", scenes::boxed("quadratic-drag/fall", quadratic), position, vec![fall, full]);
    let start: State<Vector2<f64>> = Motion::<f64>::exact(&planet, 0.0);
    // The gravity of the place where the planet starts.
    let gravity = start.q * (-planet.mu / start.q.norm().powi(3));
    let fall = rung("uniform gravity", false, Fall { gravity: gravity.into() }, start, Observation::particles);
    let full = rung(FULL, true, planet.clone(), start, Observation::particles);
    let of_planet = ladder("kepler", scenes::boxed("kepler", planet), position, vec![fall, full]);
    vec![of_linear, of_quadratic, of_planet]
}

fn pendulum(name: &'static str, scene: Pendulum, consistent: bool) -> ModelHierarchy {
    let start = Motion::<f64>::exact(&scene, 0.0);
    let model = SmallAngle { w_squared: scene.gravity / scene.length };
    let rungs = vec![
        rung("small angle", consistent, model, start, Observation::angle),
        rung(FULL, true, scene.clone(), start, Observation::angle),
    ];
    ladder(name, scenes::boxed("pendulum", scene), Quantity::Attitude, rungs)
}
