//! Lines cut at the frame, in the axes' own mapped coordinates (logarithms on a logarithmic axis).
//!
//! A point moved onto the edge of the frame would bend the slope of the last segment. Here a segment is cut where it
//! leaves the frame (Liang and Barsky, "A new concept and method for line clipping", ACM Transactions on Graphics 3 (1984)
//! 1-22), so that what is left has the slope it had.

/// A point in mapped coordinates.
pub(super) type Point = [f64; 2];

/// The frame in mapped coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    pub(super) low: Point,
    pub(super) high: Point,
}

impl Window {
    pub(super) fn contains(&self, p: Point) -> bool {
        (0..2).all(|i| self.low[i] <= p[i] && p[i] <= self.high[i])
    }
}

/// The part of the segment `a` to `b` inside the window, or `None`. Coordinates must be finite.
pub(super) fn clip_segment(a: Point, b: Point, window: Window) -> Option<[Point; 2]> {
    // A quarter of every length is taken, so that the difference of two huge coordinates stays finite.
    const QUARTER: f64 = 0.25;
    let step = [0, 1].map(|i| QUARTER * b[i] - QUARTER * a[i]);
    // Where along the segment it enters and leaves, and the coordinate that is then on the edge.
    let (mut enter, mut leave) = (Cut::at(0.0), Cut::at(1.0));
    for i in 0..2 {
        let to_low = QUARTER * window.low[i] - QUARTER * a[i];
        let to_high = QUARTER * window.high[i] - QUARTER * a[i];
        if step[i] == 0.0 {
            if to_low > 0.0 || to_high < 0.0 {
                return None;
            }
            continue;
        }
        let low = Cut { along: to_low / step[i], edge: Some((i, window.low[i])) };
        let high = Cut { along: to_high / step[i], edge: Some((i, window.high[i])) };
        let (first, last) = if step[i] > 0.0 { (low, high) } else { (high, low) };
        enter = if first.along > enter.along { first } else { enter };
        leave = if last.along < leave.along { last } else { leave };
    }
    (enter.along <= leave.along)
        .then(|| [enter.point(a, b, window).unwrap_or(a), leave.point(a, b, window).unwrap_or(b)])
}

/// A place along a segment, 0 to 1, and the edge of the window met there: coordinate and value.
#[derive(Clone, Copy)]
struct Cut {
    along: f64,
    edge: Option<(usize, f64)>,
}

impl Cut {
    fn at(along: f64) -> Self {
        Self { along, edge: None }
    }

    /// The point of the cut, exactly on its edge; `None` where the segment was not cut.
    fn point(self, a: Point, b: Point, window: Window) -> Option<Point> {
        let (axis, value) = self.edge?;
        let between = |i: usize| (a[i] * (1.0 - self.along) + b[i] * self.along).clamp(window.low[i], window.high[i]);
        Some([0, 1].map(|i| if i == axis { value } else { between(i) }))
    }
}

/// The visible parts of a line through `points`; a `None` breaks the line and is not bridged.
pub(super) fn clip_line(points: &[Option<Point>], window: Window) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let mut connected = false;
    for pair in points.windows(2) {
        let [Some(a), Some(b)] = *pair else {
            connected = false;
            continue;
        };
        let Some([start, end]) = clip_segment(a, b, window) else {
            connected = false;
            continue;
        };
        match parts.last_mut() {
            Some(part) if connected && start == a => part.push(end),
            _ => parts.push(vec![start, end]),
        }
        connected = end == b;
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Window = Window { low: [0.0, 0.0], high: [1.0, 1.0] };

    fn slope([a, b]: [Point; 2]) -> f64 {
        (b[1] - a[1]) / (b[0] - a[0])
    }

    #[test]
    fn a_cut_segment_ends_on_the_edge_and_keeps_its_slope() {
        for (a, b) in [([0.25, -2.0], [0.75, 3.0]), ([-3.0, 0.5], [5.0, 1.5]), ([0.5, 0.5], [1.5, 9.0])] {
            let cut = clip_segment(a, b, UNIT).expect("crosses the window");
            // Three roundings of values up to 9, divided by a length of at least 1/16 inside the window.
            let tolerance = 16.0 * 3.0 * 9.0 * f64::EPSILON * slope([a, b]).abs().max(1.0);
            assert!((slope(cut) - slope([a, b])).abs() <= tolerance, "{a:?} {b:?}: {cut:?}");
            assert!(cut.iter().all(|&p| UNIT.contains(p)));
            let on_edge = |p: Point| p.iter().any(|&c| c == 0.0 || c == 1.0);
            assert!(on_edge(cut[1]) && (UNIT.contains(a) || on_edge(cut[0])), "{cut:?}");
        }
    }

    #[test]
    fn a_dyadic_segment_is_cut_exactly() {
        assert_eq!(clip_segment([0.5, 0.5], [1.5, 4.5], UNIT), Some([[0.5, 0.5], [0.625, 1.0]]));
        assert_eq!(clip_segment([-1.0, 0.25], [3.0, 0.25], UNIT), Some([[0.0, 0.25], [1.0, 0.25]]));
    }

    #[test]
    fn what_lies_inside_is_untouched_and_what_lies_outside_is_gone() {
        let inside = [[0.1, 0.2], [0.7, 0.3]];
        assert_eq!(clip_segment(inside[0], inside[1], UNIT), Some(inside));
        assert_eq!(clip_segment([-1.0, 0.5], [0.5, 2.5], UNIT), None);
        assert_eq!(clip_segment([2.0, 0.5], [2.0, 0.7], UNIT), None);
    }

    #[test]
    fn huge_coordinates_do_not_overflow() {
        let cut = clip_segment([0.5, -f64::MAX], [0.5, f64::MAX], UNIT);
        assert_eq!(cut, Some([[0.5, 0.0], [0.5, 1.0]]));
    }

    #[test]
    fn a_missing_point_breaks_the_line() {
        let points = [Some([0.0, 0.0]), Some([0.25, 0.25]), None, Some([0.5, 0.5]), Some([1.0, 1.0])];
        assert_eq!(clip_line(&points, UNIT), [[[0.0, 0.0], [0.25, 0.25]], [[0.5, 0.5], [1.0, 1.0]]]);
    }

    #[test]
    fn a_line_that_leaves_and_returns_is_two_lines() {
        let points = [[0.0, 0.5], [0.25, 0.5], [0.5, 1.5], [0.75, 0.5], [1.0, 0.5]].map(Some);
        let parts = clip_line(&points, UNIT);
        assert_eq!(parts, [[[0.0, 0.5], [0.25, 0.5], [0.375, 1.0]], [[0.625, 1.0], [0.75, 0.5], [1.0, 0.5]]]);
    }
}
