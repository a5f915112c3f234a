//! What the rows show against theory.

use integrator::methods::Conserved;
use reports::Claim;

use super::laws::nutation_factor;
use super::long::{DRIFT_END_S, DiscOutcome, POINTS};
use super::orders::{ORDER_TOLERANCE, ObservedOrder, orders};
use super::row::{Experiment, Row};
use crate::claim::{self, Evidence, largest};
use crate::growth;
use crate::study::{distinct, short};
use scenes::run::Outcome;
use scenes::scheme::{Rule, Scheme};
use scenes::theory::Law;

/// All claims of the study.
pub(super) fn claims(rows: &[Row]) -> Vec<Claim> {
    let mut claims = order_claims(rows);
    claims.extend(rows.iter().filter_map(law_claim));
    claims.extend(nutation_claims(rows));
    claims.extend(disc_claims(rows));
    claims.extend(destination_claims(rows));
    claims.extend(drift_claims(rows));
    claims.extend(law_claims(rows));
    claims.extend(same_motion_claims(rows));
    claims.extend(published_claims(rows));
    claims
}

fn claim(id: &str, texts: [String; 4], evidence: impl IntoIterator<Item = Evidence>) -> Claim {
    claim::claim("rotation", id, texts, evidence)
}

/// One claim a scheme and order of theory, over all scenes that it has this order on.
fn order_claims(rows: &[Row]) -> Vec<Claim> {
    let attitudes: Vec<ObservedOrder> = orders(rows).into_iter().filter(|seen| seen.quantity == "attitude").collect();
    let mut claims = Vec::new();
    for id in distinct(attitudes.iter().map(|seen| seen.scheme.clone())) {
        let of_scheme: Vec<&ObservedOrder> = attitudes.iter().filter(|s| s.scheme == id).collect();
        for expected in distinct(of_scheme.iter().map(|s| s.theory_order)) {
            let seen: Vec<&ObservedOrder> = of_scheme.iter().copied().filter(|s| s.theory_order == expected).collect();
            claims.push(order_claim(&id, expected, &seen));
        }
    }
    claims
}

fn order_claim(id: &str, expected: Option<f64>, seen: &[&ObservedOrder]) -> Claim {
    let name = expected.map_or("exact".to_owned(), |p| format!("order-{p}"));
    let measured = seen.iter().map(|s| match (expected, s.order) {
        (Some(_), Some(order)) => format!("{} {}", s.subject, short(Some(order))),
        _ => format!("{} error {}", s.subject, short(s.finest)),
    });
    let texts = [
        match expected {
            Some(0.0) => {
                format!("{id} is inconsistent on {} scenes: its error does not fall with the step", seen.len())
            }
            Some(p) => format!("the attitude of {id} converges with order {p} on {} scenes", seen.len()),
            None => format!("{id} reproduces a quadratic angle exactly"),
        },
        expected.map_or("no error but rounding".to_owned(), |p| format!("order {p}")),
        measured.collect::<Vec<_>>().join("; "),
        match expected {
            Some(_) => format!("extrapolated order within {ORDER_TOLERANCE}"),
            None => "at most 1e-12 of the angle turned, and of 1 rad".to_owned(),
        },
    ];
    let evidence = seen.iter().map(|s| s.agrees.map_or(Evidence::Undecided, Evidence::is));
    claim(&format!("{id}.{name}"), texts, evidence).by(id).with_numbers([seen.len() as f64])
}

fn law_claim(row: &Row) -> Option<Claim> {
    let (kind, what) = match row.experiment {
        Experiment::StepLaw if row.quantity.contains("dT") => {
            ("step-law.energy", "changes the energy in a step as theory says")
        }
        Experiment::StepLaw => ("step-law.momentum", "changes |L|^2 in a step as theory says"),
        _ => return None,
    };
    let subject = row.subject.replace(' ', "-");
    row.claim(&format!("{kind}.{subject}.{}", row.scheme), format!("{} {what} ({})", row.scheme, row.subject))
}

/// One claim a scheme and top, over all steps.
fn nutation_claims(rows: &[Row]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for (scheme, rows) in by_scheme(rows, Experiment::Nutation) {
        for subject in distinct(rows.iter().map(|row| row.subject.clone())) {
            let of: Vec<&&Row> = rows.iter().filter(|row| row.subject == subject && row.theory.is_some()).collect();
            if of.is_empty() {
                continue;
            }
            let list = |f: fn(&Row) -> Option<f64>| of.iter().map(|row| short(f(row))).collect::<Vec<_>>().join(", ");
            let off = largest(of.iter().map(|r| r.value.zip(r.theory).map(|(a, b)| (a / b - 1.0).abs())));
            claims.push(claim(
                &format!("nutation.{subject}.{}", scheme.id()),
                [
                    format!("{} multiplies the nutation of a {subject} in a step by the factor of theory", scheme.id()),
                    list(|row| row.theory),
                    format!(
                        "{} (largest relative difference {})",
                        list(|row| row.value),
                        off.map_or_else(|| "unknown".to_owned(), |x| format!("{x:.1e}"))
                    ),
                    "32 units in the last place: both sides are a few operations in f64".to_owned(),
                ],
                of.iter().map(|row| Evidence::is(row.agrees() == Some(true))),
            ));
        }
    }
    claims
}

/// The rows of one experiment, scheme by scheme.
fn by_scheme(rows: &[Row], experiment: Experiment) -> Vec<(Scheme, Vec<&Row>)> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.experiment == experiment).collect();
    distinct(rows.iter().map(|row| row.scheme.clone()))
        .into_iter()
        .filter_map(|id| Some((Scheme::from_id(&id)?, rows.iter().copied().filter(|row| row.scheme == id).collect())))
        .collect()
}

fn disc_claims(rows: &[Row]) -> Vec<Claim> {
    by_scheme(rows, Experiment::Disc)
        .into_iter()
        .filter_map(|(scheme, rows)| {
            let (factor, fate) = (nutation_factor(scheme, 2.0, 1.0)?, DiscOutcome::of(&rows));
            let growth = factor.ln();
            let as_told = |fate| match fate {
                DiscOutcome::Damps => growth < -1e-9,
                DiscOutcome::Survives => growth.abs() <= 1e-9,
                _ => growth > 1e-9,
            };
            Some(claim(
                &format!("disc.{}", scheme.id()),
                [
                    format!(
                        "a disc at 60 rad/s with h = 1/60 s fares under {} as the nutation factor says",
                        scheme.id()
                    ),
                    format!("factor {factor:.6} a step"),
                    fate.map_or_else(|| "unknown".to_owned(), DiscOutcome::words),
                    "above 1 grows, at 1 survives, below 1 is damped".to_owned(),
                ],
                [Evidence::is(fate.is_some_and(as_told))],
            ))
        })
        .collect()
}

/// Start, scheme, whether the axis coordinate rises, and where it ends, with the reason.
const DESTINATIONS: [(&str, &str, Goal); 9] = [
    ("start far from all axes", "semi-implicit-euler/world-momentum", Goal::Above(0.99)),
    ("start near most inertia", "semi-implicit-euler/world-momentum", Goal::Rises),
    ("start far from all axes", "explicit-euler/world-omega", Goal::Above(0.99)),
    ("start near most inertia", "implicit-gyroscopic", Goal::Falls),
    ("start near least inertia", "implicit-gyroscopic", Goal::Rises),
    ("start near most inertia", "restored-momentum", Goal::Rises),
    ("start near least inertia", "restored-momentum", Goal::Falls),
    ("start far from all axes", "free-splitting", Goal::Stays),
    ("start far from all axes", "momentum-midpoint", Goal::Stays),
];

#[derive(Clone, Copy)]
enum Goal {
    Above(f64),
    Rises,
    Falls,
    Stays,
}

fn destination_claims(rows: &[Row]) -> Vec<Claim> {
    DESTINATIONS
        .iter()
        .filter_map(|&(start, scheme, goal)| {
            let run: Vec<&Row> = rows
                .iter()
                .filter(|row| row.experiment == Experiment::LongRun && row.subject == start && row.scheme == scheme)
                .filter(|row| row.quantity == "axis coordinate")
                .collect();
            let on_axis = |row: &Row| row.value.is_some_and(|x| (0.0..=1.0).contains(&x));
            let is_complete =
                run.len() as u64 > POINTS && run.iter().all(|row| row.outcome == Outcome::Finished && on_axis(row));
            let [first, last] = [run.first()?, run.last()?].map(|row| row.value.unwrap_or(f64::NAN));
            // Within a period the coordinate swings by the order of h; a fifth of the distance from the nearer of the two
            // axes is far outside it.
            let near = first.min(1.0 - first);
            let (theory, holds) = match goal {
                Goal::Above(least) => ("drifts to the axis of least inertia", last >= least),
                Goal::Rises => ("drifts towards the axis of least inertia", last - first > 0.2 * near),
                Goal::Falls => ("drifts towards the axis of most inertia", first - last > 0.2 * near),
                Goal::Stays => ("stays where it is", (last - first).abs() <= 1e-3),
            };
            Some(claim(
                &format!("destination.{}.{scheme}", start.replace(' ', "-")),
                [
                    format!("a body ({start}) under {scheme} {theory}"),
                    theory.to_owned(),
                    format!("axis coordinate {first:.4} at the start, {last:.4} at the end (0 most, 1 least inertia)"),
                    match goal {
                        Goal::Above(least) => format!("at least {least} at the end"),
                        Goal::Rises | Goal::Falls => {
                            "by a fifth of the distance from the nearer axis, or more".to_owned()
                        }
                        Goal::Stays => "within 1e-3".to_owned(),
                    },
                ],
                [Evidence::is(is_complete), Evidence::is(holds)],
            ))
        })
        .collect()
}

/// What a scheme keeps to rounding on a free body.
pub fn conserved(scheme: Scheme) -> &'static [Conserved] {
    use integrator::methods::MethodId::ImplicitMidpoint;
    use integrator::rigid_body::Formulation::{BodyOmega, WithoutGyroscopicTerm, WorldMomentum};
    match (scheme.rule, scheme.storage) {
        (Rule::Rigid(step), _) => step.conserves(),
        // L' = 0, which every method sums exactly.
        (Rule::General(_), WorldMomentum) => &[Conserved::Momentum],
        (Rule::General(ImplicitMidpoint), BodyOmega) => &[Conserved::Energy, Conserved::MomentumNorm],
        (Rule::General(_), WithoutGyroscopicTerm) => &[Conserved::Energy, Conserved::MomentumNorm],
        _ => &[],
    }
}

fn drift_claims(rows: &[Row]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for (scheme, rows) in by_scheme(rows, Experiment::Drift) {
        for &kept in conserved(scheme) {
            let (names, what): (&[&str], _) = match kept {
                Conserved::Energy => (&["T / T0 - 1"], "energy"),
                Conserved::MomentumNorm => (&["|L| / |L0| - 1"], "momentum-norm"),
                Conserved::Momentum => (&["|L| / |L0| - 1", "angle of L"], "momentum"),
            };
            let of_kind: Vec<&&Row> = rows.iter().filter(|row| names.contains(&row.quantity.as_str())).collect();
            let Some(last) = of_kind.last() else { continue };
            let most = largest(of_kind.iter().map(|row| row.value.map(f64::abs)));
            // A few roundings of a few units a step, all with one sign at worst.
            let bound = 8.0 * f64::EPSILON * (last.t_s / last.h_s);
            claims.push(claim(
                &format!("conserves.{what}.{}", scheme.id()),
                [
                    format!("{} keeps {what} on a free body to rounding{}", scheme.id(), wrong(scheme)),
                    "conserved".to_owned(),
                    most.map_or_else(
                        || "a value is missing".to_owned(),
                        |x| format!("largest relative change {x:.2e}"),
                    ),
                    format!("at most {bound:.1e}: 8 units in the last place a step"),
                ],
                [Evidence::within(most, [0.0, bound]), Evidence::is(ran_to_end(&rows))],
            ));
        }
    }
    claims
}

/// Whether a drift run finished, and every number of it is there.
fn ran_to_end(rows: &[&Row]) -> bool {
    rows.last().is_some_and(|row| row.t_s == DRIFT_END_S)
        && rows.iter().all(|row| row.outcome == Outcome::Finished && row.value.is_some_and(f64::is_finite))
}

/// A scheme whose step changes T by a term of h^2 that has one sign loses or gains linearly.
fn law_claims(rows: &[Row]) -> Vec<Claim> {
    let of = by_scheme(rows, Experiment::Drift);
    of.into_iter()
        .filter(|(scheme, _)| super::laws::energy_changes_with_one_sign(*scheme))
        .filter_map(|(scheme, rows)| {
            let (seen, largest) = law(&rows, "T / T0 - 1")?;
            let evidence =
                if seen == Law::Unclassified { Evidence::Undecided } else { Evidence::is(seen == Law::Linear) };
            Some(claim(
                &format!("growth.energy.{}", scheme.id()),
                [
                    format!(
                        "the energy error of {} grows linearly: every step changes T by h^2 / 2 v . J v or less",
                        scheme.id()
                    ),
                    Law::Linear.to_string(),
                    format!("{seen}, largest relative error {largest:.2e}"),
                    "the same law".to_owned(),
                ],
                [evidence, Evidence::is(ran_to_end(&rows))],
            ))
        })
        .collect()
}

fn wrong(scheme: Scheme) -> &'static str {
    if scheme.lacks_gyroscopic_term() { ", on the wrong motion: conservation does not reveal it" } else { "" }
}

/// The law of growth of one quantity of a drift run.
pub(super) fn law(rows: &[&Row], quantity: &str) -> Option<(Law, f64)> {
    let rows: Vec<&&Row> = rows.iter().filter(|row| row.quantity == quantity).collect();
    let first = rows.first()?;
    let envelope = growth::running_maximum(rows.iter().map(|row| (row.t_s, row.value.map_or(f64::NAN, f64::abs))));
    let steps = rows.last()?.t_s / first.h_s;
    let largest = envelope.last()?.error;
    Some((growth::classify(&envelope, 8.0 * f64::EPSILON * steps.sqrt().max(64.0)).law, largest))
}

fn same_motion_claims(rows: &[Row]) -> Vec<Claim> {
    rows.iter()
        .filter(|row| row.experiment == Experiment::SameMotion)
        .filter_map(|row| {
            let (apart, bound) = (row.theory?, row.tolerance?);
            let same = row.scheme.starts_with("semi-implicit");
            let (statement, allowed) = if same {
                ("are the same motion", [0.0, bound])
            } else {
                ("are two motions", [1e3 * bound, f64::INFINITY])
            };
            let (method, _) = row.scheme.split_once('/')?;
            // Where the axis of the spin keeps its direction, the world frame and the body frame are one for explicit Euler too.
            (same || apart > 1e5 * bound).then(|| {
                claim(
                    &format!("same-motion.{}.{method}", row.subject),
                    [
                        format!("{method} with world omega and with body omega {statement} on {}", row.subject),
                        statement.to_owned(),
                        row.value.map_or_else(|| "a run failed".to_owned(), |x| format!("{x:.2e} apart at most")),
                        format!(
                            "{} {:.1e}",
                            if same { "at most" } else { "more than" },
                            if same { bound } else { 1e3 * bound }
                        ),
                    ],
                    [Evidence::within(row.value, allowed)],
                )
                .on(&row.subject)
                .by(method)
            })
        })
        .collect()
}

fn published_claims(rows: &[Row]) -> Vec<Claim> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.experiment == Experiment::Published).collect();
    distinct(rows.iter().map(|row| (row.subject.clone(), row.scheme.clone())))
        .into_iter()
        .map(|(subject, scheme)| {
            let of: Vec<&&Row> = rows.iter().filter(|row| row.subject == subject && row.scheme == scheme).collect();
            let right = of.iter().filter(|row| row.agrees() == Some(true)).count();
            claim(
                &format!("published.{subject}.{scheme}"),
                [
                    format!("the numbers printed by {subject} for {scheme} are reproduced to their last digit"),
                    format!("{} of {}", of.len(), of.len()),
                    format!("{right} of {}", of.len()),
                    "half a unit of the last printed digit".to_owned(),
                ],
                of.iter().map(|row| Evidence::is(row.agrees() == Some(true))),
            )
        })
        .collect()
}
