//! A free rigid body with a position, here and in a physics engine: what a user pays for one step of it.

use std::cell::{Cell, RefCell};

use integrator::pose::{Body, Exponential, Pose};
use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, RigidModel, Torque};
use integrator::{Method, Real, Rotation, State, drive};
use nalgebra::Vector3;
use rapier3d_f64::prelude::{MassProperties, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, Vector};

use crate::problem::{INERTIA, Problem, Spin};

/// The body of the scene `torque-free-spin`, free to move.
#[derive(Clone, Copy)]
pub struct Brick<T: Real>(Vector3<T>);

impl<T: Real> RigidBody<T> for Brick<T> {
    type Position = Vector3<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        self.0
    }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Vector3<T>>) -> Torque<T> {
        Torque::None
    }
}

/// The model of the body.
pub type Free<T> = BodyOmega<Brick<T>>;
/// Its state.
pub type Moving<T> = State<Pose<T, Exponential<Body>, Vector3<T>>>;

const VELOCITY: [f64; 3] = [0.5, -0.25, 0.75];

/// The body's law and its start, the same in every lane.
pub fn brick<T: Real>() -> (Free<T>, Moving<T>) {
    let [w, x, y, z, a, b, c] = <Spin as Problem<7>>::exact(0.0).map(T::lit);
    let model = BodyOmega::new(Brick(Vector3::from(INERTIA.map(T::lit))));
    let at = Kinematics {
        position: Vector3::repeat(T::lit(0.0)),
        velocity: Vector3::from(VELOCITY.map(T::lit)),
        attitude: Rotation { w, v: Vector3::new(x, y, z) },
        omega_body: Vector3::new(a, b, c),
    };
    let start = model.state(&at);
    (model, start)
}

/// The error of a body's attitude (rad) and position (m) at the time `t_s`: the larger.
fn error(position: Vector3<f64>, attitude: Rotation<f64>, t_s: f64) -> f64 {
    let [w, x, y, z, ..] = <Spin as Problem<7>>::exact(t_s);
    let exact = Vector3::from(VELOCITY) * t_s;
    attitude.angle_to(Rotation::from_wxyz([w, x, y, z])).max((position - exact).norm())
}

/// Bodies that are stepped together.
pub struct Ours<T: Real, A> {
    method: A,
    model: Free<T>,
    bodies: RefCell<Vec<Moving<T>>>,
    steps: Cell<u64>,
    h_s: f64,
}

impl<T: Real, A: Method<T, Free<T>> + Copy> Ours<T, A> {
    /// `count` bodies, or packs of them.
    pub fn new(method: A, count: usize, h_s: f64) -> Self {
        let (model, start) = brick();
        Ours { method, model, bodies: RefCell::new(vec![start; count]), steps: Cell::new(0), h_s }
    }

    /// One step of every body; the rounding of the quaternions is removed as often as the driver does.
    pub fn frame(&self) {
        let (step, method, model, h) = (self.steps.get(), self.method, self.model, T::lit(self.h_s));
        let t = T::lit(step as f64) * h;
        let mut bodies = self.bodies.borrow_mut();
        for s in &mut *bodies {
            *s = method.step(&model, t, h, *s);
        }
        if (step + 1) % drive::SETTLE_EVERY == 0 {
            bodies.iter_mut().for_each(|s| *s = s.settled());
        }
        self.steps.set(step + 1);
    }

    /// So many steps of every body by the driver, one body after the other.
    pub fn drive(&self, steps: u64) {
        let (method, model, h) = (self.method, self.model, T::lit(self.h_s));
        for s in &mut *self.bodies.borrow_mut() {
            // These bodies cannot diverge; were they to, their error would be large.
            *s = drive::advance(&method, &model, *s, h, steps).unwrap_or(*s);
        }
        self.steps.set(self.steps.get() + steps);
    }

    /// The error of the last body by now, given its number in a lane.
    pub fn error(&self, lane: impl Fn(T) -> f64) -> f64 {
        let bodies = self.bodies.borrow();
        bodies.last().map_or(f64::NAN, |s| {
            let attitude = Rotation { w: lane(s.q.attitude.w), v: s.q.attitude.v.map(&lane) };
            error(s.q.position.map(&lane), attitude, self.steps.get() as f64 * self.h_s)
        })
    }
}

/// The same bodies in rapier: no colliders, no gravity, no sleeping, gyroscopic forces (its default) on.
pub struct Rapier {
    world: RefCell<PhysicsWorld>,
    last: RigidBodyHandle,
    frames: Cell<u64>,
    h_s: f64,
}

impl Rapier {
    /// `count` bodies, with one solver iteration or the default of several.
    pub fn new(count: usize, h_s: f64, iterations: Option<usize>) -> Self {
        let mut world = PhysicsWorld { gravity: Vector::ZERO, ..PhysicsWorld::default() };
        world.integration_parameters.dt = h_s;
        if let Some(iterations) = iterations {
            world.integration_parameters.num_solver_iterations = iterations;
        }
        let (model, start) = brick::<f64>();
        let [w, x, y, z] = start.q.attitude.wxyz();
        let omega = start.q.attitude.rotate(start.v.angular);
        let inertia = model.0.0;
        let properties = MassProperties::new(Vector::ZERO, 1.0, Vector::new(inertia.x, inertia.y, inertia.z));
        let mut last = RigidBodyHandle::invalid();
        for _ in 0..count {
            let mut builder = RigidBodyBuilder::dynamic()
                .additional_mass_properties(properties)
                .can_sleep(false)
                .linvel(Vector::from(VELOCITY))
                .angvel(Vector::new(omega.x, omega.y, omega.z));
            builder.position.rotation = rapier3d_f64::math::Rotation::from_xyzw(x, y, z, w);
            last = world.insert_body(builder);
        }
        Rapier { world: RefCell::new(world), last, frames: Cell::new(0), h_s }
    }

    /// One step of the world.
    pub fn frame(&self) {
        self.world.borrow_mut().step();
        self.frames.set(self.frames.get() + 1);
    }

    /// The error of the last body by now.
    pub fn error(&self) -> f64 {
        let world = self.world.borrow();
        let body = &world.bodies[self.last];
        let (x, q) = (body.translation(), body.rotation());
        let attitude = Rotation::from_wxyz([q.w, q.x, q.y, q.z]);
        error(Vector3::new(x.x, x.y, x.z), attitude, self.frames.get() as f64 * self.h_s)
    }
}
