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

use crate::catalogue::answerable;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene};
use crate::special::elementary::{expm1, log1p};
use crate::special::scaled::Scaled;
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

/// The arc that the ball is on, in flights: the time 2 V / g from the first bounce to the next if nothing were lost.
struct Arc {
    /// Bounces before it.
    bounces: u64,
    /// Time since the last of them, flights.
    since: fx128,
    /// e^n, the part of the speed V after the n-th bounce.
    left: fx128,
}

/// Bounces that a run may have: the studies list each.
const MOST_BOUNCES: f64 = 65_536.0;

impl BouncingBall {
    /// A bounce leaves three quarters of the speed.
    pub fn inelastic() -> Self {
        BouncingBall { restitution: 0.75, ..Self::default() }
    }

    /// V = sqrt(v0^2 + 2 g x0), m/s.
    fn impact(&self) -> Scaled {
        let (v0, g, x0) = (Scaled::of(self.v0), Scaled::of(self.gravity), Scaled::of(self.x0));
        let (fall, rise) = (g.times(x0).shifted(1).sqrt(), v0);
        // sqrt(a^2 + b^2) in units of the larger.
        let unit = if self.v0 == 0.0 { fall } else { fall.larger(rise) };
        let ratio = |part: Scaled| part.over(unit).value();
        let square = ratio(fall) * ratio(fall) + ratio(rise) * ratio(rise);
        unit.magnitude().times(Scaled::of_wide(square.sqrt()))
    }

    fn impact_speed(&self) -> fx128 {
        self.impact().value()
    }

    /// 2 V / g, s.
    fn flight(&self) -> Scaled {
        self.impact().over(Scaled::of(self.gravity)).shifted(1)
    }

    /// The first bounce in flights: (v0 + V) / (2 V), or g x0 / (V (V - v0)) for a ball thrown downwards.
    fn first_flight(&self) -> fx128 {
        let speed = self.impact();
        let ratio = Scaled::of(self.v0).over(speed).value();
        if self.v0 >= 0.0 {
            return (fx128::ONE + ratio) * fx128::lit(0.5);
        }
        let fall = Scaled::of(self.gravity).times(Scaled::of(self.x0)).over(speed).over(speed).value();
        fall / (fx128::ONE - ratio)
    }

    /// e (1 - e^n) / (1 - e): flights from the first bounce to the one n later.
    fn flights(&self, n: fx128) -> fx128 {
        let e = fx128::lit(self.restitution);
        if self.restitution == 1.0 { n } else { -e * expm1(n * log1p(e - fx128::ONE)) / (fx128::ONE - e) }
    }

    /// When the ball has come to rest, s: infinite for e = 1.
    pub fn rest_s(&self) -> f64 {
        let e = fx128::lit(self.restitution);
        if self.restitution == 1.0 {
            return f64::INFINITY;
        }
        let flights = self.first_flight() + e / (fx128::ONE - e);
        self.flight().times(Scaled::of_wide(flights)).value().to_f64()
    }

    /// The arc at the time `late` flights after the first bounce; none once the ball rests.
    ///
    /// n = ln(1 - late (1 - e) / e) / ln e, rounded down: no bounce is counted.
    fn arc(&self, late: fx128) -> Option<Arc> {
        let e = fx128::lit(self.restitution);
        let loss = fx128::ONE - e;
        if self.restitution == 1.0 {
            let whole = (late - fx128::lit(0.5)).round();
            return Some(Arc { bounces: 1 + whole.to_f64() as u64, since: late - whole, left: e });
        }
        let remaining = fx128::ONE - late * loss / e;
        if remaining.0 <= 0.0 {
            return None;
        }
        let rate = log1p(-loss);
        let mut whole = (log1p(-(late * loss / e)) / rate - fx128::lit(0.5)).round();
        // Rounding may have taken it over a bounce.
        if self.flights(whole) > late {
            whole -= fx128::ONE;
        } else if self.flights(whole + fx128::ONE) <= late {
            whole += fx128::ONE;
        }
        let left = ((whole + fx128::ONE) * rate).exp();
        Some(Arc { bounces: 1 + whole.to_f64() as u64, since: late - self.flights(whole), left })
    }

    /// Time after the first bounce in flights; negative before it.
    fn lateness(&self, t: fx128) -> fx128 {
        Scaled::of_wide(t).over(self.flight()).value() - self.first_flight()
    }

    fn motion(&self, t: fx128) -> (fx128, fx128) {
        let (late, time) = (self.lateness(t), Scaled::of_wide(t));
        if late.0 < 0.0 || t.0 == 0.0 {
            let (x0, v0, fall) = (Scaled::of(self.x0), Scaled::of(self.v0), Scaled::of(-self.gravity).times(time));
            let x = [x0, v0.times(time), fall.times(time).shifted(-1)];
            return (Scaled::sum(&x), Scaled::sum(&[v0, fall]));
        }
        let Some(Arc { since, left, .. }) = self.arc(late) else { return (fx128::ZERO, fx128::ZERO) };
        let (speed, two) = (self.impact(), fx128::lit(2.0));
        let height = self.flight().times(speed).times(Scaled::of_wide(since * (left - since)));
        (height.value(), speed.times(Scaled::of_wide(left - two * since)).value())
    }

    /// Bounces until `end_s`.
    fn bounces(&self, end_s: f64) -> u64 {
        let late = self.lateness(fx128::lit(end_s));
        if late.0 < 0.0 { 0 } else { self.arc(late).map_or(0, |arc| arc.bounces) }
    }

    /// error / h of position and velocity at the horizon, to leading order, if every bounce is seen at once, and what each
    /// bounce seen h late adds to it, in order.
    ///
    /// In flight the positions of explicit (`lag` = 1) and semi-implicit or implicit Euler (-1) lie on the parabola of the
    /// velocity u = v + lag g h / 2; the others have lag 0. `delay` and `extra` are the lateness of the ball and the excess of
    /// its speed u, in h and g h.
    fn first_order(&self, lag: f64, end_s: f64) -> ([f64; 2], Vec<[f64; 2]>) {
        let (g, e, count) = (self.gravity, self.restitution, self.bounces(end_s));
        let late = self.lateness(fx128::lit(end_s));
        let arc = if late.0 < 0.0 { None } else { self.arc(late) };
        let end =
            arc.map_or((0.0, 0.0), |arc| (arc.since.to_f64() * self.flight().value().to_f64(), arc.left.to_f64()));
        let impact = self.impact_speed().to_f64();
        let v = impact * end.1 - g * end.0;
        let at_end = |delay: f64, extra: f64| [-v * delay + g * extra * end.0, g * (delay + extra)];
        // u0 = v0 + lag g h / 2: V^2 = u0^2 + 2 g x0, t_1 = (u0 + V) / g.
        let mut extra = 0.5 * lag * self.v0 / impact;
        let mut delay = 0.5 * lag + extra;
        for j in 0..count {
            if j > 0 {
                delay += 2.0 * extra;
            }
            extra = e * extra + 0.5 * (1.0 + e) * lag;
        }
        let none = at_end(delay, extra);
        // Reflected h late, at the depth h V: up through the floor h / e later, slower by g h / e, faster by e g h.
        let (mut delay, mut extra) = (1.0 + 1.0 / e, e - 1.0 / e);
        let mut each = Vec::with_capacity(count as usize);
        for _ in 0..count {
            each.push(at_end(delay, extra));
            delay += 2.0 * extra;
            extra *= e;
        }
        each.reverse();
        ([none[0], none[1] - 0.5 * lag * g], each)
    }

    /// The step with which a ball that is as late as it can be still bounces as often until the horizon, s: half of the time from
    /// the horizon to the nearest bounce, or of the shortest flight, over the lateness in steps.
    fn envelope_below_s(&self, lag: f64, end_s: f64) -> f64 {
        let e = self.restitution;
        let times = self.nonsmooth_times_s(end_s);
        let flight = 2.0 * self.impact_speed().to_f64() / self.gravity;
        let next = times.last().map_or(f64::INFINITY, |last| last + flight * e.powi(times.len() as i32));
        let flights = times.windows(2).map(|w| w[1] - w[0]);
        let shortest = flights.fold((next - end_s).min(end_s - times.last().unwrap_or(&0.0)), f64::min);
        // As in `first_order`, each bounce at its worst.
        let (mut late, mut slow) =
            (0.5 * lag.abs() * (1.0 + (self.v0 / self.impact_speed().to_f64()).abs()), lag.abs());
        for _ in &times {
            late += 1.0 + 1.0 / e + 2.0 * slow;
            slow = e * slow + 1.0 / e - e + lag.abs();
        }
        0.5 * shortest / late
    }

    /// The step below which a ball that is too low by g t h / 2 does not bounce before the horizon either, s; half of it.
    fn unbounced_below_s(&self, end_s: f64) -> f64 {
        let first_s = self.flight().times(Scaled::of_wide(self.first_flight())).value().to_f64();
        self.impact_speed().to_f64() * (first_s - end_s) / (self.gravity * end_s)
    }

    /// The largest |error| / h over all phases of the bounces in their steps.
    fn envelope(&self, lag: f64, end_s: f64) -> [f64; 2] {
        let (none, each) = self.first_order(lag, end_s);
        let (mut low, mut high) = (none, none);
        for late in each {
            for c in 0..2 {
                low[c] += late[c].min(0.0);
                high[c] += late[c].max(0.0);
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
        let rate = self.gravity / self.impact_speed().to_f64();
        let mut pace = Pace { horizon_s: 2.25, coarsest_steps: 16 }.at(rate / 1.8);
        while pace.horizon_s >= 0.9375 * self.rest_s() && self.rest_s() > 0.0 {
            pace.horizon_s *= 0.5;
        }
        Info {
            kind: Kind::Bounces,
            about: "a ball whose bounces are seen at the end of a step: no method is better than first order",
            equation: r"\ddot x = -g;\quad x < 0,\ v < 0:\ v\to -e\,v",
            source: "parabolas and a geometric series (E. Falcon et al., Eur. Phys. J. B 3 (1998) 45)",
            horizon_s: pace.horizon_s,
            time_scale_s: self.impact_speed().to_f64() / self.gravity,
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn ends_s(&self) -> f64 {
        self.rest_s()
    }

    fn check(&self) -> Result<(), Error> {
        let (rest, end) = (self.rest_s(), self.info().horizon_s);
        let refuse = |parameter: &str, value: f64, expected: String| {
            Err(Error::Parameter {
                scene: "bouncing-ball".to_owned(),
                parameter: parameter.to_owned(),
                value: value.to_string(),
                expected,
            })
        };
        if rest <= end {
            let expected =
                format!("the ball rests at {rest:.3} s, before the end of the run at {end} s: drop it from higher");
            return refuse("restitution", self.restitution, expected);
        }
        let late = self.lateness(fx128::lit(end));
        let bounces = if late.0 <= 0.0 { 0.0 } else { self.arc(late).map_or(f64::NAN, |arc| arc.bounces as f64) };
        // Written so that a NaN is refused.
        if !(bounces <= MOST_BOUNCES) {
            let expected = format!(
                "the ball bounces more than {MOST_BOUNCES} times until the end of the run at {end} s: drop it from \
                 higher, or with less gravity"
            );
            return refuse("x0", self.x0, expected);
        }
        let seen = Motion::<f64>::observe(self, &self.exact(end));
        answerable::range("bouncing-ball", self, &seen, end)
    }

    fn nonsmooth_times_s(&self, end_s: f64) -> Vec<f64> {
        let first = self.first_flight();
        let at = |n: u64| self.flight().times(Scaled::of_wide(first + self.flights(fx128::lit(n as f64))));
        (0..self.bounces(end_s)).map(|n| at(n).value().to_f64()).collect()
    }

    fn is_periodic(&self) -> bool {
        false
    }

    fn rounding_accumulates(&self) -> bool {
        false
    }

    fn period_s(&self) -> Option<f64> {
        (self.restitution == 1.0).then(|| 2.0 * self.impact_speed().to_f64() / self.gravity)
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position)[0], seen.vector(Quantity::Velocity)[0]);
        let mass = fx128::lit(self.mass);
        let energy = mass * (v * v * fx128::lit(0.5) + fx128::lit(self.gravity) * x);
        vec![
            Entry { invariant: Invariant::Energy, value: vec![energy], conserved: self.restitution == 1.0 },
            Entry { invariant: Invariant::Momentum, value: vec![mass * v], conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        if self.nonsmooth_times_s(end_s).is_empty() {
            return match (lag(method), quantity) {
                (0.0, _) | (_, Quantity::Velocity) => Theory {
                    below_h_s: self.unbounced_below_s(end_s),
                    ..Theory::exact("no bounce: v is linear in t, x a parabola")
                },
                _ => Theory::with_constant(
                    method,
                    0.5 * self.gravity * end_s,
                    "no bounce: x is wrong by exactly -+ g t h / 2",
                ),
            };
        }
        let [x, v] = self.envelope(lag(method), end_s);
        Theory {
            order: ExpectedOrder::Envelope(1.0),
            doubt: 0.0,
            below_h_s: self.envelope_below_s(lag(method), end_s),
            constant: Some(if quantity == Quantity::Position { x } else { v }),
            reason: "a bounce is seen up to h late and the ball is delayed by twice that: at most C h, with a factor that \
                     depends on where in its step each bounce falls",
        }
    }

    fn growth(&self, method: MethodId, invariant: Invariant, _h_s: f64) -> Option<ExpectedGrowth> {
        if self.restitution != 1.0 || invariant != Invariant::Energy {
            return None;
        }
        let (law, reason) = match lag(method) {
            1.0 => (Law::Linear, "E_n - E_0 = n m g^2 h^2 / 2: a step gains m g^2 h^2 / 2, a bounce nothing"),
            -1.0 => (Law::Linear, "E_n - E_0 = -n m g^2 h^2 / 2: a step loses m g^2 h^2 / 2, a bounce nothing"),
            _ => (Law::AtTheFloor, "exact on a parabola, and the reflection keeps position and speed"),
        };
        Some(ExpectedGrowth { law, bounds: None, seen_after_s: 0.0, reason })
    }
}
