//! The same plan gives the same bytes: whatever the number of threads, and again.
//!
//! Not seen here: other machines. The arithmetic is correctly rounded or taken from libm, which is what makes them agree.

use integrator::methods::MethodId;
use measure::convergence::Convergence;
use measure::drift::DriftStudy;
use reports::write_csv;
use scenes::run::Precision;

use measure::study::{Selection, Study};
use measure::sweep::Progress;

fn selection() -> Selection {
    Selection {
        scenes: ["oscillator", "torque-free-spin"].map(|id| scenes::by_id(id).expect("a scene")).into(),
        methods: vec![MethodId::SemiImplicitEuler, MethodId::Rk4, MethodId::ImplicitMidpoint],
        schemes: Vec::new(),
        precisions: vec![Precision::F32, Precision::F64, Precision::DoubleDouble],
        steps: vec![64, 100, 32],
        length: None,
        quick: true,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    }
}

fn bytes<S: Study>(threads: usize) -> String {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| write_csv(&S::measure(&selection())).expect("rows are written"))
}

fn is_deterministic<S: Study>(rows: usize) {
    let alone = bytes::<S>(1);
    assert_eq!(alone.lines().count(), 1 + rows);
    assert_eq!(bytes::<S>(2), alone, "two threads");
    assert_eq!(bytes::<S>(3), alone, "more threads than cores");
    assert_eq!(bytes::<S>(1), alone, "again");
}

// Fails if: in_parallel returns its results in the order in which they end up.
#[test]
fn convergence_rows_are_the_same_bytes_on_any_number_of_threads() {
    // Two quantities of each scene, three methods, three precisions, three numbers of steps.
    is_deterministic::<Convergence>(2 * 2 * 3 * 3 * 3);
}

// Fails if: in_parallel returns its results in the order in which they end up.
#[test]
fn drift_rows_are_the_same_bytes_on_any_number_of_threads() {
    // Energy of the oscillator; energy, norm and direction of the momentum, and the quaternion of the body; 128 stretches, f32 and f64.
    is_deterministic::<DriftStudy>((1 + 4) * 3 * 2 * 128);
}

// Fails if: rows are taken in the order of cost (the finest run first), or of precision.
#[test]
fn rows_come_in_the_order_of_the_plan() {
    let rows = Convergence::measure(&selection());
    let mut keys: Vec<_> = rows.iter().map(|r| (r.scene.clone(), r.method.clone(), r.steps, r.precision)).collect();
    keys.dedup();
    let plan = selection();
    let mut expected = Vec::new();
    for scene in &plan.scenes {
        for method in &plan.methods {
            for steps in &plan.steps {
                let names = (scene.id().to_owned(), method.id().to_owned());
                expected.extend(plan.precisions.iter().map(|p| (names.0.clone(), names.1.clone(), *steps, *p)));
            }
        }
    }
    assert_eq!(keys, expected);
}
