//! The rows of a table: one pass, one buffer for a line, numbers parsed from its bytes.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::dialect::{self, Dialect, Separator};
use super::{Column, Table};
use crate::error::Error;

/// The longest line that is read.
const LONGEST_LINE: usize = 1 << 20;

/// Rows of which the digits are counted; later ones are printed like them.
const COUNTED: usize = 4096;

/// With how many digits a column was printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Digits {
    /// Most significant digits in a cell.
    pub significant: u32,
    /// Most digits behind the decimal mark, less the exponent.
    pub decimals: i32,
    /// Whether every cell has as many digits behind the decimal mark, and none an exponent.
    pub fixed: bool,
    /// Whether every value is a number of single precision.
    pub single: bool,
    /// Whether some cell is no whole number.
    pub fraction: bool,
}

impl Digits {
    const NONE: Digits = Digits { significant: 0, decimals: i32::MIN, fixed: true, single: true, fraction: false };

    fn count(&mut self, cell: &[u8], first: bool) {
        let (mut significant, mut zeros, mut decimals, mut behind, mut exponent) = (0_u32, 0_u32, 0_i32, false, 0_i32);
        for (i, byte) in cell.iter().enumerate() {
            match byte {
                b'0'..=b'9' => {
                    decimals += i32::from(behind);
                    if *byte == b'0' {
                        zeros += u32::from(significant > 0);
                    } else {
                        significant += 1 + zeros;
                        zeros = 0;
                    }
                }
                b'.' | b',' => behind = true,
                b'e' | b'E' => {
                    exponent = std::str::from_utf8(&cell[i + 1..]).ok().and_then(|e| e.parse().ok()).unwrap_or(0);
                    break;
                }
                _ => {}
            }
        }
        // 0.500 was printed with three digits, 0.5 with one: zeros at the end count where every cell has as many.
        self.fixed &= exponent == 0 && behind && (first || decimals == self.decimals);
        self.fraction |= behind && decimals > 0;
        self.decimals = self.decimals.max(decimals - exponent);
        self.significant = self.significant.max(significant);
    }
}

/// Refuses a line longer than any row, before it is held in memory.
pub(super) fn refuse_long_line(path: &Path, bytes: &[u8], line: usize) -> Result<(), Error> {
    let longest = bytes.split(|b| *b == b'\n').map(<[u8]>::len).max().unwrap_or(0);
    if longest < HEAD_LINE { Ok(()) } else { Err(too_long(path, line)) }
}

/// A line that fills the whole head of a file is no row.
const HEAD_LINE: usize = 256 * 1024;

fn too_long(path: &Path, line: usize) -> Error {
    let message = "the line is longer than any row of a trajectory";
    Error::at(path, line, 1, message, "give one row for each time, each on its own line")
}

struct Reader<'a> {
    path: &'a Path,
    dialect: Dialect,
    columns: Vec<Column>,
    numeric: Vec<bool>,
    long: Vec<bool>,
    rows: usize,
    scratch: String,
}

/// Reads at most so many rows.
pub(super) fn read(path: &Path, dialect: Dialect, source: impl Read, most: usize) -> Result<Table, Error> {
    let mut source = BufReader::with_capacity(1 << 16, source);
    let mut reader = Reader::new(path, dialect);
    let (mut line, mut number) = (Vec::new(), 0);
    while reader.rows < most {
        line.clear();
        let limit = LONGEST_LINE as u64 + 1;
        let read = source.by_ref().take(limit).read_until(b'\n', &mut line);
        let read = read.map_err(|source| Error::File { path: path.to_owned(), source })?;
        if read == 0 {
            break;
        }
        number += 1;
        if read > LONGEST_LINE {
            return Err(too_long(path, number));
        }
        if number > reader.dialect.lines_before {
            let ended = line.last() == Some(&b'\n');
            reader.take(line.trim_ascii(), number, ended)?;
        }
    }
    if reader.rows < 2 {
        return Err(Error::at(path, number.max(1), 1, "there is only one row", "a trajectory has at least two"));
    }
    let first_line = reader.dialect.lines_before + 1;
    Ok(Table { path: path.to_owned(), dialect: reader.dialect, columns: reader.columns, first_line })
}

impl<'a> Reader<'a> {
    fn new(path: &'a Path, dialect: Dialect) -> Self {
        let name = |i: usize| match dialect.names.get(i) {
            Some(name) if !name.is_empty() => name.clone(),
            _ => format!("column {}", i + 1),
        };
        let column = |i: usize| Column {
            name: name(i),
            unit: dialect.units.get(i).cloned(),
            values: Vec::new(),
            origin: 0,
            digits: Digits::NONE,
        };
        let columns = (0..dialect.cells).map(column).collect();
        let (numeric, long) = (vec![true; dialect.cells], vec![false; dialect.cells]);
        Reader { path, dialect, columns, numeric, long, rows: 0, scratch: String::new() }
    }

    fn take(&mut self, line: &[u8], number: usize, ended: bool) -> Result<(), Error> {
        if line.is_empty() {
            return Ok(());
        }
        let text = std::str::from_utf8(line).map_err(|_| self.error(number, 1, "the line is no text", ended))?;
        if dialect::comment(text).is_some() {
            return Ok(());
        }
        let wanted = self.dialect.cells;
        let mut found = 0;
        if text.contains('"') {
            for cell in dialect::cells(text, self.dialect.separator) {
                self.cell(found, cell, number, ended)?;
                found += 1;
            }
        } else {
            match self.dialect.separator {
                Separator::Byte(separator) => {
                    for cell in text.split(separator as char) {
                        self.cell(found, cell.trim_ascii(), number, ended)?;
                        found += 1;
                    }
                }
                Separator::Blanks => {
                    for cell in text.split_ascii_whitespace() {
                        self.cell(found, cell, number, ended)?;
                        found += 1;
                    }
                }
            }
        }
        if found < wanted {
            let message = format!("the row has {found} cells, the rows above have {wanted}");
            return Err(self.error(number, found, message, ended));
        }
        self.rows += 1;
        Ok(())
    }

    fn cell(&mut self, i: usize, cell: &str, number: usize, ended: bool) -> Result<(), Error> {
        if i >= self.dialect.cells {
            if cell.is_empty() {
                return Ok(());
            }
            let message = format!("'{cell}' is one cell more than the {} of the rows above", self.dialect.cells);
            return Err(self.error(number, i + 1, message, ended));
        }
        if self.rows == 0 {
            self.numeric[i] = dialect::number(cell, self.dialect.decimal_comma).is_some();
            let whole = cell.split(['.', ',']).next().unwrap_or("").trim_start_matches(['-', '+']);
            // f64 holds 2^53 apart: a stamp in ns, or of an epoch with its parts of a second, needs more.
            self.long[i] = whole.len() >= 9 && whole.len() < 20 && whole.bytes().all(|b| b.is_ascii_digit());
            if self.long[i] {
                self.columns[i].origin = cell.split(['.', ',']).next().and_then(|w| w.parse().ok()).unwrap_or(0);
            }
        }
        if !self.numeric[i] {
            return Ok(());
        }
        let Some(value) = self.number(i, cell) else {
            return Err(self.not_a_number(i, cell, number, ended));
        };
        let first = self.rows == 0;
        let column = &mut self.columns[i];
        if self.rows < COUNTED {
            column.digits.count(cell.as_bytes(), first);
        }
        column.digits.single &= f64::from(value as f32) == value;
        column.values.push(value);
        Ok(())
    }

    fn number(&mut self, i: usize, cell: &str) -> Option<f64> {
        if self.long[i] {
            let (whole, part) = cell.split_once(['.', ',']).unwrap_or((cell, ""));
            let offset = whole.parse::<i64>().ok()?.checked_sub(self.columns[i].origin)? as f64;
            if part.is_empty() {
                return Some(offset);
            }
            self.scratch.clear();
            self.scratch.push_str("0.");
            self.scratch.push_str(part);
            let part: f64 = self.scratch.parse().ok()?;
            return Some(if whole.starts_with('-') { offset - part } else { offset + part });
        }
        if !self.dialect.decimal_comma {
            return cell.parse().ok().filter(|x: &f64| x.is_finite());
        }
        self.scratch.clear();
        self.scratch.extend(cell.chars().map(|c| if c == ',' { '.' } else { c }));
        self.scratch.parse().ok().filter(|x: &f64| x.is_finite())
    }

    fn not_a_number(&self, i: usize, cell: &str, number: usize, ended: bool) -> Error {
        let name = &self.columns[i].name;
        let shown: String = cell.chars().take(24).collect();
        if cell.is_empty() {
            return self.error(number, i + 1, format!("the cell of '{name}' is empty"), ended);
        }
        let message = if dialect::is_not_finite(cell) {
            format!("'{shown}' in '{name}': the run is not finite from here on")
        } else {
            format!("'{shown}' in '{name}' is no number")
        };
        self.error(number, i + 1, message, ended)
    }

    fn error(&self, line: usize, column: usize, message: impl Into<String>, ended: bool) -> Error {
        let remedy = if ended {
            format!("mend the row, or audit the rows before it with --rows {}", self.rows)
        } else {
            format!("the file is cut off in its last row; audit the rows before it with --rows {}", self.rows)
        };
        Error::at(self.path, line, column, message, remedy)
    }
}
