//! Wrong models and wrong methods, each with one fault.

use std::cell::Cell;

use integrator::methods::{MethodId, Rk4, SemiImplicitEuler, Visitor};
use integrator::pose::{Exponential, Pose, Twist, Update, World};
use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, Torque, WorldOmega};
use integrator::rotation::cross;
use integrator::{Method, Model, Rotation, Space, State, Vector};
use nalgebra::{SVector, Vector3};

use crate::candidate::on_flat;
use scenes::erased::{BodyMotion, FlatModel, FlatMotion};
use scenes::motion::Motion;
use scenes::observation::Observation;
use scenes::run::{Schedule, Trajectory};

/// A flat scene whose force has the wrong sign; its exact motion is the right one.
pub(super) struct Negated<'a, const N: usize>(pub(super) FlatMotion<'a, N>);

impl<const N: usize> Model<f64> for Negated<'_, N> {
    type Config = SVector<f64, N>;

    fn rate(&self, t: f64, s: &State<Self::Config>) -> SVector<f64, N> {
        -self.0.rate(t, s)
    }
    fn contact(&self, before: &State<Self::Config>, after: State<Self::Config>) -> State<Self::Config> {
        self.0.contact(before, after)
    }
}

impl<const N: usize> Motion<f64> for Negated<'_, N> {
    fn exact(&self, t: f64) -> State<Self::Config> {
        self.0.exact(t)
    }
    fn observe(&self, s: &State<Self::Config>) -> Observation {
        self.0.observe(s)
    }
}

/// Runs a built-in method on a flat scene of which only the space is known.
pub(super) fn built_in<const N: usize>(method: MethodId, motion: FlatMotion<'_, N>, clock: Schedule) -> Trajectory {
    struct Driven<'a, const N: usize>(FlatMotion<'a, N>, Schedule);
    impl<'a, const N: usize> Visitor<f64, FlatModel<'a, N>> for Driven<'a, N> {
        type Output = Trajectory;
        fn visit<A: Method<f64, FlatModel<'a, N>>>(self, method: &A) -> Trajectory {
            on_flat(method, self.0, self.1)
        }
    }
    method.visit(Driven(motion, clock))
}

/// What is wrong with a body's loads.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Loads {
    /// Torque and force have the wrong sign.
    Negated,
    /// A multiple of omega x I omega is added to the torque: 1 cancels the gyroscopic term, 2 turns its sign, -1 puts it in
    /// where a model leaves it out.
    Gyroscopic(f64),
    /// A torque in world components is taken for one in body components, and the reverse.
    WrongFrame,
}

/// A rigid body with wrong loads.
pub(super) struct Altered<'a, P> {
    pub(super) body: BodyMotion<'a, P>,
    pub(super) loads: Loads,
}

impl<P: Vector<f64>> RigidBody<f64> for Altered<'_, P> {
    type Position = P;

    fn inertia(&self) -> Vector3<f64> {
        self.body.inertia()
    }
    fn torque(&self, t: f64, at: &Kinematics<f64, P>) -> Torque<f64> {
        let torque = self.body.torque(t, at);
        match (self.loads, torque) {
            (Loads::Gyroscopic(part), torque) => {
                let gyroscopic = cross(at.omega_body, self.inertia().component_mul(&at.omega_body));
                Torque::Body(torque.plus_in_body(at.attitude, gyroscopic * part))
            }
            (Loads::Negated, Torque::World(torque)) => Torque::World(-torque),
            (Loads::Negated, Torque::Body(torque)) => Torque::Body(-torque),
            (Loads::WrongFrame, Torque::World(torque)) => Torque::Body(torque),
            (Loads::WrongFrame, Torque::Body(torque)) => Torque::World(torque),
            (_, Torque::None) => Torque::None,
        }
    }
    fn acceleration(&self, t: f64, at: &Kinematics<f64, P>) -> P {
        let acceleration = self.body.acceleration(t, at);
        if self.loads == Loads::Negated { -acceleration } else { acceleration }
    }
}

/// RK4 with a fault: every stage at the time of the first, or no bracket on a curved space.
pub(super) struct WrongRk4 {
    pub(super) stage_times: bool,
    pub(super) curvature: bool,
}

impl<M: Model<f64>> Method<f64, M> for WrongRk4 {
    fn step(&self, m: &M, t: f64, h: f64, s: State<M::Config>) -> State<M::Config> {
        let after = |part: f64| if self.stage_times { t + part * h } else { t };
        let bracket = |k, c: f64, a, b| if self.curvature { M::Config::plus_bracket(k, c * h, a, b) } else { k };
        let stage = |w, a, part: f64| State { q: s.q.retract(w, part * h), v: s.v.add_scaled(a, part * h) };
        let (w1, a1) = (m.velocity(s.q, s.v), m.rate(t, &s));
        let s2 = stage(w1, a1, 0.5);
        let (w2, a2) = (m.velocity(s2.q, s2.v), m.rate(after(0.5), &s2));
        let s3 = stage(bracket(w2, -0.25, w1, w2), a2, 0.5);
        let (w3, a3) = (m.velocity(s3.q, s3.v), m.rate(after(0.5), &s3));
        let s4 = stage(w3, a3, 1.0);
        let (w4, a4) = (m.velocity(s4.q, s4.v), m.rate(after(1.0), &s4));
        let w = bracket((w1 + w4).add_scaled(w2 + w3, 2.0), -0.5, w1, w4);
        let a = (a1 + a4).add_scaled(a2 + a3, 2.0);
        State { q: s.q.retract(w, h / 6.0), v: s.v.add_scaled(a, h / 6.0) }
    }
}

/// RK4 that sums its time, t += h, where it should be i h.
#[derive(Default)]
pub(super) struct AccumulatedTime(Cell<f64>);

impl<M: Model<f64>> Method<f64, M> for AccumulatedTime {
    fn step(&self, m: &M, _t: f64, h: f64, s: State<M::Config>) -> State<M::Config> {
        let t = self.0.get();
        self.0.set(t + h);
        Rk4.step(m, t, h, s)
    }
}

/// RK4 in f64 whose state is stored in f32 between the steps.
pub(super) struct StoredInSingle;

impl<M: Model<f64, Config: Vector<f64>>> Method<f64, M> for StoredInSingle {
    fn step(&self, m: &M, t: f64, h: f64, s: State<M::Config>) -> State<M::Config> {
        let State { q, v } = Rk4.step(m, t, h, s);
        let single = |x: f64| f64::from(x as f32);
        State { q: Vector::from_fn(|i| single(q.component(i))), v: Vector::from_fn(|i| single(v.component(i))) }
    }
}

/// Velocity Verlet whose second kick takes the force of the first: v1 = v0 + h a0.
pub(super) struct StaleForce;

impl<M: Model<f64>> Method<f64, M> for StaleForce {
    fn step(&self, m: &M, t: f64, h: f64, s: State<M::Config>) -> State<M::Config> {
        let a0 = m.rate(t, &s);
        let u = s.v.add_scaled(a0, 0.5 * h);
        State { q: s.q.retract(m.velocity(s.q, u), h), v: u.add_scaled(a0, 0.5 * h) }
    }
}

/// Semi-implicit Euler in body components whose increment multiplies from the left, as one in world components does.
pub(super) struct WrongSide;

impl<B: RigidBody<f64>, U: Update<Frame = integrator::pose::Body>> Method<f64, BodyOmega<B, U>> for WrongSide {
    fn step(
        &self,
        m: &BodyOmega<B, U>,
        t: f64,
        h: f64,
        s: State<Pose<f64, U, B::Position>>,
    ) -> State<Pose<f64, U, B::Position>> {
        let v = m.kick(t, h, &s);
        let attitude = Exponential::<World>::increment(v.angular, h) * s.q.attitude;
        State { q: Pose::new(s.q.position.add_scaled(v.linear, h), attitude), v }
    }
}

/// Semi-implicit Euler in world components whose quaternion nobody normalises: q1 = q0 + h/2 (0, omega1) q0 where it is
/// `linear`, else the exponential map.
pub(super) struct NotNormalised {
    pub(super) linear: bool,
}

impl<B: RigidBody<f64>> Method<f64, WorldOmega<B>> for NotNormalised {
    fn step(
        &self,
        m: &WorldOmega<B>,
        t: f64,
        h: f64,
        s: State<Pose<f64, Exponential<World>, B::Position>>,
    ) -> State<Pose<f64, Exponential<World>, B::Position>> {
        let State { q, v } = SemiImplicitEuler.step(m, t, h, s);
        let Twist { angular, .. } = v;
        let attitude = Rotation { w: 1.0, v: angular * (0.5 * h) } * s.q.attitude;
        State { q: if self.linear { Pose::new(q.position, attitude) } else { q }, v }
    }
}
