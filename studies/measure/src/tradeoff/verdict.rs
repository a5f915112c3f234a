//! 'Semi-implicit Euler does its job pretty well in most cases, so that RK4 and implicit Euler are not worth it': on which scenes,
//! at which error?

use std::cmp::Ordering;

use integrator::methods::MethodId;

use super::cost_at_error::{CostBound, LEVELS, of_rule, prices};
use super::{CostMeasure, Part, Row};
use crate::study::distinct;

/// The prices of one level on one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The scene.
    pub scene: String,
    /// The level, m or rad.
    pub level: f64,
    /// The measure of cost.
    pub charge: CostMeasure,
    /// Semi-implicit Euler.
    pub semi_implicit: CostBound,
    /// RK4.
    pub rk4: CostBound,
    /// Implicit Euler.
    pub implicit: CostBound,
    /// The cheapest of all.
    pub best: Option<super::cost_at_error::CostAtError>,
}

/// Prices within this factor of each other are level: times have noise, and prices are interpolated.
pub const LEVEL_WITH: f64 = 1.1;

/// Every level on every scene, by one measure of cost.
pub fn comparisons(rows: &[Row], charge: CostMeasure) -> Vec<Comparison> {
    let runs: Vec<&Row> = rows.iter().filter(|row| row.part == Part::Run).collect();
    let mut comparisons = Vec::new();
    for scene in distinct(runs.iter().map(|row| row.scene.as_str())) {
        let of_scene: Vec<&Row> = runs.iter().copied().filter(|row| row.scene == scene).collect();
        for level in LEVELS {
            let of = |method: MethodId| of_rule(&of_scene, level, charge, method.id());
            comparisons.push(Comparison {
                scene: scene.to_owned(),
                level,
                charge,
                semi_implicit: of(MethodId::SemiImplicitEuler),
                rk4: of(MethodId::Rk4),
                implicit: of(MethodId::ImplicitEuler),
                best: prices(&of_scene, level, charge).into_iter().next(),
            });
        }
    }
    comparisons
}

/// By what factor an offer is dearer than another; only a lower bound where its sweep ends above the level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Factor {
    /// So many times.
    Of(f64),
    /// At least so many times.
    AtLeast(f64),
    /// No step does it.
    Never,
}

/// The price of `a` over that of `b`; `None` where that of `b` is not known.
pub fn factor(a: &CostBound, b: &CostBound) -> Option<Factor> {
    let CostBound::At(b) = b else { return None };
    Some(match a {
        CostBound::At(a) => Factor::Of(a.cost / b.cost),
        CostBound::Above(a) => Factor::AtLeast(a.cost / b.cost),
        CostBound::Never => Factor::Never,
    })
}

/// What is known of the price of one offer over that of another: it lies between the two, and is known where they are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// At least so many times.
    pub low: f64,
    /// At most so many times.
    pub high: f64,
}

impl Between {
    /// The price of `a` over that of `b`. A sweep that ends above the level bounds its price from below, one whose coarsest run
    /// meets it from above, and what never meets it has none.
    pub fn of(a: &CostBound, b: &CostBound) -> Self {
        let bounds = |offer: &CostBound| match offer {
            CostBound::At(price) if price.is_at_most => (0.0, price.cost),
            CostBound::At(price) => (price.cost, price.cost),
            CostBound::Above(price) => (price.cost, f64::INFINITY),
            CostBound::Never => (f64::INFINITY, f64::INFINITY),
        };
        let ((a_low, a_high), (b_low, b_high)) = (bounds(a), bounds(b));
        let or = |quotient: f64, unknown: f64| if quotient.is_nan() { unknown } else { quotient };
        Between { low: or(a_low / b_high, 0.0), high: or(a_high / b_low, f64::INFINITY) }
    }

    /// Whether it is greater than 1, less or the same; `None` where the bounds leave that open.
    pub fn beside_one(self) -> Option<Ordering> {
        let [low, high] = [self.low, self.high].map(|x| x.total_cmp(&1.0));
        (low == high || low.is_gt()).then_some(low)
    }
}

impl Comparison {
    /// By what factor semi-implicit Euler is beaten by the best; `None` where nothing reaches the level.
    pub fn beaten_by(&self) -> Option<Factor> {
        factor(&self.semi_implicit, &CostBound::At(self.best.clone()?))
    }

    /// Whether semi-implicit Euler is the cheapest, or level with it.
    pub fn semi_implicit_is_best(&self) -> bool {
        matches!(self.beaten_by(), Some(Factor::Of(factor)) if factor <= LEVEL_WITH)
    }
}

impl Factor {
    /// In a table: `4.2`, `> 170`.
    pub fn show(self) -> String {
        let digits = |x: f64| if x < 10.0 { format!("{x:.1}") } else { format!("{x:.0}") };
        match self {
            Factor::Of(x) => digits(x),
            Factor::AtLeast(x) => format!("> {}", digits(x)),
            Factor::Never => "never".to_owned(),
        }
    }
}
