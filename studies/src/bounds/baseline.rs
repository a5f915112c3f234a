//! Two results, as `--format csv` wrote them: what got worse, what got better.

use std::collections::BTreeMap;
use std::path::Path;

use reports::Table;

use super::audit::small_is_good;
use super::format::Line;
use super::row::Kind;
use crate::error::Error;

/// A change below this part is not told.
const SAME: f64 = 1e-9;

/// What became of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Greater error, lower order, a bound that broke, a number that is no more.
    Regression,
    /// The reverse.
    Improvement,
}

/// What is different between two results.
pub struct Comparison {
    /// What changed, how, and the two numbers in words.
    pub changed: Vec<(String, Change, [String; 2])>,
    /// Numbers in both.
    pub common: usize,
    /// Numbers in the old one alone, and in the new one alone.
    pub only: [Vec<String>; 2],
}

type Lines = BTreeMap<String, Line>;

/// The lines of a result, by what they measure.
///
/// # Errors
/// A file that cannot be read, with line and column; a number that is there twice.
pub fn read(path: &Path) -> Result<Lines, Error> {
    let place = path.display().to_string();
    let wrong = |message: String| Error::Plan { place: place.clone(), message };
    let bytes = std::fs::read(path).map_err(|error| wrong(format!("cannot be read: {error}")))?;
    let text = super::read::utf8(&bytes, &place)?;
    let mut lines = Lines::new();
    for line in reports::read_csv::<Line>(text, &place)? {
        Kind::from_id(&line.kind)?;
        let name = format!(
            "{} {} {} {} {} (n = {}, T = {} s)",
            line.scene, line.method, line.precision, line.quantity, line.kind, line.steps, line.end_s
        );
        if lines.insert(name.clone(), line).is_some() {
            return Err(wrong(format!("{name} is there twice")));
        }
    }
    if lines.is_empty() {
        return Err(wrong("holds no row; write one with `bounds --format csv`".to_owned()));
    }
    Ok(lines)
}

/// What changed from `old` to `new`.
pub fn compare(old: &Lines, new: &Lines) -> Comparison {
    let mut changed = Vec::new();
    let mut common = 0;
    for (name, before) in old {
        let Some(after) = new.get(name) else { continue };
        common += 1;
        if let Some(change) = change(before, after) {
            let text = |line: &Line| line.measured.map_or_else(|| line.outcome.clone(), |x| format!("{x:.9e}"));
            changed.push((name.clone(), change, [text(before), text(after)]));
        }
    }
    let missing = |a: &Lines, b: &Lines| a.keys().filter(|name| !b.contains_key(*name)).cloned().collect();
    Comparison { changed, common, only: [missing(old, new), missing(new, old)] }
}

fn change(before: &Line, after: &Line) -> Option<Change> {
    let of = |worse: bool| Some(if worse { Change::Regression } else { Change::Improvement });
    let (a, b) = match (before.measured, after.measured) {
        (Some(a), Some(b)) => (a, b),
        (None, None) => return None,
        (_, after) => return of(after.is_none()),
    };
    let broke = |line: &Line| line.verdict == "broken";
    if broke(before) != broke(after) {
        return of(broke(after));
    }
    if (b - a).abs() <= SAME * a.abs() {
        return None;
    }
    let small = Kind::from_id(&after.kind).is_ok_and(small_is_good);
    of(if small { b.abs() > a.abs() } else { b < a })
}

impl Comparison {
    /// Whether anything got worse, or is no longer measured.
    pub fn is_worse(&self) -> bool {
        !self.only[0].is_empty() || self.changed.iter().any(|(_, change, _)| *change == Change::Regression)
    }

    /// For a reader, regressions first.
    pub fn text(&self) -> String {
        let mut table = Table::new(&["what", "change", "was", "is"], &["was", "is"]);
        for wanted in [Change::Regression, Change::Improvement] {
            for (name, change, [was, is]) in self.changed.iter().filter(|(_, change, _)| *change == wanted) {
                let word = if *change == Change::Regression { "✗ regression" } else { "✓ improvement" };
                table.push([name.as_str(), word, was, is]);
            }
        }
        let mut text = if table.rows.is_empty() { String::new() } else { table.to_text() + "\n" };
        for (names, what) in self.only.iter().zip(["no longer measured", "new"]) {
            names.iter().for_each(|name| text += &format!("{what}: {name}\n"));
        }
        let count = |wanted| self.changed.iter().filter(|(_, change, _)| *change == wanted).count();
        let (worse, better) = (count(Change::Regression), count(Change::Improvement));
        text + &format!("{worse} regressions, {better} improvements, {} as before\n", self.common - worse - better)
    }
}
