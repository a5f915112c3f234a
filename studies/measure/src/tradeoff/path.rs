//! The exact motion at every step of a long run, from polynomials between exact samples.
//!
//! Each panel of time has the Chebyshev interpolant of degree 15 of every coordinate. Its error is f^(16)(s) T16(x) / (2^15 16!) in
//! a panel of half-width 1, so that it is largest where |T16| = 1: at five of these points, the ends among them, it is measured
//! against the exact motion. A panel is halved until `SAFETY` times the largest meets the target; what does not get there (a
//! bounce) has no polynomial, and the exact motion is evaluated at every step.
//! Source: L. N. Trefethen, Approximation Theory and Approximation Practice (2013), chapters 2 to 4.

use std::f64::consts::PI;

use faer::fx128;
use integrator::Real;
use scenes::any::AnyScene;
use scenes::observation::Value;

use super::quantity::Of;
use crate::sweep::{Progress, in_parallel};

/// Nodes of a panel, one more than the degree.
const NODES: usize = 16;
/// Points cos(k pi / 16) at which the error of a panel is measured.
const CHECKED: [usize; 5] = [0, 5, 8, 11, 16];
/// The sixteenth derivative at the five points may be smaller than elsewhere in the panel by this factor.
const SAFETY: f64 = 8.0;
/// Length of the panels to begin with, in natural time scales at most.
const PANEL: f64 = 4.0;
/// More panels to begin with take longer than they save.
const MOST_PANELS: u64 = 1 << 16;
/// Halvings of a panel.
const HALVINGS: u32 = 8;
/// Errors of rounding, in parts of the largest coordinate, of the sums of sixteen terms: below, a shorter panel is no better.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

/// The exact motion between its samples.
pub struct Path {
    /// Parts into which the time up to the end is divided; panels begin and end at whole ones.
    parts: u64,
    panels: Vec<Panel>,
    /// The largest error of a value from a polynomial.
    pub margin: f64,
}

struct Panel {
    from: u64,
    to: u64,
    /// Coefficients of the Chebyshev polynomials, by coordinate; `None` where no polynomial is near enough.
    coefficients: Option<Vec<[f64; NODES]>>,
    /// `SAFETY` times the largest error measured.
    error: f64,
    /// The same of a panel in which only rounding is left.
    rounding: f64,
}

/// What is interpolated.
struct Sampled<'a> {
    scene: &'a dyn AnyScene,
    of: Of,
    end_s: f64,
    parts: u64,
    target: f64,
}

/// The coordinates of values in a row, and which of them are those of an attitude.
pub struct Coordinates {
    /// Components of vectors, and quaternions (w, x, y, z).
    pub values: Vec<f64>,
    /// Length of each value, and whether it is an attitude.
    pub groups: Vec<(usize, bool)>,
}

impl Path {
    /// The motion up to an end with errors of at most about `target`, or what rounding leaves; `None` where it takes too many
    /// panels or is not finite.
    pub fn new(scene: &dyn AnyScene, of: Of, end_s: f64, target: f64) -> Option<Self> {
        let panels = (end_s / (PANEL * scene.scene().info().time_scale_s)).ceil();
        if !(panels <= MOST_PANELS as f64) {
            return None;
        }
        let (first, length) = ((panels as u64).next_power_of_two(), 1 << HALVINGS);
        let sampled = Sampled { scene, of, end_s, parts: first * length, target };
        let tops: Vec<u64> = (0..first).map(|i| i * length).collect();
        let divided = |&from: &u64| sampled.divide(from, from + length);
        let panels: Vec<Panel> =
            in_parallel(&tops, |_| 1, &Progress::silent(), divided).into_iter().flatten().collect();
        let margin = panels.iter().filter(|p| p.coefficients.is_some()).map(|p| p.error).fold(0.0, f64::max);
        Some(Path { parts: sampled.parts, panels, margin })
    }

    /// The coordinates at a step, in the order of [`Coordinates`]; `None` where no polynomial is near enough. `cursor` is the
    /// panel of an earlier step.
    pub fn at(&self, step: u64, steps: u64, cursor: &mut usize) -> Option<Vec<f64>> {
        let scaled = u128::from(step) * u128::from(self.parts);
        let ends = |i: usize| u128::from(self.panels[i].to) * u128::from(steps);
        while *cursor + 1 < self.panels.len() && ends(*cursor) < scaled {
            *cursor += 1;
        }
        let Panel { from, to, coefficients, .. } = &self.panels[*cursor];
        let coefficients = coefficients.as_ref()?;
        let offset = (scaled - u128::from(*from) * u128::from(steps)) as f64;
        let x = 2.0 * offset / (u128::from(to - from) * u128::from(steps)) as f64 - 1.0;
        Some(coefficients.iter().map(|c| clenshaw(c, x)).collect())
    }
}

impl Sampled<'_> {
    /// A panel, or its halves where it is not near enough.
    fn divide(&self, from: u64, to: u64) -> Vec<Panel> {
        let panel = self.panel(from, to);
        if panel.error <= self.target.max(panel.rounding) {
            return vec![panel];
        }
        if to - from == 1 {
            return vec![Panel { coefficients: None, ..panel }];
        }
        let middle = from + (to - from) / 2;
        [self.divide(from, middle), self.divide(middle, to)].into_iter().flatten().collect()
    }

    fn panel(&self, from: u64, to: u64) -> Panel {
        let mut samples: Vec<Coordinates> = (0..NODES).map(|k| Coordinates::of(&self.at(from, to, node(k)))).collect();
        for k in 1..NODES {
            let (before, rest) = samples.split_at_mut(k);
            rest[0].align(&before[k - 1]);
        }
        let size = samples[0].values.len();
        let coefficients: Vec<[f64; NODES]> =
            (0..size).map(|i| transform(&std::array::from_fn(|k| samples[k].values[i]))).collect();
        let scale = samples.iter().flat_map(|s| &s.values).fold(0.0_f64, |most, x| most.max(x.abs()));
        let errors = CHECKED.map(|k| {
            let x = (PI * k as f64 / NODES as f64).cos();
            let exact = Coordinates::of(&self.at(from, to, x));
            exact.distance(&coefficients.iter().map(|c| clenshaw(c, x)).collect::<Vec<_>>())
        });
        let worst = errors.iter().fold(0.0_f64, |most, e| if *e > most || e.is_nan() { *e } else { most });
        // Rounding shows at some of the points at least by an epsilon.
        let error = SAFETY * worst.max(f64::EPSILON * scale);
        Panel {
            from,
            to,
            coefficients: error.is_finite().then_some(coefficients),
            error,
            rounding: SAFETY * ROUNDED * scale,
        }
    }

    /// The exact values at a point x of a panel, -1 <= x <= 1.
    fn at(&self, from: u64, to: u64, x: f64) -> Vec<Value> {
        let part = fx128::lit(from as f64) + fx128::lit((to - from) as f64) * fx128::lit(0.5 + 0.5 * x);
        let t = fx128::lit(self.end_s) * part / fx128::lit(self.parts as f64);
        let exact = self.scene.exact(t);
        self.of.values(self.scene, t, &exact).into_iter().map(std::borrow::Cow::into_owned).collect()
    }
}

fn node(k: usize) -> f64 {
    (PI * (k as f64 + 0.5) / NODES as f64).cos()
}

/// Chebyshev coefficients of the interpolant through the values at the nodes: c_j = (2 / N) sum f_k cos(j (k + 1/2) pi / N).
fn transform(values: &[f64; NODES]) -> [f64; NODES] {
    std::array::from_fn(|j| {
        let cosine = |k: usize| (PI * (j as f64 * (k as f64 + 0.5)) / NODES as f64).cos();
        let sum: f64 = values.iter().enumerate().map(|(k, f)| f * cosine(k)).sum();
        sum * if j == 0 { 1.0 } else { 2.0 } / NODES as f64
    })
}

/// sum c_j T_j(x).
fn clenshaw(c: &[f64; NODES], x: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for c in c[1..].iter().rev() {
        (b1, b2) = (2.0 * x * b1 - b2 + c, b1);
    }
    x * b1 - b2 + c[0]
}

impl Coordinates {
    /// Those of values.
    pub fn of(values: &[impl std::borrow::Borrow<Value>]) -> Self {
        let (mut all, mut groups) = (Vec::new(), Vec::new());
        for value in values {
            let before = all.len();
            match value.borrow() {
                Value::Vector(v) => all.extend(v.iter().map(|x| x.0)),
                Value::Rotation(q) => all.extend([q.w.0, q.v.x.0, q.v.y.0, q.v.z.0]),
            }
            groups.push((all.len() - before, matches!(value.borrow(), Value::Rotation(_))));
        }
        Coordinates { values: all, groups }
    }

    /// Turns the sign of every quaternion that points away from its neighbour's: both are the same attitude.
    fn align(&mut self, neighbour: &Self) {
        let mut first = 0;
        for (length, is_attitude) in &self.groups {
            let range = first..first + length;
            let pairs = self.values[range.clone()].iter().zip(&neighbour.values[range.clone()]);
            if *is_attitude && pairs.map(|(a, b)| a * b).sum::<f64>() < 0.0 {
                self.values[range].iter_mut().for_each(|x| *x = -*x);
            }
            first += length;
        }
    }

    /// The largest distance of a value from that with other coordinates: |a - b|, of two attitudes 4 asin(|a -+ b| / 2).
    pub fn distance(&self, other: &[f64]) -> f64 {
        let (mut first, mut largest) = (0, 0.0_f64);
        for (length, is_attitude) in &self.groups {
            let range = first..first + length;
            let (a, b) = (&self.values[range.clone()], &other[range]);
            let apart = |sign: f64| a.iter().zip(b).map(|(x, y)| x - sign * y).fold(0.0, f64::hypot);
            let distance =
                if *is_attitude { 4.0 * (0.5 * apart(1.0).min(apart(-1.0))).min(1.0).asin() } else { apart(1.0) };
            largest = if distance > largest || distance.is_nan() { distance } else { largest };
            first += length;
        }
        largest
    }
}
