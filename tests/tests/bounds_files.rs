//! Files of bounds and of verdicts: what is read, what is refused, what is compared.

use gate::mutants::Mutant;
use gate::row::{Kind, Row, Subject};
use gate::{Bounds, Judged, baseline, format, read};
use measure::drift::Drift;
use measure::sweep::Progress;
use proptest::prelude::*;
use scenes::observation::Quantity;
use scenes::run::Precision;

const FILE: &[u8] = include_bytes!("../../studies/gate/data/bounds.csv");

fn committed() -> Bounds {
    Bounds::parse(FILE, "bounds.csv").expect("the committed file is read")
}

fn is_position_of_rk4(row: &Row) -> bool {
    row.scene == "oscillator"
        && row.method == "rk4"
        && row.precision == Precision::F64
        && row.quantity == Subject::Error(Quantity::Position)
        && row.kind == Kind::ErrorAtStep
}

fn judged(bounds: &Bounds, wanted: impl Fn(&Row) -> bool) -> Vec<Judged> {
    let rows: Vec<&Row> = bounds.rows.iter().filter(|row| wanted(row)).collect();
    assert!(!rows.is_empty());
    bounds.check(&rows, &Progress::silent()).expect("rows that were read name runs")
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
