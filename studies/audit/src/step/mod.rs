//! Which step computed a file: one step (or as many as lie between two rows) of every candidate from every row, its largest
//! difference from the next row against the resolution of the file.

mod angle;
mod candidate;
mod damping;
mod own;
pub(crate) mod reference;
mod rotation;
mod translation;

use nalgebra::Vector3;
use serde::Serialize;

pub use candidate::Moves;
use candidate::{Candidate, Kin};
use damping::{Damping, Rule, When};
use integrator::Rotation;

use crate::checks::time::Clock;
use crate::finding::quantile;
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

/// The share of rows that a step must reproduce: the others may be of another cause, a contact or a clamp.
const SHARE: f64 = 0.45;
/// Rows from which every candidate is first tried: half at the beginning, half over the file.
const FIRST: usize = 6;
/// Rows that are compared, at most.
const ROWS: usize = 600;
/// Candidates that are compared in all rows.
const FINALISTS: usize = 40;
/// How much worse the next candidate must be.
const WORSE: f64 = 100.0;
/// The same for a candidate that does not fit.
const WORSE_AND_UNFIT: f64 = 10.0;
/// By how much more rounding may gather in a free run in double precision.
const FREE_RUN: f64 = 100.0;

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

/// No damping, and every rule with the coefficient that is given.
fn given(c: Option<f64>) -> Vec<Option<Damping>> {
    let Some(c) = c.filter(|c| *c != 0.0) else { return vec![None] };
    let mut out = vec![None];
    for rule in Rule::ALL {
        let whens: &[When] = if rule.is_force() { &[When::Between] } else { &When::ALL };
        out.extend(whens.iter().map(|&when| Some(Damping { rule, when, c, steps: None })));
    }
    out
}

/// The dampings that the loss of speed suggests: each rule with the short decimal coefficients near it, and with the one
/// that the first rows give. `pull(i)`: what the force adds to the velocity between two rows.
fn dampings(
    t: &Trajectory,
    clock: &Clock,
    rates: &[Vector3<f64>],
    c: Option<f64>,
    record_every: Option<u64>,
    pull: &dyn Fn(usize) -> Vector3<f64>,
) -> Vec<Option<Damping>> {
    if c.is_some() {
        return given(c);
    }
    let pairs: Vec<usize> = (0..t.rows() - 1).filter(|i| clock.is_regular(*i)).collect();
    let Some((rate, quadratic)) = loss(rates, clock.interval, &pairs, pull) else { return vec![None] };
    let first = pairs[0];
    let exact = rates[first + 1].norm() / rates[first].norm();
    let free = pairs.iter().take(8).all(|i| pull(*i).norm() == 0.0);
    let mut out = vec![None];
    for k in steps_per_row(record_every) {
        let h = clock.interval / k as f64;
        for rule in Rule::ALL {
            let near = match rule {
                Rule::QuadraticForce => quadratic,
                Rule::Power => 1.0 - (-rate).exp(),
                _ => rate,
            };
            let mut all: Vec<(f64, Option<u64>)> = short_decimals(near).into_iter().map(|c| (c, None)).collect();
            if free && rule != Rule::QuadraticForce {
                all.push((rule.coefficient(exact.powf(1.0 / k as f64), h, 0.0), Some(k)));
            }
            for (c, steps) in all {
                let whens: &[When] = if rule.is_force() { &[When::Between] } else { &When::ALL };
                let all = whens.iter().map(|&when| Some(Damping { rule, when, c, steps }));
                let new: Vec<_> = all.filter(|d| !out.contains(d)).collect();
                out.extend(new);
            }
        }
    }
    out
}

/// The rates c of -c v and -c (1 + |v|) v that explain the loss of speed, if there is one: the slope of the change of v that
/// the force does not explain.
fn loss(
    rates: &[Vector3<f64>],
    interval: f64,
    pairs: &[usize],
    pull: &dyn Fn(usize) -> Vector3<f64>,
) -> Option<(f64, f64)> {
    let changes: Vec<[f64; 3]> = pairs
        .iter()
        .map(|&i| {
            let mean = (rates[i] + rates[i + 1]) / 2.0;
            let lost = -(rates[i + 1] - rates[i] - pull(i)) / interval;
            [lost.dot(&mean), mean.norm_squared(), (1.0 + mean.norm()) * mean.norm_squared()]
        })
        .collect();
    let ratio =
        |j: usize| quantile(&changes.iter().map(|c| c[0] / c[j]).filter(|r| r.is_finite()).collect::<Vec<_>>(), 0.5);
    let losing = changes.iter().filter(|c| c[0] > 0.0).count();
    let rate = ratio(1);
    (rate > 1e-5 && losing * 10 > changes.len() * 8).then(|| (rate, ratio(2)))
}

/// Decimals of one to three digits within two parts in a hundred.
fn short_decimals(x: f64) -> Vec<f64> {
    let mut out = Vec::new();
    for digits in 1..=3 {
        let place = digits - 1 - x.abs().log10().floor() as i32;
        let scale = 10.0_f64.powi(place.abs());
        let short = if place >= 0 { (x * scale).round() / scale } else { (x / scale).round() * scale };
        // A coefficient may be stored in single precision by an engine that computes in double.
        for c in [short, f64::from(short as f32)] {
            if (short / x - 1.0).abs() < 0.02 && !out.contains(&c) {
                out.push(c);
            }
        }
    }
    out
}

fn search(
    file: &File<'_>,
    candidates: &[Candidate],
    force: Option<Force>,
    record_every: Option<u64>,
) -> Option<Identified> {
    let rows = file.rows_of(force);
    if rows.len() < 2 || !moves(file, &rows) {
        return None;
    }
    let place = |i: usize| if i < FIRST / 2 { i } else { (i - FIRST / 2 + 1) * (rows.len() - 1) / FIRST };
    let first: Vec<usize> = (0..FIRST.min(rows.len())).map(|i| rows[place(i)]).collect();
    let ks = steps_per_row(record_every);
    let mut pool: Vec<(f64, usize, u64)> = Vec::new();
    for (c, candidate) in candidates.iter().enumerate() {
        for &k in ks.iter().filter(|k| candidate.steps.is_none_or(|only| only == **k)) {
            let scores = if candidate.memory {
                free_run(file, candidate, k, FIRST * 2)
            } else {
                from_rows(file, candidate, k, &first)
            };
            let score = quantile(&scores, 0.4) / allowed(k, file.t.rounding);
            pool.push((score, c, k));
        }
    }
    pool.sort_by(|a, b| a.0.total_cmp(&b.0));
    let compared: Vec<usize> = rows.iter().copied().step_by((rows.len() / ROWS).max(1)).collect();
    let fewest = pool.iter().take(FINALISTS).map(|(_, _, k)| *k).min().unwrap_or(1);
    let mut tried: Vec<Tried> = Vec::new();
    for &(_, c, k) in pool.iter().take(FINALISTS) {
        let candidate = &candidates[c];
        let scores =
            if candidate.memory { free_run(file, candidate, k, 200) } else { from_rows(file, candidate, k, &compared) };
        let limit = allowed(k, file.t.rounding);
        tried.push(Tried {
            id: candidate.id.clone(),
            h_s: file.clock.interval / k as f64,
            steps_per_row: k,
            largest_difference: quantile(&scores, SHARE) / if candidate.memory { growth(&scores, k) } else { 1.0 },
            rows: scores.iter().filter(|s| **s <= limit).count(),
            free_run: candidate.memory,
            damping: candidate.damping,
            same_as: Vec::new(),
            fitted: candidate.steps.is_some(),
            signature: signature(candidate, file, k, fewest),
            rank: (candidate.substeps, !candidate.id.starts_with("semi-implicit"), c),
        });
    }
    tried.sort_by(|a, b| a.largest_difference.total_cmp(&b.largest_difference));
    let late = late_pose(file, candidates, &tried, rows[0]);
    let mut out = verdict(file, tried, pool.len(), compared.len());
    if let Some((c, k)) = late {
        out.pose_late = true;
        out.verdict = StepVerdict::Identified;
        out.candidates.truncate(1);
        out.candidates[0].id = format!("{}, the pose written one step late", candidates[c].id);
        out.candidates[0].same_as.clear();
        out.candidates[0].steps_per_row = k;
        out.candidates[0].h_s = file.clock.interval / k as f64;
        out.candidates[0].damping = candidates[c].damping;
    }
    Some(out)
}

/// A candidate whose pose, written one step late, reproduces the first rows, where the best candidate fails from the first row:
/// there the pose and its rate still belong together.
fn late_pose(file: &File<'_>, candidates: &[Candidate], tried: &[Tried], first: usize) -> Option<(usize, u64)> {
    let best = tried.first()?;
    let k = best.steps_per_row;
    let limit = allowed(k, file.t.rounding);
    if best.largest_difference > limit || first != 0 || file.t.rows() <= LATE_ROWS {
        return None;
    }
    let of_best = candidates.get(best.rank.2)?;
    if from_rows(file, of_best, k, &[0])[0] <= limit {
        return None;
    }
    let h = file.clock.interval / k as f64;
    let fits = |candidate: &Candidate| {
        let run = (candidate.run)(&file.kin(0), h, 1, k * LATE_ROWS as u64);
        (1..=LATE_ROWS).all(|row| {
            let now = row * k as usize;
            let (Some(rate), pose) = (run.get(now - 1), if now > 1 { run[now - 2] } else { file.kin(0) }) else {
                return false;
            };
            let seen = Kin { v: rate.v, w: rate.w, angle: [pose.angle[0], rate.angle[1]], ..pose };
            file.difference(&seen, row) <= limit * (row as f64).sqrt() * 4.0
        })
    };
    let plain = |c: &&(usize, &Candidate)| !c.1.memory && c.1.substeps == 1;
    let mut fitting: Vec<usize> =
        candidates.iter().enumerate().filter(|c| plain(&c) && fits(c.1)).map(|(i, _)| i).collect();
    fitting.sort_by_key(|c| !candidates[*c].id.starts_with("semi-implicit"));
    fitting.first().map(|c| (*c, k))
}

/// Rows from the start that a late pose must reproduce.
const LATE_ROWS: usize = 8;

/// By how much rounding grows in a free run: with the square root of the number of steps.
fn growth(scores: &[f64], k: u64) -> f64 {
    (scores.len() as f64 * k as f64).max(1.0).sqrt()
}

/// Whether anything moves by more than the resolution.
fn moves(file: &File<'_>, rows: &[usize]) -> bool {
    let turns = file.moves != Moves::Rotation
        || file.t.omega.as_ref().is_some_and(|w| w.values.iter().any(|w| w.norm() * file.clock.interval > 1e-9));
    turns && rows.iter().take(64).any(|&i| file.difference(&file.kin(i), i + 1) > 64.0)
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

/// Where a candidate goes from a generic state in long steps: what tells it from others in general. `fewest`: the smallest
/// number of steps in a row of all that are compared, so that a step is at most 1/8 s.
fn signature(candidate: &Candidate, file: &File<'_>, k: u64, fewest: u64) -> Vec<f64> {
    let own = file.kin(0);
    let size = |v: &Option<crate::trajectory::Vectors>| {
        v.as_ref().map_or(1.0, |v| v.values.iter().map(|x| x.norm()).fold(0.0, f64::max)).max(0.5)
    };
    // Nothing is parallel to an axis, nothing is at rest.
    let start = Kin {
        x: Vector3::new(0.61, -0.37, 0.83) * size(&file.t.position),
        v: Vector3::new(-0.43, 0.71, 0.29) * size(&file.t.velocity),
        q: Rotation::from_wxyz([0.77, -0.31, 0.43, 0.37]).wxyz(),
        w: Vector3::new(1.53, 1.67, -1.41),
        angle: [own.angle[0] + 0.5, own.angle[1] + 0.3],
    };
    let interval = 0.125 * fewest as f64;
    let end = (candidate.run)(&start, interval / k as f64, k, 2);
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
    let tolerance = if single { 2e-5 } else { 1e-10 };
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
    let fits = |c: &Tried| {
        let more = if c.free_run && file.t.rounding == Rounding::Double { FREE_RUN } else { 1.0 };
        c.largest_difference <= more * allowed(c.steps_per_row, file.t.rounding)
    };
    let best = tried.first().map_or(f64::MAX, |t| t.largest_difference.max(1.0));
    let verdict = if !tried.first().is_some_and(fits) {
        tried.truncate(3);
        StepVerdict::NoneOf
    } else {
        tried.retain(|t| t.largest_difference < if fits(t) { WORSE } else { WORSE_AND_UNFIT } * best);
        // A coefficient of few digits is no accident; one that was fitted to the file says nothing about its rule.
        if tried.iter().any(|t| !t.fitted && fits(t)) {
            tried.retain(|t| !t.fitted);
        }
        tried = merged(tried, file.t.rounding == Rounding::Single);
        if tried.len() == 1 { StepVerdict::Identified } else { StepVerdict::OneOf }
    };
    Identified {
        moves: file.moves,
        verdict,
        candidates: tried,
        tried: pool,
        resolution: resolution.unwrap_or(0.0),
        rows,
        pose_late: false,
    }
}
