//! A manufactured motion: a smooth path and attitude are prescribed, and the loads follow from the equations of motion.
//!
//! x* = x0 + v0 t + swing sin(nu t); the attitude is that of the quaternion p = a + b sin(nu t) + c cos(nu t), normalised:
//! omega = 2 Im(p* p') / |p|^2, omega' = 2 Im(p* p'') / |p|^2 - 2 omega (p . p') / |p|^2, in the body frame.
//! The loads that produce it are m x*'' and I omega*' + omega* x I omega*; terms that vanish on it make the
//! right-hand side depend on everything: springs and dampers towards the path, attitude in the force, position in the
//! torque. (P. J. Roache, Code verification by the method of manufactured solutions, J. Fluids Eng. 124 (2002) 4-10.)

use faer::fx128;
use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::rotation::{cross, dot};
use integrator::{Real, Rotation, Single};
use nalgebra::{Vector3, Vector4};

use crate::catalogue::constant_force::lit;
use crate::catalogue::rigid;
use crate::error::Error;
use crate::invariants::Entry;
use crate::motion::RigidMotion;
use crate::observation::Observation;
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene, time_scale};

scene_parameters! {
    /// A rigid body on a prescribed motion, held to it by loads that depend on time, position, velocity, attitude and omega.
    pub struct Manufactured {
        /// Mass.
        mass: f64 = 1.5, "kg", Positive;
        /// Principal moments of inertia.
        inertia: [f64; 3] = [1.25, 0.75, 1.75], "kg m^2", Positive;
        /// Quaternion a, about which the attitude swings.
        attitude: [f64; 4] = [0.5, -0.75, 1.0, 0.25], "1", Finite;
        /// Quaternion b of its swing with the sine.
        sine: [f64; 4] = [0.25, 0.5, -0.125, 0.25], "1", Finite;
        /// Quaternion c of its swing with the cosine, |b| + |c| < |a|.
        cosine: [f64; 4] = [-0.25, 0.125, 0.25, -0.5], "1", Finite;
        /// Position at the start.
        x0: [f64; 3] = [0.5, -1.25, 2.0], "m", Finite;
        /// Mean velocity.
        v0: [f64; 3] = [1.0, 0.75, -0.5], "m/s", Finite;
        /// Amplitude of the swing of the position.
        swing: [f64; 3] = [-0.5, 0.25, 0.75], "m", Finite;
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
    /// How fast it swings, or is held, 1/s. The attitude turns the faster the nearer its quaternion swings to zero; by 1.85 at
    /// most with the default.
    fn rate(&self) -> f64 {
        let [a, b, c] = [self.attitude, self.sine, self.cosine].map(|q| Vector4::from(q).norm());
        let turning = 2.0 * self.frequency * (b + c) / (a - b - c);
        self.frequency.max(turning / 4.0).max(self.stiffness.sqrt()).max(self.damping)
    }

    fn prescribed<T: Real>(&self, t: T) -> Prescribed<T> {
        let nu = T::lit(self.frequency);
        let (sine, cosine) = (nu * t).sin_cos();
        // sin(nu t) and cos(nu t) with their first and second derivatives.
        let sines = [sine, nu * cosine, -(nu * nu * sine)];
        let cosines = [cosine, -(nu * sine), -(nu * nu * cosine)];
        let swinging = |k: usize| plus(quaternion(self.sine, sines[k]), quaternion(self.cosine, cosines[k]));
        let p = plus(quaternion(self.attitude, T::lit(1.0)), swinging(0));
        let (first, second) = (swinging(1), swinging(2));
        let twice = T::lit(2.0) / p.norm_squared();
        let omega = (p.conjugate() * first).v * twice;
        let along = (p.w * first.w + dot(p.v, first.v)) * twice;
        let omega_rate_body = (p.conjugate() * second).v * twice - omega * along;

        let (v0, swing) = (lit::<T>(self.v0), lit::<T>(self.swing));
        let position = lit::<T>(self.x0) + v0 * t + swing * sines[0];
        let velocity = v0 + swing * sines[1];
        let at = Kinematics { position, velocity, attitude: p.normalized(), omega_body: omega };
        Prescribed { at, acceleration: swing * sines[2], omega_rate_body }
    }
}

/// `size` times a quaternion, not normalised.
fn quaternion<T: Real>([w, x, y, z]: [f64; 4], size: T) -> Rotation<T> {
    Rotation { w: T::lit(w) * size, v: lit::<T>([x, y, z]) * size }
}

fn plus<T: Real>(a: Rotation<T>, b: Rotation<T>) -> Rotation<T> {
    Rotation { w: a.w + b.w, v: a.v + b.v }
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
        let Kinematics { position, velocity, attitude, omega_body } = self.prescribed(t.widen()).at;
        Kinematics {
            position: position.map(T::narrow),
            velocity: velocity.map(T::narrow),
            attitude: rigid::narrow(attitude),
            omega_body: omega_body.map(T::narrow),
        }
    }
}

impl Scene for Manufactured {
    fn info(&self) -> Info {
        let faster = self.rate() / Self::default().rate();
        let pace = Pace { horizon_s: 1.75, coarsest_steps: 4 }.at(faster);
        Info {
            kind: Kind::DrivenBody,
            about: "a prescribed motion of a rigid body under loads that depend on everything: no term goes untested",
            equation: r"m\,\ddot{\mathbf x} = \mathbf F(t, \mathbf x, \mathbf v, q),\quad I\,\dot{\omega} = I\omega\times\omega + \tau(t, \mathbf x, \mathbf v, q, \omega)",
            source: "manufactured solution (Roache 2002)",
            horizon_s: pace.horizon_s,
            time_scale_s: time_scale(1.5 * faster),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        rigid::check("manufactured", self.inertia, self.attitude)?;
        let [a, b, c] = [self.attitude, self.sine, self.cosine].map(|q| Vector4::from(q).norm());
        if b + c >= a {
            return Err(Error::Parameter {
                scene: "manufactured".to_owned(),
                parameter: "attitude".to_owned(),
                value: format!("of norm {a}"),
                expected: format!("must be longer than sine and cosine together, {}", b + c),
            });
        }
        Ok(())
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        rigid::account_of_flight(self.mass, self.inertia, lit([0.0; 3]), seen)
            .into_iter()
            .map(|entry| Entry { conserved: false, ..entry })
            .collect()
    }
}
