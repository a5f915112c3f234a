//! The error of every scheme on every rigid-body scene, and the order it falls with.

use faer::fx128;
use integrator::{Real, Single};

use super::row::{Experiment, Row};
use super::scheme::Scheme;
use crate::study::{Selection, distinct};
use crate::sweep::in_parallel;
use scenes::any::AnyScene;
use scenes::observation::{Observation, Quantity};
use scenes::run::Outcome;

/// Halvings of the coarsest step of a sweep; the step of the table is the third finest. A quick report takes them all: an
/// order is not seen in fewer, and they take a second.
const HALVINGS: u32 = 7;

/// Every scene of the selection that is a rigid body, every scheme, every step.
pub fn measure(selection: &Selection, schemes: &[Scheme]) -> Vec<Row> {
    let scenes: Vec<&dyn AnyScene> = selection.scenes.iter().map(AsRef::as_ref).filter(|s| is_rigid(*s)).collect();
    let jobs: Vec<(&dyn AnyScene, Scheme)> =
        scenes.iter().flat_map(|&scene| schemes.iter().map(move |&scheme| (scene, scheme))).collect();
    let cost = |(_, scheme): &(&dyn AnyScene, Scheme)| if scheme.is_implicit() { 50 } else { 1 };
    in_parallel(&jobs, cost, &selection.progress, |&(scene, scheme)| sweep(scene, scheme)).concat()
}

/// Whether a scene is a rigid body whose rotation is looked at.
pub fn is_rigid(scene: &dyn AnyScene) -> bool {
    scene.exact(fx128::ZERO).rotation().is_some()
}

fn sweep(scene: &dyn AnyScene, scheme: Scheme) -> Vec<Row> {
    let info = scene.scene().info();
    let exact = scene.exact(fx128::lit(info.horizon_s));
    (1..=HALVINGS).flat_map(|k| errors(scene, scheme, info.coarsest_steps << k, info.horizon_s, &exact)).collect()
}

fn errors(scene: &dyn AnyScene, scheme: Scheme, steps: u64, end_s: f64, exact: &Observation) -> Vec<Row> {
    let Some(run) = scheme.run(scene, end_s, steps, steps) else { return Vec::new() };
    let row = Row::new(Experiment::Error, scene.id(), scheme, end_s / steps as f64, &run);
    let error = |quantity| Some(run.end()?.distances(exact).iter().find(|(q, _)| *q == quantity)?.1);
    [Quantity::Attitude, Quantity::AngularVelocity]
        .map(|quantity| Row { t_s: end_s, ..row.measured(quantity.id(), quantity.unit(), error(quantity)) })
        .into()
}

/// What a sweep shows.
#[derive(Clone, Debug)]
pub struct Seen {
    /// Scene.
    pub subject: String,
    /// Scheme.
    pub scheme: String,
    /// Quantity.
    pub quantity: String,
    /// Order between the finest two errors above rounding, extrapolated to h = 0; `None` where every error is rounding.
    pub order: Option<f64>,
    /// How far the extrapolation is trusted.
    pub doubt: f64,
    /// Error at the finest step.
    pub finest: Option<f64>,
    /// Error at the reference step, and the step, s.
    pub reference: Option<(f64, f64)>,
    /// Evaluations a step.
    pub evaluations: f64,
    /// Whether every run finished.
    pub finished: bool,
}

/// Errors below this are rounding: 2^10 steps of a few units in the last place each, and a thousandth of the smallest error used.
const FLOOR: f64 = 65_536.0 * <f64 as Single>::EPSILON;

/// What every sweep among the rows shows.
pub fn orders(rows: &[Row]) -> Vec<Seen> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.experiment == Experiment::Error).collect();
    let key = |row: &Row| (row.subject.clone(), row.scheme.clone(), row.quantity.clone());
    let keys = distinct(rows.iter().map(|row| key(row)));
    keys.iter().map(|k| seen(&rows.iter().copied().filter(|row| key(row) == *k).collect::<Vec<_>>())).collect()
}

fn seen(sweep: &[&Row]) -> Seen {
    let first = sweep[0];
    let points: Vec<(f64, f64)> = sweep.iter().filter_map(|row| Some((row.h_s, row.value?))).collect();
    let above: Vec<(f64, f64)> =
        points.iter().copied().filter(|(_, e)| *e > FLOOR).map(|(h, e)| (h.log2(), e.log2())).collect();
    let local: Vec<f64> = above.windows(2).map(|w| (w[0].1 - w[1].1) / (w[0].0 - w[1].0)).collect();
    // p(h) = p + c h: halving h halves what is wrong with it.
    let order = match local[..] {
        [.., coarse, fine] => Some((2.0 * fine - coarse, (fine - coarse).abs())),
        _ => None,
    };
    let steps = (first.t_s / first.h_s).round();
    Seen {
        subject: first.subject.clone(),
        scheme: first.scheme.clone(),
        quantity: first.quantity.clone(),
        order: order.map(|o| o.0),
        doubt: order.map_or(0.0, |o| o.1),
        finest: points.last().map(|p| p.1),
        reference: points.iter().rev().nth(2).map(|&(h, e)| (e, h)),
        evaluations: first.evaluations as f64 / steps,
        finished: sweep.iter().all(|row| row.outcome == Outcome::Finished),
    }
}
