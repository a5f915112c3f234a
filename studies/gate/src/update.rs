//! New bounds for what has moved: what a person has given a reason for.

use reports::Table;

use super::Bounds;
use super::check::Judged;
use super::propose::{self, ROUNDING, six};
use super::row::Row;
use measure::error::Error;
use measure::sweep::Progress;

/// The rows of a file as they should be, and what is different.
pub struct Update {
    /// All rows, sorted.
    pub rows: Vec<Row>,
    /// Rows that moved: as they were, as they are.
    pub moved: Vec<(Row, Row)>,
    /// Broken rows of theory, which a measurement does not move: left as they were.
    pub kept: Vec<Judged>,
    /// Rows that would be proposed and were not there.
    pub added: Vec<Row>,
}

/// Why bounds move, and which.
#[derive(Clone, Copy, Debug)]
pub struct Why<'a> {
    /// What a person says.
    pub reason: &'a str,
    /// Rows of theory move too.
    pub theory: bool,
}

/// Sets the bounds of every broken row anew around what is measured, and adds the rows that would be proposed and are not
/// there. Rows that hold are left as they are, with their reasons, and so are rows of theory unless they are asked for.
///
/// # Errors
/// No reason; a broken row without a number, which no bound can admit.
pub fn update(bounds: &Bounds, reason: Option<&str>, theory: bool, progress: &Progress) -> Result<Update, Error> {
    let reason = reason.map(str::trim).filter(|reason| !reason.is_empty()).ok_or_else(|| {
        Error::plan("--update", "refused without a reason: say why the bounds move with --reason \"...\"")
    })?;
    let (moved, kept) = moved(bounds, Why { reason, theory }, progress)?;
    let mut rows = bounds.rows.clone();
    for (old, new) in &moved {
        rows.iter_mut().filter(|row| *row == old).for_each(|row| new.clone_into(row));
    }
    let added = propose::missing(&bounds.known, &bounds.rows, progress);
    rows.extend(added.iter().cloned());
    rows.sort_by_cached_key(Row::key);
    Ok(Update { rows, moved, kept, added })
}

/// The broken rows as they are and as they should be, and those that stay.
///
/// # Errors
/// A broken row without a number, which no bound can admit.
#[expect(clippy::type_complexity, reason = "two lists")]
pub fn moved(bounds: &Bounds, why: Why<'_>, progress: &Progress) -> Result<(Vec<(Row, Row)>, Vec<Judged>), Error> {
    let all: Vec<&Row> = bounds.rows.iter().collect();
    let broken = bounds.check(&all, progress)?.into_iter().filter(Judged::is_broken);
    let (kept, moving): (Vec<_>, Vec<_>) = broken.partition(|judged| judged.row.is_theory() && !why.theory);
    let moved: Result<_, Error> = moving.iter().map(|one| Ok((one.row.clone(), anew(one, why.reason)?))).collect();
    Ok((moved?, kept))
}

/// The row with its bounds around the new number, as wide for its size as they were. What was known stays behind the reason.
fn anew(judged: &Judged, reason: &str) -> Result<Row, Error> {
    let row = &judged.row;
    let x = judged.measured.value().filter(|x| x.is_finite()).ok_or_else(|| {
        let text = judged.measured.text();
        Error::plan(row.name(), format!("{text}; no bound admits that: mend the method, or delete the row"))
    })?;
    let is_ratio = !row.kind.is_exponent() && row.low != row.high && row.low >= 0.0 && x > 0.0;
    let (how, low, high) = if is_ratio {
        let from_zero = row.low == 0.0;
        let width = if from_zero { ROUNDING } else { six((row.high / row.low).sqrt()) };
        let factor = row.factor().unwrap_or(width).max(1.0 + 1e-5);
        let (from, low) = if from_zero { (", from 0", 0.0) } else { ("", six(x / factor)) };
        (format!("x {factor}{from}"), low, six(x * factor))
    } else {
        let half = half_width(row, x);
        (format!("+- {half}"), six(x - half), six(x + half))
    };
    let old = row.reason.split_once(": ").filter(|_| !row.is_theory()).map_or(row.reason.as_str(), |(_, why)| why);
    let new = Row { low, high, measured: x, reason: format!("measured {how}: {reason}; before: {old}"), ..row.clone() };
    // Six digits of a number that is wider than its bounds would leave it out.
    Ok(if new.admits(x) && new.low < new.high { new } else { Row { low: x, high: x, ..new } })
}

/// Half the width of the new interval: of an exponent as it was, of a signed number in proportion to its size.
fn half_width(row: &Row, x: f64) -> f64 {
    let (half, middle) = (0.5 * (row.high - row.low), 0.5 * (row.high + row.low));
    six(if row.kind.is_exponent() || middle == 0.0 || half >= middle.abs() { half } else { half * (x / middle).abs() })
}

impl Update {
    /// What is different, for a reader.
    pub fn diff(&self) -> String {
        let mut text = String::new();
        if !self.moved.is_empty() {
            let mut table = Table::new(&["moved", "was", "is", "reason was", "reason is"], &[]);
            for (old, new) in &self.moved {
                let show = |row: &Row| format!("{} … {}", six(row.low), six(row.high));
                table.push([old.name(), show(old), show(new), old.reason.clone(), new.reason.clone()]);
            }
            text += &table.to_text();
            text.push('\n');
        }
        for judged in &self.kept {
            let (row, x) = (&judged.row, judged.measured.text());
            text += &format!(
                "not moved: {}: {x}, {} the bound: a bound of theory does not follow a measurement; mend the method, or give \
                 --theory: {}\n",
                row.name(),
                judged.excess(),
                row.reason
            );
        }
        self.added.iter().for_each(|row| text += &format!("added: {}\n", row.name()));
        let kept = self.rows.len() - self.moved.len() - self.added.len();
        text + &format!(
            "{} rows moved, {} added, {kept} as they were, {} of theory broken\n",
            self.moved.len(),
            self.added.len(),
            self.kept.len()
        )
    }
}
