//! Special functions against their own identities, at random and nearly degenerate arguments, in double-double.

use faer::fx128;
use integrator::real::{Real, Single};
use nalgebra::Complex;
use proptest::prelude::*;
use scenes::special::jacobi::{Jacobi, Modulus, am, jacobi};
use scenes::special::kepler::eccentric_anomaly;
use scenes::special::kummer::hypergeometric_1f1;
use scenes::special::{elementary, elliptic};
use verification::derivative;

const EPS: f64 = <fx128 as Single>::EPSILON;

fn dd(x: f64) -> fx128 {
    fx128::from_f64(x)
}

/// |x|, infinite for NaN, so that a comparison with a bound fails.
fn size(x: fx128) -> f64 {
    if x.is_finite() { x.0.abs() } else { f64::INFINITY }
}

/// mc from 1e-25 to 1, and the circular limit itself.
fn parameter() -> impl Strategy<Value = f64> {
    prop_oneof![8 => (-25.0..0.0_f64).prop_map(|p| 10.0_f64.powf(p)), 1 => 0.5..1.0, 1 => Just(1.0)]
}

fn argument() -> impl Strategy<Value = f64> {
    prop_oneof![-30.0..30.0, -1e6..1e6, -1e-8..1e-8, Just(0.0)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn jacobi_functions_satisfy_both_quadratic_identities(u in argument(), mc in parameter()) {
        let Jacobi { sn, cn, dn } = jacobi(dd(u), mc);
        prop_assert!(size(sn * sn + cn * cn - dd(1.0)) <= 4.0 * EPS);
        // Relative, as dn^2 may be as small as mc.
        prop_assert!(size((cn * cn + dd(mc) * sn * sn) / (dn * dn) - dd(1.0)) <= 16.0 * EPS);
    }

    /// sn(u + v) = (sn u cn v dn v + sn v cn u dn u) / (1 - m sn^2 u sn^2 v), DLMF 22.8.1; the denominator is
    /// cn^2 u + sn^2 u dn^2 v, where nothing cancels.
    #[test]
    fn jacobi_functions_add(u in -8.0..8.0_f64, v in -8.0..8.0_f64, mc in parameter()) {
        let (a, b, sum) = (jacobi(dd(u), mc), jacobi(dd(v), mc), jacobi(dd(u) + dd(v), mc));
        let below = a.cn * a.cn + a.sn * a.sn * b.dn * b.dn;
        let sn = a.sn * b.cn * b.dn + b.sn * a.cn * a.dn;
        let cn = a.cn * b.cn - a.sn * b.sn * a.dn * b.dn;
        // The numerators cancel down to `below`, of which the errors are relative.
        let bound = 64.0 * EPS / below.0;
        prop_assert!(size(sn / below - sum.sn) <= bound, "{:?}", sn / below - sum.sn);
        prop_assert!(size(cn / below - sum.cn) <= bound, "{:?}", cn / below - sum.cn);
    }

    /// am' = dn: h = 2^-10, derivatives of am of order 9 below 5000 (0 < m <= 1): 2^-80 * 5000 / 630, and rounding 4 eps |am| / h.
    #[test]
    fn the_amplitude_has_the_slope_dn(u in -1000.0..1000.0_f64, mc in parameter()) {
        let [slope] = derivative(2.0_f64.powi(-10), |h| [am(dd(u) + h, mc)]);
        let error = size(slope - jacobi(dd(u), mc).dn);
        prop_assert!(error <= 8.0 * 2.0_f64.powi(-80) + 4096.0 * EPS * (1.0 + u.abs()), "{error:e}");
    }

    #[test]
    fn the_amplitude_inverts_the_first_integral(u in -40.0..40.0_f64, mc in parameter()) {
        // dF = dam / dn: the rounding of am is magnified by 1 / dn.
        let Jacobi { dn, .. } = jacobi(dd(u), mc);
        let back = elliptic::f(am(dd(u), mc), dd(mc));
        let bound = 8.0 * EPS * (1.0 + u.abs()) * (1.0 + u.abs() / dn.0);
        prop_assert!(size(back - dd(u)) <= bound, "{:?}", back - dd(u));
    }

    /// E K' + E' K - K K' = pi / 2, DLMF 19.7.1, with m' = mc and mc' = m = 1 - mc in double-double.
    #[test]
    fn complete_integrals_satisfy_legendres_relation(mc in 1e-6..0.999_999_f64) {
        let (mc, m) = (dd(mc), dd(1.0) - dd(mc));
        let (k, e) = (elliptic::complete_f(mc), elliptic::complete_e(mc));
        let (k_other, e_other) = (elliptic::complete_f(m), elliptic::complete_e(m));
        let error = e * k_other + e_other * k - k * k_other - fx128::PI * dd(0.5);
        prop_assert!(size(error) <= 16.0 * EPS * (1.0 + (k * k_other).0), "{error:?}");
        prop_assert!(size(Modulus::new(mc).quarter_period() / k - dd(1.0)) <= 8.0 * EPS);
    }

    /// d Pi / d phi = 1 / ((1 - n s^2) sqrt(1 - m s^2)) and dE / d phi = sqrt(1 - m s^2).
    #[test]
    fn integrals_have_their_integrands_as_slopes(phi in -20.0..20.0_f64, nc in 0.25..3.0_f64, mc in 0.1..1.0_f64) {
        let (s, c) = dd(phi).sin_cos();
        let d = Real::sqrt(c * c + dd(mc) * s * s);
        let characteristic = c * c + dd(nc) * s * s;
        let h = 2.0_f64.powi(-11);
        // The integrands vary on the scale of the nearer zero of d or 1 - n s^2: at least 0.3, so 9th derivatives are below 9!/0.3^9.
        let bound = h.powi(8) * 362_880.0 / 0.3_f64.powi(9) / 630.0 + 1e-26;
        let [slope] = derivative(h, |x| [elliptic::pi(dd(nc), dd(phi) + x, dd(mc))]);
        prop_assert!(size(slope - dd(1.0) / (characteristic * d)) <= 30.0 * bound, "{:?} {bound:e}", slope - dd(1.0) / (characteristic * d));
        let [slope] = derivative(h, |x| [elliptic::e(dd(phi) + x, dd(mc))]);
        prop_assert!(size(slope - d) <= 30.0 * bound, "{:?}", slope - d);
    }

    #[test]
    fn kepler_solutions_satisfy_the_equation(mean in -3.1..3.1_f64, e in 0.0..0.99_f64) {
        let found = eccentric_anomaly(dd(mean), dd(e));
        let error = found.angle - dd(e) * found.sine - dd(mean);
        prop_assert!(size(error) <= 8.0 * EPS * (1.0 + found.angle.0.abs()), "{error:?}");
        let coarse = eccentric_anomaly(dd(mean), e);
        let (sine, slope) = (found.sine.0, 1.0 - e * found.cosine.0);
        let bound = f64::EPSILON * (found.angle.0.abs() + mean.abs() / slope);
        prop_assert!(size(coarse.angle.widen() - found.angle) <= bound, "sine {sine}");
    }

    /// 1F1(p; 1/2; Z) and s 1F1(p + 1/2; 3/2; Z), Z = i s^2 / 2, solve one equation of Wronskian e^Z: f g' - f' g = e^Z.
    #[test]
    fn kummer_functions_keep_their_wronskian(p in 0.0..2.0_f64, s in 0.05..24.0_f64) {
        let (p, i) = (Complex::new(fx128::ZERO, dd(p)), Complex::new(fx128::ZERO, fx128::ONE));
        let real = |x: f64| Complex::new(dd(x), fx128::ZERO);
        let z = i * real(s) * real(s) * real(0.5);
        let even = hypergeometric_1f1(p, dd(0.5), z);
        let odd = hypergeometric_1f1(p + real(0.5), dd(1.5), z);
        let z_rate = i * real(s);
        let (f, f_rate, g) = (even.value, even.derivative * z_rate, odd.value * real(s));
        let g_rate = odd.value + odd.derivative * z_rate * real(s);
        let (sine, cosine) = z.im.sin_cos();
        let error = f * g_rate - f_rate * g - Complex::new(cosine, sine);
        // 64 eps (1 + |z|) in each factor, which are of size s and more at the larger p.
        let scale = 1.0 + (f.norm_sqr() * g_rate.norm_sqr()).0.sqrt() + (f_rate.norm_sqr() * g.norm_sqr()).0.sqrt();
        prop_assert!(size(error.re) + size(error.im) <= 128.0 * EPS * (1.0 + z.im.0) * scale, "{error:?}");
        // (a / b) 1F1(a + 1; b + 1; z), by its own series, is the derivative.
        let next = hypergeometric_1f1(p + real(1.0), dd(1.5), z).value * (p + p);
        let error = next - even.derivative;
        let scale = 1.0 + next.norm_sqr().0.sqrt() + f.norm_sqr().0.sqrt();
        prop_assert!(size(error.re) + size(error.im) <= 128.0 * EPS * (1.0 + z.im.0) * scale, "{error:?}");
    }

    #[test]
    fn hyperbolic_functions_invert_each_other(x in prop_oneof![-300.0..300.0_f64, -1e-10..1e-10_f64]) {
        let back = elementary::asinh(elementary::sinh(dd(x)));
        prop_assert!(size(back - dd(x)) <= 16.0 * EPS * x.abs(), "{back:?}");
        let back = elementary::log1p(elementary::expm1(dd(x.min(1.0) / 300.0)));
        prop_assert!(size(back - dd(x.min(1.0) / 300.0)) <= 16.0 * EPS * (x / 300.0).abs(), "{back:?}");
    }
}

#[test]
fn nearest_integers_of_double_doubles_look_at_the_low_part() {
    let rounded = |high: f64, low: f64| Single::round(dd(high) + dd(low));
    assert_eq!([-1e-20, 0.0, 1e-20].map(|low| rounded(0.5, low).0), [0.0, 1.0, 1.0]);
    assert_eq!(rounded(-2.5, 1e-20), dd(-2.0));
    assert_eq!(rounded(2f64.powi(60), -0.75), dd(2f64.powi(60)) - dd(1.0));
}

#[test]
fn what_is_not_finite_stays_not_finite() {
    assert!(jacobi(f64::NAN, 0.5).sn.is_nan() && jacobi(1.0_f64, f64::NAN).sn.is_nan());
    assert!(elliptic::pi(0.5, f64::NAN, 0.5).is_nan() && elliptic::complete_f(f64::NAN).is_nan());
    assert!(eccentric_anomaly(dd(f64::NAN), 0.5_f64).angle.is_nan() && elementary::expm1(f64::NAN).is_nan());
}
