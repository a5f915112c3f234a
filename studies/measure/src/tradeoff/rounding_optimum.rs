//! The U-curve: the error falls with the step until rounding takes over, and then grows.
//!
//! error(n) = A / n^p + R(n): the first from the same method in the next finer arithmetic, the second the sum of n roundings of
//! numbers of the size S. It lies between two models. At least, each step rounds once, independently of the others: ulp / sqrt 12
//! in the root mean square, with an ulp of (eps / 2 .. eps) |x| and |x| of about S / sqrt 2, which is R = eps S sqrt(n) / 10. At
//! most, each step loses a whole eps S, and always the same way: R = eps S n. A motion that forgets its errors has less.
//! Source: P. Henrici, Discrete Variable Methods in Ordinary Differential Equations (1962), 1.4.

use integrator::methods::MethodId;
use reports::Table;
use serde::Serialize;

use super::candidate::Candidate;
use super::cost_at_error::sweeps;
use super::{Part, Row};
use crate::error::Error;
use crate::order::local_order;
use crate::study::{Derived, short};
use scenes::run::Precision;

/// Where a sweep has its least error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Minimum {
    /// Scene or preset.
    pub scene: String,
    /// Method.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// Unit of the errors.
    pub unit: String,
    /// Steps of the best run of the sweep; the true minimum lies between half and twice as many.
    pub steps: u64,
    /// Its step, s.
    pub h_s: f64,
    /// Its error.
    pub error: f64,
    /// The error of the finest run of the sweep.
    pub finest_error: f64,
    /// A: error without rounding, times steps^p.
    pub truncation: f64,
    /// The order p.
    pub order: u32,
    /// Steps of the minimum of A / n^p + eps S sqrt(n) / 10.
    pub random_steps: f64,
    /// Its error.
    pub random_error: f64,
    /// Steps of the minimum of A / n^p + eps S n.
    pub biased_steps: f64,
    /// Its error.
    pub biased_error: f64,
}

/// Root mean square of one rounding, in eps S.
pub const INDEPENDENT: f64 = 0.1;
/// A minimum is one where the error has grown again by this factor at the end of the sweep.
const GROWN: f64 = 2.0;

/// Every minimum that lies inside its sweep, of the explicit methods.
pub fn minima(rows: &[Row]) -> Vec<Minimum> {
    let runs: Vec<&Row> = rows.iter().filter(|row| row.part == Part::Run).collect();
    runs.chunk_by(|a, b| a.scene == b.scene)
        .flat_map(|of_scene| {
            let sweeps = sweeps(of_scene);
            sweeps.iter().filter_map(|sweep| minimum(sweep, &sweeps)).collect::<Vec<_>>()
        })
        .collect()
}

fn minimum(sweep: &[&Row], all: &[Vec<&Row>]) -> Option<Minimum> {
    let first = sweep.first()?;
    let candidate = Candidate::from_id(&first.method).filter(|c| !c.scheme.is_implicit())?;
    let finer = match first.precision {
        Precision::F32 => Precision::F64,
        Precision::F64 => Precision::DoubleDouble,
        Precision::DoubleDouble => return None,
    };
    let scored: Vec<(&Row, f64)> = sweep.iter().filter_map(|row| Some((*row, row.scored()?))).collect();
    let (best, error) = scored.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let (_, finest_error) = *scored.last()?;
    if finest_error < GROWN * error || best.steps == scored[0].0.steps {
        return None;
    }
    let reference = all.iter().find(|s| s[0].method == first.method && s[0].precision == finer)?;
    let truncation = truncation(reference, best.steps, candidate.scheme.order())?;
    let (eps, scale, p) = (first.precision.epsilon(), first.scale?, f64::from(candidate.scheme.order()));
    let model = |rounding: f64, power: f64| {
        let steps = (p * truncation / (power * rounding)).powf(1.0 / (p + power));
        (steps, truncation / steps.powf(p) + rounding * steps.powf(power))
    };
    let ((random_steps, random_error), (biased_steps, biased_error)) =
        (model(INDEPENDENT * eps * scale, 0.5), model(eps * scale, 1.0));
    Some(Minimum {
        scene: first.scene.clone(),
        method: first.method.clone(),
        precision: first.precision,
        unit: first.unit.clone(),
        steps: best.steps,
        h_s: best.h_s,
        error,
        finest_error,
        truncation,
        order: candidate.scheme.order(),
        random_steps,
        random_error,
        biased_steps,
        biased_error,
    })
}

/// How far the order of the two runs that A is taken from may be from the method's.
const ORDER_SLACK: f64 = 0.2;

/// A = error n^p of the finer arithmetic, from the run nearest to the minimum; `None` where it does not fall with the method's
/// order there (a bounce, a method that is exact).
fn truncation(reference: &[&Row], near: u64, order: u32) -> Option<f64> {
    let usable: Vec<(u64, f64)> =
        reference.iter().filter(|row| row.steps <= near).filter_map(|row| Some((row.steps, row.scored()?))).collect();
    let [.., (n1, e1), (n2, e2)] = usable[..] else { return None };
    let seen = local_order((1.0 / n1 as f64, e1), (1.0 / n2 as f64, e2))?;
    ((seen - f64::from(order)).abs() <= ORDER_SLACK).then(|| e2 * (n2 as f64).powi(order as i32))
}

/// The table of the minima; shown are those of the three explicit yardsticks.
///
/// # Errors
/// Rows that have no form as CSV.
pub fn table(rows: &[Row]) -> Result<Derived, Error> {
    let minima = minima(rows);
    let headers = [
        "scene",
        "method",
        "arithmetic",
        "best step (s)",
        "steps",
        "least error",
        "theory: steps",
        "theory: error",
        "error of the finest run",
    ];
    let mut table = Table::new(&headers, &headers[3..]);
    for minimum in minima.iter().filter(|minimum| is_shown(&minimum.method)) {
        let between = |a: f64, b: f64| format!("{} .. {}", short(Some(a)), short(Some(b)));
        table.push([
            minimum.scene.clone(),
            Candidate::from_id(&minimum.method).map_or_else(String::new, Candidate::label),
            minimum.precision.id().to_owned(),
            short(Some(minimum.h_s)),
            minimum.steps.to_string(),
            format!("{} {}", short(Some(minimum.error)), minimum.unit),
            format!("{:.0} .. {:.0}", minimum.biased_steps, minimum.random_steps),
            between(minimum.random_error, minimum.biased_error),
            short(Some(minimum.finest_error)),
        ]);
    }
    Ok(Derived {
        name: "tradeoff-rounding-optimum",
        caption: "Where a smaller step makes it worse: the least error of a sweep, and between which minima theory puts it, with \
                  roundings that all go one way (eps S n) and roundings that are independent (eps S sqrt(n) / 10)",
        csv: reports::write_csv(&minima)?,
        table,
    })
}

/// The methods whose U-curves are shown.
pub(super) const SHOWN: [MethodId; 3] = [MethodId::SemiImplicitEuler, MethodId::VelocityVerlet, MethodId::Rk4];

fn is_shown(method: &str) -> bool {
    SHOWN.iter().any(|m| method.strip_prefix(m.id()).is_some_and(|rest| rest.is_empty() || rest == "/body-omega"))
}
