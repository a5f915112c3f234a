//! How a text table is written: separator, decimal mark, comments, header. Found from the beginning of the file.

use std::path::Path;

use super::names;
use crate::error::Error;

/// What parts the cells of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// One byte, of which two in a row enclose an empty cell.
    Byte(u8),
    /// Any run of blanks and tabs.
    Blanks,
}

/// How a text table is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Dialect {
    /// What parts the cells.
    pub separator: Separator,
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
    /// Cells in a row, trailing empty ones left out.
    pub cells: usize,
    /// Names of the columns; empty without a header.
    pub names: Vec<String>,
    /// Units from a line of units below the names; empty without one.
    pub units: Vec<String>,
    /// Lines before the first row.
    pub lines_before: usize,
}

/// The separators in the order in which they are tried, with their decimal mark.
const TRIED: [(Separator, bool); 7] = [
    (Separator::Byte(b';'), false),
    (Separator::Byte(b';'), true),
    (Separator::Byte(b'\t'), false),
    (Separator::Byte(b'\t'), true),
    (Separator::Byte(b','), false),
    (Separator::Blanks, false),
    (Separator::Blanks, true),
];

/// Marks that begin a comment.
const COMMENTS: [&str; 4] = ["#", "%", "//", "@"];

/// First bytes of formats that are no text, and what to do with them.
const FORMATS: [(&[u8], &str, &str); 8] = [
    (b"\x1f\x8b", "a gzip archive", "unpack it with gunzip"),
    (b"PK\x03\x04", "a zip archive or a spreadsheet", "unpack it, or save the sheet as CSV"),
    (b"#ROSBAG", "a ROS bag", "export the topic with `rostopic echo -p -b FILE TOPIC > FILE.csv`"),
    (b"\x89MCAP", "an MCAP recording", "export the topic as CSV"),
    (b"\x89HDF", "an HDF5 file", "export the arrays as CSV"),
    (b"\x93NUMPY", "a NumPy array", "save it with numpy.savetxt"),
    (b"\xff\xfe", "UTF-16 text", "save it as UTF-8"),
    (b"\xfe\xff", "UTF-16 text", "save it as UTF-8"),
];

/// The text without a byte order mark.
pub(super) fn without_bom(head: &[u8]) -> &[u8] {
    head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head)
}

/// The text behind a comment mark; None for a line that is no comment.
pub(super) fn comment(line: &str) -> Option<&str> {
    COMMENTS.iter().find_map(|mark| line.strip_prefix(mark))
}

/// Cuts a line into trimmed cells, without quotes around them. Quoted cells may contain the separator.
pub(super) fn cells(line: &str, separator: Separator) -> Vec<&str> {
    let bare = |cell: &'_ str| -> (usize, usize) {
        let trimmed = cell.trim();
        let inner = trimmed.strip_prefix('"').and_then(|c| c.strip_suffix('"')).unwrap_or(trimmed);
        let start = inner.as_ptr() as usize - line.as_ptr() as usize;
        (start, start + inner.len())
    };
    let spans: Vec<(usize, usize)> = match separator {
        Separator::Blanks => line.split_ascii_whitespace().map(bare).collect(),
        Separator::Byte(byte) => {
            let mut quoted = false;
            let split = |c: char| {
                quoted ^= c == '"';
                !quoted && c == byte as char
            };
            line.split(split).map(bare).collect()
        }
    };
    spans.into_iter().map(|(start, end)| &line[start..end]).collect()
}

/// The number in a cell; None where there is none.
pub(super) fn number(cell: &str, decimal_comma: bool) -> Option<f64> {
    let starts = |b: &u8| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b',');
    if !cell.as_bytes().first().is_some_and(starts) {
        return None;
    }
    if !decimal_comma {
        return cell.parse().ok();
    }
    if cell.contains('.') { None } else { cell.replacen(',', ".", 1).parse().ok() }
}

/// Whether a cell is how programs write 'not a number' or infinity.
pub(super) fn is_not_finite(cell: &str) -> bool {
    let lower = cell.trim_start_matches(['+', '-']).to_ascii_lowercase();
    ["nan", "inf", "infinity", "1.#ind", "1.#inf", "1.#qnan", "-nan(ind)", "nan(ind)", "null", "none"]
        .contains(&lower.as_str())
}

/// Finds the dialect from the beginning of a file.
///
/// # Errors
/// A format that is no text; no row of numbers.
pub(super) fn find(path: &Path, head: &[u8], whole: bool) -> Result<Dialect, Error> {
    if let Some((_, what, remedy)) = FORMATS.iter().find(|(magic, _, _)| head.starts_with(magic)) {
        return Err(Error::at(path, 1, 1, format!("this is {what}, not a table of text"), *remedy));
    }
    let text = without_bom(head);
    if let Some(at) = text.iter().position(|b| *b < 9) {
        let line = 1 + text[..at].iter().filter(|b| **b == b'\n').count();
        return Err(Error::at(path, line, 1, "this is binary, not a table of text", "export the trajectory as CSV"));
    }
    // The last line of a part of a file may be cut.
    let end = if whole { text.len() } else { text.iter().rposition(|b| *b == b'\n').unwrap_or(text.len()) };
    let text = String::from_utf8_lossy(&text[..end]);
    let lines: Vec<&str> = text.split('\n').map(str::trim).collect();
    let Some((first, dialect)) =
        lines.iter().enumerate().find_map(|(i, line)| Some((i, first_row(line, &lines[i..])?)))
    else {
        let line = lines.iter().position(|line| !line.is_empty()).map_or(1, |i| i + 1);
        let shown: String = lines[line - 1].chars().take(60).collect();
        let message = if shown.is_empty() {
            "the file is empty".to_owned()
        } else {
            format!("no row of at least two numbers; the file begins with '{shown}'")
        };
        return Err(Error::at(path, line, 1, message, "give one row for each time, cells parted by , ; tab or blanks"));
    };
    let mut dialect = Dialect { lines_before: first, ..dialect };
    take_header(&mut dialect, &lines[..first]);
    Ok(dialect)
}

/// The dialect in which a line is a row of numbers, if there is one and the next row agrees.
fn first_row(line: &str, rest: &[&str]) -> Option<Dialect> {
    if line.is_empty() || comment(line).is_some() {
        return None;
    }
    let next = rest[1..].iter().find(|line| !line.is_empty() && comment(line).is_none());
    TRIED.iter().find_map(|&(separator, decimal_comma)| {
        let numbers = |line: &str| {
            let mut row = cells(line, separator);
            while row.last() == Some(&"") {
                row.pop();
            }
            let found = row.iter().filter(|cell| number(cell, decimal_comma).is_some()).count();
            (row.len(), found, row.iter().all(|c| number(c, decimal_comma).is_some() || text_or_empty(c)))
        };
        let (count, found, plain) = numbers(line);
        let agrees = next.is_none_or(|next| numbers(next).1 * 2 >= found);
        let dialect = Dialect { separator, decimal_comma, cells: count, names: vec![], units: vec![], lines_before: 0 };
        (plain && found >= 2 && found * 2 > count.min(4) && agrees).then_some(dialect)
    })
}

/// A cell of a column of text: a frame's name, or nothing.
fn text_or_empty(cell: &str) -> bool {
    cell.bytes().next().is_none_or(|b| b.is_ascii_alphabetic() || b == b'_' || b == b'/')
}

/// Takes the names, and the units below them, from the lines before the first row.
fn take_header(dialect: &mut Dialect, before: &[&str]) {
    let mut candidates: Vec<Vec<String>> = Vec::new();
    for line in before.iter().filter(|line| !line.is_empty()) {
        let text = comment(line).unwrap_or(line);
        let tried = [dialect.separator, Separator::Byte(b','), Separator::Byte(b'\t'), Separator::Blanks];
        let names = tried.iter().find_map(|&separator| {
            let mut names: Vec<String> = cells(text, separator).iter().map(|c| (*c).to_owned()).collect();
            while names.len() > dialect.cells && names.last().is_some_and(String::is_empty) {
                names.pop();
            }
            if names.len() + 1 == dialect.cells && names.len() > 1 && !names.iter().any(String::is_empty) {
                names.insert(0, String::new());
            }
            let named = names.iter().filter(|name| names::looks_like_a_name(name)).count();
            (names.len() == dialect.cells && named * 2 >= names.len()).then_some(names)
        });
        candidates.extend(names);
    }
    let score = |names: &Vec<String>| names.iter().filter(|name| names::recognise(name).is_some()).count();
    let Some(best) = (0..candidates.len()).max_by_key(|&i| (score(&candidates[i]), candidates.len() - i)) else {
        return;
    };
    let is_units = |names: &&Vec<String>| {
        let known = names.iter().filter(|n| n.is_empty() || *n == "-" || names::unit(n).is_some()).count();
        known * 2 > names.len()
    };
    dialect.units = candidates.get(best + 1).filter(is_units).cloned().unwrap_or_default();
    dialect.names = candidates.swap_remove(best);
}
