//! `order`: tables of other programs, with orders and troubles that are known.

use std::fs;
use std::process::Output;

use measure::tables::judge::Verdict;
use measure::tables::{Ask, Judged, Layout, Of, TroubleKind, judge, read};
use verification::programs::{program, text};

fn judged(table: &str, ask: &Ask) -> Judged {
    judge(&read(table, "table", &Layout::default()).expect("a table"), ask).remove(0)
}

/// A column of errors over halved steps from 0.1 on.
fn errors(error: impl Fn(f64) -> f64, rows: u32) -> String {
    let row = |k: u32| {
        let h = 0.1 * 0.5_f64.powi(k as i32);
        format!("{h},{:e}\n", error(h))
    };
    format!("h,error\n{}", (0..rows).map(row).collect::<String>())
}

fn kinds(judged: &Judged) -> Vec<TroubleKind> {
    judged.troubles.iter().map(|trouble| trouble.kind).collect()
}

fn expecting(order: f64) -> Ask {
    Ask { expect: Some(order), ..Ask::default() }
}

/// I. B. Celik et al., J. Fluids Eng. 130 (2008) 078001, table 1, first column: p 1.53, limit 6.1685, e_a 1.5 %, e_ext 1.7 %,
/// GCI 2.2 %; with the digits 2.17 % of the same numbers.
// Fails if: the ratios of the steps are taken as equal, the safety factor is another, or h is not cells^(-1/2).
#[test]
fn the_table_of_celik_has_its_order_limit_and_index() {
    let table = "cells,phi\n18000,6.063\n8000,5.972\n4500,5.863\n";
    let layout = Layout { dimension: Some(2), ..Layout::default() };
    let all = judge(&read(table, "celik", &layout).expect("a table"), &Ask::default());
    let found = all[0].extrapolation.expect("a limit");
    assert!((found.order - 1.53).abs() < 0.005, "{}", found.order);
    assert!((found.value - 6.1685).abs() < 5e-5, "{}", found.value);
    assert!((found.gci - 0.0217).abs() < 5e-5, "{}", found.gci);
    assert!((found.approximate_error - 0.015).abs() < 5e-4 && (found.extrapolated_error - 0.017).abs() < 5e-4);
    let cubic = Layout { dimension: Some(3), ..Layout::default() };
    let other = judge(&read(table, "celik", &cubic).expect("a table"), &Ask::default());
    assert!((other[0].order.expect("an order") - 1.5 * found.order).abs() < 1e-9, "the order grows with the dimension");
}

/// NASA Glenn, *Examining Spatial (Grid) Convergence*: pressure recovery of an inlet, p 1.786170, limit 0.971300, GCI 0.1031 %.
// Fails if: the order is rounded, or the index is that of the middle grid.
#[test]
fn the_inlet_of_nasa_has_its_order_limit_and_index() {
    let found = judged("h,value\n1,0.97050\n2,0.96854\n4,0.96178\n", &Ask::default());
    let limit = found.extrapolation.expect("a limit");
    assert!((limit.order - 1.786_170).abs() < 5e-7, "{}", limit.order);
    assert!((limit.value - 0.971_300).abs() < 5e-7, "{}", limit.value);
    assert!((limit.gci - 0.001_031).abs() < 5e-7, "{}", limit.gci);
    // What half a digit in the fifth place does to ln(676 / 196) / ln 2: at most (1/676 + 1/196) / ln 2.
    let [low, high] = limit.order_interval;
    assert!(low < limit.order && limit.order < high && high - low < 0.02, "{low} {high}");
}

// Fails if: an order is invented for values that oscillate, move apart, or do not differ by their digits.
#[test]
fn values_without_a_limit_are_refused_with_the_reason() {
    for (values, kind) in [
        (["1.00", "1.20", "1.10"], TroubleKind::Oscillating),
        (["1.0", "1.1", "1.4"], TroubleKind::Diverging),
        (["1.00", "1.10", "1.20"], TroubleKind::Diverging),
        (["1.2345", "1.2346", "1.2346"], TroubleKind::Unresolved),
    ] {
        let table = format!("h,value\n4,{}\n2,{}\n1,{}\n", values[0], values[1], values[2]);
        let found = judged(&table, &Ask::default());
        assert_eq!((found.order, kinds(&found), found.verdict), (None, vec![kind], Verdict::NoOrder), "{values:?}");
    }
    // Four values, of which the coarse three show another order: f = 1 + h^2 + 2 h^8.
    let value = |h: f64| 1.0 + h * h + 2.0 * h.powi(8);
    let rows: String = [1.0, 0.7, 0.5, 0.35].iter().map(|h| format!("{h},{:.12}\n", value(*h))).collect();
    let found = judged(&format!("h,value\n{rows}"), &Ask::default());
    assert_eq!((kinds(&found), found.verdict), (vec![TroubleKind::NotAsymptotic], Verdict::NoOrder));
}

// Fails if: a step ratio is taken for 2, or the fixed point of unequal ratios is another.
#[test]
fn the_order_of_values_over_unequal_steps_is_that_of_their_law() {
    for order in [1.0, 2.0, 3.5, 4.0] {
        let rows: String =
            [0.9_f64, 0.5, 0.42, 0.1].iter().map(|h| format!("{h},{:.15}\n", 2.0 - 0.3 * h.powf(order))).collect();
        let found = judged(&format!("h,value\n{rows}"), &expecting(order));
        assert_eq!(found.verdict, Verdict::AsExpected, "{order}: {found:?}");
        assert!((found.order.expect("an order") - order).abs() < 1e-6);
        assert!((found.extrapolation.expect("a limit").value - 2.0).abs() < 1e-9);
    }
}

// Fails if: an order is accepted from one side only, or a right one is refused.
#[test]
fn errors_have_the_order_of_their_law_and_no_other() {
    for order in [1.0_f64, 2.0, 4.0] {
        let table = errors(|h| 3.0 * h.powf(order) * (1.0 + h), 6);
        let found = judged(&table, &expecting(order));
        assert_eq!((found.verdict, kinds(&found)), (Verdict::AsExpected, vec![]), "{order}: {found:?}");
        assert!((found.constant.expect("a constant") / 3.0 - 1.0).abs() < 0.15, "{:?}", found.constant);
        assert_eq!(judged(&table, &expecting(order + 1.0)).verdict, Verdict::TooLow);
        assert_eq!(judged(&table, &expecting(order + 1.0)).troubles[0].kind, TroubleKind::Capped);
        assert_eq!(judged(&table, &expecting(order - 0.5)).verdict, Verdict::TooHigh);
        assert_eq!(judged(&table, &Ask::default()).verdict, Verdict::Found);
    }
}

// Fails if: a trouble is not named, or another name is given for it.
#[test]
fn each_kind_of_trouble_is_named() {
    let cases: [(&str, String, Option<f64>, TroubleKind); 8] = [
        // Rates -0.785, 1.585 and 0.967 where the order is 7.
        (
            "ulps",
            "h,error\n0.1,7e-16\n0.05,12.06e-16\n0.025,4.02e-16\n0.0125,2.057e-16\n".to_owned(),
            Some(7.0),
            TroubleKind::AtTheFloor,
        ),
        // A rate of 0.07 of RK4.
        ("0.07", "dt,error\n0.1,0.0123\n0.05,0.011717\n".to_owned(), Some(4.0), TroubleKind::ModelError),
        ("levels off", errors(|h| h.powi(4) + 3e-7, 9), Some(4.0), TroubleKind::ModelError),
        ("signed", errors(|h| h * h - 0.02 * h, 6), Some(1.0), TroubleKind::SignChange),
        ("unsigned", errors(|h| (h * h - 0.026 * h).abs(), 9), Some(1.0), TroubleKind::SignChange),
        (
            "one run",
            errors(|h| if (h - 0.025).abs() < 1e-9 { 5.0 * h * h } else { h * h }, 7),
            Some(2.0),
            TroubleKind::BadRun,
        ),
        ("start-up", errors(|h| h.powi(4) + 0.4 * h * h, 7), Some(4.0), TroubleKind::Capped),
        ("saturated", errors(|h| (40.0 * h * h).min(0.09), 9), Some(2.0), TroubleKind::Saturated),
    ];
    for (name, table, expect, kind) in cases {
        let found = judged(&table, &Ask { expect, ..Ask::default() });
        assert_eq!(kinds(&found), [kind], "{name}: {found:#?}");
    }
    // Rounding after a clean order is a remark, and the order stands.
    let rounded = judged(&errors(|h| h.powi(4) + 3e-16 * (0.1 / h), 12), &expecting(4.0));
    assert_eq!(
        (rounded.verdict, kinds(&rounded)),
        (Verdict::AsExpected, vec![TroubleKind::AtTheFloor]),
        "{rounded:#?}"
    );
}

// Fails if: a notation in use is misread.
#[test]
fn tables_are_read_as_they_are_written() {
    let expected: Vec<f64> = [0.1_f64, 0.05, 0.025, 0.0125].iter().map(|h| h * h).collect();
    for table in [
        "h,error\n0.1,0.01\n0.05,0.0025\n0.025,0.000625\n0.0125,0.00015625\n",
        "# a comment\ndt;L2 error\n0,1;0,01\n0,05;2,5e-3\n0,025;6,25e-4\n0,0125;1,5625D-4\n",
        "step\tmax_err\n0.0125\t1.5625E-04\n0.025\t6.25e-4\n\n0.05\t2.5d-3\n0.1\t.01\n",
        "h   error_norm\n0.1 0.01\n0.05 0.0025\n0.025 0.000625\n0.0125 0.00015625\n",
        "\u{feff}\"h\",\"err\"\r\n0.1,0.01\r\n0.05,0.0025\r\n0.025,0.000625\r\n0.0125,0.00015625\r\n",
    ] {
        let read = read(table, "table", &Layout::default()).expect("a table");
        assert_eq!(read.h, [0.1, 0.05, 0.025, 0.0125], "{table}");
        let numbers: Vec<f64> = read.columns[0].cells.iter().filter_map(|cell| cell.number).collect();
        assert!(
            numbers.iter().zip(&expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-12) && numbers.len() == 4,
            "{numbers:?}"
        );
    }
    let bare = Layout { first: Some("steps".to_owned()), of: Some(Of::Errors), ..Layout::default() };
    let steps = read("10 0.1\n20 nan\n40 0.025\n", "table", &bare).expect("a table without a header");
    assert_eq!(steps.h, [0.1, 0.05, 0.025]);
    assert_eq!(steps.columns[0].cells[1].number, None);
}

fn order(content: &[u8], arguments: &[&str]) -> Output {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let file = directory.path().join("mine.csv");
    fs::write(&file, content).expect("writable");
    program("order").arg(&file).args(arguments).output().expect("the binary was built")
}

// Fails if: a wrong file is judged, or a message lacks the place or the remedy.
#[test]
fn a_file_that_is_no_table_is_refused_with_place_and_remedy() {
    let cases: [(&[u8], &str, &str); 10] = [
        (b"", "mine.csv: the file has no rows", "one row for each step"),
        (b"h,error\n0.1,0.01\n", "mine.csv: 1 row", "at least two"),
        (b"h\n0.1\n0.2\n", "mine.csv:1: 1 column", "at least one column"),
        (b"h,error\n0.1,0.01\n0.05\n", "mine.csv:3:2: 1 fields where the first row has 2", ""),
        (b"h,error\n0.1,0.01\n0.1,0.02\n", "mine.csv:3:1: h stands in two rows", "keep one"),
        (b"h,error\n0.1,0.01\nx,0.02\n", "mine.csv:3:1: 'x' is no h above zero", "remove the row"),
        (b"h,error\n0.1,0.01\n0.05,good\n", "mine.csv:3:2: 'good' is no number", "nan for a failed run"),
        (b"h,x\n0.1,0.01\n0.05,0.02\n", "'x' does not say whether", "--errors or --values"),
        (b"0.1,0.01\n0.05,0.02\n", "the first column does not say", "--first h"),
        (b"cells,error\n10,0.01\n20,0.02\n", "cells need a dimension", "--dimension 1"),
    ];
    for (content, place, remedy) in cases {
        let output = order(content, &[]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(place) && message.contains(remedy), "{place} {remedy}: {message}");
        assert!(output.stdout.is_empty());
    }
    assert_eq!(order(&[0xff, 0xfe, 0, 1], &[]).status.code(), Some(2));
}

// Fails if: the exit code is not that of the question, or JSON is not JSON.
#[test]
fn the_exit_code_is_that_of_the_question() {
    let table = errors(|h| h.powi(4), 5);
    let code = |arguments: &[&str]| order(table.as_bytes(), arguments).status.code();
    assert_eq!(code(&[]), Some(0));
    assert_eq!(code(&["--expect", "4"]), Some(0));
    assert_eq!(code(&["--expect", "3"]), Some(1));
    assert_eq!(code(&["--expect", "5"]), Some(1));
    let json = order(table.as_bytes(), &["--json", "--expect", "4"]);
    let parsed: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert_eq!(parsed["files"][0]["columns"][0]["verdict"], "as-expected");
    let said = text(&order(table.as_bytes(), &["--expect", "5"]).stdout);
    assert!(said.lines().next().is_some_and(|line| line.contains("order 4.000") && line.contains("below")), "{said}");
    assert!(said.lines().all(|line| line.chars().count() <= 200));
}
