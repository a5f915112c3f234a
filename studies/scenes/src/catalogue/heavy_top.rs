//! Lagrange's top: two equal moments, a fixed point, gravity. The only torque here that depends on the attitude alone.
//!
//! I omega' = I omega x omega + mgl e3 x down, e3 the body's axis of symmetry: see [`LagrangeTop`].

use faer::fx128;
use integrator::pose::Fixed;
use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::{Real, Rotation, Single};
use nalgebra::Vector3;

use crate::catalogue::answerable;
use crate::catalogue::constant_force::lit;
use crate::catalogue::rigid;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::RigidMotion;
use crate::observation::Observation;
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene, time_scale};
use crate::special::lagrange_top::LagrangeTop;
use crate::special::scaled::Scaled;

scene_parameters! {
    /// A symmetric top on a fixed point, its centre of mass on the third axis of the body.
    pub struct HeavyTop {
        /// Moment of inertia across the axis of symmetry, about the fixed point.
        inertia_1: f64 = 1.25, "kg m^2", Positive;
        /// Moment of inertia about the axis of symmetry.
        inertia_3: f64 = 0.75, "kg m^2", Positive;
        /// Mass times gravity times distance of the centre of mass from the fixed point.
        mgl: f64 = 2.5, "J", Positive;
        /// Attitude at the start as a quaternion (w, x, y, z), normalised before use.
        attitude: [f64; 4] = [1.0, 0.375, -0.25, 0.5], "1", Finite;
        /// Angular velocity at the start, in the body frame.
        omega: [f64; 3] = [0.75, -0.5, 4.0], "rad/s", Finite;
    }
}

impl HeavyTop {
    /// How fast it spins, or swings, 1/s.
    fn rate(&self) -> f64 {
        Vector3::from(self.omega).norm().max((self.mgl / self.inertia_1).sqrt())
    }

    fn inertia(&self) -> [f64; 3] {
        [self.inertia_1, self.inertia_1, self.inertia_3]
    }
}

/// The world's vertical in the body frame.
fn up<T: Real>(attitude: Rotation<T>) -> Vector3<T> {
    attitude.rotate_back(lit([0.0, 0.0, 1.0]))
}

impl<T: Real> RigidBody<T> for HeavyTop {
    type Position = Fixed<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        lit(self.inertia())
    }
    #[inline(always)]
    fn torque(&self, _t: T, at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        let up = up(at.attitude);
        Torque::Body(Vector3::new(up.y, -up.x, T::lit(0.0)) * T::lit(self.mgl))
    }
}

impl<T: Single> RigidMotion<T> for HeavyTop {
    fn exact(&self, t: T) -> Kinematics<T, Fixed<T>> {
        let top = LagrangeTop::new(self.inertia_1, self.inertia_3, self.mgl, self.attitude, self.omega);
        let (attitude, omega_body) = top.at(t);
        rigid::fixed_point(attitude, omega_body)
    }
}

impl Scene for HeavyTop {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 1.75, coarsest_steps: 8 }.at(self.rate() / 4.1);
        Info {
            kind: Kind::DrivenBody,
            about: "a top that precesses and nutates under gravity: the torque depends on the attitude",
            equation: r"I\,\dot{\omega} = I\omega\times\omega + m g l\,\mathbf e_3\times R^{T}\mathbf d,\quad \dot q = \tfrac12\,q\,\omega,\quad \mathbf d = (0, 0, -1)",
            source: "Lagrange 1788, by elliptic integrals",
            horizon_s: pace.horizon_s,
            time_scale_s: time_scale(self.rate()),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        rigid::check("heavy-top", self.inertia(), self.attitude)?;
        let end_s = self.info().horizon_s;
        let of_omega = Vector3::from(self.omega).norm() * end_s;
        answerable::phase("heavy-top", ("omega", &self.omega), of_omega, end_s)?;
        let of_gravity = Scaled::of(self.mgl).over(Scaled::of(self.inertia_1)).sqrt().times(Scaled::of(end_s)).value();
        answerable::phase("heavy-top", ("mgl", &self.mgl), of_gravity.to_f64(), end_s)
    }

    /// Energy, and the vertical component of the angular momentum: the others are not conserved.
    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let Some(attitude) = seen.rotation() else { return Vec::new() };
        let potential = fx128::lit(self.mgl) * up(attitude).z;
        let mut entries = rigid::invariants(self.inertia(), seen, potential, true, true);
        for entry in entries.iter_mut().filter(|entry| entry.invariant == Invariant::AngularMomentum) {
            entry.value.drain(..2);
        }
        entries
    }
}
