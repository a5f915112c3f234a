//! Special functions against tables of 36 digits, in f64 and in double-double.
//!
//! Errors are counted in eps of the arithmetic. The bounds are rounding-error counts: a sum or product of positive terms
//! is off by half an eps an operation at most, and its last operations weigh most: 2 eps for an elementary function (an
//! exponential or a series, one division, one product), 4 for a Carlson integral, 5 for a sum of two. The Jacobi
//! functions in f64 are double-double ones rounded: half an eps. Where the question itself is ill conditioned, the
//! condition number appears in the error's scale. Kummer's function at |z| = 6 has summed terms of 65 times its size.

use faer::fx128;
use integrator::real::Single;
use nalgebra::Complex;
use scenes::special::{carlson, elementary, elliptic, jacobi, kepler, kummer};
use verification::table::{self, Entry};

/// |value - truth| / (eps |scale|), infinite for NaN.
fn error_in_eps<T: Single>(value: T, truth: fx128, scale: fx128) -> f64 {
    let error = (value.widen() - truth).0.abs() / (T::EPSILON * scale.0.abs());
    match (error.is_nan(), value.widen() == truth) {
        (_, true) => 0.0,
        (true, _) => f64::INFINITY,
        (false, _) => error,
    }
}

fn relative<T: Single>(value: T, truth: fx128) -> f64 {
    error_in_eps(value, truth, truth)
}

/// The largest error of each function of a table, printed, and checked against its bound.
fn check(table: &str, bound: f64, error: impl Fn(&Entry) -> f64) {
    let mut worst: Vec<(String, f64, Vec<f64>)> = Vec::new();
    for entry in table::load(table) {
        let found = error(&entry);
        match worst.iter_mut().find(|(name, ..)| *name == entry.function) {
            Some(line) if line.1 >= found => {}
            Some(line) => (line.1, line.2) = (found, entry.arguments),
            None => worst.push((entry.function, found, entry.arguments)),
        }
    }
    for (name, error, at) in &worst {
        println!("{table} {name}: {error:.2} eps (bound {bound}) at {at:?}");
    }
    assert!(worst.iter().all(|(_, error, _)| *error <= bound), "{table}: beyond {bound} eps: {worst:?}");
}

fn elementary_error<T: Single>(entry: &Entry) -> f64 {
    let x = T::lit(entry.arguments[0]);
    let value = match entry.function.as_str() {
        "expm1" => elementary::expm1(x),
        "log1p" => elementary::log1p(x),
        "x_minus_sin" => elementary::x_minus_sin(x),
        "sinh" => elementary::sinh(x),
        "cosh" => elementary::cosh(x),
        "sech" => elementary::sech(x),
        "tanh" => elementary::tanh(x),
        "asinh" => elementary::asinh(x),
        "atan" => elementary::atan(x),
        "asin" => elementary::asin(x),
        other => panic!("no function {other:?}"),
    };
    relative(value, entry.numbers[1])
}

fn carlson_error<T: Single>(entry: &Entry) -> f64 {
    let [x, y, z, p] = [0, 1, 2, 3].map(|i| T::lit(entry.arguments[i]));
    let value = match entry.function.as_str() {
        "rf" => carlson::rf(x, y, z),
        "rc" => carlson::rc(x, y),
        "rd" => carlson::rd(x, y, z),
        "rj" => carlson::rj(x, y, z, p),
        other => panic!("no function {other:?}"),
    };
    relative(value, entry.numbers[4])
}

fn elliptic_error<T: Single>(entry: &Entry) -> f64 {
    let [phi, nc, mc] = [0, 1, 2].map(|i| T::lit(entry.arguments[i]));
    let value = match entry.function.as_str() {
        "complete_f" => elliptic::complete_f(mc),
        "complete_e" => elliptic::complete_e(mc),
        "complete_pi" => elliptic::complete_pi(nc, mc),
        "f" => elliptic::f(phi, mc),
        "e" => elliptic::e(phi, mc),
        "pi" => elliptic::pi(nc, phi, mc),
        other => panic!("no function {other:?}"),
    };
    relative(value, entry.numbers[3])
}

#[test]
fn elementary_functions_keep_the_full_precision_of_f64() {
    check("elementary", 2.0, elementary_error::<f64>);
}

#[test]
fn elementary_functions_keep_the_full_precision_of_double_double() {
    check("elementary", 2.0, elementary_error::<fx128>);
}

#[test]
fn carlson_integrals_are_good_to_a_few_eps_in_f64() {
    check("carlson", 4.0, carlson_error::<f64>);
}

#[test]
fn carlson_integrals_are_good_to_a_few_eps_in_double_double() {
    check("carlson", 4.0, carlson_error::<fx128>);
}

#[test]
fn legendre_integrals_are_good_to_a_few_eps_in_f64() {
    check("elliptic", 5.0, elliptic_error::<f64>);
}

#[test]
fn legendre_integrals_are_good_to_a_few_eps_in_double_double() {
    check("elliptic", 5.0, elliptic_error::<fx128>);
}

/// Relative errors of sn, cn, dn and am, each divided by 1 + |u|'s condition number (the phase has an error of eps |u|
/// in double-double; in f64 it has none).
fn jacobi_error<T: Single>(entry: &Entry) -> [f64; 4] {
    let [u, mc] = [0, 1].map(|i| entry.arguments[i]);
    let truth = &entry.numbers;
    let jacobi::Jacobi { sn, cn, dn } = jacobi::jacobi(T::lit(u), mc);
    let am = jacobi::am(T::lit(u), mc);
    let [s, c, d, a] = [truth[2].0, truth[3].0, truth[4].0, truth[5].0];
    let phase = |condition: f64| 1.0 + u.abs() * condition * fx128::EPSILON.0 / T::EPSILON;
    [
        relative(sn, truth[2]) / phase((c * d / s).abs()),
        relative(cn, truth[3]) / phase((s * d / c).abs()),
        relative(dn, truth[4]) / phase(((1.0 - mc) * s * c / d).abs()),
        relative(am, truth[5]) / phase((d / a).abs()),
    ]
}

fn worst_of(errors: [f64; 4]) -> f64 {
    errors.into_iter().fold(0.0, f64::max)
}

#[test]
fn jacobi_functions_are_relatively_accurate_in_f64() {
    for i in 0..4 {
        check("jacobi", 0.75, |entry| jacobi_error::<f64>(entry)[i]);
    }
}

#[test]
fn jacobi_functions_are_relatively_accurate_in_double_double() {
    check("jacobi", 4.0, |entry| worst_of(jacobi_error::<fx128>(entry)));
}

/// dE/dM = 1 / (1 - e cos E). M is exact and reduced in double-double: errors of eps of the reduced M in the arithmetic, and
/// of eps |M| in double-double.
fn kepler_error<T: Single>(entry: &Entry) -> f64 {
    let [mean, e] = [0, 1].map(|i| entry.arguments[i]);
    let truth = entry.numbers[2];
    let found = kepler::eccentric_anomaly(fx128::from_f64(mean), T::lit(e));
    let reduced = (truth.0 - e * truth.0.sin()).abs() + mean.abs() * fx128::EPSILON.0 / T::EPSILON;
    let condition = if truth.0 == 0.0 { 0.0 } else { reduced / (truth.0 * (1.0 - e * truth.0.cos())).abs() };
    relative(found.angle, truth) / (1.0 + condition)
}

#[test]
fn keplers_equation_is_solved_to_its_conditioning() {
    check("kepler", 1.0, kepler_error::<f64>);
    check("kepler", 1.0, kepler_error::<fx128>);
}

#[test]
fn kummers_function_keeps_its_digits_far_beyond_its_series() {
    check("kummer", 64.0, |entry| {
        let [a_re, a_im, b, z_re, z_im] = [0, 1, 2, 3, 4].map(|i| fx128::from_f64(entry.arguments[i]));
        let found = kummer::hypergeometric_1f1(Complex::new(a_re, a_im), b, Complex::new(z_re, z_im));
        let truth = &entry.numbers[5..9];
        let scale = truth.iter().fold(0.0_f64, |most, x| most.max(x.0.abs()));
        let parts = [found.value.re, found.value.im, found.derivative.re, found.derivative.im];
        let errors = std::array::from_fn(|i| error_in_eps(parts[i], truth[i], fx128::from_f64(scale)));
        worst_of(errors) / (1.0 + z_re.0.hypot(z_im.0))
    });
}
