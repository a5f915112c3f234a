//! Per-step laws, nutation factors, destinations and conserved quantities of the schemes for rigid bodies; for each a
//! negative control: the same verdict on another scheme's numbers must be 'broken'.

use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::{AttitudeUpdate, Formulation};
use measure::rotation::laws::{NUTATION_STEPS_S, TOPS, generic_body, nutation, nutation_factor, step_laws};
use measure::rotation::long::{disc_runs, drift, long_run, long_starts};
use measure::rotation::{Experiment, Rotation, Row, Scheme};
use measure::study::Study;
use reports::{Claim, Verdict};
use scenes::run::{Precision, Run};

fn scheme(id: &str) -> Scheme {
    Scheme::from_id(id).unwrap_or_else(|| panic!("{id} is compared"))
}

/// The claims that rows of one scheme would make under another's name.
fn claims_as(rows: &[Row], name: &str) -> Vec<Claim> {
    let renamed: Vec<Row> = rows.iter().map(|row| Row { scheme: name.to_owned(), ..row.clone() }).collect();
    Rotation::claims(&renamed)
}

fn assert_all(claims: &[Claim], verdict: Verdict, least: usize) {
    assert!(claims.len() >= least, "{} claims", claims.len());
    for claim in claims {
        assert_eq!(claim.verdict, verdict, "{}: theory {}, measured {}", claim.id, claim.theory, claim.measured);
    }
}

#[test]
fn every_scheme_has_its_own_name_and_is_found_by_it() {
    let all = Scheme::all();
    for (i, one) in all.iter().enumerate() {
        assert_eq!(scheme(&one.id()), *one);
        assert!(all[..i].iter().all(|other| other.id() != one.id()));
    }
    for &step in RigidStep::ALL {
        assert!(all.contains(&Scheme::rigid(step, AttitudeUpdate::Exponential)), "{} is not compared", step.id());
        assert!(!step.formula().is_empty() && !step.source().is_empty() && step.evaluations() > 0);
    }
}

// Fails if: any of the laws has the wrong sign or factor, or a step takes omega, attitude or torque from the wrong end.
#[test]
fn one_step_changes_energy_and_momentum_as_theory_says() {
    let rows = step_laws(&generic_body(), &Scheme::all());
    let against: Vec<&Row> = rows.iter().filter(|row| row.theory.is_some()).collect();
    assert!(against.len() >= 50, "{} laws", against.len());
    for row in against {
        assert_eq!(
            row.agrees(),
            Some(true),
            "{} {}: {:?} against {:?}",
            row.scheme,
            row.quantity,
            row.value,
            row.theory
        );
    }
}

#[test]
fn the_step_laws_tell_the_schemes_apart() {
    let law = |id: &str| -> Vec<(f64, f64, f64)> {
        let rows = step_laws(&generic_body(), &[scheme(id)]);
        rows.iter()
            .map(|row| (row.value.expect("finite"), row.theory.expect("a law"), row.tolerance.expect("a law")))
            .collect()
    };
    let groups = [
        "semi-implicit-euler/body-omega",
        "explicit-euler/world-omega",
        "explicit-euler/world-momentum",
        "implicit-gyroscopic",
        "restored-momentum",
        "free-splitting",
    ];
    for a in groups {
        for b in groups.into_iter().filter(|b| *b != a) {
            let apart = law(a).iter().zip(law(b)).any(|(a, b)| (a.0 - b.1).abs() > b.2);
            assert!(apart, "{a} keeps the laws of {b}");
        }
    }
}

// Fails if: the gyroscopic term has another factor, Newton's step another Jacobian, or the attitude moves with another omega.
#[test]
fn nutation_is_multiplied_by_the_factor_of_theory() {
    for (name, inertia, omega3) in TOPS {
        for h_s in NUTATION_STEPS_S {
            for row in nutation(name, inertia, omega3, h_s, &Scheme::all()) {
                assert_ne!(
                    row.agrees(),
                    Some(false),
                    "{} {name} {h_s}: {:?} against {:?}",
                    row.scheme,
                    row.value,
                    row.theory
                );
            }
        }
    }
}

#[test]
fn the_nutation_of_a_body_that_is_a_hundredth_rounder_is_told_apart() {
    let (name, [inertia_1, inertia_3], omega3) = TOPS[0];
    let h_s = 1.0 / 60.0;
    for id in [
        "semi-implicit-euler/world-omega",
        "explicit-euler/world-omega",
        "explicit-euler/world-momentum",
        "implicit-gyroscopic",
    ] {
        let row = &nutation(name, [inertia_1, inertia_3], omega3, h_s, &[scheme(id)])[0];
        let other = nutation_factor(scheme(id), 1.01 * inertia_3 / inertia_1, omega3 * h_s).expect("a formula");
        let off = (row.value.expect("finite") - other).abs();
        assert!(off > 1e3 * row.tolerance.expect("a formula"), "{id}: {off}");
    }
}

// Fails if: the world momentum drifts, the implicit step gains energy, the restored step does not restore.
#[test]
fn long_runs_end_where_theory_says_and_the_verdict_knows_the_difference() {
    let [most, least, far] = long_starts();
    let end_s = 400.0;
    let run = |(name, body): &(&str, _), id: &str| long_run(name, body, end_s, &[scheme(id)]);
    let momentum = "semi-implicit-euler/world-momentum";
    assert_all(&claims_as(&run(&far, momentum), momentum), Verdict::Holds, 1);
    assert_all(&claims_as(&run(&far, "free-splitting"), "free-splitting"), Verdict::Holds, 1);
    assert_all(&claims_as(&run(&most, "implicit-gyroscopic"), "implicit-gyroscopic"), Verdict::Holds, 1);
    assert_all(&claims_as(&run(&least, "implicit-gyroscopic"), "implicit-gyroscopic"), Verdict::Holds, 1);
    assert_all(&claims_as(&run(&most, "restored-momentum"), "restored-momentum"), Verdict::Holds, 1);
    assert_all(&claims_as(&run(&least, "restored-momentum"), "restored-momentum"), Verdict::Holds, 1);
    // Other schemes' motions under these names.
    assert_all(&claims_as(&run(&far, "free-splitting"), momentum), Verdict::Broken, 1);
    assert_all(&claims_as(&run(&far, momentum), "free-splitting"), Verdict::Broken, 1);
    assert_all(&claims_as(&run(&most, "restored-momentum"), "implicit-gyroscopic"), Verdict::Broken, 1);
    assert_all(&claims_as(&run(&least, "implicit-gyroscopic"), "restored-momentum"), Verdict::Broken, 1);
}

#[test]
fn the_disc_fares_as_its_nutation_factor_says_and_not_as_anothers() {
    let of = |id: &str| disc_runs(&[scheme(id)]);
    let schemes = [
        "semi-implicit-euler/body-omega",
        "explicit-euler/world-omega",
        "implicit-gyroscopic",
        "implicit-midpoint/body-omega",
    ];
    for id in schemes {
        assert_all(&claims_as(&of(id), id), Verdict::Holds, 1);
    }
    assert_all(&claims_as(&of("implicit-gyroscopic"), "semi-implicit-euler/body-omega"), Verdict::Broken, 1);
    assert_all(&claims_as(&of("semi-implicit-euler/body-omega"), "implicit-midpoint/body-omega"), Verdict::Broken, 1);
    assert_all(&claims_as(&of("implicit-midpoint/body-omega"), "implicit-gyroscopic"), Verdict::Broken, 1);
}

// Fails if: a list names a conserved quantity that a step does not keep.
#[test]
fn what_a_step_says_it_conserves_it_conserves_to_rounding() {
    for scheme in Scheme::all() {
        let rows = drift(&generic_body(), &[scheme]);
        assert_all(&claims_as(&rows, &scheme.id()), Verdict::Holds, 0);
    }
    // Semi-implicit Euler keeps nothing: its numbers break every one of these claims.
    let rows = drift(&generic_body(), &[scheme("semi-implicit-euler/body-omega")]);
    for id in ["free-splitting", "momentum-midpoint", "restored-momentum", "implicit-midpoint/body-omega"] {
        assert_all(&claims_as(&rows, id), Verdict::Broken, 1);
    }
}

/// The trap of every conservation test: a scheme on the wrong motion that conserves T and |L| to rounding.
#[test]
fn without_the_gyroscopic_term_energy_and_momentum_are_conserved_and_the_motion_is_wrong() {
    let wrong =
        Scheme::general(MethodId::SemiImplicitEuler, Formulation::WithoutGyroscopicTerm, AttitudeUpdate::Exponential);
    let scene = scenes::by_id("torque-free-spin").expect("on the list");
    let end_s = scene.scene().info().horizon_s;
    let exact = scene.exact(integrator::Real::lit(end_s));
    let error = |scheme: Scheme, steps: u64| {
        let run = scene.run(&Run::new(scheme, Precision::F64, end_s, steps), steps).expect("a rigid body");
        run.end().expect("finite").distances(&exact)[0].1
    };
    // Not by the last digit, but by what is left of the motion after a few thousandths of a radian a step.
    let [coarse, fine] = [64, 4096].map(|steps| error(wrong, steps));
    assert!(coarse > 0.5 && (fine / coarse - 1.0).abs() < 1e-9, "{coarse} and {fine}");
    let right = Scheme::general(MethodId::SemiImplicitEuler, Formulation::WorldOmega, AttitudeUpdate::Exponential);
    let ratio = error(right, 2048) / error(right, 4096);
    assert!((ratio - 2.0).abs() < 0.02, "{ratio}");
    assert_all(&claims_as(&drift(&generic_body(), &[wrong]), &wrong.id()), Verdict::Holds, 2);
}

#[test]
fn rows_come_back_from_csv_and_make_the_same_claims() {
    let rows = step_laws(&generic_body(), &[scheme("implicit-gyroscopic"), scheme("free-splitting")]);
    let text = reports::write_csv(&rows).expect("flat rows");
    let back: Vec<Row> = reports::read_csv(&text, "rotation.csv").expect("what was written");
    assert_eq!(back, rows);
    assert_eq!(Rotation::claims(&back), Rotation::claims(&rows));
    assert!(rows.iter().all(|row| row.experiment == Experiment::StepLaw));
}
