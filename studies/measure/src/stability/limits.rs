//! The largest stable step of every linear scene and method: theory, closed form and measured bracket.

use faer::fx128;
use integrator::Single;

use super::amplification;
use super::bisect::{Found, WIDTH, bracket};
use super::failure::Failure;
use super::judge::{self, Trend};
use super::{Part, Row};
use scenes::observation::norm;
use scenes::run::Precision;
use scenes::stepping::{Stepping, coordinates};
use scenes::theory::StabilityLimit;

/// Steps tried, in natural time scales of the scene.
pub const TRIED: [f64; 2] = [1.0 / 4.0, 1024.0];
/// Lengths of the runs that a verdict is sought from, as powers of two; the last one decides.
const LENGTHS: [u32; 3] = [10, 16, 20];
/// The same for implicit methods, whose steps cost a hundred times as much and whose verdicts are not near a limit.
const IMPLICIT_LENGTHS: [u32; 1] = [8];

/// One job: a scene, a method and a precision.
pub(super) fn rows(stepping: &Stepping<'_>) -> Vec<Row> {
    let Some(theory) = amplification::limit(stepping) else { return Vec::new() };
    let mut rows = vec![limit_row(stepping, theory)];
    if theory == StabilityLimit::NoStep && stepping.precision == Precision::F64 {
        rows.extend(RATE_STEPS.iter().filter_map(|&z| rate_row(stepping, z)));
    }
    rows
}

/// The measured bracket of the largest stable step. Theory says only from how far below its limit the search starts.
pub fn measure(stepping: &Stepping<'_>, theory: StabilityLimit) -> Found {
    let scale = stepping.scene.scene().info().time_scale_s;
    let from = match theory {
        StabilityLimit::Below(h) => (h / 8.0).min(TRIED[0] * scale),
        StabilityLimit::NoStep | StabilityLimit::Unlimited => TRIED[0] * scale,
    };
    bracket(from, TRIED[1] * scale, WIDTH, |h| holds(stepping, h))
}

fn limit_row(stepping: &Stepping<'_>, theory: StabilityLimit) -> Row {
    let scene = stepping.scene.scene();
    let scale = scene.info().time_scale_s;
    let found = measure(stepping, theory);
    let closed = scene.stability_limit(stepping.method);
    let (low, high, beyond) = match found {
        Found::NoStep { tried_s } => (None, Some(tried_s), tried_s),
        Found::Bracket { low_s, high_s } => (Some(low_s), Some(high_s), 1.05 * high_s),
        Found::Unlimited { tried_s } => (Some(tried_s), None, tried_s),
    };
    Row {
        low: low.map(|h| h / scale),
        high: high.map(|h| h / scale),
        theory: number(theory).map(|h| h / scale),
        closed_form: closed.and_then(|(limit, _)| number(limit)).map(|h| h / scale),
        failure: beyond_the_limit(stepping, beyond),
        note: closed.map_or_else(String::new, |(_, reason)| reason.to_owned()),
        ..Row::new(Part::Limit, stepping.scene.id(), stepping.method.id(), stepping.precision, "h / time scale", "1")
    }
}

/// A limit as a number: 0 where every step fails, infinity where none does.
pub fn number(limit: StabilityLimit) -> Option<f64> {
    Some(match limit {
        StabilityLimit::NoStep => 0.0,
        StabilityLimit::Below(h) => h,
        StabilityLimit::Unlimited => f64::INFINITY,
    })
}

/// Whether the difference of two runs, one displaced, does not grow exponentially. On a linear scene the difference obeys the
/// equation without forces: what grows is the method's doing, and a steady drift under gravity does not count.
pub fn holds(stepping: &Stepping<'_>, h_s: f64) -> bool {
    let lengths: &[u32] = if stepping.method.is_implicit() { &IMPLICIT_LENGTHS } else { &LENGTHS };
    for &log2_steps in lengths {
        match judge::trend(&difference(stepping, h_s, &GENERIC, log2_steps)) {
            Some(trend) => return trend != Trend::Exponential,
            None => continue,
        }
    }
    true
}

/// A displacement with a part in every mode.
const GENERIC: [f64; 32] = {
    let mut displacement = [0.0; 32];
    let mut i = 0;
    while i < 32 {
        // Weyl's sequence: no two components are related.
        let turn = 0.618_033_988_749_894_9 * (i + 1) as f64;
        displacement[i] = 0.5 + (turn - (turn as u64) as f64);
        i += 1;
    }
    displacement
};

/// Size of the difference of two runs, |dv|, at the steps of [`judge::looks`]: whatever grows exponentially shows in the
/// velocity, and a position that drifts under no force does not.
fn difference(stepping: &Stepping<'_>, h_s: f64, displacement: &[f64], log2_steps: u32) -> Vec<(u64, f64)> {
    difference_at(stepping, h_s, displacement, 1 << log2_steps, &judge::looks(log2_steps), false)
}

fn difference_at(
    stepping: &Stepping<'_>,
    h_s: f64,
    displacement: &[f64],
    steps: u64,
    looks: &[u64],
    with_positions: bool,
) -> Vec<(u64, f64)> {
    let walk = |displacement: &[f64]| stepping.walk(h_s, steps, displacement, looks);
    let (Some(own), Some(moved)) = (walk(&[]), walk(displacement)) else { return Vec::new() };
    let scale = stepping.scene.scene().info().time_scale_s;
    let rounding = stepping.precision.epsilon();
    let mut sizes: Vec<(u64, f64)> = Vec::with_capacity(looks.len());
    for ((step, a), (_, b)) in own.seen.iter().zip(&moved.seen) {
        let (a, b) = (coordinates(a), coordinates(b));
        let difference = size(&a, &b, scale, with_positions);
        let of_terms = size(&a, &vec![fx128::ZERO; a.len()], scale, with_positions);
        // A difference below the rounding of its terms tells nothing: it counts as unchanged.
        let start = sizes.first().map_or(difference, |(_, start)| *start);
        let noise = *step as f64 * rounding * of_terms;
        sizes.push((*step, if difference < noise { difference.min(start) } else { difference }));
    }
    if let Some(step) = own.failed_step.or(moved.failed_step) {
        sizes.push((step, f64::INFINITY));
    }
    sizes
}

fn size(a: &[fx128], b: &[fx128], scale: f64, with_positions: bool) -> f64 {
    let of_position = if with_positions { 1.0 / scale } else { 0.0 };
    let n = a.len() / 2;
    let weight = |i: usize| fx128::from_f64(if i < n { of_position } else { 1.0 });
    let parts: Vec<fx128> = a.iter().zip(b).enumerate().map(|(i, (&x, &y))| (x - y) * weight(i)).collect();
    norm(parts.into_iter()).to_f64()
}

/// What the difference of two runs does at a step that is known to fail, or not to.
fn beyond_the_limit(stepping: &Stepping<'_>, h_s: f64) -> Failure {
    let log2_steps = if stepping.method.is_implicit() { 8 } else { 16 };
    match judge::trend(&difference(stepping, h_s, &GENERIC, log2_steps)) {
        Some(Trend::Exponential) => Failure::of_growth(&difference_early(stepping, h_s)),
        _ => Failure::None,
    }
}

/// The first steps, all of them, up to overflow.
fn difference_early(stepping: &Stepping<'_>, h_s: f64) -> Vec<(u64, f64)> {
    let steps = 1 << 13;
    difference_at(stepping, h_s, &GENERIC, steps, &(0..=steps).collect::<Vec<_>>(), false)
}

/// Steps at which the growth of a method that has no stable step is measured, in natural time scales.
const RATE_STEPS: [f64; 3] = [0.125, 0.25, 0.5];
/// Largest growth used, as a natural logarithm: f64 overflows at 709.
const LN_GROWTH: f64 = 460.0;

/// Growth of the fastest direction in one step, ln |lambda|: measured over the second half of a run, where nothing else is left.
fn rate_row(stepping: &Stepping<'_>, z: f64) -> Option<Row> {
    let h_s = z * stepping.scene.scene().info().time_scale_s;
    let matrix = amplification::matrix(stepping, h_s)?;
    let theory = matrix.spectral_radius()?.ln();
    let direction = matrix.dominant_direction()?;
    let steps = ((LN_GROWTH / theory) as u64).clamp(16, 1 << 20);
    let sizes = difference_at(stepping, h_s, &direction, steps, &[steps / 2, steps], true);
    let [(first, a), (last, b)] = sizes[..] else { return None };
    let measured = (b / a).ln() / (last - first) as f64;
    Some(Row {
        h_s: Some(h_s),
        h_omega: Some(z),
        measured: Some(measured),
        theory: Some(theory),
        failure: Failure::ExponentialGrowth,
        steps,
        ..Row::new(
            Part::GrowthRate,
            stepping.scene.id(),
            stepping.method.id(),
            stepping.precision,
            "ln growth",
            "1/step",
        )
    })
}
