//! The dampings that a file may have: those that are given, and those that its loss of speed suggests.

use nalgebra::Vector3;

use super::damping::{Damping, Rule, When};
use super::steps_per_row;
use crate::clock::Clock;
use crate::finding::quantile;
use crate::trajectory::Trajectory;

/// No damping, and every rule with the coefficient that is given.
pub(super) fn given(c: Option<f64>) -> Vec<Option<Damping>> {
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
pub(super) fn dampings(
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
