//! The gate: what the file may hold, what turns it red, what it says, and that it lets no wrong method pass.

use gate::candidate::Candidate;
use gate::deaths::deaths;
use gate::known::Known;
use gate::mutants::Mutant;
use gate::row;
use gate::row::{Kind, Row, Subject};
use gate::stepper::{Ask, Stepper};
use gate::{Bounds, Judged, audit, check, format, propose, update};
use measure::sweep::Progress;
use scenes::observation::Quantity;
use scenes::run::{Outcome, Precision, Trajectory};

const FILE: &[u8] = include_bytes!("../../studies/gate/data/bounds.csv");

fn committed() -> Bounds {
    Bounds::parse(FILE, "bounds.csv").expect("the committed file is read")
}

fn judged(bounds: &Bounds, wanted: impl Fn(&Row) -> bool) -> Vec<Judged> {
    let rows: Vec<&Row> = bounds.rows.iter().filter(|row| wanted(row)).collect();
    assert!(!rows.is_empty());
    bounds.check(&rows, &Progress::silent()).expect("rows that were read name runs")
}

// Fails if: a method, a scene, a precision or the driver computes anything else than it did.
#[test]
fn every_committed_bound_holds() {
    let bounds = committed();
    let judged = judged(&bounds, |_| true);
    assert_eq!(judged.len(), bounds.rows.len(), "a row is skipped");
    assert!(!judged.iter().any(|one| one.verdict() != reports::Verdict::Holds), "{}", check::report(&judged));
}

fn has_formula(scene: &str, method: &str) -> bool {
    let scene = scenes::by_id(scene).expect("a scene of the catalogue");
    let stepper = Stepper::from_id(method, scene.as_ref()).expect("a method of the scene");
    stepper.of_theory().is_some_and(|method| scene.scene().stability_limit(method).is_some())
}

/// For whoever has added a method or a scene.
const REMEDY: &str = "no bound is committed; run `cargo run --release --bin bounds -- --update --reason \"why\"` \
    (reports/guides/adding.md says what else may turn red)";

// Fails if: a scene or a method is registered and has no bound.
#[test]
fn every_scene_and_method_has_an_error_and_its_evaluations_bounded() {
    let bounds = committed();
    let rows = &bounds.rows;
    for (scene, method, subject) in bounds.known.combinations() {
        let has = |kind| {
            rows.iter().any(|r| r.scene == scene && r.method == method && r.quantity == subject && r.kind == kind)
        };
        match subject {
            Subject::Error(_) => assert!(has(Kind::ErrorAtStep), "{scene} {method} {}: {REMEDY}", subject.id()),
            Subject::Evaluations => assert!(has(Kind::EvaluationsPerStep), "{scene} {method}: {REMEDY}"),
            // A limit of which no formula is known is not bounded; the audit lists it.
            Subject::Step => {
                assert!(has(Kind::StabilityLimit) || !has_formula(scene, &method), "{scene} {method}: {REMEDY}");
            }
            Subject::Invariant(_) => {}
        }
    }
}

// Fails if: a check depends on what else ran, on the order, or on the number of threads.
#[test]
fn a_check_gives_the_same_bytes_again() {
    let bounds = committed();
    let first = Known::first_presets();
    let once = || format::csv(&judged(&bounds, |r| row::is_quick(r, &first))).expect("flat rows");
    let reference = once();
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        assert!(pool.install(once) == reference, "{threads} threads");
    }
}

fn with_row(change: impl Fn(&mut Row), wanted: impl Fn(&Row) -> bool) -> Bounds {
    let mut bounds = committed();
    bounds.rows.retain(wanted);
    bounds.rows.iter_mut().for_each(change);
    assert!(!bounds.rows.is_empty());
    bounds
}

fn is_position_of_rk4(row: &Row) -> bool {
    row.scene == "oscillator"
        && row.method == "rk4"
        && row.precision == Precision::F64
        && row.quantity == Subject::Error(Quantity::Position)
        && row.kind == Kind::ErrorAtStep
}

// Fails if: a bound is one-sided, or the verdict does not look at it.
#[test]
fn the_gate_turns_red_on_either_side_and_says_by_how_much() {
    let too_low = with_row(|row| row.low = row.measured * 1.25, is_position_of_rk4);
    let too_high = with_row(|row| row.high = row.measured * 0.5, is_position_of_rk4);
    for (bounds, excess) in [(too_low, "20.000 % below"), (too_high, "100.000 % above")] {
        let judged = judged(&bounds, |_| true);
        assert!(judged[0].is_broken());
        assert_eq!(judged[0].excess(), excess);
        let text = check::report(&judged);
        let name = text.find("oscillator rk4 f64 position error-at-step").expect("the broken row is told");
        assert!(text.starts_with("1 bounds are broken, 0 hold, 0 are not tested\n") && name < 80, "{text}");
    }
}

// Fails if: the number when the bound was set is not what the change is told against.
#[test]
fn what_changed_since_the_bound_was_set_is_told() {
    let bounds =
        with_row(|row| (row.measured, row.high) = (row.measured / 2.0, row.measured * 0.75), is_position_of_rk4);
    assert_eq!(judged(&bounds, |_| true)[0].change(), "x 2.000000");
}

/// A candidate that fails in one way or another.
enum Failing {
    Diverges,
    IsNaN,
    CannotRun,
}

impl Candidate for Failing {
    fn run(&self, ask: &Ask<'_>) -> Option<Trajectory> {
        let mut run = Stepper::from_id("rk4", ask.scene).expect("a method").run(ask)?;
        match self {
            Failing::Diverges => (run.outcome, run.failed_step) = (Outcome::Diverged, Some(3)),
            Failing::IsNaN => run.seen.iter_mut().for_each(|(_, seen)| {
                seen.values.iter_mut().for_each(|(_, value)| {
                    if let scenes::observation::Value::Vector(x) = value {
                        x.iter_mut().for_each(|x| *x = faer::fx128::from_f64(f64::NAN));
                    }
                });
            }),
            Failing::CannotRun => return None,
        }
        Some(run)
    }
}

// Fails if: a run that failed, or a number that is none, passes or is left out.
#[test]
fn a_run_that_fails_and_a_number_that_is_none_break_their_rows() {
    let bounds =
        with_row(|_| (), |row| row.method == "rk4" && row.scene == "kepler" && row.kind != Kind::StabilityLimit);
    let held = |failing: &Failing| bounds.hold("rk4", failing).expect("rk4 has bounds");
    let diverged = held(&Failing::Diverges);
    assert_eq!(diverged.broken().len(), diverged.judged.len());
    assert!(check::report(&diverged.judged).contains("diverged at step 3"));
    let nan = held(&Failing::IsNaN);
    let errors: Vec<&Judged> = nan.judged.iter().filter(|one| one.row.kind != Kind::EvaluationsPerStep).collect();
    assert!(!errors.is_empty() && errors.iter().all(|one| one.is_broken()), "{}", check::report(&nan.judged));
    let none = bounds.hold("rk4", &Failing::CannotRun).expect_err("nothing was run").to_string();
    assert!(none.contains("can run none of its") && none.contains("Flat"), "{none}");
}

fn deaths_of_none(bounds: &Bounds) -> Vec<gate::deaths::Death> {
    deaths(bounds, &[], &Progress::silent()).expect("nothing to run")
}

// Fails if: a wrong method passes, or a row does not break under the mutant that it names.
#[test]
fn every_mutant_is_killed_by_every_row_that_names_it() {
    let bounds = committed();
    // One row of theory and one measured row for each mutant and method: the binary runs them all.
    let mut rows: Vec<&Row> = Vec::new();
    for row in bounds.rows.iter().filter(|row| !row.mutant.is_empty() && row.precision == Precision::F64) {
        let same = |other: &&&Row| {
            other.mutant == row.mutant && other.method == row.method && other.is_theory() == row.is_theory()
        };
        if !rows.iter().any(|other| same(&other)) {
            rows.push(row);
        }
    }
    let deaths = deaths(&bounds, &rows, &Progress::silent()).expect("mutants apply where they are named");
    assert_eq!(deaths.len(), Mutant::ALL.len());
    for death in deaths {
        assert!(!death.fails(), "{} survives: {:?}", death.mutant.id(), death.spared);
        let killer = &death.killer().expect("a row kills it").row;
        let named = |row: &Row| death.mutant.words().iter().any(|word| row.reason.contains(word));
        assert!(named(killer) || !death.killers.iter().any(|one| named(&one.row)), "{}", killer.name());
    }
    let none = deaths_of_none(&bounds);
    assert!(none.iter().all(|death| death.fails() && death.verdict() == "✗ no row names it"));
}

// Fails if: an update moves bounds without a reason, moves a row that holds, or loses the reason that a row had.
#[test]
fn an_update_wants_a_reason_and_leaves_what_holds_as_it_is() {
    let chosen = |row: &Row| row.scene == "oscillator" && row.method == "rk4" && row.precision == Precision::F64;
    let mut bounds = with_row(|_| (), chosen);
    for reason in [None, Some(""), Some("  ")] {
        let updated = update::update(&bounds, reason, false, &Progress::silent());
        let error = updated.err().expect("no reason").to_string();
        assert!(error.contains("--reason"), "{error}");
    }
    let broken = bounds.rows.iter().position(is_position_of_rk4).expect("there is one");
    let right = bounds.rows[broken].clone();
    bounds.rows[broken].high = right.low;
    bounds.rows[broken].low = 0.5 * right.low;
    let (moved, kept) = moved(&bounds, false);
    assert_eq!((moved.len(), kept.len()), (1, 0));
    let (old, new) = &moved[0];
    assert_eq!(*old, bounds.rows[broken]);
    assert_eq!((new.low, new.high, new.measured), (right.low, right.high, right.measured));
    let known = right.reason.strip_prefix("measured x 1.05: ").expect("a measured row");
    assert_eq!(new.reason, format!("measured x 1.05: a test; before: {known}"));
    assert_eq!(new.mutant, right.mutant);
}

fn moved(bounds: &Bounds, theory: bool) -> (Vec<(Row, Row)>, Vec<Judged>) {
    update::moved(bounds, update::Why { reason: "a test", theory }, &Progress::silent()).expect("a number")
}

// Fails if: a measurement moves theory unasked, or a moved interval is wider for its size than it was.
#[test]
fn an_update_leaves_theory_and_keeps_the_width() {
    let wrong = |kind: Kind, shift: fn(&mut Row)| {
        let of_kind = move |row: &Row| row.kind == kind && row.precision == Precision::F64 && row.is_theory();
        let mut bounds = with_row(|_| (), |row| row.scene == "oscillator" && of_kind(row));
        bounds.rows.truncate(1);
        bounds.rows.iter_mut().for_each(shift);
        bounds
    };
    let order = wrong(Kind::Order, |row| (row.low, row.high) = (row.low + 7.0, row.high + 7.0));
    let constant = wrong(Kind::ErrorConstant, |row| (row.low, row.high) = (row.low * 7.0, row.high * 7.0));
    let evaluations = wrong(Kind::EvaluationsPerStep, |row| (row.low, row.high) = (row.low + 7.0, row.high + 7.0));
    for bounds in [&order, &constant, &evaluations] {
        let (none, kept) = moved(bounds, false);
        assert!(none.is_empty() && kept.len() == 1);
        let (moved, none) = moved(bounds, true);
        assert!(moved.len() == 1 && none.is_empty());
        let (old, new) = &moved[0];
        assert!(new.admits(new.measured) && !new.is_theory() && new.reason.ends_with(&old.reason), "{new:?}");
        let of_reason = new.of_reason().expect("a reason that can be read").expect("of a measurement");
        assert!((of_reason[0] - new.low).abs() <= 1e-5 * new.measured, "{new:?}");
        assert!((of_reason[1] - new.high).abs() <= 1e-5 * new.measured, "{new:?}");
        let width = |row: &Row| if row.kind == Kind::Order { row.high - row.low } else { row.high / row.low };
        // Six digits of a bound.
        assert!((width(new) - width(old)).abs() <= 4e-5, "{old:?} {new:?}");
    }
    let updated =
        update::Update { rows: order.rows.clone(), moved: moved(&order, true).0, kept: vec![], added: vec![] };
    assert!(updated.diff().contains(&order.rows[0].reason), "{}", updated.diff());
    let updated = update::Update { kept: moved(&order, false).1, moved: vec![], ..updated };
    assert!(updated.diff().contains("not moved: oscillator") && updated.diff().contains("--theory"));
}

// Fails if: a row is taken for another kind, precision or number of steps.
#[test]
fn rows_that_would_be_proposed_and_are_not_there_are_missing() {
    let bounds = committed();
    let missing = |rows: &[Row]| propose::missing(&bounds.known, rows, &Progress::silent());
    let lost = |row: &Row| {
        row.scene == "oscillator" && row.kind == Kind::Order || row.scene == "kepler" && row.precision == Precision::F32
    };
    let (without, with): (Vec<Row>, Vec<Row>) = bounds.rows.iter().cloned().partition(lost);
    assert!(without.len() > 10);
    let mut found = missing(&with);
    found.sort_by_cached_key(Row::key);
    // Mutants too: what is added again is what was there.
    assert_eq!(found, without);
    let audit = audit::Audit { findings: vec![], missing: found, uncovered: vec![], unnamed: vec![] };
    assert!(!audit.is_good() && audit.text().starts_with("missing: "), "{}", audit.text());
    assert!(missing(&bounds.rows).is_empty());
}

// Fails if: a wide bound without theory, or one inside the rounding noise, is not seen.
#[test]
fn the_audit_sees_what_is_vacuous_and_what_is_too_tight() {
    let judged = judged(&committed(), is_position_of_rk4);
    let found = |change: &dyn Fn(&mut Row), exact: f64| {
        let mut one = judged[0].clone();
        change(&mut one.row);
        audit::finding(one, Some(exact), f64::EPSILON)
    };
    let x = judged[0].row.measured;
    let plain = found(&|_| (), x);
    assert!(!plain.vacuous && !plain.tight && (plain.margin - 1.05).abs() < 1e-5, "{plain:?}");
    assert!(found(&|row| row.high = 3.1 * row.measured, x).vacuous);
    assert!(found(&|row| row.low = row.measured / 3.1, x).vacuous);
    // Theory is held to the same, but for what it says to be rounding.
    let theory =
        |low: f64, high: f64| found(&|row| (row.low, row.high, row.reason) = (low, high, "theory: e".to_owned()), x);
    assert!(theory(0.0, 3.1 * x).vacuous && theory(0.0, 1e13).vacuous && theory(x / 3.1, x).vacuous);
    assert!(!theory(x / 2.9, 2.9 * x).vacuous && !theory(0.0, 2.9 * x).vacuous);
    let rounding = |high: f64| {
        let change = |row: &mut Row| (row.low, row.high, row.reason) = (0.0, high, "theory: 0".to_owned());
        let mut one = judged[0].clone();
        change(&mut one.row);
        one.measured = gate::numbers::Measured::Value(1e-30);
        audit::finding(one, None, f64::EPSILON)
    };
    assert!(rounding(16.0 * f64::EPSILON).margin > 3.0 && !rounding(16.0 * f64::EPSILON).vacuous);
    assert!(rounding(17.0 * f64::EPSILON).vacuous);
    let broken = found(&|row| row.high = row.low, x);
    assert!(broken.judged.is_broken() && broken.is_flagged());
    assert!(found(&|row| row.high = row.measured * (1.0 + 1e-9), x * (1.0 + 1e-8)).tight);
    assert!(!found(&|row| row.high = row.measured * (1.0 + 1e-7), x * (1.0 + 1e-8)).tight);
}

// Fails if: a factor is taken at its word, a bound from 0 passes with one, or a number of theory's may be any.
#[test]
fn the_audit_sees_loose_factors_stale_numbers_and_mutants_that_no_row_names() {
    let judged = judged(&committed(), is_position_of_rk4);
    let x = judged[0].row.measured;
    let found = |reason: &str, bounds: [f64; 2], measured: f64, noise: f64| {
        let mut one = judged[0].clone();
        (one.row.low, one.row.high, one.row.measured) = (bounds[0], bounds[1], measured);
        one.row.reason = reason.to_owned();
        audit::finding(one, Some(x * (1.0 + noise)), f64::EPSILON)
    };
    let loose = |reason: &str, bounds: [f64; 2], noise: f64| found(reason, bounds, x, noise).loose;
    assert!(!loose("measured x 1.05: C h^4", [x / 1.05, x * 1.05], 0.0));
    assert!(loose("measured x 2: C h^4", [x / 2.0, x * 2.0], 0.0));
    assert!(loose("measured x 1.05, from 0: C h^4", [0.0, x * 1.05], 0.0));
    assert!(loose("measured x 3: rounding", [x / 3.0, x * 3.0], 1e-9), "what is said to be rounding is not");
    assert!(!loose("measured x 3, from 0: rounding", [0.0, x * 3.0], 0.5));
    assert!(loose("measured x 4, from 0: rounding", [0.0, x * 4.0], 0.5));
    assert!(!found("theory: e", [0.0, 2.0 * x], x, 0.0).stale);
    assert!(found("theory: e", [0.0, 2.0 * x], 2.0 * x, 0.0).stale);
    let mut rows = committed().rows;
    assert!(audit::unnamed(&rows).is_empty());
    rows.iter_mut().for_each(|row| row.mutant = String::new());
    assert_eq!(audit::unnamed(&rows).len(), gate::mutants::Mutant::ALL.len());
}

// Fails if: a committed row proves little without saying why, or would break by rounding.
#[test]
fn no_committed_row_is_vacuous_or_too_tight() {
    let mut bounds = committed();
    // The whole of it is `bounds --audit`; here the scenes that are cheap in double-double.
    bounds
        .rows
        .retain(|row| row.scene.contains("oscillator") || row.scene == "kepler" || row.scene == "constant-force");
    let audit = audit::audit(&bounds, &Progress::silent()).expect("rows that were read name runs");
    assert_eq!(audit.findings.len(), bounds.rows.len());
    let flagged: Vec<String> = audit.flagged().iter().map(|found| found.judged.row.name()).collect();
    assert!(flagged.is_empty(), "{flagged:?}");
    let text = audit.text();
    assert!(text.contains("not covered by any row:") && text.contains("tennis-racket, attitude: "), "{text}");
}

// Fails if: a failure is not in the XML, or its text breaks the markup.
#[test]
fn junit_tells_every_row_and_escapes_markup() {
    let bounds =
        with_row(|row| (row.high, row.reason) = (row.low, "theory: a < b & \"c\"".to_owned()), is_position_of_rk4);
    let xml = format::junit(&judged(&bounds, |_| true));
    assert!(xml.starts_with(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"bounds\" tests=\"1\" failures=\"1\""
    ));
    assert!(
        xml.contains("<testsuite name=\"oscillator\" tests=\"1\" failures=\"1\" errors=\"0\" skipped=\"0\">"),
        "{xml}"
    );
    assert!(xml.contains("theory: a &lt; b &amp; &quot;c&quot;</failure></testcase>"), "{xml}");
    let json = format::json(&judged(&bounds, |_| true)).expect("flat rows");
    let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!((value[0]["verdict"].as_str(), value[0]["outcome"].as_str()), (Some("broken"), Some("finished")));
}
