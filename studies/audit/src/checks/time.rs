//! The clock: monotone, even, without gaps, repeats and resets; jitter; a sum in single precision.

use crate::clock::Clock;
use crate::finding::{Check, Finding, Verdict, median};
use crate::trajectory::Trajectory;

/// Most rows that a finding names.
const NAMED: usize = 3;

fn finding(id: &'static str, verdict: Verdict, value: f64, unit: &'static str, evidence: String) -> Finding {
    Finding::new(Check::Time, id, verdict, (id.replace('-', " "), value, unit), evidence)
}

/// The usual interval, and what is wrong with the clock.
pub fn check(t: &Trajectory) -> (Clock, Vec<Finding>) {
    let steps: Vec<f64> = t.time.windows(2).map(|w| w[1] - w[0]).collect();
    let forward: Vec<f64> = steps.iter().copied().filter(|d| *d > 0.0).collect();
    let interval = mean_interval(&forward);
    let mut found = Vec::new();
    // The difference of two rounded times, and the rounding of i h.
    let tolerance =
        4.0 * t.time_resolution + 4.0 * f64::EPSILON * t.time.last().map_or(0.0, |t| t.abs()) + 1e-9 * interval;
    let (mut back, mut repeated, mut gaps, mut uneven) = (vec![], vec![], vec![], vec![]);
    for (i, step) in steps.iter().enumerate() {
        let rows = step / interval;
        if *step < 0.0 {
            back.push(i);
        } else if *step == 0.0 {
            repeated.push(i);
        } else if (rows - rows.round()).abs() * interval <= tolerance.max(1e-3 * interval) && rows.round() >= 2.0 {
            gaps.push(i);
        } else if (step - interval).abs() > tolerance {
            uneven.push(i);
        }
    }
    let rows = |list: &[usize]| {
        let named: Vec<String> = list.iter().take(NAMED).map(|i| (i + 2).to_string()).collect();
        format!("at row {}{}", named.join(", "), if list.len() > NAMED { ", ..." } else { "" })
    };
    if let Some(first) = back.first() {
        let evidence =
            format!("time runs backwards {} time(s), {}, first by {:.6} s", back.len(), rows(&back), -steps[*first]);
        found.push(finding("clock-reset", Verdict::Fault, back.len() as f64, "rows", evidence));
    }
    if !repeated.is_empty() {
        let evidence = format!("{} row(s) have the time of the row before, {}", repeated.len(), rows(&repeated));
        found.push(finding("repeated-row", Verdict::Fault, repeated.len() as f64, "rows", evidence));
    }
    if !gaps.is_empty() {
        let lost: f64 = gaps.iter().map(|i| (steps[*i] / interval).round() - 1.0).sum();
        let evidence = format!("{lost} row(s) are missing, {}", rows(&gaps));
        found.push(finding("gap", Verdict::Fault, lost, "rows", evidence));
    }
    let single = single_sum(&t.time);
    if let Some(h) = single {
        found.push(summed(&t.time, h));
    } else if !uneven.is_empty() {
        found.push(unevenness(t, &steps, interval, &uneven));
    }
    if single.is_none() && back.is_empty() && repeated.is_empty() && gaps.is_empty() && uneven.is_empty() {
        let evidence = format!("{} rows, {:.9} s apart, even to {:.1e} s", t.rows(), interval, tolerance);
        found.push(finding("even", Verdict::Pass, interval, "s", evidence));
    }
    let mut irregular: Vec<usize> = [back, repeated, gaps].concat();
    irregular.extend(uneven.iter().filter(|i| (steps[**i] / interval - 1.0).abs() > 0.01));
    irregular.sort_unstable();
    (Clock { interval, irregular }, found)
}

/// The mean of the intervals near the median: the median itself has the rounding of two stamps.
fn mean_interval(forward: &[f64]) -> f64 {
    let middle = median(forward);
    let near: Vec<f64> = forward.iter().copied().filter(|d| (d / middle - 1.0).abs() < 0.01).collect();
    near.iter().sum::<f64>() / near.len() as f64
}

fn unevenness(t: &Trajectory, steps: &[f64], interval: f64, uneven: &[usize]) -> Finding {
    let rms = (uneven.iter().map(|i| (steps[*i] - interval).powi(2)).sum::<f64>() / steps.len() as f64).sqrt();
    if single_valued(&t.time) {
        let evidence = format!("times are numbers of single precision, {rms:.1e} s rms off an even clock");
        return finding("f32-clock", Verdict::Fault, rms, "s", evidence);
    }
    let share = uneven.len() as f64 / steps.len() as f64;
    let evidence =
        format!("{} of {} intervals differ from {interval:.9} s, rms {rms:.2e} s", uneven.len(), steps.len());
    let jitters = share > 0.05 || rms > 0.01 * interval;
    finding("jitter", if jitters { Verdict::Fault } else { Verdict::Note }, rms, "s", evidence)
}

/// A clock that is a sum in single precision, with the step that was added.
fn summed(time: &[f64], h: f64) -> Finding {
    let rows = time.len() - 1;
    let drift = (time[rows] - time[0]) - h * rows as f64;
    let evidence = format!("times are the f32 sum of {h}: after {rows} rows the clock is off by {drift:.2e} s");
    finding("f32-clock", Verdict::Fault, drift, "s", evidence)
}

/// Whether the times are numbers of single precision, and not all of them short.
fn single_valued(time: &[f64]) -> bool {
    let exact = time.iter().all(|t| f64::from(*t as f32) == *t);
    let long = time.iter().filter(|t| (*t * 1048576.0).fract() != 0.0).count();
    exact && long * 4 > time.len()
}

/// The step h, if the times are 0, h, h + h, ... added up in single precision (each row one or several steps later).
fn single_sum(time: &[f64]) -> Option<f64> {
    if !single_valued(time) || time.len() < 3 {
        return None;
    }
    let first = time[1] - time[0];
    (1..=64_u32).find_map(|substeps| {
        let h = (first / f64::from(substeps)) as f32;
        let mut clock = time[0] as f32;
        let agrees = time.iter().take(2000).skip(1).all(|t| {
            for _ in 0..substeps {
                clock += h;
            }
            (f64::from(clock) - t).abs() <= f64::from(f32::EPSILON) * t.abs() / 2.0
        });
        agrees.then_some(f64::from(h) * f64::from(substeps))
    })
}
