//! A planet on an ellipse: r'' = -mu r / |r|^3 in the plane, with the pericentre on +x, counter-clockwise.
//!
//! M = M0 + n t, n = sqrt(mu / a^3), E - e sin E = M, r / a = 1 - e cos E = (1 - e) + 2 e sin^2(E/2):
//! x = a ((1 - e) - 2 sin^2(E/2)), y = a sqrt((1 - e)(1 + e)) sin E, v = a n (-sin E, sqrt((1 - e)(1 + e)) cos E) / (r / a).
//! Source: J. Kepler, Astronomia nova (1609), chapter 60; J. M. A. Danby, Fundamentals of Celestial Mechanics (1988), 6.3.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::Vector2;

use crate::catalogue::answerable;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene, period};
use crate::special::elementary::nearest_turn;
use crate::special::kepler::{eccentric_anomaly, slope};
use crate::special::scaled::Scaled;
use crate::theory::ExpectedGrowth;
use crate::theory::Law;

scene_parameters! {
    /// A planet; the default starts away from an apsis.
    pub struct Kepler {
        /// Mass of the planet.
        mass: f64 = 0.75, "kg", Positive;
        /// Gravitational parameter of the sun.
        mu: f64 = 2.0, "m^3/s^2", Positive;
        /// Semi-major axis.
        semi_major: f64 = 1.25, "m", Positive;
        /// Eccentricity.
        eccentricity: f64 = 0.4375, "1", HalfOpen(0.0, 1.0);
        /// Mean anomaly at the start.
        anomaly: f64 = 0.875, "rad", Finite;
    }
}

impl Kepler {
    /// n = sqrt(mu / a^3), rad/s.
    fn mean_motion(&self) -> Scaled {
        let a = Scaled::of(self.semi_major);
        Scaled::of(self.mu).over(a).sqrt().over(a)
    }

    /// A circle.
    pub fn circular() -> Self {
        Kepler { eccentricity: 0.0, ..Self::default() }
    }

    /// Started at the pericentre, where v . a = 0 and the energy error of semi-implicit Euler has no mean.
    pub fn pericentre() -> Self {
        Kepler { anomaly: 0.0, ..Self::default() }
    }

    /// Numbers that no binary arithmetic has: parameters that are rounded to another one show.
    pub fn decimal() -> Self {
        Kepler { mass: 0.7, mu: 2.1, semi_major: 1.3, eccentricity: 0.41, anomaly: 0.9 }
    }

    /// e = 0.9: the time scale at the pericentre is a thirtieth of the mean.
    pub fn eccentric() -> Self {
        Kepler { eccentricity: 0.90625, ..Self::default() }
    }
}

/// End of an error run at the pace of the default, s.
const HORIZON_S: f64 = 2.25;

impl Kepler {
    /// The largest sqrt(mu / r^3) up to [`HORIZON_S`], 1/s: at the pericentre where the planet passes it, else at the nearer
    /// of start and end.
    fn fastest(&self) -> f64 {
        let mean = self.mean_motion().value().to_f64();
        let (turn, passed) = (std::f64::consts::TAU, mean * HORIZON_S);
        let start = self.anomaly.rem_euclid(turn);
        let nearest = if start + passed >= turn { 0.0 } else { start.min(turn - start - passed) };
        let distance = slope(
            eccentric_anomaly(fx128::lit(nearest), fx128::lit(self.eccentricity)).angle,
            fx128::lit(self.eccentricity),
        );
        mean / distance.to_f64().powf(1.5)
    }
}

impl<T: Real> Model<T> for Kepler {
    type Config = Vector2<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector2<T>>) -> Vector2<T> {
        let square = s.q.x * s.q.x + s.q.y * s.q.y;
        s.q * (-T::lit(self.mu) / (square * square.sqrt()))
    }
}

impl<T: Single> Motion<T> for Kepler {
    fn exact(&self, t: T) -> State<Vector2<T>> {
        let (e, one) = (fx128::lit(self.eccentricity), fx128::ONE);
        let phase = self.mean_motion().times(Scaled::of_wide(t.widen())).value();
        let at = eccentric_anomaly(nearest_turn(fx128::lit(self.anomaly)) + phase, e);
        let half = (at.angle * fx128::lit(0.5)).sin_cos().0;
        let flattening = ((one - e) * (one + e)).sqrt();
        let distance = slope(at.angle, e);
        let position = Vector2::new(one - e - fx128::lit(2.0) * half * half, flattening * at.sine);
        let velocity = Vector2::new(-at.sine, flattening * at.cosine) / distance;
        let length = Scaled::of(self.semi_major);
        let times = |unit: Scaled| move |c: fx128| unit.times(Scaled::of_wide(c)).value();
        rounded(position.map(times(length)), velocity.map(times(length.times(self.mean_motion()))))
    }
    fn observe(&self, s: &State<Vector2<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for Kepler {
    fn info(&self) -> Info {
        let (a, e) = (self.semi_major, self.eccentricity);
        let coarsest_steps = if e > 0.8 { 32 } else { 16 };
        let pace = Pace { horizon_s: HORIZON_S, coarsest_steps }.at(self.fastest() / 1.75);
        Info {
            kind: Kind::Orbit,
            about: "a planet on an ellipse: energy, angular momentum and the turning of the ellipse over many orbits",
            equation: r"\ddot{\mathbf r} = -\mu\,\frac{\mathbf r}{|\mathbf r|^3}",
            source: "Kepler's equation (J. M. A. Danby, Fundamentals of Celestial Mechanics (1988), 6.3)",
            horizon_s: pace.horizon_s,
            // The angle of the pericentre passage: (1 - e)^(3/2) of the mean motion's.
            time_scale_s: (a / self.mu).sqrt() * a * (1.0 - e).powf(1.5),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let end_s = self.info().horizon_s;
        let phase = self.mean_motion().times(Scaled::of(end_s)).value().to_f64();
        answerable::phase("kepler", ("mu", &self.mu), phase, end_s)?;
        let seen = Motion::<f64>::observe(self, &self.exact(end_s));
        answerable::range("kepler", self, &seen, end_s)
    }

    /// A parameter that is rounded to f32 is wrong from the start, and no step makes that smaller.
    fn rounding_accumulates(&self) -> bool {
        [self.mu, self.semi_major, self.eccentricity, self.anomaly].iter().all(|&x| f64::from(x as f32) == x)
    }

    fn period_s(&self) -> Option<f64> {
        period(self.mean_motion().value().to_f64())
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position), seen.vector(Quantity::Velocity));
        let mass = fx128::lit(self.mass);
        let distance = (x[0] * x[0] + x[1] * x[1]).sqrt();
        let kinetic = (v[0] * v[0] + v[1] * v[1]) * fx128::lit(0.5);
        let spin = x[0] * v[1] - x[1] * v[0];
        vec![
            Entry {
                invariant: Invariant::Energy,
                value: vec![mass * (kinetic - fx128::lit(self.mu) / distance)],
                conserved: true,
            },
            Entry { invariant: Invariant::AngularMomentum, value: vec![mass * spin], conserved: true },
        ]
    }

    fn growth(&self, method: MethodId, invariant: Invariant, _h_s: f64) -> Option<ExpectedGrowth> {
        let symplectic =
            matches!(method, MethodId::SemiImplicitEuler | MethodId::VelocityVerlet | MethodId::ImplicitMidpoint);
        let (law, reason) = match invariant {
            Invariant::Energy => (Law::Bounded, "a symplectic method keeps a modified energy"),
            Invariant::AngularMomentum => {
                (Law::AtTheFloor, "r x v is a quadratic invariant of a central force, kept exactly")
            }
            Invariant::Momentum => return None,
        };
        // The energy error swings with the distance: a few revolutions show that it stays.
        let seen_after_s = 8.0 * std::f64::consts::TAU / self.mean_motion().value().to_f64();
        symplectic.then_some(ExpectedGrowth { law, seen_after_s, bounds: None, reason })
    }
}
