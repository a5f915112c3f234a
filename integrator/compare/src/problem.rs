//! The problems as everybody gets them, y' = f(t, y) on plain numbers, and as models of the integrator; with exact motions.

use integrator::pose::Fixed;
use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::{Model, Real, Rotation, State};
use nalgebra::{Vector1, Vector2, Vector3};

use crate::exact;

/// A scene as an ordinary differential equation in N numbers.
pub trait Problem<const N: usize>: Copy {
    /// The name of the scene.
    const SCENE: &'static str;
    /// What the N numbers are.
    const NUMBERS: &'static str;

    /// f(y); none of these depends on the time.
    fn rate(&self, y: &[f64; N]) -> [f64; N];

    /// The exact y at the time `t_s`; NaN at a time that [`exact`] does not know.
    fn exact(t_s: f64) -> [f64; N];

    /// The horizon of the scene, s.
    fn horizon_s() -> f64;

    /// The largest error of a measured quantity (m, m/s, rad, rad/s).
    fn error(got: &[f64; N], exact: &[f64; N]) -> f64;
}

/// x'' = -w^2 x, the scene `oscillator`.
#[derive(Clone, Copy)]
pub struct Spring {
    /// -w^2, 1/s^2.
    pub minus_w_squared: f64,
}

/// theta'' = -w0^2 sin theta, the scene `pendulum`.
#[derive(Clone, Copy)]
pub struct Swing {
    /// -w0^2, 1/s^2.
    pub minus_w0_squared: f64,
}

/// r'' = -mu r / |r|^3, the scene `kepler`.
#[derive(Clone, Copy)]
pub struct Planet {
    /// -mu, m^3/s^2.
    pub minus_mu: f64,
}

/// q' = q (0, omega) / 2, omega' = I^-1 (I omega x omega), in the body frame: the scene `torque-free-spin`.
#[derive(Clone, Copy)]
pub struct Spin {
    /// ((I2 - I3) / I1, (I3 - I1) / I2, (I1 - I2) / I3).
    pub ratios: [f64; 3],
}

/// Principal moments of inertia of [`Spin`], kg m^2.
pub const INERTIA: [f64; 3] = [1.25, 0.75, 1.75];

impl Default for Spring {
    fn default() -> Self {
        Spring { minus_w_squared: -6.0 / 1.5 }
    }
}

impl Default for Swing {
    fn default() -> Self {
        Swing { minus_w0_squared: -9.8125 / 1.5 }
    }
}

impl Default for Planet {
    fn default() -> Self {
        Planet { minus_mu: -2.0 }
    }
}

impl Default for Spin {
    fn default() -> Self {
        let [a, b, c] = INERTIA;
        Spin { ratios: [(b - c) / a, (c - a) / b, (a - b) / c] }
    }
}

impl<T: Real> Model<T> for Spring {
    type Config = Vector1<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        s.q * T::lit(self.minus_w_squared)
    }
    #[inline(always)]
    fn kick(&self, _t: T, h: T, s: &State<Vector1<T>>) -> Vector1<T> {
        s.v.zip_map(&s.q, |v, q| (h * T::lit(self.minus_w_squared)).mul_add(q, v))
    }
}

impl<T: Real> Model<T> for Swing {
    type Config = Vector1<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(s.q.x.sin_cos().0 * T::lit(self.minus_w0_squared))
    }
}

impl<T: Real> Model<T> for Planet {
    type Config = Vector2<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector2<T>>) -> Vector2<T> {
        let square = s.q.x * s.q.x + s.q.y * s.q.y;
        s.q * (T::lit(self.minus_mu) / (square * square.sqrt()))
    }
}

impl<T: Real> RigidBody<T> for Spin {
    type Position = Fixed<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        Vector3::from(INERTIA.map(T::lit))
    }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::None
    }
}

fn largest<const N: usize>(halves: usize, got: &[f64; N], exact: &[f64; N]) -> f64 {
    let distance = |range: std::ops::Range<usize>| range.map(|i| (got[i] - exact[i]).powi(2)).sum::<f64>().sqrt();
    // Not `f64::max`, which forgets a NaN.
    let (q, v) = (distance(0..halves), distance(halves..N));
    if q > v { q } else { v + 0.0 * q }
}

impl Problem<2> for Spring {
    const SCENE: &'static str = "oscillator";
    const NUMBERS: &'static str = "x, v";

    #[inline(always)]
    fn rate(&self, y: &[f64; 2]) -> [f64; 2] {
        [y[1], self.minus_w_squared * y[0]]
    }
    fn exact(t_s: f64) -> [f64; 2] {
        exact::spring(t_s)
    }
    fn horizon_s() -> f64 {
        2.75
    }
    fn error(got: &[f64; 2], exact: &[f64; 2]) -> f64 {
        largest(1, got, exact)
    }
}

impl Problem<2> for Swing {
    const SCENE: &'static str = "pendulum";
    const NUMBERS: &'static str = "angle, rate";

    #[inline(always)]
    fn rate(&self, y: &[f64; 2]) -> [f64; 2] {
        [y[1], self.minus_w0_squared * y[0].sin()]
    }
    fn exact(t_s: f64) -> [f64; 2] {
        exact::at(&exact::SWING, t_s)
    }
    fn horizon_s() -> f64 {
        2.75
    }
    fn error(got: &[f64; 2], exact: &[f64; 2]) -> f64 {
        largest(1, got, exact)
    }
}

impl Problem<4> for Planet {
    const SCENE: &'static str = "kepler";
    const NUMBERS: &'static str = "x, y, vx, vy";

    #[inline(always)]
    fn rate(&self, y: &[f64; 4]) -> [f64; 4] {
        let square = y[0] * y[0] + y[1] * y[1];
        let pull = self.minus_mu / (square * square.sqrt());
        [y[2], y[3], pull * y[0], pull * y[1]]
    }
    fn exact(t_s: f64) -> [f64; 4] {
        exact::at(&exact::PLANET, t_s)
    }
    fn horizon_s() -> f64 {
        2.25
    }
    fn error(got: &[f64; 4], exact: &[f64; 4]) -> f64 {
        largest(2, got, exact)
    }
}

impl Problem<7> for Spin {
    const SCENE: &'static str = "torque-free-spin";
    const NUMBERS: &'static str = "quaternion, omega in the body frame";

    #[inline(always)]
    fn rate(&self, y: &[f64; 7]) -> [f64; 7] {
        let [w, x, y_, z, p, q, r] = *y;
        [
            -0.5 * (x * p + y_ * q + z * r),
            0.5 * (w * p + y_ * r - z * q),
            0.5 * (w * q + z * p - x * r),
            0.5 * (w * r + x * q - y_ * p),
            self.ratios[0] * (q * r),
            self.ratios[1] * (r * p),
            self.ratios[2] * (p * q),
        ]
    }
    fn exact(t_s: f64) -> [f64; 7] {
        exact::at(&exact::SPIN, t_s)
    }
    fn horizon_s() -> f64 {
        2.25
    }
    fn error(got: &[f64; 7], exact: &[f64; 7]) -> f64 {
        let parts = |y: &[f64; 7]| {
            let attitude = Rotation::from_wxyz([y[0], y[1], y[2], y[3]]);
            (attitude, attitude.rotate(Vector3::new(y[4], y[5], y[6])))
        };
        let ((q, omega), (q_exact, omega_exact)) = (parts(got), parts(exact));
        let (angle, rate) = (q.angle_to(q_exact), (omega - omega_exact).norm());
        if angle > rate { angle } else { rate + 0.0 * angle }
    }
}
