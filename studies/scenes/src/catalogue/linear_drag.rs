//! A projectile with drag proportional to its velocity: m v' = m g - c v in R^3.
//!
//! With k = c / m, e1 = (1 - e^(-k t)) / k and e2 = (t - e1) / k: v = v0 e^(-k t) + g e1, x = x0 + v0 e1 + g e2. No term
//! cancels for small k t, where t - e1 is summed as a series. Source: I. Newton, Principia (1687), book II, section I.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::{DMatrix, Vector3};

use crate::catalogue::answerable;
use crate::catalogue::constant_force::lit;
use crate::catalogue::linear::{Linear, Parts, RK4_REAL};
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene};
use crate::special::elementary::expm1;
use crate::special::scaled::{Scaled, sum_of_vectors};
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

/// (z - 1 + e^-z) / z^2 = 1/2 - z/6 + z^2/24 - ..., by the series for z < 1/2.
fn second_integral(z: fx128) -> fx128 {
    if z.0 > 0.5 {
        return (fx128::ONE + expm1(-z) / z) / z;
    }
    let (mut term, mut sum) = (fx128::lit(0.5), fx128::lit(0.5));
    for n in 3..40 {
        term *= -z / fx128::lit(f64::from(n));
        sum += term;
    }
    sum
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
        let (time, one) = (Scaled::of_wide(t.widen()), Scaled::of(1.0));
        // z = k t; e1 = t (1 - e^-z) / z and e2 = t^2 (z - 1 + e^-z) / z^2.
        let z = Scaled::of(self.drag).over(Scaled::of(self.mass)).times(time).value();
        let decay = expm1(-z);
        let first = if z.0 == 0.0 { fx128::ONE } else { -decay / z };
        let e1 = Scaled::of_wide(first).times(time);
        let e2 = Scaled::of_wide(second_integral(z)).times(time).times(time);
        let left = Scaled::of_wide((-z).exp());
        let [x0, v0, g] = [self.x0, self.v0, self.gravity].map(lit::<fx128>);
        rounded(sum_of_vectors([(one, x0), (e1, v0), (e2, g)]), sum_of_vectors([(left, v0), (e1, g)]))
    }
    fn observe(&self, s: &State<Vector3<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for LinearDrag {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.25, coarsest_steps: 8 }.at(self.k() / 0.75);
        Info {
            kind: Kind::Damping,
            about: "a projectile with drag -c v: the simplest force that depends on the velocity",
            equation: r"m\,\dot{\mathbf v} = m\,\mathbf g - c\,\mathbf v",
            source: "elementary (I. Newton, Principia (1687), book II, section I)",
            horizon_s: pace.horizon_s,
            time_scale_s: 1.0 / self.k(),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let end_s = self.info().horizon_s;
        let seen = Motion::<f64>::observe(self, &self.exact(end_s));
        answerable::range("linear-drag", self, &seen, end_s)
    }

    fn is_periodic(&self) -> bool {
        false
    }

    fn rounding_accumulates(&self) -> bool {
        false
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position), seen.vector(Quantity::Velocity));
        let mass = fx128::lit(self.mass);
        let kinetic = v.iter().fold(fx128::ZERO, |sum, &c| sum + c * c) * fx128::lit(0.5);
        let potential = x.iter().zip(self.gravity).fold(fx128::ZERO, |sum, (&c, g)| sum - c * fx128::lit(g));
        vec![
            Entry { invariant: Invariant::Energy, value: vec![(kinetic + potential) * mass], conserved: false },
            Entry { invariant: Invariant::Momentum, value: v.iter().map(|&c| c * mass).collect(), conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        self.linear().theory(method, quantity, end_s)
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        let below = |z: f64| StabilityLimit::Below(z / self.k());
        Some(match method {
            MethodId::ExplicitEuler | MethodId::SemiImplicitEuler => (below(2.0), "|1 - k h| <= 1"),
            MethodId::VelocityVerlet => (below(2.0), "|1 - z + z^2/2| <= 1, z = k h"),
            MethodId::Rk4 => (below(RK4_REAL), "|R(-k h)| <= 1 on the real axis"),
            MethodId::ImplicitEuler | MethodId::ImplicitMidpoint => (StabilityLimit::Unlimited, "A-stable"),
            _ => return None,
        })
    }
}
