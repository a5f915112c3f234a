//! The search: every candidate on a few rows, the best on all of them, and what the differences say.

use integrator::Rotation;
use nalgebra::Vector3;

use super::candidate::{Candidate, Kin};
use super::{File, Identified, Moves, StepVerdict, Tried, allowed, steps_per_row};
use crate::finding::quantile;
use crate::physics::Force;
use crate::trajectory::Rounding;

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

pub(super) fn search(
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
        v.as_ref().map_or(1.0, |v| v.values.iter().map(Vector3::norm).fold(0.0, f64::max)).max(0.5)
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
