//! What the rows show, against theory. No claim is made about a time: times are not the same twice.

use integrator::methods::MethodId;
use reports::Claim;

use super::candidate::Candidate;
use super::comparison_tables::question_row;
use super::rounding_optimum::{Minimum, minima};
use super::verdict::comparisons;
use super::{CostMeasure, Part, Row};
use crate::claim::{self, Evidence};
use crate::study::{distinct, short};

pub(super) fn all(rows: &[Row]) -> Vec<Claim> {
    let mut claims = evaluations(rows);
    claims.extend(question(rows));
    claims.extend(rows.iter().filter(|row| row.part == Part::Stagnation).map(stagnation));
    claims.extend(minima(rows).iter().filter(|minimum| is_judged(minimum)).flat_map(rounding_optimum));
    claims
}

fn claim(id: &str, texts: [String; 4], evidence: impl IntoIterator<Item = Evidence>) -> Claim {
    claim::claim("tradeoff", id, texts, evidence)
}

/// The evaluations of every finished run of an explicit method are those of its formula.
fn evaluations(rows: &[Row]) -> Vec<Claim> {
    let runs: Vec<&Row> = rows.iter().filter(|row| row.part == Part::Run).collect();
    let one = |method: String| {
        let expected = Candidate::from_id(&method)?.evaluations_a_step()?;
        // A run that failed has not taken all its steps.
        let finished = |row: &&&Row| row.method == method && row.scored().is_some();
        let of_method: Vec<&&Row> = runs.iter().filter(finished).collect();
        let is_right = |row: &&Row| expected.checked_mul(row.steps) == Some(row.evaluations);
        let wrong = of_method.iter().filter(|row| !is_right(row)).count();
        let texts = [
            format!("{method} evaluates the force {expected} times a step"),
            format!("{expected} a step"),
            format!("{wrong} of {} runs differ", of_method.len()),
            "none differs".to_owned(),
        ];
        Some(claim(&format!("evaluations.{method}"), texts, of_method.iter().map(|row| Evidence::is(is_right(row)))))
    };
    distinct(runs.iter().map(|row| row.method.clone())).into_iter().filter_map(one).collect()
}

/// The error at which the question is put: a centimetre, or half a degree.
const QUESTION: f64 = 1e-2;
/// On fewer scenes 'most' says nothing.
const MANY: usize = 10;

/// Whether RK4 is worth its four evaluations: to an error E an order p needs about E^(-1/p) of them.
fn question(rows: &[Row]) -> Option<Claim> {
    let line = question_row(&comparisons(rows, CostMeasure::Evaluations), QUESTION, CostMeasure::Evaluations);
    let (known, cheaper) = (line.rk4_known, line.rk4_beats_semi_implicit);
    let texts = [
        format!("at an error of {QUESTION} RK4 costs fewer evaluations than semi-implicit Euler on most scenes"),
        "evaluations to an error E grow as E^(-1/p), with p = 1 and 4".to_owned(),
        format!("{cheaper} of {known}"),
        "more than half the scenes on which the sweeps tell".to_owned(),
    ];
    (known >= MANY).then(|| {
        claim("semi-implicit-or-rk4", texts, [Evidence::is(2 * cheaper > known)])
            .with_numbers([cheaper as f64, known as f64])
    })
}

/// Roundings on the way to the first increment: of h, of g h and of g h^2, each of eps / 2, and the width of the bracket.
const ROUNDINGS: f64 = 4.0;

fn stagnation(row: &Row) -> Claim {
    let slack = ROUNDINGS * row.precision.epsilon();
    let [low, high, theory] = [row.at_rest_h_s, row.moving_h_s, row.theory_h_s].map(|x| x.unwrap_or(f64::NAN));
    let height = row.position_m.unwrap_or(f64::NAN);
    let texts = [
        format!(
            "a body at rest at {height} m begins to fall only with a step above sqrt(ulp / 2g), in {}",
            row.precision.id()
        ),
        format!("{theory:.6e} s"),
        format!("between {low:.6e} s and {high:.6e} s"),
        format!("within {ROUNDINGS} eps"),
    ];
    let holds = low <= theory * (1.0 + slack) && high >= theory * (1.0 - slack) && high - low <= slack * high;
    claim(&format!("stagnation.{}.{height}", row.precision.id()), texts, [Evidence::is(holds)])
}

/// The yardsticks, and of a rigid body what is stored in the body frame.
fn is_judged(minimum: &Minimum) -> bool {
    use MethodId::{Rk4, SemiImplicitEuler, VelocityVerlet};
    let method = Candidate::from_id(&minimum.method).filter(|_| !minimum.method.ends_with("/world-omega"));
    let is_yardstick = |m| matches!(m, SemiImplicitEuler | VelocityVerlet | Rk4);
    scenes::by_id(&minimum.scene).is_ok_and(|scene| scene.scene().rounding_accumulates())
        && method.and_then(Candidate::method).is_some_and(is_yardstick)
}

/// The grid of steps is one of powers of two, and near the bottom of the curve two errors may cancel or add.
const GRID: f64 = 2.0;

fn rounding_optimum(minimum: &Minimum) -> Vec<Claim> {
    let Minimum { scene, method, precision, .. } = minimum;
    let (fewest, most) = (minimum.biased_steps / GRID, minimum.random_steps * GRID);
    let steps = minimum.steps as f64;
    let (least, largest) = (minimum.random_error / GRID, minimum.biased_error * GRID);
    let id = |what: &str| format!("rounding-optimum.{scene}.{method}.{}.{what}", precision.id());
    vec![
        claim(
            &id("steps"),
            [
                format!(
                    "the best step of {method} on {scene} in {} is where truncation meets rounding",
                    precision.id()
                ),
                format!("{:.0} .. {:.0} steps", minimum.biased_steps, minimum.random_steps),
                format!("{steps} steps"),
                format!("{fewest:.0} .. {most:.0}: a factor of 2, the grid of steps"),
            ],
            [Evidence::within(Some(steps), [fewest, most])],
        )
        .on(scene)
        .by(method),
        claim(
            &id("error"),
            [
                format!(
                    "the least error of {method} on {scene} in {} is that of truncation and rounding",
                    precision.id()
                ),
                format!("{} .. {}", short(Some(minimum.random_error)), short(Some(minimum.biased_error))),
                short(Some(minimum.error)),
                format!("{} .. {}", short(Some(least)), short(Some(largest))),
            ],
            [Evidence::within(Some(minimum.error), [least, largest])],
        )
        .on(scene)
        .by(method),
    ]
}
