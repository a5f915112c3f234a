//! An axis ready to draw: its ends in mapped coordinates and its ticks.

use super::ticks::{Tick, ticks};
use crate::{Axis, Scale};
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged};
use std::ops::Range;

/// An axis in mapped coordinates: the value itself, or its decimal logarithm.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AxisMap {
    pub(super) scale: Scale,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) major: Vec<Tick>,
    pub(super) minor: Vec<f64>,
}

impl AxisMap {
    /// The ends asked for, or those of `values` with some room; `edges` (of maps) are kept without room.
    /// Also says whether there was anything to show. A range that cannot be is refused with the reason.
    pub(super) fn new(axis: &Axis, values: &[f64], edges: &[f64]) -> Result<(Self, bool), String> {
        let mapped = |list: &[f64]| list.iter().filter_map(|&v| map(axis.scale, v)).collect::<Vec<_>>();
        let (values, edges) = (mapped(values), mapped(edges));
        let any = !(values.is_empty() && edges.is_empty());
        let [low, high] = match axis.range {
            Some(range) => asked(axis.scale, range)?,
            None => automatic(axis.scale, &values, &edges),
        };
        let [low, high] = apart([low, high]);
        Ok((Self { scale: axis.scale, low, high, major: Vec::new(), minor: Vec::new() }, any))
    }

    /// The same axis with ticks, at most about `most` of them labelled.
    pub(super) fn with_ticks(self, most: usize) -> Self {
        let (major, minor) = ticks(self.scale, self.low, self.high, most);
        Self { major, minor, ..self }
    }

    /// The mapped coordinate of a value, or `None` if it has none.
    pub(super) fn map_value(&self, value: f64) -> Option<f64> {
        map(self.scale, value)
    }

    /// Where a mapped coordinate lies between the ends: 0 to 1 inside, at most one length of the axis outside.
    pub(super) fn fraction(&self, mapped: f64) -> f64 {
        ((mapped - self.low) / (self.high - self.low)).clamp(-1.0, 2.0)
    }

    /// The place of a mapped coordinate on an axis that is drawn from `start` to `end`.
    pub(super) fn place(&self, mapped: f64, [start, end]: [f64; 2]) -> f64 {
        start + self.fraction(mapped) * (end - start)
    }
}

/// An axis of a coordinate system of plotters. Its bold points are the labelled ticks, its light ones those between.
impl Ranged for AxisMap {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, mapped: &f64, (start, end): (i32, i32)) -> i32 {
        self.place(*mapped, [start.into(), end.into()]).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() {
            self.minor.clone()
        } else {
            self.major.iter().map(|tick| tick.at).collect()
        }
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

/// The coordinate of a value on an axis, or `None` for what cannot be shown: NaN, infinite, not positive on a log axis.
fn map(scale: Scale, value: f64) -> Option<f64> {
    let mapped = match scale {
        Scale::Linear => value,
        Scale::Log => value.log10(),
    };
    mapped.is_finite().then_some(mapped)
}

fn asked(scale: Scale, [low, high]: [f64; 2]) -> Result<[f64; 2], String> {
    match (map(scale, low), map(scale, high)) {
        (Some(a), Some(b)) if a < b => Ok([a, b]),
        _ => Err(format!("range {low:e} to {high:e}: expected two finite values in ascending order, positive if log")),
    }
}

fn ends(values: &[f64]) -> Option<[f64; 2]> {
    let least = values.iter().copied().reduce(f64::min)?;
    Some([least, values.iter().copied().fold(least, f64::max)])
}

fn automatic(scale: Scale, values: &[f64], edges: &[f64]) -> [f64; 2] {
    let padded = ends(values).map(|ends| match scale {
        Scale::Linear => pad_linear(ends),
        Scale::Log => pad_log(ends),
    });
    match (padded, ends(edges)) {
        (_, Some(edges)) => edges,
        (Some(padded), None) => padded,
        (None, None) => [0.0, 1.0],
    }
}

/// One part in twenty on either side, except that an axis that starts or ends at zero does so on the frame.
fn pad_linear([low, high]: [f64; 2]) -> [f64; 2] {
    let room = if low == high { (0.1 * low.abs()).max(1e-3) } else { 0.05 * (high - low).min(f64::MAX / 8.0) };
    let low_end = if low == 0.0 && high > 0.0 { 0.0 } else { low - room };
    let high_end = if high == 0.0 && low < 0.0 { 0.0 } else { high + room };
    [low_end, high_end]
}

/// Whole decades where the data span some, with room so that no point sits on the frame.
fn pad_log([low, high]: [f64; 2]) -> [f64; 2] {
    let room = (0.04 * (high - low)).max(0.05);
    let (a, b) = (low - room, high + room);
    if high - low < 2.5 {
        return [a, b];
    }
    let snap = |end: f64, whole: f64| if (end - whole).abs() < 0.12 * (high - low) { whole } else { end };
    [snap(a, a.floor()), snap(b, b.ceil())]
}

/// Ends that differ enough to be told apart, and little enough for their difference to be finite.
fn apart([low, high]: [f64; 2]) -> [f64; 2] {
    let [low, high] = [low, high].map(|end| end.clamp(-f64::MAX / 8.0, f64::MAX / 8.0));
    let least = (1e-12 * low.abs().max(high.abs())).max(1e-290);
    if high - low >= least { [low, high] } else { [low - least, high + least] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_place_on_an_axis_is_left_out() {
        let values = [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e-20, 1.0];
        let (log, any) = AxisMap::new(&Axis::log("y"), &values, &[]).expect("an automatic range");
        assert!(any && log.low < -20.0 && log.low > -23.0 && log.high > 0.0 && log.high < 3.0, "{log:?}");
        assert_eq!(values.map(|v| log.map_value(v)), [None, None, None, None, Some(-20.0), Some(0.0)]);
        let (linear, _) = AxisMap::new(&Axis::linear("y"), &values, &[]).expect("an automatic range");
        assert_eq!((linear.low, linear.high), (-1.1, 1.1));
    }

    #[test]
    fn every_range_is_finite_and_not_empty() {
        let cases: [&[f64]; 8] = [
            &[],
            &[0.0],
            &[3.0, 3.0],
            &[-f64::MAX, f64::MAX],
            &[f64::MAX],
            &[5e-324, 1e-323],
            &[1.0, 1.0 + f64::EPSILON],
            &[f64::NAN],
        ];
        for values in cases {
            for axis in [Axis::linear("x"), Axis::log("x")] {
                let (map, _) = AxisMap::new(&axis, values, &[]).expect("an automatic range");
                let span = map.high - map.low;
                assert!(span.is_finite() && span > 0.0, "{values:?} on {axis:?}: {} to {}", map.low, map.high);
                let ticked = map.with_ticks(8);
                assert!(ticked.major.len() < 30, "{values:?} on {axis:?}: {}", ticked.major.len());
            }
        }
    }

    #[test]
    fn a_range_that_cannot_be_is_refused() {
        for range in [[1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0], [0.0, f64::INFINITY]] {
            let axis = Axis::linear("x").with_range(range[0], range[1]);
            assert!(AxisMap::new(&axis, &[1.0], &[]).is_err(), "{range:?}");
        }
        assert!(AxisMap::new(&Axis::log("x").with_range(0.0, 1.0), &[1.0], &[]).is_err());
        let (kept, _) = AxisMap::new(&Axis::log("x").with_range(1e-4, 1.0), &[50.0], &[]).expect("a proper range");
        assert_eq!((kept.low, kept.high), (-4.0, 0.0));
    }
}
