//! The oscillator's energy, step by step: explicit Euler's exact growth, semi-implicit Euler's exact invariant and band; and
//! that each law denies the other method.
//!
//! An energy test cannot see a wrong motion (a body without its gyroscopic term conserves energy to the last bit): the
//! orders are in order_of_methods.rs.

use faer::fx128;
use integrator::methods::{ExplicitEuler, SemiImplicitEuler};
use integrator::{Method, Single, State, drive};
use nalgebra::Vector1;
use scenes::Oscillator;
use scenes::motion::Motion;

type S<T> = State<Vector1<T>>;

const H: f64 = 0.03125;
/// omega^2 of the scene's spring.
const W2: f64 = 4.0;

/// 2 E / m = v^2 + w^2 x^2, in double-double so that the sum's own rounding is not seen.
fn energy<T: Single>(s: &S<T>) -> fx128 {
    let (x, v) = (s.q.x.widen(), s.v.x.widen());
    v * v + fx128::from_f64(W2) * x * x
}

/// Q = v^2 + w^2 x^2 - w^2 h x v.
fn invariant<T: Single>(s: &S<T>) -> fx128 {
    energy(s) - fx128::from_f64(W2 * H) * s.q.x.widen() * s.v.x.widen()
}

/// Largest |f(after) / (factor f(before)) - 1| of a run's steps, in eps.
fn worst_step<T: Single, A: Method<T, Oscillator>>(method: &A, f: fn(&S<T>) -> fx128, factor: f64) -> f64 {
    let scene = Oscillator::default();
    let mut before: Option<fx128> = None;
    let mut worst = 0.0_f64;
    let start = Motion::<T>::exact(&scene, T::lit(0.0));
    let end = drive::integrate(method, &scene, start, T::lit(H), 1000, |_, s| {
        let now = f(s);
        if let Some(before) = before {
            let excess = now / (before * fx128::from_f64(factor)) - fx128::ONE;
            worst = worst.max(excess.0.abs() / T::EPSILON);
        }
        before = Some(now);
    });
    assert!(end.is_ok());
    worst
}

// Fails if: the scene's default mass is 1.
#[test]
fn the_scene_is_the_one_the_laws_are_written_for() {
    let scene = Oscillator::default();
    assert_eq!(scene.stiffness / scene.mass, W2);
    assert!(scene.mass != 1.0 && scene.x0 != 0.0 && scene.v0 != 0.0);
}

/// A step rounds x and v once each for the product and once for the sum: |(w dx, dv)| <= eps (1 + z) |(w x, v)|, so that an
/// energy is off by 2 (1 + z) eps of itself; Q by a factor (1 + z/2) / (1 - z/2) more. Both below 3 for z = 1/16.
const ROUNDING: f64 = 3.0;

// Fails if: explicit Euler moves the position by the new velocity, or by half a step.
#[test]
fn explicit_euler_multiplies_the_energy_by_1_plus_z_squared_every_step() {
    let factor = 1.0 + W2 * H * H;
    assert!(worst_step::<f32, _>(&ExplicitEuler, energy, factor) <= ROUNDING);
    assert!(worst_step::<f64, _>(&ExplicitEuler, energy, factor) <= ROUNDING);
    // fx128's own operations are good to about two eps, not to half of one.
    assert!(worst_step::<fx128, _>(&ExplicitEuler, energy, factor) <= 4.0 * ROUNDING);
    let denied = worst_step::<f64, _>(&SemiImplicitEuler, energy, factor) * f64::EPSILON;
    // Its E = Q / (1 - (z/2) sin 2 phi), phi turning by z a step, changes by -z^2 to z^2: 2 z^2 off the law at most.
    assert!(denied > 1.5 * W2 * H * H, "semi-implicit Euler has no such law: {denied}");
}

// Fails if: semi-implicit Euler moves the position by the old velocity, or evaluates the force at the new position.
#[test]
fn semi_implicit_euler_conserves_its_quadratic_invariant_in_every_step() {
    assert!(worst_step::<f32, _>(&SemiImplicitEuler, invariant, 1.0) <= ROUNDING);
    assert!(worst_step::<f64, _>(&SemiImplicitEuler, invariant, 1.0) <= ROUNDING);
    assert!(worst_step::<fx128, _>(&SemiImplicitEuler, invariant, 1.0) <= 4.0 * ROUNDING);
    let denied = worst_step::<f64, _>(&ExplicitEuler, invariant, 1.0) * f64::EPSILON;
    // Explicit Euler multiplies every quadratic form near the energy by 1 + z^2.
    assert!(denied > 0.9 * W2 * H * H, "explicit Euler does not conserve it: {denied}");
}

/// Least and greatest E / E0 of a million steps of Euler, or of as many as keep inside the band.
fn range<A: Method<f64, Oscillator>>(method: &A, steps: u64) -> [f64; 2] {
    let scene = Oscillator::default();
    let start = Motion::<f64>::exact(&scene, 0.0);
    let twice = |s: &S<f64>| s.v.x * s.v.x + W2 * s.q.x * s.q.x;
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let end = drive::integrate(method, &scene, start, H, steps, |_, s| {
        let e = twice(s) / twice(&start);
        range = [range[0].min(e), range[1].max(e)];
    });
    assert!(end.is_ok());
    range
}

// Fails if: semi-implicit Euler moves the position by the old velocity; the scene's band has the sign of the initial phase wrong.
#[test]
fn semi_implicit_euler_fills_its_energy_band_and_never_leaves_it() {
    let [low, high] = Oscillator::default().semi_implicit_band(H);
    let steps = 1_000_000;
    let [least, greatest] = range(&SemiImplicitEuler, steps);
    println!("band [{low}, {high}], seen [{least}, {greatest}]");
    // Q is conserved to ROUNDING eps a step, and no step can do worse than all of them the same way.
    let rounding = ROUNDING * f64::EPSILON * steps as f64;
    assert!(least >= low - rounding && greatest <= high + rounding, "{least} {greatest}");
    // The phase advances by theta = z each step, dense on the circle: extremes are met to (z n / 10^6)^2 and better.
    let width = high - low;
    assert!(least <= low + 1e-6 * width && greatest >= high - 1e-6 * width, "{least} {greatest}");
    // Explicit Euler leaves it within (1 + z^2)^n > high.
    let leaves = (high.ln() / (W2 * H * H).ln_1p()).ceil() as u64;
    let [_, greatest] = range(&ExplicitEuler, leaves + 1);
    assert!(leaves < 20 && greatest > high, "{leaves} steps: {greatest}");
}
