//! The exact motion of a torque-free body with two equal moments, in elementary functions.

use faer::fx128;
use integrator::real::{Real, Single};
use integrator::rotation::Rotation;
use nalgebra::Vector3;

/// A torque-free body with principal moments (I1, I1, I3).
///
/// q = exp(t l_world / I1) q0 exp(t (1 - I3 / I1) omega_3 e_3): the symmetry axis precesses about the fixed momentum at
/// L / I1 while the body turns about it; (omega_1, omega_2) turns at (I3 - I1) omega_3 / I1. Phases are formed
/// in double-double, so f64 results are good to 1e-15 at any time. (L. D. Landau, E. M. Lifshitz, Mechanics, section 35.)
#[derive(Clone, Copy, Debug)]
pub struct SymmetricTop {
    /// Attitude at t = 0, body to world.
    attitude0: Rotation<fx128>,
    /// Angular velocity at t = 0 in the body frame, rad/s.
    omega0: Vector3<fx128>,
    /// l_world / I1, rad/s.
    precession_world: Vector3<fx128>,
    /// (I3 - I1) omega_3 / I1, rad/s.
    nutation: fx128,
}

impl SymmetricTop {
    /// Moments I1 = I2 and I3 (kg m^2), attitude (w, x, y, z) normalised in double-double, angular velocity in the body
    /// frame (rad/s).
    pub fn new(inertia_1: f64, inertia_3: f64, attitude0: [f64; 4], omega_body0: [f64; 3]) -> Self {
        let attitude0 = Rotation::from_wxyz(attitude0.map(fx128::from_f64));
        let omega0 = Vector3::from(omega_body0).map(fx128::from_f64);
        let (i1, i3) = (fx128::from_f64(inertia_1), fx128::from_f64(inertia_3));
        let per_i1 = Vector3::new(omega0.x, omega0.y, omega0.z * i3 / i1);
        Self { attitude0, omega0, precession_world: attitude0.rotate(per_i1), nutation: (i3 - i1) * omega0.z / i1 }
    }

    /// Attitude (body to world) and angular velocity in the body frame (rad/s) at time t (s).
    pub fn at<T: Single>(&self, t: T) -> (Rotation<T>, Vector3<T>) {
        let t = t.widen();
        let angle = self.nutation * t;
        let spin = Vector3::new(fx128::ZERO, fx128::ZERO, -angle);
        let attitude = Rotation::exp(self.precession_world * t) * self.attitude0 * Rotation::exp(spin);
        let (sine, cosine) = angle.sin_cos();
        let [x, y, z] = self.omega0.into();
        let omega = Vector3::new(x * cosine - y * sine, x * sine + y * cosine, z);
        (Rotation { w: T::narrow(attitude.w), v: attitude.v.map(T::narrow) }, omega.map(T::narrow))
    }
}
