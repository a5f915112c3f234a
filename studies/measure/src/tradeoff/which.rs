//! Which method when: for each kind of scene and each error the method that does the least work, and how long its step may be.
//!
//! It follows from the rows alone. Errors are relative to the size of the motion, so that scenes of metres and of radians can be
//! put together; steps are parts of the scene's own time scale; work is counted in evaluations of the force law, in f64.

use integrator::methods::MethodId;
use scenes::scene::Kind;

use super::cells::{OfScene, by_scene};
use super::cost_at_error::{CostAtError, CostBound, of_rule, prices};
use super::verdict::{Factor, factor};
use super::{CostMeasure, Row};
use crate::study::distinct;

/// The errors asked for, relative to the largest size of the configuration: |x|, an angle, 1 for an attitude.
pub const ERRORS: [f64; 3] = [1e-2, 1e-3, 1e-6];

/// The method for one kind of scene and one error.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The kind of scene.
    pub kind: Kind,
    /// The error asked for, relative to the size of the motion.
    pub error: f64,
    /// Scenes of this kind among the rows.
    pub scenes: usize,
    /// The method; `None` where no method reaches the error on any of them.
    pub best: Option<Best>,
}

/// What is known of the method that was chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Best {
    /// Method, on a rigid body with what is stored.
    pub method: String,
    /// On how many of the scenes it reaches the error.
    pub reached: usize,
    /// The largest step that reaches the error on all of these, as a part of the scene's time scale.
    pub step: f64,
    /// Whether the coarsest run keeps the error already, so that the step may be longer still.
    pub step_is_at_least: bool,
    /// Its work over that of semi-implicit Euler for the same error, the geometric mean over the scenes on which both are known.
    pub work: Option<f64>,
    /// Whether the work is only an upper bound.
    pub work_is_at_most: bool,
    /// On how many of the scenes semi-implicit Euler does not reach the error with any step.
    pub never: usize,
}

/// What one method needs on one scene.
struct Need {
    method: String,
    /// Work over that of the cheapest method.
    over_cheapest: f64,
    step: f64,
    is_at_most: bool,
    beside_semi_implicit: Option<Factor>,
}

/// The choice for each kind among the rows and each error of [`ERRORS`].
pub fn choices(rows: &[Row]) -> Vec<Choice> {
    let kind = |scene: &OfScene<'_>| scenes::by_id(scene.scene).ok().map(|scene| scene.scene().info().kind);
    let all: Vec<_> = by_scene(rows).into_iter().map(|scene| (kind(&scene), scene)).collect();
    let of_kind = |kind| {
        let scenes: Vec<_> = all.iter().filter(|(own, _)| *own == Some(kind)).map(|(_, scene)| scene).collect();
        (!scenes.is_empty()).then(|| ERRORS.map(|error| choice(&scenes, kind, error)))
    };
    Kind::ALL.into_iter().filter_map(of_kind).flatten().collect()
}

fn choice(scenes: &[&OfScene<'_>], kind: Kind, error: f64) -> Choice {
    let needs: Vec<Need> = scenes.iter().flat_map(|scene| needs(scene, error)).collect();
    let methods = distinct(needs.iter().map(|need| need.method.as_str()));
    let mut best: Option<Best> = None;
    let mut least = f64::INFINITY;
    for method in methods {
        let own: Vec<&Need> = needs.iter().filter(|need| need.method == method).collect();
        let dearer = geometric_mean(own.iter().map(|need| need.over_cheapest)).unwrap_or(f64::INFINITY);
        let reached = best.as_ref().map_or(0, |best| best.reached);
        if own.len() > reached || (own.len() == reached && dearer < least) {
            least = dearer;
            best = best_of(method, &own);
        }
    }
    Choice { kind, error, scenes: scenes.len(), best }
}

/// What each method needs for the error, of those that reach it.
fn needs(scene: &OfScene<'_>, error: f64) -> Vec<Need> {
    let level = error * scene.scale;
    let work = CostMeasure::Evaluations;
    let all = prices(&scene.runs, level, work);
    let Some(cheapest) = all.first().map(|price| price.cost) else { return Vec::new() };
    let semi_implicit = of_rule(&scene.runs, level, work, MethodId::SemiImplicitEuler.id());
    let need = |price: CostAtError| Need {
        over_cheapest: price.cost / cheapest,
        step: price.h_s / scene.time_scale_s,
        is_at_most: price.is_at_most,
        beside_semi_implicit: factor(&semi_implicit, &CostBound::At(price.clone())),
        method: price.method,
    };
    all.into_iter().map(need).collect()
}

fn best_of(method: &str, needs: &[&Need]) -> Option<Best> {
    let shortest = needs.iter().min_by(|a, b| a.step.total_cmp(&b.step))?;
    let beside: Vec<Factor> = needs.iter().filter_map(|need| need.beside_semi_implicit).collect();
    let known = beside.iter().filter_map(|factor| match factor {
        Factor::Of(times) | Factor::AtLeast(times) => Some(1.0 / times),
        Factor::Never => None,
    });
    Some(Best {
        method: method.to_owned(),
        reached: needs.len(),
        step: shortest.step,
        step_is_at_least: shortest.is_at_most,
        work: geometric_mean(known),
        work_is_at_most: needs.iter().any(|need| need.is_at_most)
            || beside.iter().any(|factor| matches!(factor, Factor::AtLeast(_))),
        never: beside.iter().filter(|factor| **factor == Factor::Never).count(),
    })
}

fn geometric_mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let logs: Vec<f64> = values.map(f64::ln).collect();
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}
