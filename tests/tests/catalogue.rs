//! Every scene of the catalogue, held to what its theory column says beforehand, by the studies' own claims. A scene that is
//! registered is in it. It cannot see an error that the exact motion shares with the model: the oracles look for that.

use integrator::methods::MethodId;
use measure::convergence::Convergence;
use measure::rotation::Rotation;
use reports::Verdict;
use scenes::run::Precision;

use measure::study::{Selection, Study};
use measure::sweep::Progress;

fn everything(precisions: &[Precision]) -> Selection {
    Selection {
        scenes: scenes::all(),
        methods: MethodId::ALL.to_vec(),
        schemes: Vec::new(),
        precisions: precisions.to_vec(),
        steps: Vec::new(),
        length: None,
        quick: false,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    }
}

fn holds<S: Study>(selection: &Selection, at_least: usize) {
    let claims = S::claims(&S::measure(selection));
    assert!(claims.len() >= at_least, "{} claims", claims.len());
    for claim in claims {
        assert_eq!(claim.verdict, Verdict::Holds, "{claim:#?}");
    }
}

// Fails if: a bounce ignores the restitution; a sign, a factor or a stage time is wrong in any scene or method.
#[test]
fn every_method_has_its_order_and_constant_on_every_scene() {
    holds::<Convergence>(&everything(&[Precision::DoubleDouble]), scenes::IDS.len() * MethodId::ALL.len());
}

// Fails if: the second kick of the splitting is taken at the time of the first.
#[test]
fn every_scheme_for_rigid_bodies_has_its_order_and_step_law() {
    holds::<Rotation>(&everything(&[Precision::F64]), 200);
}
