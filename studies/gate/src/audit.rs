//! The bounds themselves, looked at: which prove little, which break by accident, what no bound covers.

use std::collections::BTreeMap;

use reports::Table;

use super::check::{Judged, judge};
use super::row::{Kind, Row, Subject};
use super::{Bounds, propose};
use measure::error::Error;
use measure::sweep::Progress;
use scenes::run::Precision;

/// A margin above this proves little, whatever the reason.
pub const VACUOUS: f64 = 3.0;
/// Half the width that an interval of an exponent may have.
const WIDE_EXPONENT: f64 = 0.5;
/// Theory alone may say that there is no error but rounding, from 0 to this many roundings: what is measured in there is luck.
const ROUNDINGS: f64 = 16.0;

/// What was found of one row.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The row and its number.
    pub judged: Judged,
    /// Bound over measured, or measured over bound, whichever is greater; of an exponent half the width.
    pub margin: f64,
    /// Rounding in the number: f64 against double-double. `None` where it is not asked for.
    pub noise: Option<f64>,
    /// The margin is above 3, of an exponent above 0.5, and the row is not theory's '0 to at most 16 roundings'.
    pub vacuous: bool,
    /// A bound is nearer than the rounding noise.
    pub tight: bool,
}

/// All that was found.
pub struct Audit {
    /// Every row.
    pub findings: Vec<Finding>,
    /// Rows that would be proposed and are not there.
    pub missing: Vec<Row>,
    /// Scene and quantity, and the methods that no row covers in it: nothing is proposed for them.
    pub uncovered: Vec<(String, String, Vec<String>)>,
}

/// Measures every row, and those of errors in f64 in double-double too.
///
/// # Errors
/// A row that names no run; rows that were read do.
pub fn audit(bounds: &Bounds, progress: &Progress) -> Result<Audit, Error> {
    let all: Vec<&Row> = bounds.rows.iter().collect();
    let judged = bounds.check(&all, progress)?;
    let of_error = |row: &Row| row.precision == Precision::F64 && matches!(row.quantity, Subject::Error(_));
    let exact: Vec<Row> = bounds
        .rows
        .iter()
        .filter(|row| of_error(row))
        .map(|row| Row { precision: Precision::DoubleDouble, ..row.clone() })
        .collect();
    let exact: Vec<&Row> = exact.iter().collect();
    let exact = judge(&bounds.known, &exact, progress, |stepper| Box::new(stepper))?;
    let mut exact = exact.into_iter();
    let findings = judged
        .into_iter()
        .map(|one| {
            let reference = if of_error(&one.row) { exact.next().and_then(|e| e.measured.value()) } else { None };
            let rounding = bounds.known.rounding(&one.row);
            finding(one, reference, rounding)
        })
        .collect();
    let missing = propose::missing(&bounds.known, &bounds.rows, progress);
    Ok(Audit { findings, missing, uncovered: uncovered(bounds) })
}

/// One row's margin, given its number in double-double, and what one rounding of it is.
pub fn finding(judged: Judged, exact: Option<f64>, rounding: f64) -> Finding {
    let row = &judged.row;
    let Some(x) = judged.measured.value() else {
        return Finding { judged, margin: f64::NAN, noise: None, vacuous: false, tight: false };
    };
    let margin = margin(row, x);
    let most = if row.kind.is_exponent() { WIDE_EXPONENT } else { VACUOUS };
    // Bounds are written with six digits.
    let is_rounding = row.is_theory() && row.low == 0.0 && row.high <= ROUNDINGS * rounding;
    let vacuous = !is_rounding && !(margin <= most * (1.0 + 1e-5));
    let noise = exact.map(|exact| (x - exact).abs());
    let above_low = if row.low == 0.0 { f64::INFINITY } else { x - row.low };
    let tight = noise.is_some_and(|noise| noise > 0.0 && above_low.min(row.high - x) < noise);
    Finding { margin, noise, vacuous, tight, judged }
}

/// By how much a row's number may change before it breaks: the greater of high / x and x / low, for a bound from 0 high / x.
fn margin(row: &Row, x: f64) -> f64 {
    if row.kind.is_exponent() {
        return 0.5 * (row.high - row.low);
    }
    if row.low == row.high {
        return 1.0;
    }
    if row.low < 0.0 {
        return 1.0 + (row.high - x).max(x - row.low) / x.abs();
    }
    let below = if row.low > 0.0 { x / row.low } else { 1.0 };
    below.max(row.high / x)
}

/// What each scene has, method by method, less what the rows name.
fn uncovered(bounds: &Bounds) -> Vec<(String, String, Vec<String>)> {
    let mut open: BTreeMap<(String, &str), Vec<String>> = BTreeMap::new();
    let rows: std::collections::HashSet<(&str, &str, &str)> =
        bounds.rows.iter().map(|row| (row.scene.as_str(), row.method.as_str(), row.quantity.id())).collect();
    for (scene, method, quantity) in bounds.known.combinations() {
        if !rows.contains(&(scene, method.as_str(), quantity.id())) {
            open.entry((scene.to_owned(), quantity.id())).or_default().push(method);
        }
    }
    open.into_iter().map(|((scene, quantity), methods)| (scene, quantity.to_owned(), methods)).collect()
}

impl Finding {
    /// Whether the row should be mended.
    pub fn is_flagged(&self) -> bool {
        self.judged.is_broken() || self.vacuous || self.tight
    }

    fn what(&self) -> String {
        let row = &self.judged.row;
        let what = if self.judged.is_broken() {
            return format!("broken: {}: {}: {}\n", row.name(), self.judged.measured.text(), self.judged.excess());
        } else if self.tight {
            "too tight, a bound is within the rounding noise"
        } else {
            "vacuous"
        };
        format!("{what}: {} (margin {:.3}): {}\n", row.name(), self.margin, row.reason)
    }
}

impl Audit {
    /// Rows that should be mended.
    pub fn flagged(&self) -> Vec<&Finding> {
        self.findings.iter().filter(|found| found.is_flagged()).collect()
    }

    /// Whether no row is flagged and none is missing.
    pub fn is_good(&self) -> bool {
        self.missing.is_empty() && self.flagged().is_empty()
    }

    /// For a reader: what is flagged, what is missing, every row's margin, then what is not covered.
    pub fn text(&self) -> String {
        let mut text = String::new();
        self.flagged().iter().for_each(|found| text += &found.what());
        for row in &self.missing {
            text += &format!("missing: {}; --update adds it\n", row.name());
        }
        if !text.is_empty() {
            text.push('\n');
        }
        text += &self.margins().to_text();
        text += "\n\nnot covered by any row:\n";
        for (scene, quantity, methods) in &self.uncovered {
            text += &format!("  {scene}, {quantity}: {}\n", methods.join(", "));
        }
        text + &self.counts()
    }

    fn margins(&self) -> Table {
        let mut all = Table::new(&["bound", "measured", "margin", "noise", "mutant"], &["measured", "margin", "noise"]);
        for found in &self.findings {
            let row = &found.judged.row;
            let noise = found.noise.map_or_else(|| "–".to_owned(), |noise| format!("{noise:.1e}"));
            let margin = format!("{:.4}", found.margin);
            all.push([row.name(), found.judged.measured.text(), margin, noise, row.mutant.clone()]);
        }
        all
    }

    fn counts(&self) -> String {
        let count = |of: &dyn Fn(&Finding) -> bool| self.findings.iter().filter(|found| of(found)).count();
        let mut margins: Vec<f64> = self
            .findings
            .iter()
            .filter(|found| !found.judged.row.kind.is_exponent() && found.margin.is_finite())
            .map(|found| found.margin)
            .collect();
        margins.sort_by(f64::total_cmp);
        let open: usize = self.uncovered.iter().map(|(_, _, methods)| methods.len()).sum();
        format!(
            "\n{} rows: {} of theory, {} broken, {} missing, {} vacuous, {} too tight, {} without a mutant; median margin {:.4}; \
             {open} combinations of scene, method and quantity without a row\n",
            self.findings.len(),
            count(&|found| found.judged.row.is_theory()),
            count(&|found| found.judged.is_broken()),
            self.missing.len(),
            count(&|found| found.vacuous),
            count(&|found| found.tight),
            count(&|found| found.judged.row.mutant.is_empty()),
            margins.get(margins.len() / 2).copied().unwrap_or(1.0),
        )
    }
}

/// Whether a small number of this kind is the better one.
pub(super) fn small_is_good(kind: Kind) -> bool {
    !matches!(kind, Kind::Order | Kind::StabilityLimit)
}
