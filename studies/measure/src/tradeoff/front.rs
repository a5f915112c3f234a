//! The Pareto front: the runs that no other run beats in both error and cost. A failed run is not among them.

use super::{CostMeasure, Row};

/// The front of these rows, from the cheapest to the most accurate.
pub fn front(rows: &[&Row], charge: CostMeasure) -> Vec<usize> {
    let offer = |i: usize| Some((i, charge.of(rows[i]).filter(|cost| cost.is_finite())?, rows[i].scored()?));
    let mut offers: Vec<(usize, f64, f64)> = (0..rows.len()).filter_map(offer).collect();
    offers.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut least = f64::INFINITY;
    offers.retain(|&(_, _, error)| {
        let better = error < least;
        least = least.min(error);
        better
    });
    offers.into_iter().map(|(i, ..)| i).collect()
}
