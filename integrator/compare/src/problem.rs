//! The problems as everybody gets them: y' = f(t, y) on plain numbers, with the exact motion of the same scene.

use integrator::Rotation;
use nalgebra::Vector3;
use studies::scene::{Motion, RigidMotion, Scene};
use studies::scenes::{Kepler, Oscillator, Pendulum, TorqueFreeSpin};

/// A scene as an ordinary differential equation in N numbers.
pub trait Problem<const N: usize>: Copy {
    /// The name of the scene.
    const SCENE: &'static str;
    /// What the N numbers are.
    const NUMBERS: &'static str;

    /// f(y); none of these depends on the time.
    fn rate(&self, y: &[f64; N]) -> [f64; N];

    /// The exact y at the time `t_s`.
    fn exact(t_s: f64) -> [f64; N];

    /// The horizon of the scene, s.
    fn horizon_s() -> f64;

    /// The largest error of a measured quantity (m, m/s, rad, rad/s).
    fn error(got: &[f64; N], exact: &[f64; N]) -> f64;
}

/// x'' = -w^2 x.
#[derive(Clone, Copy)]
pub struct Spring {
    /// -w^2, 1/s^2.
    pub minus_w_squared: f64,
}

/// theta'' = -w0^2 sin theta.
#[derive(Clone, Copy)]
pub struct Swing {
    /// -w0^2, 1/s^2.
    pub minus_w0_squared: f64,
}

/// r'' = -mu r / |r|^3.
#[derive(Clone, Copy)]
pub struct Planet {
    /// -mu, m^3/s^2.
    pub minus_mu: f64,
}

/// q' = q (0, omega) / 2, omega' = I^-1 (I omega x omega), in the body frame.
#[derive(Clone, Copy)]
pub struct Spin {
    /// ((I2 - I3) / I1, (I3 - I1) / I2, (I1 - I2) / I3).
    pub ratios: [f64; 3],
}

impl Default for Spring {
    fn default() -> Self {
        let Oscillator { mass, stiffness, .. } = Oscillator::default();
        Spring { minus_w_squared: -stiffness / mass }
    }
}

impl Default for Swing {
    fn default() -> Self {
        let Pendulum { gravity, length, .. } = Pendulum::default();
        Swing { minus_w0_squared: -gravity / length }
    }
}

impl Default for Planet {
    fn default() -> Self {
        Planet { minus_mu: -Kepler::default().mu }
    }
}

impl Default for Spin {
    fn default() -> Self {
        let [a, b, c] = TorqueFreeSpin::default().inertia;
        Spin { ratios: [(b - c) / a, (c - a) / b, (a - b) / c] }
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
        let s = Motion::<f64>::exact(&Oscillator::default(), t_s);
        [s.q.x, s.v.x]
    }
    fn horizon_s() -> f64 {
        Oscillator::default().info().horizon_s
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
        let s = Motion::<f64>::exact(&Pendulum::default(), t_s);
        [s.q.x, s.v.x]
    }
    fn horizon_s() -> f64 {
        Pendulum::default().info().horizon_s
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
        let s = Motion::<f64>::exact(&Kepler::default(), t_s);
        [s.q.x, s.q.y, s.v.x, s.v.y]
    }
    fn horizon_s() -> f64 {
        Kepler::default().info().horizon_s
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
        let at = RigidMotion::<f64>::exact(&TorqueFreeSpin::default(), t_s);
        let ([w, x, y, z], omega) = (at.attitude.wxyz(), at.omega_body);
        [w, x, y, z, omega.x, omega.y, omega.z]
    }
    fn horizon_s() -> f64 {
        TorqueFreeSpin::default().info().horizon_s
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
