//! A free rigid body at 60 steps per second: which scheme keeps its attitude within one degree?

use reports::Table;
use scenes::run::Precision;
use scenes::scene::Kind;
use serde::Serialize;

use super::cells::{label, runs};
use super::cost_at_error::{CostBound, offer, sweeps};
use super::{CostMeasure, Row};
use crate::error::Error;
use crate::names::scene_title;
use crate::study::{Derived, distinct};
use integrator::methods::MethodId;

/// The step: a frame of 60 per second, s.
pub const STEP_S: f64 = 1.0 / 60.0;
/// The error that is allowed: one degree, in rad.
pub const ALLOWED: f64 = std::f64::consts::PI / 180.0;
/// Schemes that a reader is shown of those that hold.
const SHOWN: usize = 3;

/// One scheme on one free body at [`STEP_S`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AtRate {
    /// Scene or preset.
    pub scene: String,
    /// End of the run, s.
    pub horizon_s: f64,
    /// Scheme.
    pub method: String,
    /// Evaluations of the force law per step.
    pub evaluations_a_step: f64,
    /// Largest error of the attitude with a step of 1/60 s, degrees; between two runs, interpolated.
    pub error_deg: Option<f64>,
    /// The largest step that keeps the attitude within one degree, s; empty where no run does.
    pub largest_step_s: Option<f64>,
    /// Whether a step of 1/60 s keeps it.
    pub holds: bool,
}

/// Every scheme on every free body among the rows.
pub fn at_rate(rows: &[Row]) -> Vec<AtRate> {
    let runs = runs(rows);
    let is_free = |id: &str| scenes::by_id(id).is_ok_and(|scene| scene.scene().info().kind == Kind::FreeBody);
    let free = distinct(runs.iter().map(|row| row.scene.as_str())).into_iter().filter(|id| is_free(id));
    free.flat_map(|scene| {
        let own = runs.iter().filter(|row| row.scene == scene && row.precision == Precision::F64);
        // The attitude alone: a body that is thrown has an error of its position, too.
        let of_attitude: Vec<Row> = own.map(|row| Row { error: row.attitude_error, ..(*row).clone() }).collect();
        sweeps(&of_attitude.iter().collect::<Vec<_>>()).iter().map(|sweep| one(sweep)).collect::<Vec<_>>()
    })
    .collect()
}

fn one(sweep: &[&Row]) -> AtRate {
    let first = sweep[0];
    let largest_step_s = match offer(sweep, ALLOWED, CostMeasure::Evaluations) {
        CostBound::At(price) => Some(price.h_s),
        CostBound::Above(_) | CostBound::Never => None,
    };
    let error = error_at(sweep, STEP_S);
    AtRate {
        scene: first.scene.clone(),
        horizon_s: first.h_s * first.steps as f64,
        method: first.method.clone(),
        evaluations_a_step: first.evaluations as f64 / first.steps as f64,
        error_deg: error.map(f64::to_degrees),
        largest_step_s,
        // A sweep of a slow body may end above the step: its largest step says enough.
        holds: largest_step_s.is_some_and(|h_s| h_s >= STEP_S) && error.is_none_or(|error| error <= ALLOWED),
    }
}

/// The error at a step between those of two runs: a straight line in the logarithms. `None` outside the sweep.
fn error_at(sweep: &[&Row], h_s: f64) -> Option<f64> {
    let pair = sweep.windows(2).find(|pair| pair[0].h_s >= h_s && h_s >= pair[1].h_s)?;
    let (coarse, fine) = (pair[0].scored()?, pair[1].scored()?);
    if coarse == 0.0 || fine == 0.0 {
        return Some(coarse.max(fine));
    }
    let part = (pair[0].h_s / h_s).ln() / (pair[0].h_s / pair[1].h_s).ln();
    Some(coarse * (fine / coarse).powf(part))
}

/// The schemes that hold on every free body, the least work per step first, and semi-implicit Euler.
///
/// # Errors
/// Rows that have no form as CSV.
pub(super) fn table(rows: &[Row]) -> Result<Option<Derived>, Error> {
    let lines = at_rate(rows);
    let scenes = distinct(lines.iter().map(|line| (line.scene.as_str(), line.horizon_s)));
    if scenes.is_empty() {
        return Ok(None);
    }
    let mut headers = vec!["scheme".to_owned()];
    headers.extend(scenes.iter().map(|(scene, end_s)| format!("{}, {end_s} s", scene_title(scene))));
    headers.extend(["evaluations a step", "largest step for 1°"].map(str::to_owned));
    let headers: Vec<&str> = headers.iter().map(String::as_str).collect();
    let mut table = Table::new(&headers, &headers[1..]);
    for own in ranked(&lines) {
        let errors = scenes.iter().map(|(scene, _)| own.iter().find(|line| line.scene == *scene).copied());
        let mut cells = vec![label(&own[0].method)];
        cells.extend(errors.map(|line| degrees(line.and_then(|line| line.error_deg))));
        cells.push(format!("{:.0}", own[0].evaluations_a_step));
        cells
            .push(largest_step(&own).map_or_else(|| "none".to_owned(), |h_s| format!("1/{:.0} s", (1.0 / h_s).ceil())));
        table.push(cells);
    }
    Ok(Some(Derived {
        name: "tradeoff-60-hz",
        caption: "A free rigid body at 60 Hz and 1°: the largest error of the attitude with a step of 1/60 s, in degrees, up to \
                  the time in the head. First the cheapest schemes that keep 1° on all of these bodies, then semi-implicit Euler; \
                  the others are in the CSV.",
        csv: reports::write_csv(&lines)?,
        table,
    }))
}

/// The lines of the schemes that are shown, each with those of all bodies.
fn ranked(lines: &[AtRate]) -> Vec<Vec<&AtRate>> {
    let schemes = distinct(lines.iter().map(|line| line.method.as_str()));
    let of = |method: &str| -> Vec<&AtRate> { lines.iter().filter(|line| line.method == method).collect() };
    let all: Vec<Vec<&AtRate>> = schemes.into_iter().map(of).collect();
    let worst = |own: &[&AtRate]| own.iter().filter_map(|line| line.error_deg).fold(0.0, f64::max);
    let mut holding: Vec<Vec<&AtRate>> = all.iter().filter(|own| own.iter().all(|line| line.holds)).cloned().collect();
    holding.sort_by(|a, b| {
        a[0].evaluations_a_step.total_cmp(&b[0].evaluations_a_step).then(worst(a).total_cmp(&worst(b)))
    });
    holding.truncate(SHOWN);
    let is_semi_implicit =
        |own: &&Vec<&AtRate>| own[0].method.split('/').next() == Some(MethodId::SemiImplicitEuler.id());
    for own in all.iter().filter(is_semi_implicit) {
        if !holding.contains(own) {
            holding.push(own.clone());
        }
    }
    holding
}

/// The largest step that holds on every body.
fn largest_step(own: &[&AtRate]) -> Option<f64> {
    let steps: Option<Vec<f64>> = own.iter().map(|line| line.largest_step_s).collect();
    steps.map(|steps| steps.into_iter().fold(f64::INFINITY, f64::min))
}

fn degrees(error: Option<f64>) -> String {
    match error {
        None => "–".to_owned(),
        Some(error) if error < 0.01 => "< 0.01".to_owned(),
        Some(error) if error < 10.0 => format!("{error:.2}"),
        Some(error) => format!("{error:.0}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Part;
    use super::*;

    // Fails if: a body so slow that no run is as short as 1/60 s is said to need a shorter step, or a fast one is said to hold.
    #[test]
    fn a_step_beyond_the_sweep_is_judged_by_the_largest_one() {
        let verdict = |coarsest_s: f64, error: f64| {
            let row = |k: u32| {
                let h_s = coarsest_s / f64::from(1_u32 << k);
                let row =
                    Row::new(Part::Run, "tennis-racket", "rk4/body-omega".to_owned(), Precision::F64, 8 << k, h_s);
                Row { error: Some(error / f64::from(1_u32 << k)), evaluations: 32 << k, ..row }
            };
            let rows: Vec<Row> = (0..4).map(row).collect();
            let found = one(&rows.iter().collect::<Vec<_>>());
            (found.holds, found.error_deg.is_some())
        };
        // Runs of 100 s to 12.5 s, of 0.1 s to 0.0125 s, and of 0.01 s down.
        assert_eq!(verdict(100.0, 0.5 * ALLOWED), (true, false));
        assert_eq!(verdict(100.0, 100.0 * ALLOWED), (false, false));
        assert_eq!(verdict(0.1, 2.0 * ALLOWED), (true, true));
        assert_eq!(verdict(0.1, 100.0 * ALLOWED), (false, true));
        assert_eq!(verdict(0.01, 0.5 * ALLOWED), (false, false));
    }
}
