//! Rounding in f32 and f64: how it scales with epsilon and grows with the number of steps.
//!
//! The same run in two arithmetics commits roundings of the same distribution, in units of epsilon, and the motion carries them
//! along alike. So rounding / epsilon is the same in both but for scatter: the epsilon law. Its growth with the number n of steps
//! is n^0 where only parameters and start are rounded or where the motion forgets, n^(1/2) for independent roundings and n^1 for
//! roundings that go one way.
//! Source: P. Henrici, Discrete Variable Methods in Ordinary Differential Equations (1962), 1.4.

use reports::Claim;

use super::Row;
use crate::claim::{Evidence, claim};
use crate::study::distinct;
use scenes::observation::Quantity;
use scenes::run::{Outcome, Precision};

/// Largest |mean log2| of the ratio of rounding / epsilon in f32 and in f64. Over the 26 runs of a sweep the scatter of a mean is
/// 2.2 / sqrt(26) if they are independent; neighbouring steps are not. Arithmetic of f32 within f64 moves it by 29.
const BINARY_DIGITS: f64 = 4.0;
/// The exponent of n lies between 0 and 1, and this far outside for the scatter of ten runs.
const EXPONENT_SLACK: f64 = 0.75;
/// Fewest runs in which either is seen.
const FEWEST: usize = 12;

/// One finished run in both arithmetics.
struct Pair {
    quantity: Quantity,
    steps: f64,
    scale: f64,
    /// Largest rounding in f32 and f64, in epsilons; `None` where it was not measured.
    units: [Option<f64>; 2],
}

const PRECISIONS: [Precision; 2] = [Precision::F32, Precision::F64];

/// One claim a scene and method that was run in f32 and in f64.
pub(super) fn claims(rows: &[Row]) -> Vec<Claim> {
    let key = |row: &Row| (row.scene.clone(), row.method.clone());
    let sweeps = rows.chunk_by(|a, b| a.scene == b.scene && a.method == b.method);
    sweeps
        .filter(|rows| PRECISIONS.iter().all(|p| rows.iter().any(|row| row.precision == *p)))
        .map(|rows| {
            let (scene, method) = key(&rows[0]);
            judged(&scene, &method, &pairs(rows))
        })
        .collect()
}

fn pairs(rows: &[Row]) -> Vec<Pair> {
    let finished = |row: &&Row| row.outcome == Outcome::Finished;
    // A step longer than the time scale may be unstable: what it carries along is no law of the arithmetic.
    let is_fine = |row: &&Row| row.h_s <= row.time_scale_s;
    let in_f64 = rows.iter().filter(finished).filter(is_fine).filter(|row| row.precision == Precision::F64);
    let twin = |row: &Row| {
        let same = |other: &&Row| {
            other.precision == Precision::F32 && other.steps == row.steps && other.quantity == row.quantity
        };
        rows.iter().filter(finished).find(same)
    };
    in_f64
        .filter_map(|row| {
            let units = |row: &Row| row.rounding_max.filter(|x| *x >= 0.0).map(|x| x / row.precision.epsilon());
            let (quantity, steps, scale) = (row.quantity, row.steps as f64, row.scale);
            Some(Pair { quantity, steps, scale, units: [units(twin(row)?), units(row)] })
        })
        .collect()
}

fn judged(scene: &str, method: &str, pairs: &[Pair]) -> Claim {
    let measured = pairs.iter().all(|pair| pair.units.iter().all(Option::is_some));
    let ratios: Vec<f64> = pairs
        .iter()
        .filter_map(|pair| Some((log2(pair.units[0])?, log2(pair.units[1])?)))
        .map(|(a, b)| a - b)
        .collect();
    let exact = ratios.is_empty();
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    let exponents = [0, 1].map(|i| exponent(pairs, i));
    let texts = [
        format!("{method} on {scene} loses as many units in the last place in f32 as in f64, and more with more steps"),
        if exact { "no rounding in f64" } else { "the same; n^0 to n^1" }.to_owned(),
        if exact {
            format!(
                "{} runs of {} without rounding in f64",
                pairs.iter().filter(|p| p.units[1] == Some(0.0)).count(),
                pairs.len()
            )
        } else {
            let [f32, f64] = exponents.map(|p| p.map_or_else(|| "?".to_owned(), |p| format!("{p:.2}")));
            format!("2^{mean:.2} times as many; n^{f32} in f32, n^{f64} in f64")
        },
        format!("2^+-{BINARY_DIGITS}; n^{} to n^{}", -EXPONENT_SLACK, 1.0 + EXPONENT_SLACK),
    ];
    let mut evidence: Vec<Evidence> = Vec::new();
    if !measured {
        evidence.push(Evidence::Outside);
    }
    if exact {
        // A motion whose numbers have a form in 53 bits: what is lost is less than a unit a step, all of one sign.
        evidence.extend(pairs.iter().map(|pair| Evidence::within(pair.units[1], [0.0, pair.steps * pair.scale])));
    } else if ratios.len() < FEWEST {
        evidence.push(Evidence::Undecided);
    } else {
        evidence.push(Evidence::near(Some(mean), Some(0.0), BINARY_DIGITS));
        evidence.extend(exponents.map(|p| Evidence::within(p, [-EXPONENT_SLACK, 1.0 + EXPONENT_SLACK])));
    }
    claim("convergence", &format!("{scene}.{method}.rounding"), texts, evidence)
}

fn log2(units: Option<f64>) -> Option<f64> {
    units.filter(|x| *x > 0.0).map(f64::log2)
}

/// p of rounding ~ n^p, one line a quantity with a common slope.
fn exponent(pairs: &[Pair], precision: usize) -> Option<f64> {
    let (mut along, mut square) = (0.0, 0.0);
    for quantity in distinct(pairs.iter().map(|pair| pair.quantity)) {
        let of = pairs.iter().filter(|pair| pair.quantity == quantity);
        let points: Vec<(f64, f64)> =
            of.filter_map(|pair| Some((pair.steps.log2(), log2(pair.units[precision])?))).collect();
        let n = points.len() as f64;
        let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
        for p in points {
            along += (p.0 - x) * (p.1 - y);
            square += (p.0 - x) * (p.0 - x);
        }
    }
    (square > 0.0).then(|| along / square)
}
