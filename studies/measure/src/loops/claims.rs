//! What the rows show, against theory.

use reports::Claim;

use super::growth::PARTS;
use super::orders::order_of;
use super::row::{Experiment, Row};
use crate::claim::{Evidence, claim};
use crate::order::Verdict;
use crate::study::{distinct, short};

/// Each law with what it says.
const LAWS: [(&str, &str); 13] = [
    (
        "fall",
        "A fall from rest ends g h T / 2 too low by semi-implicit Euler, as much too high by explicit Euler, and right by velocity Verlet",
    ),
    (
        "jump",
        "Half a kick back at the start lifts the peak of a jump from max n h v - g h² n (n + 1) / 2 to max n h v - g h² n² / 2",
    ),
    ("half-kick", "Semi-implicit Euler with half a kick at the start and when it is read is velocity Verlet"),
    (
        "leapfrog-energy",
        "The energy of leapfrog with the stored velocity is wrong by h ω / 2, with the synchronised one by (h ω)² / 4",
    ),
    (
        "frozen-force",
        "A force held over a frame H multiplies the energy of a spring by 1 + (1 - α) (H ω)² in a frame, whatever the method",
    ),
    ("jitter", "Frames h (1 + s u) make the error of a fall 1 + s² / 3 times as large"),
    ("clamp", "A clamp loses the time that it cuts, and no accuracy"),
    ("drawn", "An interpolated picture is one step late and off by a h² / 8; an extrapolated one is off by a t² / 2"),
    (
        "contact",
        "A bounce at the end of a step, before the kick or at the impact loses g h |v|, after the kick it gains g h |v|, without a move nothing",
    ),
    (
        "terminal-speed",
        "Kicked and damped by d, the speed tends to a h d / (1 - d): the implicit rule alone gives a / c",
    ),
    ("glide", "A glide is v / c long for the linear rule after the move and for the implicit rule before it"),
    ("clock", "A clock that sums h in f32 advances by h rounded to its unit in the last place"),
    ("stored-position", "A position in f32 stands still where h v is below half its unit in the last place"),
];

pub(super) fn claims(rows: &[Row]) -> Vec<Claim> {
    let mut claims: Vec<Claim> = LAWS.iter().filter_map(|(law, statement)| of_law(rows, law, statement)).collect();
    claims.extend(of_law(
        rows,
        "in-turn",
        "Two steps in turn multiply an error by the larger root of r + 1 / r = |2 - (z1 + z2)² + (z1 z2)²|, z = h ω, stable alone or not",
    ));
    claims.extend(published(rows));
    claims.extend(jitter(rows));
    claims.extend(orders(rows));
    claims
}

fn of_law(rows: &[Row], law: &str, statement: &str) -> Option<Claim> {
    let of_law: Vec<&Row> = rows.iter().filter(|r| r.experiment == Experiment::Law && r.choice == law).collect();
    (!of_law.is_empty()).then(|| judged(law, statement, &of_law))
}

/// The claim that every number is its theory's, shown by the one that is furthest off.
fn judged(id: &str, statement: &str, rows: &[&Row]) -> Claim {
    let off = |row: &Row| match (row.value, row.theory, row.tolerance) {
        (Some(value), Some(theory), Some(tolerance)) if tolerance > 0.0 => (value - theory).abs() / tolerance,
        (Some(value), Some(theory), Some(_)) if value == theory => 0.0,
        _ => f64::INFINITY,
    };
    let Some(worst) = rows.iter().max_by(|a, b| off(a).total_cmp(&off(b))) else {
        return claim("loops", id, Default::default(), []);
    };
    let texts = [
        statement.to_owned(),
        format!("{} {} of {} ({})", short(worst.theory), worst.unit, worst.quantity, worst.subject),
        worst.value.map_or_else(
            || "the run failed".to_owned(),
            |v| format!("{v:.10e}, the furthest from theory of {}", rows.len()),
        ),
        format!("within {:.1e} of theory", worst.tolerance.unwrap_or(f64::NAN)),
    ];
    claim("loops", id, texts, rows.iter().map(|row| row.evidence()))
        .with_numbers(rows.iter().filter_map(|row| row.value))
}

/// The printed numbers, to the last digit.
fn published(rows: &[Row]) -> Option<Claim> {
    let printed: Vec<&Row> = rows.iter().filter(|r| r.experiment == Experiment::Published).collect();
    let statement = "Numbers that others printed about loops are reproduced to their last digit";
    (!printed.is_empty()).then(|| judged("published", statement, &printed))
}

/// Small jitter against theory; larger jitter grows too.
fn jitter(rows: &[Row]) -> Option<Claim> {
    let small: Vec<&Row> = rows
        .iter()
        .filter(|r| {
            r.experiment == Experiment::Jitter
                && r.settings == format!("jitter={}", PARTS[0])
                && (0.8..1.6).contains(&r.h_s)
        })
        .collect();
    let statement = "Steps h (1 + s u) let an error of semi-implicit Euler on a spring grow by exp(s² z⁴ / (6 (4 - z²))) a step, z = h ω, \
                     however small s is";
    (!small.is_empty()).then(|| judged("jitter-growth", statement, &small))
}

/// A claim for each choice and method: the orders on every scene.
fn orders(rows: &[Row]) -> Vec<Claim> {
    let errors: Vec<&Row> =
        rows.iter().filter(|r| r.experiment == Experiment::Error && r.theory_order.is_some()).collect();
    distinct(errors.iter().map(|r| (r.choice.as_str(), r.method.as_str())))
        .into_iter()
        .map(|(choice, method)| {
            let own: Vec<&Row> =
                errors.iter().copied().filter(|r| (r.choice.as_str(), r.method.as_str()) == (choice, method)).collect();
            let sweeps = distinct(own.iter().map(|r| (r.subject.as_str(), r.quantity.as_str())));
            let seen: Vec<(f64, crate::order::Order)> = sweeps
                .iter()
                .map(|(subject, quantity)| {
                    let sweep: Vec<&Row> = own
                        .iter()
                        .copied()
                        .filter(|r| (r.subject.as_str(), r.quantity.as_str()) == (*subject, *quantity))
                        .collect();
                    (sweep[0].theory_order.unwrap_or(f64::NAN), order_of(&sweep, 1.0))
                })
                .collect();
            let expected = distinct(seen.iter().map(|(order, _)| order.to_string())).join(" and ");
            let slopes: Vec<String> = seen.iter().map(|(_, order)| short(order.slope)).collect();
            let evidence = seen.iter().map(|(_, order)| match order.verdict {
                Verdict::AsExpected => Evidence::Inside,
                Verdict::NotAsymptotic | Verdict::AtTheFloor => Evidence::Undecided,
                _ => Evidence::Outside,
            });
            let id = format!("order.{}.{method}", choice.replace([' ', ','], "-").replace("--", "-"));
            let texts = [
                format!("{method}, {choice}: the order of configuration and velocity is {expected}"),
                format!("order {expected}"),
                format!("slopes {}", slopes.join(", ")),
                "within 0.25 of the order".to_owned(),
            ];
            claim("loops", &id, texts, evidence).by(method).with_numbers(seen.iter().filter_map(|(_, o)| o.slope))
        })
        .collect()
}
