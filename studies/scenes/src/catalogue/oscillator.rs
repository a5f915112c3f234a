//! A mass on a spring: m x'' = -k x, with a general phase.
//!
//! x = x0 cos(w t) + (v0 / w) sin(w t), v = v0 cos(w t) - x0 w sin(w t), w = sqrt(k / m). The error constants come from the
//! stability function R(z) = exp(z + c z^(p+1) + ...) of a method on z' = A z: error(T) = T c h^p A^(p+1) z(T), with
//! c = -1/2 (explicit Euler), 1/2 (implicit Euler), 1/12 (implicit midpoint), -1/120 (RK4); those of semi-implicit Euler
//! and Verlet from their exact solutions. Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006),
//! IX.1 and I.5; derivations in the functions below.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::Vector1;

use crate::catalogue::answerable;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene, period};
use crate::special::elementary::sinc;
use crate::special::scaled::Scaled;
use crate::theory::Law;
use crate::theory::{ExpectedGrowth, StabilityLimit, Theory};

scene_parameters! {
    /// A mass on a spring.
    pub struct Oscillator {
        /// Mass.
        mass: f64 = 1.5, "kg", Positive;
        /// Stiffness of the spring.
        stiffness: f64 = 6.0, "N/m", Positive;
        /// Displacement at the start.
        x0: f64 = 0.75, "m", Finite;
        /// Velocity at the start.
        v0: f64 = -1.25, "m/s", Finite;
    }
}

impl Oscillator {
    /// Numbers that no binary arithmetic has: parameters that are rounded to another one show.
    pub fn decimal() -> Self {
        Oscillator { mass: 1.4, stiffness: 6.1, x0: 0.7, v0: -1.3 }
    }

    /// omega = sqrt(k / m), rad/s.
    pub fn omega(&self) -> f64 {
        (self.stiffness / self.mass).sqrt()
    }

    fn frequency(&self) -> Scaled {
        Scaled::of(self.stiffness).over(Scaled::of(self.mass)).sqrt()
    }

    /// lim (error / h^p) of position and velocity at the time `t_s`, where it is known.
    fn error_constants(&self, method: MethodId, t_s: f64) -> Option<[f64; 2]> {
        let w = self.omega();
        let State { q, v } = Motion::<f64>::exact(self, t_s);
        let (x, v) = (q.x, v.x);
        let sine = (w * t_s).sin();
        Some(match method {
            MethodId::ExplicitEuler => [w * w * t_s / 2.0 * x, w * w * t_s / 2.0 * v],
            MethodId::ImplicitEuler => [-w * w * t_s / 2.0 * x, -w * w * t_s / 2.0 * v],
            MethodId::SemiImplicitEuler => [-w / 2.0 * self.x0 * sine, w / 2.0 * self.v0 * sine],
            // x_n = x0 cos n th + v0 / (w s) sin n th, v_n = v0 cos n th - x0 w s sin n th with s^2 = 1 - (hw)^2 / 4,
            // sin(th / 2) = hw / 2, so that n th = w t (1 + (hw)^2 / 24).
            MethodId::VelocityVerlet => {
                let phase = t_s * w * w / 24.0;
                [phase * v + w * self.v0 * sine / 8.0, -phase * w * w * x + w.powi(3) * self.x0 * sine / 8.0]
            }
            MethodId::Rk4 => {
                let c = t_s * w.powi(4) / 120.0;
                [-c * v, c * w * w * x]
            }
            MethodId::ImplicitMidpoint => {
                let c = t_s * w * w / 12.0;
                [-c * v, c * w * w * x]
            }
            _ => return None,
        })
    }
}

impl<T: Real> Model<T> for Oscillator {
    type Config = Vector1<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        s.q * (-T::lit(self.stiffness) / T::lit(self.mass))
    }
}

impl<T: Single> Motion<T> for Oscillator {
    fn exact(&self, t: T) -> State<Vector1<T>> {
        let (time, w) = (Scaled::of_wide(t.widen()), self.frequency());
        let phase = w.times(time).value();
        let cosine = Scaled::of_wide(phase.sin_cos().1);
        let sinc = Scaled::of_wide(sinc(phase));
        let (x0, v0) = (Scaled::of(self.x0), Scaled::of(self.v0));
        let x = [x0.times(cosine), v0.times(time).times(sinc)];
        let v = [v0.times(cosine), Scaled::of(-self.x0).times(w).times(Scaled::of_wide(phase.sin_cos().0))];
        rounded(Vector1::new(Scaled::sum(&x)), Vector1::new(Scaled::sum(&v)))
    }
    fn observe(&self, s: &State<Vector1<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for Oscillator {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.75, coarsest_steps: 8 }.at(self.omega() / 2.0);
        let time_scale_s = 1.0 / self.omega();
        Info {
            kind: Kind::Oscillation,
            about: "a mass on a spring with a general phase: explicit Euler gains energy, semi-implicit Euler does not",
            equation: r"m\,\ddot x = -k\,x",
            source: "elementary",
            horizon_s: pace.horizon_s,
            time_scale_s,
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let end_s = self.info().horizon_s;
        let phase = self.frequency().times(Scaled::of(end_s)).value().to_f64();
        answerable::phase("oscillator", ("stiffness", &self.stiffness), phase, end_s)?;
        let seen = Motion::<f64>::observe(self, &self.exact(end_s));
        answerable::range("oscillator", self, &seen, end_s)
    }

    /// A parameter that is rounded to f32 is wrong from the start, and no step makes that smaller.
    fn rounding_accumulates(&self) -> bool {
        [self.mass, self.stiffness, self.x0, self.v0].iter().all(|&x| f64::from(x as f32) == x)
    }

    fn period_s(&self) -> Option<f64> {
        period(self.omega())
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position)[0], seen.vector(Quantity::Velocity)[0]);
        let twice = fx128::lit(self.mass) * v * v + fx128::lit(self.stiffness) * x * x;
        vec![Entry { invariant: Invariant::Energy, value: vec![twice * fx128::lit(0.5)], conserved: true }]
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        let Some([x, v]) = self.error_constants(method, end_s) else { return Theory::usual(method) };
        let constant = if quantity == Quantity::Position { x } else { v };
        Theory::with_constant(method, constant, "leading term of the method's exact solution on x'' = -w^2 x")
    }

    fn growth(&self, method: MethodId, invariant: Invariant, h_s: f64) -> Option<ExpectedGrowth> {
        let z = self.omega() * h_s;
        let exponential = |per_step: f64, reason| ExpectedGrowth {
            law: Law::Exponential,
            bounds: Some([per_step / h_s; 2]),
            seen_after_s: 0.0,
            reason,
        };
        let growth = match method {
            MethodId::ExplicitEuler => exponential((z * z).ln_1p(), "E grows by (1 + z^2) a step, z = w h"),
            MethodId::ImplicitEuler => exponential(-(z * z).ln_1p(), "E shrinks by 1 / (1 + z^2) a step, z = w h"),
            MethodId::Rk4 => exponential(
                (-z.powi(6) / 72.0 + z.powi(8) / 576.0).ln_1p(),
                "E shrinks by 1 - z^6/72 + z^8/576 a step, z = w h",
            ),
            MethodId::SemiImplicitEuler => ExpectedGrowth {
                law: Law::Bounded,
                bounds: Some(self.semi_implicit_band(h_s)),
                seen_after_s: 0.0,
                reason: "Q = v^2 + w^2 x^2 - w^2 h x v is conserved: E in [Q/2/(1 + z/2), Q/2/(1 - z/2)]",
            },
            MethodId::VelocityVerlet => ExpectedGrowth {
                law: Law::Bounded,
                bounds: Some(self.verlet_band(h_s)),
                seen_after_s: 0.0,
                reason: "v^2 + w^2 (1 - z^2/4) x^2 is conserved",
            },
            MethodId::ImplicitMidpoint => ExpectedGrowth {
                law: Law::AtTheFloor,
                bounds: None,
                seen_after_s: 0.0,
                reason: "quadratic invariants are conserved exactly",
            },
            _ => return None,
        };
        (invariant == Invariant::Energy).then_some(growth)
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        let below = |z: f64| StabilityLimit::Below(z / self.omega());
        Some(match method {
            MethodId::ExplicitEuler => (StabilityLimit::NoStep, "|R(i z)|^2 = 1 + z^2"),
            MethodId::SemiImplicitEuler | MethodId::VelocityVerlet => (below(2.0), "sin(theta / 2) = z / 2"),
            MethodId::Rk4 => (below(8.0_f64.sqrt()), "|R(i z)|^2 = 1 - z^6/72 + z^8/576"),
            MethodId::ImplicitEuler | MethodId::ImplicitMidpoint => (StabilityLimit::Unlimited, "A-stable"),
            _ => return None,
        })
    }
}

impl Oscillator {
    /// Smallest and largest E / E0 of semi-implicit Euler with the step `h_s`, for every number of steps.
    pub fn semi_implicit_band(&self, h_s: f64) -> [f64; 2] {
        let (w, z) = (self.omega(), self.omega() * h_s);
        let twice_e0 = self.v0 * self.v0 + w * w * self.x0 * self.x0;
        let q = twice_e0 - w * w * h_s * self.x0 * self.v0;
        [q / (1.0 + z / 2.0) / twice_e0, q / (1.0 - z / 2.0) / twice_e0]
    }

    /// Smallest and largest E / E0 of velocity Verlet: 2 E = Q + w^2 (z^2/4) x^2 with Q = v^2 + w^2 (1 - z^2/4) x^2
    /// conserved and x^2 between 0 and Q / (w^2 (1 - z^2/4)).
    pub fn verlet_band(&self, h_s: f64) -> [f64; 2] {
        let (w, z) = (self.omega(), self.omega() * h_s);
        let twice_e0 = self.v0 * self.v0 + w * w * self.x0 * self.x0;
        let squeeze = 1.0 - z * z / 4.0;
        let q = self.v0 * self.v0 + w * w * squeeze * self.x0 * self.x0;
        [q / twice_e0, q / squeeze / twice_e0]
    }
}
