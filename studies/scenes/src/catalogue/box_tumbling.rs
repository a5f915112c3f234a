//! A free box that is thrown and tumbles: a parabola, and the rotation of a free asymmetric body about its centre of mass.
//!
//! The default setting is the published benchmark of rigid-body engines by S. Peters and J. Hsu, Comparison of rigid body
//! dynamic simulators for robotic simulation in Gazebo (2014): a box of 10 kg spun nearly about its intermediate axis, its
//! moments rounded as printed there. Its numbers are decimal, so f32 solves a slightly different problem.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::{Real, Single};
use nalgebra::Vector3;

use crate::catalogue::answerable;
use crate::catalogue::constant_force::lit;
use crate::catalogue::rigid;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::RigidMotion;
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene, period, time_scale};
use crate::special::free_top::FreeTop;
use crate::special::scaled::{Scaled, sum_of_vectors};
use crate::theory::Theory;

scene_parameters! {
    /// A free rigid body under gravity.
    pub struct BoxTumbling {
        /// Mass.
        mass: f64 = 10.0, "kg", Positive;
        /// Principal moments of inertia.
        inertia: [f64; 3] = [0.808333, 0.683333, 0.141667], "kg m^2", Positive;
        /// Attitude at the start as a quaternion (w, x, y, z), normalised before use.
        attitude: [f64; 4] = [1.0, 0.0, 0.0, 0.0], "1", Finite;
        /// Position of the centre of mass at the start.
        x0: [f64; 3] = [0.0, 0.0, 0.0], "m", Finite;
        /// Velocity of the centre of mass at the start.
        v0: [f64; 3] = [-2.0, 2.0, 8.0], "m/s", Finite;
        /// Angular velocity at the start, in the body frame.
        omega: [f64; 3] = [0.1, 5.0, 0.1], "rad/s", Finite;
        /// Acceleration by gravity.
        gravity: [f64; 3] = [0.0, 0.0, -9.8], "m/s^2", Finite;
    }
}

impl<T: Real> RigidBody<T> for BoxTumbling {
    type Position = Vector3<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        lit(self.inertia)
    }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Vector3<T>>) -> Torque<T> {
        Torque::None
    }
    #[inline(always)]
    fn acceleration(&self, _t: T, _at: &Kinematics<T, Vector3<T>>) -> Vector3<T> {
        lit(self.gravity)
    }
}

impl<T: Single> RigidMotion<T> for BoxTumbling {
    fn exact(&self, t: T) -> Kinematics<T, Vector3<T>> {
        let (attitude, omega_body) = FreeTop::new(self.inertia, self.attitude, self.omega).at(t);
        let (time, one) = (Scaled::of_wide(t.widen()), Scaled::of(1.0));
        let [x0, v0, gravity] = [self.x0, self.v0, self.gravity].map(lit::<fx128>);
        let position = sum_of_vectors([(one, x0), (time, v0), (time.times(time).shifted(-1), gravity)]);
        let velocity = sum_of_vectors([(one, v0), (time, gravity)]);
        Kinematics { position: position.map(T::narrow), velocity: velocity.map(T::narrow), attitude, omega_body }
    }
}

impl Scene for BoxTumbling {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 0.75, coarsest_steps: 8 }.at(Vector3::from(self.omega).norm() / 5.0);
        Info {
            kind: Kind::FreeBody,
            about: "a box thrown and spun nearly about its intermediate axis: the setting of a published engine benchmark",
            equation: r"\ddot{\mathbf x} = \mathbf g,\quad I\,\dot{\omega} = I\omega\times\omega,\quad \dot q = \tfrac12\,q\,\omega",
            source: "Galilei 1638 and Jacobi 1849; setting of Peters and Hsu 2014 (Gazebo)",
            horizon_s: pace.horizon_s,
            time_scale_s: time_scale(Vector3::from(self.omega).norm()),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        rigid::check("box-tumbling", self.inertia, self.attitude)?;
        rigid::check_free("box-tumbling", &self.info(), &self.omega)?;
        let end_s = self.info().horizon_s;
        let seen = Observation::of_motion(&RigidMotion::<fx128>::exact(self, fx128::lit(end_s)));
        answerable::range("box-tumbling", self, &seen, end_s)
    }

    fn amplification(&self, end_s: f64) -> f64 {
        rigid::free_amplification(self.inertia, self.omega, end_s)
    }

    fn period_s(&self) -> Option<f64> {
        period(Vector3::from(self.omega).norm())
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        rigid::account_of_flight(self.mass, self.inertia, lit(self.gravity), seen)
            .into_iter()
            .map(|entry| Entry { conserved: entry.invariant != Invariant::Momentum, ..entry })
            .collect()
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        let constant = 0.5 * end_s * Vector3::from(self.gravity).norm();
        let euler = matches!(method, MethodId::ExplicitEuler | MethodId::SemiImplicitEuler | MethodId::ImplicitEuler);
        let at_rest = self.omega == [0.0; 3];
        match quantity {
            Quantity::Attitude | Quantity::AngularVelocity if at_rest => Theory::exact("it does not turn"),
            Quantity::Position if self.gravity == [0.0; 3] => Theory::exact("nothing pushes: v is constant"),
            Quantity::Velocity => Theory::exact("v is linear in t, and every method sums it exactly"),
            Quantity::Position if euler => {
                Theory::with_constant(method, constant, "x is wrong by exactly -+ g t h / 2")
            }
            Quantity::Position => Theory::exact("exact on polynomials of degree two"),
            _ => Theory::usual(method),
        }
    }
}
