//! Tables: for a reader rounded and in words, as CSV one value a cell.

use reports::Table;
use serde::Serialize;

use super::claims::{conserved, law};
use super::long::DiscOutcome;
use super::orders::{ObservedOrder, orders};
use super::row::{Experiment, Row};
use crate::error::Error;
use crate::study::{Derived, short};
use scenes::scheme::Scheme;

/// The one table for an engine's issue thread, orders and errors by scene, and the printed numbers.
pub(super) fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
    let seen = orders(rows);
    Ok(vec![schemes(rows, &seen)?, by_scene(&seen)?, published(rows)?])
}

fn of_scheme<'a>(rows: &'a [Row], experiment: Experiment, scheme: &str) -> Vec<&'a Row> {
    rows.iter().filter(|row| row.experiment == experiment && row.scheme == scheme).collect()
}

fn schemes(rows: &[Row], seen: &[ObservedOrder]) -> Result<Derived, Error> {
    let headers = [
        "scheme",
        "order",
        "torque evaluations a step",
        "attitude error (rad)",
        "at h (s)",
        "dT in a step, 2 dT/h² (W/s)",
        "d|L|²/h² (N² m²)",
        "drift of T",
        "drift of |L|",
        "direction of L",
        "nutation factor, disc",
        "disc at 60 rad/s, h = 1/60 s",
        "long run ends at",
    ];
    let numbers = &headers[1..7];
    let mut table = Table::new(&headers, numbers);
    let lines: Vec<SchemeLine> =
        Scheme::all().into_iter().filter_map(|scheme| scheme_line(rows, seen, scheme)).collect();
    for line in &lines {
        let grown = |(law, size): (&str, Option<f64>)| {
            if law.is_empty() { "–".to_owned() } else { format!("{law}, {}", short(size)) }
        };
        let end = match (&line.long_run_end, line.long_run_momentum_ratio) {
            (end, _) if end.is_empty() => "–".to_owned(),
            (end, None) => end.clone(),
            (end, ratio) => format!("{end}, |L| × {}", short(ratio)),
        };
        table.push([
            line.label.clone(),
            short(line.order),
            format!("{:.1}", line.torque_evaluations_a_step),
            short(line.attitude_error_rad),
            short(line.at_h_s),
            short(line.energy_change_w_per_s.map(tidy)),
            short(line.momentum_square_change_n2m2.map(tidy)),
            grown((&line.energy_drift_law, line.energy_drift)),
            grown((&line.momentum_drift_law, line.momentum_drift)),
            grown((&line.momentum_direction_law, line.momentum_direction_rad)),
            short(line.nutation_factor),
            if line.disc_fate.is_empty() { "–".to_owned() } else { line.disc_fate.clone() },
            end,
        ]);
    }
    Ok(Derived {
        name: "rotation-schemes",
        caption: "Every scheme on a free asymmetric body (torque-free-spin), on a disc at 60 rad/s, and after a long run. Steps: \
             'linear step' is the normalised q + (h/2) ω q; without the gyroscopic term T and |L| are kept and the motion is wrong",
        csv: reports::write_csv(&lines)?,
        table,
    })
}

/// One line of `rotation-schemes.csv`: one value a cell, empty where there is none.
#[derive(Serialize)]
struct SchemeLine {
    /// Scheme.
    scheme: String,
    /// Its name for a reader.
    label: String,
    /// The order of the attitude on the free body.
    order: Option<f64>,
    /// Evaluations of the torque per step.
    torque_evaluations_a_step: f64,
    /// Largest error of the attitude with the step at_h_s, rad.
    attitude_error_rad: Option<f64>,
    /// That step, s.
    at_h_s: Option<f64>,
    /// Change of the kinetic energy T in a step, 2 dT / h^2, W/s.
    energy_change_w_per_s: Option<f64>,
    /// Change of |L|^2 in a step over h^2, N^2 m^2.
    momentum_square_change_n2m2: Option<f64>,
    /// The law by which the error of T grows.
    energy_drift_law: String,
    /// Its largest size, a part of T at the start.
    energy_drift: Option<f64>,
    /// The law by which the error of |L| grows.
    momentum_drift_law: String,
    /// Its largest size, a part of |L| at the start.
    momentum_drift: Option<f64>,
    /// The law by which the direction of L errs.
    momentum_direction_law: String,
    /// Its largest size, rad.
    momentum_direction_rad: Option<f64>,
    /// Factor of the nutation of a disc over the run.
    nutation_factor: Option<f64>,
    /// What becomes of a disc at 60 rad/s with h = 1/60 s.
    disc_fate: String,
    /// The axis at which the long run ends.
    long_run_end: String,
    /// |L| at its end over that at the start.
    long_run_momentum_ratio: Option<f64>,
}

fn scheme_line(rows: &[Row], seen: &[ObservedOrder], scheme: Scheme) -> Option<SchemeLine> {
    let id = scheme.id();
    let sweep = seen.iter().find(|s| s.scheme == id && s.quantity == "attitude" && s.subject == "torque-free-spin")?;
    let step = of_scheme(rows, Experiment::StepLaw, &id);
    let change = |name: &str| step.iter().find(|row| row.quantity.contains(name)).and_then(|row| row.value);
    let drift = of_scheme(rows, Experiment::Drift, &id);
    let grown =
        |name: &str| law(&drift, name).map_or((String::new(), None), |(law, size)| (law.to_string(), Some(size)));
    let nutation = of_scheme(rows, Experiment::Nutation, &id).into_iter().find(|row| row.subject == "disc");
    let (energy_drift_law, energy_drift) = grown("T / T0 - 1");
    let (momentum_drift_law, momentum_drift) = grown("|L| / |L0| - 1");
    let (momentum_direction_law, momentum_direction_rad) = grown("angle of L");
    let (long_run_end, long_run_momentum_ratio) = destination(rows, &id);
    Some(SchemeLine {
        label: scheme.label(),
        order: sweep.order,
        torque_evaluations_a_step: sweep.evaluations,
        attitude_error_rad: sweep.reference.map(|r| r.0),
        at_h_s: sweep.reference.map(|r| r.1),
        energy_change_w_per_s: change("dT"),
        momentum_square_change_n2m2: change("|L|"),
        energy_drift_law,
        energy_drift,
        momentum_drift_law,
        momentum_drift,
        momentum_direction_law,
        momentum_direction_rad,
        nutation_factor: nutation.and_then(|row| row.value),
        disc_fate: DiscOutcome::of(&of_scheme(rows, Experiment::Disc, &id))
            .map_or_else(String::new, DiscOutcome::words),
        long_run_end,
        long_run_momentum_ratio,
        scheme: id,
    })
}

/// What is nothing but rounding is shown as zero.
fn tidy(x: f64) -> f64 {
    if x.abs() < 1e-9 { 0.0 } else { x }
}

/// The end of the long run from far from all axes: where, and |L| / |L0|.
fn destination(rows: &[Row], scheme: &str) -> (String, Option<f64>) {
    let run: Vec<&Row> = of_scheme(rows, Experiment::LongRun, scheme)
        .into_iter()
        .filter(|row| row.subject == "start far from all axes")
        .collect();
    let ends = |name: &str| run.iter().rev().find(|row| row.quantity == name).and_then(|row| row.value);
    let (Some(axis), Some(length)) = (ends("axis coordinate"), ends("|L| / |L0|")) else {
        return (String::new(), None);
    };
    if let Some(step) = run[0].at_step {
        return (format!("blows up at step {step}"), None);
    }
    let start = run.iter().find(|row| row.quantity == "axis coordinate").and_then(|row| row.value).unwrap_or(axis);
    let place = match axis {
        x if (x - start).abs() < 0.01 => "where it was",
        x if x > 0.95 => "the axis of least inertia",
        x if x < 0.05 => "the axis of most inertia",
        x if x > start => "on the way to least inertia",
        _ => "on the way to most inertia",
    };
    (place.to_owned(), Some(length))
}

/// One line of `rotation-orders.csv`.
#[derive(Serialize)]
struct OrderLine<'a> {
    /// Scene or preset.
    scene: &'a str,
    /// Scheme.
    scheme: &'a str,
    /// What was compared.
    quantity: &'a str,
    /// Unit of the errors.
    unit: &'a str,
    /// The order observed.
    order: Option<f64>,
    /// Error with the smallest step.
    error_at_finest_step: Option<f64>,
    /// Error with the step reference_h_s.
    error_at_reference_step: Option<f64>,
    /// That step, s.
    reference_h_s: Option<f64>,
    /// What the scheme conserves without a torque, by theory.
    conserved_without_torque: String,
}

fn by_scene(seen: &[ObservedOrder]) -> Result<Derived, Error> {
    let headers = [
        "scene",
        "scheme",
        "quantity",
        "order",
        "error at the finest step",
        "unit",
        "error at the reference step",
        "reference h (s)",
        "conserved without torque",
    ];
    let mut table =
        Table::new(&headers, &["order", "error at the finest step", "error at the reference step", "reference h (s)"]);
    let line = |s: &'_ ObservedOrder| {
        let kept = Scheme::from_id(&s.scheme).map(conserved).unwrap_or_default();
        kept.iter().map(|c| format!("{c:?}")).collect::<Vec<_>>().join(" ")
    };
    let lines: Vec<OrderLine<'_>> = seen
        .iter()
        .map(|s| OrderLine {
            scene: &s.subject,
            scheme: &s.scheme,
            quantity: &s.quantity,
            unit: if s.quantity == "attitude" { "rad" } else { "rad/s" },
            order: s.order,
            error_at_finest_step: s.finest,
            error_at_reference_step: s.reference.map(|r| r.0),
            reference_h_s: s.reference.map(|r| r.1),
            conserved_without_torque: line(s),
        })
        .collect();
    for one in &lines {
        table.push([
            one.scene.to_owned(),
            one.scheme.to_owned(),
            one.quantity.to_owned(),
            short(one.order),
            short(one.error_at_finest_step),
            one.unit.to_owned(),
            short(one.error_at_reference_step),
            short(one.reference_h_s),
            one.conserved_without_torque.clone(),
        ]);
    }
    let caption = "Order and error of every scheme on every rigid-body scene";
    Ok(Derived { name: "rotation-orders", caption, csv: reports::write_csv(&lines)?, table })
}

/// One line of `rotation-published.csv`.
#[derive(Serialize)]
struct PublishedLine<'a> {
    /// Where the number was printed.
    source: &'a str,
    /// Scheme.
    scheme: &'a str,
    /// Step, s.
    h_s: f64,
    /// What was compared.
    quantity: &'a str,
    /// The number printed.
    published: Option<f64>,
    /// The number measured.
    ours: Option<f64>,
    /// Whether the two agree to the digits printed.
    agrees_to_the_printed_digits: bool,
}

fn published(rows: &[Row]) -> Result<Derived, Error> {
    let headers = ["source", "scheme", "step (s)", "quantity", "published", "ours", "agrees to the printed digits"];
    let mut table = Table::new(&headers, &["step (s)", "published", "ours"]);
    let lines: Vec<PublishedLine<'_>> = rows
        .iter()
        .filter(|row| row.experiment == Experiment::Published)
        .map(|row| PublishedLine {
            source: &row.subject,
            scheme: &row.scheme,
            h_s: row.h_s,
            quantity: &row.quantity,
            published: row.theory,
            ours: row.value,
            agrees_to_the_printed_digits: row.agrees() == Some(true),
        })
        .collect();
    for line in &lines {
        table.push([
            line.source.to_owned(),
            line.scheme.to_owned(),
            line.h_s.to_string(),
            line.quantity.to_owned(),
            line.published.map_or_else(String::new, |x| x.to_string()),
            line.ours.map_or_else(String::new, |x| format!("{x:.9}")),
            if line.agrees_to_the_printed_digits { "yes" } else { "no" }.to_owned(),
        ]);
    }
    let caption = "Published against ours: boxes by Gazebo's benchmark, a spinning box by MuJoCo's test";
    Ok(Derived { name: "rotation-published", caption, csv: reports::write_csv(&lines)?, table })
}
