//! The guide for Python, followed by its letter.
//!
//! Ignored, because it needs `python3` with pandas and matplotlib:
//! `cargo test --release --workspace --test python_guide -- --ignored`.

use std::fs;
use std::process::Command;

use verification::programs::{program, text};

const GUIDE: &str = include_str!("../../reports/guides/python.md");

// Fails if: the code of the guide does not run, names a column that is not there, or the chart and the orders are not made.
#[test]
#[ignore = "needs python3 with pandas and matplotlib"]
fn the_code_of_the_guide_reads_the_rows_and_draws_a_chart() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let command = GUIDE.split("--bin convergence -- ").nth(1).and_then(|rest| rest.lines().next()).expect("a command");
    let study = program("convergence").args(command.split(' ')).current_dir(directory.path()).output().expect("built");
    assert!(study.status.success(), "{}", text(&study.stderr));
    let code = GUIDE.split("```python\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a block of code");
    fs::write(directory.path().join("chart.py"), code).expect("writable");
    let python = Command::new("python3").arg("chart.py").current_dir(directory.path()).output().expect("python3");
    let said = text(&python.stdout);
    assert!(python.status.success(), "{said}{}", text(&python.stderr));
    let chart = fs::read(directory.path().join("kepler.png")).expect("a chart");
    assert!(chart.starts_with(b"\x89PNG") && chart.len() > 10_000, "{} bytes", chart.len());
    let order = |method: &str| -> [f64; 2] {
        let line = said.lines().find(|line| line.split_whitespace().next() == Some(method));
        let fields: Vec<&str> = line.unwrap_or_else(|| panic!("{method}: {said}")).split_whitespace().collect();
        [1, 2].map(|i| fields[i].parse().expect("a number"))
    };
    for method in ["semi-implicit-euler", "velocity-verlet", "rk4"] {
        let [theory, seen] = order(method);
        // The study's own tolerance for f64.
        assert!((seen - theory).abs() < 0.4, "{method}: {seen}, theory {theory}");
    }
}
