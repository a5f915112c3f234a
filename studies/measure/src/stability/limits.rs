//! The largest stable step of every linear scene and method: theory, closed form and measured bracket.

use faer::fx128;
use integrator::Single;

use super::amplification;
use super::bisect::{Found, WIDTH, bracket};
use super::failure::Failure;
use super::trend::{self, Trend};
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
/// Growth over a run, as a natural logarithm, that is told from none: its last half grows by e^1.5.
const SEEN: f64 = 3.0;
/// Part of a bracket's width by which a step may lie beyond the limit and not be seen to fail.
pub const UNSEEN: f64 = 0.5;

/// One job: a scene, a method and a precision.
pub(super) fn rows(stepping: &Stepping<'_>) -> Vec<Row> {
    let Some(theory) = amplification::limit(stepping) else { return Vec::new() };
    let mut rows = vec![limit_row(stepping, theory)];
    if theory == StabilityLimit::NoStep && stepping.precision == Precision::F64 {
        rows.extend(RATE_STEPS.iter().filter_map(|&z| rate_row(stepping, z)));
    }
    rows
}

/// The measured bracket of the largest stable step. Theory says only from how far below its limit the search starts, and how long a
/// run must be for the growth beyond it to show.
pub fn measure(stepping: &Stepping<'_>, theory: StabilityLimit) -> Found {
    let scale = stepping.scene.scene().info().time_scale_s;
    let from = match theory {
        StabilityLimit::Below(h) => (h / 8.0).min(TRIED[0] * scale),
        StabilityLimit::NoStep | StabilityLimit::Unlimited => TRIED[0] * scale,
    };
    let trial = Trial::of(stepping, theory);
    bracket(from, TRIED[1] * scale, trial.width, |h| trial.holds(stepping, h))
}

/// How long a step is judged, and how narrow a bracket that allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Steps in which growth shows.
    pub patience: u64,
    /// Width of the bracket, in parts of its upper end.
    pub width: f64,
    /// Whether growth beyond the limit shows at all.
    pub sees: bool,
}

impl Trial {
    /// The width of every bracket where a run of at most 2^20 steps shows the growth of a step that lies [`UNSEEN`] of it beyond the
    /// limit; the next power of two of it that does, where light damping leaves less growth than that.
    pub fn of(stepping: &Stepping<'_>, theory: StabilityLimit) -> Self {
        if stepping.method.is_implicit() {
            return Trial { patience: 1 << IMPLICIT_LENGTHS[0], width: WIDTH, sees: true };
        }
        let StabilityLimit::Below(limit) = theory else {
            return Trial { patience: trend::PATIENCE, width: WIDTH, sees: true };
        };
        let growth = |width: f64| {
            let matrix = amplification::matrix(stepping, limit * (1.0 + UNSEEN * width));
            matrix.and_then(|m| m.spectral_radius()).map_or(0.0, f64::ln)
        };
        let needed = |width: f64| (SEEN / growth(width).max(f64::MIN_POSITIVE)) as u64;
        let mut width = WIDTH;
        while width < WIDEST && needed(width) > 1 << LENGTHS[2] {
            width *= 2.0;
        }
        let (needed, most) = (needed(width), 1 << LENGTHS[2]);
        let patience = needed.min(most).next_power_of_two().max(trend::PATIENCE);
        Trial { patience, width, sees: needed <= most }
    }

    /// The least growth per step, as a natural logarithm, that shows in so many steps.
    pub fn growth(self) -> f64 {
        SEEN / self.patience as f64
    }

    /// Whether the difference of two runs, one displaced, does not grow exponentially. On a linear scene the difference obeys the
    /// equation without forces: what grows is the method's doing, and a steady drift under gravity does not count.
    pub fn holds(self, stepping: &Stepping<'_>, h_s: f64) -> bool {
        let [short, middle, long] = LENGTHS;
        // A run that is longer than growth needs decides what a drift leaves open; none is longer than that where growth needs more.
        let last = if self.patience > 1 << middle { self.patience.ilog2() } else { long };
        let lengths = [short, middle, last];
        let lengths: &[u32] = if stepping.method.is_implicit() { &IMPLICIT_LENGTHS } else { &lengths };
        for &log2_steps in lengths {
            match trend::trend_after(&difference(stepping, h_s, &GENERIC, log2_steps), self.patience) {
                Some(trend) => return trend != Trend::Exponential,
                None => continue,
            }
        }
        true
    }
}

/// The widest bracket, in parts of its upper end: beyond, growth is not looked for.
const WIDEST: f64 = 0.5;

fn limit_row(stepping: &Stepping<'_>, theory: StabilityLimit) -> Row {
    let scene = stepping.scene.scene();
    let scale = scene.info().time_scale_s;
    let (found, trial) = (measure(stepping, theory), Trial::of(stepping, theory));
    let closed = scene.expected_limit(stepping.method);
    let (low, high, beyond) = match found {
        _ if !trial.sees => (None, None, f64::NAN),
        Found::NoStep { tried_s } => (None, Some(tried_s), tried_s),
        Found::Bracket { low_s, high_s } => (Some(low_s), Some(high_s), 1.05 * high_s),
        Found::Unlimited { tried_s } => (Some(tried_s), None, tried_s),
    };
    Row {
        low: low.map(|h| h / scale),
        high: high.map(|h| h / scale),
        theory: number(theory).map(|h| h / scale),
        closed_form: closed.and_then(|(limit, _)| number(limit)).map(|h| h / scale),
        failure: if trial.sees { beyond_the_limit(stepping, beyond) } else { Failure::None },
        steps: trial.patience,
        value: (trial.width > WIDTH).then_some(trial.width),
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

/// Size of the difference of two runs, |dv|, at the steps of [`trend::samples`]: whatever grows exponentially shows in the
/// velocity, and a position that drifts under no force does not.
fn difference(stepping: &Stepping<'_>, h_s: f64, displacement: &[f64], log2_steps: u32) -> Vec<(u64, f64)> {
    difference_at(stepping, h_s, displacement, 1 << log2_steps, &trend::samples(log2_steps), false)
}

fn difference_at(
    stepping: &Stepping<'_>,
    h_s: f64,
    displacement: &[f64],
    steps: u64,
    samples: &[u64],
    with_positions: bool,
) -> Vec<(u64, f64)> {
    let walk = |displacement: &[f64]| stepping.walk(h_s, steps, displacement, samples);
    let (Some(own), Some(moved)) = (walk(&[]), walk(displacement)) else { return Vec::new() };
    let scale = stepping.scene.scene().info().time_scale_s;
    let rounding = stepping.precision.epsilon();
    let mut sizes: Vec<(u64, f64)> = Vec::with_capacity(samples.len());
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
    match trend::trend(&difference(stepping, h_s, &GENERIC, log2_steps)) {
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
