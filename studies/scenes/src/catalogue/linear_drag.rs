//! A projectile with drag proportional to its velocity: m v' = m g - c v in R^3.
//!
//! With k = c / m, e1 = (1 - e^(-k t)) / k and e2 = (t - e1) / k: v = v0 e^(-k t) + g e1, x = x0 + v0 e1 + g e2. No term
//! cancels for small k t, where t - e1 is summed as a series. Source: I. Newton, Principia (1687), book II, section I.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::{DMatrix, Vector3};

use crate::catalogue::constant_force::lit;
use crate::catalogue::linear::{Linear, Parts, RK4_REAL};
use crate::invariants::{Balance, Entry};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Scene};
use crate::special::elementary::expm1;
use crate::theory::{StabilityLimit, Theory};

scene_parameters! {
    /// A projectile under gravity with linear drag.
    pub struct LinearDrag {
        /// Mass.
        mass: f64 = 1.25, "kg", Positive;
        /// Drag coefficient c.
        drag: f64 = 0.9375, "kg/s", Positive;
        /// Gravity.
        gravity: [f64; 3] = [0.25, -0.5, -9.8125], "m/s^2", Finite;
        /// Position at the start.
        x0: [f64; 3] = [0.5, -1.25, 2.0], "m", Finite;
        /// Velocity at the start.
        v0: [f64; 3] = [6.0, 2.5, 7.25], "m/s", Finite;
    }
}

impl LinearDrag {
    /// k = c / m, 1/s.
    pub fn k(&self) -> f64 {
        self.drag / self.mass
    }

    fn linear(&self) -> Linear {
        Linear::new(&Parts {
            stiffness: DMatrix::zeros(3, 3),
            damping: DMatrix::from_diagonal_element(3, 3, -self.k()),
            forcing: &self.gravity,
            drive: 0.0,
            q0: &self.x0,
            v0: &self.v0,
        })
    }
}

/// (t - (1 - e^(-k t)) / k) / k = t^2 (1/2 - z/6 + z^2/24 - ...) with z = k t, by the series for z < 1/2.
fn second_integral(k: fx128, t: fx128) -> fx128 {
    let z = k * t;
    if z.0 > 0.5 {
        return (t + expm1(-z) / k) / k;
    }
    let (mut term, mut sum) = (fx128::lit(0.5), fx128::lit(0.5));
    for n in 3..40 {
        term *= -z / fx128::lit(f64::from(n));
        sum += term;
    }
    sum * t * t
}

impl<T: Real> Model<T> for LinearDrag {
    type Config = Vector3<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector3<T>>) -> Vector3<T> {
        lit::<T>(self.gravity) - s.v * (T::lit(self.drag) / T::lit(self.mass))
    }
}

impl<T: Single> Motion<T> for LinearDrag {
    fn exact(&self, t: T) -> State<Vector3<T>> {
        let (t, k) = (t.widen(), fx128::lit(self.drag) / fx128::lit(self.mass));
        let decay = expm1(-(k * t));
        let (e1, e2) = (-decay / k, second_integral(k, t));
        let (v0, g) = (lit::<fx128>(self.v0), lit::<fx128>(self.gravity));
        rounded(lit::<fx128>(self.x0) + v0 * e1 + g * e2, v0 * (decay + fx128::ONE) + g * e1)
    }
    fn observe(&self, s: &State<Vector3<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for LinearDrag {
    fn info(&self) -> Info {
        Info {
            about: "a projectile with drag -c v: the simplest force that depends on the velocity",
            equation: r"m\,\dot{\mathbf v} = m\,\mathbf g - c\,\mathbf v",
            source: "elementary (I. Newton, Principia (1687), book II, section I)",
            horizon_s: 2.25,
            time_scale_s: 1.0 / self.k(),
            coarsest_steps: 8,
        }
    }

    fn account(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position), seen.vector(Quantity::Velocity));
        let mass = fx128::lit(self.mass);
        let kinetic = v.iter().fold(fx128::ZERO, |sum, &c| sum + c * c) * fx128::lit(0.5);
        let potential = x.iter().zip(self.gravity).fold(fx128::ZERO, |sum, (&c, g)| sum - c * fx128::lit(g));
        vec![
            Entry { balance: Balance::Energy, value: vec![(kinetic + potential) * mass], conserved: false },
            Entry { balance: Balance::Momentum, value: v.iter().map(|&c| c * mass).collect(), conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity) -> Theory {
        self.linear().theory(method, quantity, self.info().horizon_s)
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        let below = |z: f64| StabilityLimit::Below(z / self.k());
        Some(match method {
            MethodId::ExplicitEuler | MethodId::SemiImplicitEuler => (below(2.0), "|1 - k h| <= 1"),
            MethodId::VelocityVerlet => (below(2.0), "|1 - z + z^2/2| <= 1, z = k h"),
            MethodId::Rk4 => (below(RK4_REAL), "|R(-k h)| <= 1 on the real axis"),
            MethodId::ImplicitEuler | MethodId::ImplicitMidpoint => (StabilityLimit::Unlimited, "A-stable"),
        })
    }
}
