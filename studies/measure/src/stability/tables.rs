//! The limits as a table for a reader.

use reports::Table;

use super::{Part, Row};
use crate::error::Error;
use crate::study::{Derived, short};
use scenes::run::Precision;

pub(super) fn all(rows: &[Row]) -> Result<Vec<Derived>, Error> {
    Ok(vec![limits(rows)?, other(rows)?])
}

fn limits(rows: &[Row]) -> Result<Derived, Error> {
    let chosen: Vec<Row> = rows.iter().filter(|row| row.part == Part::Limit).cloned().collect();
    let headers = ["scene", "method", "holds at", "fails at", "theory", "beyond it"];
    let mut table = Table::new(&headers, &["holds at", "fails at", "theory"]);
    for row in chosen.iter().filter(|row| row.precision == Precision::F64) {
        let theory = row.theory.map_or_else(|| "–".to_owned(), limit_words);
        table.push([
            row.scene.clone(),
            row.method.clone(),
            short(row.low),
            short(row.high),
            theory,
            row.failure.to_string(),
        ]);
    }
    let caption = "Largest stable step over the natural time scale of the scene, in f64; the CSV has f32 too";
    Ok(Derived { name: "stability-limits", caption, csv: reports::write_csv(&chosen)?, table })
}

/// A limit in words.
pub(super) fn limit_words(limit: f64) -> String {
    match limit {
        0.0 => "no step".to_owned(),
        l if l.is_infinite() => "none".to_owned(),
        l => format!("{l:.5}"),
    }
}

fn other(rows: &[Row]) -> Result<Derived, Error> {
    let parts = [Part::QuadraticDrag, Part::PendulumAmplitude, Part::BlowUp, Part::Ball, Part::Unconditional];
    let chosen: Vec<Row> = rows.iter().filter(|row| parts.contains(&row.part)).cloned().collect();
    let headers = ["scene", "method", "at", "quantity", "measured", "theory", "what goes wrong"];
    let mut table = Table::new(&headers, &["measured", "theory"]);
    for row in &chosen {
        let at = match (row.h_omega, row.h_s, row.value) {
            (Some(z), ..) => format!("h omega = {}", short(Some(z))),
            (_, Some(h), _) => format!("h = {} s", short(Some(h))),
            (.., Some(value)) => format!("{} = {}", row.parameter, short(Some(value))),
            _ => String::new(),
        };
        let measured = match (row.low, row.high) {
            (Some(low), Some(high)) => format!("{} .. {}", short(Some(low)), short(Some(high))),
            _ => short(row.measured),
        };
        let quantity = format!("{} ({})", row.quantity, row.unit);
        table.push([
            row.scene.clone(),
            row.method.clone(),
            at,
            quantity,
            measured,
            short(row.theory),
            row.failure.to_string(),
        ]);
    }
    let caption = "Limits that no matrix tells, and what the methods without a limit do at large steps";
    Ok(Derived { name: "stability-other", caption, csv: reports::write_csv(&chosen)?, table })
}
