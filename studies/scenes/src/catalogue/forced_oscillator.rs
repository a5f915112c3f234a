//! A driven mass on a spring with a damper: m x'' = -k x - c x' + F cos(W t), the non-autonomous scene.
//!
//! The free motion of [`super::DampedOscillator`] plus F / m times the response from rest, the divided difference of e^(l t)
//! over the two roots and i W: one formula at, near and away from resonance. See `oscillation.rs`.

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
    /// A driven and damped mass on a spring.
    pub struct ForcedOscillator {
        /// Mass.
        mass: f64 = 1.5, "kg", Positive;
        /// Stiffness of the spring.
        stiffness: f64 = 6.0, "N/m", Positive;
        /// Damping coefficient c.
        damping: f64 = 0.375, "kg/s", NonNegative;
        /// Amplitude of the driving force.
        force: f64 = 2.25, "N", Finite;
        /// Angular frequency of the driving force.
        drive: f64 = 3.25, "rad/s", NonNegative;
        /// Displacement at the start.
        x0: f64 = 0.75, "m", Finite;
        /// Velocity at the start.
        v0: f64 = -1.25, "m/s", Finite;
    }
}

impl ForcedOscillator {
    /// Undamped and driven at its own frequency: the amplitude grows as t.
    pub fn resonance() -> Self {
        ForcedOscillator { damping: 0.0, drive: 2.0, ..Self::default() }
    }

    /// Undamped and driven 2^-20 beside its own frequency, where the textbook formula loses six digits.
    pub fn near_resonance() -> Self {
        ForcedOscillator { damping: 0.0, drive: 2.0 + 2.0_f64.powi(-20), ..Self::default() }
    }

    fn oscillation(&self) -> Oscillation {
        let per_mass = |x: f64| Scaled::of(x).over(Scaled::of(self.mass));
        let (decay, square) = (per_mass(self.damping).shifted(-1), per_mass(self.stiffness));
        let ratio = decay.over(square.sqrt()).value();
        Oscillation {
            decay,
            square,
            beat: (fx128::ONE - ratio) * (fx128::ONE + ratio),
            force: per_mass(self.force),
            drive: self.drive,
            x0: self.x0,
            v0: self.v0,
        }
    }
}

impl<T: Real> Model<T> for ForcedOscillator {
    type Config = Vector1<T>;

    #[inline(always)]
    fn rate(&self, t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        let (_, cosine) = (T::lit(self.drive) * t).sin_cos();
        let force = T::lit(self.force) * cosine;
        (Vector1::new(force) - s.q * T::lit(self.stiffness) - s.v * T::lit(self.damping)) / T::lit(self.mass)
    }
}

impl<T: Single> Motion<T> for ForcedOscillator {
    fn exact(&self, t: T) -> State<Vector1<T>> {
        self.oscillation().at(t)
    }
    fn observe(&self, s: &State<Vector1<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for ForcedOscillator {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.75, coarsest_steps: 8 }.at(self.oscillation().fastest() / 3.25);
        Info {
            kind: Kind::Oscillation,
            about: "a driven oscillator: the force depends on time, so that the stage times of a method count",
            equation: r"m\,\ddot x = -k\,x - c\,\dot x + F\cos\Omega t",
            source: "elementary; the response as a divided difference of exponentials",
            horizon_s: pace.horizon_s,
            time_scale_s: (self.mass / self.stiffness).sqrt().min(1.0 / self.drive.max(f64::MIN_POSITIVE)),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let end_s = self.info().horizon_s;
        answerable::phase("forced-oscillator", ("drive", &self.drive), self.drive * end_s, end_s)?;
        let phase = self.oscillation().largest_phase(end_s);
        answerable::phase("forced-oscillator", ("stiffness", &self.stiffness), phase, end_s)?;
        let seen = Motion::<f64>::observe(self, &self.exact(end_s));
        answerable::range("forced-oscillator", self, &seen, end_s)
    }

    fn period_s(&self) -> Option<f64> {
        period(self.drive)
    }

    fn substitutes(&self) -> Vec<Substitute> {
        let factor = 2.0 * self.stiffness.sqrt() * self.mass.sqrt();
        let ratio = "Damping ratio: c = 2 zeta sqrt(k m).";
        vec![
            Substitute { name: "zeta", of: "damping", unit: "1", about: ratio, factor },
            Substitute { name: "c", of: "damping", unit: "kg/s", about: "Damping coefficient.", factor: 1.0 },
        ]
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position)[0], seen.vector(Quantity::Velocity)[0]);
        let twice = fx128::lit(self.mass) * v * v + fx128::lit(self.stiffness) * x * x;
        let conserved = self.damping == 0.0 && self.force == 0.0;
        vec![Entry { invariant: Invariant::Energy, value: vec![twice * fx128::lit(0.5)], conserved }]
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        self.oscillation().linear().theory(method, quantity, end_s)
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        // At resonance the motion itself grows; the limit is that of the free part, as for every linear equation.
        self.oscillation().stability_limit(method)
    }
}
