//! `order`: what order a table of errors or of values shows.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use reports::Table;
use serde::Serialize;

use super::{Ending, ProgramInfo};
use measure::error::Error;
use measure::study::short;
use measure::tables::judge::Verdict;
use measure::tables::{self, Ask, Judged, Layout, Of};

/// What the binary says of itself.
pub const WORDS: ProgramInfo = ProgramInfo {
    name: "order",
    about: "Judges the order of convergence in a table of errors, or of values without a truth, that another program computed",
    examples: "order errors.csv                                   columns h and error: the observed order
        order errors.csv --expect 4                        exit code 1 unless the order is 4
        order grid.csv --dimension 2 --values              columns cells and f: order, limit and grid convergence index
        order errors.csv --precision f32 --scale 100       rounding is that of f32 on numbers of size 100",
};

/// What to judge, and against what.
#[derive(Args, Clone, Debug)]
pub struct Flags {
    /// Tables with one row for each step: the first column h, steps or cells, the others errors or values
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    /// What the first column holds, where its name does not say it
    #[arg(long, value_enum, help_heading = "The table")]
    first: Option<First>,

    /// The first column is a number of cells in D dimensions: h = cells^(-1/D)
    #[arg(long, value_name = "D", value_parser = clap::value_parser!(u32).range(1..=9), help_heading = "The table")]
    dimension: Option<u32>,

    /// The other columns are errors
    #[arg(long, help_heading = "The table", conflicts_with = "values")]
    errors: bool,

    /// The other columns are values of which no truth is known
    #[arg(long, help_heading = "The table")]
    values: bool,

    /// The arithmetic that computed the table
    #[arg(long, value_enum, default_value = "f64", help_heading = "The table")]
    precision: Arithmetic,

    /// Size of the quantity, in the unit of its errors: its rounding is that of the arithmetic times this
    #[arg(long, value_name = "S", value_parser = positive, default_value = "1", help_heading = "The table")]
    scale: f64,

    /// Error from which on a run says nothing about its step, as the diameter of an orbit
    #[arg(long, value_name = "X", value_parser = positive, help_heading = "The table")]
    saturation: Option<f64>,

    /// The order that is expected; exit code 1 where a column does not show it
    #[arg(long, value_name = "P", value_parser = positive, help_heading = "What to ask")]
    expect: Option<f64>,

    /// Accepted difference from the expected order, either way
    #[arg(long, value_name = "X", value_parser = positive, default_value = "0.1", help_heading = "What to ask")]
    tolerance: f64,

    /// Safety factor of the grid convergence index: 1.25 for three rows or more, 3 for a cautious reader
    #[arg(long, value_name = "F", value_parser = positive, default_value = "1.25", help_heading = "What to ask")]
    safety: f64,

    /// Print JSON, for machines
    #[arg(long, help_heading = "What to print")]
    json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum First {
    /// The step
    H,
    /// The number of steps
    Steps,
    /// The number of cells
    Cells,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Arithmetic {
    /// 24 bits
    F32,
    /// 53 bits
    F64,
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite());
    number.ok_or_else(|| "not a finite number above zero".to_owned())
}

/// What a machine is told. Keys are added and never change their meaning under the same `format`.
#[derive(Serialize)]
struct ForMachines {
    format: u32,
    files: Vec<File>,
}

#[derive(Serialize)]
struct File {
    path: String,
    columns: Vec<Judged>,
}

/// Does what the flags ask for.
///
/// # Errors
/// A file that cannot be read or is no table.
pub fn run(flags: &Flags) -> Result<Ending, Error> {
    let first = flags.first.map(|first| match first {
        First::H => "h",
        First::Steps => "steps",
        First::Cells => "cells",
    });
    let of = if flags.errors { Some(Of::Errors) } else { flags.values.then_some(Of::Values) };
    let layout = Layout { first: first.map(str::to_owned), dimension: flags.dimension, of };
    let epsilon = match flags.precision {
        Arithmetic::F32 => f64::from(f32::EPSILON),
        Arithmetic::F64 => f64::EPSILON,
    };
    let ask = Ask {
        expect: flags.expect,
        tolerance: flags.tolerance,
        safety: flags.safety,
        epsilon,
        scale: flags.scale,
        saturation: flags.saturation.unwrap_or(f64::INFINITY),
    };
    let mut files = Vec::new();
    let mut text = String::new();
    for path in &flags.files {
        let table = tables::read(&contents(path)?, &path.display().to_string(), &layout)?;
        let columns = tables::judge(&table, &ask);
        for column in &columns {
            if !text.is_empty() {
                text.push('\n');
            }
            shown(&mut text, path, &table, column, &ask);
        }
        files.push(File { path: path.display().to_string(), columns });
    }
    let mut columns = files.iter().flat_map(|file| &file.columns);
    let fails = flags.expect.is_some() && columns.any(|column| column.verdict != Verdict::AsExpected);
    if flags.json {
        let refuse = |error: serde_json::Error| Error::plan("JSON", error.to_string());
        text = serde_json::to_string_pretty(&ForMachines { format: 1, files }).map_err(refuse)? + "\n";
    }
    Ok(Ending { text, note: None, code: u8::from(fails) })
}

fn contents(path: &Path) -> Result<String, Error> {
    let place = path.display().to_string();
    let bytes = std::fs::read(path)
        .map_err(|error| Error::plan(&place, format!("cannot be read: {error}; give the path of a table")))?;
    String::from_utf8(bytes).map_err(|error| Error::plan(&place, format!("{error}; give a table as text in UTF-8")))
}

fn headline(column: &Judged, ask: &Ask) -> String {
    let order = match (column.order, column.interval) {
        (Some(order), Some([low, high])) => format!("order {order:.3} ({low:.3} to {high:.3})"),
        (Some(order), None) => format!("order {order:.3}"),
        _ => "no order".to_owned(),
    };
    let expected = ask.expect.map(|p| format!(" of {p}")).unwrap_or_default();
    let verdict = match column.verdict {
        Verdict::Found => String::new(),
        Verdict::AsExpected => format!(", the expected order{expected}"),
        Verdict::TooLow => format!(", below the expected order{expected}"),
        Verdict::TooHigh => format!(", above the expected order{expected}"),
        Verdict::NoOrder if ask.expect.is_some() => format!(", and the expected order{expected} is not shown"),
        Verdict::NoOrder if column.order.is_some() => ", which is not established".to_owned(),
        Verdict::NoOrder => String::new(),
    };
    let names: Vec<&str> = column.troubles.iter().map(|trouble| trouble.kind.title()).collect();
    let troubles = if names.is_empty() { String::new() } else { format!("; {}", names.join(", ")) };
    format!("{order}{verdict}{troubles}")
}

fn shown(text: &mut String, path: &Path, table: &tables::Table, column: &Judged, ask: &Ask) {
    // Writing to a string cannot fail.
    let mut line = |words: String| {
        let _ = writeln!(text, "{words}");
    };
    line(format!("{}, {}: {}", path.display(), column.name, headline(column, ask)));
    for trouble in &column.troubles {
        line(format!("  {}: {}", trouble.kind.title(), trouble.evidence));
        line(format!("    {}", trouble.remedy));
    }
    if let Some(found) = column.extrapolation {
        line(format!(
            "  limit {:.6}, GCI {:.4} % of the finest value with the safety factor {}",
            found.value,
            100.0 * found.gci,
            found.safety
        ));
        line(format!(
            "  relative error {:.3} % between the finest two, {:.3} % from the limit; asymptotic ratio {:.4}",
            100.0 * found.approximate_error,
            100.0 * found.extrapolated_error,
            found.asymptotic_ratio
        ));
    }
    if let (Some(constant), Some([coarse, fine]), Some(p)) = (column.constant, column.window, column.order) {
        line(format!(
            "  error = {} h^{p:.2} from h = {} to {}",
            short(Some(constant)),
            short(Some(coarse)),
            short(Some(fine))
        ));
    }
    let of_values = column.extrapolation.is_some() || column.refusal.is_some();
    let (what, rate) = if of_values { ("value", "order of three") } else { ("error", "rate") };
    // The step as it was written, unless it had to be computed.
    let is_step = table.labels.iter().zip(&column.h).all(|(label, h)| label.parse() == Ok(*h));
    let names: Vec<&str> =
        [Some(table.first.as_str()), (!is_step).then_some("h"), Some(what), Some(rate)].into_iter().flatten().collect();
    let mut rows = Table::new(&names, &names);
    let late = column.h.len() - column.rates.len();
    for (i, (h, number)) in column.h.iter().zip(&column.numbers).enumerate() {
        let rate = i.checked_sub(late).and_then(|at| column.rates[at]).map_or("–".to_owned(), |p| format!("{p:.3}"));
        let number = number.map_or("failed".to_owned(), |x| if of_values { x.to_string() } else { short(Some(x)) });
        let step = (!is_step).then(|| short(Some(*h)));
        rows.push([Some(table.labels[i].clone()), step, Some(number), Some(rate)].into_iter().flatten());
    }
    line(String::new());
    text.push_str(&rows.to_text());
}
