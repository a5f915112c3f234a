//! Models, bodies and drivers with one fault each.

use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::rotation::cross;
use integrator::{Model, State, Vector};
use nalgebra::{SVector, Vector3};
use scenes::erased::{BodyMotion, FlatMotion};

/// What is wrong with a flat model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Law {
    Right,
    Sign,
    OnePercent,
    VelocityIgnored,
    PositionIgnored,
    TimeIgnored,
    TimeOnePercent,
    TimeNegative,
    RateInSingle,
    StateInSingle,
    TimeInSingle,
    ComponentsSwapped,
    LastComponentLost,
    ConstantAdded,
    ContactLost,
    ContactTwice,
    ContactWithoutCondition,
    VelocityOnePercent,
    VelocityNegative,
}

impl Law {
    pub(crate) const ALL: [(Law, &'static str); 18] = [
        (Law::Sign, "the force has the wrong sign"),
        (Law::OnePercent, "the force is 1 % off"),
        (Law::VelocityIgnored, "the force of a body at rest"),
        (Law::PositionIgnored, "the force at the origin"),
        (Law::TimeIgnored, "the force at the time 0"),
        (Law::TimeOnePercent, "the time of the force is 1 % off"),
        (Law::TimeNegative, "the force at the time -t"),
        (Law::RateInSingle, "the force is rounded to f32"),
        (Law::StateInSingle, "the force is that of a state rounded to f32"),
        (Law::TimeInSingle, "the time is rounded to f32"),
        (Law::ComponentsSwapped, "two components of the force are swapped"),
        (Law::LastComponentLost, "the last component of the force is lost"),
        (Law::ConstantAdded, "1e-6 is added to the force"),
        (Law::ContactLost, "contact is left out"),
        (Law::ContactTwice, "contact acts twice"),
        (Law::ContactWithoutCondition, "a bounce sends the ball from the floor itself"),
        (Law::VelocityOnePercent, "positions move 1 % too far"),
        (Law::VelocityNegative, "positions move backwards"),
    ];
}

/// A flat scene with a fault.
pub(crate) struct Flat<'a, const N: usize> {
    pub motion: FlatMotion<'a, N>,
    /// Coordinates of the scene, the first of `N`.
    pub dimension: usize,
    pub law: Law,
}

fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

impl<const N: usize> Model<f64> for Flat<'_, N> {
    type Config = SVector<f64, N>;

    fn rate(&self, t: f64, s: &State<Self::Config>) -> SVector<f64, N> {
        let of = |t: f64, s: &State<Self::Config>| self.motion.rate(t, s);
        match self.law {
            Law::Sign => -of(t, s),
            Law::OnePercent => of(t, s) * 1.01,
            Law::VelocityIgnored => of(t, &State { v: SVector::zeros(), ..*s }),
            Law::PositionIgnored => of(t, &State { q: SVector::from_element(1e-3), ..*s }),
            Law::TimeIgnored => of(0.0, s),
            Law::TimeOnePercent => of(1.01 * t, s),
            Law::TimeNegative => of(-t, s),
            Law::TimeInSingle => of(single(t), s),
            Law::RateInSingle => of(t, s).map(single),
            Law::StateInSingle => of(t, &State { q: s.q.map(single), v: s.v.map(single) }),
            Law::ComponentsSwapped => {
                let mut rate = of(t, s);
                rate.swap_rows(0, self.dimension - 1);
                rate
            }
            Law::LastComponentLost => {
                let mut rate = of(t, s);
                rate[self.dimension - 1] = 0.0;
                rate
            }
            Law::ConstantAdded => of(t, s).add_scalar(1e-6),
            _ => of(t, s),
        }
    }
    fn velocity(&self, q: SVector<f64, N>, v: SVector<f64, N>) -> SVector<f64, N> {
        let w = self.motion.velocity(q, v);
        match self.law {
            Law::VelocityOnePercent => w * 1.01,
            Law::VelocityNegative => -w,
            _ => w,
        }
    }
    fn contact(&self, before: &State<Self::Config>, after: State<Self::Config>) -> State<Self::Config> {
        let once = |after| self.motion.contact(before, after);
        let touched = |a: &State<Self::Config>, b: &State<Self::Config>| a.v != b.v;
        match self.law {
            Law::ContactLost => after,
            Law::ContactTwice => {
                let first = once(after);
                if touched(&first, &after) { State { v: after.v, ..first } } else { first }
            }
            Law::ContactWithoutCondition => {
                let first = once(after);
                if touched(&first, &after) { State { q: SVector::zeros(), ..first } } else { first }
            }
            _ => once(after),
        }
    }
}

/// What is wrong with a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Loads {
    Right,
    TorqueSign,
    TorqueOnePercent,
    TorqueAtStart,
    TorqueInSingle,
    WrongFrame,
    Gyroscopic(f64),
    InertiaSwapped,
    InertiaOnePercent,
    InertiaInverse,
    InertiaInSingle,
    AccelerationSign,
    AccelerationOnePercent,
    AccelerationLost,
    OmegaFrame,
}

impl Loads {
    pub(crate) const ALL: [(Loads, &'static str); 16] = [
        (Loads::TorqueSign, "the torque has the wrong sign"),
        (Loads::TorqueOnePercent, "the torque is 1 % off"),
        (Loads::TorqueAtStart, "the torque is that of the start"),
        (Loads::TorqueInSingle, "the torque is rounded to f32"),
        (Loads::WrongFrame, "the torque is taken in the other frame"),
        (Loads::Gyroscopic(1.0), "the gyroscopic term is lost"),
        (Loads::Gyroscopic(2.0), "the gyroscopic term has the wrong sign"),
        (Loads::Gyroscopic(0.01), "the gyroscopic term is 1 % off"),
        (Loads::InertiaSwapped, "two moments of inertia are swapped"),
        (Loads::InertiaOnePercent, "a moment of inertia is 1 % off"),
        (Loads::InertiaInverse, "the inverse of the inertia is taken"),
        (Loads::InertiaInSingle, "the inertia is rounded to f32"),
        (Loads::AccelerationSign, "the force on the centre of mass has the wrong sign"),
        (Loads::AccelerationOnePercent, "the force on the centre of mass is 1 % off"),
        (Loads::AccelerationLost, "the force on the centre of mass is lost"),
        (Loads::OmegaFrame, "the torque sees the angular velocity in the other frame"),
    ];
}

/// A body with a fault.
pub(crate) struct Wrong<'a, P> {
    pub motion: BodyMotion<'a, P>,
    pub loads: Loads,
}

impl<P: Vector<f64>> RigidBody<f64> for Wrong<'_, P> {
    type Position = P;

    fn inertia(&self) -> Vector3<f64> {
        let right = self.motion.inertia();
        match self.loads {
            Loads::InertiaSwapped => Vector3::new(right.x, right.z, right.y),
            Loads::InertiaOnePercent => Vector3::new(right.x * 1.01, right.y, right.z),
            Loads::InertiaInverse => right.map(f64::recip),
            Loads::InertiaInSingle => right.map(single),
            _ => right,
        }
    }
    fn torque(&self, t: f64, at: &Kinematics<f64, P>) -> Torque<f64> {
        let turned = |f: &dyn Fn(Vector3<f64>) -> Vector3<f64>, torque| match torque {
            Torque::World(torque) => Torque::World(f(torque)),
            Torque::Body(torque) => Torque::Body(f(torque)),
            Torque::None => Torque::None,
        };
        let torque = match self.loads {
            Loads::TorqueAtStart => self.motion.torque(0.0, &self.motion.exact(0.0)),
            Loads::OmegaFrame => {
                let omega_body = at.attitude.rotate(at.omega_body);
                self.motion.torque(t, &Kinematics { omega_body, ..*at })
            }
            _ => self.motion.torque(t, at),
        };
        match (self.loads, torque) {
            (Loads::TorqueSign, torque) => turned(&|x| -x, torque),
            (Loads::TorqueOnePercent, torque) => turned(&|x| x * 1.01, torque),
            (Loads::TorqueInSingle, torque) => turned(&|x| x.map(single), torque),
            (Loads::WrongFrame, Torque::World(torque)) => Torque::Body(torque),
            (Loads::WrongFrame, Torque::Body(torque)) => Torque::World(torque),
            (Loads::Gyroscopic(part), torque) => {
                let gyroscopic = cross(at.omega_body, self.inertia().component_mul(&at.omega_body));
                Torque::Body(torque.plus_in_body(at.attitude, gyroscopic * part))
            }
            (_, torque) => torque,
        }
    }
    fn acceleration(&self, t: f64, at: &Kinematics<f64, P>) -> P {
        let right = self.motion.acceleration(t, at);
        match self.loads {
            Loads::AccelerationSign => -right,
            Loads::AccelerationOnePercent => right * 1.01,
            Loads::AccelerationLost => P::zero(),
            _ => right,
        }
    }
}

/// What is wrong with a driver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Drive {
    Right,
    OneStepShort,
    OneStepMore,
    FirstTimeIsOne,
    TimeSummedInSingle,
    StartInSingle,
    StartVelocityNegative,
    StepOnePercent,
    SeenOneStepLate,
}

impl Drive {
    pub(crate) const ALL: [(Drive, &'static str); 8] = [
        (Drive::OneStepShort, "the last step is not taken"),
        (Drive::OneStepMore, "a step more is taken"),
        (Drive::FirstTimeIsOne, "step i starts at the time (i + 1) h"),
        (Drive::TimeSummedInSingle, "time is summed in f32"),
        (Drive::StartInSingle, "the start is rounded to f32"),
        (Drive::StartVelocityNegative, "the start moves backwards"),
        (Drive::StepOnePercent, "the step is 1 % too long"),
        (Drive::SeenOneStepLate, "the state is seen a step late"),
    ];
}
