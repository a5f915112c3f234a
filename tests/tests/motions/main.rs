//! A net for exact motions: every scene with random parameters from the allowed ranges and with the special values between
//! which formulas change (0, equal, along an axis, from rest, critical, on the separatrix, 1 +- ulp).
//!
//! What `check` accepts must have a finite motion that starts at the start, solves its equation, is the same in f32 and f64 but
//! for rounding, and keeps its bits when the units of mass, length and time change by powers of two. `NET_DRAWS` sets the
//! number of draws per scene. Parameters that once failed are in `motions_cases.rs`.

mod draw;

use std::time::{Duration, Instant};

use draw::{Random, numbers, randomise, set, values};
use faer::fx128;
use integrator::{Real, Single};
use scenes::any::AnyScene;
use scenes::observation::{Observation, Quantity, Value};
use scenes::run::Precision;
use scenes::{IDS, by_id};

/// Draws per scene, unless NET_DRAWS says otherwise.
const DRAWS: u64 = 48;
/// What one evaluation may take: a hundred times what the slowest takes, so that only what does not end is found.
const LONGEST: Duration = Duration::from_secs(2);
/// Phases up to which the rounding of the phase is below the truncation of the differences.
const RESIDUAL_RADIANS: f64 = 1e6;
/// Step of the differences in units of the fastest rate.
const STEP: f64 = 1.0 / 4096.0;

fn norm(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))
}

/// An upper bound of the rates of a motion until the time t, 1/s.
fn fastest(scene: &dyn AnyScene, t: f64) -> f64 {
    let of = values(scene);
    let one = |name: &str| of.get(name).map_or(0.0, |v| v[0]);
    let (m, omega) = (one("mass"), of.get("omega").map_or(0.0, |w| norm(w)));
    let rate = match scene.id().split('/').next().unwrap_or_default() {
        "oscillator" | "damped-oscillator" | "forced-oscillator" | "spring-chain" => {
            let w = (one("stiffness") / m).sqrt();
            2.0 * w * (1.0 + one("zeta")) + one("damping") / m + one("drive")
        }
        "linear-drag" => one("drag") / m,
        "quadratic-drag" => (one("gravity") * one("drag") / m).sqrt() + one("drag") / m * one("v0").abs(),
        "pendulum" => (one("gravity") / one("length")).sqrt() + omega,
        "kepler" => (one("mu") / one("semi_major")).sqrt() / one("semi_major") * (1.0 - one("eccentricity")).powf(-1.5),
        "charged-particle" => one("charge").abs() / m * norm(&of["magnetic"]),
        "bouncing-ball" => one("gravity") / one("v0").hypot((one("gravity") * one("x0")).sqrt()),
        "principal-axis-torque" => {
            let alpha = one("torque").abs() / of["inertia"].iter().copied().fold(f64::INFINITY, f64::min);
            omega + alpha.sqrt() + alpha * t
        }
        "sphere-torque" => {
            let alpha = norm(&of["torque"]) / one("inertia");
            omega + alpha.sqrt() + alpha * t
        }
        "manufactured" => {
            let [a, b, c] = ["attitude", "sine", "cosine"].map(|name| norm(&of[name]));
            one("frequency") * a / (a - b - c)
        }
        _ => {
            let inertia = of.get("inertia").cloned().unwrap_or_else(|| {
                let [i1, i3] = ["inertia_1", "inertia_3"].map(|name| of.get(name).map_or(1.0, |v| v[0]));
                vec![i1, i1, i3]
            });
            let twice: f64 = of.get("omega").map_or(0.0, |w| w.iter().zip(&inertia).map(|(w, i)| i * w * w).sum());
            let least = inertia.iter().copied().fold(f64::INFINITY, f64::min);
            omega + ((twice + 4.0 * one("mgl")) / least).sqrt()
        }
    };
    rate.max(1.0 / t)
}

/// The parameters, for a message.
fn shown(scene: &dyn AnyScene) -> String {
    let all = scene.scene().parameters();
    let settings: Vec<String> = all.iter().map(|p| format!("--set {}={}", p.name, p.value)).collect();
    format!("{} {}", scene.id(), settings.join(" "))
}

fn components(value: &Value) -> Vec<fx128> {
    match value {
        Value::Vector(components) => components.clone(),
        Value::Rotation(q) => q.wxyz().to_vec(),
    }
}

/// The largest distance of two lists, NaN if one is.
fn apart(a: &[fx128], b: &[fx128]) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| (a - b).0.abs()).fold(0.0, |most: f64, x| if x.is_nan() { x } else { most.max(x) })
}

/// What is said of the start by its parameters, where any is.
fn given(scene: &dyn AnyScene, seen: &Observation, quantity: Quantity) -> Option<(Vec<fx128>, Vec<fx128>)> {
    let of = values(scene);
    let family = scene.id().split('/').next().unwrap_or_default();
    if matches!(family, "kepler" | "manufactured") {
        return None;
    }
    let wide = |v: &Vec<f64>| v.iter().map(|&x| fx128::lit(x)).collect::<Vec<_>>();
    let found = components(seen.get(quantity)?);
    match (quantity, seen.rotation()) {
        (Quantity::Position, _) => Some((wide(of.get("x0")?), found)),
        (Quantity::Velocity, _) => Some((wide(of.get("v0")?), found)),
        (Quantity::Attitude, None) => Some((wide(of.get("angle")?), found)),
        (Quantity::AngularVelocity, None) => Some((wide(of.get("omega")?), found)),
        (Quantity::Attitude, Some(q)) => {
            let start = integrator::Rotation::from_wxyz([0, 1, 2, 3].map(|i| fx128::lit(of["attitude"][i])));
            let sign = if start.wxyz().iter().zip(q.wxyz()).any(|(&a, b)| (a * b).0 < -1e-3) { -1.0 } else { 1.0 };
            Some((start.wxyz().map(|c| c * fx128::lit(sign)).to_vec(), q.wxyz().to_vec()))
        }
        (Quantity::AngularVelocity, Some(q)) if family != "principal-axis-torque" => {
            let world = nalgebra::Vector3::from_column_slice(&found);
            let in_frame = if family == "sphere-torque" { world } else { q.rotate_back(world) };
            Some((wide(of.get("omega")?), in_frame.iter().copied().collect()))
        }
        _ => None,
    }
}

fn starts_at_the_start(scene: &dyn AnyScene) {
    let wide = scene.exact(fx128::ZERO);
    for (quantity, _) in &wide.values {
        let Some((given, found)) = given(scene, &wide, *quantity) else { continue };
        let scale = given.iter().map(|c| c.0.abs()).fold(0.0, f64::max);
        let error = apart(&given, &found);
        assert!(error <= 1e-26 * scale, "{}: {} {error:e} at t = 0", shown(scene), quantity.id());
    }
}

fn timed(scene: &dyn AnyScene, t: f64) -> Observation {
    let start = Instant::now();
    let seen = scene.exact(fx128::lit(t));
    let took = start.elapsed();
    assert!(took < LONGEST, "{}: {took:?} at {t}", shown(scene));
    for (quantity, value) in &seen.values {
        let finite = components(value).iter().all(|c| c.is_finite());
        assert!(finite, "{}: {} at {t} is {value:?}", shown(scene), quantity.id());
    }
    seen
}

/// f64 and f32 are the double-double motion rounded: 8 eps of the larger of now and the start.
fn rounds_alike(scene: &dyn AnyScene, t: f64) {
    let (start, wide) = (scene.exact(fx128::ZERO), scene.exact(fx128::lit(t)));
    for (precision, eps) in [(Precision::F64, f64::EPSILON), (Precision::F32, f64::from(f32::EPSILON))] {
        // The time of f32 is another number.
        let at = if precision == Precision::F32 { f64::from(t as f32) } else { t };
        let wide = if at == t { wide.clone() } else { scene.exact(fx128::lit(at)) };
        for (quantity, error) in scene.exact_in(precision, at).distances(&wide) {
            let scale = start.scale(quantity).max(wide.scale(quantity));
            // What has died away to less is not resolved by the range of the arithmetic.
            let resolved = if precision == Precision::F32 { 1e-30..1e30 } else { 1e-270..1e300 };
            let size = wide.scale(quantity);
            if size != 0.0 && !(resolved.contains(&scale) && resolved.contains(&size)) {
                continue;
            }
            let bound = 8.0 * eps * scale;
            assert!(
                error <= bound,
                "{}: {} in {precision:?} at {at}: {error:e} > {bound:e}",
                shown(scene),
                quantity.id()
            );
        }
    }
}

/// As in `oracles.rs`, in units of the fastest rate.
fn solves_its_equation(scene: &dyn AnyScene, t: f64) {
    let rate = fastest(scene, t);
    let h = STEP / rate;
    let breaks = scene.scene().nonsmooth_times_s(t + 6.0 * h);
    if rate * t > RESIDUAL_RADIANS || t <= 5.0 * h || breaks.iter().any(|at| (at - t).abs() <= 5.0 * h) {
        return;
    }
    let tolerance = 362_880.0 * 4.0_f64.powi(9) / 630.0 * STEP.powi(8) + 512.0 * <fx128 as Single>::EPSILON / STEP;
    let found = scene.residual(fx128::lit(t), h);
    let [q, v, a] = found.size;
    // The differences of what has died away have no digits.
    if (q != 0.0 && q < 1e-240) || (v != 0.0 && v < 1e-240) {
        return;
    }
    let bound = tolerance * (v + q * rate);
    assert!(found.velocity <= bound, "{} at {t}: {found:?} > {bound:e}", shown(scene));
    let bound = tolerance * (a + (v + q * rate) * rate);
    assert!(found.rate <= bound, "{} at {t}: {found:?} > {bound:e}", shown(scene));
}

/// (kg, m, s) of a unit; a coulomb is a number.
fn dimension(unit: &str) -> [i32; 3] {
    match unit {
        "1" | "rad" | "C" => [0, 0, 0],
        "kg" => [1, 0, 0],
        "m" => [0, 1, 0],
        "m/s" => [0, 1, -1],
        "m/s^2" => [0, 1, -2],
        "m^3/s^2" => [0, 3, -2],
        "1/s" | "rad/s" => [0, 0, -1],
        "1/s^2" => [0, 0, -2],
        "kg/s" | "T" => [1, 0, -1],
        "kg/m" => [1, -1, 0],
        "N/m" => [1, 0, -2],
        "N" | "V/m" => [1, 1, -2],
        "kg m^2" => [1, 2, 0],
        "N m" | "J" => [1, 2, -2],
        other => panic!("no dimension of {other:?}"),
    }
}

/// The motion in other units, powers of two of these, has the same bits.
fn keeps_its_bits_in_other_units(scene: &dyn AnyScene, t: f64, powers: [i32; 3]) {
    let mut other = by_id(scene.id()).expect("a scene of the catalogue");
    let shift = |dimension: [i32; 3]| -> i32 { dimension.iter().zip(powers).map(|(d, p)| d * p).sum() };
    for parameter in scene.scene().parameters() {
        let scale = f64::from(shift(dimension(parameter.unit))).exp2();
        let scaled: Vec<f64> = numbers(&parameter).iter().map(|x| x * scale).collect();
        set(other.as_mut(), parameter.name, &scaled);
    }
    let at = t * f64::from(powers[2]).exp2();
    let (here, there) = (scene.exact_in(Precision::F64, t), other.exact_in(Precision::F64, at));
    for ((quantity, a), (_, b)) in here.values.iter().zip(&there.values) {
        let dimension = match quantity {
            Quantity::Position => [0, 1, 0],
            Quantity::Velocity => [0, 1, -1],
            Quantity::Attitude => [0, 0, 0],
            Quantity::AngularVelocity => [0, 0, -1],
        };
        let scale = f64::from(shift(dimension)).exp2();
        let (a, b) = (components(a), components(b));
        let same = a.iter().zip(&b).all(|(a, b)| a.0 * scale == b.0);
        assert!(same, "{} at {t} in units of 2^{powers:?}: {} {a:?} {b:?}", shown(scene), quantity.id());
    }
}

fn draws() -> u64 {
    std::env::var("NET_DRAWS").ok().map_or(DRAWS, |text| text.parse().expect("NET_DRAWS is a number"))
}

/// Fails if a motion is not finite, does not start at its start, does not solve its equation, differs between precisions or
/// depends on the units.
#[test]
fn motions_of_accepted_parameters_are_exact() {
    let draws = draws();
    for (number, id) in IDS.iter().enumerate() {
        let mut random = Random(0x6d6f_7469_6f6e ^ ((number as u64) << 32));
        let mut accepted = 0;
        for _ in 0..draws {
            let mut scene = by_id(id).expect("a scene of the catalogue");
            randomise(scene.as_mut(), &mut random);
            let fraction = (1.0 + random.below(63) as f64) / 64.0;
            let powers = [0, 1, 2].map(|_| random.below(301) as i32 - 150);
            if scene.scene().check().is_err() {
                continue;
            }
            accepted += 1;
            let t = fraction * scene.scene().info().horizon_s;
            starts_at_the_start(scene.as_ref());
            timed(scene.as_ref(), t);
            rounds_alike(scene.as_ref(), t);
            solves_its_equation(scene.as_ref(), t);
            keeps_its_bits_in_other_units(scene.as_ref(), t, powers);
        }
        assert!(accepted * 4 >= draws, "{id}: {accepted} of {draws} draws accepted");
    }
}
