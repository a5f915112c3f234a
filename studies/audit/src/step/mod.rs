//! Which step computed a file: one step (or as many as lie between two rows) of every candidate from every row, its largest
//! difference from the next row against the resolution of the file.

mod angle;
mod candidate;
mod damping;
mod own;
mod rotation;
mod translation;

use nalgebra::Vector3;
use serde::Serialize;

pub use candidate::Moves;
use candidate::{Candidate, Kin, Precision};
use integrator::Rotation;
use damping::{Damping, Rule, When};

use crate::checks::time::Clock;
use crate::finding::quantile;
use crate::physics::{Force, Moment, Physics};
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
    /// Other names of the same step: candidates that agree with it from any state.
    pub same_as: Vec<String>,
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
}

/// Rows whose differences are allowed to be of another cause: contacts, clamps.
const SHARE: f64 = 0.9;
/// Rows from which every candidate is first tried.
const FIRST: usize = 4;
/// Rows that are compared, at most.
const ROWS: usize = 600;
/// Candidates that are compared in all rows.
const FINALISTS: usize = 40;
/// How much worse the next candidate must be.
const WORSE: f64 = 100.0;

/// Rounding that a step may add, in resolutions: an engine's sixteen operations, and as many steps as lie between two rows.
fn allowed(steps: u64, rounding: Rounding) -> f64 {
    match rounding {
        Rounding::Double | Rounding::Single => 24.0 * (steps as f64).sqrt().max(1.0),
        // The rows themselves are rounded; the start's rounding is carried along.
        _ => 6.0,
    }
}

struct File<'a> {
    t: &'a Trajectory,
    clock: &'a Clock,
    moves: Moves,
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
        let of = |v: &Option<crate::trajectory::Vectors>| v.as_ref().map_or(f64::INFINITY, |v| unit(v.resolution.absolute));
        let d = match self.moves {
            Moves::Translation => ((kin.x - own.x).norm() / of(&t.position)).max((kin.v - own.v).norm() / of(&t.velocity)),
            Moves::Rotation => {
                let res = t.attitude.as_ref().map_or(1.0, |a| unit(a.resolution.absolute));
                let size = |sign: f64| {
                    2.0 * kin.q.iter().zip(&own.q).map(|(a, b)| (a - sign * b).powi(2)).sum::<f64>().sqrt()
                };
                (size(1.0).min(size(-1.0)) / res).max((kin.w - own.w).norm() / of(&t.omega))
            }
            Moves::Angle => {
                let of = |s: &Option<crate::trajectory::Scalars>| s.as_ref().map_or(f64::INFINITY, |s| unit(s.resolution.absolute));
                ((kin.angle[0] - own.angle[0]).abs() / of(&t.angle)).max((kin.angle[1] - own.angle[1]).abs() / of(&t.angle_rate))
            }
        };
        if d.is_finite() { d } else { f64::MAX }
    }

    fn regular_rows(&self) -> Vec<usize> {
        (0..self.t.rows() - 1).filter(|i| self.clock.is_regular(*i)).collect()
    }
}

/// The steps of all parts of the motion of which the law is known.
pub fn identify(t: &Trajectory, clock: &Clock, physics: &Physics, record_every: Option<u64>) -> Vec<Identified> {
    let mut out = Vec::new();
    if let (Some(force), Some(_), Some(v)) = (physics.force, &t.position, &t.velocity) {
        let file = File { t, clock, moves: Moves::Translation };
        if force == Force::None && !slows(&v.values) {
            return rotation_and_angle(t, clock, physics, record_every);
        }
        let damping = if force == Force::None {
            dampings(t, clock, &v.values, physics.linear_damping, record_every)
        } else {
            given(physics.linear_damping)
        };
        out.extend(search(&file, &translation::candidates(force, &damping), record_every));
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
    if let (Some(inertia), Some(moment), Some(_), Some(w)) = (physics.inertia, physics.moment, &t.attitude, &t.omega) {
        let file = File { t, clock, moves: Moves::Rotation };
        let damping = if moment == Moment::None {
            dampings(t, clock, &w.values, physics.angular_damping, record_every)
        } else {
            given(physics.angular_damping)
        };
        out.extend(search(&file, &rotation::candidates(inertia, moment, &damping, t.omega_frame), record_every));
    }
    if let (Some(square), Some(_), Some(_)) = (physics.pendulum, &t.angle, &t.angle_rate) {
        let file = File { t, clock, moves: Moves::Angle };
        out.extend(search(&file, &angle::candidates(square), record_every));
    }
    out
}

/// Steps in a row that are tried.
fn steps_per_row(record_every: Option<u64>) -> Vec<u64> {
    record_every.map_or_else(|| vec![1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 64], |k| vec![k])
}

/// No damping, and every rule with the coefficient that is given.
fn given(c: Option<f64>) -> Vec<Option<Damping>> {
    let Some(c) = c.filter(|c| *c != 0.0) else { return vec![None] };
    let mut out = vec![None];
    for rule in Rule::ALL {
        let whens: &[When] = if rule.is_force() { &[When::Between] } else { &When::ALL };
        out.extend(whens.iter().map(|&when| Some(Damping { rule, when, c })));
    }
    out
}

/// The dampings that the loss of speed in the first rows suggests: each rule with the shortest decimal coefficient near it.
fn dampings(
    t: &Trajectory,
    clock: &Clock,
    rates: &[Vector3<f64>],
    c: Option<f64>,
    record_every: Option<u64>,
) -> Vec<Option<Damping>> {
    if c.is_some() {
        return given(c);
    }
    let ratios: Vec<f64> = (0..t.rows() - 1)
        .filter(|i| clock.is_regular(*i))
        .map(|i| rates[i + 1].norm() / rates[i].norm())
        .filter(|r| r.is_finite())
        .collect();
    let ratio = quantile(&ratios, 0.5);
    let loses = ratios.iter().filter(|r| **r < 1.0).count() * 10 > ratios.len() * 9;
    if !(ratio < 1.0 - 1e-7 && loses) {
        return vec![None];
    }
    let middle = rates.len() / 2;
    let mut out = vec![None];
    for k in steps_per_row(record_every) {
        let h = clock.interval / k as f64;
        let factor = ratio.powf(1.0 / k as f64);
        for rule in Rule::ALL {
            let near = rule.coefficient(factor, h, rates[middle].norm());
            for c in short_decimals(near) {
                let whens: &[When] = if rule.is_force() { &[When::Between] } else { &When::ALL };
                let all = whens.iter().map(|&when| Some(Damping { rule, when, c }));
                let new: Vec<_> = all.filter(|d| !out.contains(d)).collect();
                out.extend(new);
            }
        }
    }
    out
}

/// Decimals of one to three digits within two parts in a hundred.
fn short_decimals(x: f64) -> Vec<f64> {
    let mut out = Vec::new();
    for digits in 1..=3 {
        let place = digits - 1 - x.abs().log10().floor() as i32;
        let scale = 10.0_f64.powi(place.abs());
        let short = if place >= 0 { (x * scale).round() / scale } else { (x / scale).round() * scale };
        if (short / x - 1.0).abs() < 0.02 && !out.contains(&short) {
            out.push(short);
        }
    }
    out
}

fn search(file: &File<'_>, candidates: &[Candidate], record_every: Option<u64>) -> Option<Identified> {
    let rows = file.regular_rows();
    if rows.len() < 2 || !moves(file, &rows) {
        return None;
    }
    let first: Vec<usize> = (0..FIRST.min(rows.len())).map(|i| rows[i * (rows.len() - 1) / FIRST.max(1)]).collect();
    let ks = steps_per_row(record_every);
    let mut pool: Vec<(f64, usize, u64)> = Vec::new();
    for (c, candidate) in candidates.iter().enumerate() {
        for &k in &ks {
            let scores = if candidate.memory { free_run(file, candidate, k, FIRST * 2) } else { from_rows(file, candidate, k, &first) };
            let score = quantile(&scores, 0.67) / allowed(k, file.t.rounding);
            pool.push((score, c, k));
        }
    }
    pool.sort_by(|a, b| a.0.total_cmp(&b.0));
    let compared: Vec<usize> = rows.iter().copied().step_by((rows.len() / ROWS).max(1)).collect();
    let mut tried: Vec<Tried> = Vec::new();
    for &(_, c, k) in pool.iter().take(FINALISTS) {
        let candidate = &candidates[c];
        let scores = if candidate.memory { free_run(file, candidate, k, 200) } else { from_rows(file, candidate, k, &compared) };
        let limit = allowed(k, file.t.rounding);
        tried.push(Tried {
            id: candidate.id.clone(),
            h_s: file.clock.interval / k as f64,
            steps_per_row: k,
            largest_difference: quantile(&scores, SHARE) / if candidate.memory { growth(&scores, k) } else { 1.0 },
            rows: scores.iter().filter(|s| **s <= limit).count(),
            free_run: candidate.memory,
            same_as: Vec::new(),
            signature: signature(candidate, file, k),
            rank: (candidate.substeps, !candidate.id.starts_with("semi-implicit"), c),
        });
    }
    tried.sort_by(|a, b| a.largest_difference.total_cmp(&b.largest_difference));
    Some(verdict(file, tried, pool.len(), compared.len()))
}

/// By how much rounding grows in a free run: with the number of steps.
fn growth(scores: &[f64], k: u64) -> f64 {
    (scores.len() as f64 * k as f64).max(1.0)
}

/// Whether anything moves by more than the resolution.
fn moves(file: &File<'_>, rows: &[usize]) -> bool {
    rows.iter().take(64).any(|&i| file.difference(&file.kin(i), i + 1) > 64.0)
}

fn from_rows(file: &File<'_>, candidate: &Candidate, k: u64, rows: &[usize]) -> Vec<f64> {
    let h = file.clock.interval / k as f64;
    rows.iter()
        .map(|&i| {
            let end = (candidate.run)(&file.kin(i), h, k, 1);
            end.first().map_or(f64::MAX, |end| file.difference(end, i + 1))
        })
        .collect()
}

fn free_run(file: &File<'_>, candidate: &Candidate, k: u64, rows: usize) -> Vec<f64> {
    let h = file.clock.interval / k as f64;
    let rows = rows.min(file.t.rows() - 1);
    let run = (candidate.run)(&file.kin(0), h, k, rows as u64);
    run.iter().enumerate().map(|(i, kin)| file.difference(kin, i + 1)).collect()
}

/// Where a candidate goes from a generic state, in steps as long as those of the file: what tells it from others in general.
fn signature(candidate: &Candidate, file: &File<'_>, k: u64) -> Vec<f64> {
    let own = file.kin(0);
    // Generic directions, and sizes of the file: nothing is parallel to an axis, nothing is at rest.
    let size = |v: &Option<crate::trajectory::Vectors>| {
        v.as_ref().map_or(1.0, |v| v.values.iter().map(|x| x.norm()).fold(0.0, f64::max)).max(1e-3)
    };
    let start = Kin {
        x: Vector3::new(0.61, -0.37, 0.83) * size(&file.t.position),
        v: Vector3::new(-0.43, 0.71, 0.29) * size(&file.t.velocity),
        q: Rotation::from_wxyz([0.77, -0.31, 0.43, 0.37]).wxyz(),
        w: Vector3::new(0.53, 0.67, -0.41) * size(&file.t.omega),
        angle: [own.angle[0] + 0.5, own.angle[1] + 0.3],
    };
    let end = (candidate.run)(&start, file.clock.interval / k as f64, k, 2);
    let Some(end) = end.last() else { return vec![] };
    let sign = end.q[0].signum();
    match file.moves {
        Moves::Translation => end.x.iter().chain(end.v.iter()).copied().collect(),
        Moves::Rotation => end.q.iter().map(|x| x * sign).chain(end.w.iter().copied()).collect(),
        Moves::Angle => end.angle.to_vec(),
    }
}

/// Puts candidates that are the same step together, under the plainest of their names.
fn merged(tried: Vec<Tried>, single: bool) -> Vec<Tried> {
    let tolerance = if single { 1e-4 } else { 1e-10 };
    let mut out: Vec<Tried> = Vec::new();
    for mut t in tried {
        let same = |o: &&mut Tried| {
            let size = o.signature.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            o.signature.iter().zip(&t.signature).all(|(a, b)| (a - b).abs() <= tolerance * size)
        };
        match out.iter_mut().find(same) {
            None => out.push(t),
            Some(o) if t.rank < o.rank => {
                let best = o.largest_difference.min(t.largest_difference);
                std::mem::swap(o, &mut t);
                o.largest_difference = best;
                o.same_as = std::mem::take(&mut t.same_as);
                o.same_as.push(t.id);
            }
            Some(o) => o.same_as.push(t.id),
        }
    }
    out
}

fn verdict(file: &File<'_>, mut tried: Vec<Tried>, pool: usize, rows: usize) -> Identified {
    let resolution = match file.moves {
        Moves::Translation => file.t.position.as_ref().map(|p| p.resolution.absolute),
        Moves::Rotation => file.t.attitude.as_ref().map(|a| a.resolution.absolute),
        Moves::Angle => file.t.angle.as_ref().map(|a| a.resolution.absolute),
    };
    let fits = |c: &Tried| c.largest_difference <= allowed(c.steps_per_row, file.t.rounding);
    let best = tried.first().map_or(f64::MAX, |t| t.largest_difference.max(1.0));
    let verdict = if !tried.first().is_some_and(fits) {
        tried.truncate(3);
        StepVerdict::NoneOf
    } else {
        tried.retain(|t| t.largest_difference < WORSE * best);
        tried = merged(tried, file.t.rounding == Rounding::Single);
        if tried.len() == 1 { StepVerdict::Identified } else { StepVerdict::OneOf }
    };
    Identified { moves: file.moves, verdict, candidates: tried, tried: pool, resolution: resolution.unwrap_or(0.0), rows }
}
