//! The file of bounds: CSV with comment lines, sorted, closed by a line that tells how many rows it holds.

use csv::{ReaderBuilder, StringRecord};

use super::known::{Known, with_settings, without_settings};
use super::row::{Key, Kind, Row, Subject};
use measure::error::Error;
use scenes::run::Precision;

/// The columns, in their order; after the first may stand [`SET`].
pub const COLUMNS: [&str; 13] = [
    "scene",
    "method",
    "precision",
    "quantity",
    "kind",
    "steps",
    "end_s",
    "unit",
    "low",
    "high",
    "measured",
    "reason",
    "mutant",
];

/// The column of scene parameters, `NAME=VALUE` parted by blanks. A file without it holds scenes with their default parameters.
pub const SET: &str = "set";

/// What a reader of the file should know; written at its head.
const HEAD: &str = "\
# Error bounds, one number a row. `cargo run --release --bin bounds` checks them; README says how they are set.
# scene, method, precision, quantity, kind, steps, end_s: which number. steps is the number of steps n up to end_s, in s.
#   order                 2 p(n/2,n) - p(n/4,n/2), p(m,n) = log2(error(m)/error(n)): the order, extrapolated to h = 0
#   error-at-step         distance from the exact motion at end_s
#   error-constant        2 c(n) - c(n/2), c = error/h^p: extrapolated to h = 0
#   drift                 largest error of an invariant along the run, over the invariant at the start (rad for a direction)
#   growth-law            p of error ~ t^p over the last decade of the run
#   growth-rate           r of E/E0 = exp(r t)
#   stability-limit       largest stable step over the scene's time scale; 0: none, 1024: no limit found
#   evaluations-per-step  of the force law, or of the torque
# low <= number <= high, in the unit of the row. measured: the number when the bound was set.
# reason: 'theory: ...', or 'measured x F: ...' for low = measured / F, high = measured * F (low = 0 with 'x F, from 0'), or
# 'measured +- W: ...' for low = measured - W, high = measured + W. mutant: what is known to break it.
";

/// The longest run that a row may ask for.
pub const MOST_STEPS: u64 = 1 << 24;

/// The rows of a file; `place` is its name, for errors.
///
/// # Errors
/// With file, line and column (no column where a whole line is meant): whatever is not a sorted file of bounds that name a run.
pub fn read(bytes: &[u8], place: &str) -> Result<(Vec<Row>, Known), Error> {
    let at = |line: u64, column: usize, message: String| at(place, line, column, message);
    let text = utf8(bytes, place)?;
    let mut reader = ReaderBuilder::new().comment(Some(b'#')).flexible(true).from_reader(text.as_bytes());
    let headers = reader.headers().map_err(|e| at(0, 0, e.to_string()))?.clone();
    let header_line = text.lines().position(|line| !line.starts_with('#') && !line.is_empty()).unwrap_or(0) as u64 + 1;
    check_headers(&headers).map_err(|(column, message)| at(header_line, column, message))?;
    let mut known = Known::catalogue();
    let mut rows: Vec<(Key, u64, Row)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| at(e.position().map_or(0, csv::Position::line), 0, e.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let row = parse(&record, &headers, &mut known).map_err(|(column, message)| at(line, column, message))?;
        let key = row.key();
        if let Some((before, earlier, _)) = rows.last() {
            if *before == key {
                return Err(at(line, 0, format!("the same number as in line {earlier}; delete one of the two")));
            }
            if *before > key {
                return Err(at(line, 0, format!("out of order: it belongs before line {earlier}; move it there")));
            }
        }
        rows.push((key, line, row));
    }
    let rows: Vec<Row> = rows.into_iter().map(|(_, _, row)| row).collect();
    let lines = text.lines().count() as u64;
    check_end(text, rows.len()).map_err(|message| at(lines.max(1), 0, message))?;
    if rows.is_empty() {
        return Err(at(lines, 0, "holds no row: a gate without rows holds nothing".to_owned()));
    }
    Ok((rows, known))
}

/// A file's bytes as text.
///
/// # Errors
/// [`reports::Error::Csv`] with line and column of the first byte that is not UTF-8.
pub fn utf8<'a>(bytes: &'a [u8], place: &str) -> Result<&'a str, Error> {
    std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line = before.iter().filter(|&&b| b == b'\n').count() as u64 + 1;
        let column = before.iter().rev().take_while(|&&b| b != b'\n').filter(|&&b| b == b',').count() as u64 + 1;
        let byte = bytes[error.valid_up_to()];
        let message = format!("byte 0x{byte:02x} is not UTF-8; save the file as UTF-8");
        reports::Error::Csv { place: place.to_owned(), line, column, message }.into()
    })
}

/// What is wrong in one column of a line.
pub(super) fn at(place: &str, line: u64, column: usize, message: String) -> Error {
    if column == 0 {
        return whole(place, line, message);
    }
    reports::Error::Csv { place: place.to_owned(), line, column: column as u64, message }.into()
}

/// What is wrong with a line as a whole.
pub(super) fn whole(place: &str, line: u64, message: String) -> Error {
    Error::plan(format!("{place}:{line}"), message)
}

/// An error of a whole line names no column.
pub(super) fn without_column_zero(error: reports::Error) -> Error {
    match error {
        reports::Error::Csv { place, line, column: 0, message } => whole(&place, line, message),
        other => other.into(),
    }
}

/// Rows as the text of a file, sorted.
///
/// # Errors
/// [`reports::Error::Rows`] where a row has no form as CSV.
pub fn write(rows: &[Row]) -> Result<String, Error> {
    let mut sorted: Vec<&Row> = rows.iter().collect();
    sorted.sort_by_cached_key(|row| row.key());
    let mut writer = csv::Writer::from_writer(Vec::new());
    let refuse = |message: String| Error::from(reports::Error::Rows { message });
    let has_settings = sorted.iter().any(|row| !without_settings(&row.scene).1.is_empty());
    let columns = |mut all: Vec<String>, set: &str| {
        if has_settings {
            all.insert(1, set.to_owned());
        }
        all
    };
    let header = COLUMNS.map(str::to_owned).to_vec();
    writer.write_record(columns(header, SET)).map_err(|e| refuse(e.to_string()))?;
    for row in sorted {
        let fields = columns(fields(row).to_vec(), without_settings(&row.scene).1);
        writer.write_record(fields).map_err(|e| refuse(e.to_string()))?;
    }
    let bytes = writer.into_inner().map_err(|e| refuse(e.to_string()))?;
    let body = String::from_utf8(bytes).map_err(|e| refuse(e.to_string()))?;
    Ok(format!("{HEAD}{body}{}\n", end(rows.len())))
}

/// A row as the fields of its line. A number is written so that reading it gives the same number back.
pub fn fields(row: &Row) -> [String; 13] {
    [
        without_settings(&row.scene).0.to_owned(),
        row.method.clone(),
        row.precision.id().to_owned(),
        row.quantity.id().to_owned(),
        row.kind.id().to_owned(),
        row.steps.to_string(),
        format!("{:?}", row.end_s),
        row.unit.clone(),
        format!("{:?}", row.low),
        format!("{:?}", row.high),
        format!("{:?}", row.measured),
        row.reason.clone(),
        row.mutant.clone(),
    ]
}

/// The last line of a file that is whole.
pub(super) fn end(rows: usize) -> String {
    format!("# end: {rows} rows")
}

pub(super) fn check_end(text: &str, rows: usize) -> Result<(), String> {
    match text.lines().last() {
        Some(last) if last == end(rows) => Ok(()),
        Some(last) if last.starts_with("# end: ") => Err(format!(
            "'{last}', but the file holds {rows}: lines are lost, or the last line should be '{}'",
            end(rows)
        )),
        _ => Err(format!("truncated: the last line should be '# end: N rows', and {rows} rows were read")),
    }
}

/// What is wrong, and in which column (from 1; 0 for the whole line).
type Wrong = (usize, String);

fn check_headers(headers: &StringRecord) -> Result<(), Wrong> {
    if headers.is_empty() {
        return Err((0, format!("no rows: the header should be {}", COLUMNS.join(","))));
    }
    let all = format!("the columns are {}; after scene may stand {SET}", COLUMNS.join(","));
    if let Some(column) = headers.iter().position(|name| name != SET && !COLUMNS.contains(&name)) {
        return Err((column + 1, format!("unknown column '{}'; {all}", &headers[column])));
    }
    let mut expected = COLUMNS.to_vec();
    if headers.get(1) == Some(SET) {
        expected.insert(1, SET);
    }
    match expected.iter().enumerate().find(|(i, name)| headers.get(*i) != Some(name)) {
        Some((i, name)) => Err((i + 1, format!("column '{name}' is missing here; {all}"))),
        None if headers.len() > expected.len() => Err((expected.len() + 1, "a column too many".to_owned())),
        None => Ok(()),
    }
}

fn parse(record: &StringRecord, headers: &StringRecord, known: &mut Known) -> Result<Row, Wrong> {
    let count = headers.len();
    if record.len() != count {
        let message = format!("{} fields where the header has {count}", record.len());
        return Err((record.len().min(count) + usize::from(record.len() < count), message));
    }
    let column = |name: &str| headers.iter().position(|column| column == name).map_or(0, |i| i + 1);
    let field = |name: &str| column(name).checked_sub(1).and_then(|i| record.get(i)).unwrap_or("");
    let wrong = |name: &'static str| move |message: String| (column(name), format!("'{name}': {message}"));
    let of_name = |name: &'static str| move |error: &dyn std::fmt::Display| (column(name), error.to_string());
    let number = |name: &'static str| {
        let text = field(name);
        let x: f64 = text.parse().map_err(|_| wrong(name)(format!("'{text}' is not a number")))?;
        if x.is_finite() { Ok(x) } else { Err(wrong(name)(format!("{text} is no bound; give a finite number"))) }
    };
    let (id, settings) = (field("scene"), field(SET).split_whitespace().collect::<Vec<_>>().join(" "));
    if scenes::IDS.contains(&id) {
        known.add(id, &settings).map_err(|error| (column(SET), error.to_string()))?;
    }
    let row = Row {
        scene: with_settings(id, &settings),
        method: field("method").to_owned(),
        precision: Precision::from_id(field("precision")).map_err(|error| of_name("precision")(&error))?,
        quantity: Subject::from_id(field("quantity")).map_err(|error| of_name("quantity")(&error))?,
        kind: Kind::from_id(field("kind")).map_err(|error| of_name("kind")(&error))?,
        steps: field("steps")
            .parse()
            .map_err(|_| wrong("steps")(format!("'{}' is not a number of steps", field("steps"))))?,
        end_s: number("end_s")?,
        unit: field("unit").to_owned(),
        low: number("low")?,
        high: number("high")?,
        measured: number("measured")?,
        reason: field("reason").to_owned(),
        mutant: field("mutant").to_owned(),
    };
    known.scene(&row).map_err(|error| of_name("scene")(&error))?;
    known.method(&row).map_err(|error| of_name("method")(&error))?;
    known.quantity(&row).map_err(wrong("quantity"))?;
    known.mutant(&row).map_err(|error| of_name("mutant")(&error))?;
    check_run(&row).map_err(|(name, message)| (column(name), format!("'{name}': {message}")))?;
    let unit = known.unit(&row);
    if row.unit != unit {
        return Err(wrong("unit")(format!(
            "'{}' where {} of {} is in '{unit}'",
            row.unit,
            row.kind.id(),
            row.quantity.id()
        )));
    }
    Ok(row)
}

/// What is wrong with the numbers of a row, and the column.
fn check_run(row: &Row) -> Result<(), (&'static str, String)> {
    let divisor = row.kind.divisor();
    if row.steps == 0 || row.steps > MOST_STEPS || !row.steps.is_multiple_of(divisor) {
        let multiple = if divisor > 1 { format!(", a multiple of {divisor} for this kind") } else { String::new() };
        return Err(("steps", format!("{}: give 1 to {MOST_STEPS}{multiple}", row.steps)));
    }
    if !(row.end_s > 0.0) {
        return Err(("end_s", format!("{}: give a time after the start", row.end_s)));
    }
    if row.low > row.high {
        return Err(("low", format!("{:?} is above high {:?}", row.low, row.high)));
    }
    if !row.admits(row.measured) {
        return Err((
            "measured",
            format!("{:?} is outside {:?} to {:?}: it never held", row.measured, row.low, row.high),
        ));
    }
    check_reason(row).map_err(|message| ("reason", message))
}

/// What a bound may differ by from what its reason makes it: bounds are written with six digits.
const SIX_DIGITS: f64 = 1e-5;

/// Whether the reason is one, and the bounds are those that it makes.
fn check_reason(row: &Row) -> Result<(), String> {
    let Some([low, high]) = row.of_reason()? else { return Ok(()) };
    for (name, is, made) in [("low", row.low, low), ("high", row.high, high)] {
        if !((is - made).abs() <= SIX_DIGITS * made.abs().max(row.measured.abs())) {
            return Err(format!("{name} is {is} where the reason makes it {made}"));
        }
    }
    Ok(())
}
