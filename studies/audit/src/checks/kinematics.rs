//! Position against velocity and attitude against angular velocity: which rule moves them, by which factor, how late.

mod attitude;

use nalgebra::Vector3;

pub use attitude::contradictions;
use attitude::{attitude, norm};

use crate::clock::Clock;
use crate::finding::{Check, Finding, Verdict, quantile};
use crate::trajectory::{Trajectory, Vectors};

/// Half units in the last place that a step of an engine may be off its own formula: about sixteen roundings.
const ROUNDINGS: f64 = 16.0;
/// Rows from which a lag is found, at most.
const ROWS: usize = 4096;
/// The largest lag that is looked for, in rows.
const LARGEST_LAG: i64 = 8;
/// Factors that have a name.
const FACTORS: [(f64, &str); 10] = [
    (2.0, "twice too small"),
    (0.5, "twice too large"),
    (-1.0, "of the wrong sign"),
    (-2.0, "of the wrong sign and twice too small"),
    (-0.5, "of the wrong sign and twice too large"),
    (std::f64::consts::PI / 180.0, "in degrees"),
    (180.0 / std::f64::consts::PI, "in rad where degrees are said"),
    (1e-3, "a thousand times too large"),
    (1e3, "a thousand times too small"),
    (0.3048, "in feet"),
];

/// The movement of a quantity between two rows, beside what its rate says.
struct Moved {
    /// What moved: x1 - x0, or the rotation vector of the turn.
    by: Vector3<f64>,
    /// The rates at both rows.
    rates: [Vector3<f64>; 2],
    /// (r0 + r1) / 2, with the commutator for a rotation.
    mean: Vector3<f64>,
    h: f64,
}

/// The rate by which a rule moves a pose.
type RateOf = fn(&Moved) -> Vector3<f64>;

/// What is asked about: the words for a quantity and its rate.
#[derive(Clone, Copy)]
struct Words {
    pose: &'static str,
    rate: &'static str,
    ids: [&'static str; 3],
}

const POSITION: Words =
    Words { pose: "position", rate: "velocity", ids: ["position-rule", "velocity-factor", "position-lags"] };
const ATTITUDE: Words = Words {
    pose: "attitude",
    rate: "angular velocity",
    ids: ["attitude-rule", "angular-velocity-factor", "attitude-lags"],
};
const ANGLE: Words =
    Words { pose: "angle", rate: "angle rate", ids: ["angle-rule", "angle-rate-factor", "angle-lags"] };

/// All findings. `record_every`: engine steps in a row, where known.
pub fn check(t: &Trajectory, clock: &Clock, record_every: Option<u64>) -> Vec<Finding> {
    let mut found = Vec::new();
    if let (Some(x), Some(v)) = (&t.position, &t.velocity) {
        let tolerance = clock.interval.mul_add(v.resolution.absolute, x.resolution.absolute) * ROUNDINGS;
        let moved = flat(&t.time, x, v);
        let shifted = |s: i64| correlation_flat(t, x, v, s);
        found.extend(judge(POSITION, &moved, clock, record_every, tolerance, &shifted));
        found.extend(late_start(t, x, v));
    }
    if let (Some(a), Some(r)) = (&t.angle, &t.angle_rate) {
        let vectors = |s: &crate::trajectory::Scalars| Vectors {
            values: s.values.iter().map(|x| Vector3::new(*x, 0.0, 0.0)).collect(),
            axes: vec![0],
            resolution: s.resolution,
        };
        let (x, v) = (vectors(a), vectors(r));
        let moved = flat(&t.time, &x, &v);
        let tolerance = ROUNDINGS * (x.resolution.absolute + clock.interval * v.resolution.absolute);
        found.extend(judge(ANGLE, &moved, clock, record_every, tolerance, &|s| correlation_flat(t, &x, &v, s)));
        if a.unwrapped > 0 {
            let evidence = format!("the angle jumps by a turn {} time(s); the turns were added", a.unwrapped);
            found.push(Finding::new(
                Check::Kinematics,
                "wrapped-angle",
                Verdict::Note,
                ("jumps", a.unwrapped as f64, ""),
                evidence,
            ));
        }
    }
    if t.attitude.is_some() && t.omega.is_some() && t.scored.is_some() {
        found.extend(attitude(t, clock, record_every));
    }
    found.extend(norm(t));
    found
}

fn flat(time: &[f64], x: &Vectors, v: &Vectors) -> Vec<Moved> {
    (0..time.len() - 1)
        .map(|i| Moved {
            by: x.values[i + 1] - x.values[i],
            rates: [v.values[i], v.values[i + 1]],
            mean: (v.values[i] + v.values[i + 1]) / 2.0,
            h: time[i + 1] - time[i],
        })
        .collect()
}

/// Rule, factor and lag of one pair of quantities. `shifted(s)`: misfit with the pose taken s rows later.
fn judge(
    words: Words,
    moved: &[Moved],
    clock: &Clock,
    record_every: Option<u64>,
    tolerance: f64,
    shifted: &dyn Fn(i64) -> f64,
) -> Vec<Finding> {
    let regular: Vec<&Moved> = moved.iter().enumerate().filter(|(i, _)| clock.is_regular(*i)).map(|(_, m)| m).collect();
    let largest = regular.iter().map(|m| m.by.norm()).fold(0.0, f64::max);
    let told = regular.iter().map(|m| m.mean.norm() * m.h).fold(0.0, f64::max);
    if regular.len() < 3 || largest.max(told) <= tolerance {
        return vec![];
    }
    let mut found = Vec::new();
    if let Some((name, kept, worst)) = rule(&regular, tolerance) {
        let evidence = format!(
            "{} in {kept} of {} rows, to {worst:.1e}",
            name.replace('x', &words.pose[..1]).replace('p', "x"),
            regular.len()
        );
        found.push(
            Finding::new(
                Check::Kinematics,
                words.ids[0],
                Verdict::Pass,
                (format!("{} moved by {}", words.pose, words.rate), worst, ""),
                evidence,
            )
            .within(tolerance),
        );
        return found;
    }
    let smooth = without_jumps(&regular);
    if let Some(factor) = factor(words, &smooth) {
        found.push(factor);
        return found;
    }
    found.extend(lag(words, &smooth, clock.interval, record_every, tolerance, shifted));
    found
}

/// A rule that holds in three rows of five (contacts break it; to rounding it holds nowhere by chance): its formula, rows kept,
/// largest misfit of those.
fn rule(moved: &[&Moved], tolerance: f64) -> Option<(&'static str, usize, f64)> {
    let rules: [(&str, RateOf); 3] = [
        ("x1 = x0 + h v0 (old rate)", |m| m.rates[0]),
        ("x1 = x0 + h v1 (new rate)", |m| m.rates[1]),
        ("x1 = x0 + h (v0 + v1) / 2", |m| m.mean),
    ];
    let tested = rules.map(|(name, rate)| {
        let misfits: Vec<f64> = moved.iter().map(|m| (m.by - rate(m) * m.h).norm()).collect();
        let kept: Vec<f64> = misfits.iter().copied().filter(|e| *e <= tolerance).collect();
        (name, kept.len(), kept.iter().copied().fold(0.0, f64::max))
    });
    let holds = |kept: usize| kept * 5 >= moved.len() * 3;
    let holding: Vec<_> = tested.iter().filter(|(_, kept, _)| holds(*kept)).collect();
    match holding.as_slice() {
        [] => None,
        [(name, kept, worst)] => Some((name, *kept, *worst)),
        [(_, kept, worst), ..] => Some(("the rate hardly changes: old, new and mean rate fit alike", *kept, *worst)),
    }
}

/// The movements during which the rate does not jump, as it does in a bounce.
fn without_jumps<'a>(moved: &[&'a Moved]) -> Vec<&'a Moved> {
    let change = |m: &Moved| (m.rates[1] - m.rates[0]).norm();
    let usual = quantile(&moved.iter().map(|m| change(m)).collect::<Vec<_>>(), 0.5);
    moved.iter().copied().filter(|m| usual == 0.0 || change(m) <= 8.0 * usual).collect()
}

/// A factor between a rate and the movement that is no rounding and no error of a method.
fn factor(words: Words, moved: &[&Moved]) -> Option<Finding> {
    let sum = |f: &dyn Fn(&Moved) -> f64| moved.iter().map(|m| f(m)).sum::<f64>();
    let told = sum(&|m| (m.mean * m.h).norm_squared());
    let by = sum(&|m| m.by.norm_squared());
    let factor = sum(&|m| m.by.dot(&(m.mean * m.h))) / told;
    let missed = (sum(&|m| (m.by - m.mean * (m.h * factor)).norm_squared()) / by).sqrt();
    if !((factor - 1.0).abs() > 0.05 && missed < 0.3) {
        return None;
    }
    let named = FACTORS.iter().find(|(f, _)| (factor / f - 1.0).abs() < 0.03);
    let meaning = named.map_or(String::new(), |(_, words)| format!(": the rate is {words}"));
    let evidence = format!(
        "{} moves by {factor:.4} times its {}{meaning}; what is left is {missed:.1e} of the movement",
        words.pose, words.rate
    );
    let quantity = (format!("factor between {} and {}", words.pose, words.rate), factor, "");
    Some(Finding::new(Check::Kinematics, words.ids[1], Verdict::Fault, quantity, evidence).within(1.0))
}

/// How late the pose is against its rate, in time: whole rows by trying, the rest by regression on the change of the rate.
fn lag(
    words: Words,
    moved: &[&Moved],
    interval: f64,
    record_every: Option<u64>,
    tolerance: f64,
    shifted: &dyn Fn(i64) -> f64,
) -> Option<Finding> {
    let best = (-LARGEST_LAG..=LARGEST_LAG)
        .map(|s| (shifted(s), s))
        .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.abs().cmp(&b.1.abs())))?;
    let whole = if best.0 < 0.1 * shifted(0) { best.1 } else { 0 };
    let (mut above, mut below, mut size) = (0.0, 0.0, 0.0);
    for m in moved {
        let missed = m.by / m.h - m.mean;
        let change = (m.rates[1] - m.rates[0]) / m.h;
        above += missed.dot(&change);
        below += change.norm_squared();
        size += missed.norm_squared();
    }
    let fraction = -above / below;
    let explained = above * above / (below * size);
    let change = (below / moved.len() as f64).sqrt() * interval;
    if below == 0.0
        || change * interval < 4.0 * tolerance
        || !(size > 0.0)
        || fraction.abs() > LARGEST_LAG as f64 * interval
    {
        return None;
    }
    let late = if whole == 0 { fraction } else { whole as f64 * interval };
    let rows = late / interval;
    let per_row = record_every.map_or(String::new(), |k| format!(", {:.2} steps", rows * k as f64));
    // A method that moves the pose by the old or the new rate is half a step off.
    // A rule of one step holds to rounding from row to row, so that half a row without a rule is no method.
    let of_method = record_every.filter(|k| *k > 1).map_or(0.27, |k| 0.55 / k as f64);
    let quantity = (format!("lag of the {} behind its rate", words.pose), late, "s");
    let evidence =
        format!("the {} fits the {} best {late:.6} s ({rows:.3} rows{per_row}) late", words.pose, words.rate);
    // The mean of two rates misses a curved rate, and a linear step of an attitude turns by (h omega)^2 / 12 too little.
    let bends = moved
        .windows(2)
        .map(|w| (w[1].rates[1] - w[1].rates[0] - w[0].rates[1] + w[0].rates[0]).norm_squared())
        .sum::<f64>();
    let bend = (bends / below).sqrt() / interval;
    let speed = (moved.iter().map(|m| m.mean.norm_squared()).sum::<f64>() / moved.len() as f64).sqrt();
    let turn = speed * interval / record_every.unwrap_or(1) as f64;
    let linear = if words.ids[2] == "attitude-lags" { turn * turn / 12.0 * speed / (change / interval) } else { 0.0 };
    let room = of_method + interval * bend / 12.0 + linear / interval;
    if whole != 0 || (rows.abs() > room && explained > 0.8) {
        return Some(Finding::new(Check::Kinematics, words.ids[2], Verdict::Fault, quantity, evidence));
    }
    (explained > 0.9).then(|| {
        let evidence = format!(
            "{evidence}: as by a step of {:.6} s with the {} rate",
            2.0 * late.abs(),
            if late > 0.0 { "old" } else { "new" }
        );
        Finding::new(Check::Kinematics, words.ids[0], Verdict::Note, quantity, evidence)
    })
}

/// Misfit of x' = v with the pose s rows later, relative to the movement.
fn correlation_flat(t: &Trajectory, x: &Vectors, v: &Vectors, s: i64) -> f64 {
    shifted_misfit(t.rows(), s, &|i, j| {
        let h = t.time[i + 1] - t.time[i];
        (x.values[j + 1] - x.values[j], (v.values[i] + v.values[i + 1]) * (h / 2.0))
    })
}

fn shifted_misfit(rows: usize, s: i64, pair: &dyn Fn(usize, usize) -> (Vector3<f64>, Vector3<f64>)) -> f64 {
    let margin = LARGEST_LAG as usize;
    if rows < 4 * margin {
        return if s == 0 { 1.0 } else { f64::INFINITY };
    }
    let (mut missed, mut size) = (0.0, 0.0);
    let stride = ((rows - 2 * margin) / ROWS).max(1);
    for i in (margin..rows - margin - 1).step_by(stride) {
        let (by, told) = pair(i, (i as i64 + s) as usize);
        missed += (by - told).norm_squared();
        size += by.norm_squared();
    }
    if size == 0.0 { f64::INFINITY } else { (missed / size).sqrt() }
}

/// The first row repeated in the pose alone: the pose was written before the step, its rate after it.
fn late_start(t: &Trajectory, x: &Vectors, v: &Vectors) -> Option<Finding> {
    let still = x.values[1] == x.values[0] && v.values[0].norm() > 0.0 && v.values[1].norm() > 0.0;
    let moves = (1..t.rows().min(12) - 1).all(|i| x.values[i + 1] != x.values[i]);
    (still && moves && t.time[1] > t.time[0]).then(|| {
        let evidence = "the pose of row 2 is that of row 1 while the velocity is not zero, and moves from then on: the pose is written one step late";
        Finding::new(Check::Kinematics, "pose-late-by-one-step", Verdict::Fault, ("lag of the pose", 1.0, "steps"), evidence)
    })
}
