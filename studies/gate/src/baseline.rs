//! Two results, as `--format csv` wrote them: what got worse, what got better.

use std::collections::BTreeMap;
use std::path::Path;

use reports::{Table, Verdict};

use super::audit::small_is_good;
use super::format::{COLUMNS, Line};
use super::read;
use super::row::Kind;
use measure::error::Error;

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
/// A file that cannot be read or is not whole; a line that is not one of a result, with its line and column; a number that is
/// there twice.
pub fn read(path: &Path) -> Result<Lines, Error> {
    let place = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|error| Error::plan(&place, format!("cannot be read: {error}")))?;
    parse(&bytes, &place)
}

/// The same from memory; `place` is named in errors.
///
/// # Errors
/// As [`read()`].
pub fn parse(bytes: &[u8], place: &str) -> Result<Lines, Error> {
    let text = read::utf8(bytes, place)?;
    // The end is the last line alone, whatever a reason says.
    let last = text.trim_end().rfind('\n').map_or(0, |i| i + 1);
    let body = if text[last..].starts_with('#') { &text[..last] } else { text };
    let rows = reports::read_csv::<Line>(body, place).map_err(read::without_column_zero)?;
    let mut reader = csv::Reader::from_reader(body.as_bytes());
    let at =
        reader.records().map(|record| record.ok().and_then(|r| r.position().map(csv::Position::line)).unwrap_or(0));
    let mut lines: BTreeMap<String, (u64, Line)> = BTreeMap::new();
    let count = rows.len();
    for (line, at) in rows.into_iter().zip(at) {
        check(&line).map_err(|(column, message)| read::at(place, at, column, message))?;
        let name = format!(
            "{} {} {} {} {} (n = {}, T = {} s)",
            line.scene, line.method, line.precision, line.quantity, line.kind, line.steps, line.end_s
        );
        if let Some((earlier, _)) = lines.get(&name) {
            return Err(read::whole(place, at, format!("{name} is in line {earlier} too; delete one of the two")));
        }
        lines.insert(name, (at, line));
    }
    read::check_end(text, count).map_err(|message| read::whole(place, text.lines().count().max(1) as u64, message))?;
    if lines.is_empty() {
        return Err(Error::plan(place, "holds no row; write one with `bounds --format csv`"));
    }
    Ok(lines.into_iter().map(|(name, (_, line))| (name, line)).collect())
}

/// What is wrong with a line, and in which column.
fn check(line: &Line) -> Result<(), (usize, String)> {
    let column = |name: &str| COLUMNS.iter().position(|column| *column == name).map_or(0, |i| i + 1);
    Kind::from_id(&line.kind).map_err(|error| (column("kind"), error.to_string()))?;
    let numbers = [
        ("end_s", Some(line.end_s)),
        ("low", Some(line.low)),
        ("high", Some(line.high)),
        ("measured_then", Some(line.measured_then)),
        ("measured", line.measured),
    ];
    for (name, x) in numbers {
        if let Some(x) = x.filter(|x| !x.is_finite()) {
            return Err((column(name), format!("'{name}': {x} where a result has a finite number")));
        }
    }
    let verdict = Verdict::ALL.into_iter().find(|verdict| verdict.to_string() == line.verdict);
    let inside = line.measured.map(|x| line.low <= x && x <= line.high);
    let fits = match verdict {
        Some(Verdict::Holds) => inside == Some(true),
        Some(Verdict::Broken) => inside != Some(true),
        Some(Verdict::NotTested) => inside.is_none(),
        None => {
            let known = Verdict::ALL.map(|verdict| verdict.to_string()).join(", ");
            return Err((column("verdict"), format!("verdict '{}': unknown; give one of {known}", line.verdict)));
        }
    };
    let message = || format!("'{}' is not what low, high and measured of this line say", line.verdict);
    if fits { Ok(()) } else { Err((column("verdict"), message())) }
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
    let broke = |line: &Line| line.verdict == Verdict::Broken.to_string();
    if broke(before) != broke(after) {
        return of(broke(after));
    }
    let (a, b) = match (before.measured, after.measured) {
        (Some(a), Some(b)) => (a, b),
        (None, None) => return None,
        (_, after) => return of(after.is_none()),
    };
    if (b - a).abs() <= SAME * a.abs() {
        return None;
    }
    let small = Kind::from_id(&after.kind).is_ok_and(small_is_good);
    // What cannot be compared is not better.
    let better = if small { b.abs() <= a.abs() } else { b >= a };
    of(!better)
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
