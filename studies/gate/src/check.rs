//! Rows against runs.

use reports::{Table, Verdict};

use super::candidate::Candidate;
use super::known::Known;
use super::numbers::{Measured, Runs};
use super::row::Row;
use super::stepper::Stepper;
use measure::error::Error;
use measure::study::distinct;
use measure::sweep::{Progress, in_parallel};
use scenes::run::Precision;

/// A row and what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// The row.
    pub row: Row,
    /// What was measured.
    pub measured: Measured,
}

impl Judged {
    /// Holds inside the bounds. A run that failed and a number that does not exist are broken; what cannot be asked of a
    /// candidate is not tested.
    pub fn verdict(&self) -> Verdict {
        match self.measured {
            Measured::NotAsked => Verdict::NotTested,
            Measured::Value(x) => Verdict::from_comparison(self.row.admits(x)),
            _ => Verdict::Broken,
        }
    }

    /// Whether it is broken.
    pub fn is_broken(&self) -> bool {
        self.verdict() == Verdict::Broken
    }

    /// By how much it is broken, in words: the distance from the bound, and as a part of the bound.
    pub fn excess(&self) -> String {
        let Some(x) = self.measured.value() else { return "no number".to_owned() };
        let (beyond, bound, side) = if x > self.row.high {
            (x - self.row.high, self.row.high, "above")
        } else if x < self.row.low {
            (self.row.low - x, self.row.low, "below")
        } else if x.is_nan() {
            return "NaN".to_owned();
        } else {
            return "inside".to_owned();
        };
        if bound == 0.0 {
            format!("{beyond:.3e} {side} 0")
        } else {
            format!("{:.3} % {side}", 100.0 * beyond / bound.abs())
        }
    }

    /// What changed since the bound was set, in words.
    pub fn change(&self) -> String {
        match self.measured.value() {
            None => "was a number".to_owned(),
            Some(x) if x == self.row.measured => "none".to_owned(),
            Some(x) if self.row.measured == 0.0 || self.row.kind.is_exponent() => {
                format!("{:+.3e}", x - self.row.measured)
            }
            Some(x) => format!("x {:.6}", x / self.row.measured),
        }
    }
}

/// Runs what the rows ask for, each scene, method and precision once, and judges every row. `candidate` says what stands in
/// for the method of a group of rows.
///
/// # Errors
/// A scene or a method that is none; rows that were read name no such.
pub fn judge<'a>(
    known: &Known,
    rows: &[&Row],
    progress: &Progress,
    candidate: impl Fn(Stepper) -> Box<dyn Candidate + 'a> + Sync,
) -> Result<Vec<Judged>, Error> {
    let groups: Vec<&[&Row]> =
        rows.chunk_by(|a, b| (&a.scene, &a.method, a.precision) == (&b.scene, &b.method, b.precision)).collect();
    for group in &groups {
        known.method(group[0])?;
    }
    let judged = in_parallel(
        &groups,
        |group| cost(known, group),
        progress,
        |group| -> Result<Vec<Judged>, Error> {
            let candidate = candidate(known.method(group[0])?);
            let runs = Runs::new(candidate.as_ref(), known.scene(group[0])?, group[0].precision);
            Ok(group.iter().map(|&row| Judged { row: row.clone(), measured: runs.measure(row) }).collect())
        },
    );
    Ok(judged.into_iter().collect::<Result<Vec<_>, _>>()?.concat())
}

/// Evaluations of a group, more or less.
fn cost(known: &Known, group: &[&Row]) -> u64 {
    let precision = if group[0].precision == Precision::DoubleDouble { 30 } else { 1 };
    let is_implicit = known.method(group[0]).is_ok_and(Stepper::is_implicit);
    let implicit = if is_implicit { 50 } else { 4 };
    group.iter().map(|row| row.steps).max().unwrap_or(0) * precision * implicit
}

/// Rows of a message, and characters of a line.
const SHOWN: usize = 10;
const LINE: usize = 160;

/// The counts; the wrong methods that break the same rows; the rows that are broken by most, with their bounds and their reasons.
pub fn message(judged: &[Judged]) -> String {
    let of = |verdict| judged.iter().filter(|one| one.verdict() == verdict).count();
    let [holds, broken, open] = [Verdict::Holds, Verdict::Broken, Verdict::NotTested].map(of);
    let mut text = format!("{broken} bounds are broken, {holds} hold, {open} are not tested\n");
    let mut line = |words: String| {
        text.extend(words.chars().take(LINE));
        text.push('\n');
    };
    for (mutant, named) in looks_like(judged) {
        line(format!("looks like: {mutant} ({named} of the broken bounds name it)"));
    }
    for one in worst(judged).into_iter().take(SHOWN) {
        let (row, measured, excess) = (&one.row, one.measured.text(), one.excess());
        line(format!("  {}: {measured}, bound {:.4e} to {:.4e}, {excess}", row.name(), row.low, row.high));
        line(format!("    change since it was set: {}; reason: {}", one.change(), row.reason));
    }
    if broken > SHOWN {
        line(format!("  and {} more", broken - SHOWN));
    }
    text
}

/// The wrong methods that a third or more of the broken rows name, of those that name one, and at least three; the most first.
fn looks_like(judged: &[Judged]) -> Vec<(&str, usize)> {
    let broken = judged.iter().filter(|one| one.is_broken());
    let named: Vec<&str> = broken.map(|one| one.row.mutant.as_str()).filter(|name| !name.is_empty()).collect();
    let mut counts: Vec<(&str, usize)> = distinct(named.iter().copied())
        .into_iter()
        .map(|name| (name, named.iter().filter(|other| **other == name).count()))
        .filter(|(_, count)| *count >= 3 && 3 * count >= named.len())
        .collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    counts
}

/// The message, then how many rows of each kind hold.
pub fn report(judged: &[Judged]) -> String {
    format!("{}\n{}", message(judged), summary(judged).to_text())
}

/// The broken rows, those first that are beyond their bounds by most.
pub fn worst(judged: &[Judged]) -> Vec<&Judged> {
    let mut broken: Vec<&Judged> = judged.iter().filter(|one| one.is_broken()).collect();
    broken.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
    broken
}

/// How far outside, in half widths of the interval; infinite where there is no number.
fn distance(one: &Judged) -> f64 {
    let (low, high) = (one.row.low, one.row.high);
    let Some(x) = one.measured.value().filter(|x| x.is_finite()) else { return f64::INFINITY };
    (low - x).max(x - high) / (high - low).max(f64::MIN_POSITIVE)
}

fn summary(judged: &[Judged]) -> Table {
    let mut table = Table::new(&["kind", "holds", "broken", "not tested"], &["holds", "broken", "not tested"]);
    for kind in super::row::Kind::ALL {
        let of: Vec<Verdict> = judged.iter().filter(|one| one.row.kind == kind).map(Judged::verdict).collect();
        let count = |verdict| of.iter().filter(|v| **v == verdict).count().to_string();
        if !of.is_empty() {
            let counts = [Verdict::Holds, Verdict::Broken, Verdict::NotTested].map(count);
            table.push(std::iter::once(kind.id().to_owned()).chain(counts));
        }
    }
    table
}
