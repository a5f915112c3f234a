//! The lengths of frames: read from a list or a file, drawn at random, cut by a clamp.

use std::path::Path;

use crate::error::Error;
use crate::random::Generator;

use super::description::{Frames, Loop};

/// Frames in a pattern, at most.
const MOST: usize = 1 << 20;

/// The lengths in a list `0.016,0.02`, or in the first column of a file `FILE.csv`, which may have a header.
///
/// # Errors
/// A file that cannot be read, or what is no length of time, with its place.
pub(super) fn read(text: &str) -> Result<Vec<f64>, Error> {
    let path = Path::new(text.trim());
    let is_file = path.extension().is_some_and(|ending| ["csv", "txt"].iter().any(|e| ending.eq_ignore_ascii_case(e)));
    if !is_file {
        let place = |_| "--loop frames".to_owned();
        let lengths = text.split(',').enumerate().map(|(i, cell)| length(cell).ok_or_else(|| refuse(place(i), cell)));
        return lengths.collect();
    }
    let place = |line: usize| format!("{}:{}", path.display(), line + 1);
    let content = std::fs::read_to_string(path).map_err(|error| {
        Error::plan(path.display().to_string(), format!("cannot be read: {error}; give a file of frame times in s"))
    })?;
    let mut lengths = Vec::new();
    for (line, row) in content.lines().enumerate() {
        let cell = row.split([',', ';', '\t']).next().unwrap_or_default().trim();
        if cell.is_empty() || cell.starts_with('#') {
            continue;
        }
        match length(cell) {
            Some(h) => lengths.push(h),
            // A header.
            None if lengths.is_empty() && cell.parse::<f64>().is_err() => {}
            None => return Err(refuse(place(line), cell)),
        }
        if lengths.len() > MOST {
            return Err(Error::plan(place(line), format!("more than {MOST} frames; give fewer")));
        }
    }
    if lengths.is_empty() {
        return Err(Error::plan(place(0), "holds no frame times; give one length in s a line"));
    }
    Ok(lengths)
}

fn length(cell: &str) -> Option<f64> {
    cell.trim().parse().ok().filter(|h: &f64| h.is_finite() && *h > 0.0)
}

fn refuse(place: String, cell: &str) -> Error {
    Error::plan(place, format!("'{}' is no length of a frame; give seconds above 0, such as 0.016", cell.trim()))
}

/// The lengths of the frames of a run, one after the other.
pub(super) struct Lengths<'a> {
    frames: &'a Frames,
    h_s: f64,
    next: usize,
    random: Generator,
}

impl<'a> Lengths<'a> {
    /// For frames of the length `h_s`, where the loop does not give lengths itself.
    pub(super) fn new(frames: &'a Frames, h_s: f64) -> Self {
        let seed = if let Frames::Jitter { seed, .. } = frames { *seed } else { 0 };
        Lengths { frames, h_s, next: 0, random: Generator::new(seed) }
    }

    /// The next length, s.
    pub(super) fn next(&mut self) -> f64 {
        match self.frames {
            Frames::Uniform => self.h_s,
            Frames::Pattern(lengths) => {
                let h = lengths[self.next];
                self.next = (self.next + 1) % lengths.len();
                h
            }
            Frames::Jitter { part, .. } => self.h_s * (1.0 + part * self.random.between(-1.0, 1.0)),
        }
    }
}

impl Loop {
    /// The mean length of a frame, s, where the uniform one is `h_s`.
    pub fn mean_s(&self, h_s: f64) -> f64 {
        match &self.frames {
            Frames::Uniform | Frames::Jitter { .. } => h_s,
            Frames::Pattern(lengths) => lengths.iter().sum::<f64>() / lengths.len() as f64,
        }
    }
}
