//! A projectile: x'' = F / m in R^3.
//!
//! x(t) = x0 + v0 t + a t^2 / 2, v(t) = v0 + a t, a = F / m. Every method that is exact on quadratic polynomials is exact
//! here; the Eulers are wrong by exactly -+ a t h / 2. Source: G. Galilei, Discorsi (1638), day four.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::Vector3;

use crate::catalogue::answerable;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Scene};
use crate::special::scaled::{Scaled, sum_of_vectors};
use crate::theory::{ExpectedGrowth, Theory};

scene_parameters! {
    /// A projectile under a constant force.
    pub struct ConstantForce {
        /// Mass.
        mass: f64 = 1.25, "kg", Positive;
        /// Force.
        force: [f64; 3] = [0.625, -0.3125, -12.1875], "N", Finite;
        /// Position at the start.
        x0: [f64; 3] = [0.5, -1.25, 2.0], "m", Finite;
        /// Velocity at the start.
        v0: [f64; 3] = [3.0, 1.5, 7.25], "m/s", Finite;
    }
}

impl ConstantForce {
    fn acceleration<T: Real>(&self) -> Vector3<T> {
        lit(self.force) / T::lit(self.mass)
    }
}

/// A constant vector in any arithmetic.
pub(crate) fn lit<T: Real>(v: [f64; 3]) -> Vector3<T> {
    Vector3::from(v.map(T::lit))
}

impl<T: Real> Model<T> for ConstantForce {
    type Config = Vector3<T>;

    #[inline(always)]
    fn rate(&self, _t: T, _s: &State<Vector3<T>>) -> Vector3<T> {
        self.acceleration()
    }
}

impl<T: Single> Motion<T> for ConstantForce {
    fn exact(&self, t: T) -> State<Vector3<T>> {
        let (time, one) = (Scaled::of_wide(t.widen()), Scaled::of(1.0));
        let gain = time.over(Scaled::of(self.mass));
        let [x0, v0, force] = [self.x0, self.v0, self.force].map(lit::<fx128>);
        let position = sum_of_vectors([(one, x0), (time, v0), (gain.times(time).shifted(-1), force)]);
        rounded(position, sum_of_vectors([(one, v0), (gain, force)]))
    }
    fn observe(&self, s: &State<Vector3<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for ConstantForce {
    fn info(&self) -> Info {
        Info {
            kind: Kind::ConstantForce,
            about: "a projectile in R^3: every polynomial-exact method is exact, the Eulers are off by -+ a t h / 2",
            equation: r"m\,\ddot{\mathbf x} = \mathbf F",
            source: "x0 + v0 t + a t^2 / 2 (Galilei 1638)",
            horizon_s: 1.5,
            time_scale_s: 1.0,
            coarsest_steps: 4,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let end_s = self.info().horizon_s;
        let seen = Motion::<f64>::observe(self, &self.exact(end_s));
        answerable::range("constant-force", self, &seen, end_s)
    }

    fn is_periodic(&self) -> bool {
        false
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let mass = fx128::lit(self.mass);
        let (x, v) = (seen.vector(Quantity::Position), seen.vector(Quantity::Velocity));
        let kinetic = v.iter().fold(fx128::ZERO, |sum, &c| sum + c * c) * mass * fx128::lit(0.5);
        let work = x.iter().zip(self.force).fold(fx128::ZERO, |sum, (&c, f)| sum + c * fx128::lit(f));
        vec![
            Entry { invariant: Invariant::Energy, value: vec![kinetic - work], conserved: true },
            Entry { invariant: Invariant::Momentum, value: v.iter().map(|&c| c * mass).collect(), conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        let constant = 0.5 * end_s * Vector3::from(self.force).norm() / self.mass;
        match (method, quantity) {
            (_, Quantity::Velocity) => Theory::exact("v is linear in t, and every method sums it exactly"),
            _ if self.force == [0.0; 3] => Theory::exact("nothing pushes: v is constant"),
            (MethodId::ExplicitEuler, _) => Theory::with_constant(method, constant, "x is wrong by exactly -a t h / 2"),
            (MethodId::SemiImplicitEuler | MethodId::ImplicitEuler, _) => {
                Theory::with_constant(method, constant, "x is wrong by exactly +a t h / 2")
            }
            _ => Theory::exact("exact on polynomials of degree two"),
        }
    }

    fn growth(&self, method: MethodId, invariant: Invariant, _h_s: f64) -> Option<ExpectedGrowth> {
        use crate::theory::Law;
        match (method, invariant) {
            (_, Invariant::Momentum) => Some(ExpectedGrowth {
                law: Law::AtTheFloor,
                bounds: None,
                seen_after_s: 0.0,
                reason: "v is summed exactly but for rounding",
            }),
            (MethodId::ExplicitEuler | MethodId::SemiImplicitEuler | MethodId::ImplicitEuler, Invariant::Energy)
                if self.force != [0.0; 3] =>
            {
                Some(ExpectedGrowth {
                    law: Law::Linear,
                    bounds: None,
                    seen_after_s: 0.0,
                    reason: "E - E0 = F . (a t h / 2), from the position error",
                })
            }
            (_, Invariant::Energy) => Some(ExpectedGrowth {
                law: Law::AtTheFloor,
                bounds: None,
                seen_after_s: 0.0,
                reason: "position and velocity are exact but for rounding",
            }),
            _ => None,
        }
    }
}
