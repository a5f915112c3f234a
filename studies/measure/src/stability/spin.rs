//! A spinning body: nutation factors of the linearised spin, and the blow-up in finite time.

use integrator::methods::{ExplicitEuler, ImplicitEuler, ImplicitMidpoint, Rk4, SemiImplicitEuler};
use integrator::pose::Fixed;
use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, RigidModel, Torque, WorldMomentum, WorldOmega};
use integrator::{Method, Real, Rotation, Vector};
use nalgebra::Vector3;

/// A free body.
#[derive(Clone, Copy, Debug)]
pub struct Free {
    /// Principal moments of inertia, kg m^2.
    pub inertia: [f64; 3],
}

impl<T: Real> RigidBody<T> for Free {
    type Position = Fixed<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        Vector3::from(self.inertia.map(T::lit))
    }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::None
    }
}

/// What is stored, and how it is stepped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpinScheme {
    /// omega in the body frame, semi-implicit Euler; explicit Euler has the same factor.
    BodySemiImplicit,
    /// omega in the world frame, semi-implicit Euler: the same motion, by equivariance.
    WorldSemiImplicit,
    /// omega in the world frame, explicit Euler: the attitude moves with the old omega.
    WorldExplicit,
    /// L in the world frame, omega = I_w^-1 L.
    Momentum,
    /// omega in the body frame, RK4.
    BodyRk4,
    /// omega in the body frame, implicit Euler.
    BodyImplicit,
    /// omega in the body frame, implicit midpoint.
    BodyMidpoint,
}

impl SpinScheme {
    /// Every one.
    pub const ALL: [SpinScheme; 7] = [
        SpinScheme::BodySemiImplicit,
        SpinScheme::WorldSemiImplicit,
        SpinScheme::WorldExplicit,
        SpinScheme::Momentum,
        SpinScheme::BodyRk4,
        SpinScheme::BodyImplicit,
        SpinScheme::BodyMidpoint,
    ];

    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            SpinScheme::BodySemiImplicit => "semi-implicit-euler/body-omega",
            SpinScheme::WorldSemiImplicit => "semi-implicit-euler/world-omega",
            SpinScheme::WorldExplicit => "explicit-euler/world-omega",
            SpinScheme::Momentum => "semi-implicit-euler/world-momentum",
            SpinScheme::BodyRk4 => "rk4/body-omega",
            SpinScheme::BodyImplicit => "implicit-euler/body-omega",
            SpinScheme::BodyMidpoint => "implicit-midpoint/body-omega",
        }
    }

    /// In words.
    pub fn title(self) -> &'static str {
        match self {
            SpinScheme::BodySemiImplicit => "Semi-implicit Euler, omega stored in the body frame",
            SpinScheme::WorldSemiImplicit => "Semi-implicit Euler, omega stored in the world frame",
            SpinScheme::WorldExplicit => "Explicit Euler, omega stored in the world frame",
            SpinScheme::Momentum => "Angular momentum stored",
            SpinScheme::BodyRk4 => "RK4, omega stored in the body frame",
            SpinScheme::BodyImplicit => "Implicit Euler, omega stored in the body frame",
            SpinScheme::BodyMidpoint => "Implicit midpoint, omega stored in the body frame",
        }
    }

    /// By how much one step multiplies a small nutation of the symmetric body (1, 1, rho) that spins by theta = omega3 h.
    ///
    /// With x = (rho - 1) theta: sqrt(1 + x^2), explicit with world omega sqrt(1 + 2 x sin theta + x^2), momentum
    /// sqrt(1 + 4 rho (rho - 1) sin^2(theta / 2)), RK4 |R(i x)|, implicit Euler 1 / sqrt(1 + x^2), midpoint 1.
    pub fn theory(self, rho: f64, theta: f64) -> f64 {
        let x = (rho - 1.0) * theta;
        match self {
            SpinScheme::BodySemiImplicit | SpinScheme::WorldSemiImplicit => x.hypot(1.0),
            SpinScheme::WorldExplicit => (1.0 + 2.0 * x * theta.sin() + x * x).sqrt(),
            SpinScheme::Momentum => (1.0 + 4.0 * rho * (rho - 1.0) * (0.5 * theta).sin().powi(2)).sqrt(),
            SpinScheme::BodyRk4 => (1.0 - x.powi(6) / 72.0 + x.powi(8) / 576.0).sqrt(),
            SpinScheme::BodyImplicit => 1.0 / x.hypot(1.0),
            SpinScheme::BodyMidpoint => 1.0,
        }
    }

    /// The same factor, measured over [`STEPS`] steps of a run with a tilt of [`TILT`].
    pub fn measured(self, rho: f64, theta: f64) -> f64 {
        let body = Free { inertia: [1.0, 1.0, rho] };
        match self {
            SpinScheme::BodySemiImplicit => nutation(&BodyOmega::<_>::new(body), &SemiImplicitEuler, theta),
            SpinScheme::WorldSemiImplicit => nutation(&WorldOmega::<_>::new(body), &SemiImplicitEuler, theta),
            SpinScheme::WorldExplicit => nutation(&WorldOmega::<_>::new(body), &ExplicitEuler, theta),
            SpinScheme::Momentum => nutation(&WorldMomentum::<_>::new(body), &SemiImplicitEuler, theta),
            SpinScheme::BodyRk4 => nutation(&BodyOmega::<_>::new(body), &Rk4, theta),
            SpinScheme::BodyImplicit => nutation(&BodyOmega::<_>::new(body), &ImplicitEuler, theta),
            SpinScheme::BodyMidpoint => nutation(&BodyOmega::<_>::new(body), &ImplicitMidpoint, theta),
        }
    }
}

/// Tilt of the measurement: eps / TILT = 2e-8 is the rounding of its factor, its square the part left out by linearising.
pub const TILT: f64 = 1e-8;
/// Steps of the measurement.
pub const STEPS: i32 = 8;
/// How well a factor is measured: rounding eps / TILT a step, and the square of a nutation that has grown 4^8 times.
pub const FACTOR_TOLERANCE: f64 = 1e-6;

fn nutation<M: RigidModel<f64>, A: Method<f64, M>>(model: &M, method: &A, theta: f64) -> f64
where
    M::Body: RigidBody<f64, Position = Fixed<f64>>,
{
    let omega_body = Vector3::new(TILT * theta, 0.0, theta);
    let mut s = model.state(&at_rest(omega_body));
    for _ in 0..STEPS {
        s = method.step(model, 0.0, 1.0, s);
    }
    let end = model.kinematics(&s).omega_body;
    (end.x.hypot(end.y) / (TILT * theta)).powf(1.0 / f64::from(STEPS))
}

/// A body in the world's axes that turns.
pub fn at_rest(omega_body: Vector3<f64>) -> Kinematics<f64, Fixed<f64>> {
    Kinematics { position: Fixed::zero(), velocity: Fixed::zero(), attitude: Rotation::identity(), omega_body }
}

/// A thin body: a rod with a little thickness.
pub const THIN: [f64; 3] = [0.0625, 1.0, 1.03125];
/// Its angular velocity at the start, in the body frame, rad/s.
pub const FAST: [f64; 3] = [6.0, 2.0, 3.0];

/// |omega| at every step of semi-implicit Euler on the thin body, until it is no longer finite or `most` steps are taken.
pub fn thin_body(h: f64, most: u64) -> Vec<f64> {
    let model = BodyOmega::<_>::new(Free { inertia: THIN });
    let mut s = model.state(&at_rest(Vector3::from(FAST)));
    let mut speeds = vec![s.v.angular.norm()];
    while speeds.len() as u64 <= most {
        s = SemiImplicitEuler.step(&model, 0.0, h, s);
        speeds.push(s.v.angular.norm());
        if !s.v.angular.norm().is_finite() {
            break;
        }
    }
    speeds
}

/// No blow-up comes before 4 / (h L^2 (1/I1 - 1/I3)^2): |l|^2 grows by h^2 |omega x l|^2 <= h^2 |l|^4 (J1 - J3)^2 / 4 a step.
pub fn blow_up_bound(h: f64) -> f64 {
    let momentum = Vector3::from(THIN).component_mul(&Vector3::from(FAST));
    let spread = 1.0 / THIN[0] - 1.0 / THIN[2];
    4.0 / (h * momentum.norm_squared() * spread * spread)
}
