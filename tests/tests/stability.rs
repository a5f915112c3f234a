//! Stability limits: values of theory against amplification matrices and running scenes, and controls that must fail.

use integrator::methods::MethodId;
use reports::Verdict;
use scenes::any::AnyScene;
use scenes::run::Precision;
use scenes::theory::StabilityLimit;

use measure::stability::answer::substeps;
use measure::stability::failure::{Failure, Signal};
use measure::stability::maps::{DAMPED, boundary_distance};
use measure::stability::models::Scheme;
use measure::stability::spin::{FACTOR_TOLERANCE, SpinScheme};
use measure::stability::trend::{Trend, samples, trend};
use measure::stability::{Stability, amplification, claims, limits};
use measure::study::{Selection, Study};
use measure::sweep::Progress;
use scenes::stepping::Stepping;

fn scene(id: &str) -> Box<dyn AnyScene> {
    scenes::by_id(id).expect("a scene of the catalogue")
}

fn limit_of(id: &str, method: MethodId) -> StabilityLimit {
    let scene = scene(id);
    let stepping = Stepping { scene: scene.as_ref(), method, precision: Precision::F64 };
    amplification::limit(&stepping).expect("a linear scene")
}

/// The limit in natural time scales of the scene.
fn scaled(id: &str, method: MethodId) -> f64 {
    match limit_of(id, method) {
        StabilityLimit::Below(h) => h / scene(id).scene().info().time_scale_s,
        other => panic!("{other:?}"),
    }
}

/// Where two eigenvalues meet, their error is the root of a rounding and the limit's is its square: 1e-14, and 1e-5 of slack
/// of the rounding threshold where the radius leaves 1 with a high power of the step.
const MATRIX: f64 = 1e-9;

#[test]
fn limits_of_the_oscillator_are_two_and_the_root_of_eight() {
    for (method, value) in
        [(MethodId::SemiImplicitEuler, 2.0), (MethodId::VelocityVerlet, 2.0), (MethodId::Rk4, 8.0_f64.sqrt())]
    {
        let limit = scaled("oscillator", method);
        assert!((limit - value).abs() < MATRIX, "{}: {limit}", method.id());
    }
    assert_eq!(limit_of("oscillator", MethodId::ExplicitEuler), StabilityLimit::NoStep);
    assert_eq!(limit_of("oscillator", MethodId::ImplicitMidpoint), StabilityLimit::Unlimited);
}

#[test]
fn limits_of_linear_drag_are_two_and_rk4s_real_axis() {
    for (method, value) in [(MethodId::ExplicitEuler, 2.0), (MethodId::Rk4, 2.785_293_563_405_282)] {
        let limit = scaled("linear-drag", method);
        // RK4's R comes back to +1, which the positions have too: told from it only by amplification::NEUTRAL, |R'| > 1/2.
        assert!((limit - value).abs() < 2.0 * amplification::NEUTRAL, "{}: {limit}", method.id());
    }
}

#[test]
fn the_chain_is_limited_by_its_stiffest_mode() {
    let chain = scenes::SpringChain::default();
    let n = chain.x0.len() as f64;
    let stiffest = (chain.stiffness / chain.mass).sqrt() * (n * std::f64::consts::PI / (2.0 * (n + 1.0))).sin();
    let StabilityLimit::Below(h) = limit_of("spring-chain", MethodId::SemiImplicitEuler) else { panic!("has a limit") };
    assert!((h * stiffest - 1.0).abs() < MATRIX, "{}", h * stiffest);
}

#[test]
fn damping_lowers_the_limit_taken_explicitly_and_raises_it_taken_implicitly() {
    for zeta in [0.0, 0.125, 0.5, 1.0, 1.5] {
        let root = f64::hypot(1.0, zeta);
        for (scheme, value) in [
            (Scheme::Listed(MethodId::SemiImplicitEuler), 2.0 * (root - zeta)),
            (Scheme::ImplicitDamping, 2.0 * (root + zeta)),
        ] {
            assert!((scheme.limit(zeta) - value).abs() < 1e-12);
            // Half a per cent beyond, the spectral radius exceeds 1 by the root of it at least where zeta is small.
            assert!(scheme.holds(zeta, 0.995 * value), "{} zeta = {zeta}", scheme.id());
            assert!(!scheme.holds(zeta, 1.005 * value), "{} zeta = {zeta}", scheme.id());
        }
    }
    assert!((Scheme::Listed(MethodId::Rk4).limit(0.0) - 8.0_f64.sqrt()).abs() < 1e-4);
}

#[test]
fn measured_brackets_contain_theory() {
    for (id, method) in [
        ("oscillator", MethodId::VelocityVerlet),
        ("damped-oscillator", MethodId::ExplicitEuler),
        ("linear-drag", MethodId::Rk4),
        ("charged-particle", MethodId::Rk4),
    ] {
        for precision in [Precision::F32, Precision::F64] {
            let scene = scene(id);
            let stepping = Stepping { scene: scene.as_ref(), method, precision };
            let theory = limit_of(id, method);
            let measure::stability::bisect::Found::Bracket { low_s, high_s } = limits::measure(&stepping, theory)
            else {
                panic!("{id}: no bracket")
            };
            let StabilityLimit::Below(h) = theory else { panic!("{id}: no limit") };
            let slack = 8.0 * precision.epsilon() * h;
            assert!(low_s - slack <= h && h <= high_s + slack, "{id}: {low_s} .. {high_s}, theory {h}");
            assert!(high_s - low_s < 0.01 * high_s);
        }
    }
}

#[test]
fn non_linear_scenes_have_no_amplification_matrix() {
    for id in ["pendulum", "kepler", "quadratic-drag/fall", "bouncing-ball", "torque-free-spin"] {
        let scene = scene(id);
        let stepping = Stepping { scene: scene.as_ref(), method: MethodId::Rk4, precision: Precision::F64 };
        assert!(amplification::matrix(&stepping, 0.125).is_none(), "{id}");
    }
}

#[test]
fn nutation_factors_of_a_disc_and_a_rod() {
    for scheme in SpinScheme::ALL {
        for (rho, theta) in [(2.0, 1.0), (0.25, 1.0), (1.5, 0.3)] {
            let (measured, theory) = (scheme.measured(rho, theta), scheme.theory(rho, theta));
            assert!((measured / theory - 1.0).abs() < FACTOR_TOLERANCE, "{}: {measured} {theory}", scheme.id());
        }
    }
    // A disc at one radian a step, x = 1: the square root of two, and its inverse.
    assert!((SpinScheme::BodySemiImplicit.theory(2.0, 1.0) - 2.0_f64.sqrt()).abs() < 1e-15);
    assert!((SpinScheme::BodyImplicit.theory(2.0, 1.0) - 0.5_f64.sqrt()).abs() < 1e-15);
}

/// The measured map, and theory with the sign of zeta turned round.
#[test]
fn a_wrong_theory_is_caught_by_the_map() {
    let scheme = Scheme::Listed(MethodId::SemiImplicitEuler);
    let grid = DAMPED.coarse();
    let cells: Vec<(f64, f64, bool)> = (0..grid.ny)
        .flat_map(|j| (0..grid.nx).map(move |i| (grid.x_at(i), grid.y_at(j))))
        .map(|(h, zeta)| (h, zeta, scheme.holds(zeta, h)))
        .collect();
    let right = boundary_distance(&cells, &grid, |zeta| scheme.limit(zeta));
    let wrong = boundary_distance(&cells, &grid, |zeta| 2.0 * (zeta.hypot(1.0) + zeta));
    assert!(right <= claims::ONE_CELL, "{right}");
    assert!(wrong > 3.0 * claims::ONE_CELL, "{wrong}");
}

#[test]
fn growth_is_told_from_a_transient_a_drift_and_a_decay() {
    let of = |size: &dyn Fn(f64) -> f64| {
        let sizes: Vec<(u64, f64)> = samples(16).into_iter().map(|n| (n, size(n as f64))).collect();
        trend(&sizes)
    };
    assert_eq!(of(&|n| 1.0 + (0.7 * n).sin().abs()), Some(Trend::Bounded));
    assert_eq!(of(&|n| 1e6 - (1e6 - 1.0) * (-0.01 * n).exp()), Some(Trend::Bounded));
    assert_eq!(of(&|n| 1.0 + n), Some(Trend::Power));
    assert_eq!(of(&|n| (-0.001 * n).exp()), Some(Trend::Bounded));
    assert_eq!(of(&|n| (1e-4 * n).exp()), Some(Trend::Exponential));
    assert_eq!(of(&|n| 1.0 + 1e-30 * (0.01 * n).exp()), Some(Trend::Exponential));
}

#[test]
fn kinds_of_failure_are_told_apart() {
    let exponential: Vec<(u64, f64)> = (0..2000).map(|n| (n, 1.1_f64.powi(n as i32))).collect();
    assert_eq!(Failure::of_growth(&exponential), Failure::ExponentialGrowth);
    let squaring: Vec<(u64, f64)> = (0..40).map(|n| (n, 1.5_f64.powf(1.3_f64.powi(n as i32)))).collect();
    assert_eq!(Failure::of_growth(&squaring), Failure::FiniteTimeBlowUp);
    let of = |numeric: &dyn Fn(f64) -> f64, exact: &dyn Fn(f64) -> f64, turn_per_step: f64, unsolved: bool| {
        let values = |f: &dyn Fn(f64) -> f64| (0..200).map(|i| f(f64::from(i))).collect::<Vec<f64>>();
        Failure::of_signal(&Signal { numeric: &values(numeric), exact: &values(exact), turn_per_step, unsolved })
    };
    assert_eq!(of(&f64::cos, &f64::cos, 1.0, false), Failure::None);
    assert_eq!(of(&|t| (0.7 * t).cos(), &f64::cos, 1.0, false), Failure::WrongFrequency);
    assert_eq!(of(&|t| (0.7 * t).cos(), &|t| (4.0 * t).cos(), 4.0, false), Failure::Aliasing);
    let alternating = |t: f64| (-0.1 * t).exp() * (std::f64::consts::PI * t).cos();
    assert_eq!(of(&alternating, &|t| (-0.1 * t).exp(), 0.0, false), Failure::OscillatingDecay);
    assert_eq!(of(&f64::cos, &f64::cos, 1.0, true), Failure::NewtonNotConverging);
    assert_eq!(Failure::of_axis(&[1.0, 0.3, -0.9]), Failure::FlippedAxis);
    assert_eq!(Failure::of_axis(&[1.0, 0.3, 0.9]), Failure::None);
    let drift: Vec<(f64, f64)> = (1..=100).map(|i| (f64::from(i), 1e-4 * f64::from(i))).collect();
    assert_eq!(Failure::of_invariant(&drift), Failure::Drift);
    let bounded: Vec<(f64, f64)> = (1..=100).map(|i| (f64::from(i), 1e-4 * f64::from(i).sin())).collect();
    assert_eq!(Failure::of_invariant(&bounded), Failure::None);
    assert_eq!(Failure::of_order(3.05, 4.0), Failure::OrderLost);
    assert_eq!(Failure::of_order(3.9, 4.0), Failure::None);
}

#[test]
fn substeps_are_the_fewest_that_are_stable() {
    assert_eq!(substeps(1.0, 2.0), Some(1));
    assert_eq!(substeps(2.0, 2.0), Some(1));
    assert_eq!(substeps(2.1, 2.0), Some(2));
    assert_eq!(substeps(1.0, 0.0), None);
    assert_eq!(substeps(1.0, f64::INFINITY), Some(1));
}

#[test]
fn every_claim_of_a_quick_study_holds() {
    let selection = Selection {
        scenes: scenes::all(),
        methods: MethodId::ALL.to_vec(),
        schemes: Vec::new(),
        precisions: vec![Precision::F64],
        steps: Vec::new(),
        length: None,
        quick: true,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    };
    let rows = Stability::measure(&selection);
    let broken: Vec<_> = Stability::claims(&rows).into_iter().filter(|claim| claim.verdict != Verdict::Holds).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    // A limit that is doubled breaks the claims about it.
    let mut wrong = rows;
    wrong.retain(|row| row.low.is_some() && row.high.is_some() && row.theory.is_some());
    for row in &mut wrong {
        row.theory = row.theory.map(|limit| 2.0 * limit);
        row.closed_form = None;
    }
    let claims = Stability::claims(&wrong);
    let kept: Vec<_> = claims.iter().filter(|claim| claim.verdict != Verdict::Broken).collect();
    assert!(!claims.is_empty() && kept.is_empty(), "{kept:#?}");
}

fn lightly_damped(zeta: &str) -> Box<dyn AnyScene> {
    let mut scene = scene("damped-oscillator");
    for (name, value) in [("mass", "1"), ("stiffness", "150"), ("zeta", zeta)] {
        scene.scene_mut().set("damped-oscillator", name, value).expect("a value of the range");
    }
    scene
}

// |1 + h l|^2 = 1 - 2 zeta z + z^2: explicit Euler is stable up to z = 2 zeta, and just beyond grows by next to nothing per step.
// Fails if: a run of 2^14 steps decides whatever its growth (0.0243 for 0.0204); the ladder of theory ends at z = 0.002.
#[test]
fn light_damping_is_judged_by_runs_as_long_as_its_growth_needs() {
    for (text, zeta) in [("0.0102", 0.0102), ("0.004", 0.004)] {
        let spring = lightly_damped(text);
        for precision in [Precision::F32, Precision::F64] {
            let stepping = Stepping { scene: spring.as_ref(), method: MethodId::ExplicitEuler, precision };
            let theory = amplification::limit(&stepping).expect("linear");
            let trial = limits::Trial::of(&stepping, theory);
            let measure::stability::bisect::Found::Bracket { low_s, high_s } = limits::measure(&stepping, theory)
            else {
                panic!("zeta = {zeta}: no bracket")
            };
            let [low, high] = [low_s, high_s].map(|h| h * 150.0_f64.sqrt() / (2.0 * zeta));
            println!("zeta = {zeta} {precision:?}: {low} .. {high} {trial:?}");
            assert!(
                low <= 1.0 + limits::UNSEEN * trial.width && 1.0 <= high,
                "zeta = {zeta}: {low} .. {high}, {trial:?}"
            );
            assert!(high / low - 1.0 <= 2.0 * trial.width && trial.sees, "zeta = {zeta}: {low} .. {high}, {trial:?}");
        }
    }
    for zeta in ["0.0001", "0.00001"] {
        let spring = lightly_damped(zeta);
        let stepping = Stepping { scene: spring.as_ref(), method: MethodId::ExplicitEuler, precision: Precision::F64 };
        let Some(StabilityLimit::Below(h)) = amplification::limit(&stepping) else { panic!("zeta = {zeta}: a limit") };
        let expected = 2.0 * zeta.parse::<f64>().expect("a number") / 150.0_f64.sqrt();
        // The determinant misses 1 by 1e-24 of its terms at most, beside 2 zeta z = 8e-10 of it.
        assert!((h / expected - 1.0).abs() < 1e-11, "zeta = {zeta}: {h} {expected}");
        assert!(!limits::Trial::of(&stepping, StabilityLimit::Below(h)).sees, "no run shows growth of zeta^2 per step");
    }
}
