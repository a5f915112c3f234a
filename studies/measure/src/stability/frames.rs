//! Steps of unequal length: what stability is for a sequence of steps.
//!
//! A step h multiplies the state of a linear scene by M(h). A pattern of steps h_1, .., h_n that repeats multiplies it by
//! M(h_n) .. M(h_1); it is stable where no eigenvalue of the product lies outside the unit circle, which does not follow from each step
//! being stable (parametric resonance: L. D. Landau, E. M. Lifshitz, *Mechanics*, section 27). For steps drawn at random the growth is
//! the largest Lyapunov exponent of the product (H. Furstenberg, H. Kesten, Ann. Math. Stat. 31 (1960) 457), which is measured.

use faer::fx128;
use integrator::Single;

use super::amplification::{Amplification, matrix};
use crate::fit::student_t_95;
use crate::random::Generator;
use scenes::stepping::Stepping;

/// The growth of a pattern of steps that repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern {
    /// By what factor the fastest growing error is multiplied in one pattern: the spectral radius of the product.
    pub factor: f64,
    /// Whether no error grows exponentially.
    pub is_stable: bool,
}

/// The growth of the steps `frames_s`, one after the other and again; `None` where a step is not a linear map, or none is given.
pub fn pattern(stepping: &Stepping<'_>, frames_s: &[f64]) -> Option<Pattern> {
    let mut product: Option<Amplification> = None;
    for &h_s in frames_s {
        let step = matrix(stepping, h_s)?;
        product = Some(product.map_or(step.clone(), |before| times(&step, &before)));
    }
    let product = product?;
    Some(Pattern { factor: product.spectral_radius()?, is_stable: product.is_stable()? })
}

fn times(a: &Amplification, b: &Amplification) -> Amplification {
    let n = a.n;
    let entry =
        |i: usize, j: usize| (0..n).fold(fx128::ZERO, |sum, k| sum + a.entries[i * n + k] * b.entries[k * n + j]);
    Amplification { n, entries: (0..n * n).map(|at| entry(at / n, at % n)).collect() }
}

/// The growth under steps drawn at random.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jitter {
    /// ln of the factor by which an error grows in a step, in the mean.
    pub rate: f64,
    /// Half of its 95 % interval.
    pub half_width: f64,
    /// Steps that it was measured over.
    pub steps: u64,
}

impl Jitter {
    /// Whether errors grow: the interval lies above zero.
    pub fn grows(&self) -> bool {
        self.rate > self.half_width
    }
}

/// Steps of one block, and blocks: their scatter gives the interval.
const BLOCK: u64 = 65_536;
const BLOCKS: u64 = 32;
/// Different lengths of step that the draws are rounded to: a matrix is made for each.
const LENGTHS: u64 = 1024;

/// The mean growth rate of steps h (1 + s u) with u uniform in [-1, 1], from a seed; `None` where a step is not a linear map.
pub fn jitter(stepping: &Stepping<'_>, h_s: f64, part: f64, seed: u64) -> Option<Jitter> {
    jitter_over(stepping, h_s, part, seed, BLOCKS)
}

/// The same over so many blocks of 65536 steps, at least 2.
pub fn jitter_over(stepping: &Stepping<'_>, h_s: f64, part: f64, seed: u64, blocks: u64) -> Option<Jitter> {
    let length = |k: u64| h_s * (1.0 + part * ((2.0 * k as f64 + 1.0) / LENGTHS as f64 - 1.0));
    let plain = |m: Amplification| m.entries.iter().map(|x| x.to_f64()).collect::<Vec<f64>>();
    let matrices = (0..LENGTHS).map(|k| matrix(stepping, length(k)).map(plain)).collect::<Option<Vec<_>>>()?;
    let n = (matrices[0].len() as f64).sqrt() as usize;
    let mut random = Generator::new(seed);
    let mut vector: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
    let mut rates = Vec::new();
    for block in 0..=blocks {
        let mut grown = 0.0;
        for _ in 0..BLOCK {
            let m = &matrices[(random.bits() % LENGTHS) as usize];
            let next: Vec<f64> = (0..n).map(|i| (0..n).map(|j| m[i * n + j] * vector[j]).sum()).collect();
            let size = next.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
            if !(size > 0.0 && size.is_finite()) {
                return None;
            }
            grown += size.ln();
            vector = next.into_iter().map(|x| x / size).collect();
        }
        // The first block turns the vector into the direction that grows.
        if block > 0 {
            rates.push(grown / BLOCK as f64);
        }
    }
    let count = rates.len() as f64;
    let rate = rates.iter().sum::<f64>() / count;
    let variance = rates.iter().map(|x| (x - rate).powi(2)).sum::<f64>() / (count - 1.0);
    let half_width = student_t_95(rates.len() - 1) * (variance / count).sqrt();
    Some(Jitter { rate, half_width, steps: BLOCK * blocks })
}
