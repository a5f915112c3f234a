//! Steps of unequal length: patterns that repeat, and steps drawn at random.

use integrator::methods::MethodId;
use measure::stability::frames::{jitter, pattern};
use scenes::any::AnyScene;
use scenes::run::Precision;
use scenes::stepping::Stepping;
use verification::programs::{program, text};

/// m = 1 kg, k = omega^2.
fn spring(omega: f64) -> Box<dyn AnyScene> {
    let mut scene = scenes::by_id("oscillator").expect("a scene");
    for (name, value) in [("mass", 1.0), ("stiffness", omega * omega)] {
        scene.scene_mut().set("oscillator", name, &value.to_string()).expect("an allowed value");
    }
    scene
}

fn stepping(scene: &dyn AnyScene, method: MethodId) -> Stepping<'_> {
    Stepping { scene, method, precision: Precision::F64 }
}

/// M(h) of semi-implicit Euler on x'' = -w^2 x, for (x, v).
fn semi_implicit(w: f64, h: f64) -> [[f64; 2]; 2] {
    [[1.0 - h * h * w * w, h], [-h * w * w, 1.0]]
}

fn times(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

/// The largest |lambda| of a matrix of determinant 1.
fn radius(m: [[f64; 2]; 2]) -> f64 {
    let half = 0.5 * (m[0][0] + m[1][1]).abs();
    if half <= 1.0 { 1.0 } else { half + (half * half - 1.0).sqrt() }
}

// Fails if: the product is taken of other steps, or a pattern is judged by its steps alone.
#[test]
fn a_pattern_has_the_spectral_radius_of_its_product() {
    for (w, frames) in [(10.0, [0.05, 0.19]), (14.5, [0.05, 0.13]), (3.0, [0.1, 0.2]), (11.0, [0.16, 0.02])] {
        let scene = spring(w);
        let found = pattern(&stepping(scene.as_ref(), MethodId::SemiImplicitEuler), &frames).expect("linear steps");
        let theory = radius(times(semi_implicit(w, frames[1]), semi_implicit(w, frames[0])));
        assert!((found.factor / theory - 1.0).abs() < 1e-7, "{w} {frames:?}: {} {theory}", found.factor);
        assert_eq!(found.is_stable, theory == 1.0, "{w} {frames:?}");
    }
    // h w = 0.725 and 1.885: each is below 2, and together they are not stable.
    let scene = spring(14.5);
    let method = stepping(scene.as_ref(), MethodId::SemiImplicitEuler);
    let alone = [0.05, 0.13].map(|h| pattern(&method, &[h]).expect("linear steps").is_stable);
    assert_eq!((alone, pattern(&method, &[0.05, 0.13]).map(|p| p.is_stable)), ([true, true], Some(false)));
    // Verlet in either order has the same factor: the products are similar.
    let verlet = stepping(scene.as_ref(), MethodId::VelocityVerlet);
    let [one, two] = [[0.05, 0.13], [0.13, 0.05]].map(|f| pattern(&verlet, &f).expect("linear steps").factor);
    assert!((one / two - 1.0).abs() < 1e-9, "{one} {two}");
}

/// The growth rate of semi-implicit Euler with steps h + d, d of variance q: q s^2 / 2, where +-s are the eigenvalues of the symmetric part
/// of M^-1 M' in coordinates in which the ellipse of M(h), w^2 x^2 - w^2 h x v + v^2, is a circle. The factor is that of
/// ln |exp(d S) u|, whose mean over the directions u is ln cosh(d s).
fn small_jitter(w: f64, h: f64, q: f64) -> f64 {
    let m = semi_implicit(w, h);
    let inverse = [[m[1][1], -m[0][1]], [-m[1][0], m[0][0]]];
    let derivative = [[-2.0 * h * w * w, 1.0], [-w * w, 0.0]];
    let n = times(inverse, derivative);
    // A = L^T L with L = [[a, b], [0, c]].
    let a = w;
    let b = -w * h / 2.0;
    let c = (1.0 - b * b).sqrt();
    let (l, back) = ([[a, b], [0.0, c]], [[1.0 / a, -b / (a * c)], [0.0, 1.0 / c]]);
    let s = times(times(l, n), back);
    let (difference, sum) = (0.5 * (s[0][0] - s[1][1]), 0.5 * (s[0][1] + s[1][0]));
    0.5 * q * (difference * difference + sum * sum)
}

// Fails if: the growth is not that of the drawn steps: another variance, another mean, or a vector that is not followed.
#[test]
fn small_jitter_grows_at_the_rate_of_theory() {
    for (w, h, part) in [(1.0, 1.0, 0.1), (10.0, 0.07, 0.12), (2.0, 0.6, 0.1)] {
        let scene = spring(w);
        let found = jitter(&stepping(scene.as_ref(), MethodId::SemiImplicitEuler), h, part, 1).expect("linear steps");
        let theory = small_jitter(w, h, (part * h).powi(2) / 3.0);
        // The next term is a part `part`^2 times (1 / (1 - (h w)^2 / 4))^2 or so of the rate.
        let next = 4.0 * part * part / (1.0 - (h * w).powi(2) / 4.0).powi(2);
        let allowed = 2.0 * found.half_width + next * theory;
        assert!((found.rate - theory).abs() <= allowed, "{w} {h} {part}: {found:?} {theory} +- {allowed}");
        assert!(theory > 3.0 * allowed, "resolved: {theory} +- {allowed}");
        assert!(found.grows());
    }
    let scene = spring(1.0);
    let still = jitter(&stepping(scene.as_ref(), MethodId::SemiImplicitEuler), 1.0, 0.0, 1).expect("linear steps");
    assert!(!still.grows() && still.rate.abs() < 1e-4, "{still:?}");
}

// Fails if: the answer is not told, the exit code is not that of the answer, or a scene that is not linear is called stable.
#[test]
fn the_command_answers_for_frames_and_jitter() {
    let ask = |arguments: &[&str]| {
        let output = program("stability").args(arguments).output().expect("the binary was built");
        (output.status.code(), text(&output.stdout))
    };
    let spring =
        ["--scene", "oscillator", "--set", "mass=1", "--set", "stiffness=210.25", "--method", "semi-implicit-euler"];
    let (code, said) = ask(&[&spring[..], &["--frames", "0.05,0.13"]].concat());
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("in turn: NOT stable: factor") && said.contains("alone 0.05 s is stable, 0.13 s is stable"),
        "{said}"
    );
    let (code, said) = ask(&[&spring[..], &["--frames", "0.05,0.06"]].concat());
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = ask(&[&spring[..], &["--step", "0.1", "--jitter", "0.3"]].concat());
    assert!(code == Some(1) && said.contains("steps of 0.1 s +- 30 %: NOT stable"), "{said}");
    let (code, said) = ask(&["--scene", "pendulum", "--method", "semi-implicit-euler", "--frames", "0.05,0.13"]);
    assert!(code == Some(1) && said.contains("not known"), "{said}");
    let wrong = program("stability").args(["--frames", "0.1,-1"]).output().expect("the binary was built");
    assert_eq!(wrong.status.code(), Some(2));
}

// Fails if: damping is taken at another point of the step. The limit of semi-implicit Euler with explicit damping is
// h w = 2 (sqrt(1 + zeta^2) - zeta), for k = 10 N/m, m = 0.3 kg, c = 0.1 kg/s: 0.336554469 s, as printed in a bug report of an engine.
#[test]
fn a_damped_spring_has_the_printed_limit() {
    let mut scene = scenes::by_id("damped-oscillator").expect("a scene");
    let zeta = 0.1 / (2.0 * (10.0_f64 * 0.3).sqrt());
    for (name, value) in [("mass", 0.3), ("stiffness", 10.0), ("zeta", zeta)] {
        scene.scene_mut().set("damped-oscillator", name, &value.to_string()).expect("an allowed value");
    }
    let method = stepping(scene.as_ref(), MethodId::SemiImplicitEuler);
    let stable = |h: f64| pattern(&method, &[h]).expect("linear steps").is_stable;
    assert!(stable(0.336_554_469 - 5e-10) && !stable(0.336_554_469 + 5e-10));
}
