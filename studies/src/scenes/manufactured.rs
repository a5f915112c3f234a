//! A manufactured motion: a smooth path and attitude are prescribed, and the loads follow from the equations of motion.
//!
//! x* = x0 + v0 t + swing sin(nu t); R* = R0 exp(theta_1 e1) exp(theta_2 e2) exp(theta_3 e3), theta_k = rate_k t +
//! tilt_k sin(nu t). The loads that produce it are m x*'' and I omega*' + omega* x I omega*; terms that vanish on it make the
//! right-hand side depend on everything: springs and dampers towards the path, attitude in the force, position in the
//! torque. (P. J. Roache, Code verification by the method of manufactured solutions, J. Fluids Eng. 124 (2002) 4-10.)

use faer::fx128;
use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::rotation::cross;
use integrator::{Real, Rotation, Single};
use nalgebra::Vector3;

use crate::error::Error;
use crate::observation::Observation;
use crate::scene::{Entry, Info, RigidMotion, Scene};
use crate::scenes::constant_force::lit;
use crate::scenes::parameters::scene_parameters;
use crate::scenes::rigid;

scene_parameters! {
    /// A rigid body on a prescribed motion, held to it by loads that depend on time, position, velocity, attitude and omega.
    pub struct Manufactured {
        /// Mass.
        mass: f64 = 1.5, "kg", Positive;
        /// Principal moments of inertia.
        inertia: [f64; 3] = [1.25, 0.75, 1.75], "kg m^2", Positive;
        /// Factor R0 of the attitude as a quaternion (w, x, y, z), normalised before use.
        attitude: [f64; 4] = [0.5, -0.75, 1.0, 0.25], "1", Finite;
        /// Position at the start.
        x0: [f64; 3] = [0.5, -1.25, 2.0], "m", Finite;
        /// Mean velocity.
        v0: [f64; 3] = [1.0, 0.75, -0.5], "m/s", Finite;
        /// Amplitude of the swing of the position.
        swing: [f64; 3] = [-0.5, 0.25, 0.75], "m", Finite;
        /// Mean rates of the three angles.
        rates: [f64; 3] = [0.75, -0.5, 1.25], "rad/s", Finite;
        /// Amplitudes of the swing of the three angles.
        tilts: [f64; 3] = [0.5, 0.75, -0.25], "rad", Finite;
        /// Angular frequency nu of all swings.
        frequency: f64 = 1.5, "rad/s", Positive;
        /// Stiffness towards the path over the mass; as torque over the moments of inertia, the same.
        stiffness: f64 = 2.0, "1/s^2", NonNegative;
        /// Damping towards the motion over the mass; as torque over the moments of inertia, the same.
        damping: f64 = 0.5, "1/s", NonNegative;
        /// Thrust along the body's third axis over the mass, less that on the motion.
        thrust: f64 = 0.75, "m/s^2", Finite;
        /// Torque by a distance from the path.
        coupling: f64 = 0.5, "N", Finite;
    }
}

/// The prescribed motion and its second derivatives.
struct Prescribed<T: Real> {
    at: Kinematics<T, Vector3<T>>,
    acceleration: Vector3<T>,
    omega_rate_body: Vector3<T>,
}

impl Manufactured {
    fn prescribed<T: Real>(&self, t: T) -> Prescribed<T> {
        let nu = T::lit(self.frequency);
        let (sine, cosine) = (nu * t).sin_cos();
        // sin(nu t) and its first two derivatives.
        let wave = [sine, nu * cosine, -(nu * nu * sine)];
        let (v0, swing) = (lit::<T>(self.v0), lit::<T>(self.swing));
        let (rates, tilts) = (lit::<T>(self.rates), lit::<T>(self.tilts));

        let mut attitude = Rotation::from_wxyz(self.attitude.map(T::lit));
        let (mut omega, mut omega_rate) = (Vector3::repeat(T::lit(0.0)), Vector3::repeat(T::lit(0.0)));
        for k in 0..3 {
            let along = |size: T| Vector3::from_fn(|i, _| if i == k { size } else { T::lit(0.0) });
            let rate = rates[k] + tilts[k] * wave[1];
            let half = ((rates[k] * t + tilts[k] * wave[0]) * T::lit(0.5)).sin_cos();
            // omega = F^T omega + theta' e_k, and the derivative of it.
            let carried = turned_back(k, half, omega);
            omega_rate =
                turned_back(k, half, omega_rate) - along_axis_cross(k, rate, carried) + along(tilts[k] * wave[2]);
            omega = carried + along(rate);
            attitude = attitude * Rotation { w: half.1, v: along(half.0) };
        }
        let position = lit::<T>(self.x0) + v0 * t + swing * wave[0];
        let at = Kinematics { position, velocity: v0 + swing * wave[1], attitude, omega_body: omega };
        Prescribed { at, acceleration: swing * wave[2], omega_rate_body: omega_rate }
    }
}

/// F^T v, F the rotation about e_k with the given sine and cosine of half its angle. Six products instead of thirty.
fn turned_back<T: Real>(k: usize, (sine, cosine): (T, T), v: Vector3<T>) -> Vector3<T> {
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let twice = sine * T::lit(2.0);
    let (s, c) = (twice * cosine, T::lit(1.0) - twice * sine);
    let mut turned = v;
    (turned[i], turned[j]) = (c * v[i] + s * v[j], c * v[j] - s * v[i]);
    turned
}

/// rate e_k x v.
fn along_axis_cross<T: Real>(k: usize, rate: T, v: Vector3<T>) -> Vector3<T> {
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let mut product = Vector3::repeat(T::lit(0.0));
    (product[i], product[j]) = (-(rate * v[j]), rate * v[i]);
    product
}

impl<T: Real> RigidBody<T> for Manufactured {
    type Position = Vector3<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        lit(self.inertia)
    }

    #[inline]
    fn torque(&self, t: T, at: &Kinematics<T, Vector3<T>>) -> Torque<T> {
        let Prescribed { at: to, omega_rate_body, .. } = self.prescribed(t);
        // sin(angle) times the axis of the rotation from the motion to the state: the same for q and -q.
        let between = to.attitude.conjugate() * at.attitude;
        let error = between.v * (between.w * T::lit(2.0));
        let restoring = error * T::lit(self.stiffness) + (at.omega_body - to.omega_body) * T::lit(self.damping);
        let inertia: Vector3<T> = lit(self.inertia);
        let gyroscopic = cross(to.omega_body, inertia.component_mul(&to.omega_body));
        let apart = (at.position - to.position) + (at.velocity - to.velocity) / T::lit(self.frequency);
        let coupled = at.attitude.rotate_back(apart) * T::lit(self.coupling);
        Torque::Body(inertia.component_mul(&(omega_rate_body - restoring)) + gyroscopic + coupled)
    }

    #[inline]
    fn acceleration(&self, t: T, at: &Kinematics<T, Vector3<T>>) -> Vector3<T> {
        let Prescribed { at: to, acceleration, .. } = self.prescribed(t);
        let third = lit([0.0, 0.0, 1.0]);
        let thrust = (at.attitude.rotate(third) - to.attitude.rotate(third)) * T::lit(self.thrust);
        acceleration + thrust
            - (at.position - to.position) * T::lit(self.stiffness)
            - (at.velocity - to.velocity) * T::lit(self.damping)
    }
}

impl<T: Single> RigidMotion<T> for Manufactured {
    fn exact(&self, t: T) -> Kinematics<T, Vector3<T>> {
        self.prescribed(t).at
    }
}

impl Scene for Manufactured {
    fn info(&self) -> Info {
        Info {
            about: "a prescribed motion of a rigid body under loads that depend on everything: no term goes untested",
            source: "manufactured solution (Roache 2002)",
            horizon_s: 1.75,
            time_scale_s: 1.0 / self.frequency,
            coarsest_steps: 4,
        }
    }

    fn check(&self) -> Result<(), Error> {
        rigid::check("manufactured", self.inertia, self.attitude)
    }

    fn account(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        rigid::account_of_flight(self.mass, self.inertia, lit([0.0; 3]), seen)
            .into_iter()
            .map(|entry| Entry { conserved: false, ..entry })
            .collect()
    }
}
