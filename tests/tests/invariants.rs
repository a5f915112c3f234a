//! Energy and momenta of every scene along its exact motion: what is said to be conserved is, the rest follows its rate.

use faer::fx128;
use integrator::Real;
use scenes::any::AnyScene;
use scenes::invariants::{Entry, Invariant};
use scenes::observation::{Observation, Quantity};
use verification::invariants::{parameter, violations};

// Fails if: a potential has the wrong sign, a kinetic energy a factor, a part the wrong flag, or an account another mass.
#[test]
fn what_a_scene_calls_conserved_is_constant_and_the_rest_follows_its_rate() {
    let all: Vec<String> = scenes::all()
        .iter()
        .flat_map(|scene| violations(scene.as_ref(), &|t, seen| scene.scene().invariants(t, seen)))
        .collect();
    assert!(all.is_empty(), "{}", all.join("\n"));
}

/// What is wrong with an account.
type Fault = fn(&dyn AnyScene, &Observation, &mut Entry);

/// q E . x, the potential energy of a charge with its sign turned.
fn field_energy(scene: &dyn AnyScene, seen: &Observation) -> fx128 {
    let along = seen.vector(Quantity::Position).iter().zip(parameter(scene, "electric"));
    along.fold(fx128::ZERO, |sum, (&x, e)| sum + x * fx128::lit(e)) * fx128::lit(parameter(scene, "charge")[0])
}

const FAULTS: [(&str, &str, Fault); 6] = [
    ("charged-particle", "the potential has the wrong sign", |scene, seen, e| {
        if e.invariant == Invariant::Energy {
            e.value[0] += field_energy(scene, seen) * fx128::lit(2.0);
        }
    }),
    ("box-tumbling", "the kinetic energy of the flight is 1 % off", |scene, seen, e| {
        if e.invariant == Invariant::Energy {
            let square = seen.vector(Quantity::Velocity).iter().fold(fx128::ZERO, |sum, &v| sum + v * v);
            e.value[0] += square * fx128::lit(0.005 * parameter(scene, "mass")[0]);
        }
    }),
    ("kepler", "all of the energy is 1 % off", |_, _, e| e.value.iter_mut().for_each(|x| *x *= fx128::lit(1.01))),
    ("linear-drag", "what is lost is said to be conserved", |_, _, e| e.conserved = true),
    ("damped-oscillator", "the energy is 1e-6 off", |_, _, e| {
        e.value.iter_mut().for_each(|x| *x *= fx128::lit(1.0 + 1e-6));
    }),
    ("spring-chain", "the momentum is that of twice the mass", |_, _, e| {
        if e.invariant == Invariant::Momentum {
            e.value.iter_mut().for_each(|x| *x *= fx128::lit(2.0));
        }
    }),
];

// Fails if: a law is not held against the account: each fault breaks one.
#[test]
fn a_wrong_account_is_seen() {
    for (id, what, fault) in FAULTS {
        let scene = scenes::by_id(id).expect("a scene");
        let wrong = |t: fx128, seen: &Observation| {
            let mut entries = scene.scene().invariants(t, seen);
            entries.iter_mut().for_each(|entry| fault(scene.as_ref(), seen, entry));
            entries
        };
        assert!(!violations(scene.as_ref(), &wrong).is_empty(), "{id}: {what}");
    }
}
