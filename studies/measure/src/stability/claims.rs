//! What the rows show, against theory.

use reports::{Claim, Verdict};

use super::bisect::WIDTH;
use super::failure::Failure;
use super::maps::{self, Grid, boundary_distance};
use super::models::Scheme;
use super::spin::{FACTOR_TOLERANCE, STEPS, SpinScheme};
use super::tables::limit_words;
use super::{Part, Row};
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

fn claim(id: &str, statement: String, theory: String, measured: String, bound: String, holds: bool) -> Claim {
    let study = "stability".to_owned();
    Claim {
        id: format!("stability.{id}"),
        study,
        statement,
        theory,
        measured,
        bound,
        verdict: Verdict::from_comparison(holds),
    }
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
            (Some(low), Some(high)) => contains(low, high, theory, row.precision) && high - low <= BRACKET * high,
            (None, None) => false,
        }
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
    claim(
        &format!("limit.{}.{}.{}", row.scene, row.method, row.precision.id()),
        format!("the largest stable step of {} on {} in {}", row.method, row.scene, row.precision.id()),
        row.theory.map_or_else(|| "unknown".to_owned(), limit_words),
        bracket_words(row),
        format!("the bracket contains it and is narrower than {:.0} %", 100.0 * BRACKET),
        bracket_agrees(row),
    )
}

fn rate(row: &Row) -> Claim {
    let (measured, theory) = (row.measured.unwrap_or(f64::NAN), row.theory.unwrap_or(f64::NAN));
    let z = row.h_omega.unwrap_or(f64::NAN);
    claim(
        &format!("rate.{}.{}.{z}", row.scene, row.method),
        format!("growth of {} on {} at {z} time scales a step", row.method, row.scene),
        format!("{theory:.12e} a step"),
        format!("{measured:.12e} a step"),
        format!("relative difference at most {RATE:.0e}"),
        (measured / theory - 1.0).abs() <= RATE,
    )
}

fn unconditional(row: &Row) -> Claim {
    let (measured, theory) = (row.measured.unwrap_or(f64::NAN), row.theory.unwrap_or(f64::NAN));
    let z = row.h_omega.unwrap_or(f64::NAN);
    // One step solves a system whose matrix has condition 1 + z^2 in these coordinates.
    let tolerance = 16.0 * f64::EPSILON * (1.0 + z * z);
    claim(
        &format!("unconditional.{}.{}.{z}", row.method, row.unit),
        format!("{} of {} at h omega = {z}", row.quantity, row.method),
        format!("{theory:.12e} {}", row.unit),
        format!("{measured:.12e} {}", row.unit),
        format!("difference at most {tolerance:.1e}"),
        (measured - theory).abs() <= tolerance,
    )
}

fn drag(row: &Row) -> Claim {
    let holds = row.low.zip(row.high).zip(row.theory).is_some_and(|((low, high), theory)| {
        contains(low, high, theory, row.precision) && high - low <= BRACKET * high
    });
    claim(
        &format!("quadratic-drag.{}", row.quantity.replace(' ', "-")),
        format!("the largest {} of explicit Euler", row.quantity),
        row.theory.map_or_else(String::new, limit_words),
        bracket_words(row),
        format!("the bracket contains it and is narrower than {:.0} %", 100.0 * BRACKET),
        holds,
    )
}

fn blow_up(row: &Row) -> Claim {
    let (measured, bound) = (row.measured.unwrap_or(f64::NAN), row.theory.unwrap_or(f64::NAN));
    claim(
        &format!("blow-up.{}", row.h_s.unwrap_or(f64::NAN)),
        format!("a free thin body blows up in finite time with h = {} s", row.h_s.unwrap_or(f64::NAN)),
        format!("not before {bound:.4} s"),
        format!("{measured:.4} s, {}", row.failure),
        "after the bound, at an accelerating pace, and before a thousand times it".to_owned(),
        measured >= bound && measured <= 1000.0 * bound && row.failure == Failure::FiniteTimeBlowUp,
    )
}

/// The grid that the cells of a map were measured on.
fn grid_of(rows: &[&Row], full: Grid) -> Grid {
    if rows.len() == full.nx * full.ny { full } else { full.coarse() }
}

/// The measured map of a scheme as (h omega, zeta, bounded).
fn damped_cells(rows: &[&Row]) -> Vec<(f64, f64, bool)> {
    rows.iter().filter_map(|row| Some((row.h_omega?, row.value?, row.measured? > 0.5))).collect()
}

/// Largest distance of a damped oscillator's map from a theory, in cells; the rows are those of one scheme.
pub fn damped_distance(rows: &[&Row], theory: impl Fn(f64) -> f64) -> f64 {
    boundary_distance(&damped_cells(rows), &grid_of(rows, maps::DAMPED), theory)
}

fn damped_maps(rows: &[Row]) -> Vec<Claim> {
    let of = |scheme: Scheme| -> Vec<&Row> {
        rows.iter().filter(|row| row.part == Part::DampedMap && row.method == scheme.id()).collect()
    };
    let present = Scheme::ALL.into_iter().map(|scheme| (scheme, of(scheme))).filter(|(_, cells)| !cells.is_empty());
    present
        .map(|(scheme, cells)| {
            let distance = damped_distance(&cells, |zeta| scheme.limit(zeta));
            claim(
                &format!("map.damped.{}", scheme.id()),
                format!("the boundary of {} on the damped oscillator lies on theory's curve", scheme.title()),
                "the limit in h omega as a function of zeta".to_owned(),
                format!("at most {distance:.2} cells away"),
                format!("at most {ONE_CELL} cell"),
                distance <= ONE_CELL,
            )
        })
        .collect()
}

fn spin_maps(rows: &[Row]) -> Vec<Claim> {
    SpinScheme::ALL
        .into_iter()
        .filter_map(|scheme| {
            let cells = rows.iter().filter(|row| row.part == Part::SpinMap && row.method == scheme.id());
            let worst = cells
                .filter_map(|row| {
                    // Measured is a nutation after several steps; one that has died out is lost in rounding.
                    let [measured, theory] = [row.measured?, row.theory?].map(|factor| factor.powi(STEPS));
                    Some((measured - theory).abs() / theory.max(1.0) / f64::from(STEPS))
                })
                // NaN is the worst.
                .reduce(|a, b| if b.is_nan() || b > a { b } else { a })?;
            Some(claim(
                &format!("map.spin.{}", scheme.id()),
                format!("nutation factor in one step: {}", scheme.title()),
                "the factor of the linearised spin".to_owned(),
                format!("largest difference {worst:.1e}"),
                format!("at most {FACTOR_TOLERANCE:.0e} in every cell"),
                worst <= FACTOR_TOLERANCE,
            ))
        })
        .collect()
}

fn regions(rows: &[Row]) -> Vec<Claim> {
    let cells = || rows.iter().filter(|row| row.part == Part::Region);
    distinct(cells().map(|row| row.method.as_str()))
        .into_iter()
        .map(|method| {
            let worst = cells()
                .filter(|row| row.method == method && row.theory.is_some_and(|r| r < POLE))
                .filter_map(|row| Some((row.measured? - row.theory?).abs() / row.theory?.max(1.0)))
                .fold(0.0_f64, |a, b| if b.is_nan() { f64::INFINITY } else { a.max(b) });
            claim(
                &format!("map.region.{method}"),
                format!("one step of {method} multiplies y' = lambda y by |R(h lambda)| over the complex plane"),
                "the stability function".to_owned(),
                format!("largest difference {worst:.1e}"),
                format!("at most {REGION_TOLERANCE:.0e}"),
                worst <= REGION_TOLERANCE,
            )
        })
        .collect()
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
            (!seen.is_empty()).then(|| {
                claim(
                    &format!("picture.{id}"),
                    format!("the run of the picture '{id}' is seen to fail in this way"),
                    wanted.to_string(),
                    words.join("; "),
                    "one curve shows it".to_owned(),
                    seen.contains(&wanted),
                )
            })
        })
        .collect()
}

// A bracket is searched to a width that leaves room below the widest that counts.
const _: () = assert!(WIDTH < BRACKET);
