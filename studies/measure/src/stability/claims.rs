//! What the rows show, against theory.

use reports::Claim;

use super::bisect::WIDTH;
use super::failure::Failure;
use super::limits::UNSEEN;
use super::maps::{self, Grid, boundary_distance};
use super::models::{Scheme, modulus, stability_function};
use super::spin::{FACTOR_TOLERANCE, STEPS, SpinScheme};
use super::tables::limit_words;
use super::{Part, Row};
use crate::claim::{self, Evidence, largest};
use crate::study::distinct;
use scenes::run::Precision;

/// The widest bracket that counts, in parts of its upper end.
const BRACKET: f64 = 0.01;
/// How well a growth rate must agree with theory, relative: rounding adds one part in 1e16 a step, the direction is the
/// eigenvector's to 1e-15.
const RATE: f64 = 1e-6;
/// How far the boundary of a map may lie from theory's curve, in cells: the boundary is known to half a cell on either side.
pub const ONE_CELL: f64 = 1.0;

/// All claims, in the order of the parts.
pub fn all(rows: &[Row]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for row in rows {
        claims.extend(match row.part {
            Part::Limit => Some(limit(row)),
            Part::GrowthRate => Some(rate(row)),
            Part::Unconditional => Some(unconditional(row)),
            Part::QuadraticDrag => Some(drag(row)),
            Part::BlowUp => Some(blow_up(row)),
            _ => None,
        });
    }
    claims.extend(damped_maps(rows));
    claims.extend(spin_maps(rows));
    claims.extend(regions(rows));
    claims.extend(pictures(rows));
    claims
}

fn claim(id: &str, texts: [String; 4], evidence: impl IntoIterator<Item = Evidence>) -> Claim {
    claim::claim("stability", id, texts, evidence)
}

/// Whether the bracket of a row says what theory says, and is narrow enough.
pub fn bracket_agrees(row: &Row) -> bool {
    let Some(theory) = row.theory else { return false };
    let closed_form_agrees = row.closed_form.is_none_or(|closed| {
        // The matrix loses the root of the rounding errors where an eigenvalue is double: 1e-7 in its radius.
        closed == theory || (closed / theory - 1.0).abs() <= 1e-5
    });
    closed_form_agrees
        && match (row.low, row.high) {
            (None, Some(_)) => theory == 0.0,
            (Some(_), None) => theory == f64::INFINITY,
            (Some(low), Some(high)) => {
                // A step that lies so little beyond the limit is not seen to fail.
                let unseen = 1.0 + UNSEEN * row.value.unwrap_or(WIDTH);
                contains(low / unseen, high, theory, row.precision) && high - low <= widest(row) * high
            }
            (None, None) => false,
        }
}

/// The widest bracket that counts for a limit: where light damping leaves less growth than the longest run shows, it is wider.
fn widest(row: &Row) -> f64 {
    row.value.map_or(BRACKET, |width| width * BRACKET / WIDTH)
}

/// Parameters and the step are rounded to the precision of the run: so is the limit.
fn contains(low: f64, high: f64, theory: f64, precision: Precision) -> bool {
    let slack = 8.0 * precision.epsilon() * theory;
    // An infinite limit lies in no bracket, whatever its slack.
    theory.is_finite() && low - slack <= theory && theory <= high + slack
}

fn bracket_words(row: &Row) -> String {
    match (row.low, row.high) {
        (Some(low), Some(high)) => format!("{low:.5} .. {high:.5}"),
        (None, Some(high)) => format!("fails at {high} already"),
        (Some(low), None) => format!("holds at {low} still"),
        (None, None) => "not measured".to_owned(),
    }
}

fn limit(row: &Row) -> Claim {
    let texts = [
        format!("the largest stable step of {} on {} in {}", row.method, row.scene, row.precision.id()),
        row.theory.map_or_else(|| "unknown".to_owned(), limit_words),
        bracket_words(row),
        format!("the bracket contains it and is narrower than {:.0} %", 100.0 * widest(row)),
    ];
    // Growth beyond the limit that is too slow for every run decides nothing.
    let is_tested = row.low.is_some() || row.high.is_some();
    let id = format!("limit.{}.{}.{}", row.scene, row.method, row.precision.id());
    let numbers = [row.low, row.high].into_iter().flatten();
    claim(&id, texts, [if is_tested { Evidence::is(bracket_agrees(row)) } else { Evidence::Undecided }])
        .on(&row.scene)
        .by(&row.method)
        .with_numbers(numbers)
}

/// A number in words, where there is one.
fn number(x: Option<f64>, unit: &str) -> String {
    x.map_or_else(|| "not measured".to_owned(), |x| format!("{x:.12e} {unit}"))
}

fn rate(row: &Row) -> Claim {
    let z = row.h_omega.unwrap_or(f64::NAN);
    let texts = [
        format!("growth of {} on {} at {z} time scales a step", row.method, row.scene),
        number(row.theory, "a step"),
        number(row.measured, "a step"),
        format!("relative difference at most {RATE:.0e}"),
    ];
    let ratio = row.measured.zip(row.theory).map(|(measured, theory)| measured / theory);
    claim(&format!("rate.{}.{}.{z}", row.scene, row.method), texts, [Evidence::near(ratio, Some(1.0), RATE)])
        .on(&row.scene)
        .by(&row.method)
}

fn unconditional(row: &Row) -> Claim {
    let z = row.h_omega.unwrap_or(f64::NAN);
    // One step solves a system whose matrix has condition 1 + z^2 in these coordinates.
    let tolerance = 16.0 * f64::EPSILON * (1.0 + z * z);
    let texts = [
        format!("{} of {} at h omega = {z}", row.quantity, row.method),
        number(row.theory, &row.unit),
        number(row.measured, &row.unit),
        format!("difference at most {tolerance:.1e}"),
    ];
    let evidence = [Evidence::near(row.measured, row.theory, tolerance)];
    claim(&format!("unconditional.{}.{}.{z}", row.method, row.unit), texts, evidence).by(&row.method)
}

fn drag(row: &Row) -> Claim {
    let holds = row.low.zip(row.high).zip(row.theory).is_some_and(|((low, high), theory)| {
        contains(low, high, theory, row.precision) && high - low <= BRACKET * high
    });
    let texts = [
        format!("the largest {} of explicit Euler", row.quantity),
        row.theory.map_or_else(String::new, limit_words),
        bracket_words(row),
        format!("the bracket contains it and is narrower than {:.0} %", 100.0 * BRACKET),
    ];
    claim(&format!("quadratic-drag.{}", row.quantity.replace(' ', "-")), texts, [Evidence::is(holds)])
        .on("quadratic-drag")
}

fn blow_up(row: &Row) -> Claim {
    let h = row.h_s.unwrap_or(f64::NAN);
    let bound = row.theory.unwrap_or(f64::NAN);
    let texts = [
        format!("a free thin body blows up in finite time with h = {h} s"),
        format!("not before {bound:.4} s"),
        format!("{:.4} s, {}", row.measured.unwrap_or(f64::NAN), row.failure),
        "after the bound, at an accelerating pace, and before a thousand times it".to_owned(),
    ];
    let in_time = Evidence::within(row.measured, [bound, 1000.0 * bound]);
    claim(&format!("blow-up.{h}"), texts, [in_time, Evidence::is(row.failure == Failure::FiniteTimeBlowUp)])
}

/// The grid that the cells of a map were measured on: in full, or with a third of the cells each way. `None` where a cell is
/// missing or in another place.
fn grid_of(rows: &[&Row], full: Grid) -> Option<Grid> {
    let is_at = |row: &Row, x: f64, y: f64| row.h_omega == Some(x) && row.value == Some(y);
    [full, full.coarse()].into_iter().find(|grid| {
        let place = |k: usize| (grid.x_at(k % grid.nx), grid.y_at(k / grid.nx));
        rows.len() == grid.nx * grid.ny && (0..).zip(rows).all(|(k, row)| is_at(row, place(k).0, place(k).1))
    })
}

/// The measured map of a scheme as (h omega, zeta, bounded); `None` where a cell is not measured.
fn damped_cells(rows: &[&Row]) -> Option<Vec<(f64, f64, bool)>> {
    let bounded = |row: &Row| row.measured.filter(|x| *x == 0.0 || *x == 1.0).map(|x| x == 1.0);
    rows.iter().map(|row| Some((row.h_omega?, row.value?, bounded(row)?))).collect()
}

/// Largest distance of a damped oscillator's map from a theory, in cells; the rows are those of one scheme. `None` where a cell
/// is missing.
pub fn damped_distance(rows: &[&Row], theory: impl Fn(f64) -> f64) -> Option<f64> {
    Some(boundary_distance(&damped_cells(rows)?, &grid_of(rows, maps::DAMPED)?, theory))
}

/// The rows of one part, method by method.
fn by_method(rows: &[Row], part: Part) -> Vec<(&str, Vec<&Row>)> {
    let of_part = || rows.iter().filter(|row| row.part == part);
    let methods = distinct(of_part().map(|row| row.method.as_str()));
    methods.into_iter().map(|method| (method, of_part().filter(|row| row.method == method).collect())).collect()
}

/// The largest of some numbers in words.
fn at_most(x: Option<f64>, words: impl Fn(f64) -> String) -> String {
    x.map_or_else(|| "a cell is missing".to_owned(), words)
}

fn damped_maps(rows: &[Row]) -> Vec<Claim> {
    by_method(rows, Part::DampedMap)
        .into_iter()
        .map(|(method, cells)| {
            let scheme = Scheme::ALL.into_iter().find(|scheme| scheme.id() == method);
            let distance = scheme.and_then(|scheme| damped_distance(&cells, |zeta| scheme.limit(zeta)));
            let title = scheme.map_or(method, |scheme| scheme.title());
            let texts = [
                format!("the boundary of {title} on the damped oscillator lies on theory's curve"),
                "the limit in h omega as a function of zeta".to_owned(),
                at_most(distance, |x| format!("at most {x:.2} cells away")),
                format!("at most {ONE_CELL} cell"),
            ];
            claim(&format!("map.damped.{method}"), texts, [Evidence::within(distance, [0.0, ONE_CELL])])
        })
        .collect()
}

fn spin_maps(rows: &[Row]) -> Vec<Claim> {
    by_method(rows, Part::SpinMap)
        .into_iter()
        .map(|(method, cells)| {
            let scheme = SpinScheme::ALL.into_iter().find(|scheme| scheme.id() == method);
            let worst = largest(cells.iter().map(|row| {
                // Measured is a nutation after several steps; one that has died out is lost in rounding.
                let [measured, theory] = [row.measured?, row.theory?].map(|factor| factor.powi(STEPS));
                Some((measured - theory).abs() / theory.max(1.0) / f64::from(STEPS))
            }));
            let texts = [
                format!("nutation factor in one step: {}", scheme.map_or(method, |scheme| scheme.title())),
                "the factor of the linearised spin".to_owned(),
                at_most(worst, |x| format!("largest difference {x:.1e}")),
                format!("at most {FACTOR_TOLERANCE:.0e} in every cell"),
            ];
            let evidence =
                [Evidence::within(worst, [0.0, FACTOR_TOLERANCE]), Evidence::is(grid_of(&cells, maps::SPIN).is_some())];
            claim(&format!("map.spin.{method}"), texts, evidence)
        })
        .collect()
}

fn regions(rows: &[Row]) -> Vec<Claim> {
    by_method(rows, Part::Region)
        .into_iter()
        .map(|(method, cells)| {
            let worst = largest(cells.iter().filter(|row| !is_pole(row)).map(|row| {
                let (measured, theory) = row.measured.zip(row.theory)?;
                Some((measured - theory).abs() / theory.max(1.0))
            }));
            let texts = [
                format!("one step of {method} multiplies y' = lambda y by |R(h lambda)| over the complex plane"),
                "the stability function".to_owned(),
                at_most(worst, |x| format!("largest difference {x:.1e}")),
                format!("at most {REGION_TOLERANCE:.0e}"),
            ];
            let evidence = [
                Evidence::within(worst, [0.0, REGION_TOLERANCE]),
                Evidence::is(grid_of(&cells, maps::REGION).is_some()),
            ];
            claim(&format!("map.region.{method}"), texts, evidence)
        })
        .collect()
}

/// Whether a cell lies at a pole of R, where there is nothing to compare.
fn is_pole(row: &Row) -> bool {
    let method = maps::ONE_STEP.into_iter().find(|method| method.id() == row.method);
    let at = method.zip(row.h_omega.zip(row.value));
    at.is_some_and(|(method, z)| !(modulus(stability_function(method, z)) < POLE))
}

/// A step of at most 4 stages, or one linear system, near a pole: a few hundred roundings.
const REGION_TOLERANCE: f64 = 1e-12;

/// At a pole of R there is nothing to compare.
const POLE: f64 = 1e6;

/// The failure that each picture has to show.
const SHOWN: [(&str, Failure); 9] = [
    ("exponential-growth", Failure::ExponentialGrowth),
    ("finite-time-blow-up", Failure::FiniteTimeBlowUp),
    ("wrong-frequency", Failure::WrongFrequency),
    ("flipped-axis", Failure::FlippedAxis),
    ("aliasing", Failure::Aliasing),
    ("oscillating-decay", Failure::OscillatingDecay),
    ("newton-not-converging", Failure::NewtonNotConverging),
    ("order-lost", Failure::OrderLost),
    ("drift", Failure::Drift),
];

fn pictures(rows: &[Row]) -> Vec<Claim> {
    SHOWN
        .into_iter()
        .filter_map(|(id, wanted)| {
            let curves = rows.iter().filter(|row| row.part == Part::Picture && row.scene == id);
            let seen = distinct(curves.map(|row| row.failure));
            let words: Vec<&str> = seen.iter().map(|failure| failure.words()).collect();
            let texts = [
                format!("the run of the picture '{id}' is seen to fail in this way"),
                wanted.to_string(),
                words.join("; "),
                "one curve shows it".to_owned(),
            ];
            let shown = Evidence::is(seen.contains(&wanted));
            (!seen.is_empty()).then(|| claim(&format!("picture.{id}"), texts, [shown]))
        })
        .collect()
}

// A bracket is searched to a width that leaves room below the widest that counts.
const _: () = assert!(WIDTH < BRACKET);
