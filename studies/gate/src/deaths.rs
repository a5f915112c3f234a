//! Which row kills which mutant.

use reports::Table;

use crate::check::{Judged, judge};
use crate::mutants::Mutant;
use crate::{Bounds, Row};
use measure::error::Error;
use measure::sweep::Progress;

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
    /// Whether no row names the mutant, or one names it and does not see it.
    pub fn fails(&self) -> bool {
        self.killers.is_empty() || !self.spared.is_empty()
    }

    /// What became of it, in words.
    pub fn verdict(&self) -> &'static str {
        match (self.killers.is_empty(), self.spared.is_empty()) {
            (true, true) => "✗ no row names it",
            (true, false) => "✗ survives",
            (false, false) => "✗ spared by a row",
            (false, true) => "✓ killed",
        }
    }

    /// The row that shows it best: one whose reason names what is wrong, theory before measurement, then other rows of theory.
    pub fn killer(&self) -> Option<&Judged> {
        let rank = |row: &Row| {
            let names_it = self.mutant.words().iter().any(|word| row.reason.contains(word));
            let is_general = GENERAL.iter().any(|word| row.reason.contains(word));
            match (names_it, row.is_theory(), is_general) {
                (true, true, _) => 0,
                (true, false, _) => 1,
                (false, true, false) => 2,
                (false, true, true) => 3,
                _ => 4,
            }
        };
        self.killers.iter().min_by_key(|one| rank(&one.row))
    }
}

/// Reasons that would be given of any method.
const GENERAL: [&str; 3] =
    ["the method's order on a smooth problem", "the method's local error, propagated", "evaluations make a step"];

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
        let mut cells = vec![format!("{}: {}", death.mutant.id(), death.mutant.about()), death.verdict().to_owned()];
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
