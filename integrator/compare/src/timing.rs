//! Times that can be compared: the candidates take turns in one process, for many rounds, between looks at a clock of
//! integer operations that goes with the processor's frequency.

use std::hint::black_box;
use std::time::Instant;

/// A piece of work, and how much of it there is.
pub struct Candidate<'a> {
    /// Does it once.
    pub run: Box<dyn Fn() + 'a>,
    /// How often in one measurement: enough for the clock's resolution, little enough for few interruptions.
    pub times: u32,
}

/// What one execution of a candidate takes.
#[derive(Clone, Debug)]
pub struct Timing {
    /// The least over the rounds, ns.
    pub least_ns: f64,
    /// The median over the rounds, ns.
    pub median_ns: f64,
    /// The least over the rounds, in cycles of the clock chain.
    pub least_cycles: f64,
    /// Of each round, in the same cycles.
    rounds: Vec<f64>,
}

impl Timing {
    /// The median over the rounds of (this / other): both were measured within the same round.
    pub fn median_ratio(&self, other: &Timing) -> f64 {
        let mut ratios: Vec<f64> = self.rounds.iter().zip(&other.rounds).map(|(a, b)| a / b).collect();
        median(&mut ratios)
    }
}

impl<'a> Candidate<'a> {
    /// Repeats short work until a measurement lasts about 30 us.
    pub fn new(run: impl Fn() + 'a) -> Self {
        run();
        let once = (0..3).map(|_| seconds(&run)).fold(f64::INFINITY, f64::min);
        Candidate { run: Box::new(run), times: (30e-6 / once).clamp(1.0, 1000.0) as u32 }
    }
}

/// Every candidate once a round.
pub fn interleave(candidates: &[Candidate<'_>], rounds: usize) -> Vec<Timing> {
    let mut samples = vec![Vec::with_capacity(rounds); candidates.len()];
    for _ in 0..rounds {
        for (candidate, sample) in candidates.iter().zip(&mut samples) {
            // The clock before and after: an interruption of one of them must not make a candidate look fast.
            let before = seconds(&clock);
            let time = seconds(&|| (0..candidate.times).for_each(|_| (candidate.run)())) / f64::from(candidate.times);
            let cycle = before.min(seconds(&clock)) / CLOCK_CYCLES;
            sample.push((time * 1e9, time / cycle));
        }
    }
    samples.iter().map(|sample| summary(sample)).collect()
}

fn summary(sample: &[(f64, f64)]) -> Timing {
    let mut ns: Vec<f64> = sample.iter().map(|s| s.0).collect();
    let rounds: Vec<f64> = sample.iter().map(|s| s.1).collect();
    Timing {
        least_ns: ns.iter().copied().fold(f64::INFINITY, f64::min),
        median_ns: median(&mut ns),
        least_cycles: rounds.iter().copied().fold(f64::INFINITY, f64::min),
        rounds,
    }
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn seconds(work: &impl Fn()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

const CLOCK_LINKS: u32 = 4000;
const CLOCK_CYCLES: f64 = 4.0 * CLOCK_LINKS as f64;

/// Four cycles a link: a multiplication (three) and an exclusive or (one), which no compiler can put together.
fn clock() {
    let mut x = black_box(3_u64);
    let by = black_box(0x9E37_79B9_7F4A_7C15_u64);
    for _ in 0..CLOCK_LINKS {
        x = x.wrapping_mul(by) ^ by;
    }
    black_box(x);
}
