//! What the oscillators share: the motion x'' + 2 g x' + w^2 x = f cos(W t) in double-double, smooth in its parameters.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Real, Single, State};
use nalgebra::{DMatrix, Vector1};

use crate::catalogue::linear::{Linear, Parts, first_failure};
use crate::motion::rounded;
use crate::special::elementary::expm1;
use crate::special::scaled::{Scaled, exponent_of_largest, times_two_to};
use crate::theory::StabilityLimit;

/// The numbers of one oscillator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oscillation {
    /// Half the damping rate, g = c / (2 m), 1/s.
    pub(crate) decay: Scaled,
    /// w^2 = k / m, 1/s^2.
    pub(crate) square: Scaled,
    /// w^2 - g^2 over w^2.
    pub(crate) beat: fx128,
    /// f = F / m, m/s^2.
    pub(crate) force: Scaled,
    /// W, rad/s.
    pub(crate) drive: f64,
    /// Displacement at the start, m.
    pub(crate) x0: f64,
    /// Velocity at the start, m/s.
    pub(crate) v0: f64,
}

/// A complex number as (real, imaginary).
type Complex = (fx128, fx128);

fn product(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn quotient(a: Complex, b: Complex) -> Complex {
    // In units of the divisor: its square may be out of range.
    let unit = exponent_of_largest(&[b.0.0, b.1.0]);
    let b = (times_two_to(b.0, -unit), times_two_to(b.1, -unit));
    let size = b.0 * b.0 + b.1 * b.1;
    let (re, im) = product(a, (b.0, -b.1));
    (times_two_to(re / size, -unit), times_two_to(im / size, -unit))
}

/// e^-a sinh(z) / z with z = a + i y, a >= 0: nothing overflows.
fn damped_sinhc(a: fx128, y: fx128) -> Complex {
    if a.0 == 0.0 && y.0 == 0.0 {
        return (fx128::ONE, fx128::ZERO);
    }
    let (sine, cosine) = y.sin_cos();
    let sinh = -expm1(-(a + a)) * fx128::lit(0.5);
    quotient((sinh * cosine, (fx128::ONE - sinh) * sine), (a, y))
}

/// The oscillator with the time as its unit: everything is a phase.
struct Phases {
    /// g t.
    decay: fx128,
    /// w^2 t^2, and w t.
    square: fx128,
    root: fx128,
    /// sqrt|w^2 - g^2| t.
    beat: fx128,
    /// w^2 > g^2.
    turns: bool,
    /// W t.
    drive: fx128,
}

/// S, S' and C of the motions that start from (0, 1) and (1, 0).
struct Free {
    s: fx128,
    s_rate: fx128,
    c: fx128,
}

impl Phases {
    /// S = e^(-g t) sin(b t) / b, S' and C = S' + 2 g S with b^2 = w^2 - g^2, hyperbolic for g > w: smooth through b = 0,
    /// where two exponentials would cancel.
    fn free(&self) -> Free {
        let (g, b) = (self.decay, self.beat);
        if self.turns || b.0 == 0.0 {
            let damped = (-g).exp();
            let (cosine, sinc) = if b.0 <= 0.25 {
                fx128::cos_sinc(b * b)
            } else {
                let (sine, cosine) = b.sin_cos();
                (cosine, sine / b)
            };
            return Free { s: damped * sinc, s_rate: damped * (cosine - g * sinc), c: damped * (cosine + g * sinc) };
        }
        // The slow exponent g - b = w^2 / (g + b) does not cancel, and e^(-g t) cosh(b t) does not overflow.
        let (slow, fast) = self.exponents();
        let (damped, twice) = ((-slow).exp(), b + b);
        let gap = -expm1(-twice);
        let s_rate = if b.0 < 1.0 { fx128::ONE - fast * gap / twice } else { (fast * (-twice).exp() - slow) / twice };
        Free { s: damped * gap / twice, s_rate: damped * s_rate, c: damped * (fx128::ONE + slow * gap / twice) }
    }

    /// The decay rates g -+ b of an over-damped oscillator.
    fn exponents(&self) -> (fx128, fx128) {
        let fast = self.decay + self.beat;
        (self.root / fast * self.root, fast)
    }

    /// Q and Q' of x'' + 2 g x' + w^2 x = cos(W t) from rest.
    fn response(&self, free: &Free) -> Complex {
        let (g, w, drive) = (self.decay.0, self.root.0, self.drive.0);
        if (g + g).max(w).max(drive) <= 1.0 {
            self.short_response()
        } else if drive >= 2.0 * w.max(g) || (0.5 * w <= g && g <= 2.0 * w) {
            self.response_off_resonance(free)
        } else {
            self.response_by_differences(free)
        }
    }

    /// By its power series, whose coefficients fall as 1 / n!.
    fn short_response(&self) -> Complex {
        let (twice_decay, drive_squared) = (self.decay + self.decay, self.drive * self.drive);
        let (mut before, mut last, mut load) = (fx128::ZERO, fx128::ZERO, fx128::ONE);
        let (mut value, mut rate) = (fx128::ZERO, fx128::ZERO);
        for n in 0..40 {
            let [m, k] = [f64::from(n) + 1.0, f64::from(n) + 2.0].map(fx128::lit);
            // c_n of the drive, which has even powers only.
            let drive = if n % 2 == 0 { load } else { fx128::ZERO };
            let next = (drive - twice_decay * m * last - self.square * before) / (m * k);
            if n % 2 == 0 {
                load = -load * drive_squared / (m * k);
            }
            (before, last) = (last, next);
            value += next;
            rate += k * next;
        }
        (value, rate)
    }

    /// (e^(i W t) - C - i W S) over its denominator w^2 - W^2 + 2 i g W, which is not small.
    fn response_off_resonance(&self, free: &Free) -> Complex {
        let (sine, cosine) = self.drive.sin_cos();
        let denominator = (self.square - self.drive * self.drive, (self.decay + self.decay) * self.drive);
        let value = quotient((cosine - free.c, sine - self.drive * free.s), denominator);
        let rate = (self.square * free.s - self.drive * sine, self.drive * (cosine - free.s_rate));
        (value.0, quotient(rate, denominator).0)
    }

    /// The divided difference exp[l+, l-, i W] of the roots, (D(l+) - D(l-)) / (l+ - l-) with
    /// D(l) = t e^((l + i W) t / 2) sinhc((l - i W) t / 2): at and near resonance, and for a slow root near 0.
    fn response_by_differences(&self, free: &Free) -> Complex {
        let half = fx128::lit(0.5);
        let difference = |decay: fx128, turn: fx128| {
            let (sine, cosine) = ((turn + self.drive) * half).sin_cos();
            // sinhc is even.
            product((cosine, sine), damped_sinhc(decay * half, (self.drive - turn) * half))
        };
        let value = if self.turns {
            let (plus, minus) = (difference(self.decay, self.beat), difference(self.decay, -self.beat));
            quotient((plus.0 - minus.0, plus.1 - minus.1), (fx128::ZERO, self.beat + self.beat))
        } else {
            let (slow, fast) = self.exponents();
            let (slow, fast) = (difference(slow, fx128::ZERO), difference(fast, fx128::ZERO));
            let twice = self.beat + self.beat;
            ((slow.0 - fast.0) / twice, (slow.1 - fast.1) / twice)
        };
        // The derivative of a divided difference of e^(l t): Q' = i W Q + S.
        (value.0, free.s - self.drive * value.1)
    }
}

impl Oscillation {
    fn phases(&self, t: fx128) -> Phases {
        let time = Scaled::of_wide(t);
        let root = self.square.sqrt();
        let size = Real::abs(self.beat);
        // An over-damped oscillator has g for its scale: beat may be infinite where g is not.
        let beat = if size.0.is_finite() { root.times(Scaled::of_wide(size).sqrt()) } else { self.decay };
        Phases {
            decay: self.decay.times(time).value(),
            square: self.square.times(time).times(time).value(),
            root: root.times(time).value(),
            beat: beat.times(time).value(),
            turns: self.beat.0 > 0.0,
            drive: Scaled::of(self.drive).times(time).value(),
        }
    }

    /// The motion at the time `t`: x = x0 C + v0 S + f Q, v = -w^2 x0 S + v0 S' + f Q'.
    pub(crate) fn at<T: Single>(&self, t: T) -> State<Vector1<T>> {
        let t = t.widen();
        let (x0, v0) = (Scaled::of(self.x0), Scaled::of(self.v0));
        if t.0 == 0.0 {
            return rounded(Vector1::new(x0.value()), Vector1::new(v0.value()));
        }
        let (phases, time) = (self.phases(t), Scaled::of_wide(t));
        let free = phases.free();
        let (q, q_rate) =
            if self.force == Scaled::of(0.0) { (fx128::ZERO, fx128::ZERO) } else { phases.response(&free) };
        let [c, s, s_rate, q, q_rate] = [free.c, free.s, free.s_rate, q, q_rate].map(Scaled::of_wide);
        let pushed = self.force.times(time);
        let x = [x0.times(c), v0.times(time).times(s), pushed.times(time).times(q)];
        let pulled = Scaled::of(-self.x0).times(self.square).times(time);
        let v = [pulled.times(s), v0.times(s_rate), pushed.times(q_rate)];
        rounded(Vector1::new(Scaled::sum(&x)), Vector1::new(Scaled::sum(&v)))
    }

    /// The phase turned through until a time, or the decay: what double-double must resolve.
    pub(crate) fn largest_phase(&self, t_s: f64) -> f64 {
        let phases = self.phases(fx128::lit(t_s));
        if phases.turns { phases.root.0.max(phases.drive.0) } else { phases.drive.0 }
    }

    /// The fastest of its rates, 1/s: of the free motion's exponents, and of the driving force where there is one.
    pub(crate) fn fastest(&self) -> f64 {
        let number = |x: Scaled| x.value().to_f64();
        let (g, w) = (number(self.decay), number(self.square).sqrt());
        let free = if g > w { g + (g * g - w * w).sqrt() } else { w };
        if number(self.force) == 0.0 { free } else { free.max(self.drive) }
    }

    /// The same as a linear system.
    pub(crate) fn linear(&self) -> Linear {
        Linear::new(&Parts {
            stiffness: DMatrix::from_element(1, 1, -self.square.value().to_f64()),
            damping: DMatrix::from_element(1, 1, -2.0 * self.decay.value().to_f64()),
            forcing: &[self.force.value().to_f64()],
            drive: self.drive,
            q0: &[self.x0],
            v0: &[self.v0],
        })
    }

    /// The largest stable step where theory knows it, z = w h and zeta = g / w. Damping is explicit in both Eulers.
    pub(crate) fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        let w = self.square.sqrt().value().to_f64();
        let zeta = self.decay.value().to_f64() / w;
        let below = |z: f64| StabilityLimit::Below(z / w);
        let solved = || {
            let step = method.facts().linear?;
            Some(first_failure(1.0 / w, |h| !step.is_bounded((w * h).powi(2), 2.0 * zeta * w * h, 0.0)))
        };
        Some(match method {
            MethodId::ExplicitEuler if zeta == 0.0 => (StabilityLimit::NoStep, "|R(i z)|^2 = 1 + z^2"),
            MethodId::ExplicitEuler if zeta <= 1.0 => (below(2.0 * zeta), "|1 + h l|^2 = 1 - 2 zeta z + z^2 <= 1"),
            MethodId::ExplicitEuler => {
                (below(2.0 / (zeta + (zeta * zeta - 1.0).sqrt())), "z <= 2 (zeta - sqrt(zeta^2 - 1)), the fast root")
            }
            MethodId::SemiImplicitEuler => {
                (below(2.0 / ((1.0 + zeta * zeta).sqrt() + zeta)), "z <= 2 (sqrt(1 + zeta^2) - zeta), explicit damping")
            }
            MethodId::VelocityVerlet if zeta == 0.0 => (below(2.0), "sin(theta / 2) = z / 2"),
            MethodId::VelocityVerlet => {
                (solved()?, "|det| <= 1 and |trace| <= 1 + det of the step's matrix, solved numerically")
            }
            MethodId::Rk4 if zeta == 0.0 => (below(8.0_f64.sqrt()), "|R(i z)|^2 = 1 - z^6/72 + z^8/576"),
            MethodId::Rk4 => (solved()?, "|R(h l)| = 1 of the fast root, solved numerically"),
            MethodId::ImplicitEuler | MethodId::ImplicitMidpoint => (StabilityLimit::Unlimited, "A-stable"),
            _ => return None,
        })
    }
}
