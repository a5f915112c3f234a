//! Adaptive integrators of others beside the best fixed-step method: measured by `integrator/compare`, kept in
//! `data/peers.csv`. The other numbers of the study are of this run and this machine; these say their own.

use reports::Table;
use serde::{Deserialize, Serialize};

use super::Row;
use crate::error::Error;
use crate::study::{Derived, distinct, short};

const CSV: &str = include_str!("../../data/peers.csv");

/// The crate of this workspace in the column `system`.
const OURS: &str = "integrator";

/// One line of `tradeoff-peers.csv`: the fastest setting of one system that keeps the error asked for.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Line {
    /// Day of the measurement.
    date: String,
    /// Processor.
    processor: String,
    /// What was compared.
    comparison: String,
    /// Scene or preset.
    scene: String,
    /// The system.
    system: String,
    /// Its method.
    method: String,
    /// Its setting.
    setting: String,
    /// End of the run, s.
    horizon_s: f64,
    /// Error asked for, m or rad.
    asked_error: Option<f64>,
    /// Error reached.
    error: Option<f64>,
    /// Evaluations of the force law.
    evaluations: Option<u64>,
    /// Least time for a simulated second, ns.
    ns_per_simulated_second: f64,
    /// The same, median.
    median_ns_per_simulated_second: f64,
    /// The same over that of this workspace.
    ratio_to_ours: Option<f64>,
    /// What to know of it.
    note: String,
}

/// Who is the fastest at which error, on those of the chosen scenes that were compared.
pub(super) fn table(rows: &[Row]) -> Result<Option<Derived>, Error> {
    let lines: Vec<Line> = reports::read_csv(CSV, "data/peers.csv")?;
    let asked = |line: &Line| line.comparison == "time-to-accuracy" && rows.iter().any(|row| row.scene == line.scene);
    let mut best: Vec<Line> = Vec::new();
    for line in lines.into_iter().filter(asked) {
        match best.iter_mut().find(|known| same_question(known, &line) && known.system == line.system) {
            Some(known) if line.ns_per_simulated_second < known.ns_per_simulated_second => *known = line,
            Some(_) => {}
            None => best.push(line),
        }
    }
    let Some(first) = best.first() else { return Ok(None) };
    let others = distinct(best.iter().map(|line| line.system.as_str()).filter(|system| *system != OURS));
    let mut headers = vec!["scene".to_owned(), "error asked".to_owned(), "over (s)".to_owned(), "leader".to_owned()];
    headers.push(format!("this one's best, measured on {} ({})", first.processor, first.date));
    headers.extend(others.iter().map(|system| format!("{system}, times ours")));
    let names: Vec<&str> = headers.iter().map(String::as_str).collect();
    let mut table = Table::new(&names, &[&names[1..3], &names[5..]].concat());
    for question in best.iter().filter(|line| line.system == OURS) {
        let answers: Vec<&Line> = best.iter().filter(|line| same_question(line, question)).collect();
        let leader = answers.iter().min_by(|a, b| a.ns_per_simulated_second.total_cmp(&b.ns_per_simulated_second));
        let times = |system: &&str| {
            let line = answers.iter().find(|line| line.system == **system);
            short(line.map(|line| line.ns_per_simulated_second / question.ns_per_simulated_second))
        };
        let mut cells = vec![
            question.scene.clone(),
            short(question.asked_error),
            short(Some(question.horizon_s)),
            leader.map_or_else(String::new, |line| line.system.clone()),
            format!(
                "{}, {}, {} ns/s",
                question.method,
                question.setting,
                short(Some(question.ns_per_simulated_second))
            ),
        ];
        cells.extend(others.iter().map(times));
        table.push(cells);
    }
    Ok(Some(Derived {
        name: "tradeoff-peers",
        caption: "Against adaptive integrators of others, Dop853 in Rust and heyoka's Taylor method from Python: least time for the \
                  error asked for, and who leads. Not measured in this run but by integrator/compare; machine and day are in the table",
        csv: reports::write_csv(&best)?,
        table,
    }))
}

fn same_question(a: &Line, b: &Line) -> bool {
    (&a.scene, a.horizon_s, a.asked_error) == (&b.scene, b.horizon_s, b.asked_error)
}
