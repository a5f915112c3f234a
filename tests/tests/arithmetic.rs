//! The arithmetic under every step: f32, f64 and double-double against tables of 36 digits, and against identities.
//!
//! Errors are absolute or relative as the function's condition has it, in eps = distance from 1 to the next number. Not
//! seen here: speed, and whether other platforms give the same bits.

use faer::fx128;
use integrator::{Real, Single};
use verification::table::{self, Entry};

/// |value - truth| / (eps scale); infinite for NaN.
fn error_in_eps<T: Single>(value: T, truth: fx128, scale: f64) -> f64 {
    let error = (value.widen() - truth).0.abs() / (T::EPSILON * scale);
    if error.is_nan() { f64::INFINITY } else { error }
}

/// The largest error of one function of the table.
fn worst(function: &str, error: impl Fn(&Entry) -> f64) -> f64 {
    let entries = table::load("arithmetic").into_iter().filter(|e| e.function == function);
    let errors: Vec<f64> = entries.map(|e| error(&e)).collect();
    assert!(errors.len() >= 20, "{function}: {} entries", errors.len());
    let worst = errors.into_iter().fold(0.0, f64::max);
    println!("{function}: {worst:.2} eps");
    worst
}

/// Errors relative to the value, of what is computed from the first two numbers of an entry.
fn worst_relative<T: Single>(function: &str, f: impl Fn(T, T) -> T) -> f64 {
    worst(function, |e| {
        error_in_eps(f(T::lit(e.arguments[0]), T::lit(e.arguments[1])), e.numbers[2], e.numbers[2].0.abs())
    })
}

/// Absolute errors, for functions bounded by 1.
fn worst_absolute<T: Single>(function: &str, f: impl Fn(T) -> T) -> f64 {
    worst(function, |e| error_in_eps(f(T::lit(e.arguments[0])), e.numbers[2], 1.0))
}

// Fails if: libm::sin and libm::cos change places.
#[test]
fn elementary_functions_of_f64_are_good_to_an_ulp() {
    // One ulp is at most one eps of the value.
    assert!(worst_relative::<f64>("sin", |x, _| integrator::Real::sin_cos(x).0) <= 1.0);
    assert!(worst_relative::<f64>("cos", |x, _| integrator::Real::sin_cos(x).1) <= 1.0);
    assert!(worst_relative::<f64>("exp", |x, _| Single::exp(x)) <= 1.0);
    assert!(worst_relative::<f64>("ln", |x, _| Single::ln(x)) <= 1.0);
    assert!(worst_relative::<f64>("atan2", Single::atan2) <= 1.0);
}

// Fails if: the third part of HALF_PI is left out; the reduction takes one quarter turn too many; one doubling is left out;
// the Newton step of atan2 is left out.
#[test]
fn elementary_functions_of_double_double_keep_their_digits() {
    // 2e-31, the bound stated for |x| < 1e6, is 4.06 eps.
    let stated = 2e-31 / fx128::EPSILON.0;
    assert!(worst_absolute::<fx128>("sin", |x| integrator::Real::sin_cos(x).0) <= stated);
    assert!(worst_absolute::<fx128>("cos", |x| integrator::Real::sin_cos(x).1) <= stated);
    // faer's own: 7e-31 is 14.2 eps.
    let of_faer = 7e-31 / fx128::EPSILON.0;
    assert!(worst_relative::<fx128>("exp", |x, _| Single::exp(x)) <= of_faer);
    // Near 1 the error of ln stays that of numbers of size 1: where its digits matter there, log1p has them.
    let ln = |e: &Entry| {
        error_in_eps(Single::ln(fx128::from_f64(e.arguments[0])), e.numbers[2], e.numbers[2].0.abs().max(1.0))
    };
    assert!(worst("ln", ln) <= of_faer);
    // The sum of an angle and a correction 1e-16 of it: 2e-31 of sine and cosine times 1 at most, and the radius.
    assert!(worst_relative::<fx128>("atan2", Single::atan2) <= 8.0);
}

// Fails if: libm::sinf and libm::cosf change places; f32 takes a term less of the sinc.
#[test]
fn elementary_functions_of_f32_agree_with_f64_to_an_ulp() {
    let mut worst = [0.0_f64; 7];
    for i in 1..20_000 {
        let x = (f64::from(i) * 0.002) as f32;
        let wide = f64::from(x);
        let (sine, cosine) = integrator::Real::sin_cos(x);
        let (cosine_of_root, sinc_of_root) = <f32 as integrator::Real>::cos_sinc(x);
        let root = wide.sqrt();
        let pairs = [
            (sine, wide.sin(), wide.sin().abs()),
            (cosine, wide.cos(), wide.cos().abs()),
            (Single::exp(-x), (-wide).exp(), (-wide).exp()),
            (Single::ln(x), wide.ln(), wide.ln().abs()),
            (Single::atan2(x, 3.0), wide.atan2(3.0), wide.atan2(3.0)),
            (cosine_of_root, root.cos(), 1.0 + DOUBLED * root),
            (sinc_of_root, root.sin() / root, 1.0 + DOUBLED * root.min(1.3)),
        ];
        for (w, (value, truth, scale)) in worst.iter_mut().zip(pairs) {
            if scale > 0.0 {
                *w = w.max((f64::from(value) - truth).abs() / (<f32 as Single>::EPSILON * scale));
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.iter().all(|w| *w <= 1.0), "{worst:?}");
}

/// Largest x^2 of the Taylor sums, in every arithmetic.
const SWITCH: f64 = 0.0625;

/// The errors of (cos x, sin x / x) as functions of x^2 up to 40^2: `own` eps of the sums, and beyond them a phase error of
/// `phase` eps of the angle.
fn cos_sinc_is_accurate<T: Single>(own: f64, phase: f64) {
    let scale = |x: f64| if x * x <= SWITCH { own } else { own + phase * x };
    for (name, is_cosine) in [("cos_sqrt", true), ("sinc_sqrt", false)] {
        let error = worst(name, |e| {
            let x = e.arguments[0].sqrt();
            let (cosine, sinc) = T::cos_sinc(T::lit(e.arguments[0]));
            // A phase error of phase x moves sin x / x by |x d(sinc)/dx| <= 1.3 of phase.
            let scale = if is_cosine { scale(x) } else { scale(x.min(1.3)) };
            error_in_eps(if is_cosine { cosine } else { sinc }, e.numbers[2], scale)
        });
        assert!(error <= 1.0, "{name}: {error}");
    }
}

/// Doubling carries the relative error of the sinc at x = 1 on as a phase: an ulp of the sum, and one and a half (cosine and product)
/// in each of two doublings, 4 eps in all. Stated is about 1 eps, which is typical and no bound.
const DOUBLED: f64 = 4.0;

// Fails if: a sinc sum of f64 or double-double loses its highest term; TAYLOR_BOUND is 2.
#[test]
fn cosine_and_sinc_of_a_square_are_accurate() {
    cos_sinc_is_accurate::<f64>(1.0, DOUBLED);
    // Sine and cosine of the root: 2e-31, and half an ulp of the root.
    cos_sinc_is_accurate::<fx128>(2e-31 / fx128::EPSILON.0, 0.5);
}

/// The two formulas on the two sides of the switch, one ulp apart in x^2, differ by rounding only.
fn continuous_at<T: Single>(below: f64, above: T, bound: f64) {
    let (c0, s0) = T::cos_sinc(T::lit(below));
    let (c1, s1) = T::cos_sinc(above);
    let jumps = [c1 - c0, s1 - s0].map(|d| d.to_f64().abs() / T::EPSILON);
    println!("{jumps:?} eps");
    assert!(T::lit(below) < above && jumps.iter().all(|j| *j <= bound), "{jumps:?}");
}

// Fails if: the Taylor sum of the sinc of f64 has a term less.
#[test]
fn cosine_and_sinc_are_continuous_where_the_formula_changes() {
    // Between two neighbours in x^2 the functions change by less than eps / 8; one ulp each side is the rest.
    continuous_at::<f32>(SWITCH, (SWITCH as f32).next_up(), 2.0);
    continuous_at::<f64>(SWITCH, SWITCH.next_up(), 2.0);
    let above = fx128::from_f64(SWITCH) + fx128::from_f64(2.0_f64.powi(-107));
    continuous_at::<fx128>(SWITCH, above, 4.0);
}

/// Largest violation, in eps, of identities that tie the functions to each other.
fn identities<T: Single>(x: T) -> [f64; 5] {
    let (one, two) = (T::lit(1.0), T::lit(2.0));
    let (sine, cosine) = x.sin_cos();
    let (twice, _) = (x + x).sin_cos();
    let small = x / T::lit(16.0);
    let in_eps = |difference: T| difference.to_f64().abs() / T::EPSILON;
    let (s, c) = small.sin_cos();
    [
        in_eps(sine * sine + cosine * cosine - one),
        in_eps(two * sine * cosine - twice),
        in_eps(small.exp() * (-small).exp() - one),
        in_eps(small.exp().ln() - small),
        in_eps(s.atan2(c) - small),
    ]
}

// Fails if: quarters 1 and 3 of the reduction change places (double-double).
#[test]
fn functions_keep_their_identities_in_every_arithmetic() {
    fn worst<T: Single>(bound: f64) {
        let mut worst = [0.0_f64; 5];
        for i in -400..=400 {
            let found = identities(T::lit(f64::from(i) / 16.0));
            worst = std::array::from_fn(|k| worst[k].max(found[k]));
        }
        println!("{worst:?}");
        assert!(worst.iter().all(|w| *w <= bound), "{worst:?}");
    }
    // A handful of roundings of numbers below e^(25/16) = 4.8.
    worst::<f32>(4.0);
    worst::<f64>(4.0);
    // 4.06 eps of sine and cosine each enter twice; 14.2 eps of exp and ln once.
    worst::<fx128>(2.0 * 14.2);
}

fn non_finite_stays<T: Single>() {
    let nan = T::lit(f64::NAN);
    let infinite = T::lit(f64::INFINITY);
    for x in [nan, infinite, -infinite] {
        let (sine, cosine) = x.sin_cos();
        let (c, s) = T::cos_sinc(x);
        assert!(!x.is_finite() && !sine.is_finite() && !cosine.is_finite(), "{x:?}: {sine:?} {cosine:?}");
        assert!(!c.is_finite() && !s.is_finite() || x == -infinite, "{x:?}: {c:?} {s:?}");
        assert!(!x.abs().is_finite() && !x.ln().is_finite() && !x.round().is_finite(), "{x:?}");
        assert!(!x.widen().0.is_finite() && !T::narrow(x.widen()).is_finite(), "{x:?}");
    }
    assert!(!nan.exp().is_finite() && !infinite.exp().is_finite() && !nan.sqrt().is_finite());
    assert!(!infinite.sqrt().is_finite() && !T::lit(-1.0).sqrt().is_finite());
    assert!(!T::lit(-1.0).ln().is_finite() && !T::lit(0.0).ln().is_finite());
    assert!(!nan.atan2(T::lit(1.0)).is_finite() && !T::lit(1.0).atan2(nan).is_finite());
    assert!(T::lit(1.0).is_finite() && T::lit(-1e30).is_finite());
}

// Fails if: narrow takes the low part alone.
#[test]
fn non_finite_numbers_stay_so_and_nothing_panics() {
    non_finite_stays::<f32>();
    non_finite_stays::<f64>();
    non_finite_stays::<fx128>();
}

// Fails if: narrow of f32 or f64 takes the low part alone; round of double-double ignores the low part.
#[test]
fn conversions_are_exact_or_nearest() {
    let tail = fx128::from_f64(2.0_f64.powi(-70));
    let x = fx128::from_f64(1.0) + tail;
    assert_eq!((x.0, x.1), (1.0, 2.0_f64.powi(-70)));
    assert_eq!(fx128::narrow(x), x);
    assert_eq!(<f64 as Single>::narrow(x), 1.0);
    assert_eq!(0.1_f32.widen().to_f64(), f64::from(0.1_f32));
    assert_eq!(<f32 as Single>::narrow(0.7_f32.widen()), 0.7_f32);
    assert_eq!(<f64 as Single>::narrow(0.7_f64.widen()), 0.7_f64);
    let half_and_less = fx128::from_f64(2.5) - tail;
    assert_eq!(Single::round(half_and_less), fx128::from_f64(2.0));
    assert_eq!(Single::round(-half_and_less), fx128::from_f64(-2.0));
    assert_eq!(Single::round(fx128::from_f64(2.5) + tail), fx128::from_f64(3.0));
    assert_eq!(Single::round(fx128::from_f64(7.0) + tail), fx128::from_f64(7.0));
    // Half way goes away from zero; beyond 2^53 the low part is rounded by itself.
    assert_eq!(Single::round(fx128::from_f64(2.5)), fx128::from_f64(3.0));
    assert_eq!(Single::round(fx128::from_f64(-2.5)), fx128::from_f64(-3.0));
    let (large, three_quarters) = (fx128::from_f64(2.0_f64.powi(60)), fx128::from_f64(0.75));
    assert_eq!(Single::round(large + three_quarters), large + fx128::ONE);
    // The point without a direction has the angle that the standard gives it.
    assert_eq!(fx128::ZERO.atan2(fx128::ZERO), fx128::ZERO);
}

/// cos x and sin x / x for x^2 up to 1/16, on average over 64 of them: the least term of the sums, x^12 / 12! = 1.2e-16 at
/// the end, is half a rounding unit and shows in the mean, where roundings cancel.
// Fails if: the last coefficient of the cosine is left out.
#[test]
fn the_short_sums_of_f64_keep_their_last_term() {
    let mean = |part: fn((fx128, fx128), (f64, f64)) -> fx128| {
        let sum = (0..64).fold(fx128::ZERO, |sum, i| {
            let square = 0.0625 - f64::from(i) / 16384.0;
            sum + part(fx128::cos_sinc(fx128::lit(square)), f64::cos_sinc(square))
        });
        sum.to_f64().abs() / 64.0
    };
    let (cosine, sinc) = (mean(|e, c| fx128::lit(c.0) - e.0), mean(|e, c| fx128::lit(c.1) - e.1));
    // Half the mean of that term, which is 1e-16 over this stretch; roundings of 0.5 ulp = 5.5e-17 average to a seventh of it.
    assert!(cosine < 0.4e-16 && sinc < 0.4e-16, "{cosine} {sinc}");
}
