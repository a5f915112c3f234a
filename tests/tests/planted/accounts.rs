//! Faults of the account that a scene keeps of its energy and momenta, seen by the laws of mechanics.

use faer::fx128;
use integrator::Real;
use scenes::any::AnyScene;
use scenes::invariants::{Entry, Invariant};
use scenes::observation::{Observation, Quantity};
use verification::invariants::{parameter, violations};

type Change = fn(&dyn AnyScene, &Observation, &mut Entry);

/// Faults of the account of a scene, with the number of scenes on which the laws see them.
pub(crate) fn faults() -> Vec<(&'static str, usize)> {
    let faults: [(&str, Change); 8] = [
        ("account: all of it 1 % off", |_, _, e| e.value.iter_mut().for_each(|x| *x *= fx128::lit(1.01))),
        ("account: all of it negative", |_, _, e| e.value.iter_mut().for_each(|x| *x = -*x)),
        ("account: the first component is lost", |_, _, e| e.value[0] = fx128::ZERO),
        ("account: rounded to f32", |_, _, e| {
            e.value.iter_mut().for_each(|x| *x = fx128::from_f64(f64::from(x.0 as f32)));
        }),
        ("account: what is conserved is said not to be", |_, _, e| e.conserved = false),
        ("account: what is not conserved is said to be", |_, _, e| e.conserved = true),
        ("account: the kinetic energy is 1 % off", |scene, seen, e| kinetic(scene, seen, e, 0.01)),
        ("account: the kinetic energy is negative", |scene, seen, e| kinetic(scene, seen, e, -2.0)),
    ];
    let count = |fault: Change| {
        let sees = |scene: &dyn AnyScene| {
            let wrong = |t: fx128, seen: &Observation| {
                let mut entries = scene.scene().invariants(t, seen);
                entries.iter_mut().for_each(|entry| fault(scene, seen, entry));
                entries
            };
            !violations(scene, &wrong).is_empty()
        };
        scenes::all().iter().filter(|scene| sees(scene.as_ref())).count()
    };
    faults.map(|(name, fault)| (name, count(fault))).into()
}

/// Adds a part of m v^2 / 2 to an energy.
fn kinetic(scene: &dyn AnyScene, seen: &Observation, entry: &mut Entry, part: f64) {
    if entry.invariant == Invariant::Energy
        && let [mass, ..] = parameter(scene, "mass")[..]
    {
        let square = seen.vector(Quantity::Velocity).iter().fold(fx128::ZERO, |sum, &v| sum + v * v);
        entry.value[0] += square * fx128::lit(0.5 * mass * part);
    }
}
