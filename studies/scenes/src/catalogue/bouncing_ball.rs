//! A ball that falls on a floor and bounces: h'' = -g, and at h < 0 the velocity turns from v to -e v.
//!
//! The driver sees a bounce only at the end of a step, as a game engine does: a ball below the floor that moves down has its
//! velocity reversed, its position is left where it is. Which of gravity and reflection comes first follows from the method:
//! explicit Euler drifts, kicks and reflects, semi-implicit Euler kicks, drifts and reflects. For e = 1 the reflection
//! itself changes no energy, so that E_n - E_0 = +n m g^2 h^2 / 2 (explicit Euler), -n m g^2 h^2 / 2 (semi-implicit and implicit Euler) and
//! 0 (the others, which are exact on a parabola), exactly. A bounce that is seen s late (0 <= s <= h) delays the ball
//! by 2 s; the order is 1 for every method.
//!
//! Exact: bounce n at t_n with the speed e^n V upwards after it, t_1 = (v0 + V) / g, V^2 = v0^2 + 2 g x0,
//! t_(n+1) - t_n = 2 e^n V / g; for e < 1 all bounces end at t_1 + 2 e V / (g (1 - e)), and the ball rests.
//! Source: E. Falcon et al., Eur. Phys. J. B 3 (1998) 45, section 2.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Model, Real, Single, State};
use nalgebra::Vector1;

use crate::error::Error;
use crate::invariants::{Balance, Entry};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Scene};
use crate::theory::Law;
use crate::theory::{ExpectedGrowth, ExpectedOrder, Theory};

scene_parameters! {
    /// A ball over a floor; the default loses nothing.
    pub struct BouncingBall {
        /// Mass.
        mass: f64 = 0.75, "kg", Positive;
        /// Gravity.
        gravity: f64 = 9.8125, "m/s^2", Positive;
        /// Part of the speed that a bounce leaves.
        restitution: f64 = 1.0, "1", Closed(0.0625, 1.0);
        /// Height at the start.
        x0: f64 = 1.375, "m", Positive;
        /// Upward velocity at the start.
        v0: f64 = 1.25, "m/s", Finite;
    }
}

/// The arc that the ball is on: the bounce before it, the time of that bounce, and the upward speed after it.
struct Arc {
    bounces: u32,
    from: fx128,
    speed: fx128,
}

impl BouncingBall {
    /// A bounce leaves three quarters of the speed.
    pub fn inelastic() -> Self {
        BouncingBall { restitution: 0.75, ..Self::default() }
    }

    fn impact_speed(&self) -> fx128 {
        let v0 = fx128::lit(self.v0);
        (v0 * v0 + fx128::lit(2.0) * fx128::lit(self.gravity) * fx128::lit(self.x0)).sqrt()
    }

    fn first_bounce(&self) -> fx128 {
        (fx128::lit(self.v0) + self.impact_speed()) / fx128::lit(self.gravity)
    }

    /// When the ball has come to rest, s: infinite for e = 1.
    pub fn rest_s(&self) -> f64 {
        let (v, e) = (self.impact_speed().to_f64(), self.restitution);
        self.first_bounce().to_f64() + 2.0 * e * v / (self.gravity * (1.0 - e))
    }

    /// The arc at the time t, after the first bounce; none once the ball rests.
    fn arc(&self, t: fx128) -> Option<Arc> {
        let (g, e) = (fx128::lit(self.gravity), fx128::lit(self.restitution));
        let (mut from, mut speed) = (self.first_bounce(), self.impact_speed() * e);
        let mut bounces = 1;
        if self.restitution == 1.0 {
            let flight = (speed + speed) / g;
            let late = (t - from) / flight;
            let whole = (late - fx128::lit(0.5)).round();
            return Some(Arc { bounces: 1 + whole.0 as u32, from: from + whole * flight, speed });
        }
        if t.to_f64() >= self.rest_s() {
            return None;
        }
        while t > from + (speed + speed) / g && speed.0 > 0.0 {
            from += (speed + speed) / g;
            speed *= e;
            bounces += 1;
        }
        Some(Arc { bounces, from, speed })
    }

    fn motion(&self, t: fx128) -> (fx128, fx128) {
        let (g, half) = (fx128::lit(self.gravity), fx128::lit(0.5));
        if t < self.first_bounce() {
            let v0 = fx128::lit(self.v0);
            return (fx128::lit(self.x0) + t * (v0 - g * t * half), v0 - g * t);
        }
        let Some(arc) = self.arc(t) else { return (fx128::ZERO, fx128::ZERO) };
        let since = t - arc.from;
        (since * (arc.speed - g * since * half), arc.speed - g * since)
    }

    /// error / h of position and velocity at the horizon, to leading order, for bounces seen `late`[j] h after they happen.
    ///
    /// In flight the positions of explicit (`lag` = 1) and semi-implicit or implicit Euler (-1) lie on the parabola of the
    /// velocity u = v + lag g h / 2; the others have lag 0. `delay` and `extra` are the lateness of the ball and the excess of
    /// its speed u, in h and g h.
    fn first_order(&self, lag: f64, late: &[f64]) -> [f64; 2] {
        let (g, e, v0) = (self.gravity, self.restitution, self.v0);
        let impact = self.impact_speed().to_f64();
        let end_s = self.info().horizon_s;
        // u0 = v0 + lag g h / 2: V^2 = u0^2 + 2 g x0, t_1 = (u0 + V) / g.
        let mut extra = 0.5 * lag * v0 / impact;
        let mut delay = 0.5 * lag + extra;
        for (j, s) in late.iter().enumerate() {
            if j > 0 {
                delay += 2.0 * extra;
            }
            // Reflected s h late, at the depth s h V: up through the floor s h / e later, slower by g s h / e, faster by e g s h.
            delay += s * (1.0 + 1.0 / e);
            extra = e * extra + 0.5 * (1.0 + e) * lag + s * (e - 1.0 / e);
        }
        let at = self.arc(fx128::lit(end_s)).map_or((0.0, 0.0), |arc| (arc.from.to_f64(), arc.speed.to_f64()));
        let since = end_s - at.0;
        let v = at.1 - g * since;
        [-v * delay + g * extra * since, g * (delay + extra - 0.5 * lag)]
    }

    /// The largest |error| / h over all phases of the bounces in their steps.
    fn envelope(&self, lag: f64) -> [f64; 2] {
        let bounces = self.breaks_s().len();
        let none = self.first_order(lag, &vec![0.0; bounces]);
        let (mut low, mut high) = (none, none);
        for j in 0..bounces {
            let mut late = vec![0.0; bounces];
            late[j] = 1.0;
            let with = self.first_order(lag, &late);
            for c in 0..2 {
                low[c] += (with[c] - none[c]).min(0.0);
                high[c] += (with[c] - none[c]).max(0.0);
            }
        }
        [0, 1].map(|c| low[c].abs().max(high[c].abs()))
    }
}

impl<T: Single> Model<T> for BouncingBall {
    type Config = Vector1<T>;

    #[inline(always)]
    fn rate(&self, _t: T, _s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(-T::lit(self.gravity))
    }

    #[inline(always)]
    fn contact(&self, _before: &State<Vector1<T>>, after: State<Vector1<T>>) -> State<Vector1<T>> {
        let zero = T::lit(0.0);
        if after.q.x < zero && after.v.x < zero {
            State { q: after.q, v: after.v * -T::lit(self.restitution) }
        } else {
            after
        }
    }
}

impl<T: Single> Motion<T> for BouncingBall {
    fn exact(&self, t: T) -> State<Vector1<T>> {
        let (x, v) = self.motion(t.widen());
        rounded(Vector1::new(x), Vector1::new(v))
    }
    fn observe(&self, s: &State<Vector1<T>>) -> Observation {
        Observation::particles(s)
    }
}

/// -1, 0 or 1: see [`BouncingBall::first_order`].
fn lag(method: MethodId) -> f64 {
    match method {
        MethodId::ExplicitEuler => 1.0,
        MethodId::SemiImplicitEuler | MethodId::ImplicitEuler => -1.0,
        _ => 0.0,
    }
}

impl Scene for BouncingBall {
    fn info(&self) -> Info {
        Info {
            about: "a ball whose bounces are seen at the end of a step: no method is better than first order",
            equation: r"\ddot x = -g;\quad x < 0,\ v < 0:\ v\to -e\,v",
            source: "parabolas and a geometric series (E. Falcon et al., Eur. Phys. J. B 3 (1998) 45)",
            horizon_s: 2.25,
            time_scale_s: self.impact_speed().to_f64() / self.gravity,
            coarsest_steps: 16,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let (rest, end) = (self.rest_s(), self.info().horizon_s);
        if rest > end {
            return Ok(());
        }
        Err(Error::Parameter {
            scene: "bouncing-ball".to_owned(),
            parameter: "restitution".to_owned(),
            value: self.restitution.to_string(),
            expected: format!(
                "the ball rests at {rest:.3} s, before the end of the run at {end} s: drop it from higher"
            ),
        })
    }

    fn breaks_s(&self) -> Vec<f64> {
        let end = fx128::lit(self.info().horizon_s);
        if end < self.first_bounce() {
            return Vec::new();
        }
        let count = self.arc(end).map_or(0, |arc| arc.bounces);
        let (g, e) = (self.gravity, self.restitution);
        let flight = |n: i32| 2.0 * e.powi(n) * self.impact_speed().to_f64() / g;
        (0..count as i32).map(|n| self.first_bounce().to_f64() + (1..=n).map(flight).sum::<f64>()).collect()
    }

    fn account(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position)[0], seen.vector(Quantity::Velocity)[0]);
        let mass = fx128::lit(self.mass);
        let energy = mass * (v * v * fx128::lit(0.5) + fx128::lit(self.gravity) * x);
        vec![
            Entry { balance: Balance::Energy, value: vec![energy], conserved: self.restitution == 1.0 },
            Entry { balance: Balance::Momentum, value: vec![mass * v], conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity) -> Theory {
        let [x, v] = self.envelope(lag(method));
        Theory {
            order: ExpectedOrder::Envelope(1.0),
            constant: Some(if quantity == Quantity::Position { x } else { v }),
            reason: "a bounce is seen up to h late and the ball is delayed by twice that: at most C h, with a factor that \
                     depends on where in its step each bounce falls",
        }
    }

    fn growth(&self, method: MethodId, balance: Balance, _h_s: f64) -> Option<ExpectedGrowth> {
        if self.restitution != 1.0 || balance != Balance::Energy {
            return None;
        }
        let (law, reason) = match lag(method) {
            1.0 => (Law::Linear, "E_n - E_0 = n m g^2 h^2 / 2: a step gains m g^2 h^2 / 2, a bounce nothing"),
            -1.0 => (Law::Linear, "E_n - E_0 = -n m g^2 h^2 / 2: a step loses m g^2 h^2 / 2, a bounce nothing"),
            _ => (Law::AtTheFloor, "exact on a parabola, and the reflection keeps position and speed"),
        };
        Some(ExpectedGrowth { law, bounds: None, reason })
    }
}
