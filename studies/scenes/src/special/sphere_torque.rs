//! The exact motion of a sphere under a torque that is constant in the world frame (Landau-Zener problem).
//!
//! omega = omega0 + (tau / I) t, but the attitude is elementary only where tau and omega0 are parallel: rotations about the
//! directions that omega passes through do not commute. C. Zener, Non-adiabatic crossing of energy levels, Proc. R.
//! Soc. A 137 (1932) 696-702, solves the same equation of a spin in a field that changes linearly.

use faer::fx128;
use integrator::real::{Real, Single};
use integrator::rotation::{Rotation, cross, dot};
use nalgebra::{Complex, Vector3};

use super::kummer::{Complex128, Kummer, hypergeometric_1f1};

/// A sphere (three equal moments) with constant torque in the world frame.
#[derive(Clone, Copy, Debug)]
pub struct SphereTop {
    /// Attitude at t = 0, body to world.
    attitude0: Rotation<fx128>,
    /// omega at t = 0 and its rate, world frame, rad/s and rad/s^2.
    omega0: Vector3<fx128>,
    acceleration: Vector3<fx128>,
    /// None where omega keeps its direction.
    turning: Option<Turning>,
}

impl SphereTop {
    /// Moment of inertia (kg m^2), attitude (w, x, y, z) normalised in double-double, omega (rad/s) and torque (N m) in the
    /// world frame.
    pub fn new(inertia: f64, attitude0: [f64; 4], omega_world0: [f64; 3], torque_world: [f64; 3]) -> Self {
        let omega0 = Vector3::from(omega_world0).map(fx128::from_f64);
        let torque = Vector3::from(torque_world).map(fx128::from_f64);
        let normal = cross(torque, omega0);
        Self {
            attitude0: Rotation::from_wxyz(attitude0.map(fx128::from_f64)),
            omega0,
            acceleration: torque.map(|c| c / fx128::from_f64(inertia)),
            turning: (dot(normal, normal).0 > 0.0).then(|| Turning::new(inertia, omega0, torque)),
        }
    }

    /// Attitude (body to world) and angular velocity in the world frame (rad/s) at time t (s).
    ///
    /// Error (measured): f64 below 1e-15, double-double 1e-28, for |tau| t^2 / I up to 512.
    pub fn at<T: Single>(&self, t: T) -> (Rotation<T>, Vector3<T>) {
        let t = t.widen();
        let turn = match &self.turning {
            Some(turning) => turning.at(t),
            None => Rotation::exp((self.omega0 + self.acceleration * (t * fx128::from_f64(0.5))) * t),
        };
        let attitude = (turn * self.attitude0).normalized();
        let omega = self.omega0 + self.acceleration * t;
        (Rotation { w: T::narrow(attitude.w), v: attitude.v.map(T::narrow) }, omega.map(T::narrow))
    }
}

/// The SU(2) matrix ((a, -b*), (b, a*)) in the frame (omega0 perpendicular to tau, the third axis x the first, tau).
///
/// With A = |tau| / I, s = omega_parallel / A + t, p = i omega_perp^2 / (8 A), Z = i A s^2 / 2:
/// a = e^(-i A s^2 / 4) (c1 f + c2 g), f = 1F1(p; 1/2; Z), g = s 1F1(p + 1/2; 3/2; Z), and
/// b = 2 i e^(-i A s^2 / 4) (c1 f' + c2 g') / omega_perp. The Wronskian f g' - f' g = e^Z gives c1 and c2 from a(0) = 1, b(0) = 0.
#[derive(Clone, Copy, Debug)]
struct Turning {
    /// Attitude of that frame in the world.
    frame: Rotation<fx128>,
    rate: fx128,
    perpendicular: fx128,
    s0: fx128,
    c1: Complex128,
    c2: Complex128,
}

impl Turning {
    fn new(inertia: f64, omega0: Vector3<fx128>, torque: Vector3<fx128>) -> Self {
        let strength = Real::sqrt(dot(torque, torque));
        let z = torque.map(|c| c / strength);
        let y = cross(z, omega0);
        let perpendicular = Real::sqrt(dot(y, y));
        let y = y.map(|c| c / perpendicular);
        let rate = strength / fx128::from_f64(inertia);
        let s0 = dot(omega0, z) / rate;
        let zero = Complex::new(fx128::ZERO, fx128::ZERO);
        let mut turning = Self { frame: frame_of(cross(y, z), y, z), rate, perpendicular, s0, c1: zero, c2: zero };
        let solutions = turning.solutions(s0);
        let phase = turning.phase(s0);
        turning.c1 = phase * solutions.g_rate;
        turning.c2 = -phase * solutions.f_rate;
        turning
    }

    fn at(&self, t: fx128) -> Rotation<fx128> {
        let s = self.s0 + t;
        let Solutions { f, f_rate, g, g_rate } = self.solutions(s);
        let phase = self.phase(s);
        let a = phase * (self.c1 * f + self.c2 * g);
        let half_b = phase * (self.c1 * f_rate + self.c2 * g_rate) / Complex::new(self.perpendicular, fx128::ZERO);
        // b = 2 i half_b; the quaternion is (Re a, -Im b, Re b, -Im a).
        let two = fx128::from_f64(2.0);
        let turn = Rotation { w: a.re, v: Vector3::new(-half_b.re * two, -half_b.im * two, -a.im) };
        self.frame * turn * self.frame.conjugate()
    }

    /// e^(-i A s^2 / 4).
    fn phase(&self, s: fx128) -> Complex128 {
        let (sine, cosine) = (self.rate * s * s * fx128::from_f64(0.25)).sin_cos();
        Complex::new(cosine, -sine)
    }

    fn solutions(&self, s: fx128) -> Solutions {
        let half = fx128::from_f64(0.5);
        let imaginary = |x: fx128| Complex::new(fx128::ZERO, x);
        let p = imaginary(self.perpendicular * self.perpendicular / (fx128::from_f64(8.0) * self.rate));
        let z = imaginary(self.rate * s * s * half);
        let even = hypergeometric_1f1(p, half, z);
        let odd: Kummer = hypergeometric_1f1(p + Complex::new(half, fx128::ZERO), fx128::from_f64(1.5), z);
        // dZ/ds = i A s.
        let z_rate = imaginary(self.rate * s);
        let s = Complex::new(s, fx128::ZERO);
        Solutions {
            f: even.value,
            f_rate: even.derivative * z_rate,
            g: odd.value * s,
            g_rate: odd.value + odd.derivative * z_rate * s,
        }
    }
}

/// Two solutions and their derivatives in s.
struct Solutions {
    f: Complex128,
    f_rate: Complex128,
    g: Complex128,
    g_rate: Complex128,
}

/// The rotation whose matrix has the columns x, y, z (orthonormal, right-handed), from its largest component.
fn frame_of(x: Vector3<fx128>, y: Vector3<fx128>, z: Vector3<fx128>) -> Rotation<fx128> {
    let one = fx128::ONE;
    let candidates = [
        [one + x.x + y.y + z.z, y.z - z.y, z.x - x.z, x.y - y.x],
        [y.z - z.y, one + x.x - y.y - z.z, x.y + y.x, x.z + z.x],
        [z.x - x.z, x.y + y.x, one - x.x + y.y - z.z, y.z + z.y],
        [x.y - y.x, x.z + z.x, y.z + z.y, one - x.x - y.y + z.z],
    ];
    let best = (1..4).fold(0, |best, i| if candidates[i][i].0 > candidates[best][best].0 { i } else { best });
    Rotation::from_wxyz(candidates[best])
}
