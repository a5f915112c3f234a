//! What a scene's account has to do along its exact motion, from the laws of mechanics and the scene's parameters alone.
//!
//! A part that is said to be conserved is constant. One that is not follows its rate: E' = P, the power of the forces that have no
//! potential, p' = m a and L' = the torque. Constancy cannot see a factor; the kinetic part is held to m v^2 / 2 + w . I w / 2 for
//! that, and then the potential has no factor left.

use faer::fx128;
use integrator::rigid_body::Torque;
use integrator::{Real, Single, State, Vector};
use nalgebra::{SVector, Vector3};
use scenes::any::AnyScene;
use scenes::erased::{AnyMotion, BodyMotion, FlatScene};
use scenes::invariants::{Entry, Invariant};
use scenes::observation::{Observation, Quantity, Value};

/// Every law that an account breaks, in words.
pub fn violations(scene: &dyn AnyScene, invariants: &dyn Fn(fx128, &Observation) -> Vec<Entry>) -> Vec<String> {
    let mut all = kinetic(scene, invariants);
    for (i, entry) in invariants(fx128::ZERO, &scene.exact(fx128::ZERO)).iter().enumerate() {
        let what = format!("{} {}", scene.id(), entry.invariant.id());
        let found =
            if entry.conserved { constant(scene, invariants, i) } else { rate(scene, invariants, i, entry.invariant) };
        all.extend(found.map(|found| format!("{what}: {found}")));
    }
    all
}

type Invariants<'a> = &'a dyn Fn(fx128, &Observation) -> Vec<Entry>;

/// Times at which an account is looked at.
const LOOKS: u32 = 16;
/// The exact motion is good to this part, relative; measured 1e-28 and better, by the tests of the exact motions.
const EXACT: f64 = 1e-26;

fn components(invariants: Invariants<'_>, scene: &dyn AnyScene, t: fx128, entry: usize) -> Vec<fx128> {
    invariants(t, &scene.exact(t))[entry].value.clone()
}

/// The largest change of a conserved part, where it is more than rounding.
fn constant(scene: &dyn AnyScene, invariants: Invariants<'_>, entry: usize) -> Option<String> {
    let start = components(invariants, scene, fx128::ZERO, entry);
    // Kinetic and potential parts may cancel: the size of either is that of the account without its potential.
    let size = kinetic_size(scene) + start.iter().map(|x| x.to_f64().abs()).sum::<f64>();
    let end = scene.scene().info().horizon_s;
    (1..=LOOKS).find_map(|k| {
        let t = fx128::lit(end) * fx128::lit(f64::from(k)) / fx128::lit(f64::from(LOOKS));
        let now = components(invariants, scene, t, entry);
        let off = now.iter().zip(&start).map(|(a, b)| (*a - *b).to_f64().abs()).sum::<f64>();
        (!(off <= EXACT * size)).then(|| format!("changes by {off:.3e} of {size:.3e} up to {} s", t.to_f64()))
    })
}

/// The values of a parameter of the scene; empty where it has none of that name.
pub fn parameter(scene: &dyn AnyScene, name: &str) -> Vec<f64> {
    let all = scene.scene().parameters();
    let value = all.into_iter().find(|p| p.name == name).map(|p| p.value).unwrap_or_default();
    value.split(',').filter_map(|x| x.parse().ok()).collect()
}

fn one(scene: &dyn AnyScene, name: &str) -> f64 {
    parameter(scene, name).first().copied().unwrap_or(f64::NAN)
}

fn base(scene: &dyn AnyScene) -> &'static str {
    scene.id().split('/').next().unwrap_or_default()
}

/// m, of a pendulum m l^2.
fn mass(scene: &dyn AnyScene) -> f64 {
    let length = if base(scene) == "pendulum" { one(scene, "length") } else { 1.0 };
    one(scene, "mass") * length * length
}

/// Principal moments of inertia of a rigid body.
fn inertia(scene: &dyn AnyScene) -> Option<[f64; 3]> {
    match parameter(scene, "inertia")[..] {
        [a, b, c] => Some([a, b, c]),
        [all] => Some([all; 3]),
        _ => {
            let across = *parameter(scene, "inertia_1").first()?;
            Some([across, across, one(scene, "inertia_3")])
        }
    }
}

/// m v^2 / 2 + w . I w / 2.
fn kinetic_energy(scene: &dyn AnyScene, seen: &Observation) -> fx128 {
    let square = |q| seen.vector(q).iter().fold(fx128::ZERO, |sum, &x| sum + x * x);
    let half = fx128::lit(0.5);
    let Some(rotation) = seen.rotation() else {
        return (square(Quantity::Velocity) + square(Quantity::AngularVelocity)) * fx128::lit(mass(scene)) * half;
    };
    let omega = rotation.rotate_back(Vector3::from_column_slice(seen.vector(Quantity::AngularVelocity)));
    let inertia = inertia(scene).unwrap_or([f64::NAN; 3]);
    let turning = omega.iter().zip(inertia).fold(fx128::ZERO, |sum, (&w, i)| sum + w * w * fx128::lit(i));
    let flying = if seen.vector(Quantity::Velocity).is_empty() {
        fx128::ZERO
    } else {
        square(Quantity::Velocity) * fx128::lit(mass(scene))
    };
    (turning + flying) * half
}

fn kinetic_size(scene: &dyn AnyScene) -> f64 {
    1.0 + kinetic_energy(scene, &scene.exact(fx128::ZERO)).to_f64()
}

/// The energy without what does not move, against the kinetic energy.
fn kinetic(scene: &dyn AnyScene, invariants: Invariants<'_>) -> Vec<String> {
    let t = fx128::lit(0.375 * scene.scene().info().horizon_s);
    let seen = scene.exact(t);
    let mut at_rest = seen.clone();
    for (quantity, value) in &mut at_rest.values {
        if let (Quantity::Velocity | Quantity::AngularVelocity, Value::Vector(v)) = (*quantity, value) {
            v.fill(fx128::ZERO);
        }
    }
    let energy = |seen: &Observation| invariants(t, seen).into_iter().find(|e| e.invariant == Invariant::Energy);
    let (Some(moving), Some(resting)) = (energy(&seen), energy(&at_rest)) else { return Vec::new() };
    let (part, kinetic) = (moving.value[0] - resting.value[0], kinetic_energy(scene, &seen));
    let size = kinetic.to_f64() + moving.value[0].to_f64().abs();
    let off = (part - kinetic).to_f64().abs();
    if off <= EXACT * size {
        Vec::new()
    } else {
        vec![format!("{} kinetic energy: off by {off:.3e} of {size:.3e}", scene.id())]
    }
}

/// Nodes and weights of Gauss and Legendre's rule of five points on -1..1.
const GAUSS: [(f64, f64); 5] = [
    (0.0, 128.0 / 225.0),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
];
/// Panels of the integral between two times.
const PANELS: u32 = 64;
/// A rule of five points on a panel of a 64th of a motion leaves (1/64)^10 of its tenth derivative; rounding is 320 evaluations
/// of a few eps each.
const INTEGRAL: f64 = 1e-12;

/// How far a part that is not conserved is from the integral of its rate, where it is more than the integral's own error: between
/// the times at which the motion is not smooth.
fn rate(scene: &dyn AnyScene, invariants: Invariants<'_>, entry: usize, invariant: Invariant) -> Option<String> {
    let end = scene.scene().info().horizon_s;
    let times: Vec<f64> = std::iter::once(0.0).chain(scene.scene().nonsmooth_times_s(end)).chain([end]).collect();
    times.windows(2).find_map(|w| {
        // A bounce is at its time to rounding: the pieces end beside it.
        let margin = 1e-9 * end;
        let [from, to] = [w[0] + margin, w[1] - margin];
        let (mut sum, mut size) = (vec![0.0; 16], 0.0_f64);
        let width = (to - from) / f64::from(PANELS);
        for panel in 0..PANELS {
            for (x, weight) in GAUSS {
                let t = from + width * (f64::from(panel) + 0.5 * (x + 1.0));
                let rates = rates(scene, invariant, t);
                rates.iter().zip(&mut sum).for_each(|(r, sum)| *sum += r * weight * 0.5 * width);
                size += rates.iter().map(|r| r.abs()).sum::<f64>() * weight * 0.5 * width;
            }
        }
        let [a, b] = [from, to].map(|t| components(invariants, scene, fx128::lit(t), entry));
        let gained = b.iter().zip(&a).map(|(b, a)| (*b - *a).to_f64());
        let off = gained.zip(&sum).map(|(gained, sum)| (gained - sum).abs()).fold(0.0, scenes::observation::worse);
        let size = size + kinetic_size(scene);
        (!(off <= INTEGRAL * size)).then(|| format!("off its rate by {off:.3e} of {size:.3e} from {from} s to {to} s"))
    })
}

/// The rate of a part that is not conserved: power in W, force in N, torque in N m.
fn rates(scene: &dyn AnyScene, invariant: Invariant, t: f64) -> Vec<f64> {
    let m = mass(scene);
    match scene.any_motion() {
        AnyMotion::Few(erased) => flat(scene, invariant, &erased, t, m),
        AnyMotion::Many(erased) => flat(scene, invariant, &erased, t, m),
        AnyMotion::Pivoted(_) => vec![f64::NAN],
        AnyMotion::Flying(motion) => flying(invariant, motion, t, m),
    }
}

fn flat<const M: usize>(
    scene: &dyn AnyScene,
    invariant: Invariant,
    erased: &FlatScene<'_, M>,
    t: f64,
    m: f64,
) -> Vec<f64> {
    let motion = erased.motion();
    let s: State<SVector<f64, M>> = motion.exact(t);
    let force: Vec<f64> = motion.rate(t, &s).iter().take(erased.dimension).map(|a| a * m).collect();
    if invariant != Invariant::Energy {
        // The sixteen masses have one momentum.
        return if erased.dimension == 16 { vec![force.iter().sum()] } else { force };
    }
    let speed = s.v.norm();
    vec![match base(scene) {
        "linear-drag" => -one(scene, "drag") * speed * speed,
        "quadratic-drag" => -one(scene, "drag") * speed.powi(3),
        "damped-oscillator" => -2.0 * one(scene, "zeta") * (one(scene, "stiffness") * m).sqrt() * speed * speed,
        "forced-oscillator" => {
            let drive = one(scene, "force") * (one(scene, "drive") * t).cos();
            (drive - one(scene, "damping") * s.v[0]) * s.v[0]
        }
        // Between its bounces.
        "bouncing-ball" => 0.0,
        _ => f64::NAN,
    }]
}

fn flying(invariant: Invariant, motion: BodyMotion<'_, Vector3<f64>>, t: f64, m: f64) -> Vec<f64> {
    let at = motion.exact(t);
    let force = motion.acceleration(t, &at) * m;
    let torque = match motion.torque(t, &at) {
        Torque::World(torque) => torque,
        Torque::Body(torque) => at.attitude.rotate(torque),
        Torque::None => Vector3::zero(),
    };
    match invariant {
        Invariant::Energy => vec![force.dot(&at.velocity) + torque.dot(&at.attitude.rotate(at.omega_body))],
        Invariant::Momentum => force.iter().copied().collect(),
        Invariant::AngularMomentum => torque.iter().copied().collect(),
    }
}
