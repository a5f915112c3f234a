//! The tradeoff study: fronts, costs at an error, optimal steps and stagnation.
//! Times are not looked at: they are not the same twice.

use std::sync::OnceLock;

use integrator::methods::MethodId;
use programs::options::Format;
use proptest::prelude::*;
use reports::Verdict;
use scenes::run::{Outcome, Precision};

use measure::study::{Selection, Study};
use measure::sweep::Progress;
use measure::tradeoff::candidate::{Candidate, candidates};
use measure::tradeoff::cost_at_error::{CostBound, offer, sweeps};
use measure::tradeoff::front::front;
use measure::tradeoff::rounding_optimum::minima;
use measure::tradeoff::stagnation::{HEIGHTS_M, moves, predicted_s};
use measure::tradeoff::verdict::{Factor, comparisons};
use measure::tradeoff::which::{ERRORS, choices};
use measure::tradeoff::{CostMeasure, Part, Row, Tradeoff};

const SCENES: [&str; 5] = ["constant-force", "oscillator", "pendulum", "kepler", "tennis-racket"];

fn selection(ids: &[&str]) -> Selection {
    Selection {
        scenes: ids.iter().map(|id| scenes::by_id(id).expect("a scene of the catalogue")).collect(),
        methods: MethodId::ALL.to_vec(),
        schemes: Vec::new(),
        precisions: Precision::ALL.to_vec(),
        steps: Vec::new(),
        length: None,
        quick: false,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    }
}

fn rows() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| Tradeoff::measure(&selection(&SCENES)))
}

fn of_scene(scene: &str) -> Vec<&'static Row> {
    rows().iter().filter(|row| row.scene == scene && row.part == Part::Run).collect()
}

// Fails if: the second kick of Verlet is not counted, a height is not in the middle of its binade, an ulp is taken for half of one.
#[test]
fn every_claim_holds() {
    let claims = Tradeoff::claims(rows());
    assert!(claims.len() >= 40, "{} claims", claims.len());
    for claim in claims {
        assert_eq!(claim.verdict, Verdict::Holds, "{claim:#?}");
    }
}

#[test]
fn claims_about_other_numbers_are_broken() {
    let mut wrong = rows().to_vec();
    for row in &mut wrong {
        row.evaluations += 1;
        row.theory_h_s = row.theory_h_s.map(|h| h * 2.0_f64.sqrt());
        // Rounding of another arithmetic: the minima are where they are, and theory looks for them elsewhere.
        row.scale = row.scale.map(|s| s * 1e4);
    }
    let claims = Tradeoff::claims(&wrong);
    for (kind, least) in [("tradeoff.evaluations", 10), ("tradeoff.stagnation", 6), ("tradeoff.rounding-optimum", 4)] {
        let of_kind: Vec<_> = claims.iter().filter(|claim| claim.id.starts_with(kind)).collect();
        let broken = of_kind.iter().filter(|claim| claim.verdict == Verdict::Broken).count();
        assert!(broken >= least, "{kind}: {broken} of {} are broken", of_kind.len());
    }
}

/// Everything but the measuring starts from the rows: the same rows from their CSV give the same tables, charts and claims.
#[test]
fn tables_and_charts_are_the_same_from_the_csv() {
    let written = measure::files::write::<Tradeoff>(rows()).expect("flat rows");
    let mut again: Vec<Row> = Vec::new();
    for file in measure::files::of::<Tradeoff>() {
        let Some((name, text)) = written.iter().find(|(name, _)| *name == file.name) else { continue };
        again.extend(file.read::<Tradeoff>(text, name).expect("what was written"));
    }
    assert_eq!(again, measure::files::in_order::<Tradeoff>(rows().to_vec()));
    let files = |rows: &[Row]| {
        programs::produce::from_rows::<Tradeoff>(rows, &programs::plan::Plan::default(), Format::Svg)
            .expect("rows have a form")
            .files
    };
    assert!(files(rows()) == files(&again));
}

fn a_row() -> impl Strategy<Value = Row> {
    let template = of_scene("oscillator")[0].clone();
    let outcome = prop_oneof![
        3 => Just(Outcome::Finished),
        1 => Just(Outcome::Diverged),
        1 => Just(Outcome::NotConverged),
    ];
    let error =
        prop_oneof![4 => (1e-9..1.0).prop_map(Some), 1 => Just(None), 1 => Just(Some(f64::NAN)), 1 => Just(Some(0.0))];
    (outcome, error, 1_u64..1000, prop::option::of(1.0..1e3)).prop_map(move |(outcome, error, evaluations, ns)| Row {
        precision: Precision::F64,
        outcome,
        error,
        evaluations,
        least_ns_per_step: ns,
        ..template.clone()
    })
}

proptest! {
    // Fails if: a failed run scores, a NaN counts as a small error, or a run is kept that another beats in both.
    #[test]
    fn a_front_holds_what_nothing_beats_and_nothing_that_failed(rows in prop::collection::vec(a_row(), 0..40)) {
        let rows: Vec<&Row> = rows.iter().collect();
        for charge in CostMeasure::ALL {
            let on_front = front(&rows, charge);
            let value = |i: usize| (charge.of(rows[i]), rows[i].error);
            for &i in &on_front {
                prop_assert_eq!(rows[i].outcome, Outcome::Finished);
                prop_assert!(rows[i].error.is_some_and(f64::is_finite) && charge.of(rows[i]).is_some());
            }
            for (j, row) in rows.iter().enumerate() {
                if row.scored().is_none() || charge.of(row).is_none() {
                    continue;
                }
                let (cost, error) = value(j);
                let is_matched = on_front.iter().any(|&i| value(i).0 <= cost && value(i).1 <= error);
                prop_assert!(is_matched, "{:?} is on no front and nothing matches it", value(j));
                let is_beaten = on_front.iter().any(|&i| {
                    let (c, e) = value(i);
                    c <= cost && e <= error && (c < cost || e < error)
                });
                prop_assert!(!(is_beaten && on_front.contains(&j)), "{:?} is beaten and on the front", value(j));
            }
        }
    }
}

/// error = C h: the price of a level is C T / level evaluations, wherever the grid of steps falls.
#[test]
fn the_price_of_a_level_is_interpolated_between_runs() {
    let template = of_scene("oscillator").into_iter().find(|row| row.method == "semi-implicit-euler").expect("a run");
    let run = |k: u32, error: f64| Row {
        precision: Precision::F64,
        outcome: Outcome::Finished,
        steps: 1 << k,
        h_s: 1.0 / f64::from(1_u32 << k),
        evaluations: 1 << k,
        error: Some(error),
        ..template.clone()
    };
    let falling: Vec<Row> = (3..12).map(|k| run(k, 0.7 / f64::from(1_u32 << k))).collect();
    let price =
        |rows: &[Row], level: f64| match offer(&rows.iter().collect::<Vec<_>>(), level, CostMeasure::Evaluations) {
            CostBound::At(price) => Some(price.cost),
            _ => None,
        };
    for level in [1e-2, 3.3e-3, 1e-3] {
        let cost = price(&falling, level).expect("met");
        assert!((cost / (0.7 / level) - 1.0).abs() < 1e-12, "{level}: {cost}");
    }
    assert_eq!(price(&falling, 1e-5), None, "beyond the finest run");
    assert!(matches!(offer(&falling.iter().collect::<Vec<_>>(), 1e-5, CostMeasure::Evaluations), CostBound::Above(_)));
    // A lucky run in between is no price.
    let mut lucky = falling.clone();
    lucky[1].error = Some(1e-4);
    assert_eq!(price(&lucky, 3.3e-3), price(&falling, 3.3e-3));
    // Neither is one that failed.
    let mut failed = falling.clone();
    failed[8].outcome = Outcome::Diverged;
    failed[7].outcome = Outcome::Diverged;
    assert_eq!(price(&failed, 1e-3), None);
}

/// Written as a range of both sides of the prediction, a part in a thousand wide: one ulp of the step is 1e-7 of it in f32.
#[test]
fn a_body_at_rest_stays_where_it_is_below_the_predicted_step_and_falls_above() {
    for precision in [Precision::F32, Precision::F64] {
        for height in HEIGHTS_M {
            let h = predicted_s(precision, height);
            assert!(
                !moves(precision, height, 0.999 * h) && moves(precision, height, 1.001 * h),
                "{precision:?} {height}"
            );
        }
    }
    // sqrt(2^-24 / 9.75): by hand.
    assert!(
        (predicted_s(Precision::F32, 1.5) / 7.818_76e-5 - 1.0).abs() < 1e-5,
        "{}",
        predicted_s(Precision::F32, 1.5)
    );
    // Double-double resolves a step that f64 does not.
    assert!(moves(Precision::DoubleDouble, 1.5, 0.5 * predicted_s(Precision::F64, 1.5)));
}

#[test]
fn a_u_curve_has_its_minimum_inside_the_sweep() {
    let minima = minima(rows());
    let of = |method: &str, precision| {
        minima.iter().find(|m| m.scene == "tennis-racket" && m.method == method && m.precision == precision)
    };
    for (method, precision) in [
        ("velocity-verlet/body-omega", Precision::F32),
        ("rk4/body-omega", Precision::F32),
        ("rk4/body-omega", Precision::F64),
    ] {
        let found = of(method, precision).unwrap_or_else(|| panic!("{method} in {precision:?} has no minimum"));
        assert!(found.finest_error >= 2.0 * found.error, "{found:?}");
    }
    // Where the sweep ends before rounding is felt there is none.
    assert!(
        of("semi-implicit-euler/body-omega", Precision::F64).is_none()
            && of("rk4/body-omega", Precision::DoubleDouble).is_none()
    );
}

/// C1 / e against 4 (C4 / e)^(1/4): from 1e-2 to 1e-4 the factor grows by 100^(3/4) = 31, less a factor of two or so at each end,
/// where RK4 meets 1e-2 with its coarsest run and semi-implicit Euler misses 1e-4 with its finest.
#[test]
fn semi_implicit_euler_is_dear_where_the_error_is_small() {
    let comparisons = comparisons(rows(), CostMeasure::Evaluations);
    for scene in ["oscillator", "pendulum", "kepler", "tennis-racket"] {
        let at = |level: f64| {
            comparisons.iter().find(|d| d.scene == scene && d.level == level).expect("a level of the table")
        };
        let factor = |level| match at(level).beaten_by() {
            Some(Factor::Of(x) | Factor::AtLeast(x)) => x,
            other => panic!("{scene}: {other:?}"),
        };
        assert!(factor(1e-4) > 5.0 * factor(1e-2), "{scene}: {} at 1e-2, {} at 1e-4", factor(1e-2), factor(1e-4));
        assert!(!at(1e-6).semi_implicit_is_best());
    }
}

/// The angular velocity of the world and of the body make the same motion with semi-implicit Euler, to rounding: the errors agree
/// to the roundings of n steps, which the double-double run tells.
#[test]
fn storages_have_the_same_error_with_semi_implicit_euler_and_no_other_method() {
    let rows = of_scene("tennis-racket");
    let find = |method: &str, precision, steps| {
        rows.iter().find(|r| r.method == method && r.precision == precision && r.steps == steps).expect("a run")
    };
    let pair = |method: &str| {
        ["world-omega", "body-omega"].map(|storage| find(&format!("{method}/{storage}"), Precision::DoubleDouble, 256))
    };
    for method in ["semi-implicit-euler", "explicit-euler", "rk4"] {
        let [world, body] = pair(method);
        let (a, b) = (world.error.expect("finished"), body.error.expect("finished"));
        assert_eq!((a - b).abs() <= 1e-15 * a, method == "semi-implicit-euler", "{method}: {a} and {b}");
        assert_eq!(world.evaluations, body.evaluations);
    }
}

#[test]
fn every_candidate_is_found_by_its_name() {
    for id in ["pendulum", "tennis-racket"] {
        for candidate in candidates(scenes::by_id(id).expect("a scene").as_ref(), MethodId::ALL, &[]) {
            assert_eq!(Candidate::from_id(&candidate.id()), Some(candidate));
        }
    }
    assert_eq!(Candidate::from_id("rk5"), None);
}

#[test]
fn sweeps_are_ordered_and_complete() {
    let rows = of_scene("kepler");
    let sweeps = sweeps(&rows);
    assert_eq!(sweeps.iter().map(Vec::len).sum::<usize>(), rows.len());
    assert!(sweeps.iter().all(|sweep| sweep.is_sorted_by_key(|row| row.steps)));
}

/// Three scenes on which RK4 is cheaper, dearer, and not to be compared: there both sweeps end above the level.
#[test]
fn what_two_sweeps_leave_open_is_not_counted() {
    let template = of_scene("oscillator").into_iter().find(|row| row.method == "semi-implicit-euler").expect("a run");
    let sweep = |scene: &str, method: &str, evaluations_at_level: f64| -> Vec<Row> {
        (3..10)
            .map(|k| Row {
                scene: scene.to_owned(),
                method: method.to_owned(),
                precision: Precision::F64,
                steps: 1 << k,
                h_s: 1.0 / f64::from(1_u32 << k),
                evaluations: 1 << k,
                error: Some(1e-2 * evaluations_at_level / f64::from(1_u32 << k)),
                ..template.clone()
            })
            .collect()
    };
    // The runs have 8 to 512 evaluations: 2000 are beyond the sweep. Verlet makes the level one that is reached.
    let cases = [("cheap", 100.0, 50.0), ("dear", 20.0, 60.0), ("open", 2000.0, 4000.0), ("bound", 20.0, 2000.0)];
    let rows: Vec<Row> = cases
        .iter()
        .flat_map(|&(scene, own, rk4)| {
            let methods = [("semi-implicit-euler", own), ("rk4", rk4), ("velocity-verlet", 30.0)];
            methods.map(|(method, at)| sweep(scene, method, at)).concat()
        })
        .collect();
    let line = |rows: &[Row]| {
        let tables = Tradeoff::tables(rows).expect("rows have tables");
        let csv = &tables.iter().find(|table| table.name == "tradeoff-question").expect("the question").csv;
        let mut lines = csv.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let names = lines.next().expect("a header");
        let level = lines.find(|l| l[0].parse() == Ok(1e-2) && l[1] == "evaluations").expect("the level");
        let of = |name: &str| level[names.iter().position(|n| n == name).expect("a column")].clone();
        ["scenes", "rk4_known", "semi_implicit_beats_rk4", "median_rk4_over_semi_implicit"].map(of)
    };
    // Factors 0.5, 3, unknown and > 25.6: the median of the three known is 3.
    let [scenes, known, beats, median] = line(&rows);
    assert_eq!([scenes, known, beats], ["4", "3", "2"]);
    assert!((median.parse::<f64>().expect("a number") - 3.0).abs() < 1e-12, "{median}");
    // Without the dear one 0.5 and > 25.6 are left, and the upper middle is a bound.
    let rest: Vec<Row> = rows.into_iter().filter(|row| row.scene != "dear").collect();
    assert_eq!(line(&rest), ["3", "2", "1", ""]);
}

/// Two oscillations of time scales 1/2 s and 2 s and sizes 1 and 10, with errors c h^p: what each method needs is known.
#[test]
fn the_method_that_is_named_does_the_least_work() {
    let template = of_scene("oscillator").into_iter().find(|row| row.precision == Precision::F64).expect("a run");
    // Error at the step h, relative to the size, with h in time scales: 0.32 h, 0.08 h^2 and 0.01 h^4; evaluations a step 1, 2, 4.
    let methods = [("semi-implicit-euler", 0.32, 1, 1), ("velocity-verlet", 0.08, 2, 2), ("rk4", 0.01, 4, 4)];
    let mut rows = Vec::new();
    for (scene, time_scale_s, scale) in [("oscillator", 0.5, 1.0), ("pendulum", 2.0, 10.0)] {
        for (method, c, order, evaluations) in methods {
            for (k, precision) in (0..16).flat_map(|k| [(k, Precision::F64), (k, Precision::F32)]) {
                let h = 4.0 / f64::from(1_u32 << k);
                rows.push(Row {
                    scene: scene.to_owned(),
                    method: method.to_owned(),
                    precision,
                    steps: 1 << k,
                    h_s: h * time_scale_s,
                    time_scale_s: Some(time_scale_s),
                    scale: Some(scale),
                    evaluations: evaluations << k,
                    error: Some(c * h.powi(order) * scale),
                    ..template.clone()
                });
            }
        }
    }
    let found = choices(&rows);
    assert_eq!(found.len(), ERRORS.len(), "one kind");
    // h of an error e is (e / c)^(1/p): 1/32, 0.354 and 1 for a hundredth; work is evaluations over h.
    for (choice, error) in found.iter().zip(ERRORS) {
        let best = choice.best.as_ref().expect("a method");
        let step = (error / 0.01_f64).powf(0.25);
        let work = (4.0 / step) / (0.32 / error);
        let is = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
        assert_eq!((best.method.as_str(), choice.scenes, best.reached, best.never), ("rk4", 2, 2, 0));
        assert!(is(best.step, step), "{error}: {} is not {step}", best.step);
        if error > 1e-5 {
            assert!(
                best.work.is_some_and(|found| is(found, work)) && !best.work_is_at_most,
                "{error}: {best:?} {work}"
            );
        } else {
            // The sweep of semi-implicit Euler ends at h = 4 / 2^15 above the error: its work is a lower bound.
            assert!(best.work.is_some_and(|found| is(found, 4.0 / step / 8192.0)) && best.work_is_at_most, "{best:?}");
        }
    }
    // Ten times the constant of RK4, and Verlet leads at a hundredth: 2 / 0.354 evaluations a time scale beside 4 / 0.562.
    for row in rows.iter_mut().filter(|row| row.method == "rk4") {
        row.error = row.error.map(|e| 10.0 * e);
    }
    let best = choices(&rows).swap_remove(0).best.expect("a method");
    assert!(best.method == "velocity-verlet" && (best.step - 0.125_f64.sqrt()).abs() < 1e-9, "{best:?}");
}
