//! Verdicts for other programs: CSV, JSON and JUnit's XML.

use reports::Verdict;
use serde::{Deserialize, Serialize};

use super::check::Judged;
use measure::error::Error;

/// The columns of a [`Line`], in their order.
pub const COLUMNS: [&str; 15] = [
    "scene",
    "method",
    "precision",
    "quantity",
    "kind",
    "steps",
    "end_s",
    "unit",
    "low",
    "high",
    "measured_then",
    "measured",
    "outcome",
    "verdict",
    "reason",
];

/// A verdict as one flat line. `--baseline` compares two files of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Scene or preset.
    pub scene: String,
    /// Method.
    pub method: String,
    /// Arithmetic.
    pub precision: String,
    /// What is bounded.
    pub quantity: String,
    /// How the number is got.
    pub kind: String,
    /// Number of steps.
    pub steps: u64,
    /// End of the run, s.
    pub end_s: f64,
    /// Unit of the numbers.
    pub unit: String,
    /// The least number that holds.
    pub low: f64,
    /// The greatest number that holds.
    pub high: f64,
    /// The number when the bound was set.
    pub measured_then: f64,
    /// The number now; empty where there is none.
    pub measured: Option<f64>,
    /// How the runs ended: `finished`, or what was found in the place of a number.
    pub outcome: String,
    /// `holds`, `broken` or `not tested`.
    pub verdict: String,
    /// Why these bounds.
    pub reason: String,
}

impl Line {
    /// The verdict as a line.
    pub fn of(one: &Judged) -> Self {
        let row = &one.row;
        Line {
            scene: row.scene.clone(),
            method: row.method.clone(),
            precision: row.precision.id().to_owned(),
            quantity: row.quantity.id().to_owned(),
            kind: row.kind.id().to_owned(),
            steps: row.steps,
            end_s: row.end_s,
            unit: row.unit.clone(),
            low: row.low,
            high: row.high,
            measured_then: row.measured,
            measured: one.measured.value().filter(|x| x.is_finite()),
            outcome: match one.measured.value() {
                Some(x) if x.is_finite() => "finished".to_owned(),
                _ => one.measured.text(),
            },
            verdict: one.verdict().to_string(),
            reason: row.reason.clone(),
        }
    }
}

/// As CSV, with a header, closed by a line that tells how many rows it holds: a result that was cut short is not compared.
///
/// # Errors
/// [`reports::Error::Rows`]; flat rows have a form.
pub fn csv(judged: &[Judged]) -> Result<String, Error> {
    let rows = reports::write_csv(&judged.iter().map(Line::of).collect::<Vec<_>>())?;
    Ok(format!("{rows}{}\n", super::read::end(judged.len())))
}

/// As a JSON array, one object a row.
///
/// # Errors
/// [`reports::Error::Rows`]; flat rows have a form.
pub fn json(judged: &[Judged]) -> Result<String, Error> {
    let lines: Vec<Line> = judged.iter().map(Line::of).collect();
    let text = serde_json::to_string_pretty(&lines);
    text.map(|text| text + "\n").map_err(|error| reports::Error::Rows { message: error.to_string() }.into())
}

/// As JUnit's XML, which CI servers show: a suite a scene, a case a row.
pub fn junit(judged: &[Judged]) -> String {
    let count = |of: &[Judged], verdict| of.iter().filter(|one| one.verdict() == verdict).count();
    let attributes = |of: &[Judged]| {
        let (broken, skipped) = (count(of, Verdict::Broken), count(of, Verdict::NotTested));
        format!("tests=\"{}\" failures=\"{broken}\" errors=\"0\" skipped=\"{skipped}\"", of.len())
    };
    let mut xml =
        format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"bounds\" {}>\n", attributes(judged));
    for suite in judged.chunk_by(|a, b| a.row.scene == b.row.scene) {
        let scene = escape(&suite[0].row.scene);
        xml += &format!("  <testsuite name=\"{scene}\" {}>\n", attributes(suite));
        for one in suite {
            let class = escape(&format!("bounds.{}.{}", one.row.scene, one.row.method));
            let case = format!("    <testcase classname=\"{class}\" name=\"{}\"", escape(&one.row.name()));
            xml += &match one.verdict() {
                Verdict::Holds => format!("{case}/>\n"),
                Verdict::NotTested => format!("{case}><skipped/></testcase>\n"),
                Verdict::Broken => format!("{case}>{}</testcase>\n", failure(one)),
            };
        }
        xml += "  </testsuite>\n";
    }
    xml + "</testsuites>\n"
}

fn failure(one: &Judged) -> String {
    let row = &one.row;
    let message = format!(
        "measured {} {}, bound {:e} to {:e}: {}",
        one.measured.text(),
        row.unit,
        row.low,
        row.high,
        one.excess()
    );
    let detail = format!("change since the bound was set: {}\nreason: {}", one.change(), row.reason);
    format!("<failure message=\"{}\">{}</failure>", escape(&message), escape(&detail))
}

/// Text for XML 1.0: markup escaped, control characters, which it cannot hold, left out.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\n' => escaped += "&#10;",
            c if c.is_control() => {}
            c => escaped.push(c),
        }
    }
    escaped
}
