//! Which terms does a scene need? Models from the least to the full one, against the full exact motion.

pub mod ladders;
mod show;

use faer::fx128;
use integrator::Real;
use integrator::methods::MethodId;
use reports::{Claim, Figure, Verdict};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::study::{Derived, Selection, Study, distinct, short};
use crate::sweep::in_parallel;
use ladders::{Ladder, METHODS, Rung};
use scenes::run::Outcome;

/// Halvings of the coarsest step.
const HALVINGS: u32 = 10;

/// The error of one model with one method and step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Ladder: the scene, and what is asked of it where there are two.
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
        let chosen =
            |ladder: &Ladder| selection.scenes.iter().any(|scene| without_preset(scene.id()) == base(ladder.name));
        let ladders: Vec<Ladder> = ladders::all().into_iter().filter(chosen).collect();
        let halvings = if selection.quick { HALVINGS - 2 } else { HALVINGS };
        in_parallel(&ladders, |_| 1, &selection.progress, |ladder| climb(ladder, halvings)).concat()
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

fn climb(ladder: &Ladder, halvings: u32) -> Vec<Row> {
    let info = ladder.scene.scene().info();
    let exact = ladder.scene.exact(fx128::lit(info.horizon_s));
    let mut rows = Vec::new();
    for rung in &ladder.rungs {
        for method in METHODS {
            for k in 0..=halvings {
                let steps = info.coarsest_steps << k;
                let Some(end) = (rung.run)(method, info.horizon_s, steps) else { continue };
                let distances = end.seen.as_ref().map(|seen| exact.distances(seen)).unwrap_or_default();
                let error =
                    distances.iter().find(|(q, _)| *q == ladder.quantity).map(|(_, d)| *d).filter(|d| d.is_finite());
                rows.push(Row {
                    scene: ladder.name.to_owned(),
                    model: rung.model.to_owned(),
                    consistent: rung.consistent,
                    method: method.id().to_owned(),
                    h_s: info.horizon_s / steps as f64,
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

fn operations(rung: &Rung, method: MethodId) -> u64 {
    (rung.operations)(method).unwrap_or(0)
}

/// What the sweep of one model with one method shows.
#[derive(Clone, Debug)]
pub struct Seen {
    /// Ladder.
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
    /// Order between the two finest steps whose errors are above rounding, or `None` where all are rounding.
    pub order: Option<f64>,
    /// The largest step from which on the error stays within a tenth of its value at the finest, s.
    pub plateau_h_s: Option<f64>,
    /// Operations of one step.
    pub operations_a_step: u64,
    /// Evaluations of the force law in one step.
    pub evaluations_a_step: f64,
}

/// Errors below this are rounding: 2^13 steps of a few units in the last place of numbers of the order of 10.
const FLOOR: f64 = 1e-11;

/// What every sweep among the rows shows, in their order.
pub fn rungs(rows: &[Row]) -> Vec<Seen> {
    let key = |row: &Row| (row.scene.clone(), row.model.clone(), row.method.clone());
    distinct(rows.iter().map(key))
        .iter()
        .map(|k| seen(&rows.iter().filter(|row| key(row) == *k).collect::<Vec<_>>()))
        .collect()
}

fn seen(sweep: &[&Row]) -> Seen {
    let first = sweep[0];
    let finest = sweep.last().and_then(|row| row.error);
    let above: Vec<(f64, f64)> =
        sweep.iter().filter_map(|row| Some((row.h_s, row.error.filter(|e| *e > FLOOR)?))).collect();
    let order = match above[..] {
        [.., a, b] => Some((a.1 / b.1).log2() / (a.0 / b.0).log2()),
        _ => None,
    };
    let near = |row: &&&Row| finest.zip(row.error).is_some_and(|(f, e)| (e / f - 1.0).abs() <= 0.1);
    Seen {
        scene: first.scene.clone(),
        model: first.model.clone(),
        consistent: first.consistent,
        method: first.method.clone(),
        unit: first.unit.clone(),
        finest,
        order,
        plateau_h_s: sweep.iter().rev().take_while(near).last().map(|row| row.h_s),
        operations_a_step: first.operations / first.steps,
        evaluations_a_step: first.evaluations as f64 / first.steps as f64,
    }
}

/// A consistent model: its error falls, or is rounding. An inconsistent one: the last halving does not change the error. That is
/// seen with RK4, whose own error is far below that of the model; where a model is nearly right, as a small angle is for a small
/// swing, the error of a method of order 1 still covers it.
fn claim(seen: &Seen) -> Option<Claim> {
    if !seen.consistent && seen.method != MethodId::Rk4.id() {
        return None;
    }
    let id = format!("adequacy.{}.{}.{}", seen.scene, seen.model, seen.method).replace(' ', "-");
    let (statement, theory, bound, holds) = if seen.consistent {
        let holds = seen.finest.is_some_and(|e| e <= FLOOR) || seen.order.is_some_and(|p| p >= LEAST_ORDER);
        ("converges to the full motion", "order 1 or more, or exact", format!("order at least {LEAST_ORDER}"), holds)
    } else {
        let holds = seen.finest.is_some_and(|e| e > FLOOR) && seen.order.is_some_and(|p| p.abs() <= LARGEST_ORDER);
        (
            "is inconsistent: its error does not fall with the step",
            "order 0",
            format!("|order| at most {LARGEST_ORDER}"),
            holds,
        )
    };
    Some(Claim {
        id,
        study: "adequacy".to_owned(),
        statement: format!("'{}' with {} on {} {statement}", seen.model, seen.method, seen.scene),
        theory: theory.to_owned(),
        measured: format!("order {}, error {} {} at the finest step", short(seen.order), short(seen.finest), seen.unit),
        bound,
        verdict: Verdict::from_comparison(holds),
    })
}

/// Order 1, less what the next term of the error takes at the finest step.
const LEAST_ORDER: f64 = 0.95;
/// Order 0, and what RK4's own error adds at the finest step: less than a thousandth of the model's.
const LARGEST_ORDER: f64 = 0.001;
