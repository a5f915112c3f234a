//! The table of engines is what `audit` computes from the committed trajectories.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use audit::physics::Force;
use audit::step::{Identified, Moves, StepVerdict};
use audit::subject::{Settings, Subject, subject};
use audit::trajectory::{Rounding, Trajectory};
use audit::{Args, Choices, FileReport, judge, load, order::orders};
use measure::growth::{classify, running_maximum};
use serde::{Deserialize, Serialize};

const BEGIN: &str = "<!-- engines: begin -->";
const END: &str = "<!-- engines: end -->";
/// The documents that show the table.
const PAGES: [&str; 2] = ["README.md", "reports/guides/engines.md"];

/// One committed trajectory.
#[derive(Debug, Deserialize)]
struct Run {
    file: String,
    engine: String,
    version: String,
    licence: String,
    case: String,
    scene: String,
    set: String,
    inertia: String,
    step_s: f64,
    record_every: u64,
    settings: String,
}

/// One engine in one case: a row of the table.
#[derive(Debug, Serialize)]
struct Line {
    engine: String,
    version: String,
    case: String,
    step: String,
    steps_per_s: String,
    error_at_end: String,
    error_unit: &'static str,
    order: String,
    energy_law: String,
    energy_change: String,
    findings: String,
    settings: String,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace").to_owned()
}

fn data() -> PathBuf {
    root().join("studies/engines")
}

fn runs() -> Vec<Run> {
    let mut reader = csv::Reader::from_path(data().join("runs.csv")).expect("it is committed");
    reader.deserialize().map(|run| run.expect("a row of runs.csv")).collect()
}

fn settings(run: &Run) -> Settings {
    let pair = |text: &str| text.split_once('=').map(|(name, value)| (name.to_owned(), value.to_owned()));
    let set = run.set.split_whitespace().map(|text| pair(text).expect("NAME=VALUE")).collect();
    let inertia = (!run.inertia.is_empty()).then(|| audit::subject::inertia(&run.inertia).expect("three moments"));
    Settings { scene: Some(run.scene.clone()), set, inertia }
}

fn judged(run: &Run) -> FileReport {
    let args = Args { settings: settings(run), record_every: Some(run.record_every), ..Args::default() };
    let path = data().join("data").join(&run.file);
    judge(&path, &args).unwrap_or_else(|error| panic!("{error}"))
}

/// The energy of a row: per mass of a point, of the rotation of a body.
fn energy(t: &Trajectory, subject: &Subject, row: usize) -> f64 {
    if let (Some(inertia), Some(omega)) = (subject.physics.inertia, t.omega_body(row)) {
        return inertia.component_mul(&omega).dot(&omega) / 2.0;
    }
    let (x, v) = (t.position.as_ref().expect("positions"), t.velocity.as_ref().expect("velocities"));
    let (x, v) = (x.values[row], v.values[row]);
    let potential = match subject.physics.force {
        Some(Force::Constant(g)) => -g.dot(&x),
        Some(Force::Spring { rate, anchor }) => rate * (x - anchor).norm_squared() / 2.0,
        _ => 0.0,
    };
    v.norm_squared() / 2.0 + potential
}

/// The law by which the relative change of the energy grows, and its largest value.
fn growth(run: &Run) -> [String; 2] {
    let t = load(&data().join("data").join(&run.file), &Choices::default()).expect("a trajectory");
    let subject = subject(&settings(run), &t).expect("a subject").expect("a scene");
    let start = energy(&t, &subject, 0);
    let change = |row: usize| (t.time[row] - t.time[0], energy(&t, &subject, row) / start - 1.0);
    let envelope = running_maximum((1..t.rows()).map(change));
    // A hundred roundings of the numbers that the engine computes with.
    let floor = match t.rounding {
        Rounding::Double => 100.0 * f64::EPSILON,
        _ => 100.0 * f64::from(f32::EPSILON),
    };
    let largest = envelope.last().map_or(0.0, |sample| sample.error);
    let change = if largest <= 8.0 * floor { "rounding".to_owned() } else { format!("{largest:.2e}") };
    [classify(&envelope, floor).law.to_string(), change]
}

fn step(step: &Identified) -> String {
    let names: Vec<&str> = step.candidates.iter().take(2).map(|tried| tried.id.as_str()).collect();
    match step.verdict {
        StepVerdict::Exact => "none: the exact motion".to_owned(),
        StepVerdict::Identified => names[0].to_owned(),
        StepVerdict::OneOf => format!("one of {}: {}", step.candidates.len(), names.join(" or ")),
        StepVerdict::NoneOf => format!("none of {}", step.tried),
    }
}

/// The faults of a file, each with its number.
fn faults(report: &FileReport) -> String {
    let fault = |finding: &audit::finding::Finding| {
        let name = finding.id.replace('-', " ");
        // The factor of a term that is missing is rounding around zero.
        if finding.id.ends_with("missing") {
            return name;
        }
        format!("{name} {:.4} {}", finding.value, finding.unit).trim_end().to_owned()
    };
    let all: Vec<String> = report.faults().map(fault).collect();
    if all.is_empty() { "none".to_owned() } else { all.join("; ") }
}

fn line(runs: &[&Run]) -> Line {
    let reports: Vec<FileReport> = runs.iter().map(|run| judged(run)).collect();
    let (run, report) = (runs[0], &reports[0]);
    let rotates = report.error.iter().any(|error| error.quantity == "attitude");
    let (quantity, moves) = if rotates { ("attitude", Moves::Rotation) } else { ("position", Moves::Translation) };
    let error = report.error.iter().find(|error| error.quantity == quantity).expect("an exact motion");
    let found = report.step.iter().find(|step| step.moves == moves).expect("a step");
    let order = orders(&reports).into_iter().find(|order| order.quantity == quantity);
    let order = order.and_then(|order| order.order.last().copied());
    let [energy_law, energy_change] = growth(run);
    let rates: Vec<String> = runs.iter().map(|run| format!("{}", (1.0 / run.step_s).round())).collect();
    Line {
        engine: run.engine.clone(),
        version: run.version.clone(),
        case: run.case.clone(),
        step: step(found),
        steps_per_s: rates.join(" "),
        error_at_end: format!("{:.2e}", error.end),
        error_unit: error.unit,
        // A slope within rounding of zero has no sign.
        order: order.map_or(String::new(), |p| format!("{p:.2}").replace("-0.00", "0.00")),
        energy_law,
        energy_change,
        findings: faults(report),
        settings: run.settings.clone(),
    }
}

fn lines(runs: &[Run]) -> Vec<Line> {
    let same = |a: &Run, b: &Run| a.engine == b.engine && a.case == b.case;
    runs.chunk_by(same).map(|group| line(&group.iter().collect::<Vec<_>>())).collect()
}

fn markdown(lines: &[Line]) -> String {
    let mut out = String::from(
        "| engine | case | step found | error at the end | order | energy: law, largest change | findings |\n|---|---|---|---|---|---|---|\n",
    );
    for l in lines {
        let rate = l.steps_per_s.split(' ').next().unwrap_or_default();
        let step = l.step.replace('|', "\\|");
        let error = format!("{} {} at 1/{rate} s", l.error_at_end, l.error_unit);
        let energy = format!("{}, {}", l.energy_law, l.energy_change);
        let name = format!("{} {}", l.engine, l.version.split(' ').next().unwrap_or_default());
        writeln!(out, "| {name} | {} | {step} | {error} | {} | {energy} | {} |", l.case, l.order, l.findings)
            .expect("a string takes all text");
    }
    out
}

/// A document with the table between its markers.
fn with_table(document: &str, table: &str) -> String {
    let (head, rest) = document.split_once(BEGIN).expect("the first marker");
    let (_, tail) = rest.split_once(END).expect("the second marker");
    format!("{head}{BEGIN}\n{table}{END}{tail}")
}

// Fails if: a trajectory, a check or an exact motion changes without the table; or a number of the table is of no file.
#[test]
fn the_table_of_engines_is_what_the_audit_computes() {
    let lines = lines(&runs());
    let csv = reports::write_csv(&lines).expect("rows have a form");
    let mut files = vec![(data().join("engines.csv"), csv)];
    for page in PAGES {
        let path = root().join(page);
        let document = std::fs::read_to_string(&path).expect("a document");
        files.push((path, with_table(&document, &markdown(&lines))));
    }
    let update = std::env::var_os("UPDATE_ENGINES").is_some();
    for (path, computed) in files {
        if update {
            std::fs::write(&path, &computed).expect("writable");
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        let differs = committed.lines().zip(computed.lines()).find(|(a, b)| a != b);
        let remedy = "run `UPDATE_ENGINES=1 cargo test --release -p verification --test engines_page`";
        assert!(committed == computed, "{} is not what is computed: {differs:?}; {remedy}", path.display());
    }
}

// Fails if: a committed trajectory is not listed, or a row names a file that is not there, no licence or no settings.
#[test]
fn every_trajectory_is_listed_with_its_engine_and_settings() {
    let mut listed: Vec<PathBuf> = runs().iter().map(|run| data().join("data").join(&run.file)).collect();
    let mut present = Vec::new();
    for engine in std::fs::read_dir(data().join("data")).expect("there are engines") {
        let folder = std::fs::read_dir(engine.expect("readable").path()).expect("a folder of an engine");
        present.extend(folder.map(|file| file.expect("readable").path()));
    }
    listed.sort();
    present.sort();
    assert_eq!(listed, present);
    assert!(runs().iter().all(|run| !run.licence.is_empty() && !run.settings.is_empty() && run.step_s > 0.0));
    let bytes: u64 = present.iter().map(|path| path.metadata().expect("a file").len()).sum();
    assert!(bytes < 3_000_000, "{bytes} bytes of trajectories");
}
