//! Each law is found in data built for it, with oscillation, scatter, transients and saturation, and in no other.

use super::*;
use proptest::prelude::*;

/// Uniform numbers in -1..1 (D. Knuth, *The Art of Computer Programming* 2, 1997, 3.3.4, line 26).
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut x = seed.wrapping_mul(2_862_933_555_777_941_757).wrapping_add(1);
    move || {
        x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A run to T = 1000 s of 1000 samples.
fn run(mut error: impl FnMut(f64) -> f64) -> Vec<Envelope> {
    (1..=1000).map(|i| Envelope { t_s: f64::from(i), error: error(f64::from(i)) }).collect()
}

fn law(error: impl FnMut(f64) -> f64) -> Law {
    classify(&run(error), 0.0).law
}

#[test]
fn each_law_is_found_in_its_own_data() {
    assert_eq!(law(|_| 1e-3), Law::Bounded);
    assert_eq!(law(|t| 1e-16 * t.sqrt()), Law::SqrtT);
    assert_eq!(law(|t| 1e-6 * t), Law::Linear);
    assert_eq!(law(|t| 1e-9 * t * t), Law::Quadratic);
    assert_eq!(law(|t| 1e-9 * (0.02 * t).exp()), Law::Exponential);
    assert_eq!(law(|t| if t < 700.0 { t } else { f64::NAN }), Law::Diverged);
    assert_eq!(law(|t| if t < 700.0 { t } else { f64::INFINITY }), Law::Diverged);
    assert_eq!(law(|t| t.powf(1.48)), Law::Unclassified);
    assert_eq!(classify(&run(|t| 1e-16 * (1.0 + t / 1000.0)), 1e-16).law, Law::AtTheFloor);
}

#[test]
fn exponents_and_rates_are_those_of_the_data() {
    let g = classify(&run(|t| 1e-6 * t.powf(1.1)), 0.0);
    assert!((g.exponent.expect("fitted") - 1.1).abs() < 1e-12, "{}", g.evidence);
    assert!((g.decade_ratio.expect("a decade") - 10.0_f64.powf(1.1)).abs() < 1e-12, "{}", g.evidence);
    assert!(g.misfit_ratio.expect("fitted") < 1e-6 && g.alternative.is_none());
    let g = classify(&run(|t| 1e-9 * (0.02 * t).exp()), 0.0);
    assert!((g.rate.expect("fitted") - 0.02).abs() < 1e-14, "{}", g.evidence);
    assert!(g.interval.is_some_and(|[low, high]| (low - 0.02).abs() < 1e-12 && (high - 0.02).abs() < 1e-12));
    assert!(g.misfit_ratio.expect("fitted") > 1e6);
}

/// Between laws there is no law: these exponents are as far from their neighbours as they can be.
#[test]
fn exponents_between_laws_are_not_rounded_to_one() {
    for p in [0.25, 0.75, 1.45, 2.7] {
        let g = classify(&run(|t| t.powf(p)), 0.0);
        assert_eq!((g.law, g.misfit_ratio < Some(1.0)), (Law::Unclassified, true), "{p}: {}", g.evidence);
    }
}

/// Energy under explicit Euler is (1 + h^2)^n: an error of exp(c t) - 1.
#[test]
fn exponential_growth_is_linear_as_long_as_it_is_small() {
    let growth = |c_t: f64| classify(&run(|t| (c_t * t / 1000.0).exp_m1()), 0.0).law;
    assert_eq!([growth(1e-3), growth(0.1)], [Law::Linear; 2]);
    assert_eq!([growth(10.0), growth(30.0), growth(600.0)], [Law::Exponential; 3]);
    assert!(![Law::Quadratic, Law::Bounded, Law::SqrtT].contains(&growth(2.0)));
}

/// ln(1 + error) = c t is a line to rounding, whatever c t is.
#[test]
fn the_rate_of_exponential_growth_is_measured_even_where_it_looks_linear() {
    for c in [1e-9, 1e-3, 0.1] {
        let samples: Vec<(f64, f64)> = (1..=100).map(|i| (f64::from(i), (c * f64::from(i)).exp_m1())).collect();
        let line = fit_exponential_rate(&samples).expect("a line");
        assert!((line.slope / c - 1.0).abs() < 1e-14 && line.rms < 1e-14, "{line:?}");
    }
    assert_eq!(fit_exponential_rate(&[(1.0, -2.0), (2.0, 1.0), (3.0, 1.0)]), None);
}

#[test]
fn an_oscillation_is_seen_by_its_envelope() {
    let envelope = |f: fn(f64) -> f64| running_maximum(run(f).iter().map(|s| (s.t_s, s.error)));
    assert_eq!(classify(&envelope(f64::sin), 0.0).law, Law::Bounded);
    assert_eq!(classify(&envelope(|t| (t / 50.0).sin()), 0.0).law, Law::Bounded);
    assert_eq!(classify(&envelope(|t| t * (0.3 * t).sin()), 0.0).law, Law::Linear);
    assert_eq!(classify(&envelope(|t| t * t * (0.3 * t).sin()), 0.0).law, Law::Quadratic);
    assert_eq!(classify(&envelope(|t| (0.05 * t).exp() * (0.9 * t).sin()), 0.0).law, Law::Exponential);
}

#[test]
fn a_transient_does_not_hide_the_law() {
    assert_eq!(law(|t| 1.0 - (-t / 30.0).exp()), Law::Bounded);
    assert_eq!(law(|t| 1e-3 * (1.0 + 50.0 * (-t / 20.0).exp())), Law::Bounded);
    assert_eq!(law(|t| 100.0 + t), Law::Linear, "an offset of a tenth of the end");
    assert_eq!(law(|t| 1.0 + 1e-6 * (0.05 * t).exp()), Law::Exponential);
    assert_eq!(classify(&run(|t| 1e-16 + 1e-12 * (t / 1000.0).powi(2)), 1e-15).law, Law::Quadratic);
}

#[test]
fn a_law_that_changes_within_the_decade_is_not_averaged() {
    assert_ne!(law(|t| (t / 316.0).powf(if t < 316.0 { 1.5 } else { 0.5 })), Law::Linear);
    assert_ne!(law(|t| (t / 700.0).max(1.0).powf(1.5)), Law::Bounded, "growth that sets in late");
    assert_eq!(law(|t| if t < 150.0 { 0.0 } else { t }), Law::Linear, "zeros before the growth");
}

/// t^p exp(q t / T) lies between both families. Over a decade its misfit ratio is 0.40 q / p, over the last quarter 0.55 q / p
/// (the shapes of t against ln t and of ln t against t); between 1 / 1.5 and 1.5 there is no law, beyond there is one.
#[test]
fn a_family_must_fit_clearly_better_than_the_other() {
    let between = |p: f64, q: f64| law(move |t| t.powf(p) * (q * t / 1000.0).exp());
    assert_eq!(between(1.0, 2.4), Law::Unclassified, "the exponential ahead by 1.33 in the last quarter");
    assert_eq!(between(1.0, 3.0), Law::Exponential, "by 1.66");
    assert_eq!(between(0.3, 0.525), Law::Unclassified, "the power ahead by 1 / 0.70 over the decade");
    assert_eq!(between(0.3, 0.42), Law::SqrtT, "by 1 / 0.56");
}

/// What fits next best is named as long as it fits less than three times worse.
#[test]
fn the_law_that_is_not_excluded_is_named() {
    let alternative = |p: f64, q: f64| {
        let g = classify(&run(|t| t.powf(p) * (q * t / 1000.0).exp()), 0.0);
        (g.law, g.alternative)
    };
    assert_eq!(alternative(0.45, 1.35), (Law::Exponential, Some(Law::Linear)), "ahead by 1.66");
    assert_eq!(alternative(0.0, 20.0), (Law::Exponential, None));
    assert_eq!(alternative(0.3, 0.42), (Law::SqrtT, Some(Law::Exponential)), "ahead by 1 / 0.56");
    assert_eq!(alternative(0.3, 0.525), (Law::Unclassified, Some(Law::SqrtT)), "the power fits better");
    assert_eq!(alternative(0.0, 1.0), (Law::Unclassified, Some(Law::Exponential)), "the exponential fits better");
    assert_eq!(alternative(0.0, 0.1), (Law::Bounded, None));
    assert_eq!(alternative(1.0, 0.0), (Law::Linear, None));
}

/// An exponential is one from a rise by e over the stretch on: here 0.9 q over the decade.
#[test]
fn a_rise_by_less_than_e_is_not_called_exponential() {
    assert_eq!(law(|t| (t / 1000.0).exp()), Law::Unclassified);
    assert_eq!(law(|t| (1.2 * t / 1000.0).exp()), Law::Exponential);
}

/// exp(t^2) fits an exponential twice as well as a power, but its rate is not one rate.
#[test]
fn an_exponential_keeps_its_rate_in_both_halves() {
    assert_eq!(law(|t| (10.0 * (t / 1000.0).powi(2)).exp()), Law::Unclassified);
}

/// The run does not stay where the exponential rise left it: what counts is its end.
#[test]
fn an_exponential_start_is_not_the_law_of_the_end() {
    let g = classify(&run(|t| if t < 245.0 { 0.06 * ((t - 245.0) / 10.0).exp() } else { (t / 1000.0).powi(2) }), 0.0);
    assert_eq!(g.law, Law::Quadratic, "{}", g.evidence);
}

/// Eight samples above the floor are enough, and the one before them has no part in the fit.
#[test]
fn the_last_sample_at_the_floor_is_not_fitted() {
    let samples: Vec<Envelope> = (0..10)
        .map(|k| 10.0_f64.powf(f64::from(k) / 9.0))
        .map(|t_s| Envelope { t_s, error: if t_s < 1.5 { 1e-6 } else { t_s * t_s } })
        .collect();
    let g = classify(&samples, 1e-6);
    assert_eq!(g.law, Law::Quadratic, "{}", g.evidence);
}

#[test]
fn saturation_does_not_hide_exponential_growth() {
    let saturating = |r: f64| run(move |t| 1.0 / (1.0 + 1e8 * (-r * t).exp()));
    let g = classify(&saturating(0.05), 0.0);
    assert_eq!(g.law, Law::Exponential, "{}", g.evidence);
    assert!((g.rate.expect("fitted") - 0.05).abs() < 0.001, "{}", g.evidence);
    // A power law that saturates is bounded: no instability is invented.
    assert_eq!(law(|t| (t / 100.0).min(1.0).powi(2)), Law::Bounded);
    assert_eq!(law(|t| (t / 300.0).min(1.0).powi(4)), Law::Bounded);
}

#[test]
fn too_little_data_have_no_law() {
    let linear = |n: i32, step: f64| -> Vec<Envelope> {
        (1..=n).map(|i| Envelope { t_s: 100.0 + step * f64::from(i), error: f64::from(i) }).collect()
    };
    assert_eq!(classify(&[], 0.0).law, Law::Unclassified);
    assert_eq!(classify(&linear(7, 1000.0), 0.0).law, Law::Unclassified);
    assert_eq!(classify(&linear(100, 1.0), 0.0).law, Law::Unclassified, "less than a decade");
    let mut samples = run(|t| t);
    samples.swap(3, 4);
    assert_eq!(classify(&samples, 0.0).law, Law::Unclassified);
    assert_eq!(law(|_| 0.0), Law::AtTheFloor);
    assert_eq!(law(|t| -t), Law::Diverged, "an envelope is not negative");
}

#[test]
fn the_drift_ratio_compares_the_largest_errors() {
    let samples = run(|t| t * t);
    assert_eq!(drift_ratio(&samples, 100.0), Some(100.0));
    assert_eq!(drift_ratio(&samples, 10.0), Some(100.0));
    assert_eq!(drift_ratio(&samples, 101.0), None, "the run ends at 1000 s");
    assert_eq!(drift_ratio(&samples, 0.5), None, "nothing lies before");
    assert_eq!(drift_ratio(&run(|_| 0.0), 10.0), None);
    assert_eq!(drift_ratio(&run(|t| if t < 50.0 { t } else { f64::NAN }), 10.0), None);
    assert_eq!(drift_ratio(&run(|t| if t < 5.0 { 8.0 } else { 2.0 }), 10.0), Some(1.0), "a maximum does not shrink");
}

#[test]
fn a_running_maximum_keeps_not_a_number() {
    let errors: Vec<f64> =
        running_maximum([(1.0, -2.0), (2.0, 1.0), (3.0, f64::NAN), (4.0, 5.0)]).iter().map(|s| s.error).collect();
    assert_eq!(errors[..2], [2.0, 2.0]);
    assert!(errors[2].is_nan() && errors[3].is_nan());
}

#[test]
fn laws_have_one_name_in_text_and_in_data() {
    use Law::*;
    for l in [Bounded, SqrtT, Linear, Quadratic, Exponential, AtTheFloor, Unclassified, Diverged] {
        assert_eq!(serde_json::to_string(&l).expect("a name"), format!("\"{l}\""));
    }
    for g in [classify(&run(|t| t), 0.0), classify(&run(|_| 1.0), 0.0), classify(&[], 0.0)] {
        let text = serde_json::to_string(&g).expect("plain data");
        assert_eq!(serde_json::from_str::<Growth>(&text).expect("plain data"), g);
    }
}

/// The envelope of |S_n| over 64 random walks grows as sqrt(t); its last decade scatters by about 1 / sqrt(64).
#[test]
fn a_random_walk_is_a_square_root() {
    let mut r = noise(3);
    let mut walks = [0.0_f64; 64];
    let samples = run(|_| {
        walks.iter_mut().for_each(|w| *w += r());
        (walks.iter().map(|w| w * w).sum::<f64>() / 64.0).sqrt()
    });
    let g = classify(&samples, 0.0);
    assert_eq!(g.law, Law::SqrtT, "{}", g.evidence);
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    /// Scatter of +-10 % with uniform or geometric sampling, in any unit.
    #[test]
    fn scatter_does_not_change_the_law(i in 0_usize..4, seed in 0_u64..1_000_000, ln_c in -40.0..20.0_f64, geometric: bool) {
        let laws = [Law::Bounded, Law::SqrtT, Law::Linear, Law::Quadratic];
        let p = [0.0, 0.5, 1.0, 2.0][i];
        let mut r = noise(seed);
        let samples: Vec<Envelope> = (1..=60)
            .map(|k| if geometric { 1.12_f64.powi(k) } else { f64::from(k) })
            .map(|t_s| Envelope { t_s, error: ln_c.exp() * t_s.powf(p) * (1.0 + 0.1 * r()) })
            .collect();
        let g = classify(&samples, 0.0);
        prop_assert_eq!(g.law, laws[i], "{}", g.evidence);
    }

    /// From e-fold 5 on an exponential is told from a power law, at any amplitude and with scatter of +-10 %.
    #[test]
    fn exponential_growth_is_told_from_a_power(folds in 5.0..200.0_f64, ln_a in -30.0..0.0_f64, seed in 0_u64..1_000_000) {
        let mut r = noise(seed);
        let g = classify(&run(|t| (ln_a + folds * t / 1000.0).exp() * (1.0 + 0.1 * r())), 0.0);
        prop_assert_eq!(g.law, Law::Exponential, "{}", g.evidence);
        prop_assert!((g.rate.expect("fitted") * 1000.0 / folds - 1.0).abs() < 0.1, "{}", g.evidence);
    }
}
