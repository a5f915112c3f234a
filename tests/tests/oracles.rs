//! Exact motions solve their own equations of motion: for every scene of the catalogue, at random times and parameters.
//!
//! The equation is the model's own rate and velocity, the derivative a difference of order eight in double-double. A scene whose
//! rate and exact motion share one wrong parameter would pass; the reference solutions are for that.

use faer::fx128;
use integrator::{Real, Single};
use proptest::prelude::*;
use scenes::any::AnyScene;
use scenes::parameters::Range;
use scenes::run::Precision;
use scenes::{all, by_id};

/// Step of the differences in natural time scales of the scene.
const STEP: f64 = 1.0 / 4096.0;

/// A motion that is analytic up to a quarter of its time scale has f^(9) <= 9! 4^9 |f|: the difference of order eight is
/// wrong by STEP^8 f^(9) / 630, and by the rounding of f, a few hundred eps of double-double over the step.
fn tolerance() -> f64 {
    362_880.0 * 4.0_f64.powi(9) / 630.0 * STEP.powi(8) + 512.0 * <fx128 as Single>::EPSILON / STEP
}

fn solves_its_equation(scene: &dyn AnyScene, fraction: f64) {
    let info = scene.scene().info();
    let (t, h) = (fraction * info.horizon_s, STEP * info.time_scale_s);
    if scene.scene().nonsmooth_times_s(info.horizon_s).iter().any(|at| (at - t).abs() <= 5.0 * h) {
        return;
    }
    let found = scene.residual(fx128::lit(t), h);
    let [q, v, rate] = found.size;
    let parameters = || format!("{} {:?} at {t}: {found:?}", scene.id(), values(scene));
    // Written so that a NaN fails.
    assert!(found.velocity <= tolerance() * (v + q / info.time_scale_s), "velocity of {}", parameters());
    assert!(found.rate <= tolerance() * (rate + v / info.time_scale_s), "rate of {}", parameters());
}

fn values(scene: &dyn AnyScene) -> Vec<(&'static str, String)> {
    scene.scene().parameters().into_iter().map(|p| (p.name, p.value)).collect()
}

/// Sets every parameter from numbers in [0, 1); false if they do not fit together.
fn randomise(scene: &mut dyn AnyScene, mut numbers: impl Iterator<Item = f64>) -> bool {
    let id = scene.id();
    for parameter in scene.scene().parameters() {
        let mut component = |_| {
            let u = numbers.next().unwrap_or(0.5);
            match parameter.range {
                Range::Finite => 4.0 * u - 2.0,
                // Between 1 and 2: three moments of inertia then always belong to a body.
                Range::Positive => 1.0 + u,
                Range::NonNegative => 2.0 * u,
                Range::HalfOpen(low, high) => low + 0.99 * (high - low) * u,
                Range::Closed(low, high) => low + (high - low) * u,
            }
        };
        let text: Vec<String> = parameter.value.split(',').map(|c| component(c).to_string()).collect();
        scene.scene_mut().set(id, parameter.name, &text.join(",")).expect("a value inside its range");
    }
    scene.scene().check().is_ok()
}

#[test]
fn default_motions_solve_their_equations_and_f64_agrees_with_double_double() {
    for scene in all() {
        for k in 1..64 {
            let fraction = f64::from(k) / 64.0;
            solves_its_equation(scene.as_ref(), fraction);
            let t = fraction * scene.scene().info().horizon_s;
            let (wide, double) = (scene.exact(fx128::lit(t)), scene.exact_in(Precision::F64, t));
            for (quantity, apart) in double.distances(&wide) {
                let scale =
                    [0.0, t].map(|t| scene.exact(fx128::lit(t)).scale(quantity)).into_iter().fold(0.0, f64::max);
                let bound = 8.0 * f64::EPSILON * scale;
                assert!(apart <= bound, "{} {} at {t}: {apart:e} > {bound:e}", scene.id(), quantity.id());
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn motions_with_random_parameters_solve_their_equations(
        numbers in prop::collection::vec(0.0..1.0_f64, 64),
        fraction in 0.01..0.99_f64,
    ) {
        for mut scene in all() {
            if randomise(scene.as_mut(), numbers.iter().copied()) {
                solves_its_equation(scene.as_ref(), fraction);
            }
        }
    }
}

#[test]
fn motions_beside_a_degeneracy_solve_their_equations() {
    let above = |x: f64, part: f64| (x * (1.0 + part)).to_string();
    // Twice w0 cos(angle / 2), the least speed that carries the default pendulum over the top from 0.5 rad.
    let over_the_top = 2.0 * (9.8125_f64 / 1.5).sqrt() * 0.25_f64.cos();
    let mut cases = Vec::new();
    for part in [-1e-7, -1e-12, 0.0, 1e-12, 1e-7] {
        cases.push(("damped-oscillator/critical", vec![("zeta", above(1.0, part))]));
        cases.push(("forced-oscillator/resonance", vec![("drive", above(2.0, part))]));
        cases.push(("forced-oscillator/resonance", vec![("drive", above(2.0, part)), ("damping", "1e-9".to_owned())]));
        cases.push(("forced-oscillator", vec![("damping", above(6.0, part))]));
        cases.push(("forced-oscillator", vec![("damping", above(3.0, part))]));
        cases.push(("pendulum/near-separatrix", vec![("omega", above(over_the_top, part))]));
    }
    for e in ["0", "1e-9", "0.99"] {
        cases.push(("kepler", vec![("eccentricity", e.to_owned())]));
        cases.push(("kepler/pericentre", vec![("eccentricity", e.to_owned())]));
    }
    cases.push(("linear-drag", vec![("drag", "1e-9".to_owned())]));
    cases.push(("quadratic-drag/rise", vec![("drag", "1e-6".to_owned())]));
    for (id, settings) in cases {
        let mut scene = by_id(id).expect("a scene of the catalogue");
        for (name, value) in &settings {
            scene.scene_mut().set(id, name, value).expect("a parameter of the scene");
        }
        for k in 1..32 {
            solves_its_equation(scene.as_ref(), f64::from(k) / 32.0);
        }
    }
}
