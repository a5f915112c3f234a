//! From the text of a table to steps and columns.

use crate::error::Error;

/// How the text is laid out, where it does not say so itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// What the first column holds: `h`, `steps` or `cells`.
    pub first: Option<String>,
    /// Dimension of the cells: h = cells^(-1/D).
    pub dimension: Option<u32>,
    /// What the other columns hold.
    pub of: Option<Of>,
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// Errors against a truth.
    Errors,
    /// Values of which no truth is known.
    Values,
}

/// One number of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The number; `None` for a run that failed.
    pub number: Option<f64>,
    /// Half of the last digit that is written.
    pub half_digit: f64,
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub of: Of,
    /// Its numbers, from the coarsest step to the finest.
    pub cells: Vec<Cell>,
}

/// A table: the steps, and at least one column.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Steps, from the coarsest to the finest; relative to one for numbers of steps and of cells.
    pub h: Vec<f64>,
    /// The first column as it was written, in the same order.
    pub labels: Vec<String>,
    /// Name of the first column.
    pub first: String,
    /// The other columns.
    pub columns: Vec<Column>,
}

/// Names of a first column that holds steps, numbers of steps, numbers of cells.
const STEPS: [&str; 8] = ["h", "dt", "step", "step_size", "stepsize", "timestep", "dx", "delta"];
const COUNTS: [&str; 5] = ["steps", "n", "nsteps", "n_steps", "number_of_steps"];
const CELLS: [&str; 5] = ["cells", "elements", "nodes", "points", "n_cells"];
/// Parts of names that say what a column holds.
const ERRORS: [&str; 8] = ["err", "diff", "residual", "norm", "l1", "l2", "linf", "rmse"];
const VALUES: [&str; 6] = ["value", "phi", "result", "solution", "functional", "quantity"];

#[derive(Clone, Copy, PartialEq)]
enum First {
    Step,
    Count,
    Cells,
}

/// Reads a table; `place` is where the text came from, for errors.
///
/// # Errors
/// A text that is no table of at least two rows, or that does not say what it holds: with place, line and remedy.
pub fn read(text: &str, place: &str, layout: &Layout) -> Result<Table, Error> {
    let lines: Vec<(usize, &str)> = (1..)
        .zip(text.lines())
        .map(|(number, line)| (number, line.trim_start_matches('\u{feff}').trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .collect();
    let Some(&(_, head)) = lines.first() else {
        return Err(Error::plan(place, "the file has no rows; give a table with one row for each step"));
    };
    let separator = [';', '\t', ','].into_iter().find(|c| head.contains(*c));
    let split = |line: &str| -> Vec<String> {
        let cell = |cell: &str| cell.trim().trim_matches('"').trim().to_owned();
        match separator {
            Some(separator) => line.split(separator).map(cell).collect(),
            None => line.split_whitespace().map(cell).collect(),
        }
    };
    let comma = separator == Some(';');
    let names = split(head);
    let has_header = names.iter().any(|name| number(name, comma).is_none() && !is_failed(name));
    let body = &lines[usize::from(has_header)..];
    let width = names.len();
    if width < 2 {
        let message = format!("{width} column; a table has the step and at least one column of errors or values");
        return Err(Error::plan(format!("{place}:{}", lines[0].0), message));
    }
    let names: Vec<String> = if has_header { names } else { (1..=width).map(|i| format!("column {i}")).collect() };
    let first = first_of(&names[0], has_header, layout, place)?;
    let mut rows: Vec<(f64, String, Vec<Cell>)> = Vec::new();
    for (line, text) in body {
        let at = |column: usize, message: String| Error::plan(format!("{place}:{line}:{}", column + 1), message);
        let cells = split(text);
        if cells.len() != width {
            return Err(at(cells.len().min(width), format!("{} fields where the first row has {width}", cells.len())));
        }
        let size = number(&cells[0], comma).filter(|x| x.is_finite() && *x > 0.0).ok_or_else(|| {
            at(0, format!("'{}' is no {} above zero; remove the row, or write the number", cells[0], names[0]))
        })?;
        let h = match first {
            First::Step => size,
            First::Count => 1.0 / size,
            First::Cells => size.powf(-1.0 / f64::from(layout.dimension.unwrap_or(1))),
        };
        let parse = |(column, text): (usize, &String)| match number(text, comma) {
            Some(x) => Ok(Cell { number: Some(x).filter(|x| x.is_finite()), half_digit: half_digit(text) }),
            None if is_failed(text) => Ok(Cell { number: None, half_digit: 0.0 }),
            None => {
                Err(at(column, format!("'{text}' is no number; leave the field empty or write nan for a failed run")))
            }
        };
        let cells_of = cells.iter().enumerate().skip(1).map(parse).collect::<Result<Vec<_>, _>>()?;
        if let Some((_, other, _)) = rows.iter().find(|(known, ..)| (known / h - 1.0).abs() < 1e-12) {
            let message = format!("{} stands in two rows ({other} and {}); keep one of them", names[0], cells[0]);
            return Err(at(0, message));
        }
        rows.push((h, cells[0].clone(), cells_of));
    }
    if rows.len() < 2 {
        return Err(Error::plan(place, format!("{} row; an order needs at least two, better four", rows.len())));
    }
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut columns = Vec::new();
    for (i, name) in names.iter().enumerate().skip(1) {
        let cells = rows.iter().map(|(_, _, cells)| cells[i - 1]).collect();
        columns.push(Column { name: name.clone(), of: held_by(name, layout, place)?, cells });
    }
    let labels = rows.iter().map(|(_, label, _)| label.clone()).collect();
    Ok(Table { h: rows.iter().map(|row| row.0).collect(), labels, first: names[0].clone(), columns })
}

fn first_of(name: &str, has_header: bool, layout: &Layout, place: &str) -> Result<First, Error> {
    let given = layout.first.as_deref().unwrap_or(if has_header { name } else { "" }).to_lowercase();
    // A unit in brackets, or after an underline, is no part of the name.
    let bare = given.split(['(', '[']).next().unwrap_or_default().trim().trim_end_matches("_s").to_owned();
    let known = |names: &[&str]| names.contains(&bare.as_str());
    let first = if known(&STEPS) {
        First::Step
    } else if known(&COUNTS) {
        First::Count
    } else if known(&CELLS) {
        First::Cells
    } else {
        let said = if has_header { format!("the first column '{name}'") } else { "the first column".to_owned() };
        let message = format!("{said} does not say what it holds; give --first h, --first steps or --first cells");
        return Err(Error::plan(place, message));
    };
    match (first, layout.dimension) {
        (First::Cells, None) => {
            Err(Error::plan(place, "cells need a dimension for their size; give --dimension 1, 2 or 3"))
        }
        (First::Step | First::Count, Some(_)) => {
            Err(Error::plan("--dimension", "it is for a first column of cells; leave it out"))
        }
        _ => Ok(first),
    }
}

fn held_by(name: &str, layout: &Layout, place: &str) -> Result<Of, Error> {
    if let Some(of) = layout.of {
        return Ok(of);
    }
    let lower = name.to_lowercase();
    let has = |parts: &[&str]| parts.iter().any(|part| lower.contains(part));
    match (has(&ERRORS) || lower == "e", has(&VALUES)) {
        (true, false) => Ok(Of::Errors),
        (false, true) => Ok(Of::Values),
        _ => {
            let message = format!("'{name}' does not say whether it holds errors or values; give --errors or --values");
            Err(Error::plan(place, message))
        }
    }
}

/// A number in any of the usual notations: `1e-3`, `1.0D-03`, and `0,5` where the separator is a semicolon.
fn number(text: &str, comma: bool) -> Option<f64> {
    let plain = if comma { text.replace(',', ".") } else { text.to_owned() };
    let exponent = plain.replace(['d', 'D'], "e");
    let is_number = text.chars().any(|c| c.is_ascii_digit());
    exponent.parse::<f64>().ok().filter(|_| is_number)
}

fn is_failed(text: &str) -> bool {
    ["", "-", "nan", "inf", "-inf", "+inf", "failed", "diverged", "none", "null"]
        .contains(&text.to_lowercase().as_str())
}

/// Half of the last written digit of a number.
fn half_digit(text: &str) -> f64 {
    let lower = text.to_lowercase().replace('d', "e").replace(',', ".");
    let (mantissa, exponent) = lower.split_once('e').unwrap_or((&lower, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    0.5 * 10.0_f64.powi(exponent.parse::<i32>().unwrap_or(0) - i32::try_from(decimals).unwrap_or(300))
}
