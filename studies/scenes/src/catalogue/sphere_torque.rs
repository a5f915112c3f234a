//! A sphere under a constant torque oblique to its rotation: the rotations do not commute, and there is no gyroscopic term.
//!
//! omega = omega0 + (tau / I) t; the attitude is that of the Landau-Zener problem: see [`SphereTop`].

use faer::fx128;
use integrator::methods::MethodId;
use integrator::pose::Fixed;
use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::{Real, Single};
use nalgebra::Vector3;

use crate::catalogue::answerable;
use crate::catalogue::constant_force::lit;
use crate::catalogue::rigid;
use crate::error::Error;
use crate::invariants::Entry;
use crate::motion::RigidMotion;
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene, time_scale};
use crate::special::sphere_torque::SphereTop;
use crate::theory::Theory;

scene_parameters! {
    /// A body with three equal moments of inertia under a torque that is constant in the world frame.
    pub struct SphereTorque {
        /// Moment of inertia.
        inertia: f64 = 0.75, "kg m^2", Positive;
        /// Attitude at the start as a quaternion (w, x, y, z), normalised before use.
        attitude: [f64; 4] = [0.5, -0.75, 1.0, 0.25], "1", Finite;
        /// Angular velocity at the start, in the world frame.
        omega: [f64; 3] = [1.5, 0.5, -0.75], "rad/s", Finite;
        /// Torque, in the world frame.
        torque: [f64; 3] = [0.375, -0.75, 0.9375], "N m", Finite;
    }
}

impl SphereTorque {
    /// How fast it turns, or comes to turn, 1/s.
    fn rate(&self) -> f64 {
        Vector3::from(self.omega).norm().max((Vector3::from(self.torque).norm() / self.inertia).sqrt())
    }
}

impl<T: Real> RigidBody<T> for SphereTorque {
    type Position = Fixed<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        Vector3::repeat(T::lit(self.inertia))
    }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::World(lit(self.torque))
    }
}

impl<T: Single> RigidMotion<T> for SphereTorque {
    fn exact(&self, t: T) -> Kinematics<T, Fixed<T>> {
        let top = SphereTop::new(self.inertia, self.attitude, self.omega, self.torque);
        let (attitude, omega_world) = top.at(t.widen());
        rigid::fixed_point(rigid::narrow(attitude), attitude.rotate_back(omega_world).map(T::narrow))
    }
}

impl Scene for SphereTorque {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.25, coarsest_steps: 8 }
            .at((Vector3::from(self.omega).norm() + Vector3::from(self.torque).norm() / self.inertia * 2.25) / 5.5);
        Info {
            kind: Kind::DrivenBody,
            about: "a sphere under an oblique torque: rotations that do not commute, but no gyroscopic term",
            equation: r"I\,\dot{\omega} = \tau,\quad \dot q = \tfrac12\,\omega\,q",
            source: "Zener 1932 (Landau-Zener), by power series, and by the adiabatic series of a slow turn",
            horizon_s: pace.horizon_s,
            time_scale_s: time_scale(self.rate()),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        rigid::check("sphere-torque", [self.inertia; 3], self.attitude)?;
        let end_s = self.info().horizon_s;
        let gained = Vector3::from(self.torque).norm() / self.inertia * end_s;
        let started = Vector3::from(self.omega).norm();
        let most = if started >= gained { ("omega", &self.omega) } else { ("torque", &self.torque) };
        answerable::phase("sphere-torque", most, (started + gained) * end_s, end_s)
    }

    fn invariants(&self, t: fx128, seen: &Observation) -> Vec<Entry> {
        rigid::account_less_torque([self.inertia; 3], self.inertia, lit(self.torque), lit(self.omega), t, seen)
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        let at = |t: f64| -> Vector3<f64> { RigidMotion::<f64>::exact(self, t).omega_body };
        let gained = (at(end_s) - at(0.0)).norm();
        rigid::theory_of_constant_torque(method, quantity, gained)
    }
}
