//! New bounds for what has moved: what a person has given a reason for.

use reports::Table;

use super::check::Judged;
use super::propose::{self, ROUNDING, TRUNCATION, around, from_zero};
use super::row::Row;
use super::{Bounds, uncovered};
use crate::error::Error;
use crate::sweep::{Progress, in_parallel};

/// The rows of a file as they should be, and what is different.
pub struct Update {
    /// All rows, sorted.
    pub rows: Vec<Row>,
    /// Rows that moved: as they were, as they are.
    pub moved: Vec<(Row, Row)>,
    /// Rows of scenes and methods that had none.
    pub added: Vec<Row>,
}

/// Sets the bounds of every broken row anew around what is measured, and proposes bounds for scenes and methods without any.
/// Rows that hold are left as they are, with their reasons.
///
/// # Errors
/// No reason; a broken row without a number, which no bound can admit.
pub fn update(bounds: &Bounds, reason: Option<&str>, progress: &Progress) -> Result<Update, Error> {
    let reason = reason.map(str::trim).filter(|reason| !reason.is_empty()).ok_or_else(|| Error::Plan {
        place: "--update".to_owned(),
        message: "refused without a reason: say why the bounds move with --reason \"...\"".to_owned(),
    })?;
    let moved = moved(bounds, reason, progress)?;
    let mut rows = bounds.rows.clone();
    for (old, new) in &moved {
        rows.iter_mut().filter(|row| *row == old).for_each(|row| new.clone_into(row));
    }
    let open = uncovered(&bounds.known, &bounds.rows);
    let cost = |(scene, stepper): &(&dyn crate::scene::AnyScene, super::stepper::Stepper)| {
        scene.scene().info().coarsest_steps * if stepper.is_implicit() { 50 } else { 1 }
    };
    let added = in_parallel(&open, cost, progress, |&(scene, stepper)| propose::rows(scene, stepper)).concat();
    rows.extend(added.iter().cloned());
    rows.sort_by_cached_key(Row::key);
    Ok(Update { rows, moved, added })
}

/// The broken rows as they are, and as they should be.
///
/// # Errors
/// A broken row without a number, which no bound can admit.
pub fn moved(bounds: &Bounds, reason: &str, progress: &Progress) -> Result<Vec<(Row, Row)>, Error> {
    let all: Vec<&Row> = bounds.rows.iter().collect();
    let broken = bounds.check(&all, progress)?.into_iter().filter(Judged::is_broken);
    broken.map(|judged| Ok((judged.row.clone(), anew(&judged, reason)?))).collect()
}

/// The row with its bounds around the new number.
fn anew(judged: &Judged, reason: &str) -> Result<Row, Error> {
    let row = &judged.row;
    let x = judged.measured.value().filter(|x| x.is_finite()).ok_or_else(|| Error::Plan {
        place: row.name(),
        message: format!("{}; no bound admits that: mend the method, or delete the row", judged.measured.text()),
    })?;
    let mut new = if row.low == 0.0 && row.high > 0.0 {
        from_zero(row.clone(), x, row.high / ROUNDING, reason)
    } else if row.kind.is_exponent() || x <= 0.0 {
        let half = 0.5 * (row.high - row.low);
        Row {
            low: x - half,
            high: x + half,
            measured: x,
            reason: format!("measured x 1, +-{half}: {reason}"),
            ..row.clone()
        }
    } else if row.low == row.high {
        Row { low: x, high: x, measured: x, reason: format!("measured x 1: {reason}"), ..row.clone() }
    } else {
        let factor = factor(&row.reason).unwrap_or(TRUNCATION);
        around(row.clone(), x, factor, reason)
    };
    if row.low < 0.0 && !row.kind.is_exponent() {
        let half = 0.5 * (row.high - row.low);
        new = Row { low: x - half, high: x + half, ..new };
    }
    Ok(new)
}

/// F of `measured x F: ...`.
pub fn factor(reason: &str) -> Option<f64> {
    let rest = reason.strip_prefix("measured x ")?;
    rest.split([':', ',']).next()?.trim().parse().ok()
}

impl Update {
    /// What is different, for a reader.
    pub fn diff(&self) -> String {
        let mut text = String::new();
        if !self.moved.is_empty() {
            let mut table = Table::new(&["moved", "was", "is", "reason"], &[]);
            for (old, new) in &self.moved {
                let show = |row: &Row| format!("{:.6e} … {:.6e}", row.low, row.high);
                table.push([old.name(), show(old), show(new), new.reason.clone()]);
            }
            text += &table.to_text();
            text.push('\n');
        }
        let kept = self.rows.len() - self.moved.len() - self.added.len();
        text + &format!("{} rows moved, {} added, {kept} as they were\n", self.moved.len(), self.added.len())
    }
}
