//! What is printed: the verdict first, then how the file was read and what was found; and the same for machines.

use std::fmt::Write;

use serde::Serialize;

use crate::finding::Verdict;
use crate::judge::FileReport;
use crate::order::Order;
use crate::step::StepVerdict;

/// The result for all files.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// One for each file.
    pub files: Vec<FileReport>,
    /// How errors fall with the step, of several files.
    pub order: Vec<Order>,
}

/// Lines of a file on the terminal, at most.
const LINES: usize = 25;
/// Letters in a line, at most.
const WIDTH: usize = 220;

impl Report {
    /// 0: no fault; 1: a fault, or a bound is broken.
    pub fn exit_code(&self) -> u8 {
        u8::from(self.files.iter().any(|f| f.faults().next().is_some()))
    }

    /// For the terminal.
    pub fn text(&self) -> String {
        let mut out = String::new();
        for file in &self.files {
            let mut lines = lines(file);
            if lines.len() > LINES {
                let left = lines.len() - (LINES - 1);
                lines.truncate(LINES - 1);
                lines.push(format!("  ... {left} more findings; --json FILE has them all"));
            }
            for line in lines {
                let short: String = line.chars().take(WIDTH).collect();
                let _ = writeln!(out, "{short}");
            }
        }
        for order in &self.order {
            let _ = writeln!(out, "{}", order.line());
        }
        out
    }

    /// For machines.
    pub fn json(&self) -> String {
        let files: Vec<serde_json::Value> = self.files.iter().map(json).collect();
        serde_json::json!({ "format": 1, "files": files, "order": self.order }).to_string()
    }

    /// For a comment on a pull request.
    pub fn markdown(&self) -> String {
        let mut out = String::new();
        for file in &self.files {
            let _ = writeln!(out, "### {}\n\n{}\n", file.path.display(), verdict(file));
            out += "| verdict | check | quantity | value | unit | evidence |\n|---|---|---|---|---|---|\n";
            for f in &file.findings {
                let evidence = f.evidence.replace('|', "\\|");
                let (verdict, check) = (f.verdict.id(), f.check.id());
                let _ = writeln!(
                    out,
                    "| {verdict} | {check} | {} | {:.6e} | {} | {evidence} |",
                    f.quantity, f.value, f.unit
                );
            }
            out.push('\n');
        }
        out
    }

    /// For continuous integration.
    pub fn junit(&self) -> String {
        let escape = |s: &str| s.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;");
        let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n");
        for file in &self.files {
            let path = escape(&file.path.display().to_string());
            let (all, faults) = (file.findings.len(), file.faults().count());
            let _ = writeln!(out, "  <testsuite name=\"{path}\" tests=\"{all}\" failures=\"{faults}\">");
            for f in &file.findings {
                let name = escape(&format!("{}: {} ({})", f.id, f.quantity, f.verdict.id()));
                let (check, evidence) = (f.check.id(), escape(&f.evidence));
                let _ = match f.verdict {
                    Verdict::Fault => writeln!(
                        out,
                        "    <testcase classname=\"{check}\" name=\"{name}\"><failure message=\"{evidence}\"/></testcase>"
                    ),
                    _ => writeln!(out, "    <testcase classname=\"{check}\" name=\"{name}\"/>"),
                };
            }
            out += "  </testsuite>\n";
        }
        out + "</testsuites>\n"
    }

    /// One finding a row.
    pub fn csv(&self) -> String {
        let mut out = String::from("file,check,id,quantity,value,unit,bound,verdict,evidence\n");
        let quote = |s: &str| format!("\"{}\"", s.replace('"', "\"\""));
        for file in &self.files {
            for f in &file.findings {
                let bound = f.bound.map_or(String::new(), |b| b.to_string());
                let path = quote(&file.path.display().to_string());
                let (check, verdict) = (f.check.id(), f.verdict.id());
                let (quantity, evidence) = (quote(&f.quantity), quote(&f.evidence));
                let _ = writeln!(
                    out,
                    "{path},{check},{},{quantity},{:e},{},{bound},{verdict},{evidence}",
                    f.id, f.value, f.unit
                );
            }
        }
        out
    }
}

/// The sentence that comes first.
pub fn verdict(file: &FileReport) -> String {
    let faults: Vec<String> = file.faults().map(|f| f.id.replace('-', " ")).collect();
    let step = file.step.iter().filter(|s| s.verdict == StepVerdict::Identified).map(|s| s.candidates[0].id.as_str());
    let step: Vec<&str> = step.collect();
    let step = if step.is_empty() { String::new() } else { format!("; step: {}", step.join(" and ")) };
    match faults.len() {
        0 => format!("no fault found{step}"),
        1 => format!("1 fault: {}{step}", faults[0]),
        n => format!("{n} faults: {}{step}", faults.join(", ")),
    }
}

fn lines(file: &FileReport) -> Vec<String> {
    let t = &file.time;
    let mut out = vec![
        format!("{}: {}", file.path.display(), verdict(file)),
        format!(
            "  {} rows, {} to {} s, {:.9} s apart, numbers with {}",
            t.rows, t.start_s, t.end_s, t.interval_s, file.rounding
        ),
    ];
    for c in &file.columns {
        out.push(format!("  {} = {} [{}]", c.columns.join(" "), c.reading, c.reason));
    }
    if !file.unused.is_empty() {
        out.push(format!("  not used: {}", file.unused.join(" ")));
    }
    for f in &file.findings {
        out.push(format!("  {:5} {}: {}", f.verdict.id(), f.quantity, f.evidence));
    }
    out
}

fn json(file: &FileReport) -> serde_json::Value {
    let candidates: Vec<serde_json::Value> = file
        .step
        .iter()
        .flat_map(|s| s.candidates.iter().map(move |c| (s, c)))
        .map(|(s, c)| {
            serde_json::json!({
                "moves": s.moves, "id": c.id, "h_s": c.h_s, "steps_per_row": c.steps_per_row, "rows": c.rows,
                "largest_difference": c.largest_difference * s.resolution, "resolution": s.resolution,
                "damping": c.damping, "same_as": c.same_as,
            })
        })
        .collect();
    let rank = |v: StepVerdict| match v {
        StepVerdict::Exact => 0,
        StepVerdict::Identified => 1,
        StepVerdict::OneOf => 2,
        StepVerdict::NoneOf => 3,
    };
    let worst = file.step.iter().map(|s| s.verdict).max_by_key(|v| rank(*v));
    let parts: Vec<serde_json::Value> = file
        .step
        .iter()
        .map(|s| serde_json::json!({ "moves": s.moves, "verdict": s.verdict, "rows": s.rows }))
        .collect();
    serde_json::json!({
        "path": file.path, "verdict": verdict(file), "columns": file.columns, "unused": file.unused,
        "rounding": file.rounding, "time": file.time, "findings": file.findings, "error": file.error,
        "step": { "verdict": worst, "parts": parts, "candidates": candidates },
    })
}
