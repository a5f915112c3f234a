//! Rows as CSV, and small tables as text, Markdown and HTML.

use crate::Error;
use serde::{Serialize, de::DeserializeOwned};

/// Rows as CSV with a header. A field is written so that reading it gives the same value back, bit for bit for a
/// finite f64, an infinity (`inf`) or a NaN (`NaN`, whatever its payload); an `Option` that is `None` is empty.
/// No rows give no header.
///
/// # Errors
/// [`Error::Rows`] when a row has no flat form.
pub fn write_csv<R: Serialize>(rows: &[R]) -> Result<String, Error> {
    let refuse = |message: String| Error::Rows { message };
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(|e| refuse(e.to_string()))?;
    }
    let bytes = writer.into_inner().map_err(|e| refuse(e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| refuse(e.to_string()))
}

/// The rows of a CSV text with a header; `place` is the file it came from, for errors.
///
/// # Errors
/// [`Error::Csv`] with line and column: a field that cannot be read, a missing column, a line too long or too short.
pub fn read_csv<R: DeserializeOwned>(text: &str, place: &str) -> Result<Vec<R>, Error> {
    read_csv_with(text, place, &[])
}

/// The same where each record has these columns and cells as well, which the text does not repeat.
///
/// # Errors
/// As [`read_csv`].
pub fn read_csv_with<R: DeserializeOwned>(text: &str, place: &str, more: &[(&str, &str)]) -> Result<Vec<R>, Error> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut headers = reader.headers().map_err(|e| locate(&e, place, &csv::StringRecord::new()))?.clone();
    more.iter().for_each(|(name, _)| headers.push_field(name));
    let row = |record: Result<csv::StringRecord, csv::Error>| {
        let mut record = record?;
        more.iter().for_each(|(_, cell)| record.push_field(cell));
        record.deserialize(Some(&headers))
    };
    reader.records().map(|record| row(record).map_err(|e| locate(&e, place, &headers))).collect()
}

/// These columns of a CSV text with a header, in this order.
///
/// # Errors
/// [`Error::Rows`] when there is no such column.
pub fn columns_of_csv(text: &str, columns: &[&str]) -> Result<String, Error> {
    let refuse = |message: String| Error::Rows { message };
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let headers = reader.headers().map_err(|e| refuse(e.to_string()))?;
    let place = |column: &&str| {
        let found = headers.iter().position(|header| header == *column);
        found.ok_or_else(|| refuse(format!("there is no column '{column}'")))
    };
    let places: Vec<usize> = columns.iter().map(place).collect::<Result<_, _>>()?;
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns).map_err(|e| refuse(e.to_string()))?;
    for record in reader.records() {
        let record = record.map_err(|e| refuse(e.to_string()))?;
        writer.write_record(places.iter().map(|&at| &record[at])).map_err(|e| refuse(e.to_string()))?;
    }
    let bytes = writer.into_inner().map_err(|e| refuse(e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| refuse(e.to_string()))
}

fn locate(error: &csv::Error, place: &str, headers: &csv::StringRecord) -> Error {
    let line = error.position().map_or(0, csv::Position::line);
    let (column, message) = match error.kind() {
        csv::ErrorKind::Deserialize { err, .. } => match err.field().and_then(|field| usize::try_from(field).ok()) {
            Some(field) => (field as u64 + 1, format!("'{}': {}", headers.get(field).unwrap_or("?"), err.kind())),
            None => (0, err.kind().to_string()),
        },
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            (*len.min(expected_len) + 1, format!("{len} fields where the header has {expected_len}"))
        }
        _ => (0, error.to_string()),
    };
    Error::Csv { place: place.to_owned(), line, column, message }
}

/// How a column is set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Words.
    #[default]
    Left,
    /// Numbers.
    Right,
}

/// A small table of texts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Column headings, each with its unit.
    pub headers: Vec<String>,
    /// How each column is set; `Left` where missing.
    pub align: Vec<Align>,
    /// Rows; a missing cell is empty.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table with these headings; columns whose heading is in `numbers` are set to the right.
    pub fn new(headers: &[&str], numbers: &[&str]) -> Self {
        let align = |header: &&str| if numbers.contains(header) { Align::Right } else { Align::Left };
        Self {
            headers: headers.iter().map(|&header| header.to_owned()).collect(),
            align: headers.iter().map(align).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row.
    pub fn push<S: Into<String>>(&mut self, row: impl IntoIterator<Item = S>) {
        self.rows.push(row.into_iter().map(Into::into).collect());
    }

    /// Number of columns: that of the longest line.
    pub(crate) fn columns(&self) -> usize {
        self.rows.iter().map(Vec::len).fold(self.headers.len(), usize::max)
    }

    pub(crate) fn align(&self, column: usize) -> Align {
        self.align.get(column).copied().unwrap_or_default()
    }

    /// Plain text for a terminal: columns padded with blanks, headings underlined, no blank at a line's end.
    pub fn to_text(&self) -> String {
        let lines = || std::iter::once(&self.headers).chain(&self.rows);
        let widths: Vec<usize> =
            (0..self.columns()).map(|c| lines().map(|line| width(cell(line, c))).fold(0, usize::max)).collect();
        let set = |line: &Vec<String>| {
            let cells = widths.iter().enumerate().map(|(c, &w)| pad(cell(line, c), w, self.align(c)));
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
        };
        let rule = widths.iter().map(|&w| "─".repeat(w)).collect::<Vec<_>>().join("  ") + "\n";
        set(&self.headers) + &rule + &self.rows.iter().map(set).collect::<String>()
    }

    /// A Markdown table.
    pub fn to_markdown(&self) -> String {
        let columns = self.columns();
        let safe = |text: &str| text.replace('\\', "\\\\").replace('|', "\\|").replace('\n', "<br>");
        let set = |line: &Vec<String>| {
            (0..columns).map(|c| format!("| {} ", safe(cell(line, c)))).collect::<String>() + "|\n"
        };
        let rule = |c| if self.align(c) == Align::Right { "|---:" } else { "|---" };
        set(&self.headers)
            + &(0..columns).map(rule).collect::<String>()
            + "|\n"
            + &self.rows.iter().map(set).collect::<String>()
    }
}

pub(crate) fn cell(line: &[String], column: usize) -> &str {
    line.get(column).map_or("", String::as_str)
}

/// Columns a text takes in a terminal. Greek, superscripts and signs take one each; accents that combine take none.
/// East Asian wide characters, which reports do not use, are not told apart.
fn width(text: &str) -> usize {
    text.chars()
        .filter(|c| !matches!(c, '\u{300}'..='\u{36f}' | '\u{200b}'..='\u{200d}' | '\u{20d0}'..='\u{20ff}'))
        .count()
}

fn pad(text: &str, to: usize, align: Align) -> String {
    let blanks = " ".repeat(to.saturating_sub(width(text)));
    match align {
        Align::Left => format!("{text}{blanks}"),
        Align::Right => format!("{blanks}{text}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Row {
        scene: String,
        h_s: f64,
        error_m: Option<f64>,
    }

    /// SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
    fn random_bits(state: &mut u64) -> u64 {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    #[test]
    fn every_double_comes_back_from_csv_bit_for_bit() {
        let special =
            [0.0, -0.0, 5e-324, -2.2e-308, f64::MIN_POSITIVE, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, 0.1];
        let mut state = 1;
        let random = std::iter::repeat_with(|| f64::from_bits(random_bits(&mut state))).take(20_000);
        let values: Vec<f64> = special.into_iter().chain(random.filter(|v| !v.is_nan())).collect();
        let rows: Vec<Row> = values.iter().map(|&v| Row { scene: "a".to_owned(), h_s: v, error_m: Some(-v) }).collect();
        let text = write_csv(&rows).expect("flat rows");
        let back: Vec<Row> = read_csv(&text, "rows.csv").expect("what was written");
        assert_eq!(back.len(), values.len());
        for (row, value) in back.iter().zip(values) {
            assert_eq!((row.h_s.to_bits(), row.error_m.map(f64::to_bits)), (value.to_bits(), Some((-value).to_bits())));
        }
    }

    #[test]
    fn what_is_not_a_number_and_what_is_missing_stay_apart() {
        let rows = [Row { scene: "a, \"b\"\nc".to_owned(), h_s: f64::NAN, error_m: None }];
        let text = write_csv(&rows).expect("flat rows");
        assert_eq!(text, "scene,h_s,error_m\n\"a, \"\"b\"\"\nc\",NaN,\n");
        let back: Vec<Row> = read_csv(&text, "rows.csv").expect("what was written");
        assert!(back[0].h_s.is_nan() && back[0].error_m.is_none() && back[0].scene == rows[0].scene);
    }

    #[test]
    fn a_bad_field_is_named_by_file_line_and_column() {
        let read = |text: &str| read_csv::<Row>(text, "data/rows.csv").expect_err("bad").to_string();
        let bad = read("scene,h_s,error_m\na,1,\nb,fast,2\n");
        assert!(bad.starts_with("data/rows.csv:3:2: 'h_s': ") && bad.contains("float"), "{bad}");
        let short = read("scene,h_s,error_m\na,1\n");
        assert!(short.starts_with("data/rows.csv:2:3: 2 fields where the header has 3; "), "{short}");
        let missing = read("scene,error_m\na,1\n");
        assert!(missing.starts_with("data/rows.csv:2:0: ") && missing.contains("h_s"), "{missing}");
    }

    fn table() -> Table {
        let mut table = Table::new(&["method", "order"], &["order"]);
        table.push(["Störmer–Verlet, θ̇", "2"]);
        table.push(["a|b <i>", "−10⁻³"]);
        table.push(["short"]);
        table
    }

    #[test]
    fn text_columns_line_up_also_with_accents_and_superscripts() {
        let expected = "method             order\n\
                        ─────────────────  ─────\n\
                        Störmer–Verlet, θ̇      2\n\
                        a|b <i>            −10⁻³\n\
                        short\n";
        assert_eq!(table().to_text(), expected);
    }

    #[test]
    fn markdown_escapes_what_would_end_a_cell() {
        let markdown = table().to_markdown();
        assert!(
            markdown.starts_with("| method | order |\n|---|---:|\n| Störmer–Verlet, θ̇ | 2 |\n| a\\|b <i> | −10⁻³ |\n")
        );
        assert!(markdown.ends_with("| short |  |\n"), "{markdown}");
    }
}
