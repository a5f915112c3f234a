//! Which row kills which mutant.

use reports::Table;

use super::Mutant;
use crate::bounds::check::{Judged, judge};
use crate::bounds::row::Subject;
use crate::bounds::{Bounds, Row};
use crate::error::Error;
use crate::sweep::Progress;

/// What became of one mutant.
#[derive(Clone, Debug)]
pub struct Death {
    /// The mutant.
    pub mutant: Mutant,
    /// The rows that name it and broke.
    pub killers: Vec<Judged>,
    /// The rows that name it and held all the same.
    pub spared: Vec<Judged>,
}

impl Death {
    /// Whether no row that names the mutant sees it, or one does not that says it does.
    pub fn fails(&self) -> bool {
        self.killers.is_empty() || !self.spared.is_empty()
    }

    /// The row that shows it best: one whose bounds are theory's, or else one of a balance with a law for every step.
    pub fn killer(&self) -> Option<&Judged> {
        let rank = |row: &Row| match (row.is_theory(), row.quantity) {
            (true, Subject::Evaluations) => 1,
            (true, _) => 0,
            (false, Subject::Balance(_)) if row.reason.contains("every step adds") => 2,
            _ => 3,
        };
        self.killers.iter().min_by_key(|one| rank(&one.row))
    }
}

/// Runs every mutant against the rows among these that name it.
///
/// # Errors
/// A row that names a mutant which cannot be made in its method.
pub fn deaths(bounds: &Bounds, rows: &[&Row], progress: &Progress) -> Result<Vec<Death>, Error> {
    Mutant::ALL.iter().map(|&mutant| death(bounds, rows, mutant, progress)).collect()
}

fn death(bounds: &Bounds, rows: &[&Row], mutant: Mutant, progress: &Progress) -> Result<Death, Error> {
    let named: Vec<&Row> = rows.iter().copied().filter(|row| row.mutant == mutant.id()).collect();
    let judged = judge(&bounds.known, &named, progress, |stepper| mutant.of(stepper))?;
    let (killers, spared) = judged.into_iter().partition(Judged::is_broken);
    Ok(Death { mutant, killers, spared })
}

/// Every mutant with the row that kills it; then every row that says it would and does not.
pub fn summary(deaths: &[Death]) -> String {
    let headers = ["mutant", "verdict", "killed by", "measured", "bound", "reason", "rows"];
    let mut table = Table::new(&headers, &["rows"]);
    for death in deaths {
        let verdict = if death.killers.is_empty() { "✗ survives" } else { "✓ killed" };
        let mut cells = vec![format!("{}: {}", death.mutant.id(), death.mutant.about()), verdict.to_owned()];
        if let Some(Judged { row, measured }) = death.killer() {
            let bound = format!("{:.6e} … {:.6e}", row.low, row.high);
            cells.extend([row.name(), measured.text(), bound, row.reason.clone(), death.killers.len().to_string()]);
        }
        table.push(cells);
    }
    let mut text = table.to_text();
    for death in deaths {
        for Judged { row, measured } in &death.spared {
            text += &format!("spared: {} names {}, and holds: {}\n", row.name(), death.mutant.id(), measured.text());
        }
    }
    let survivors = deaths.iter().filter(|death| death.fails()).count();
    text + &format!("\n{} of {} mutants killed\n", deaths.len() - survivors, deaths.len())
}
