//! The gate: what the file may hold, what turns it red, what it says, and that it lets no wrong method pass.

use gate::candidate::Candidate;
use gate::deaths::deaths;
use gate::known::Known;
use gate::mutants::Mutant;
use gate::row;
use gate::row::{Kind, Row, Subject};
use gate::stepper::{Ask, Stepper};
use gate::{Bounds, Judged, audit, baseline, check, format, propose, read, update};
use measure::drift::Drift;
use measure::sweep::Progress;
use proptest::prelude::*;
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
            Subject::Error(_) => assert!(has(Kind::ErrorAtStep), "{scene} {method} {}", subject.id()),
            Subject::Evaluations => assert!(has(Kind::EvaluationsPerStep), "{scene} {method}"),
            // A limit of which no formula is known is not bounded; the audit lists it.
            Subject::Step => assert!(has(Kind::StabilityLimit) || !has_formula(scene, &method), "{scene} {method}"),
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
        assert!(name < text.find("0 bounds hold, 1 broken").expect("and counted after it"), "{text}");
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
    let none = held(&Failing::CannotRun);
    assert!(none.judged.iter().all(|one| one.verdict() == reports::Verdict::NotTested));
    assert!(check::report(&none.judged).contains("0 bounds hold, 0 broken"));
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

// Fails if: a greater error counts as better, a lower order too, or a number that is lost is not told.
#[test]
fn two_results_are_compared_in_the_direction_that_is_worse() {
    let of = |rows: &[Judged]| {
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), format::csv(rows).expect("flat rows")).expect("written");
        baseline::read(file.path()).expect("what was written")
    };
    let rows = judged(&committed(), |row| {
        row.scene == "oscillator" && row.method == "rk4" && matches!(row.kind, Kind::Order | Kind::ErrorAtStep)
    });
    let scaled = |factor: f64, kind: Kind| -> Vec<Judged> {
        let mut rows = rows.clone();
        for one in rows.iter_mut().filter(|one| one.row.kind == kind) {
            one.measured = gate::numbers::Measured::Value(one.measured.value().expect("a number") * factor);
        }
        rows
    };
    let same = baseline::compare(&of(&rows), &of(&rows));
    assert!(!same.is_worse() && same.changed.is_empty() && same.common == rows.len());
    for (factor, kind, worse) in [
        (1.001, Kind::ErrorAtStep, true),
        (0.999, Kind::ErrorAtStep, false),
        (0.999, Kind::Order, true),
        (1.001, Kind::Order, false),
    ] {
        let comparison = baseline::compare(&of(&rows), &of(&scaled(factor, kind)));
        assert_eq!(comparison.is_worse(), worse, "{kind:?} x {factor}\n{}", comparison.text());
        assert!(!comparison.changed.is_empty());
    }
    assert!(baseline::compare(&of(&rows), &of(&rows[1..])).is_worse());
    assert!(!baseline::compare(&of(&rows[1..]), &of(&rows)).is_worse());
}

// Fails if: what is no number counts as better, a verdict is a word, or half a result passes for a whole one.
#[test]
fn a_result_that_is_not_whole_is_not_compared() {
    let rows = judged(&committed(), is_position_of_rk4);
    let good = format::csv(&rows).expect("flat rows");
    assert!(baseline::parse(good.as_bytes(), "r.csv").is_ok());
    let header = good.lines().next().expect("a header");
    assert_eq!(header, format::COLUMNS.join(","));
    let line = good.lines().nth(1).expect("a line");
    let field = |name: &str| line.split(',').nth(format::COLUMNS.iter().position(|c| *c == name).expect("a column"));
    let measured = format!("{},finished", field("measured").expect("a field"));
    let double = good.replace("# end: 1", &format!("{line}\n# end: 2"));
    for (text, at, says) in [
        (good.replace(&measured, "NaN,finished"), "2:12: ", "'measured': NaN where a result has a finite number"),
        (good.replace(&measured, "inf,finished"), "2:12: ", "'measured': inf where"),
        (good.replace(&measured, "x,finished"), "2:12: ", "'measured'"),
        (good.replace("finished,holds", "finished,Broken"), "2:14: ", "verdict 'Broken': unknown; give one of holds"),
        (good.replace("finished,holds", "finished,broken"), "2:14: ", "'broken' is not what low, high and measured"),
        (good.replace("error-at-step", "error"), "2:5: ", "kind 'error': unknown"),
        (good.replace("# end: 1 rows\n", ""), "2: ", "truncated"),
        (good.replace("# end: 1", "# end: 2"), "3: ", "lines are lost"),
        (double, "3: ", "is in line 2 too"),
        (format!("{header}\n# end: 0 rows\n"), "", "holds no row"),
    ] {
        let found = baseline::parse(text.as_bytes(), "r.csv").expect_err("not a result").to_string();
        assert!(found.starts_with("r.csv:") && found[6..].trim_start().starts_with(at), "{text}\n{found}");
        assert!(found.contains(says), "{text}\n{found}");
    }
}

const HEADER: &str = "scene,method,precision,quantity,kind,steps,end_s,unit,low,high,measured,reason,mutant";
const GOOD: &str =
    "oscillator,rk4,f64,position,error-at-step,64,2.75,m,0.5,2.0,1.0,measured x 2: a test,one-step-short";

fn refusal(bytes: &[u8]) -> String {
    Bounds::parse(bytes, "dir/b.csv").err().expect("malformed").to_string()
}

// Fails if: a file that is not wholly understood is used, or its fault is not named with line and column.
#[test]
fn a_malformed_file_is_refused_with_file_line_and_column() {
    let file = |row: &str| format!("# a comment\n{HEADER}\n{row}\n# end: 1 rows\n");
    assert!(Bounds::parse(file(GOOD).as_bytes(), "b.csv").is_ok());
    for (from, to, at, says) in [
        ("oscillator", "oscilator", "3:1", "did you mean 'oscillator'"),
        ("rk4", "rk5", "3:2", "method 'rk5': unknown"),
        ("rk4", "rk4/body-omega", "3:2", "method 'rk4/body-omega': unknown"),
        ("f64", "f16", "3:3", "precision 'f16': unknown"),
        ("position", "attitude", "3:4", "oscillator has no attitude: no run matches"),
        ("position", "weight", "3:4", "quantity 'weight': unknown"),
        ("error-at-step", "drift", "3:4", "position has no drift"),
        ("error-at-step", "errors", "3:5", "kind 'errors': unknown"),
        (",64,", ",0,", "3:6", "0: give 1 to"),
        (",64,", ",-64,", "3:6", "'-64' is not a number of steps"),
        (",64,", ",99999999,", "3:6", "99999999: give 1 to"),
        ("error-at-step,64", "order,66", "3:6", "a multiple of 4"),
        ("2.75", "inf", "3:7", "inf is no bound"),
        ("2.75", "-2.75", "3:7", "a time after the start"),
        (",m,", ",km,", "3:8", "'km' where error-at-step of position is in 'm'"),
        ("0.5", "NaN", "3:9", "NaN is no bound"),
        ("0.5", "-inf", "3:9", "-inf is no bound"),
        ("0.5", "", "3:9", "'' is not a number"),
        ("0.5", "3.0", "3:9", "3.0 is above high 2.0"),
        ("2.0", "two", "3:10", "'two' is not a number"),
        ("2.0", "inf", "3:10", "inf is no bound"),
        ("1.0", "2.5", "3:11", "it never held"),
        ("1.0", "nan", "3:11", "nan is no bound"),
        ("measured x 2: a test", "", "3:12", "give 'theory:"),
        ("measured x 2: a test", "theory:  ", "3:12", "give 'theory: the formula'"),
        ("measured x 2: a test", "theory e = 4 h", "3:12", "give 'theory: the formula'"),
        ("measured x 2: a test", "measured x 2: ", "3:12", "'measured x FACTOR: what is known'"),
        ("measured x 2: a test", "measured x two: a test", "3:12", "'two' is no factor"),
        ("measured x 2: a test", "measured x 1: a test", "3:12", "'1' is no factor"),
        ("measured x 2: a test", "measured x inf: a test", "3:12", "'inf' is no factor"),
        ("measured x 2: a test", "measured x 2.001: a test", "3:12", "low is 0.5 where the reason makes it 0.49975"),
        ("2.0", "2.001", "3:12", "high is 2.001 where the reason makes it 2"),
        ("measured x 2: a test", "\"measured x 2, from 0: a test\"", "3:12", "low is 0.5 where the reason makes it 0"),
        ("measured x 2: a test", "measured +- 0.5: a test", "3:12", "high is 2 where the reason makes it 1.5"),
        ("one-step-short", "gremlins", "3:13", "mutant 'gremlins': unknown"),
        (",one-step-short", "", "3:13", "12 fields where the header has 13"),
        ("one-step-short", "one-step-short,more", "3:13", "14 fields where the header has 13"),
    ] {
        let text = refusal(file(&GOOD.replacen(from, to, 1)).as_bytes());
        let place = format!("dir/b.csv:{at}: ");
        assert!(text.starts_with(&place) && text.contains(says), "{from} -> {to}: {text}");
    }
}

// Fails if: a header, a lost end, an order or a byte is not looked at.
#[test]
fn a_file_with_a_wrong_frame_is_refused() {
    let second = GOOD.replace(",64,", ",128,");
    let whole = |rows: &[&str], end: usize| format!("{HEADER}\n{}\n# end: {end} rows\n", rows.join("\n"));
    assert!(Bounds::parse(whole(&[GOOD, &second], 2).as_bytes(), "b.csv").is_ok());
    let truncated = whole(&[GOOD, &second], 2);
    for (text, at, says) in [
        (format!("{HEADER}\n# end: 0 rows\n"), "2: ", "holds no row"),
        (String::new(), "1: ", "no rows: the header should be"),
        (whole(&[GOOD, GOOD], 2), "3: ", "the same number as in line 2"),
        (whole(&[&second, GOOD], 2), "3: ", "out of order: it belongs before line 2"),
        (whole(&[GOOD], 2), "3: ", "lines are lost"),
        (format!("{HEADER}\n{GOOD}\n"), "2: ", "truncated"),
        (truncated[..truncated.len() / 2].to_owned(), "2:", "fields where the header has 13"),
        (whole(&[GOOD], 1).replacen("precision", "bits", 1), "1:3", "unknown column 'bits'"),
        (whole(&[GOOD], 1).replacen(",unit", "", 1), "1:8", "column 'unit' is missing here"),
        (whole(&[GOOD], 1).replacen("mutant", "mutant,low", 1), "1:14", "a column too many"),
    ] {
        let found = refusal(text.as_bytes());
        assert!(found.starts_with(&format!("dir/b.csv:{at}")) && found.contains(says), "{text}\n{found}");
    }
    let mut bytes = whole(&[GOOD], 1).into_bytes();
    let reason = bytes.windows(4).position(|w| w == b"test").expect("it is there");
    bytes[reason] = 0xff;
    let found = refusal(&bytes);
    assert!(found.starts_with("dir/b.csv:2:12: ") && found.contains("byte 0xff is not UTF-8"), "{found}");
}

fn any_row() -> impl Strategy<Value = Row> {
    let scenes =
        prop::sample::select(vec![("oscillator", "rk4"), ("kepler", "velocity-verlet"), ("bouncing-ball", "rk4")]);
    let subjects = prop::sample::select(vec![
        (Subject::Error(Quantity::Position), Kind::ErrorAtStep, "m"),
        (Subject::Error(Quantity::Velocity), Kind::Order, "1"),
        (Subject::Invariant(Drift::Energy), Kind::GrowthRate, "1/s"),
        (Subject::Evaluations, Kind::EvaluationsPerStep, "1"),
    ]);
    let number = prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO;
    let numbers = prop::array::uniform3(number);
    let end = (1_u64..1 << 62).prop_map(f64::from_bits).prop_filter("a finite time", |t| t.is_finite() && *t > 0.0);
    let mutant = prop::sample::select(Mutant::ALL.iter().map(|m| m.id()).chain([""]).collect::<Vec<_>>());
    (
        scenes,
        subjects,
        prop::sample::select(Precision::ALL.to_vec()),
        1_u64..1000,
        end,
        numbers,
        "[ -~äω→\"',#;]*",
        mutant,
    )
        .prop_map(|((scene, method), (quantity, kind, unit), precision, quarter, end_s, mut n, reason, mutant)| {
            n.sort_by(f64::total_cmp);
            Row {
                scene: scene.to_owned(),
                method: method.to_owned(),
                precision,
                quantity,
                kind,
                steps: 4 * quarter,
                end_s,
                unit: unit.to_owned(),
                low: n[0],
                measured: n[1],
                high: n[2],
                reason: format!("theory: e{reason}"),
                mutant: mutant.to_owned(),
            }
        })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(64) })]

    // Fails if: a number is rounded, a text is not quoted, or rows are written in the order in which they are given.
    #[test]
    fn what_is_written_is_read_back_bit_for_bit(rows in prop::collection::vec(any_row(), 1..12)) {
        let mut sorted = rows.clone();
        sorted.sort_by_cached_key(Row::key);
        sorted.dedup_by_key(|row| row.key());
        prop_assume!(sorted.len() == rows.len());
        let text = read::write(&rows).expect("rows have a form");
        let (back, _) = read::read(text.as_bytes(), "b.csv").expect("what was written");
        prop_assert_eq!(&back, &sorted);
        for (a, b) in back.iter().zip(&sorted) {
            prop_assert_eq!([a.low, a.high, a.measured, a.end_s].map(f64::to_bits), [b.low, b.high, b.measured, b.end_s].map(f64::to_bits));
        }
        prop_assert_eq!(read::write(&back).expect("rows have a form"), text);
    }
}
