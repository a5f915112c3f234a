//! Every column of every rows file, spoilt in every way, judged without the manifest's hash: what changes the evidence of a claim is
//! refused, or breaks a claim, or leaves one untested. `--nocapture` prints the table.
//!
//! `--from` refuses all of it before anything is judged: exports.rs.

use std::collections::BTreeMap;

use measure::adequacy::Adequacy;
use measure::convergence::Convergence;
use measure::drift::DriftStudy;
use measure::loops::Loops;
use measure::rotation::Rotation;
use measure::stability::Stability;
use measure::study::{Selection, Study};
use measure::sweep::Progress;
use measure::tradeoff::Tradeoff;
use reports::{Claim, Verdict};
use scenes::run::Precision;

fn selection() -> Selection {
    let ids =
        ["oscillator", "damped-oscillator", "kepler", "constant-force", "torque-free-spin", "principal-axis-torque"];
    Selection {
        scenes: ids.map(|id| scenes::by_id(id).expect("a scene")).into(),
        methods: integrator::methods::MethodId::ALL.to_vec(),
        schemes: Vec::new(),
        precisions: Precision::ALL.to_vec(),
        steps: Vec::new(),
        length: None,
        quick: true,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    }
}

const CORRUPTIONS: [&str; 6] = ["NaN", "empty", "sign", "x1.08", "swapped", "constant"];

/// A column spoilt in one way; `None` where the way does not apply to what stands in it.
fn spoilt(header: &[String], rows: &[Vec<String>], column: usize, how: &str) -> Option<String> {
    let is_number = rows.iter().all(|row| row[column].is_empty() || row[column].parse::<f64>().is_ok());
    if !is_number && how != "empty" && how != "swapped" && how != "constant" {
        return None;
    }
    let mut all = rows.to_vec();
    let filled: Vec<usize> = (0..all.len()).filter(|&i| !all[i][column].is_empty()).collect();
    match how {
        "swapped" => filled.chunks_exact(2).for_each(|pair| {
            let other = all[pair[0]][column].clone();
            all[pair[0]][column] = std::mem::replace(&mut all[pair[1]][column], other);
        }),
        "constant" => {
            let first = all.get(*filled.first()?)?[column].clone();
            filled.iter().for_each(|&i| all[i][column].clone_from(&first));
        }
        _ => {
            for &i in &filled {
                let text = &all[i][column];
                all[i][column] = match (how, text.parse::<f64>()) {
                    ("empty", _) => String::new(),
                    ("NaN", _) => "NaN".to_owned(),
                    ("sign", Ok(x)) => format!("{:?}", -x),
                    // A whole number stays one.
                    (_, Ok(x)) if !text.contains('.') && !text.contains('e') => format!("{}", (x * 1.08).ceil()),
                    (_, Ok(x)) => format!("{:?}", x * 1.08),
                    _ => text.clone(),
                };
            }
        }
    }
    if all == rows { None } else { Some(write(header, &all)) }
}

fn write(header: &[String], rows: &[Vec<String>]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for record in std::iter::once(header).chain(rows.iter().map(Vec::as_slice)) {
        writer.write_record(record).expect("into memory");
    }
    String::from_utf8(writer.into_inner().expect("into memory")).expect("text")
}

/// What rows make of the claims.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    /// They are refused.
    Refused,
    /// A claim is broken or not tested.
    Seen,
    /// No claim has changed its evidence.
    Same,
    /// Claims are gone, and none of the rest has changed.
    Gone,
    /// A claim that holds has other evidence.
    Green,
}

/// Files of rows, by name.
type Files = Vec<(String, String)>;

fn claims<S: Study>(files: &Files) -> Result<Vec<Claim>, String> {
    let mut rows = Vec::new();
    for file in measure::files::of::<S>() {
        let Some((name, text)) = files.iter().find(|(name, _)| *name == file.name) else { continue };
        rows.extend(file.read::<S>(text, name).map_err(|error| error.to_string())?);
    }
    rows.iter().try_for_each(S::check)?;
    let claims = S::claims(&rows);
    let repeated = measure::claim::repeated(&claims).map(|id| format!("two claims are named {id}"));
    repeated.map_or(Ok(claims), Err)
}

fn judged<S: Study>(good: &[Claim], files: &Files) -> (Outcome, String) {
    let found = match claims::<S>(files) {
        Err(message) => return (Outcome::Refused, message),
        Ok(found) => found,
    };
    if let Some(claim) = found.iter().find(|claim| claim.verdict != Verdict::Holds) {
        return (Outcome::Seen, claim.id.clone());
    }
    let by_id: BTreeMap<&str, &Claim> = found.iter().map(|claim| (claim.id.as_str(), claim)).collect();
    let other = |claim: &&Claim| {
        by_id.get(claim.id.as_str()).is_some_and(|now| (&now.theory, &now.measured) != (&claim.theory, &claim.measured))
    };
    if let Some(claim) = good.iter().find(other) {
        return (Outcome::Green, format!("{}: {} -> {}", claim.id, claim.measured, by_id[claim.id.as_str()].measured));
    }
    let gone = good.iter().filter(|claim| !by_id.contains_key(claim.id.as_str())).count();
    if gone > 0 { (Outcome::Gone, format!("{gone} of {}", good.len())) } else { (Outcome::Same, String::new()) }
}

/// What stays green, with the reason: the start of the file's name, column, how (empty for every way), why.
type Exception = (&'static str, &'static str, &'static str, &'static str);

/// Judges every corruption of every file of one study's rows and gives those that stay green without a reason.
fn matrix<S: Study>(exceptions: &[Exception]) -> Vec<String> {
    let rows = measure::files::in_order::<S>(S::measure(&selection()));
    let good = S::claims(&rows);
    let held = good.iter().all(|claim| claim.verdict == Verdict::Holds);
    assert!(held && good.len() > 5, "{}: {} claims", S::ID, good.len());
    let files: Files = measure::files::write::<S>(&rows).expect("rows have a form");
    let same = claims::<S>(&files).expect("what was written");
    assert!(same == good, "{}: the files do not hold all of the rows", S::ID);
    let mut survivors = Vec::new();
    for (at, (name, text)) in files.iter().enumerate() {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let header: Vec<String> = reader.headers().expect("a header").iter().map(str::to_owned).collect();
        let lines: Vec<Vec<String>> =
            reader.records().map(|row| row.expect("read back").iter().map(str::to_owned).collect()).collect();
        let mut look = |column: &str, how: &str, text: String| {
            let mut spoilt = files.clone();
            spoilt[at].1 = text;
            let (outcome, what) = judged::<S>(&good, &spoilt);
            println!("{name:<24} {column:<20} {how:<10} {outcome:?} {what}");
            let is_known = exceptions
                .iter()
                .any(|(file, of, way, _)| name.starts_with(file) && *of == column && (way.is_empty() || *way == how));
            if outcome >= Outcome::Gone && !is_known {
                survivors.push(format!("{name} {column} {how}: {outcome:?} {what}"));
            }
        };
        for (i, column) in header.iter().enumerate() {
            for how in CORRUPTIONS {
                if let Some(text) = spoilt(&header, &lines, i, how) {
                    look(column, how, text);
                }
            }
            let kept: Vec<usize> = (0..header.len()).filter(|&k| k != i).collect();
            let less = |row: &Vec<String>| kept.iter().map(|&k| row[k].clone()).collect::<Vec<String>>();
            look(column, "missing", write(&less(&header), &lines.iter().map(less).collect::<Vec<_>>()));
        }
        // Cut within the last run, so that the last claim loses part of what it needs.
        look("(rows)", "truncated", write(&header, &lines[..lines.len() - 1]));
        if let Some(outcome) = header.iter().position(|name| name == "outcome") {
            let mut failed = lines.clone();
            failed.iter_mut().for_each(|row| "diverged".clone_into(&mut row[outcome]));
            look("(runs)", "diverged", write(&header, &failed));
        }
    }
    survivors
}

/// Corruptions that stay green, and why that is right.
const EXCEPTIONS: &[Exception] = &[
    ("convergence", "precision", "constant", "a selection without double-double has no orders to judge"),
    ("convergence", "steps", "x1.08", "a factor of n leaves the exponent of n^p; the step itself is h_s"),
    (
        "convergence",
        "quantity",
        "swapped",
        "errors and theory of a row go together: names are exchanged, and no number",
    ),
    ("convergence", "unit", "", WORDS),
    ("convergence", "theory_constant", "empty", NO_THEORY),
    ("convergence", "theory_constant", "missing", NO_THEORY),
    (
        "convergence",
        "time_scale_s",
        "constant",
        "it chooses the steps that count for the law of rounding, which holds over other steps too",
    ),
    ("drift", "precision", "constant", "a selection without f64 has no laws to judge"),
    (
        "drift",
        "scale",
        "constant",
        "another scene's size moves the floor of rounding by their ratio, and a law at the floor stays there",
    ),
    ("drift", "theory_law", "empty", NO_THEORY),
    ("drift", "theory_law", "missing", NO_THEORY),
    ("drift", "terms", "", "it moves the floor of rounding, and a law far below the floor stays there"),
    ("rotation", "experiment", "constant", NAMES),
    ("rotation", "theory_order", "sign", NAMES),
    ("rotation", "theory_order", "constant", NAMES),
    ("rotation", "unit", "", WORDS),
    ("rotation", "at_step", "", "what happens is judged, and the step at which it does is told"),
    ("rotation", "(rows)", "truncated", "a claim of a single row is gone with it: the manifest counts rows"),
    ("adequacy", "unit", "", WORDS),
    (
        "adequacy",
        "scene",
        "swapped",
        "a run at the end of each sweep is exchanged for its like, and either order stays",
    ),
    ("adequacy", "consistent", "swapped", NAMES),
    ("adequacy", "error", "x1.08", "a factor leaves an order, and the size of a model's error is told"),
    ("adequacy", "(rows)", "truncated", "the order is that of the runs that are left: the manifest counts rows"),
    ("stability", "unit", "", WORDS),
    ("stability", "h_s", "", "it names the claim, and theory of the row was computed from it"),
    ("stability.limit", "method", "swapped", WHOLE),
    ("stability.growth-rate", "h_omega", "swapped", WHOLE),
    ("stability.growth-rate", "scene", "empty", NAMES),
    ("stability.growth-rate", "method", "empty", NAMES),
    ("stability.growth-rate", "h_omega", "sign", NAMES),
    ("stability.growth-rate", "h_omega", "x1.08", NAMES),
    ("stability.unconditional", "h_omega", "sign", NAMES),
    ("stability.unconditional", "h_omega", "x1.08", NAMES),
    ("stability.blow-up", "measured", "x1.08", LOWER),
    ("stability.blow-up", "measured", "swapped", LOWER),
    ("stability.blow-up", "measured", "constant", LOWER),
    ("stability.blow-up", "theory", "x1.08", LOWER),
    ("stability.blow-up", "theory", "swapped", LOWER),
    ("stability.blow-up", "theory", "constant", LOWER),
    ("stability.picture", "scene", "empty", NAMES),
    ("stability.picture", "scene", "swapped", PICTURED),
    ("stability.picture", "scene", "constant", PICTURED),
    ("stability.picture", "failure", "swapped", PICTURED),
    ("stability", "(rows)", "truncated", "a claim of a single row is gone with it: the manifest counts rows"),
    ("loops", "experiment", "constant", NAMES),
    ("loops", "choice", "swapped", WHOLE),
    ("loops", "settings", "", NAMES),
    ("loops", "subject", "swapped", WORDS),
    ("loops", "quantity", "swapped", WORDS),
    ("loops", "unit", "", WORDS),
    ("loops", "theory_order", "empty", NO_THEORY),
    ("loops", "theory_order", "missing", NO_THEORY),
    ("loops", "(rows)", "truncated", "a claim has fewer cases: the manifest counts rows"),
    ("tradeoff", "unit", "", WORDS),
    ("tradeoff.run", "precision", "swapped", NAMES),
    ("tradeoff.run", "precision", "constant", NAMES),
    ("tradeoff", "scene", "constant", NAMES),
    ("tradeoff", "position_m", "", NAMES),
    ("tradeoff", "error", "x1.08", "the models of rounding leave a factor of 2, the grid of steps"),
    ("tradeoff", "error", "swapped", NO_MINIMUM),
    ("tradeoff", "error", "constant", NO_MINIMUM),
    ("tradeoff", "scale", "x1.08", "the models of rounding leave a factor of 2, the grid of steps"),
    ("tradeoff", "scale", "empty", NO_MINIMUM),
    ("tradeoff", "scale", "missing", NO_MINIMUM),
    ("tradeoff", "(rows)", "truncated", "a claim of a single row is gone with it: the manifest counts rows"),
];
const NAMES: &str = "it says which claim a row belongs to: claims are gone or have another name, which the hash sees";
const WHOLE: &str = "what was measured and theory of a row go together: names are exchanged, and no number";
const LOWER: &str = "theory is a lower bound of the time of blow-up, and a later time keeps it";
const PICTURED: &str = "the claim asks whether a failure is among those of a picture, and the others stay";
const NO_MINIMUM: &str = "a sweep without a minimum inside it has none to judge; the hash sees the file";
const WORDS: &str = "it is shown, and no number is judged by it";
const NO_THEORY: &str = "where theory says nothing nothing is claimed; the manifest's hash sees the file";

// Fails if: a claim holds over rows that are not there, not numbers, of the wrong sign, 8 % off or of another run.
#[test]
fn no_corruption_that_changes_the_evidence_stays_green() {
    let survivors: Vec<String> = [
        matrix::<Convergence>(EXCEPTIONS),
        matrix::<DriftStudy>(EXCEPTIONS),
        matrix::<Rotation>(EXCEPTIONS),
        matrix::<Adequacy>(EXCEPTIONS),
        matrix::<Stability>(EXCEPTIONS),
        matrix::<Loops>(EXCEPTIONS),
        matrix::<Tradeoff>(EXCEPTIONS),
    ]
    .concat();
    assert!(survivors.is_empty(), "{}", survivors.join("\n"));
}
