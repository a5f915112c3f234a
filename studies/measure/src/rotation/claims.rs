//! What the rows show against theory.

use integrator::methods::Conserved;
use reports::{Claim, Verdict};

use super::laws::nutation_factor;
use super::long::Fate;
use super::orders::{Seen, orders};
use super::row::{Experiment, Row};
use super::scheme::{Rule, Scheme};
use crate::growth;
use crate::study::{distinct, short};
use scenes::theory::Law;

/// Scenes on which omega x I omega vanishes along the whole motion: there the model without the gyroscopic term is right.
pub(super) const CONSISTENT_WITHOUT: [&str; 2] = ["principal-axis-torque", "sphere-torque"];

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

fn claim(id: &str, statement: String, theory: String, measured: String, bound: String, holds: bool) -> Claim {
    let verdict = Verdict::from_comparison(holds);
    Claim { id: format!("rotation.{id}"), study: "rotation".to_owned(), statement, theory, measured, bound, verdict }
}

/// What theory says of the attitude of one scheme on one scene: its order, or `None` where the motion is reproduced exactly.
pub(super) fn expected_order(scheme: Scheme, subject: &str) -> Option<f64> {
    if scheme.lacks_gyroscopic_term() && !CONSISTENT_WITHOUT.contains(&subject) {
        return Some(0.0);
    }
    // The angle is a quadratic polynomial of t.
    (subject != "principal-axis-torque" || scheme.order() == 1).then(|| f64::from(scheme.order()))
}

/// Largest accepted difference of an extrapolated order: the local order of a sweep is p + c h, what extrapolation leaves
/// is of the second order in h, and no scene of the list has a larger one than this at its finest steps.
const ORDER_TOLERANCE: f64 = 0.05;
/// Largest error of a motion that is reproduced exactly: 2^10 steps of a few roundings each.
const EXACT: f64 = 1e-12;

fn order_claims(rows: &[Row]) -> Vec<Claim> {
    let attitudes: Vec<Seen> = orders(rows).into_iter().filter(|seen| seen.quantity == "attitude").collect();
    let mut claims = Vec::new();
    for id in distinct(attitudes.iter().map(|seen| seen.scheme.clone())) {
        let Some(scheme) = Scheme::from_id(&id) else { continue };
        let of_scheme = |expected: Option<f64>| -> Vec<&Seen> {
            attitudes.iter().filter(|s| s.scheme == id && expected_order(scheme, &s.subject) == expected).collect()
        };
        let kinds = distinct(attitudes.iter().filter(|s| s.scheme == id).map(|s| expected_order(scheme, &s.subject)));
        for expected in kinds {
            let seen = of_scheme(expected);
            let right = |s: &Seen| match expected {
                Some(p) => s.finished && s.order.is_some_and(|q| (q - p).abs() <= ORDER_TOLERANCE),
                None => s.finished && s.finest.is_some_and(|error| error <= EXACT),
            };
            let name = expected.map_or("exact".to_owned(), |p| format!("order-{p}"));
            let measured = seen.iter().map(|s| match expected {
                Some(_) => format!("{} {}", s.subject, short(s.order)),
                None => format!("{} error {}", s.subject, short(s.finest)),
            });
            claims.push(claim(
                &format!("{id}.{name}"),
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
                    None => format!("at most {EXACT:.0e} rad"),
                },
                seen.iter().all(|s| right(s)),
            ));
        }
    }
    claims
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
    row.claim(format!("rotation.{kind}.{subject}.{}", row.scheme), format!("{} {what} ({})", row.scheme, row.subject))
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
            let off = of.iter().map(|r| r.value.zip(r.theory).map_or(f64::INFINITY, |(a, b)| (a / b - 1.0).abs()));
            let largest = off.fold(0.0, f64::max);
            claims.push(claim(
                &format!("nutation.{subject}.{}", scheme.id()),
                format!("{} multiplies the nutation of a {subject} in a step by the factor of theory", scheme.id()),
                list(|row| row.theory),
                format!("{} (largest relative difference {largest:.1e})", list(|row| row.value)),
                "32 units in the last place: both sides are a few operations in f64".to_owned(),
                of.iter().all(|row| row.agrees() == Some(true)),
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
            let (factor, fate) = (nutation_factor(scheme, 2.0, 1.0)?, Fate::of(&rows)?);
            let growth = factor.ln();
            let holds = match fate {
                Fate::Damps => growth < -1e-9,
                Fate::Survives => growth.abs() <= 1e-9,
                _ => growth > 1e-9,
            };
            Some(claim(
                &format!("disc.{}", scheme.id()),
                format!("a disc at 60 rad/s with h = 1/60 s fares under {} as the nutation factor says", scheme.id()),
                format!("factor {factor:.6} a step"),
                fate.words(),
                "above 1 grows, at 1 survives, below 1 is damped".to_owned(),
                holds,
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
            let path: Vec<f64> = rows
                .iter()
                .filter(|row| row.experiment == Experiment::LongRun && row.subject == start && row.scheme == scheme)
                .filter(|row| row.quantity == "axis coordinate")
                .filter_map(|row| row.value)
                .collect();
            let (&first, &last) = (path.first()?, path.last()?);
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
                format!("a body ({start}) under {scheme} {theory}"),
                theory.to_owned(),
                format!("axis coordinate {first:.4} at the start, {last:.4} at the end (0 most, 1 least inertia)"),
                match goal {
                    Goal::Above(least) => format!("at least {least} at the end"),
                    Goal::Rises | Goal::Falls => "by a fifth of the distance from the nearer axis, or more".to_owned(),
                    Goal::Stays => "within 1e-3".to_owned(),
                },
                holds,
            ))
        })
        .collect()
}

/// What a scheme keeps to rounding on a free body.
pub fn conserved(scheme: Scheme) -> &'static [Conserved] {
    use integrator::methods::MethodId::{ExplicitEuler, ImplicitMidpoint, Rk4, SemiImplicitEuler, VelocityVerlet};
    use integrator::rigid_body::Storage::{BodyOmega, WithoutGyroscopicTerm, WorldMomentum};
    match (scheme.rule, scheme.storage) {
        (Rule::Rigid(step), _) => step.conserves(),
        (Rule::General(ExplicitEuler | SemiImplicitEuler | VelocityVerlet | Rk4 | ImplicitMidpoint), WorldMomentum) => {
            &[Conserved::Momentum]
        }
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
            let largest = of_kind.iter().filter_map(|row| row.value).map(f64::abs).fold(0.0, f64::max);
            let Some(last) = of_kind.last() else { continue };
            // A few roundings of a few units a step, all with one sign at worst.
            let bound = 8.0 * f64::EPSILON * (last.t_s / last.h_s);
            claims.push(claim(
                &format!("conserves.{what}.{}", scheme.id()),
                format!("{} keeps {what} on a free body to rounding{}", scheme.id(), wrong(scheme)),
                "conserved".to_owned(),
                format!("largest relative change {largest:.2e}"),
                format!("at most {bound:.1e}: 8 units in the last place a step"),
                of_kind.iter().all(|row| row.value.is_some()) && largest <= bound,
            ));
        }
    }
    claims
}

/// A scheme whose step changes T by a term of h^2 that has one sign loses or gains linearly.
fn law_claims(rows: &[Row]) -> Vec<Claim> {
    let of = by_scheme(rows, Experiment::Drift);
    of.into_iter()
        .filter(|(scheme, _)| super::laws::energy_changes_with_one_sign(*scheme))
        .filter_map(|(scheme, rows)| {
            let (seen, largest) = law(&rows, "T / T0 - 1")?;
            Some(claim(
                &format!("growth.energy.{}", scheme.id()),
                format!(
                    "the energy error of {} grows linearly: every step changes T by h^2 / 2 v . J v or less",
                    scheme.id()
                ),
                Law::Linear.to_string(),
                format!("{seen}, largest relative error {largest:.2e}"),
                "the same law".to_owned(),
                seen == Law::Linear,
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
    let envelope = growth::running_maximum(rows.iter().filter_map(|row| Some((row.t_s, row.value?.abs()))));
    let steps = rows.last()?.t_s / first.h_s;
    let largest = envelope.last()?.error;
    Some((growth::classify(&envelope, 8.0 * f64::EPSILON * steps.sqrt().max(64.0)).law, largest))
}

fn same_motion_claims(rows: &[Row]) -> Vec<Claim> {
    rows.iter()
        .filter(|row| row.experiment == Experiment::SameMotion)
        .filter_map(|row| {
            let (value, steps) = (row.value?, row.t_s / row.h_s);
            let same = row.scheme.starts_with("semi-implicit");
            // Either form rounds a few units in the last place a step, and the motion carries earlier roundings along.
            let bound = 64.0 * f64::EPSILON * steps;
            let (statement, holds) =
                if same { ("are the same motion", value <= bound) } else { ("are two motions", value > 1e3 * bound) };
            let (method, _) = row.scheme.split_once('/')?;
            // Where the body spins about one axis, the world frame and the body frame are one for explicit Euler too.
            (same || row.subject != "principal-axis-torque").then(|| {
                claim(
                    &format!("same-motion.{}.{method}", row.subject),
                    format!("{method} with world omega and with body omega {statement} on {}", row.subject),
                    statement.to_owned(),
                    format!("{value:.2e} apart at most"),
                    format!(
                        "{} {:.1e}",
                        if same { "at most" } else { "more than" },
                        if same { bound } else { 1e3 * bound }
                    ),
                    holds,
                )
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
                format!("the numbers printed by {subject} for {scheme} are reproduced to their last digit"),
                format!("{} of {}", of.len(), of.len()),
                format!("{right} of {}", of.len()),
                "half a unit of the last printed digit".to_owned(),
                right == of.len() && right > 0,
            )
        })
        .collect()
}
