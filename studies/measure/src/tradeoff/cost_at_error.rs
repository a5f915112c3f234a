//! What an error level costs with each method: the coarsest run from which on the error stays below it.

use super::{CostMeasure, Row};
use crate::study::distinct;
use scenes::run::Precision;

/// Errors at which prices are compared, in m or rad.
pub const LEVELS: [f64; 5] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-6];
/// Halvings beyond a run that have to meet the level too, where the sweep has them: an error that passes through zero meets it
/// by luck.
const DEPTH: usize = 2;

/// The price of a level with one method and precision.
#[derive(Clone, Debug, PartialEq)]
pub struct CostAtError {
    /// Method, on a rigid body with what is stored.
    pub method: String,
    /// The rule of a step alone.
    pub rule: &'static str,
    /// Arithmetic.
    pub precision: Precision,
    /// Step, s.
    pub h_s: f64,
    /// In the unit of the charge.
    pub cost: f64,
    /// Whether the coarsest run of the sweep meets the level already, so that the price may be lower still.
    pub is_at_most: bool,
}

/// What a level costs with one sweep.
#[derive(Clone, Debug, PartialEq)]
pub enum CostBound {
    /// The level is met.
    At(CostAtError),
    /// It is not met by any step down to the finest run, whose error still falls: it costs more than this.
    Above(CostAtError),
    /// It cannot be met: rounding, or a failure.
    Never,
}

/// The sweeps of one scene: rows of one method and precision, from the coarsest step to the finest.
pub fn sweeps<'a>(rows: &[&'a Row]) -> Vec<Vec<&'a Row>> {
    distinct(rows.iter().map(|row| (row.method.as_str(), row.precision)))
        .into_iter()
        .map(|(method, precision)| {
            let mut sweep: Vec<&Row> =
                rows.iter().copied().filter(|r| r.method == method && r.precision == precision).collect();
            sweep.sort_by_key(|row| row.steps);
            sweep
        })
        .collect()
}

/// The price of a level, interpolated between the last run that misses it and the first that meets it.
pub fn offer(sweep: &[&Row], level: f64, charge: CostMeasure) -> CostBound {
    let meets = |i: usize| sweep[i].scored().is_some_and(|error| error <= level);
    let stays = |i: usize| (i..sweep.len().min(i + 1 + DEPTH)).all(meets);
    let Some(first) = (0..sweep.len()).find(|&i| stays(i)) else { return beyond(sweep, charge) };
    let Some(mut price) = price(sweep[first], charge) else { return CostBound::Never };
    if first == 0 {
        price.is_at_most = true;
        return CostBound::At(price);
    }
    let coarser = sweep[first - 1];
    let (Some(above), Some(below)) = (coarser.scored(), sweep[first].scored()) else { return CostBound::At(price) };
    if let Some(cost) = charge.of(coarser).filter(|_| above > level && below > 0.0) {
        let part = (above / level).ln() / (above / below).ln();
        price.cost = cost * (price.cost / cost).powf(part);
        price.h_s = coarser.h_s * (price.h_s / coarser.h_s).powf(part);
    }
    CostBound::At(price)
}

/// A sweep that ends above the level: it costs more, if the error falls still.
fn beyond(sweep: &[&Row], charge: CostMeasure) -> CostBound {
    let falls = matches!(sweep, [.., a, b] if a.scored().zip(b.scored()).is_some_and(|(a, b)| b < 0.75 * a));
    match sweep.last().and_then(|row| price(row, charge)).filter(|_| falls) {
        Some(price) => CostBound::Above(price),
        None => CostBound::Never,
    }
}

fn price(row: &Row, charge: CostMeasure) -> Option<CostAtError> {
    let candidate = super::candidate::Candidate::from_id(&row.method)?;
    Some(CostAtError {
        method: row.method.clone(),
        rule: candidate.rule_id(),
        precision: row.precision,
        h_s: row.h_s,
        cost: charge.of(row)?,
        is_at_most: false,
    })
}

/// The prices of a level on one scene, the cheapest first.
pub fn prices(rows: &[&Row], level: f64, charge: CostMeasure) -> Vec<CostAtError> {
    let at = |sweep: Vec<&Row>| match offer(&sweep, level, charge) {
        CostBound::At(price) => Some(price),
        _ => None,
    };
    let mut prices: Vec<CostAtError> = sweeps(rows).into_iter().filter_map(at).collect();
    prices.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    prices
}

/// The least price of a level with one rule, whatever is stored and in whatever arithmetic.
pub fn of_rule(rows: &[&Row], level: f64, charge: CostMeasure, rule: &str) -> CostBound {
    let mut best = CostBound::Never;
    for sweep in sweeps(rows) {
        let offer = offer(&sweep, level, charge);
        let better = match (&offer, &best) {
            (CostBound::At(new), CostBound::At(old)) | (CostBound::Above(new), CostBound::Above(old)) => {
                new.rule == rule && new.cost < old.cost
            }
            (CostBound::At(new), _) | (CostBound::Above(new), CostBound::Never) => new.rule == rule,
            _ => false,
        };
        if better {
            best = offer;
        }
    }
    best
}
