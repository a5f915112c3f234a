//! Times that can be compared: the candidates take turns for many rounds, each between two readings of a clock chain.

use std::hint::black_box;
use std::time::Instant;

use super::candidate::{Candidate, Span};
use scenes::any::AnyScene;
use scenes::run::Precision;
use scenes::timed::Repetitions;

/// How carefully times are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimingEffort {
    /// Rounds.
    pub rounds: usize,
    /// Length of one sample, ns.
    pub sample_ns: u64,
}

impl TimingEffort {
    /// For a study of everything.
    pub const FULL: TimingEffort = TimingEffort { rounds: 9, sample_ns: 40_000 };
    /// For a glance.
    pub const QUICK: TimingEffort = TimingEffort { rounds: 3, sample_ns: 10_000 };
    /// For the few that an answer rests on.
    pub const ADVICE: TimingEffort = TimingEffort { rounds: 21, sample_ns: 200_000 };
}

/// What is to be timed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// What moves the scene.
    pub candidate: Candidate,
    /// The arithmetic.
    pub precision: Precision,
    /// How far, in how many steps.
    pub span: Span,
}

/// Time of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The least over all rounds, ns.
    pub least_ns: f64,
    /// The median, ns.
    pub median_ns: f64,
    /// The upper quartile, ns.
    pub upper_ns: f64,
    /// The least of the ratios to the cycle of the same round: cycles.
    pub cycles: f64,
}

/// Links of the clock chain.
const LINKS: u64 = 2_000;
/// Cycles of one link: a multiplication (three) and an exclusive or (one), which no compiler can put together.
const CYCLES_A_LINK: f64 = 4.0;

/// The length of one cycle of the processor now, ns.
pub fn cycle_ns() -> f64 {
    let (mut x, by) = (black_box(3_u64), black_box(0x9E37_79B9_7F4A_7C15_u64));
    let clock = Instant::now();
    for _ in 0..LINKS {
        x = x.wrapping_mul(by) ^ by;
    }
    black_box(x);
    clock.elapsed().as_secs_f64() * 1e9 / (LINKS as f64 * CYCLES_A_LINK)
}

/// Times every task on one scene; `None` for a run that fails. Nothing else may run meanwhile.
pub fn costs(scene: &dyn AnyScene, tasks: &[Task], care: TimingEffort) -> Vec<Option<Cost>> {
    // The first run warms the caches and says how many make a sample.
    let laps: Vec<Repetitions> = tasks
        .iter()
        .map(|task| {
            let one = sample(scene, task, Repetitions(1));
            // A run that cannot be timed is not tried again.
            Repetitions(if one.is_nan() { 0 } else { (care.sample_ns as f64 / one.max(1.0)).clamp(1.0, 1e4) as u32 })
        })
        .collect();
    let mut times = vec![Vec::with_capacity(care.rounds); tasks.len()];
    for _ in 0..care.rounds {
        for ((task, laps), times) in tasks.iter().zip(&laps).zip(&mut times).filter(|((_, laps), _)| laps.0 > 0) {
            // The clock before and after: an interruption of one of them must not make a candidate look fast.
            let before = cycle_ns();
            let ns = sample(scene, task, *laps) / (f64::from(laps.0) * task.span.steps as f64);
            times.push((ns, ns / before.min(cycle_ns())));
        }
    }
    times.iter().map(|times| summary(times)).collect()
}

/// Time of all laps, ns; NaN for a run that fails.
fn sample(scene: &dyn AnyScene, task: &Task, laps: Repetitions) -> f64 {
    let Task { candidate, precision, span } = *task;
    match candidate.time(scene, precision, span, laps) {
        Some(lap) if lap.checksum.is_finite() => lap.ns,
        Some(_) => f64::NAN,
        None if precision == Precision::DoubleDouble => observed(scene, task, laps),
        None => f64::NAN,
    }
}

/// Double-double is timed as it is run for errors: its arithmetic outweighs the counting by far.
fn observed(scene: &dyn AnyScene, task: &Task, laps: Repetitions) -> f64 {
    let clock = Instant::now();
    for _ in 0..laps.0 {
        let seen = task.candidate.run(scene, task.precision, task.span, task.span.steps);
        if black_box(seen).is_none_or(|run| run.end().is_none()) {
            return f64::NAN;
        }
    }
    clock.elapsed().as_secs_f64() * 1e9
}

fn summary(times: &[(f64, f64)]) -> Option<Cost> {
    if times.is_empty() || times.iter().any(|(ns, _)| !ns.is_finite()) {
        return None;
    }
    let mut ns: Vec<f64> = times.iter().map(|t| t.0).collect();
    ns.sort_by(f64::total_cmp);
    let cycles = times.iter().map(|t| t.1).fold(f64::INFINITY, f64::min);
    Some(Cost { least_ns: ns[0], median_ns: ns[ns.len() / 2], upper_ns: ns[3 * ns.len() / 4], cycles })
}
