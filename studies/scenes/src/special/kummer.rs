//! Kummer's confluent hypergeometric function of complex argument.

use faer::fx128;
use integrator::real::Real;
use nalgebra::Complex;

/// A complex number in double-double.
pub type Complex128 = Complex<fx128>;

/// The function and its derivative in z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kummer {
    /// 1F1(a; b; z).
    pub value: Complex128,
    /// d/dz 1F1(a; b; z) = (a / b) 1F1(a + 1; b + 1; z).
    pub derivative: Complex128,
}

/// |z| up to which the series about 0 is summed; on the imaginary axis its terms reach 6^6/6! = 65 times the result.
const FIRST_RADIUS: f64 = 6.0;
/// Length of the segments beyond, at most a third of the distance to the singular point 0.
const SEGMENT: f64 = 2.0;
/// Terms of a series that are worth adding: at FIRST_RADIUS the 60th is below 1e-35.
const MOST_TERMS: usize = 200;

/// 1F1(a; b; z) = 1 + (a/b) z + a (a+1) / (b (b+1)) z^2/2! + ... for real b > 0.
///
/// The series loses e^|z| to cancellation, so it is used for |z| <= 6 only. From there Kummer's equation
/// z w'' + (b - z) w' - a w = 0 is continued along the ray to z by its Taylor series, a segment of length 2 at a time; for
/// Re z < 0 through e^z 1F1(b - a; b; -z), so that the solution followed never decays against another one.
/// Error (measured, |a| <= 2): 2e-30 (1 + |z|) relative to max(|w|, |w'|) for |z| up to 300. The time taken grows with |z|. (DLMF 13.2.1-2, 13.2.39.)
pub fn hypergeometric_1f1(a: Complex128, b: fx128, z: Complex128) -> Kummer {
    if z.re.0 < 0.0 {
        let mirrored = hypergeometric_1f1(real(b) - a, b, -z);
        let growth = exp(z);
        let value = growth * mirrored.value;
        return Kummer { value, derivative: value - growth * mirrored.derivative };
    }
    let length = Real::sqrt(z.norm_sqr());
    if length.0 <= FIRST_RADIUS {
        return about_zero(a, b, z);
    }
    let segments = ((length.0 - FIRST_RADIUS) / SEGMENT).ceil();
    let step = z * real((length - fx128::from_f64(FIRST_RADIUS)) / (length * fx128::from_f64(segments)));
    let mut at = z * real(fx128::from_f64(FIRST_RADIUS) / length);
    let mut kummer = about_zero(a, b, at);
    for _ in 0..segments as u64 {
        kummer = continued(a, b, at, step, kummer);
        at += step;
    }
    kummer
}

/// The defining series and its derivative's.
fn about_zero(a: Complex128, b: fx128, z: Complex128) -> Kummer {
    let mut coefficient = real(fx128::ONE);
    let (mut value, mut derivative) = (coefficient, real(fx128::ZERO));
    for n in 0..MOST_TERMS {
        let n = fx128::from_f64(n as f64);
        // coefficient z^n of w; the next one times (n + 1) is that of w'.
        let slope = coefficient * (a + real(n)) * real(fx128::ONE / (b + n));
        derivative += slope;
        coefficient = slope * z * real(fx128::ONE / (n + fx128::ONE));
        value += coefficient;
        if size(slope) + size(coefficient) <= 1e-36 * (size(value) + size(derivative)) {
            break;
        }
    }
    Kummer { value, derivative }
}

/// The solution a step h from z, from its Taylor coefficients c_n there:
/// z (n + 2) (n + 1) c_{n+2} = (n + 1) (z - b - n) c_{n+1} + (n + a) c_n.
fn continued(a: Complex128, b: fx128, z: Complex128, h: Complex128, start: Kummer) -> Kummer {
    let turn = h / z;
    // Terms c_n h^n and c_{n+1} h^(n+1).
    let (mut term, mut next) = (start.value, start.derivative * h);
    let (mut value, mut slope) = (term + next, next);
    for n in 0..MOST_TERMS {
        let n = fx128::from_f64(n as f64);
        let pull = (z - real(b + n)) * next * real(n + fx128::ONE) + (a + real(n)) * term * h;
        let after = turn * pull * real(fx128::ONE / ((n + fx128::from_f64(2.0)) * (n + fx128::ONE)));
        (term, next) = (next, after);
        value += next;
        slope += next * real(n + fx128::from_f64(2.0));
        if size(term) + size(next) <= 1e-36 * size(value) {
            break;
        }
    }
    Kummer { value, derivative: slope / h }
}

/// e^z.
fn exp(z: Complex128) -> Complex128 {
    let (sine, cosine) = z.im.sin_cos();
    Complex::new(cosine, sine) * real(fx128::exp(z.re))
}

fn real(x: fx128) -> Complex128 {
    Complex::new(x, fx128::ZERO)
}

fn size(z: Complex128) -> f64 {
    z.re.0.abs() + z.im.0.abs()
}
