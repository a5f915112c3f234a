//! A pendulum: theta'' = -w0^2 sin theta, w0^2 = g / l, with elliptic functions of the complementary parameter.
//!
//! p0 = theta0' / (2 w0), k^2 = sin^2(theta0/2) + p0^2, mc = 1 - k^2 = (cos(theta0/2) - p0)(cos(theta0/2) + p0), never the subtraction.
//! Libration (mc > 0): u = w0 t + F(phi0 | k^2) with phi0 = atan2(sin(theta0/2), p0): theta = 2 atan2(k sn u, dn u), theta' = 2 k w0 cn u.
//! Rotation (mc < 0): u = F(+-theta0/2 | 1/k^2) + k w0 t, theta = +-2 am(u | 1/k^2), theta' = +-2 k w0 dn u.
//! Between the two: theta = +-2 atan sinh(+-asinh tan(theta0/2) + w0 t), theta' = +-2 w0 sech.
//! Source: E. T. Whittaker, Analytical Dynamics (1937), section 44; DLMF 22.19(i).

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
use crate::scene::{Info, Kind, Pace, Scene, time_scale};
use crate::special::elementary::{asinh, atan, nearest_turn, sech, sinc, sinh, versine_over_square};
use crate::special::elliptic;
use crate::special::jacobi::Modulus;
use crate::special::scaled::Scaled;
use crate::theory::Law;
use crate::theory::{ExpectedGrowth, Theory};

scene_parameters! {
    /// A pendulum; the default swings widely.
    pub struct Pendulum {
        /// Mass.
        mass: f64 = 0.75, "kg", Positive;
        /// Length.
        length: f64 = 1.5, "m", Positive;
        /// Gravity.
        gravity: f64 = 9.8125, "m/s^2", Positive;
        /// Angle from the lowest position at the start.
        angle: f64 = 1.75, "rad", Finite;
        /// Angular velocity at the start.
        omega: f64 = 1.5, "rad/s", Finite;
    }
}

impl Pendulum {
    /// Over the top, round and round.
    pub fn rotation() -> Self {
        Pendulum { angle: 0.5, omega: 6.75, ..Self::default() }
    }

    /// Just not over the top: mc = 0.001.
    pub fn near_separatrix() -> Self {
        Pendulum { angle: 0.5, omega: 4.953125, ..Self::default() }
    }

    /// w0 = sqrt(g / l), rad/s.
    fn frequency(&self) -> Scaled {
        Scaled::of(self.gravity).over(Scaled::of(self.length)).sqrt()
    }

    /// The time of a swing, or of a turn, s: long near the separatrix, and infinite on it.
    fn swing_s(&self) -> f64 {
        let (w0, half) = (self.omega0().to_f64(), 0.5 * self.angle);
        let p0 = self.omega / (2.0 * w0);
        let (k2, mc) = (half.sin().powi(2) + p0 * p0, (half.cos() - p0) * (half.cos() + p0));
        if mc > 0.0 {
            4.0 * elliptic::complete_f(fx128::lit(mc)).to_f64() / w0
        } else if mc < 0.0 {
            2.0 * elliptic::complete_f(fx128::lit(-mc / k2)).to_f64() / (k2.sqrt() * w0)
        } else {
            f64::INFINITY
        }
    }

    fn omega0(&self) -> fx128 {
        self.frequency().value()
    }

    /// theta and theta' at the time t after (angle, omega).
    fn motion(&self, omega: fx128, t: fx128) -> (fx128, fx128) {
        let (half, given) = (fx128::lit(0.5), fx128::lit(self.angle));
        let (w0, time, omega) = (self.frequency(), Scaled::of_wide(t), Scaled::of_wide(omega));
        let start = nearest_turn(given);
        let p0 = omega.over(w0).shifted(-1).value();
        let phase = w0.times(time).value();
        let (sine, cosine) = (start * half).sin_cos();
        let advanced = |by: &[Scaled]| Scaled::sum(&[&[Scaled::of_wide(given)], by].concat());
        if p0.0.abs() > FAST {
            return (advanced(&[omega.times(time)]), omega.value());
        }
        if sine.0.abs().max(p0.0.abs()) < SMALL {
            let (swing, cosine) = (Scaled::of_wide(start), Scaled::of_wide(phase.sin_cos().1));
            let (sine, sinc) = (Scaled::of_wide(phase.sin_cos().0), Scaled::of_wide(sinc(phase)));
            let versine = phase * versine_over_square(phase) * phase;
            let angle = advanced(&[swing.times(Scaled::of_wide(-versine)), omega.times(time).times(sinc)]);
            let back = Scaled::of_wide(-start).times(w0).times(sine);
            return (angle, Scaled::sum(&[omega.times(cosine), back]));
        }
        let mc = (cosine - p0) * (cosine + p0);
        let k = (sine * sine + p0 * p0).sqrt();
        let (angle, rate) = if mc.0 > 0.0 {
            // F of an amplitude in (-pi, pi]: odd, and reflected at pi/2.
            let (s, c) = (sine / k, p0 / k);
            let quarter = elliptic::f_of(s, Real::abs(c), mc);
            let u0 = if c.0 >= 0.0 { quarter } else { elliptic::complete_f(mc) * fx128::lit(2.0) - quarter };
            let at = Modulus::new(mc).at::<fx128>(phase + u0);
            ((k * at.sn).atan2(at.dn) * fx128::lit(2.0), (k + k) * at.cn)
        } else {
            let sense = if p0.0 < 0.0 { -fx128::ONE } else { fx128::ONE };
            let (angle, rate) = turning(sense * start * half, mc, k, phase);
            (sense * angle, sense * rate)
        };
        (given - start + angle, Scaled::of_wide(rate).times(w0).value())
    }
}

/// Above this theta' / (2 w0) gravity changes nothing: k^-2 is below 2^-106.
const FAST: f64 = 1e17;
/// Below this size of sin(theta / 2) and theta' / (2 w0) the swing is harmonic: k^2 / 16 of MOST_RADIANS is below 2^-106.
const SMALL: f64 = 1e-25;

/// theta and theta' / w0 of a rotation (mc < 0) or of the separatrix (mc = 0) in the positive sense, from theta / 2 at the
/// start, at the phase w0 t.
fn turning(half_angle: fx128, mc: fx128, k: fx128, phase: fx128) -> (fx128, fx128) {
    let two = fx128::lit(2.0);
    if mc.0 == 0.0 {
        let (sine, cosine) = half_angle.sin_cos();
        let u = asinh(sine / cosine) + phase;
        return (two * atan(sinh(u)), two * sech(u));
    }
    let mc_r = -mc / (k * k);
    let u = elliptic::f(half_angle, mc_r) + k * phase;
    let modulus = Modulus::new(mc_r);
    (two * modulus.amplitude::<fx128>(u), two * k * modulus.at::<fx128>(u).dn)
}

impl<T: Real> Model<T> for Pendulum {
    type Config = Vector1<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        let (sine, _) = s.q.x.sin_cos();
        Vector1::new(-(T::lit(self.gravity) / T::lit(self.length)) * sine)
    }
}

impl<T: Single> Motion<T> for Pendulum {
    fn exact(&self, t: T) -> State<Vector1<T>> {
        let (angle, rate) = match t.widen() {
            // Exactly, where the elliptic functions of a start beside the separatrix lose digits.
            t if t.0 == 0.0 => (fx128::lit(self.angle), fx128::lit(self.omega)),
            t => self.motion(fx128::lit(self.omega), t),
        };
        rounded(Vector1::new(angle), Vector1::new(rate))
    }
    fn observe(&self, s: &State<Vector1<T>>) -> Observation {
        Observation::angle(s)
    }
}

impl Scene for Pendulum {
    fn info(&self) -> Info {
        // Faster round and round than to and fro, it is the turning that a step has to follow.
        let scale_s = time_scale(self.omega0().to_f64().max(0.25 * self.omega.abs()));
        let pace = Pace { horizon_s: 2.75, coarsest_steps: 8 }.at((1.0 / scale_s) / 2.5);
        Info {
            kind: Kind::Oscillation,
            about: "a pendulum with wide swings: libration, rotation, and the slow passage between them",
            equation: r"\ddot\theta = -\frac{g}{l}\sin\theta",
            source: "Jacobi's elliptic functions (E. T. Whittaker, Analytical Dynamics (1937), section 44)",
            horizon_s: pace.horizon_s,
            time_scale_s: scale_s,
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let end_s = self.info().horizon_s;
        let time = Scaled::of(end_s);
        let swung = self.frequency().times(time).value().to_f64();
        answerable::phase("pendulum", ("gravity", &self.gravity), swung, end_s)?;
        answerable::phase("pendulum", ("omega", &self.omega), self.omega * end_s, end_s)?;
        let seen = Motion::<f64>::observe(self, &self.exact(end_s));
        answerable::range("pendulum", self, &seen, end_s)
    }

    /// Not where it goes round and round, and its angle grows.
    fn rounding_accumulates(&self) -> bool {
        self.omega.abs() <= 2.0 * self.omega0().to_f64() * (0.5 * self.angle).cos().abs()
    }

    fn period_s(&self) -> Option<f64> {
        Some(self.swing_s()).filter(|s| s.is_finite())
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (angle, rate) = (seen.vector(Quantity::Attitude)[0], seen.vector(Quantity::AngularVelocity)[0]);
        let (length, mass) = (fx128::lit(self.length), fx128::lit(self.mass));
        let (half, two) = (fx128::lit(0.5), fx128::lit(2.0));
        let sine = (angle * half).sin_cos().0;
        // Height over the lowest position: l (1 - cos theta) without cancellation.
        let energy = mass * length * (length * rate * rate * half + fx128::lit(self.gravity) * two * sine * sine);
        vec![
            Entry { invariant: Invariant::Energy, value: vec![energy], conserved: true },
            Entry {
                invariant: Invariant::AngularMomentum,
                value: vec![mass * length * length * rate],
                conserved: false,
            },
        ]
    }

    /// Semi-implicit Euler is leapfrog with a velocity that is h a0 / 2 off: error / h is the motion's answer to such a
    /// kick at the start, less a(T) / 2 for the velocity.
    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        if method != MethodId::SemiImplicitEuler {
            return Theory::usual(method);
        }
        let (t, step) = (fx128::lit(end_s), fx128::lit(2.0_f64.powi(-30)));
        let square = self.omega0() * self.omega0();
        let acceleration = |angle: fx128| -square * angle.sin_cos().0;
        let (start, rate) = (fx128::lit(self.angle), fx128::lit(self.omega));
        let (above, below) = (self.motion(rate + step, t), self.motion(rate - step, t));
        let kick = acceleration(start) * fx128::lit(0.25) / step;
        let end = acceleration(self.motion(rate, t).0) * fx128::lit(0.5);
        let constant = match quantity {
            Quantity::Attitude => (above.0 - below.0) * kick,
            _ => (above.1 - below.1) * kick - end,
        };
        Theory::with_constant(
            method,
            constant.to_f64(),
            "the motion's answer to a kick h a0 / 2 at the start, less a(T) h / 2",
        )
    }

    fn growth(&self, method: MethodId, invariant: Invariant, _h_s: f64) -> Option<ExpectedGrowth> {
        let symplectic =
            matches!(method, MethodId::SemiImplicitEuler | MethodId::VelocityVerlet | MethodId::ImplicitMidpoint);
        (symplectic && invariant == Invariant::Energy).then_some(ExpectedGrowth {
            law: Law::Bounded,
            bounds: None,
            seen_after_s: 8.0 * self.swing_s(),
            reason: "a symplectic method keeps a modified energy",
        })
    }
}
