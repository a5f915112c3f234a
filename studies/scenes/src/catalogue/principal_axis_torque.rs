//! A constant torque about a principal axis, from a spin about the same axis: one degree of freedom, tilted in space.
//!
//! omega = omega0 + (tau / I) t about the axis, angle = omega0 t + tau t^2 / (2 I), q = q0 exp(angle axis). The gyroscopic
//! term vanishes along the whole motion. Source: elementary.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::pose::Fixed;
use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::{Real, Rotation, Single};
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
use crate::special::scaled::{Scaled, unit_quaternion};
use crate::theory::Theory;

scene_parameters! {
    /// A body that is spun up about one of its principal axes.
    pub struct PrincipalAxisTorque {
        /// Principal moments of inertia.
        inertia: [f64; 3] = [0.75, 1.25, 1.5], "kg m^2", Positive;
        /// The body axis of spin and torque: 0, 1 or 2.
        axis: f64 = 1.0, "1", Closed(0.0, 2.0);
        /// Attitude at the start as a quaternion (w, x, y, z), normalised before use.
        attitude: [f64; 4] = [0.5, -0.75, 1.0, 0.25], "1", Finite;
        /// Angular velocity about the axis at the start.
        omega: f64 = 1.25, "rad/s", Finite;
        /// Torque about the axis.
        torque: f64 = 0.9375, "N m", Finite;
    }
}

impl PrincipalAxisTorque {
    fn index(&self) -> usize {
        // Checked to be 0, 1 or 2; a cast of anything else stays in range.
        (self.axis as usize).min(2)
    }

    /// How fast it turns, or comes to turn, 1/s.
    fn rate(&self) -> f64 {
        self.omega.abs().max((self.torque.abs() / self.inertia[self.index()]).sqrt())
    }

    /// tau / I about the axis, rad/s^2.
    fn acceleration(&self) -> Scaled {
        Scaled::of(self.torque).over(Scaled::of(self.inertia[self.index()]))
    }

    /// (omega + tau t / (2 I)) t / 2, rad.
    fn half_angle(&self, time: Scaled) -> fx128 {
        let terms = [Scaled::of(self.omega).times(time), self.acceleration().times(time).times(time).shifted(-1)];
        Scaled::sum(&terms.map(|term| term.shifted(-1)))
    }

    /// `size` times the unit vector of the axis.
    fn along_axis<T: Real>(&self, size: T) -> Vector3<T> {
        let mut along = Vector3::repeat(T::lit(0.0));
        along[self.index()] = size;
        along
    }
}

impl<T: Real> RigidBody<T> for PrincipalAxisTorque {
    type Position = Fixed<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        lit(self.inertia)
    }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::Body(self.along_axis(T::lit(self.torque)))
    }
}

impl<T: Single> RigidMotion<T> for PrincipalAxisTorque {
    fn exact(&self, t: T) -> Kinematics<T, Fixed<T>> {
        // In double-double: the angle of a long run has more digits than its sine needs.
        let time = Scaled::of_wide(t.widen());
        let (omega, gained) = (Scaled::of(self.omega), self.acceleration().times(time));
        let (sine, cosine) = self.half_angle(time).sin_cos();
        let turn = Rotation { w: cosine, v: self.along_axis(sine) };
        let omega = self.along_axis(Scaled::sum(&[omega, gained]));
        rigid::fixed_point(rigid::narrow(unit_quaternion(self.attitude) * turn), omega.map(T::narrow))
    }
}

impl Scene for PrincipalAxisTorque {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.25, coarsest_steps: 4 }
            .at((self.omega.abs() + self.torque.abs() / self.inertia[self.index()] * 2.25) / 2.94);
        Info {
            kind: Kind::DrivenBody,
            about: "spun up about a principal axis: no gyroscopic term, the Eulers' attitude is off by -+ alpha t h / 2",
            equation: r"I_k\,\dot\omega_k = \tau_k,\quad \dot q = \tfrac12\,q\,\omega_k\mathbf e_k",
            source: "elementary",
            horizon_s: pace.horizon_s,
            time_scale_s: time_scale(self.rate()),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        if self.axis.fract() != 0.0 {
            return Err(Error::Parameter {
                scene: "principal-axis-torque".to_owned(),
                parameter: "axis".to_owned(),
                value: self.axis.to_string(),
                expected: "must be 0, 1 or 2".to_owned(),
            });
        }
        rigid::check("principal-axis-torque", self.inertia, self.attitude)?;
        let end_s = self.info().horizon_s;
        let phase = self.half_angle(Scaled::of(end_s)).to_f64();
        let most =
            if self.omega.abs() * end_s >= phase.abs() { ("omega", &self.omega) } else { ("torque", &self.torque) };
        answerable::phase("principal-axis-torque", most, phase, end_s)
    }

    fn has_constant_angular_acceleration(&self) -> bool {
        true
    }

    fn invariants(&self, t: fx128, seen: &Observation) -> Vec<Entry> {
        let start = unit_quaternion(self.attitude);
        let torque = start.rotate(self.along_axis(fx128::lit(self.torque)));
        let omega = start.rotate(self.along_axis(fx128::lit(self.omega)));
        rigid::account_less_torque(self.inertia, self.inertia[self.index()], torque, omega, t, seen)
    }

    fn amplification(&self, end_s: f64) -> f64 {
        let gained = self.torque / self.inertia[self.index()] * end_s;
        rigid::amplification(self.inertia, self.index(), (self.omega.abs() + 0.5 * gained.abs()) * end_s)
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        let gained = self.torque / self.inertia[self.index()] * end_s;
        match (method, quantity) {
            (MethodId::VelocityVerlet | MethodId::Rk4 | MethodId::ImplicitMidpoint, Quantity::Attitude) => {
                Theory::exact("the angle is a quadratic polynomial of t")
            }
            _ => rigid::theory_of_constant_torque(method, quantity, gained.abs()),
        }
    }
}
