//! What names leave open, the numbers decide: of all readings the one that satisfies q' = q omega / 2 (and x' = v) better
//! than the next by a factor of ten.

use integrator::Rotation;
use nalgebra::Vector3;

use super::attitude::{self, Reading};
use super::roles::Group;
use crate::read::Table;

/// The frame in which an angular velocity is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OmegaFrame {
    /// World components.
    World,
    /// Body components.
    Body,
}

/// How well one reading explains the turning of the attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scored {
    pub(crate) reading: Reading,
    pub(crate) frame: OmegaFrame,
    /// Factor to rad/s.
    pub(crate) omega_scale: f64,
    /// Largest part of the turning that is not explained, relative to the turning.
    pub(crate) misfit: f64,
    /// The same with omega multiplied by the factor that explains most.
    pub(crate) free_misfit: f64,
    /// That factor.
    pub(crate) factor: f64,
    /// Mean square of the turning of a step, rad^2.
    pub(crate) turning: f64,
    /// How far the readings in world and in body components differ in this file.
    pub(crate) frames_differ: f64,
}

/// The factor by which a reading must be better than the next one.
pub(crate) const CLEARLY: f64 = 10.0;

/// Pairs of rows from which readings are judged.
const PAIRS: usize = 256;

/// The rotation vector of q, |angle| <= pi.
pub(crate) fn log(q: Rotation<f64>) -> Vector3<f64> {
    let (w, v) = if q.w < 0.0 { (-q.w, -q.v) } else { (q.w, q.v) };
    let sine = v.norm();
    if sine < 1e-150 { v * 2.0 } else { v * (2.0 * sine.atan2(w) / sine) }
}

pub(crate) fn rotation(q: [f64; 4]) -> Rotation<f64> {
    Rotation::from_wxyz(q)
}

/// All readings of an attitude and an angular velocity, the best first.
pub(crate) fn score(table: &Table, time: &[f64], att: &Group, omega: &Group) -> Vec<Scored> {
    let rows = time.len();
    let stride = ((rows - 1) / PAIRS).max(1);
    let pairs: Vec<usize> = (0..rows - 1).step_by(stride).collect();
    let largest = att.columns.iter().flat_map(|i| &table.columns[*i].values).fold(0.0_f64, |m, x| m.max(x.abs()));
    let degree = std::f64::consts::PI / 180.0;
    let omega_scales = omega.unit.as_ref().map_or_else(|| vec![1.0, degree], |(factor, _)| vec![*factor]);
    let (mut a, mut b) = (Vec::new(), Vec::new());
    let mut all = Vec::new();
    for reading in attitude::readings(att, largest) {
        let steps: Vec<Pair> = pairs
            .iter()
            .map(|&i| {
                attitude::row(table, att, i, &mut a);
                attitude::row(table, att, i + 1, &mut b);
                let (q0, q1) = (rotation(reading.quaternion(&a)), rotation(reading.quaternion(&b)));
                let w = |row: usize| Vector3::from_fn(|k, _| table.columns[omega.columns[k]].values[row]);
                Pair { q0, q1, w0: w(i), w1: w(i + 1), h: time[i + 1] - time[i] }
            })
            .filter(|p| p.h > 0.0)
            .collect();
        for &omega_scale in &omega_scales {
            let world = residuals(&steps, OmegaFrame::World, omega_scale);
            let body = residuals(&steps, OmegaFrame::Body, omega_scale);
            let frames_differ = steps
                .iter()
                .map(|p| (p.q0.rotate(p.w0) - p.w0).norm() / p.w0.norm().max(f64::MIN_POSITIVE))
                .fold(0.0, f64::max);
            for (frame, r) in [(OmegaFrame::World, world), (OmegaFrame::Body, body)] {
                let [misfit, free_misfit, factor, turning] = r;
                all.push(Scored { reading, frame, omega_scale, misfit, free_misfit, factor, turning, frames_differ });
            }
        }
    }
    all.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    all
}

struct Pair {
    q0: Rotation<f64>,
    q1: Rotation<f64>,
    w0: Vector3<f64>,
    w1: Vector3<f64>,
    h: f64,
}

/// How the attitude turned, and how the angular velocity says it did.
type Turned = (Vector3<f64>, Vector3<f64>);

/// rms of the turning in a step less that by the mean angular velocity (with the first commutator of Magnus' series, which
/// leaves an error of h^3), relative to the rms of the larger of the two; the same after the best factor; the factor.
fn residuals(steps: &[Pair], frame: OmegaFrame, scale: f64) -> [f64; 4] {
    let mut vectors = Vec::with_capacity(steps.len());
    for p in steps {
        let (turned, sign) = match frame {
            OmegaFrame::World => (log(p.q1 * p.q0.conjugate()), -1.0),
            OmegaFrame::Body => (log(p.q0.conjugate() * p.q1), 1.0),
        };
        let (w0, w1) = (p.w0 * scale, p.w1 * scale);
        let told = (w0 + w1) * (p.h / 2.0) + w0.cross(&w1) * (sign * p.h * p.h / 12.0);
        // A turn of more than half a circle cannot be told from its complement.
        if told.norm() < 3.0 {
            vectors.push((turned, told));
        }
    }
    if vectors.len() * 2 < steps.len() {
        return [f64::INFINITY, f64::INFINITY, 1.0, 1.0];
    }
    let sum = |f: &dyn Fn(&Turned) -> f64| vectors.iter().map(f).sum::<f64>();
    let (turned, told) = (sum(&|(a, _)| a.norm_squared()), sum(&|(_, b)| b.norm_squared()));
    let size = turned.max(told).max(f64::MIN_POSITIVE);
    let missed = sum(&|(a, b)| (a - b).norm_squared());
    let factor = if told > 0.0 { sum(&|(a, b)| a.dot(b)) / told } else { 1.0 };
    let freely = sum(&|(a, b)| (a - b * factor).norm_squared());
    [(missed / size).sqrt(), (freely / turned.max(f64::MIN_POSITIVE)).sqrt(), factor, size / vectors.len() as f64]
}
