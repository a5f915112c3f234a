//! The steps that exist for rigid bodies, each against its own definition: the order under a torque that depends on
//! everything, the equation that it solves, what it conserves; and the frames in which torques and velocities are given.
//!
//! Not seen here: their laws without a torque over a long run (rotation.rs).

use integrator::methods::{
    FreeSplitting, ImplicitGyroscopic, MomentumMidpoint, RestoredMomentum, Rk4, SemiImplicitEuler,
};
use integrator::pose::Fixed;
use integrator::rigid_body::{
    AttitudeUpdate, BodyOmega, Formulation, Kinematics, RigidBody, RigidModel, Torque, WithoutGyroscopicTerm,
    WorldMomentum, WorldOmega,
};
use integrator::rotation::cross;
use integrator::{Method, Pose, Rotation, Space, State, Vector, drive};
use nalgebra::{Vector1, Vector3};

const INERTIA: [f64; 3] = [1.25, 0.75, 1.75];

/// A driven body; its torque is handed out in world components, or in body components.
#[derive(Clone, Copy)]
struct Driven {
    in_body: bool,
    strength: f64,
}

impl RigidBody<f64> for Driven {
    type Position = Vector3<f64>;

    fn inertia(&self) -> Vector3<f64> {
        Vector3::from(INERTIA)
    }
    fn torque(&self, t: f64, at: &Kinematics<f64, Vector3<f64>>) -> Torque<f64> {
        let (up, omega) = (at.attitude.rotate(Vector3::new(0.25, -0.5, 1.0)), at.attitude.rotate(at.omega_body));
        let world = (Vector3::new(0.5, (2.0 * t).cos(), -0.75) + cross(up, at.velocity) - omega * 0.25) * self.strength;
        if self.in_body { Torque::Body(at.attitude.rotate_back(world)) } else { Torque::World(world) }
    }
    fn acceleration(&self, t: f64, at: &Kinematics<f64, Vector3<f64>>) -> Vector3<f64> {
        Vector3::new(t.sin(), 0.5, -1.0) - at.position - at.velocity * 0.125
    }
}

fn start<M: RigidModel<f64, Body = Driven>>(model: &M) -> State<M::Config> {
    model.state(&Kinematics {
        position: Vector3::new(0.5, -0.25, 0.75),
        velocity: Vector3::new(-0.5, 1.0, 0.25),
        attitude: Rotation::from_wxyz([0.5, -0.75, 1.0, 0.25]),
        omega_body: Vector3::new(1.5, -0.75, 1.0),
    })
}

/// Position, velocity, attitude and angular velocity in the body frame at t = 1 s.
fn end<M: RigidModel<f64, Body = Driven>, A: Method<f64, M>>(method: &A, model: &M, steps: u64) -> [f64; 13] {
    let s = drive::advance(method, model, start(model), 1.0 / steps as f64, steps).expect("finite");
    let at = model.kinematics(&s);
    let ([w, x, y, z], p, v, o) = (at.attitude.wxyz(), at.position, at.velocity, at.omega_body);
    [p.x, p.y, p.z, v.x, v.y, v.z, w, x, y, z, o.x, o.y, o.z]
}

fn distance(a: [f64; 13], b: [f64; 13]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// log2 of the ratio of the changes from n to 2n and from 2n to 4n steps: p + O(h).
fn order<M: RigidModel<f64, Body = Driven>, A: Method<f64, M>>(method: &A, model: &M, steps: u64) -> f64 {
    let [a, b, c] = [1, 2, 4].map(|k| end(method, model, steps * k));
    (distance(a, b) / distance(b, c)).log2()
}

/// The step's own order, and the motion that it converges to is that of RK4 in the world frame: a step that is consistent with
/// another law converges too.
#[test]
fn every_rigid_step_has_its_order_under_a_torque_that_depends_on_everything() {
    let body = Driven { in_body: false, strength: 1.0 };
    let (in_body, in_world) = (BodyOmega::<Driven>::new(body), WorldMomentum::<Driven>::new(body));
    let truth = end(&Rk4, &WorldOmega::<Driven>::new(body), 4096);
    let held = |name: &str, expected: f64, order: f64, error: f64, h: f64| {
        assert!((order - expected).abs() < 0.1, "{name}: order {order}");
        // No error constant of these exceeds 8 at rates of about 2 rad/s: a wrong law is off by more than 0.1.
        assert!(error < 8.0 * h.powf(expected), "{name}: error {error}");
    };
    let h = 1.0 / 1024.0;
    held(
        "implicit gyroscopic",
        1.0,
        order(&ImplicitGyroscopic, &in_body, 256),
        distance(end(&ImplicitGyroscopic, &in_body, 1024), truth),
        h,
    );
    held(
        "restored momentum",
        1.0,
        order(&RestoredMomentum, &in_body, 256),
        distance(end(&RestoredMomentum, &in_body, 1024), truth),
        h,
    );
    held(
        "momentum midpoint",
        2.0,
        order(&MomentumMidpoint, &in_world, 256),
        distance(end(&MomentumMidpoint, &in_world, 1024), truth),
        h,
    );
    held(
        "free splitting",
        2.0,
        order(&FreeSplitting, &in_body, 256),
        distance(end(&FreeSplitting, &in_body, 1024), truth),
        h,
    );
    held("RK4, body frame", 4.0, order(&Rk4, &in_body, 32), distance(end(&Rk4, &in_body, 128), truth), 1.0 / 128.0);
    held(
        "RK4, stored momentum",
        4.0,
        order(&Rk4, &in_world, 32),
        distance(end(&Rk4, &in_world, 128), truth),
        1.0 / 128.0,
    );
}

/// One Newton step from u leaves of f(w) = I (w - u) + h w x I w a remainder h d x I d of the correction d = O(h): it falls by
/// eight as h is halved, by four if the derivative of f is anything else.
#[test]
fn the_implicit_gyroscopic_step_solves_its_equation_to_third_order() {
    let model = BodyOmega::<Driven>::new(Driven { in_body: true, strength: 0.0 });
    let inertia = Vector3::from(INERTIA);
    let remainder = |h: f64| {
        let s = start(&model);
        let (u, w) = (s.v.angular, ImplicitGyroscopic.step(&model, 0.0, h, s).v.angular);
        (inertia.component_mul(&(w - u)) + cross(w, inertia.component_mul(&w)) * h).norm()
    };
    let ratio = remainder(1.0 / 64.0) / remainder(1.0 / 128.0);
    assert!((ratio - 8.0).abs() < 0.5, "{ratio}");
}

#[test]
fn the_restored_momentum_keeps_its_length_and_a_body_at_rest_stays_at_rest() {
    let model = BodyOmega::<Driven>::new(Driven { in_body: true, strength: 0.0 });
    let length = |s: &State<_>| model.kinematics(s).omega_body.component_mul(&Vector3::from(INERTIA)).norm();
    let mut s = start(&model);
    let first = length(&s);
    s = drive::advance(&RestoredMomentum, &model, s, 0.125, 64).expect("finite");
    // Each step rounds |l| a few times.
    assert!((length(&s) / first - 1.0).abs() < 64.0 * 8.0 * f64::EPSILON);
    s.v.angular = Vector3::zeros();
    assert_eq!(RestoredMomentum.step(&model, 0.0, 0.125, s).v.angular, Vector3::zeros());
}

/// A torque is the same physics in world and in body components, and semi-implicit Euler moves a body alike whether it stores
/// the angular velocity in the world or in the body frame: what differs is rounding, some tens of operations a step.
#[test]
fn the_frame_of_a_torque_and_of_what_is_stored_does_not_change_the_motion() {
    let [world, body] = [false, true].map(|in_body| Driven { in_body, strength: 1.0 });
    let close = |a: [f64; 13], b: [f64; 13]| {
        assert!(distance(a, b) < 64.0 * 64.0 * f64::EPSILON, "{}", distance(a, b));
    };
    macro_rules! both {
        ($($model:ident),*) => {$(
            close(
                end(&SemiImplicitEuler, &$model::<Driven>::new(world), 64),
                end(&SemiImplicitEuler, &$model::<Driven>::new(body), 64),
            );
        )*};
    }
    both!(WorldOmega, BodyOmega, WorldMomentum, WithoutGyroscopicTerm);
    close(
        end(&SemiImplicitEuler, &WorldOmega::<Driven>::new(world), 64),
        end(&SemiImplicitEuler, &BodyOmega::<Driven>::new(world), 64),
    );
}

/// The driver finds a failed run by this alone.
#[test]
fn one_number_that_is_not_finite_makes_a_state_not_finite() {
    assert!(Space::is_finite(&Vector1::new(1.0)) && !Space::is_finite(&Vector1::new(f64::NAN)));
    for bad in [f64::NAN, f64::INFINITY] {
        for i in 0..7 {
            let mut x = [0.5; 7];
            assert!(pose(x).is_finite());
            x[i] = bad;
            assert!(!pose(x).is_finite(), "component {i}");
        }
    }
}

fn pose([w, a, b, c, x, y, z]: [f64; 7]) -> Pose<f64> {
    Pose::new(Vector3::new(x, y, z), Rotation { w, v: Vector3::new(a, b, c) })
}

/// The names are those of the command line and of the tables.
#[test]
fn storages_and_updates_have_their_names() {
    let names = Formulation::ALL.map(Formulation::id);
    assert_eq!(names, ["world-omega", "body-omega", "world-momentum", "without-gyroscopic-term"]);
    assert_eq!(AttitudeUpdate::ALL.map(AttitudeUpdate::id), ["exponential", "linear"]);
    assert_eq!(Fixed::<f64>::zero().len(), 0);
}
