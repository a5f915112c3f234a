//! Exact motions of the particle scenes against 30-digit reference solutions.
//!
//! The tables give accelerations and rates where the scenes have masses and force constants; with m = 1 (or a length of 1 m)
//! the conversions are exact: F = a, c = k, k = w^2, c = 2 zeta w, g = w0^2 (w is dyadic and 2 zeta w a power of two times zeta).

use faer::fx128;
use integrator::{Single, State};
use nalgebra::SMatrix;
use scenes::motion::Motion;
use scenes::spring_chain::chain_motion;
use scenes::{
    ChargedParticle, ConstantForce, DampedOscillator, ForcedOscillator, Kepler, LinearDrag, Oscillator, Pendulum,
    QuadraticDrag,
};
use verification::reference::{self, Reference, Row};

/// Largest |found - truth| over the components of position and velocity, each as a part of its largest component in the table
/// (the state's scale).
fn error<T: Single, const N: usize>(
    case: &Reference,
    row: &Row,
    names: [&str; 2],
    state: &State<SMatrix<T, N, 1>>,
) -> f64 {
    let part = |name: &str, found: &SMatrix<T, N, 1>| {
        let truth = |row: &Row| case.values::<N>(row, name);
        let scale = case.rows.iter().flat_map(truth).map(|c| c.0.abs()).fold(0.0, f64::max);
        let apart = (0..N).map(|i| (found[i].widen() - truth(row)[i]).0.abs());
        apart.fold(0.0, |worst: f64, x| if x.is_nan() { x } else { worst.max(x) }) / scale
    };
    let (q, v) = (part(names[0], &state.q), part(names[1], &state.v));
    if q.is_nan() || v.is_nan() { f64::NAN } else { q.max(v) }
}

fn check<const N: usize, M>(case: &Reference, names: [&str; 2], motion: &M)
where
    M: Motion<f64, Config = SMatrix<f64, N, 1>> + Motion<fx128, Config = SMatrix<fx128, N, 1>>,
{
    for row in &case.rows {
        let double: State<SMatrix<f64, N, 1>> = motion.exact(row.t);
        let apart = error(case, row, names, &double);
        assert!(apart <= 8.0 * f64::EPSILON, "f64, t = {}: {apart:e}", row.t);
        let wide: State<SMatrix<fx128, N, 1>> = motion.exact(fx128::from_f64(row.t));
        let apart = error(case, row, names, &wide);
        assert!(apart <= 1e-25, "double-double, t = {}: {apart:e}", row.t);
    }
}

fn each(case: &str, check: impl Fn(&Reference)) {
    let sets = reference::sets(case);
    assert!(!sets.is_empty(), "no sets of {case}");
    for set in sets {
        println!("{case} {set}");
        check(&reference::load(case, &set));
    }
}

#[test]
fn constant_force_agrees_with_the_reference() {
    each("const_force", |case| {
        let scene = ConstantForce { mass: 1.0, force: case.vector("a"), x0: case.vector("x0"), v0: case.vector("v0") };
        check(case, ["x", "vx"], &scene);
    });
}

#[test]
fn linear_drag_agrees_with_the_reference() {
    each("linear_drag", |case| {
        let scene = LinearDrag {
            mass: 1.0,
            drag: case.number("k"),
            gravity: case.vector("g"),
            x0: case.vector("x0"),
            v0: case.vector("v0"),
        };
        check(case, ["x", "vx"], &scene);
    });
}

#[test]
fn quadratic_drag_agrees_with_the_reference() {
    each("quad_drag", |case| {
        let scene = QuadraticDrag {
            mass: 1.0,
            drag: case.number("k"),
            gravity: case.number("g"),
            x0: case.number("x0"),
            v0: case.number("v0"),
        };
        check(case, ["x", "v"], &scene);
    });
}

#[test]
fn oscillators_agree_with_the_reference() {
    each("oscillator", |case| {
        let (w, zeta, force, drive) = (case.number("w"), case.number("zeta"), case.number("F"), case.number("Om"));
        let (mass, stiffness, damping) = (1.0, w * w, 2.0 * zeta * w);
        let (x0, v0) = (case.number("x0"), case.number("v0"));
        check(case, ["x", "v"], &ForcedOscillator { mass, stiffness, damping, force, drive, x0, v0 });
        if force == 0.0 {
            check(case, ["x", "v"], &DampedOscillator { mass, stiffness, zeta, x0, v0 });
        }
        if force == 0.0 && zeta == 0.0 {
            check(case, ["x", "v"], &Oscillator { mass, stiffness, x0, v0 });
        }
    });
}

#[test]
fn pendulums_agree_with_the_reference() {
    each("pendulum", |case| {
        let w0 = case.number("w0");
        let (angle, omega) = (case.number("th0"), case.number("om0"));
        check(case, ["theta", "omega"], &Pendulum { mass: 1.0, length: 1.0, gravity: w0 * w0, angle, omega });
    });
}

#[test]
fn kepler_orbits_agree_with_the_reference() {
    each("kepler", |case| {
        let scene = Kepler {
            mass: 1.0,
            mu: case.number("mu"),
            semi_major: case.number("a"),
            eccentricity: case.number("e"),
            anomaly: case.number("M0"),
        };
        check(case, ["x", "vx"], &scene);
    });
}

#[test]
fn charged_particles_agree_with_the_reference() {
    each("em", |case| {
        let scene = ChargedParticle {
            mass: 1.0,
            charge: case.number("qm"),
            electric: case.vector("E"),
            magnetic: case.vector("B"),
            x0: case.vector("x0"),
            v0: case.vector("v0"),
        };
        check(case, ["x", "vx"], &scene);
    });
}

#[test]
fn spring_chains_of_three_and_eight_masses_agree_with_the_reference() {
    fn check_chain<const N: usize>(case: &Reference) {
        let ratio = fx128::from_f64(case.number("k")) / fx128::from_f64(case.number("m"));
        for row in &case.rows {
            let (q, v) = chain_motion::<N>(ratio, &case.vector("x0"), &case.vector("v0"), fx128::from_f64(row.t));
            let apart = error(case, row, ["x0", "v0"], &State { q, v });
            assert!(apart <= 1e-25, "double-double, t = {}: {apart:e}", row.t);
            let rounded = State { q: q.map(f64::narrow), v: v.map(f64::narrow) };
            assert!(error(case, row, ["x0", "v0"], &rounded) <= 8.0 * f64::EPSILON, "f64, t = {}", row.t);
        }
    }
    each("chain", |case| match case.columns.len() {
        6 => check_chain::<3>(case),
        16 => check_chain::<8>(case),
        other => panic!("a chain of {other} columns"),
    });
}
