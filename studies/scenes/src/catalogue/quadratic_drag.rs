//! A fall with drag proportional to the square of the velocity: m v' = m g - c v |v|, down positive.
//!
//! With k = c / m, vt = sqrt(g / k), r = sqrt(g k). Falling: v = (v0 + vt th) / (1 + v0 th / vt), th = tanh(r t), and
//! x = x0 + ln(cosh r t + (v0 / vt) sinh r t) / k. Rising: v = (v0 + vt tn) / (1 - v0 tn / vt), tn = tan(r t), and
//! x = x0 - ln(cos r t - (v0 / vt) sin r t) / k, until the apex at t* = atan(-v0 / vt) / r; then a fall from rest.
//! Source: E. J. Routh, A Treatise on Dynamics of a Particle (1898), article 117.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::Vector1;

use crate::catalogue::linear::RK4_REAL;
use crate::invariants::{Balance, Entry};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Scene};
use crate::special::elementary::{atan, expm1, log1p, tanh};
use crate::theory::{ExpectedOrder, StabilityLimit, Theory};

scene_parameters! {
    /// A body in a fluid; the default falls.
    pub struct QuadraticDrag {
        /// Mass.
        mass: f64 = 1.25, "kg", Positive;
        /// Drag coefficient c.
        drag: f64 = 0.078125, "kg/m", Positive;
        /// Gravity, downwards.
        gravity: f64 = 9.8125, "m/s^2", Positive;
        /// Position at the start, downwards.
        x0: f64 = -2.5, "m", Finite;
        /// Velocity at the start, downwards.
        v0: f64 = 3.25, "m/s", Finite;
    }
}

impl QuadraticDrag {
    /// Thrown upwards: the force has a kink at the apex.
    pub fn rise() -> Self {
        QuadraticDrag { v0: -14.5, ..Self::default() }
    }

    fn k(&self) -> fx128 {
        fx128::lit(self.drag) / fx128::lit(self.mass)
    }

    /// (vt, r): terminal velocity in m/s and rate in 1/s.
    fn terminal(&self) -> (fx128, fx128) {
        let g = fx128::lit(self.gravity);
        ((g / self.k()).sqrt(), (g * self.k()).sqrt())
    }

    /// Time of the apex, s; none for a body that falls from the start.
    pub fn apex_s(&self) -> Option<f64> {
        let (vt, r) = self.terminal();
        (self.v0 < 0.0).then(|| (atan(fx128::lit(-self.v0) / vt) / r).to_f64())
    }

    /// Distance and velocity after falling for the time t from the velocity v0 >= 0.
    fn fall(&self, v0: fx128, t: fx128) -> (fx128, fx128) {
        let (vt, r) = self.terminal();
        let (th, ratio) = (tanh(r * t), v0 / vt);
        let half = fx128::lit(0.5);
        // ln(cosh u + c sinh u) = u + ln(1 + (1 - c) (e^(-2u) - 1) / 2)
        let u = r * t;
        let logarithm = u + log1p((fx128::ONE - ratio) * expm1(-(u + u)) * half);
        (logarithm / self.k(), (v0 + vt * th) / (fx128::ONE + ratio * th))
    }

    fn motion(&self, t: fx128) -> (fx128, fx128) {
        let (vt, r) = self.terminal();
        let (x0, v0) = (fx128::lit(self.x0), fx128::lit(self.v0));
        if self.v0 >= 0.0 {
            let (distance, v) = self.fall(v0, t);
            return (x0 + distance, v);
        }
        let ratio = v0 / vt;
        let apex = atan(-ratio) / r;
        if t < apex {
            let (sine, cosine) = (r * t).sin_cos();
            let (tn, shrunk) = (sine / cosine, cosine - ratio * sine);
            return (x0 - shrunk.ln() / self.k(), (v0 + vt * tn) / (fx128::ONE - ratio * tn));
        }
        let height = log1p(ratio * ratio) / (self.k() + self.k());
        let (distance, v) = self.fall(fx128::ZERO, t - apex);
        (x0 - height + distance, v)
    }

    /// C of |error| <= C h^3 of RK4 at the time T after a kink at t*: the step across it sums k g^2 tau |tau| by
    /// Simpson's rule, which is wrong by k g^2 h^3 (u/6)(1 - 2u)^2 with the kink at (1/2 + u) h, at most h^3 / 81.
    /// A velocity error there shrinks by sech^2(r (T - t*)) and moves the position by tanh(r (T - t*)) / r.
    fn kink_constants(&self, since_apex_s: f64) -> [f64; 2] {
        let r = self.terminal().1.to_f64();
        let jump = self.k().to_f64() * self.gravity * self.gravity / 81.0;
        let th = (r * since_apex_s).tanh();
        [jump * th / r, jump * (1.0 - th * th)]
    }
}

impl<T: Real> Model<T> for QuadraticDrag {
    type Config = Vector1<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        let v = s.v.x;
        Vector1::new(T::lit(self.gravity) - v * v.abs() * (T::lit(self.drag) / T::lit(self.mass)))
    }
}

impl<T: Single> Motion<T> for QuadraticDrag {
    fn exact(&self, t: T) -> State<Vector1<T>> {
        let (x, v) = self.motion(t.widen());
        rounded(Vector1::new(x), Vector1::new(v))
    }
    fn observe(&self, s: &State<Vector1<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for QuadraticDrag {
    fn info(&self) -> Info {
        Info {
            about: "a fall with drag -c v |v|: smooth while it falls, with a kink of the force at the apex of a throw",
            equation: r"m\,\dot v = m\,g - c\,v\,|v|",
            source: "E. J. Routh, Dynamics of a Particle (1898), article 117",
            horizon_s: 2.75,
            time_scale_s: 1.0 / self.terminal().1.to_f64(),
            coarsest_steps: 8,
        }
    }

    fn breaks_s(&self) -> Vec<f64> {
        self.apex_s().into_iter().collect()
    }

    fn account(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position)[0], seen.vector(Quantity::Velocity)[0]);
        let mass = fx128::lit(self.mass);
        let energy = mass * (v * v * fx128::lit(0.5) - fx128::lit(self.gravity) * x);
        vec![
            Entry { balance: Balance::Energy, value: vec![energy], conserved: false },
            Entry { balance: Balance::Momentum, value: vec![mass * v], conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity) -> Theory {
        let since = self.apex_s().map(|apex| self.info().horizon_s - apex).filter(|since| *since > 0.0);
        match (method, since) {
            (MethodId::Rk4, Some(since)) => {
                let [x, v] = self.kink_constants(since);
                Theory {
                    order: ExpectedOrder::Envelope(3.0),
                    constant: Some(if quantity == Quantity::Position { x } else { v }),
                    reason: "v |v| has a kink at the apex: order 3, with a factor that depends on where in its step the apex \
                             falls; no arithmetic helps, and local orders scatter",
                }
            }
            _ => Theory::usual(method),
        }
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        // At the terminal velocity dv'/dv = -2 k vt = -2 r.
        let below = |z: f64| StabilityLimit::Below(z / (2.0 * self.terminal().1.to_f64()));
        Some(match method {
            MethodId::ExplicitEuler | MethodId::SemiImplicitEuler => {
                (below(2.0), "h < 1 / sqrt(g k): |1 - 2 r h| <= 1 at the terminal velocity")
            }
            MethodId::VelocityVerlet => (below(2.0), "|1 - z + z^2/2| <= 1, z = 2 r h, at the terminal velocity"),
            MethodId::Rk4 => (below(RK4_REAL), "|R(-2 r h)| <= 1 at the terminal velocity"),
            MethodId::ImplicitEuler | MethodId::ImplicitMidpoint => {
                (StabilityLimit::Unlimited, "A-stable, at the terminal velocity")
            }
        })
    }
}
