//! What the oscillators share: the motion x'' + 2 g x' + w^2 x = f cos(W t) in double-double, smooth in its parameters.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Real, Single, State};
use nalgebra::{DMatrix, Vector1};

use crate::catalogue::linear::{Linear, Parts, first_failure, rk4_excess};
use crate::motion::rounded;
use crate::special::elementary::{expm1, sinh};
use crate::theory::StabilityLimit;

/// The numbers of one oscillator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oscillation {
    /// Half the damping rate, g = c / (2 m), 1/s.
    pub(crate) decay: fx128,
    /// w^2 = k / m, 1/s^2.
    pub(crate) square: fx128,
    /// f = F / m, m/s^2.
    pub(crate) force: fx128,
    /// W, rad/s.
    pub(crate) drive: fx128,
    /// Displacement at the start, m.
    pub(crate) x0: fx128,
    /// Velocity at the start, m/s.
    pub(crate) v0: fx128,
}

/// A complex number as (real, imaginary).
type Complex = (fx128, fx128);

fn product(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn quotient(a: Complex, b: Complex) -> Complex {
    let size = b.0 * b.0 + b.1 * b.1;
    let (re, im) = product(a, (b.0, -b.1));
    (re / size, im / size)
}

/// sinh(z) / z.
fn sinhc(z: Complex) -> Complex {
    if z.0.0 == 0.0 && z.1.0 == 0.0 {
        return (fx128::ONE, fx128::ZERO);
    }
    let (sine, cosine) = z.1.sin_cos();
    let sinh = sinh(z.0);
    let cosh = (fx128::ONE + sinh * sinh).sqrt();
    quotient((sinh * cosine, cosh * sine), z)
}

impl Oscillation {
    /// e^(-g t) (C, S), the motions that start from (1, -g) and (0, 1): (cos b t, sin(b t) / b) with b^2 = w^2 - g^2,
    /// hyperbolic for g > w. Both are smooth through b = 0, where two exponentials would cancel.
    fn free(&self, t: fx128) -> Complex {
        let square = self.square - self.decay * self.decay;
        if square.0 >= 0.0 {
            let damped = (-(self.decay * t)).exp();
            let (cosine, sinc) = fx128::cos_sinc(square * t * t);
            return (damped * cosine, damped * sinc * t);
        }
        // The slow exponent g - b = w^2 / (g + b) does not cancel, and e^(-g t) cosh(b t) does not overflow.
        let b = (-square).sqrt();
        let slow = (-(self.square / (self.decay + b) * t)).exp();
        let gap = -expm1(-(b * t + b * t));
        let half = fx128::lit(0.5);
        (slow * (fx128::ONE - gap * half), slow * gap * half / b)
    }

    /// Q(t) of x'' + 2 g x' + w^2 x = e^(i W t), x(0) = x'(0) = 0: the divided difference exp[l+, l-, i W] of the roots.
    ///
    /// Near resonance the roots l+ and i W come together: there Q = (D(l+) - D(l-)) / (l+ - l-) with
    /// D(l) = t e^((l + i W) t / 2) sinhc((l - i W) t / 2). Elsewhere Q = (e^(i W t) - free motion from (1, i W)) / (its denominator).
    fn response(&self, t: fx128) -> Complex {
        let (four, half) = (fx128::lit(4.0), fx128::lit(0.5));
        let beat = self.square - self.decay * self.decay;
        if (four * self.decay * self.decay).0 < self.square.0 {
            let b = beat.sqrt();
            let difference = |b: fx128| {
                let damped = (-(self.decay * t * half)).exp() * t;
                let (sine, cosine) = ((b + self.drive) * t * half).sin_cos();
                product(
                    (damped * cosine, damped * sine),
                    sinhc((-(self.decay * t * half), (b - self.drive) * t * half)),
                )
            };
            let (plus, minus) = (difference(b), difference(-b));
            return quotient((plus.0 - minus.0, plus.1 - minus.1), (fx128::ZERO, b + b));
        }
        let (c, s) = self.free(t);
        let (sine, cosine) = (self.drive * t).sin_cos();
        let denominator = (self.square - self.drive * self.drive, (self.decay + self.decay) * self.drive);
        quotient((cosine - c - self.decay * s, sine - self.drive * s), denominator)
    }

    /// The motion at the time `t`.
    pub(crate) fn at<T: Single>(&self, t: T) -> State<Vector1<T>> {
        let t = t.widen();
        let (c, s) = self.free(t);
        let (x0, v0) = (self.x0, self.v0);
        let q = self.response(t);
        let x = x0 * c + (v0 + self.decay * x0) * s + self.force * q.0;
        // The derivative of a divided difference of e^(l t): Q' = i W Q + exp[l+, l-].
        let v = v0 * c - (self.decay * v0 + self.square * x0) * s + self.force * (s - self.drive * q.1);
        rounded(Vector1::new(x), Vector1::new(v))
    }

    /// The same as a linear system.
    pub(crate) fn linear(&self) -> Linear {
        Linear::new(&Parts {
            stiffness: DMatrix::from_element(1, 1, -self.square.to_f64()),
            damping: DMatrix::from_element(1, 1, -2.0 * self.decay.to_f64()),
            forcing: &[self.force.to_f64()],
            drive: self.drive.to_f64(),
            q0: &[self.x0.to_f64()],
            v0: &[self.v0.to_f64()],
        })
    }

    /// The largest stable step, z = w h and zeta = g / w. Damping is explicit in both Eulers.
    pub(crate) fn stability_limit(&self, method: MethodId) -> (StabilityLimit, &'static str) {
        let w = self.square.to_f64().sqrt();
        let zeta = self.decay.to_f64() / w;
        let below = |z: f64| StabilityLimit::Below(z / w);
        match method {
            MethodId::ExplicitEuler if zeta == 0.0 => (StabilityLimit::NoStep, "|R(i z)|^2 = 1 + z^2"),
            MethodId::ExplicitEuler if zeta <= 1.0 => (below(2.0 * zeta), "|1 + h l|^2 = 1 - 2 zeta z + z^2 <= 1"),
            MethodId::ExplicitEuler => {
                (below(2.0 / (zeta + (zeta * zeta - 1.0).sqrt())), "z <= 2 (zeta - sqrt(zeta^2 - 1)), the fast root")
            }
            MethodId::SemiImplicitEuler => {
                (below(2.0 / ((1.0 + zeta * zeta).sqrt() + zeta)), "z <= 2 (sqrt(1 + zeta^2) - zeta), explicit damping")
            }
            MethodId::VelocityVerlet if zeta == 0.0 => (below(2.0), "sin(theta / 2) = z / 2"),
            MethodId::VelocityVerlet => (
                first_failure(1.0 / w, |h| verlet_excess(w * h, zeta)),
                "|det| <= 1 and |trace| <= 1 + det of the step's matrix, solved numerically",
            ),
            MethodId::Rk4 if zeta == 0.0 => (below(8.0_f64.sqrt()), "|R(i z)|^2 = 1 - z^6/72 + z^8/576"),
            MethodId::Rk4 => {
                let fast = zeta + (zeta * zeta - 1.0).max(0.0).sqrt();
                let turn = (1.0 - zeta * zeta).max(0.0).sqrt();
                let excess = |h: f64| rk4_excess(-fast * w * h, turn * w * h);
                (first_failure(1.0 / w, excess), "|R(h l)| = 1 of the fast root, solved numerically")
            }
            MethodId::ImplicitEuler | MethodId::ImplicitMidpoint => (StabilityLimit::Unlimited, "A-stable"),
        }
    }
}

/// Positive where a step of velocity Verlet on x'' + 2 zeta x' + x = 0 amplifies: Jury's conditions for its matrix.
fn verlet_excess(z: f64, zeta: f64) -> f64 {
    let (xx, xv) = (1.0 - z * z / 2.0, z - zeta * z * z);
    let damped = 1.0 - 2.0 * zeta * z;
    // v1 = v + (z/2) (a0 + a1), a0 = -x - 2 zeta v, a1 = -x1 - 2 zeta (v + z a0)
    let vx = z / 2.0 * (-1.0 - xx + 2.0 * zeta * z);
    let vv = 1.0 + z / 2.0 * (-2.0 * zeta - xv - 2.0 * zeta * damped);
    let (trace, det) = (xx + vv, xx * vv - xv * vx);
    (det.abs() - 1.0).max(trace.abs() - 1.0 - det)
}
