//! What physics engines do: the committed findings of `audit` in trajectories that seven engines wrote.

use reports::{Block, Section, Table};
use serde::Deserialize;

use measure::error::Error;
use measure::study::rounded;

/// The findings, computed from `studies/engines/data`; the test `engines_page` compares them byte for byte.
const FOUND: &str = include_str!("../../engines/engines.csv");

/// Digits of the numbers in it.
const DIGITS: u8 = 3;

#[derive(Deserialize)]
struct Found {
    engine: String,
    version: String,
    case: String,
    step: String,
    steps_per_s: String,
    error_at_end: f64,
    error_unit: String,
    order: Option<f64>,
    energy_law: String,
    energy_change: String,
    findings: String,
    settings: String,
}

/// The chapter.
///
/// # Errors
/// Findings that are no CSV.
pub(crate) fn section() -> Result<Section, Error> {
    let headers = ["engine", "case, settings", "step found", "error", "order", "energy", "findings"];
    let mut table = Table::new(&headers, &["order"]);
    for found in reports::read_csv::<Found>(FOUND, "studies/engines/engines.csv")? {
        // Of several steps that fit, the first: the file says which the others are.
        let step = found.step.split_once(" or ").map_or(found.step.as_str(), |(first, _)| first);
        table.push([
            format!("{} {}", found.engine, found.version),
            format!("{}, {} steps per s: {}", found.case, found.steps_per_s.replace(' ', " and "), found.settings),
            // A name of many parts may be broken at each of them.
            step.replace('/', "/\u{200b}"),
            format!("{} {}", rounded(found.error_at_end, DIGITS), found.error_unit),
            found.order.map_or_else(|| "–".to_owned(), |order| format!("{order:.2}")),
            format!("{}, {}", found.energy_law, found.energy_change),
            found.findings,
        ]);
    }
    Ok(Section {
        id: "engines".to_owned(),
        title: "What do engines do?".to_owned(),
        intro: "Trajectories that seven engines wrote for motions that are known exactly, as the command 'audit' judges them: the step \
                that gives the rows of the file, its error and what is wrong with the settings. These numbers come from files of the project and are the same in every report."
            .to_owned(),
        blocks: vec![Block::Table {
            caption: "Seven engines: error at the end with the largest step, order from two steps (0: the error does not depend on the step), law and largest change of the energy.".to_owned(),
            table,
            csv: None,
        }],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    // Fails if: a digit is made up, or one is lost.
    #[test]
    fn a_number_has_three_digits() {
        let shown = [1.67, 0.309, 0.00433, 2.53e-10, 12.5, 396.0].map(|x| rounded(x, DIGITS));
        assert_eq!(shown, ["1.67", "0.309", "0.00433", "2.53e-10", "12.5", "396"]);
    }

    // Fails if: the committed findings lose a column, or an engine.
    #[test]
    fn seven_engines_are_shown() {
        let section = section().expect("the committed findings");
        let [Block::Table { table, .. }] = &section.blocks[..] else { panic!("one table") };
        let engines: std::collections::BTreeSet<&str> =
            table.rows.iter().filter_map(|row| row[0].split(' ').next()).collect();
        assert_eq!(engines.len(), 7, "{engines:?}");
        assert!(table.rows.iter().all(|row| row[2..4].iter().all(|cell| !cell.is_empty())));
    }
}
