//! A mass on a spring with a damper: m x'' = -k x - c x'.
//!
//! With g = c / (2 m), w^2 = k / m and the motions C, S of `oscillation.rs`: x = e^(-g t) (x0 C + (v0 + g x0) S),
//! v = e^(-g t) (v0 C - (g v0 + w^2 x0) S), one formula below, at and above critical damping.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::Vector1;

use crate::catalogue::answerable;
use crate::catalogue::oscillation::Oscillation;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::Motion;
use crate::observation::{Observation, Quantity};
use crate::parameters::{Substitute, scene_parameters};
use crate::scene::{Info, Kind, Pace, Scene, period};
use crate::special::scaled::Scaled;
use crate::theory::{StabilityLimit, Theory};

scene_parameters! {
    /// A mass on a spring with a damper; the default is under-damped, zeta = 1/8.
    pub struct DampedOscillator {
        /// Mass.
        mass: f64 = 1.5, "kg", Positive;
        /// Stiffness of the spring.
        stiffness: f64 = 6.0, "N/m", Positive;
        /// Damping ratio c / (2 sqrt(k m)).
        zeta: f64 = 0.125, "1", NonNegative;
        /// Displacement at the start.
        x0: f64 = 0.75, "m", Finite;
        /// Velocity at the start.
        v0: f64 = -1.25, "m/s", Finite;
    }
}

impl DampedOscillator {
    /// zeta = 1, exactly.
    pub fn critical() -> Self {
        DampedOscillator { zeta: 1.0, ..Self::default() }
    }

    /// zeta = 5/2.
    pub fn over_damped() -> Self {
        DampedOscillator { zeta: 2.5, ..Self::default() }
    }

    /// c = 2 zeta sqrt(k m), kg/s.
    fn damping<T: Real>(&self) -> T {
        T::lit(2.0 * self.zeta) * (T::lit(self.stiffness) * T::lit(self.mass)).sqrt()
    }

    fn oscillation(&self) -> Oscillation {
        let (zeta, one) = (fx128::lit(self.zeta), fx128::ONE);
        let square = Scaled::of(self.stiffness).over(Scaled::of(self.mass));
        Oscillation {
            decay: square.sqrt().times(Scaled::of(self.zeta)),
            square,
            beat: (one - zeta) * (one + zeta),
            force: Scaled::of(0.0),
            drive: 0.0,
            x0: self.x0,
            v0: self.v0,
        }
    }
}

impl<T: Real> Model<T> for DampedOscillator {
    type Config = Vector1<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        (s.q * T::lit(self.stiffness) + s.v * self.damping::<T>()) / -T::lit(self.mass)
    }
}

impl<T: Single> Motion<T> for DampedOscillator {
    fn exact(&self, t: T) -> State<Vector1<T>> {
        self.oscillation().at(t)
    }
    fn observe(&self, s: &State<Vector1<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for DampedOscillator {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.75, coarsest_steps: 8 }.at(self.oscillation().fastest() / 2.0);
        Info {
            kind: Kind::Damping,
            about: "a damped mass on a spring: under-damped, critical (a double root) or over-damped (two rates)",
            equation: r"m\,\ddot x = -k\,x - c\,\dot x,\quad c = 2\zeta\sqrt{k\,m}",
            source: "elementary",
            horizon_s: pace.horizon_s,
            time_scale_s: (self.mass / self.stiffness).sqrt(),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let end_s = self.info().horizon_s;
        let phase = self.oscillation().largest_phase(end_s);
        answerable::phase("damped-oscillator", ("stiffness", &self.stiffness), phase, end_s)?;
        let seen = Motion::<f64>::observe(self, &self.exact(end_s));
        answerable::range("damped-oscillator", self, &seen, end_s)
    }

    fn is_periodic(&self) -> bool {
        self.zeta < 1.0
    }

    fn rounding_accumulates(&self) -> bool {
        self.zeta == 0.0
    }

    fn period_s(&self) -> Option<f64> {
        (self.zeta < 1.0)
            .then(|| period((self.stiffness / self.mass * (1.0 - self.zeta) * (1.0 + self.zeta)).sqrt()))?
    }

    fn substitutes(&self) -> Vec<Substitute> {
        let factor = 0.5 / (self.stiffness.sqrt() * self.mass.sqrt());
        let about = "Damping coefficient: zeta = c / (2 sqrt(k m)).";
        ["c", "damping"].map(|name| Substitute { name, of: "zeta", unit: "kg/s", about, factor }).to_vec()
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position)[0], seen.vector(Quantity::Velocity)[0]);
        let twice = fx128::lit(self.mass) * v * v + fx128::lit(self.stiffness) * x * x;
        vec![Entry { invariant: Invariant::Energy, value: vec![twice * fx128::lit(0.5)], conserved: self.zeta == 0.0 }]
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        self.oscillation().linear().theory(method, quantity, end_s)
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        self.oscillation().stability_limit(method)
    }
}
