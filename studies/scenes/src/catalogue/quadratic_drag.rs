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

use crate::catalogue::answerable;
use crate::catalogue::linear::RK4_REAL;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene};
use crate::special::elementary::{atan, expm1, log1p, log1p_over, sinc, sinh, tanh, versine_over_square};
use crate::special::scaled::Scaled;
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

    /// How fast the velocity changes, 1/s: towards the terminal velocity, or from a greater one.
    fn rate(&self) -> f64 {
        self.terminal().1.to_f64().max(self.k().to_f64() * self.v0.abs())
    }

    /// Time of the apex, s; none for a body that falls from the start.
    pub fn apex_s(&self) -> Option<f64> {
        let (vt, r) = self.terminal();
        (self.v0 < 0.0).then(|| (atan(fx128::lit(-self.v0) / vt) / r).to_f64())
    }

    /// v0 / vt.
    fn ratio(&self, v0: Scaled) -> fx128 {
        let k = Scaled::of(self.drag).over(Scaled::of(self.mass));
        v0.times(k.over(Scaled::of(self.gravity)).sqrt()).value()
    }

    /// r t.
    fn phase(&self, t: Scaled) -> fx128 {
        let k = Scaled::of(self.drag).over(Scaled::of(self.mass));
        k.times(Scaled::of(self.gravity)).sqrt().times(t).value()
    }

    /// (v0 + g t p) / (1 + |v0| / vt q), where p = q / (r t).
    fn velocity(&self, v0: Scaled, t: Scaled, p: fx128, shrunk: fx128) -> Scaled {
        let gained = Scaled::of(self.gravity).times(t).times(Scaled::of_wide(p));
        Scaled::of_wide(Scaled::sum(&[v0, gained])).over(Scaled::of_wide(shrunk))
    }

    /// Distance and velocity after falling for the time t from the velocity v0 >= 0.
    fn fall(&self, v0: Scaled, t: Scaled) -> (Scaled, Scaled) {
        let (u, ratio, half) = (self.phase(t), self.ratio(v0), fx128::lit(0.5));
        let (th, over_u) = if u.0 < 1e-40 { (u, fx128::ONE) } else { (tanh(u), tanh(u) / u) };
        let velocity = self.velocity(v0, t, over_u, fx128::ONE + ratio * th);
        if u.0 >= 1.0 {
            // ln(cosh u + c sinh u) = u + ln(1 + (1 - c) (e^(-2u) - 1) / 2), over k = (u / t)^2 / g
            let logarithm = u + log1p((fx128::ONE - ratio) * expm1(-(u + u)) * half);
            let length = Scaled::of(self.mass).over(Scaled::of(self.drag));
            return (Scaled::of_wide(logarithm).times(length), velocity);
        }
        // With y = cosh u - 1 + c sinh u = k Y nothing is divided by k: ln(1 + y) / k = Y ln(1 + y) / y.
        let half_sinh = if u.0 < 1e-40 { fx128::ONE } else { sinh(u * half) / (u * half) };
        let whole_sinh = if u.0 < 1e-40 { fx128::ONE } else { sinh(u) / u };
        let [by_weight, by_speed] = [half_sinh * half_sinh * half, whole_sinh];
        let y = u * u * by_weight + ratio * u * by_speed;
        let weight = Scaled::of(self.gravity).times(t).times(t).times(Scaled::of_wide(by_weight));
        let sum = Scaled::sum(&[weight, v0.times(t).times(Scaled::of_wide(by_speed))]);
        (Scaled::of_wide(sum).times(Scaled::of_wide(log1p_over(y))), velocity)
    }

    /// Height and velocity (downwards) after rising for the time t, before the apex.
    fn rise_for(&self, v0: Scaled, t: Scaled) -> (Scaled, Scaled) {
        let (u, ratio) = (self.phase(t), -self.ratio(v0));
        let (sine, cosine) = u.sin_cos();
        let over_u = sinc(u) / cosine;
        let velocity = self.velocity(v0, t, over_u, fx128::ONE + ratio * (sine / cosine));
        let y = ratio * sine - u * u * versine_over_square(u);
        let weight = Scaled::of(-self.gravity).times(t).times(t).times(Scaled::of_wide(versine_over_square(u)));
        let sum = Scaled::sum(&[v0.times(t).times(Scaled::of_wide(-sinc(u))), weight]);
        (Scaled::of_wide(sum).times(Scaled::of_wide(log1p_over(y))), velocity)
    }

    fn motion(&self, t: fx128) -> (fx128, fx128) {
        let (x0, v0, time) = (Scaled::of(self.x0), Scaled::of(self.v0), Scaled::of_wide(t));
        let down = |parts: &[Scaled], v: Scaled| (Scaled::sum(parts), v.value());
        if self.v0 >= 0.0 {
            let (distance, v) = self.fall(v0, time);
            return down(&[x0, distance], v);
        }
        let minus = |s: Scaled| s.times(Scaled::of(-1.0));
        let ratio = -self.ratio(v0);
        let slowed = if ratio.0 == 0.0 { fx128::ONE } else { atan(ratio) / ratio };
        let thrown = minus(v0).over(Scaled::of(self.gravity));
        let apex = thrown.times(Scaled::of_wide(slowed)).value();
        if t < apex {
            let (height, v) = self.rise_for(v0, time);
            return down(&[x0, minus(height)], v);
        }
        // v0^2 / (2 g) less what the drag takes.
        let height = minus(v0).times(thrown).shifted(-1).times(Scaled::of_wide(log1p_over(ratio * ratio)));
        let (distance, v) = self.fall(Scaled::of(0.0), Scaled::of_wide(t - apex));
        down(&[x0, minus(height), distance], v)
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
        let pace = Pace { horizon_s: 2.75, coarsest_steps: 8 }.at(self.rate() / 0.78);
        Info {
            kind: Kind::Damping,
            about: "a fall with drag -c v |v|: smooth while it falls, with a kink of the force at the apex of a throw",
            equation: r"m\,\dot v = m\,g - c\,v\,|v|",
            source: "E. J. Routh, Dynamics of a Particle (1898), article 117",
            horizon_s: pace.horizon_s,
            time_scale_s: 1.0 / self.terminal().1.to_f64(),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let end_s = self.info().horizon_s;
        let seen = Motion::<f64>::observe(self, &self.exact(end_s));
        answerable::range("quadratic-drag", self, &seen, end_s)
    }

    fn nonsmooth_times_s(&self, end_s: f64) -> Vec<f64> {
        self.apex_s().into_iter().filter(|&apex| apex <= end_s).collect()
    }

    fn is_periodic(&self) -> bool {
        false
    }

    fn rounding_accumulates(&self) -> bool {
        false
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position)[0], seen.vector(Quantity::Velocity)[0]);
        let mass = fx128::lit(self.mass);
        let energy = mass * (v * v * fx128::lit(0.5) - fx128::lit(self.gravity) * x);
        vec![
            Entry { invariant: Invariant::Energy, value: vec![energy], conserved: false },
            Entry { invariant: Invariant::Momentum, value: vec![mass * v], conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        let since = self.apex_s().map(|apex| end_s - apex).filter(|since| *since > 0.0);
        match (method, since) {
            (MethodId::Rk4, Some(since)) => {
                let [x, v] = self.kink_constants(since);
                Theory {
                    order: ExpectedOrder::Envelope(3.0),
                    doubt: 0.0,
                    below_h_s: since / 32.0,
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
            _ => return None,
        })
    }
}
