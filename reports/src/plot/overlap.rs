//! What lies on what: lines and marks that coincide, so that the upper ones can be drawn to leave the lower ones visible.

use super::frame::along;
use super::sheet::Pixel;
use std::collections::HashMap;

/// The places that series pass, in squares of one CSS pixel. Series beyond 64 are not told apart.
#[derive(Default)]
pub(super) struct Tracks(HashMap<(i64, i64), u64>);

impl Tracks {
    pub(super) fn add(&mut self, series: usize, places: impl IntoIterator<Item = Pixel>) {
        for at in places {
            *self.0.entry(square(at)).or_default() |= bit(series);
        }
    }

    /// The series that pass within a pixel or two, as bits.
    fn near(&self, at: Pixel) -> u64 {
        let (x, y) = square(at);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (x + i, y + j)));
        around.filter_map(|at| self.0.get(&at)).fold(0, |all, series| all | series)
    }

    /// How many series before this one pass all along a line.
    pub(super) fn under(&self, series: usize, line: &[Pixel]) -> usize {
        let before = bit(series).wrapping_sub(1);
        along(line, 1.0).fold(before, |all, at| all & self.near(at)).count_ones() as usize
    }

    /// How many series after this one pass a place.
    pub(super) fn over(&self, series: usize, at: Pixel) -> usize {
        let after = !(bit(series) | bit(series).wrapping_sub(1));
        (self.near(at) & after).count_ones() as usize
    }
}

fn bit(series: usize) -> u64 {
    1 << series.min(63)
}

fn square((x, y): Pixel) -> (i64, i64) {
    (x.floor() as i64, y.floor() as i64)
}

/// A line in parts, each with the number of earlier series that it covers; a cover shorter than a dash or two is none.
pub(super) fn parts(tracks: &Tracks, series: usize, line: &[Pixel]) -> Vec<(usize, Vec<Pixel>)> {
    let mut parts: Vec<(usize, Vec<Pixel>)> = Vec::new();
    for pair in line.windows(2) {
        let under = tracks.under(series, pair);
        match parts.last_mut() {
            Some((known, part)) if *known == under => part.push(pair[1]),
            _ => parts.push((under, pair.to_vec())),
        }
    }
    let mut joined: Vec<(usize, Vec<Pixel>)> = Vec::new();
    for (under, part) in parts {
        let under = if length(&part) < 14.0 { 0 } else { under };
        match joined.last_mut() {
            Some((known, line)) if *known == under => line.extend(&part[1..]),
            _ => joined.push((under, part)),
        }
    }
    joined
}

fn length(line: &[Pixel]) -> f64 {
    line.windows(2).map(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tracks(lines: &[&[Pixel]]) -> Tracks {
        let mut tracks = Tracks::default();
        lines.iter().enumerate().for_each(|(i, line)| tracks.add(i, along(line, 1.0)));
        tracks
    }

    #[test]
    fn a_line_is_told_apart_where_it_lies_on_earlier_ones_and_only_there() {
        let line = [(0.0, 0.0), (100.0, 50.0), (200.0, 50.0)];
        let bent = [(0.0, 0.5), (100.0, 50.0), (200.0, 150.0)];
        let tracks = tracks(&[&line, &bent, &line]);
        let of = |series, line: &[Pixel]| parts(&tracks, series, line).iter().map(|(n, _)| *n).collect::<Vec<_>>();
        assert_eq!((of(0, &line), of(1, &bent), of(2, &line)), (vec![0], vec![1, 0], vec![2, 1]));
    }

    #[test]
    fn lines_that_cross_or_run_side_by_side_cover_nothing() {
        let (level, upright) = ([(0.0, 50.0), (100.0, 50.0)], [(50.0, 0.0), (50.0, 49.0), (50.0, 51.0), (50.0, 100.0)]);
        let tracks = tracks(&[&level, &upright]);
        assert_eq!(parts(&tracks, 1, &upright), [(0, upright.to_vec())]);
        assert_eq!(parts(&tracks, 1, &[(0.0, 54.0), (100.0, 54.0)]).len(), 1);
        assert_eq!(
            (tracks.over(0, (50.5, 50.0)), tracks.over(1, (50.5, 50.0)), tracks.over(0, (20.0, 50.0))),
            (1, 0, 0)
        );
    }
}
