//! A step allocates nothing: a run of many steps asks for as much memory as a run of few.

use integrator::methods::{MethodId, RigidStep};
use measure::ensemble::draw::{draw, with_a_rule};
use scenes::run::{Precision, Run};

/// Steps of a short run and of a long one; both are looked at twice, at the start and at the end.
const STEPS: [u64; 2] = [64, 4096];

fn allocations(work: impl Fn()) -> u64 {
    // What is made once for all runs (tables, thread locals) is made before.
    work();
    allocation_counter::measure(work).count_total
}

// The counter sees what it should see.
#[test]
fn an_allocation_is_counted() {
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![1.0; 100]))), 1);
    assert_eq!(allocations(|| ()), 0);
}

// Fails if: a model, a space or a method boxes or collects anything in a step.
#[test]
fn a_step_of_an_explicit_method_allocates_nothing_in_any_scene() {
    let explicit = MethodId::ALL.iter().filter(|method| !method.is_implicit());
    for &method in explicit {
        for scene in scenes::all() {
            for precision in [Precision::F32, Precision::F64] {
                let run = |steps| Run::new(method, precision, 1.0 / 64.0, steps);
                let [few, many] = STEPS.map(|steps| allocations(|| drop(scene.run(&run(steps), steps))));
                assert!(few > 0, "the observations of {} are not counted", scene.id());
                assert_eq!(many, few, "{} {}", scene.id(), method.id());
            }
        }
    }
}

// Fails if: a step for rigid bodies boxes or collects anything.
#[test]
fn a_step_for_rigid_bodies_allocates_nothing() {
    let scene = scenes::by_id("heavy-top").expect("a scene");
    for &step in RigidStep::ALL {
        let run = |steps| Run::new(step, Precision::F64, 1.0 / 64.0, steps);
        let [few, many] = STEPS.map(|steps| allocations(|| drop(scene.run_step(&run(steps), steps))));
        assert_eq!(many, few, "{}", step.id());
    }
}

// Fails if: lanes are filled and emptied in every step.
#[test]
fn a_step_in_lanes_allocates_nothing() {
    for id in with_a_rule() {
        let members = draw(scenes::by_id(id).expect("a scene").as_ref(), 8, 1).expect("a rule");
        let [few, many] = STEPS.map(|steps| allocations(|| drop(members.ends(0..8, MethodId::Rk4, 1.0 / 64.0, steps))));
        assert_eq!(many, few, "{id}");
    }
}
