//! What can be measured of a motion, in double-double whatever arithmetic the run used.

use faer::fx128;
use integrator::pose::{Frame, Update};
use integrator::rigid_body::{Kinematics, RigidModel};
use integrator::{Real, Rotation, Single, State, Vector};
use nalgebra::{SMatrix, Vector3};
use serde::{Deserialize, Serialize};

/// A measured quantity. Its error is a distance, in the unit given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// |x - x*|, m.
    Position,
    /// |v - v*|, m/s.
    Velocity,
    /// Geodesic angle between two attitudes, or the difference of two angles, rad.
    Attitude,
    /// |omega - omega*| in the world frame, rad/s.
    AngularVelocity,
}

impl Quantity {
    /// Every quantity.
    pub const ALL: [Quantity; 4] =
        [Quantity::Position, Quantity::Velocity, Quantity::Attitude, Quantity::AngularVelocity];

    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            Quantity::Position => "position",
            Quantity::Velocity => "velocity",
            Quantity::Attitude => "attitude",
            Quantity::AngularVelocity => "angular-velocity",
        }
    }

    /// The unit of its error.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Position => "m",
            Quantity::Velocity => "m/s",
            Quantity::Attitude => "rad",
            Quantity::AngularVelocity => "rad/s",
        }
    }
}

/// The value of one quantity at one time.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Components.
    Vector(Vec<fx128>),
    /// An attitude, normalised.
    Rotation(Rotation<fx128>),
}

/// A state as it can be seen from outside: physical quantities, whatever the model stores.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Each quantity that the scene has, with its value.
    pub values: Vec<(Quantity, Value)>,
    /// |q| - 1 of the integrated quaternion, before [`Value::Rotation`] is normalised; 0 without one.
    pub norm_error: f64,
}

impl Observation {
    /// Position and velocity of particles (one column each), or of one coordinate.
    pub fn particles<T: Single, const R: usize, const C: usize>(s: &State<SMatrix<T, R, C>>) -> Self {
        Self::pair(Quantity::Position, Quantity::Velocity, s)
    }

    /// An angle and its rate.
    pub fn angle<T: Single>(s: &State<SMatrix<T, 1, 1>>) -> Self {
        Self::pair(Quantity::Attitude, Quantity::AngularVelocity, s)
    }

    fn pair<T: Single, const R: usize, const C: usize>(q: Quantity, v: Quantity, s: &State<SMatrix<T, R, C>>) -> Self {
        Observation { values: vec![(q, vector(&s.q)), (v, vector(&s.v))], norm_error: 0.0 }
    }

    /// A rigid body, whatever its model stores.
    pub fn of_body<T: Single, M: RigidModel<T>>(model: &M, s: &State<M::Config>) -> Self {
        let angular = model.velocity(s.q, s.v).angular.map(Single::widen);
        let omega_world = <M::Update as Update>::Frame::to_world(widen(s.q.attitude).normalized(), angular);
        Self::rigid(&s.q.position, &s.v.linear, widen(s.q.attitude), omega_world)
    }

    /// A rigid body that moves like this.
    pub fn of_motion<P: Vector<fx128>>(at: &Kinematics<fx128, P>) -> Self {
        Self::rigid(&at.position, &at.velocity, at.attitude, at.attitude.rotate(at.omega_body))
    }

    fn rigid<T: Single, P: Vector<T>>(
        position: &P,
        velocity: &P,
        attitude: Rotation<fx128>,
        omega_world: Vector3<fx128>,
    ) -> Self {
        let norm = attitude.norm_squared().sqrt();
        let mut values = Vec::with_capacity(4);
        if P::DIM > 0 {
            values.push((Quantity::Position, vector(position)));
            values.push((Quantity::Velocity, vector(velocity)));
        }
        values.push((Quantity::Attitude, Value::Rotation(attitude.normalized())));
        values.push((Quantity::AngularVelocity, Value::Vector(omega_world.iter().copied().collect())));
        Observation { values, norm_error: (norm - fx128::ONE).to_f64() }
    }

    /// The value of a quantity, if the scene has it.
    pub fn get(&self, quantity: Quantity) -> Option<&Value> {
        self.values.iter().find(|(q, _)| *q == quantity).map(|(_, value)| value)
    }

    /// The components of a vector quantity; empty where the scene has none.
    pub fn vector(&self, quantity: Quantity) -> &[fx128] {
        match self.get(quantity) {
            Some(Value::Vector(v)) => v,
            _ => &[],
        }
    }

    /// The attitude of a rigid body.
    pub fn rotation(&self) -> Option<Rotation<fx128>> {
        match self.get(Quantity::Attitude) {
            Some(Value::Rotation(q)) => Some(*q),
            _ => None,
        }
    }

    /// The distance of each quantity from its value in `other`, rounded to `f64`.
    pub fn distances(&self, other: &Observation) -> Vec<(Quantity, f64)> {
        self.values
            .iter()
            .filter_map(|(quantity, value)| Some((*quantity, distance(value, other.get(*quantity)?))))
            .collect()
    }

    /// The size of a quantity: the norm of a vector; 1 for an attitude.
    pub fn scale(&self, quantity: Quantity) -> f64 {
        match self.get(quantity) {
            Some(Value::Vector(v)) => norm(v.iter().copied()).to_f64(),
            Some(Value::Rotation(_)) => 1.0,
            None => 0.0,
        }
    }
}

fn vector<T: Single, V: Vector<T>>(v: &V) -> Value {
    Value::Vector((0..V::DIM).map(|i| v.component(i).widen()).collect())
}

/// The same quaternion in double-double.
pub fn widen<T: Single>(q: Rotation<T>) -> Rotation<fx128> {
    Rotation { w: q.w.widen(), v: q.v.map(Single::widen) }
}

/// sqrt(sum x^2), scaled so that neither 1e200 overflows nor 1e-200 vanishes.
pub fn norm(components: impl Iterator<Item = fx128> + Clone) -> fx128 {
    let largest = components.clone().map(|x| x.0.abs()).fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() {
        return fx128::from_f64(largest);
    }
    // A power of two: scaling by it does not round.
    let scale = fx128::lit(2.0_f64.powi(largest.log2().floor() as i32));
    let sum = components.fold(fx128::ZERO, |sum, x| {
        let y = x / scale;
        sum + y * y
    });
    sum.sqrt() * scale
}

fn distance(a: &Value, b: &Value) -> f64 {
    match (a, b) {
        (Value::Vector(a), Value::Vector(b)) => {
            norm(a.iter().zip(b).map(|(&x, &y)| x - y).collect::<Vec<_>>().into_iter()).to_f64()
        }
        (Value::Rotation(a), Value::Rotation(b)) => a.angle_to(*b).to_f64(),
        _ => f64::NAN,
    }
}
