//! The largest step with which a method keeps an error: found by running, not by theory.
//!
//! An error is no monotone function of the step: near a resonance, or where two errors cancel, a long step meets a level that a
//! shorter one misses. So a number of steps counts only if the finer ones meet the level too, as far as they are tried: two
//! doublings, and [`FINER`] between. A run meets a level if its error at every step does; that one sample misses it is enough.

use super::candidate::{Candidate, Span};
use super::exact::{ExactSamples, Watch};
use crate::study::distinct;
use scenes::any::AnyScene;
use scenes::run::{Outcome, Precision};

/// What is asked of a run.
#[derive(Clone, Copy)]
pub struct Need<'a> {
    /// The scene.
    pub scene: &'a dyn AnyScene,
    /// Its exact motion.
    pub truth: &'a ExactSamples<'a>,
    /// The largest error, in m or rad.
    pub error: f64,
    /// End of the run, s.
    pub end_s: f64,
    /// The number of steps is a multiple of this: frames, or 2 so that a step twice as large can be tried.
    pub unit: u64,
}

/// A run that was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tried {
    /// Number of steps.
    pub steps: u64,
    /// Largest error; `None` for a failed run.
    pub error: Option<f64>,
    /// Evaluations of the force law.
    pub evaluations: u64,
    /// Finer numbers of steps that were tried and keep the error too.
    pub finer: usize,
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Search {
    /// The fewest steps that keep the error, as do all finer ones that were tried.
    Found(Tried),
    /// The error falls, but too slowly: about so many steps would do.
    TooMany {
        /// By the order observed, or `None` where none is to be seen.
        about: Option<f64>,
        /// The least error met.
        least: Option<Tried>,
        /// Steps of the longest run tried.
        searched: u64,
    },
    /// The error does not fall any more: rounding, or a failure. The best run is given, if any finished.
    Never {
        /// The least error met.
        least: Option<Tried>,
        /// Steps of the longest run tried.
        searched: u64,
    },
    /// Not even the coarsest run is within the budget.
    OverBudget,
    /// No step that is stable does what is asked.
    Unstable {
        /// The largest stable step, s; 0 where there is none.
        limit_s: f64,
    },
}

/// Steps beyond which a search gives up: less than a second of f32 or f64, of implicit steps or of double-double.
pub fn most_steps(candidate: Candidate, precision: Precision) -> u64 {
    match (candidate.scheme.is_implicit(), precision == Precision::DoubleDouble) {
        (false, false) => 1 << 24,
        (true, true) => 1 << 16,
        _ => 1 << 20,
    }
}

/// Multiples of the number of steps found at which the error has to be kept too.
pub const FINER: [f64; 8] = [1.04, 1.13, 1.27, 1.41, 1.62, 2.0, 2.83, 4.0];
/// The same for a long run.
const FINER_LONG: [f64; 2] = [1.41, 2.0];
/// A run of more steps is a long one.
const LONG: u64 = 1 << 18;
/// Runs up to this length are watched at every step from the beginning; longer ones only where their samples keep the error.
const SHORT: u64 = 1 << 12;
/// How finely the number of steps is found: one part in so many, or one step.
const RESOLUTION: u64 = 128;
/// The same for a long run.
const RESOLUTION_LONG: u64 = 16;
/// Multiples of the first number of steps found beyond which no better one is looked for.
const HIGHEST: u64 = 8;
/// Doublings without a new least error after which rounding is to blame: a run that met a low error by luck is overtaken sooner by
/// a method of first order, whose error falls by this power of two meanwhile.
const STALLED: usize = 6;
/// A least error above this part of the motion's size may be one far from convergence.
const CONVERGING: f64 = 0.1;

/// Roundings of all steps, all one way, may grow by this factor until they are seen.
const AMPLIFIED: f64 = 1e3;

/// One run with so many steps, and its largest error over all of them.
pub fn watched(need: &Need<'_>, candidate: Candidate, precision: Precision, steps: u64) -> Tried {
    let run = |watch: &Watch<'_, '_>| {
        let span = Span { end_s: need.end_s, steps };
        let run = candidate.show(need.scene, precision, span, &|i, seen| watch.see(i, seen))?;
        let finished = run.outcome == Outcome::Finished;
        Some((run.evaluations, if finished { watch.largest() } else { (None, true) }))
    };
    let tried = |(evaluations, (error, _))| Tried { steps, error, evaluations, finer: 0 };
    let failed = Tried { steps, error: None, evaluations: 0, finer: 0 };
    match run(&Watch::new(need.truth, steps)) {
        Some((_, (_, false))) => run(&Watch::exactly(need.truth, steps)).map_or(failed, tried),
        found => found.map_or(failed, tried),
    }
}

/// The same at the samples alone: an error that may be too small.
fn sampled(need: &Need<'_>, candidate: Candidate, precision: Precision, steps: u64) -> Tried {
    let span = Span { end_s: need.end_s, steps };
    let run = candidate.run(need.scene, precision, span, need.truth.stride(steps));
    let error = run.as_ref().and_then(|run| need.truth.errors(run, steps)).map(|errors| errors.largest);
    Tried { steps, error, evaluations: run.map_or(0, |run| run.evaluations), finer: 0 }
}

/// One run with so many steps: its largest error over all of them, or over its samples where these miss the level already.
pub fn attempt(need: &Need<'_>, candidate: Candidate, precision: Precision, steps: u64) -> Tried {
    if steps > SHORT {
        let tried = sampled(need, candidate, precision, steps);
        if !need.is_met(&tried) {
            return tried;
        }
    }
    watched(need, candidate, precision, steps)
}

impl Need<'_> {
    /// Whether a run keeps the error.
    pub fn is_met(&self, tried: &Tried) -> bool {
        tried.error.is_some_and(|error| error <= self.error)
    }
}

/// The finer numbers of steps that are tried beside `m` times a unit.
pub fn finer(m: u64, unit: u64) -> Vec<u64> {
    let factors: &[f64] = if m * unit > LONG { &FINER_LONG } else { &FINER };
    distinct(factors.iter().map(|f| (m as f64 * f).ceil() as u64))
}

/// The largest step of a method that keeps the error.
pub fn search(need: &Need<'_>, candidate: Candidate, precision: Precision) -> Search {
    let most = most_steps(candidate, precision);
    let run = |m: u64| attempt(need, candidate, precision, m * need.unit);
    // The two doublings that bear out a long run are not watched at every step.
    let double =
        |m: u64| if m * need.unit > LONG { sampled(need, candidate, precision, m * need.unit) } else { run(m) };
    let mut doubled: Vec<Tried> = Vec::new();
    let mut m = 1;
    loop {
        let tried = double(m);
        doubled.push(tried);
        // Three in a row: the first of them, with two doublings that bear it out.
        let borne_out = matches!(&doubled[..], [.., a, b, c] if [a, b, c].iter().all(|tried| need.is_met(tried)));
        if borne_out && let Some(found) = narrow(need, m / 4, run) {
            return Search::Found(found);
        }
        let (kept, searched) = (need.is_met(&tried), tried.steps);
        let least = least(&doubled);
        if !kept && is_stalled(&doubled, least, precision.epsilon(), need.truth.scale()) {
            return Search::Never { least: least.map(|(_, least)| least), searched };
        }
        let is_converging = tried.error.is_some_and(|error| error < CONVERGING * need.truth.scale());
        let about = extrapolated(&doubled, need.error, candidate).filter(|_| is_converging);
        let is_hopeless = about.is_some_and(|about| about > 2.0 * most as f64);
        if !kept && (searched >= most || is_hopeless) || searched >= 4 * most {
            return Search::TooMany { about: about.filter(|_| !kept), least: least.map(|(_, least)| least), searched };
        }
        m *= 2;
    }
}

/// Bisects between half of `first` and `first`, and starts again above every finer step that breaks the level; `None` where finer
/// ones break it again and again, or `first` does.
fn narrow(need: &Need<'_>, first: u64, run: impl Fn(u64) -> Tried) -> Option<Tried> {
    let (mut low, mut high) = (first / 2, first);
    let resolution = if first * need.unit > LONG { RESOLUTION_LONG } else { RESOLUTION };
    let mut best = run(high);
    if !need.is_met(&best) {
        return None;
    }
    loop {
        while high - low > (high / resolution).max(1) {
            let middle = low + (high - low) / 2;
            let tried = run(middle);
            if need.is_met(&tried) {
                (high, best) = (middle, tried);
            } else {
                low = middle;
            }
        }
        let finer = finer(high, need.unit);
        let breaks = finer.iter().copied().filter(|&m| !need.is_met(&run(m))).max();
        let Some(breaks) = breaks else { return Some(Tried { finer: finer.len(), ..best }) };
        // Above the breaking one: the next that is kept. Where finer ones break it again and again, rounding does.
        (low, high) = (breaks, breaks + (breaks / resolution).max(1));
        best = run(high);
        while !need.is_met(&best) && high <= HIGHEST * first {
            low = high;
            high += (high / 16).max(1);
            best = run(high);
        }
        if high > HIGHEST * first {
            return None;
        }
    }
}

/// Whether the error has ceased to fall, at a level at which a method converges and that so many roundings explain.
fn is_stalled(doubled: &[Tried], least: Option<(usize, Tried)>, epsilon: f64, scale: f64) -> bool {
    let steps = doubled.last().map_or(0.0, |tried| tried.steps as f64);
    let rounding = (AMPLIFIED * epsilon * steps).min(CONVERGING) * scale;
    least.is_some_and(|(i, least)| i + STALLED < doubled.len() && least.error.is_some_and(|error| error < rounding))
}

/// The run with the least error, and its place; `None` where every run failed.
fn least(tried: &[Tried]) -> Option<(usize, Tried)> {
    let error = |tried: &Tried| tried.error.unwrap_or(f64::INFINITY);
    let least = tried.iter().copied().enumerate().min_by(|a, b| error(&a.1).total_cmp(&error(&b.1)));
    least.filter(|(_, least)| least.error.is_some())
}

/// Steps at which the level would be met, by the order that the last two doublings show, if it is the method's.
fn extrapolated(doubled: &[Tried], level: f64, candidate: Candidate) -> Option<f64> {
    let [.., a, b, c] = doubled else { return None };
    let (a, b, c_error) = (a.error?, b.error?, c.error?);
    let expected = f64::from(candidate.scheme.order());
    let shows = |coarse: f64, fine: f64| ((coarse / fine).log2() - expected).abs() < 0.25;
    (shows(a, b) && shows(b, c_error)).then(|| c.steps as f64 * (c_error / level).powf(1.0 / expected))
}
