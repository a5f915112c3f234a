//! A planet on an ellipse: r'' = -mu r / |r|^3 in the plane, with the pericentre on +x, counter-clockwise.
//!
//! M = M0 + n t, n = sqrt(mu / a^3), E - e sin E = M, r / a = 1 - e cos E = (1 - e) + 2 e sin^2(E/2):
//! x = a ((1 - e) - 2 sin^2(E/2)), y = a sqrt((1 - e)(1 + e)) sin E, v = a n (-sin E, sqrt((1 - e)(1 + e)) cos E) / (r / a).
//! Source: J. Kepler, Astronomia nova (1609), chapter 60; J. M. A. Danby, Fundamentals of Celestial Mechanics (1988), 6.3.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::Vector2;

use crate::invariants::{Balance, Entry};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Scene};
use crate::special::kepler::{eccentric_anomaly, slope};
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
    /// A circle.
    pub fn circular() -> Self {
        Kepler { eccentricity: 0.0, ..Self::default() }
    }

    /// Started at the pericentre, where v . a = 0 and the energy error of semi-implicit Euler has no mean.
    pub fn pericentre() -> Self {
        Kepler { anomaly: 0.0, ..Self::default() }
    }

    /// e = 0.9: the time scale at the pericentre is a thirtieth of the mean.
    pub fn eccentric() -> Self {
        Kepler { eccentricity: 0.90625, ..Self::default() }
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
        let (a, e, one) = (fx128::lit(self.semi_major), fx128::lit(self.eccentricity), fx128::ONE);
        let n = (fx128::lit(self.mu) / a).sqrt() / a;
        let at = eccentric_anomaly(fx128::lit(self.anomaly) + n * t.widen(), e);
        let half = (at.angle * fx128::lit(0.5)).sin_cos().0;
        let flattening = ((one - e) * (one + e)).sqrt();
        let distance = slope(at.angle, e);
        let position = Vector2::new(one - e - fx128::lit(2.0) * half * half, flattening * at.sine) * a;
        let velocity = Vector2::new(-at.sine, flattening * at.cosine) * (a * n / distance);
        rounded(position, velocity)
    }
    fn observe(&self, s: &State<Vector2<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for Kepler {
    fn info(&self) -> Info {
        let (a, e) = (self.semi_major, self.eccentricity);
        Info {
            about: "a planet on an ellipse: energy, angular momentum and the turning of the ellipse over many orbits",
            equation: r"\ddot{\mathbf r} = -\mu\,\frac{\mathbf r}{|\mathbf r|^3}",
            source: "Kepler's equation (J. M. A. Danby, Fundamentals of Celestial Mechanics (1988), 6.3)",
            horizon_s: 2.25,
            // The angle of the pericentre passage: (1 - e)^(3/2) of the mean motion's.
            time_scale_s: (a / self.mu).sqrt() * a * (1.0 - e).powf(1.5),
            coarsest_steps: if e > 0.8 { 32 } else { 16 },
        }
    }

    fn account(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position), seen.vector(Quantity::Velocity));
        let mass = fx128::lit(self.mass);
        let distance = (x[0] * x[0] + x[1] * x[1]).sqrt();
        let kinetic = (v[0] * v[0] + v[1] * v[1]) * fx128::lit(0.5);
        let spin = x[0] * v[1] - x[1] * v[0];
        vec![
            Entry {
                balance: Balance::Energy,
                value: vec![mass * (kinetic - fx128::lit(self.mu) / distance)],
                conserved: true,
            },
            Entry { balance: Balance::AngularMomentum, value: vec![mass * spin], conserved: true },
        ]
    }

    fn growth(&self, method: MethodId, balance: Balance, _h_s: f64) -> Option<ExpectedGrowth> {
        let symplectic =
            matches!(method, MethodId::SemiImplicitEuler | MethodId::VelocityVerlet | MethodId::ImplicitMidpoint);
        let (law, reason) = match balance {
            Balance::Energy => (Law::Bounded, "a symplectic method keeps a modified energy"),
            Balance::AngularMomentum => {
                (Law::AtTheFloor, "r x v is a quadratic invariant of a central force, kept exactly")
            }
            Balance::Momentum => return None,
        };
        symplectic.then_some(ExpectedGrowth { law, bounds: None, reason })
    }
}
