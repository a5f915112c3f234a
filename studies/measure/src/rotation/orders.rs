//! The error of every scheme on every rigid-body scene, and the order it falls with.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::rigid_body::{AttitudeUpdate, Formulation};
use integrator::{Real, Single};

use super::row::{Experiment, Row};
use crate::convergence::{Approach, RESOLVED, limit};
use crate::order::{Sample, local_order};
use crate::study::{Selection, distinct};
use scenes::any::AnyScene;
use scenes::erased::{AnyMotion, BodyMotion, ErasedPlace};
use scenes::errors::ExactSamples;
use scenes::observation::{Observation, Quantity};
use scenes::run::{Outcome, Precision, Run};
use scenes::scheme::{Rule, Scheme};
use scenes::variation::Leading;

/// Halvings of the coarsest step of a sweep; the step of the table is the third finest. A quick report takes them all: an
/// order is not seen in fewer, and they take a second.
const HALVINGS: u32 = 7;

/// Every scene of the selection that is a rigid body, every scheme, every step.
pub fn measure(selection: &Selection, schemes: &[Scheme]) -> Vec<Row> {
    let scenes: Vec<&dyn AnyScene> = selection.scenes.iter().map(AsRef::as_ref).filter(|s| s.is_rigid()).collect();
    let known: Vec<Known> = scenes.iter().map(|&scene| Known::of(scene, selection.end_s(scene))).collect();
    let of_scene = |(&scene, known)| schemes.iter().map(move |&scheme| (known, scene, scheme));
    let jobs: Vec<(&Known, &dyn AnyScene, Scheme)> = scenes.iter().zip(&known).flat_map(of_scene).collect();
    let cost = |(_, _, scheme): &(&Known, &dyn AnyScene, Scheme)| if scheme.is_implicit() { 50 } else { 1 };
    selection.rows(&jobs, 7.6e-5, cost, |&(known, scene, scheme)| {
        sweep(scene, known, scheme, &selection.sweep(scene, 1..=HALVINGS))
    })
}

/// What is known of a scene before it is run.
struct Known {
    end_s: f64,
    exact: Observation,
    leading: Vec<Leading>,
    /// |J (omega x I omega)| T^2 / 2 at most: by how much a body that lacks the term is turned wrongly, rad.
    without: f64,
    /// By how much a body turns at most, rad, and at least 1; times what an unstable motion makes of a rounding.
    turned: f64,
}

impl Known {
    fn of(scene: &dyn AnyScene, end_s: f64) -> Self {
        let exact = scene.exact(fx128::lit(end_s));
        let samples = ExactSamples::of(scene, end_s);
        let rates = samples.samples().iter().map(|seen| seen.scale(Quantity::AngularVelocity));
        let amplified = scene.scene().amplification(end_s);
        let turned = (rates.fold(0.0, f64::max) * end_s).max(1.0) * amplified;
        let without = 0.5 * gyroscopic(scene, end_s) * end_s * end_s;
        Known { end_s, exact, leading: scene.leading(end_s), without, turned }
    }

    /// lim error / h^p of theory: of what stores the world's angular velocity, and of semi-implicit Euler in either frame.
    fn constant(&self, scheme: Scheme, quantity: Quantity) -> Option<&Leading> {
        let Rule::General(method) = scheme.rule else { return None };
        let is_known = match scheme.storage {
            Formulation::WorldOmega => method.order() == 1 || scheme.update == AttitudeUpdate::Exponential,
            Formulation::BodyOmega => method == MethodId::SemiImplicitEuler,
            _ => false,
        };
        let of = |one: &&Leading| (one.method, one.quantity) == (method, quantity);
        self.leading.iter().find(of).filter(|_| is_known)
    }
}

/// The largest |J (omega x I omega)| along the exact motion, rad/s^2.
fn gyroscopic(scene: &dyn AnyScene, end_s: f64) -> f64 {
    fn largest<P: ErasedPlace>(body: BodyMotion<'_, P>, end_s: f64) -> f64 {
        let inertia = body.inertia();
        let at = |k: u32| {
            let omega = body.exact(end_s * f64::from(k) / 32.0).omega_body;
            // By differences of the moments: a sphere has none.
            let (i, w) = (inertia, omega);
            let turned = [(i.z - i.y) * w.y * w.z, (i.x - i.z) * w.z * w.x, (i.y - i.x) * w.x * w.y];
            nalgebra::Vector3::from(turned).component_div(&inertia).norm()
        };
        (0..=32).map(at).fold(0.0, f64::max)
    }
    match scene.any_motion() {
        AnyMotion::Pivoted(body) => largest(body, end_s),
        AnyMotion::Flying(body) => largest(body, end_s),
        _ => 0.0,
    }
}

fn sweep(scene: &dyn AnyScene, known: &Known, scheme: Scheme, all_steps: &[u64]) -> Vec<Row> {
    all_steps.iter().flat_map(|&steps| errors(scene, known, scheme, steps)).collect()
}

fn errors(scene: &dyn AnyScene, known: &Known, scheme: Scheme, steps: u64) -> Vec<Row> {
    let end_s = known.end_s;
    let Some(run) = scene.run(&Run::new(scheme, Precision::F64, end_s, steps), steps) else { return Vec::new() };
    let h_s = end_s / steps as f64;
    let row = Row::new(Experiment::Error, scene.id(), scheme, h_s, &run);
    let error = |quantity| Some(run.end()?.distances(&known.exact).iter().find(|(q, _)| *q == quantity)?.1);
    let is_wrong = scheme.lacks_gyroscopic_term() && known.without > 0.0;
    let order = if is_wrong { 0.0 } else { f64::from(scheme.order()) };
    let exact = scene.scene().has_constant_angular_acceleration() && scheme.facts().worked_out && scheme.order() > 1;
    [Quantity::Attitude, Quantity::AngularVelocity]
        .map(|quantity| Row {
            t_s: end_s,
            theory: if is_wrong {
                Some(known.without)
            } else {
                known.constant(scheme, quantity).map(|c| c.end * h_s.powf(order))
            },
            tolerance: if exact {
                Some(EXACT * known.turned)
            } else {
                known.constant(scheme, quantity).map(|c| c.doubt * h_s.powf(order))
            },
            theory_order: (!exact).then_some(order),
            ..row.measured(quantity.id(), quantity.unit(), error(quantity))
        })
        .into()
}

/// What a sweep shows.
#[derive(Clone, Debug)]
pub struct ObservedOrder {
    /// Scene.
    pub subject: String,
    /// Scheme.
    pub scheme: String,
    /// Quantity.
    pub quantity: String,
    /// Order between the finest two errors above rounding, extrapolated to h = 0; `None` where every error is rounding.
    pub order: Option<f64>,
    /// The order that theory predicts; 0 where the model is wrong, `None` where there is no error but rounding.
    pub theory_order: Option<f64>,
    /// Whether the errors are what theory says; `None` where they do not tell.
    pub agrees: Option<bool>,
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

/// Errors this many times above it show an order: what rounding adds to it is then small, also where a motion multiplies it.
const CLEAR: f64 = 8.0;

/// What every sweep among the rows shows.
pub fn orders(rows: &[Row]) -> Vec<ObservedOrder> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.experiment == Experiment::Error).collect();
    let key = |row: &Row| (row.subject.clone(), row.scheme.clone(), row.quantity.clone());
    let keys = distinct(rows.iter().map(|row| key(row)));
    keys.iter().map(|k| seen(&rows.iter().copied().filter(|row| key(row) == *k).collect::<Vec<_>>())).collect()
}

fn seen(sweep: &[&Row]) -> ObservedOrder {
    let first = sweep[0];
    let points: Vec<(f64, f64)> = sweep.iter().filter_map(|row| Some((row.h_s, row.value?))).collect();
    let above: Vec<(f64, f64)> = points.iter().copied().filter(|(_, e)| *e > CLEAR * FLOOR).collect();
    let local: Vec<f64> = above.windows(2).filter_map(|w| local_order(w[0], w[1])).collect();
    // p(h) = p + c h: halving h halves what is wrong with it.
    let order = match local[..] {
        [.., coarse, fine] => Some((2.0 * fine - coarse, (fine - coarse).abs())),
        _ => None,
    };
    let steps = (first.t_s / first.h_s).round();
    ObservedOrder {
        subject: first.subject.clone(),
        scheme: first.scheme.clone(),
        quantity: first.quantity.clone(),
        order: order.map(|o| o.0),
        theory_order: first.theory_order,
        agrees: agrees(sweep, order, &points),
        doubt: order.map_or(0.0, |o| o.1),
        finest: points.last().map(|p| p.1),
        reference: points.iter().rev().nth(2).map(|&(h, e)| (e, h)),
        evaluations: first.evaluations as f64 / steps,
        finished: sweep.iter().all(|row| row.outcome == Outcome::Finished && row.value.is_some_and(f64::is_finite)),
    }
}

/// Largest accepted difference of an extrapolated order: the local order of a sweep is p + c h, what extrapolation leaves
/// is of the second order in h, and no scene of the list has a larger one than this at its finest steps.
pub const ORDER_TOLERANCE: f64 = 0.05;
/// Largest error of a motion that is reproduced exactly: 2^10 steps of a few roundings each, and as many for each radian.
const EXACT: f64 = 1e-12;

/// A change of the local order from one halving to the next by which a sweep is not in its limit.
const UNSETTLED: f64 = 0.3;

/// Whether a sweep shows what theory says: its order; the constant of it, where that is known; at least its order where it is not.
fn agrees(sweep: &[&Row], extrapolated: Option<(f64, f64)>, points: &[(f64, f64)]) -> Option<bool> {
    let (order, doubt) = (extrapolated.map(|o| o.0), extrapolated.map_or(0.0, |o| o.1));
    let first = sweep[0];
    // A run that failed with a long step says nothing of shorter ones.
    let finished = sweep.iter().rev().take(3).all(|row| row.outcome == Outcome::Finished);
    let finest = points.last().map(|p| p.1);
    let Some(p) = first.theory_order else {
        let allowed = first.tolerance.unwrap_or(EXACT);
        return Some(finished && finest.is_some_and(|error| error <= allowed));
    };
    if !finished || points.len() < 3 {
        return if first.outcome == Outcome::Finished { Some(false) } else { None };
    }
    let near = order.is_some_and(|q| (q - p).abs() <= ORDER_TOLERANCE);
    if p == 0.0 {
        // A model that is hardly wrong is seen only below the errors of its method.
        let is_seen = first.theory.zip(finest).is_some_and(|(without, e)| without.min(1.0) > 16.0 * e.max(FLOOR));
        let falls = order.is_some_and(|q| q >= HALF) && doubt <= UNSETTLED;
        return if near { Some(true) } else { (is_seen && falls).then_some(false) };
    }
    if points.iter().all(|(_, e)| *e <= FLOOR) {
        return Some(true);
    }
    let doubted = sweep.last().and_then(|row| Some(row.tolerance? / row.h_s.powf(p))).unwrap_or(0.0);
    let constant = sweep.last().and_then(|row| Some(row.theory? / row.h_s.powf(p)));
    let samples: Vec<Sample> = points.iter().map(|&(h_s, e)| Sample { h_s, error: Some(e), floor: 0.0 }).collect();
    let limit = limit(&samples, p, Approach::Smooth, |_| FLOOR / 16.0);
    // A body that points anywhere is too far off for its errors to say anything.
    if finest.is_none_or(|error| error > SMALL_ANGLE) {
        return None;
    }
    match (constant, limit) {
        (Some(constant), Some(limit)) => {
            let allowed = limit.bound + doubted + 1e-9 * constant;
            let resolved = allowed <= RESOLVED * constant.max(limit.value.abs());
            let right = (limit.value.abs() - constant).abs() <= allowed;
            // A next term that outweighs the first hides it.
            let is_in_its_limit = order.is_some_and(|q| (q - p).abs() < HALF);
            if right || (resolved && is_in_its_limit) { Some(right) } else { None }
        }
        // Local orders that differ by so much are none. A lower order is lower by one, in three pairs of runs; what is nearer has
        // not arrived.
        _ => {
            let is_lower = |w: &[(f64, f64)]| local_order(w[0], w[1]).is_some_and(|order| order <= p - HALF);
            let lower = points.windows(2).rev().take(3).all(is_lower);
            match order.filter(|_| doubt <= UNSETTLED) {
                Some(q) if q >= p - ORDER_TOLERANCE => Some(true),
                Some(_) if lower => Some(false),
                _ => None,
            }
        }
    }
}

/// The largest error of an attitude that an order is read from, rad.
const SMALL_ANGLE: f64 = 0.1;
/// Half an order: a sweep that is farther off its order is not in its limit, or has another order.
const HALF: f64 = 0.5;
