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

use crate::invariants::{Balance, Entry};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Scene};
use crate::special::elementary::{asinh, atan, sech, sinh};
use crate::special::elliptic;
use crate::special::jacobi::Modulus;
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

    fn omega0(&self) -> fx128 {
        (fx128::lit(self.gravity) / fx128::lit(self.length)).sqrt()
    }

    /// theta and theta' at the time t after (angle, omega).
    fn motion(&self, omega: fx128, t: fx128) -> (fx128, fx128) {
        let (w0, half) = (self.omega0(), fx128::lit(0.5));
        let turns = (fx128::lit(self.angle) / (fx128::PI + fx128::PI)).round() * (fx128::PI + fx128::PI);
        let start = fx128::lit(self.angle) - turns;
        let p0 = omega * half / w0;
        let (sine, cosine) = (start * half).sin_cos();
        let mc = (cosine - p0) * (cosine + p0);
        let k = (sine * sine + p0 * p0).sqrt();
        let (angle, rate) = if k.0 == 0.0 {
            (fx128::ZERO, fx128::ZERO)
        } else if mc.0 > 0.0 {
            // F of an amplitude in (-pi, pi]: odd, and reflected at pi/2.
            let (s, c) = (sine / k, p0 / k);
            let quarter = elliptic::f_of(s, Real::abs(c), mc);
            let u0 = if c.0 >= 0.0 { quarter } else { elliptic::complete_f(mc) * fx128::lit(2.0) - quarter };
            let at = Modulus::new(mc).at::<fx128>(w0 * t + u0);
            ((k * at.sn).atan2(at.dn) * fx128::lit(2.0), (k + k) * w0 * at.cn)
        } else {
            let sense = if p0.0 < 0.0 { -fx128::ONE } else { fx128::ONE };
            let (angle, rate) = turning(sense * start * half, mc, k, w0, t);
            (sense * angle, sense * rate)
        };
        (angle + turns, rate)
    }
}

/// theta and theta' of a rotation (mc < 0) or of the separatrix (mc = 0) in the positive sense, from theta / 2 at the start.
fn turning(half_angle: fx128, mc: fx128, k: fx128, w0: fx128, t: fx128) -> (fx128, fx128) {
    let two = fx128::lit(2.0);
    if mc.0 == 0.0 {
        let (sine, cosine) = half_angle.sin_cos();
        let u = asinh(sine / cosine) + w0 * t;
        return (two * atan(sinh(u)), two * w0 * sech(u));
    }
    let mc_r = -mc / (k * k);
    let u = elliptic::f(half_angle, mc_r) + k * w0 * t;
    let modulus = Modulus::new(mc_r);
    (two * modulus.amplitude::<fx128>(u), two * k * w0 * modulus.at::<fx128>(u).dn)
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
        let (angle, rate) = self.motion(fx128::lit(self.omega), t.widen());
        rounded(Vector1::new(angle), Vector1::new(rate))
    }
    fn observe(&self, s: &State<Vector1<T>>) -> Observation {
        Observation::angle(s)
    }
}

impl Scene for Pendulum {
    fn info(&self) -> Info {
        Info {
            about: "a pendulum with wide swings: libration, rotation, and the slow passage between them",
            equation: r"\ddot\theta = -\frac{g}{l}\sin\theta",
            source: "Jacobi's elliptic functions (E. T. Whittaker, Analytical Dynamics (1937), section 44)",
            horizon_s: 2.75,
            time_scale_s: 1.0 / self.omega0().to_f64(),
            coarsest_steps: 8,
        }
    }

    fn account(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (angle, rate) = (seen.vector(Quantity::Attitude)[0], seen.vector(Quantity::AngularVelocity)[0]);
        let (length, mass) = (fx128::lit(self.length), fx128::lit(self.mass));
        let (half, two) = (fx128::lit(0.5), fx128::lit(2.0));
        let sine = (angle * half).sin_cos().0;
        // Height over the lowest position: l (1 - cos theta) without cancellation.
        let energy = mass * length * (length * rate * rate * half + fx128::lit(self.gravity) * two * sine * sine);
        vec![
            Entry { balance: Balance::Energy, value: vec![energy], conserved: true },
            Entry { balance: Balance::AngularMomentum, value: vec![mass * length * length * rate], conserved: false },
        ]
    }

    /// Semi-implicit Euler is leapfrog with a velocity that is h a0 / 2 off: error / h is the motion's answer to such a
    /// kick at the start, less a(T) / 2 for the velocity.
    fn theory(&self, method: MethodId, quantity: Quantity) -> Theory {
        if method != MethodId::SemiImplicitEuler {
            return Theory::usual(method);
        }
        let (t, step) = (fx128::lit(self.info().horizon_s), fx128::lit(2.0_f64.powi(-30)));
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

    fn growth(&self, method: MethodId, balance: Balance, _h_s: f64) -> Option<ExpectedGrowth> {
        let symplectic =
            matches!(method, MethodId::SemiImplicitEuler | MethodId::VelocityVerlet | MethodId::ImplicitMidpoint);
        (symplectic && balance == Balance::Energy).then_some(ExpectedGrowth {
            law: Law::Bounded,
            bounds: None,
            reason: "a symplectic method keeps a modified energy",
        })
    }
}
