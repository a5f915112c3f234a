//! Which step computed a file: one step (or as many as lie between two rows) of every candidate from every row, its largest
//! difference from the next row against the resolution of the file.

mod angle;
mod candidate;
mod damping;
mod dampings;
mod own;
pub(crate) mod reference;
mod rotation;
mod search;
mod translation;

use nalgebra::Vector3;
use serde::Serialize;

use candidate::Kin;
pub use candidate::Moves;
use dampings::{dampings, given};
use search::search;

use crate::clock::Clock;
use crate::physics::{Force, Moment, Physics, acceleration};
use crate::subject::Ball;
use crate::trajectory::{Rounding, Trajectory};

/// What is known of the step of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StepVerdict {
    /// One candidate fits, the next other is a hundred times worse.
    Identified,
    /// Several fit.
    OneOf,
    /// None fits.
    NoneOf,
    /// The file is the exact motion.
    Exact,
}

/// A candidate and how far it is from the file.
#[derive(Clone, Debug, Serialize)]
pub struct Tried {
    /// Its parts in words.
    pub id: String,
    /// The step, s.
    pub h_s: f64,
    /// Steps between two rows.
    pub steps_per_row: u64,
    /// Largest difference from a row, in resolutions of the file.
    pub largest_difference: f64,
    /// Rows that it reproduces.
    pub rows: usize,
    /// Whether it was run from the first row on instead of from every row.
    pub free_run: bool,
    /// The coefficient of its damping, 1/s.
    pub damping: Option<f64>,
    /// Other names of the same step: candidates that agree with it from any state.
    pub same_as: Vec<String>,
    #[serde(skip)]
    fitted: bool,
    #[serde(skip)]
    signature: Vec<f64>,
    #[serde(skip)]
    rank: (u32, bool, usize),
}

/// The step of one part of the motion.
#[derive(Clone, Debug, Serialize)]
pub struct Identified {
    /// The part.
    pub moves: Moves,
    /// What is known.
    pub verdict: StepVerdict,
    /// The candidates that fit, or the nearest; best first.
    pub candidates: Vec<Tried>,
    /// Candidates that were tried, with every number of steps in a row.
    pub tried: usize,
    /// Half a unit in the last place of the file: rad or m.
    pub resolution: f64,
    /// Rows that were compared.
    pub rows: usize,
    /// Whether the pose is written one step after its rate.
    pub pose_late: bool,
}

/// Rounding that a step may add, in resolutions: an engine's sixteen operations, and as many steps as lie between two rows.
fn allowed(steps: u64, rounding: Rounding) -> f64 {
    match rounding {
        Rounding::Double => 24.0 + 16.0 * steps as f64,
        // Single precision leaves less room between candidates: rounding is taken to grow as a random walk.
        Rounding::Single => 20.0 + 12.0 * (steps as f64).sqrt(),
        // The rows themselves are rounded; the start's rounding is carried along.
        _ => 6.0,
    }
}

struct File<'a> {
    t: &'a Trajectory,
    clock: &'a Clock,
    moves: Moves,
    ball: Option<Ball>,
}

impl File<'_> {
    fn kin(&self, row: usize) -> Kin {
        let t = self.t;
        let pick = |v: &Option<crate::trajectory::Vectors>| v.as_ref().map_or(Vector3::zeros(), |v| v.values[row]);
        Kin {
            x: pick(&t.position),
            v: pick(&t.velocity),
            q: t.attitude.as_ref().map_or([1.0, 0.0, 0.0, 0.0], |a| a.raw[row]),
            w: pick(&t.omega),
            angle: [
                t.angle.as_ref().map_or(0.0, |a| a.values[row]),
                t.angle_rate.as_ref().map_or(0.0, |a| a.values[row]),
            ],
        }
    }

    /// The difference of a state from a row, in resolutions.
    fn difference(&self, kin: &Kin, row: usize) -> f64 {
        let t = self.t;
        let own = self.kin(row);
        let unit = |r: f64| r.max(f64::MIN_POSITIVE);
        let of =
            |v: &Option<crate::trajectory::Vectors>| v.as_ref().map_or(f64::INFINITY, |v| unit(v.resolution.absolute));
        let d = match self.moves {
            Moves::Translation => {
                ((kin.x - own.x).norm() / of(&t.position)).max((kin.v - own.v).norm() / of(&t.velocity))
            }
            Moves::Rotation => {
                let res = t.attitude.as_ref().map_or(1.0, |a| unit(a.resolution.absolute));
                let size =
                    |sign: f64| 2.0 * kin.q.iter().zip(&own.q).map(|(a, b)| (a - sign * b).powi(2)).sum::<f64>().sqrt();
                (size(1.0).min(size(-1.0)) / res).max((kin.w - own.w).norm() / of(&t.omega))
            }
            Moves::Angle => {
                let of = |s: &Option<crate::trajectory::Scalars>| {
                    s.as_ref().map_or(f64::INFINITY, |s| unit(s.resolution.absolute))
                };
                ((kin.angle[0] - own.angle[0]).abs() / of(&t.angle))
                    .max((kin.angle[1] - own.angle[1]).abs() / of(&t.angle_rate))
            }
        };
        if d.is_finite() { d } else { f64::MAX }
    }

    /// Pairs of rows that follow the law: no gap of the clock between them, and no contact.
    fn rows_of(&self, force: Option<Force>) -> Vec<usize> {
        let regular = (0..self.t.rows() - 1).filter(|i| self.clock.is_regular(*i));
        let (Some(Force::Constant(g)), Some(v)) = (force, &self.t.velocity) else { return regular.collect() };
        let h = self.clock.interval;
        let falls = |i: &usize| ((v.values[i + 1] - v.values[*i]) / h - g).norm() < 0.5 * g.norm();
        let flies = |i: &usize| self.ball.is_none_or(|ball| ball.flies(self.t, g, *i, h));
        regular.filter(falls).filter(flies).collect()
    }
}

/// The steps of all parts of the motion of which the law is known.
pub fn identify(
    t: &Trajectory,
    clock: &Clock,
    physics: &Physics,
    ball: Option<Ball>,
    record_every: Option<u64>,
) -> Vec<Identified> {
    let mut out = Vec::new();
    let single = t.rounding != Rounding::Double;
    if let (Some(force), Some(_), Some(v)) = (physics.force, &t.position, &t.velocity) {
        let file = File { t, clock, moves: Moves::Translation, ball };
        if force == Force::None && !slows(&v.values) {
            return rotation_and_angle(t, clock, physics, record_every);
        }
        let x = &t.position.as_ref().map_or(&v.values, |x| &x.values);
        let pull = |i: usize| {
            let middle = (x[i] + x[i + 1]) / 2.0;
            acceleration(force, middle) * (t.time[i + 1] - t.time[i])
        };
        let damping = dampings(t, clock, &v.values, physics.linear_damping, record_every, &pull);
        out.extend(search(&file, &translation::candidates(force, &damping, single), Some(force), record_every));
    }
    out.extend(rotation_and_angle(t, clock, physics, record_every));
    out
}

/// Whether a velocity changes at all: without a force there is nothing to tell steps apart by.
fn slows(v: &[Vector3<f64>]) -> bool {
    let change = v.iter().map(|x| (x - v[0]).norm()).fold(0.0, f64::max);
    change > 1e-6 * v[0].norm()
}

fn rotation_and_angle(t: &Trajectory, clock: &Clock, physics: &Physics, record_every: Option<u64>) -> Vec<Identified> {
    let mut out = Vec::new();
    let single = t.rounding != Rounding::Double;
    if let (Some(inertia), Some(moment), Some(_), Some(w)) = (physics.inertia, physics.moment, &t.attitude, &t.omega) {
        let file = File { t, clock, moves: Moves::Rotation, ball: None };
        let damping = if moment == Moment::None {
            dampings(t, clock, &w.values, physics.angular_damping, record_every, &|_| Vector3::zeros())
        } else {
            given(physics.angular_damping)
        };
        out.extend(search(
            &file,
            &rotation::candidates(inertia, moment, &damping, t.omega_frame, single),
            None,
            record_every,
        ));
    }
    if let (Some(square), Some(_), Some(_)) = (physics.pendulum, &t.angle, &t.angle_rate) {
        let file = File { t, clock, moves: Moves::Angle, ball: None };
        out.extend(search(&file, &angle::candidates(square, single), None, record_every));
    }
    out
}

/// Steps in a row that are tried.
fn steps_per_row(record_every: Option<u64>) -> Vec<u64> {
    record_every.map_or_else(|| vec![1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 64], |k| vec![k])
}
