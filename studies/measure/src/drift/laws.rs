//! From the stretches of a run to the law of growth, and to claims about it.

use reports::{Claim, Table};
use serde::{Deserialize, Serialize};

use super::{Drift, Row, STRETCHES};
use crate::claim::{Evidence, claim};
use crate::error::Error;
use crate::growth;
use crate::study::{Derived, short};
use scenes::run::{Outcome, Precision};
use scenes::theory::Law;

/// The law of growth of one invariant in one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawRow {
    /// Scene or preset.
    pub scene: String,
    /// Method.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// Step, s.
    pub h_s: f64,
    /// What the error is of.
    pub drift: Drift,
    /// Unit of the errors.
    pub unit: String,
    /// Largest |error| of the run.
    pub largest_error: Option<f64>,
    /// The same as a part of the invariant at the start (of 1 for an angle and for the quaternion).
    pub relative_error: Option<f64>,
    /// The law observed.
    pub law: Law,
    /// p of error ~ t^p.
    pub exponent: Option<f64>,
    /// r of E / E0 = exp(r t), 1/s, where theory or the data say exponential.
    pub rate_per_s: Option<f64>,
    /// error(T) / error(T / 10).
    pub decade_ratio: Option<f64>,
    /// The law that theory predicts, where it does.
    pub theory_law: Option<Law>,
    /// The length of a run from which on that law is to be seen, s.
    pub theory_seen_after_s: Option<f64>,
    /// Length of the run, s.
    pub length_s: f64,
    /// Low end of the band or rate that theory predicts.
    pub theory_low: Option<f64>,
    /// High end of the same.
    pub theory_high: Option<f64>,
    /// Smallest value / start.
    pub ratio_low: Option<f64>,
    /// Largest value / start.
    pub ratio_high: Option<f64>,
    /// When the run failed, s.
    pub failed_at_s: Option<f64>,
    /// The numbers behind the law, in words.
    pub evidence: String,
}

/// The law of every invariant of every run among the rows, in their order.
pub fn laws(rows: &[Row]) -> Vec<LawRow> {
    runs(rows).map(law_of).collect()
}

fn runs(rows: &[Row]) -> impl Iterator<Item = &[Row]> {
    rows.chunk_by(|a, b| a.scene == b.scene && a.method == b.method && a.precision == b.precision && a.drift == b.drift)
}

/// Whether a run finished and every stretch of it was measured.
fn is_complete(run: &[Row]) -> bool {
    let measured = |row: &Row| row.error_min.zip(row.error_max).is_some_and(|(low, high)| low <= high);
    run.len() as u64 == STRETCHES
        && run.iter().all(|row| row.outcome == Outcome::Finished && row.failed_at_s.is_none() && measured(row))
}

fn law_of(run: &[Row]) -> LawRow {
    let first = &run[0];
    let complete: Vec<(f64, f64, f64)> =
        run.iter().filter_map(|row| Some((row.t_s, row.error_min?, row.error_max?))).collect();
    let envelope = growth::running_maximum(complete.iter().map(|&(t, low, high)| (t, low.abs().max(high.abs()))));
    // Rounding of the invariant itself: a few units in its last place, gathered over a few thousand steps as a random walk.
    let noise = 256.0 * first.precision.epsilon() * first.scale.max(first.terms);
    let seen = growth::classify(&envelope, noise);
    let largest = envelope.last().map(|sample| sample.error);
    let extreme = |values: Vec<f64>, pick: fn(f64, f64) -> f64| values.into_iter().reduce(pick);
    let ratio = |error: f64| 1.0 + error / first.scale;
    let relative: Vec<(f64, f64)> = complete.iter().map(|&(t, _, high)| (t, high / first.scale)).collect();
    let wants_rate = first.theory_law == Some(Law::Exponential) || seen.law == Law::Exponential;
    LawRow {
        scene: first.scene.clone(),
        method: first.method.clone(),
        precision: first.precision,
        h_s: first.h_s,
        drift: first.drift,
        unit: first.unit.clone(),
        largest_error: largest,
        relative_error: largest.map(|error| error / first.scale),
        law: if first.failed_at_s.is_some() { Law::Diverged } else { seen.law },
        exponent: seen.exponent,
        rate_per_s: if wants_rate { growth::fit_exponential_rate(&relative).map(|line| line.slope) } else { None },
        decade_ratio: seen.decade_ratio,
        theory_law: first.theory_law,
        theory_seen_after_s: first.theory_seen_after_s,
        length_s: run.last().map_or(0.0, |row| row.t_s),
        theory_low: first.theory_low,
        theory_high: first.theory_high,
        ratio_low: extreme(complete.iter().map(|c| ratio(c.1)).collect(), f64::min),
        ratio_high: extreme(complete.iter().map(|c| ratio(c.2)).collect(), f64::max),
        failed_at_s: first.failed_at_s,
        evidence: seen.evidence,
    }
}

/// Every law as CSV; for a reader those in f64.
pub(super) fn table(rows: &[Row]) -> Result<Derived, Error> {
    let laws = laws(rows);
    let headers =
        ["scene", "method", "error of", "largest", "unit", "relative", "law", "theory", "error(T)/error(T/10)"];
    let mut table = Table::new(&headers, &["largest", "relative", "error(T)/error(T/10)"]);
    for law in laws.iter().filter(|law| law.precision == Precision::F64) {
        table.push([
            law.scene.clone(),
            law.method.clone(),
            law.drift.id().to_owned(),
            short(law.largest_error),
            law.unit.clone(),
            short(law.relative_error),
            law.failed_at_s.map_or_else(|| law.law.to_string(), |t| format!("diverged at {} s", short(Some(t)))),
            law.theory_law.map_or_else(|| "–".to_owned(), |law| law.to_string()),
            short(law.decade_ratio),
        ]);
    }
    Ok(Derived {
        name: "growth-laws",
        caption: "Growth laws in f64; the CSV has all precisions, rates, bands and the evidence",
        csv: reports::write_csv(&laws)?,
        table,
    })
}

/// One claim for each run and invariant of which theory says something, in f64.
pub(super) fn claims(rows: &[Row]) -> Vec<Claim> {
    runs(rows).filter(|run| run[0].precision == Precision::F64).filter_map(judged).collect()
}

fn judged(run: &[Row]) -> Option<Claim> {
    let row = &law_of(run);
    let theory = row.theory_law?;
    let band = row.theory_low.zip(row.theory_high);
    let number = |x: Option<f64>| x.map_or_else(|| "none".to_owned(), |x| format!("{x:.9e}"));
    let (statement, theory_text, measured, bound, evidence) = match (theory, band) {
        (Law::Exponential, Some((rate, high))) => (
            "changes exponentially at the rate of theory",
            format!("rate {rate:.9e} 1/s"),
            format!("rate {} 1/s", number(row.rate_per_s)),
            // The rate is a mean over a run that ends within one stretch of its period.
            format!("relative difference at most {EXPONENTIAL_TOLERANCE:.0e}"),
            vec![Evidence::within(
                row.rate_per_s,
                [rate - EXPONENTIAL_TOLERANCE * rate.abs(), high + EXPONENTIAL_TOLERANCE * high.abs()],
            )],
        ),
        (Law::Bounded, Some((low, high))) => (
            "stays inside its exact band",
            format!("value / start in [{low:.9}, {high:.9}]"),
            format!("in [{}, {}]", number(row.ratio_low), number(row.ratio_high)),
            format!("the band, and {ROUNDING_SLACK:.0e} for rounding"),
            {
                let inside = [low - ROUNDING_SLACK, high + ROUNDING_SLACK];
                let width = row.ratio_low.zip(row.ratio_high).map(|(a, b)| b - a);
                vec![
                    Evidence::within(row.ratio_low, inside),
                    Evidence::within(row.ratio_high, inside),
                    // Filled as well as kept: a band that nothing comes near to proves nothing.
                    Evidence::within(width, [0.5 * (high - low), f64::INFINITY]),
                ]
            },
        ),
        _ => (
            "grows by the law of theory",
            theory.to_string(),
            format!("{} ({})", row.law, row.evidence),
            "the same law".to_owned(),
            vec![Evidence::is(row.law == theory || (theory, row.law) == (Law::Bounded, Law::AtTheFloor))],
        ),
    };
    let statement = format!("{} of {} on {} {statement}", row.drift.id(), row.method, row.scene);
    let id = format!("{}.{}.{}", row.scene, row.method, row.drift.id());
    let numbers: Vec<f64> = match theory {
        Law::Exponential => row.rate_per_s.into_iter().collect(),
        _ => [row.ratio_low, row.ratio_high].into_iter().flatten().collect(),
    };
    let mut evidence: Vec<Evidence> = evidence.into_iter().chain([Evidence::is(is_complete(run))]).collect();
    if evidence.contains(&Evidence::Outside) && is_open(row, theory) {
        evidence = vec![Evidence::Undecided];
    }
    Some(
        claim("drift", &id, [statement, theory_text, measured, bound], evidence)
            .on(&row.scene)
            .by(&row.method)
            .with_numbers(numbers),
    )
}

/// Whether a run cannot tell: the invariant has no size to compare with; or two laws fit alike, the run is shorter than what the law
/// needs to be seen, or nothing grew out of the rounding.
fn is_open(row: &LawRow, theory: Law) -> bool {
    let no_size = row.relative_error.is_none_or(|r| !r.is_finite()) && row.failed_at_s.is_none();
    let unseen = row.theory_low.is_none()
        && (row.law == Law::Unclassified
            || row.theory_seen_after_s.is_some_and(|s| row.length_s < s)
            || (row.law == Law::AtTheFloor && theory != Law::AtTheFloor));
    no_size || unseen
}

/// The rate is the slope of ln(E / E0), whose oscillation within a period is (w h) / 2 at most over hundreds of periods.
const EXPONENTIAL_TOLERANCE: f64 = 1e-3;
/// An invariant is summed with a rounding error a step; its random walk over 10^5 steps stays below this part of it.
const ROUNDING_SLACK: f64 = 1e-12;
