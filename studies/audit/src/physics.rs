//! The law of motion that a file is judged by: a rigid body under a force and a torque, in three dimensions.

use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::{Model, Single, State};
use nalgebra::{Vector1, Vector3};

/// Force over mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Force {
    /// None.
    None,
    /// The same everywhere, m/s^2.
    Constant(Vector3<f64>),
    /// -(k/m) (x - anchor).
    Spring {
        /// k/m, 1/s^2.
        rate: f64,
        /// Where it is at rest, m.
        anchor: Vector3<f64>,
    },
    /// -mu (x - centre) / |x - centre|^3.
    Kepler {
        /// m^3/s^2.
        mu: f64,
        /// The attracting point, m.
        centre: Vector3<f64>,
    },
}

/// Torque about the centre of mass or the fixed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moment {
    /// None.
    None,
    /// The weight at a point of the body: arm x R^T g.
    Weight {
        /// Mass times the arm from the fixed point, body axes, kg m.
        arm: Vector3<f64>,
        /// Gravity, world axes, m/s^2.
        gravity: Vector3<f64>,
    },
}

/// A law of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Physics {
    /// Principal moments of inertia, kg m^2; one where they are unknown.
    pub inertia: Option<Vector3<f64>>,
    /// Force over mass; None where it is unknown.
    pub force: Option<Force>,
    /// Torque; None where it is unknown.
    pub moment: Option<Moment>,
    /// omega0^2 of theta'' = -omega0^2 sin theta, 1/s^2.
    pub pendulum: Option<f64>,
    /// Rate at which a linear damping slows the velocity, 1/s.
    pub linear_damping: Option<f64>,
    /// The same of the angular velocity, 1/s.
    pub angular_damping: Option<f64>,
}

impl Physics {
    /// Nothing is known.
    pub const UNKNOWN: Physics = Physics {
        inertia: None,
        force: None,
        moment: None,
        pendulum: None,
        linear_damping: None,
        angular_damping: None,
    };
}

fn lit<T: Single>(v: Vector3<f64>) -> Vector3<T> {
    v.map(T::lit)
}

/// Force over mass at a point.
pub fn acceleration<T: Single>(force: Force, x: Vector3<T>) -> Vector3<T> {
    match force {
        Force::None => Vector3::repeat(T::lit(0.0)),
        Force::Constant(g) => lit(g),
        Force::Spring { rate, anchor } => (x - lit(anchor)) * -T::lit(rate),
        Force::Kepler { mu, centre } => {
            let r = x - lit::<T>(centre);
            let square = integrator::rotation::dot(r, r);
            r * (-T::lit(mu) / (square * square.sqrt()))
        }
    }
}

/// How a damping depends on the speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drag {
    /// None.
    None,
    /// -c v.
    Linear(f64),
    /// -c (1 + |v|) v.
    Quadratic(f64),
}

impl Drag {
    /// The acceleration.
    pub fn at<T: Single>(self, v: Vector3<T>) -> Vector3<T> {
        match self {
            Drag::None => Vector3::repeat(T::lit(0.0)),
            Drag::Linear(c) => v * -T::lit(c),
            Drag::Quadratic(c) => v * (-T::lit(c) * (T::lit(1.0) + integrator::rotation::dot(v, v).sqrt())),
        }
    }
}

/// A point under a force and a drag.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Force over mass.
    pub force: Force,
    /// Drag over mass.
    pub drag: Drag,
}

impl<T: Single> Model<T> for Point {
    type Config = Vector3<T>;

    fn rate(&self, _t: T, s: &State<Vector3<T>>) -> Vector3<T> {
        let a = acceleration(self.force, s.q);
        if self.drag == Drag::None { a } else { a + self.drag.at(s.v) }
    }
}

/// theta'' = -omega0^2 sin theta.
#[derive(Clone, Copy, Debug)]
pub struct Swing(pub f64);

impl<T: Single> Model<T> for Swing {
    type Config = Vector1<T>;

    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(-T::lit(self.0) * s.q.x.sin_cos().0)
    }
}

/// A body that turns.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Principal moments of inertia.
    pub inertia: Vector3<f64>,
    /// The torque.
    pub moment: Moment,
    /// A drag on the angular velocity, times the inertia.
    pub drag: Drag,
}

impl<T: Single> RigidBody<T> for Body {
    type Position = integrator::pose::Fixed<T>;

    fn inertia(&self) -> Vector3<T> {
        lit(self.inertia)
    }

    fn torque(&self, _t: T, at: &Kinematics<T, Self::Position>) -> Torque<T> {
        let weight = match self.moment {
            Moment::None => None,
            Moment::Weight { arm, gravity } => {
                Some(integrator::rotation::cross(lit(arm), at.attitude.rotate_back(lit(gravity))))
            }
        };
        let drag =
            (self.drag != Drag::None).then(|| self.drag.at(at.omega_body).component_mul(&lit::<T>(self.inertia)));
        match (weight, drag) {
            (None, None) => Torque::None,
            (Some(a), Some(b)) => Torque::Body(a + b),
            (Some(a), None) | (None, Some(a)) => Torque::Body(a),
        }
    }
}
