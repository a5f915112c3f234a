//! Which terms does a scene need? Models from the least to the full one, against the full exact motion.

pub mod hierarchies;
mod show;

use faer::fx128;
use integrator::Real;
use integrator::methods::MethodId;
use reports::{Claim, Figure};
use serde::{Deserialize, Serialize};

use crate::claim;
use crate::claim::{Evidence, largest};
use crate::error::Error;
use crate::order::local_order;
use crate::study::{Derived, Selection, Study, check_method, check_steps, distinct, short};
use hierarchies::{Level, METHODS, ModelHierarchy};
use scenes::run::Outcome;

/// Halvings of the coarsest step.
const HALVINGS: u32 = 10;

/// The error of one model with one method and step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Model hierarchy: the scene, and what is asked of it where there are two.
    pub scene: String,
    /// What is modelled, or left out.
    pub model: String,
    /// Whether the model's motion is the scene's.
    pub consistent: bool,
    /// Method.
    pub method: String,
    /// Step, s.
    pub h_s: f64,
    /// Number of steps.
    pub steps: u64,
    /// Quantity whose error it is.
    pub quantity: String,
    /// Unit of the error.
    pub unit: String,
    /// Distance from the full exact motion at the end.
    pub error: Option<f64>,
    /// How the run ended.
    pub outcome: Outcome,
    /// Evaluations of the force law.
    pub evaluations: u64,
    /// Arithmetic operations of the run.
    pub operations: u64,
}

/// The study.
pub struct Adequacy;

impl Study for Adequacy {
    type Row = Row;
    const ID: &'static str = "adequacy";
    const HEEDS: &'static [&'static str] = &["steps", "for"];
    const ABOUT: &'static str =
        "Compares models of a scene, from the least to the full one, with the full exact motion";
    const EXAMPLES: &'static str = "adequacy --scene heavy-top
        adequacy --scene pendulum --scene kepler --out /tmp/adequacy";
    const TITLE: &'static str = "Which terms does a scene need?";
    const INTRO: &'static str = "A model that leaves a term out saves work in every step, and is wrong by an amount that no \
        step size mends. For each scene models are set beside each other, from the least to the full one, and compared with the \
        full exact motion. Where a curve goes flat the model is the error, and a smaller step is wasted. An inconsistent model has \
        no order of convergence: it is named as such.";

    fn measure(selection: &Selection) -> Vec<Row> {
        let chosen = |ladder: &ModelHierarchy| {
            selection.scenes.iter().any(|scene| without_preset(scene.id()) == base(ladder.name))
        };
        let hierarchies: Vec<ModelHierarchy> = hierarchies::all(&selection.scenes).into_iter().filter(chosen).collect();
        let halvings = if selection.quick { HALVINGS - 2 } else { HALVINGS };
        selection.rows(&hierarchies, 4e-3, |_| 1, |ladder| climb(ladder, selection, halvings))
    }
    fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
        show::tables(rows)
    }
    fn figures(rows: &[Row]) -> Vec<Figure> {
        show::figures(rows)
    }
    fn claims(rows: &[Row]) -> Vec<Claim> {
        rungs(rows).iter().filter_map(claim).collect()
    }
    fn check(row: &Row) -> Result<(), String> {
        if !scenes::IDS.iter().any(|id| without_preset(id) == base(&row.scene)) {
            return Err(format!("scene '{}' is unknown", row.scene));
        }
        check_method(&row.method, METHODS.iter().any(|method| method.id() == row.method))?;
        check_steps(row.steps, row.h_s)
    }
}

/// The scene of a ladder.
fn base(ladder: &str) -> &str {
    match ladder {
        "pendulum-1-mrad" => "pendulum",
        name => name.split(' ').next().unwrap_or(name),
    }
}

fn without_preset(id: &str) -> &str {
    id.split('/').next().unwrap_or(id)
}

fn climb(ladder: &ModelHierarchy, selection: &Selection, halvings: u32) -> Vec<Row> {
    let scene = ladder.scene.as_ref();
    let end_s = selection.end_s(scene);
    let exact = scene.exact(fx128::lit(end_s));
    let mut rows = Vec::new();
    for rung in &ladder.rungs {
        for method in METHODS.into_iter().filter(|method| selection.methods.contains(method)) {
            for steps in selection.sweep(scene, 0..=halvings) {
                let Some(end) = (rung.run)(method, end_s, steps) else { continue };
                let distances = end.seen.as_ref().map(|seen| exact.distances(seen)).unwrap_or_default();
                let error =
                    distances.iter().find(|(q, _)| *q == ladder.quantity).map(|(_, d)| *d).filter(|d| d.is_finite());
                rows.push(Row {
                    scene: ladder.name.to_owned(),
                    model: rung.model.to_owned(),
                    consistent: rung.consistent,
                    method: method.id().to_owned(),
                    h_s: end_s / steps as f64,
                    steps,
                    quantity: ladder.quantity.id().to_owned(),
                    unit: ladder.quantity.unit().to_owned(),
                    error,
                    outcome: if end.seen.is_some() { Outcome::Finished } else { Outcome::Diverged },
                    evaluations: end.evaluations,
                    operations: operations(rung, method) * steps,
                });
            }
        }
    }
    rows
}

fn operations(rung: &Level, method: MethodId) -> u64 {
    (rung.operations)(method).unwrap_or(0)
}

/// What the sweep of one model with one method shows.
#[derive(Clone, Debug)]
pub struct ObservedOrder {
    /// Model hierarchy.
    pub scene: String,
    /// Model.
    pub model: String,
    /// Whether it is said to be consistent.
    pub consistent: bool,
    /// Method.
    pub method: String,
    /// Unit of the errors.
    pub unit: String,
    /// Error at the finest step.
    pub finest: Option<f64>,
    /// Error of the full model by the same method at the finest step.
    pub full: Option<f64>,
    /// Largest error of the sweep: the size of what is seen.
    pub scale: f64,
    /// Order between the two finest steps whose errors are above rounding, or `None` where all are rounding.
    pub order: Option<f64>,
    /// The same one halving earlier.
    pub order_before: Option<f64>,
    /// The largest step from which on the error stays within a tenth of its value at the finest, s.
    pub plateau_h_s: Option<f64>,
    /// Operations of one step.
    pub operations_a_step: u64,
    /// Evaluations of the force law in one step.
    pub evaluations_a_step: f64,
    /// Whether every run finished with an error.
    pub finished: bool,
}

/// Errors below this are rounding: 2^13 steps of a few units in the last place of numbers of the order of 10.
const FLOOR: f64 = 1e-11;

/// What every sweep among the rows shows, in their order.
pub fn rungs(rows: &[Row]) -> Vec<ObservedOrder> {
    let key = |row: &Row| (row.scene.clone(), row.model.clone(), row.method.clone());
    distinct(rows.iter().map(key))
        .iter()
        .map(|k| {
            let full = rows.iter().rfind(|row| (&row.scene, &row.method, row.model.as_str()) == (&k.0, &k.2, "full"));
            let seen = seen(&rows.iter().filter(|row| key(row) == *k).collect::<Vec<_>>());
            ObservedOrder { full: full.and_then(|row| row.error), ..seen }
        })
        .collect()
}

fn seen(sweep: &[&Row]) -> ObservedOrder {
    let first = sweep[0];
    let finest = sweep.last().and_then(|row| row.error);
    let above: Vec<(f64, f64)> =
        sweep.iter().filter_map(|row| Some((row.h_s, row.error.filter(|e| *e > FLOOR)?))).collect();
    let order = above.last_chunk().and_then(|[coarse, fine]| local_order(*coarse, *fine));
    let order_before = above.last_chunk().and_then(|[coarse, fine, _]| local_order(*coarse, *fine));
    let near = |row: &&&Row| finest.zip(row.error).is_some_and(|(f, e)| (e / f - 1.0).abs() <= 0.1);
    ObservedOrder {
        scene: first.scene.clone(),
        model: first.model.clone(),
        consistent: first.consistent,
        method: first.method.clone(),
        unit: first.unit.clone(),
        finest,
        full: None,
        scale: largest(sweep.iter().map(|row| row.error)).unwrap_or(f64::NAN),
        order,
        order_before,
        plateau_h_s: sweep.iter().rev().take_while(near).last().map(|row| row.h_s),
        operations_a_step: first.operations.checked_div(first.steps).unwrap_or(0),
        evaluations_a_step: first.evaluations as f64 / first.steps as f64,
        // Two sweeps under one name have steps that go back.
        finished: sweep.iter().all(|row| row.outcome == Outcome::Finished && row.error.is_some_and(f64::is_finite))
            && sweep.windows(2).all(|pair| pair[0].steps < pair[1].steps),
    }
}

/// A consistent model: its error falls with the order of the method, or is rounding. An inconsistent one: the last halving does
/// not change the error. That is seen with RK4, whose own error is far below that of the model; where a model is nearly right, as
/// a small angle is for a small swing, the error of a method of order 1 still covers it.
fn claim(seen: &ObservedOrder) -> Option<Claim> {
    if !seen.consistent && seen.method != MethodId::Rk4.id() {
        return None;
    }
    let id = format!("{}.{}.{}", seen.scene, seen.model, seen.method).replace(' ', "-");
    let rounding = seen.finest.is_some_and(|error| (0.0..=FLOOR * seen.scale.max(1.0)).contains(&error));
    let (statement, theory, bound, evidence) = if seen.consistent {
        let theory = "order 1 or more, or exact".to_owned();
        ("converges to the full motion", theory, format!("order at least {LEAST_ORDER}"), converges(seen, rounding))
    } else {
        // A model without an error leaves nothing out of this motion.
        let order = Evidence::near(seen.order, Some(0.0), LARGEST_ORDER);
        (
            "is inconsistent: its error does not fall with the step",
            "order 0".to_owned(),
            format!("|order| at most {LARGEST_ORDER}"),
            if rounding && seen.order.is_none() { Evidence::Undecided } else { order },
        )
    };
    let texts = [
        format!("'{}' with {} on {} {statement}", seen.model, seen.method, seen.scene),
        theory,
        format!("order {}, error {} {} at the finest step", short(seen.order), short(seen.finest), seen.unit),
        bound,
    ];
    // A run that failed is too coarse for its method: a fault of the model is not seen.
    let is_open = !seen.finished || (evidence == Evidence::Outside && hides(seen));
    let evidence = if is_open { Evidence::Undecided } else { evidence };
    let claim = claim::claim("adequacy", &id, texts, [evidence]);
    Some(claim.on(base(&seen.scene)).by(&seen.method))
}

/// Whether the errors of a model fall with the step. They do not if the last two halvings hardly change them; between that and a whole
/// order the steps are too long to say, or the error is about to change its sign.
fn converges(seen: &ObservedOrder, rounding: bool) -> Evidence {
    let is_flat = |order: Option<f64>| order.is_some_and(|order| order.abs() < FLAT);
    match seen.order {
        _ if rounding => Evidence::Inside,
        Some(order) if order >= LEAST_ORDER => Evidence::Inside,
        Some(order) if order.is_nan() => Evidence::Outside,
        // So small an error may be rounding of a motion that goes far.
        _ if seen.finest.is_some_and(|error| error <= HIDDEN) => Evidence::Undecided,
        _ if is_flat(seen.order) && is_flat(seen.order_before) => Evidence::Outside,
        _ => Evidence::Undecided,
    }
}

/// An order below this is none.
const FLAT: f64 = 0.2;

/// Whether a wrong model is too little wrong to be seen beside rounding, or beside the error that the method makes on the full model.
fn hides(seen: &ObservedOrder) -> bool {
    let beside = |e: f64| e <= HIDDEN || seen.full.is_some_and(|full| full < e && e <= full / LARGEST_ORDER);
    !seen.consistent && seen.finest.is_some_and(beside)
}

/// The error of a model that rounding can hide, m or rad.
const HIDDEN: f64 = 1e-7;

/// Order 1, less what the next term of the error takes at the finest step.
const LEAST_ORDER: f64 = 0.95;
/// Order 0, and what RK4's own error adds at the finest step: less than a thousandth of the model's.
const LARGEST_ORDER: f64 = 0.001;
