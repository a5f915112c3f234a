//! The largest step with which a method keeps an error: found by running, not by theory.
//!
//! An error is no monotone function of the step: near a resonance, or where two errors cancel, a long step meets a level that a
//! shorter one misses. So a number of steps counts only if the finer ones meet the level too, as far as they are tried: two
//! doublings, and [`FINER`] between.

use super::candidate::{Candidate, Span};
use super::truth::Truth;
use crate::study::distinct;
use scenes::any::AnyScene;
use scenes::run::Precision;

/// What is asked of a run.
#[derive(Clone, Copy)]
pub struct Need<'a> {
    /// The scene.
    pub scene: &'a dyn AnyScene,
    /// Its exact motion.
    pub truth: &'a Truth<'a>,
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
    },
    /// The error does not fall any more: rounding, or a failure. The best run is given, if any finished.
    Never {
        /// The least error met.
        least: Option<Tried>,
    },
    /// Not even the coarsest run is within the budget.
    OverBudget,
    /// No step that is stable does what is asked.
    Unstable {
        /// The largest stable step, s; 0 where there is none.
        limit_s: f64,
    },
}

/// Steps beyond which a search gives up.
pub const MOST_STEPS: u64 = 1 << 20;
/// Multiples of the number of steps found at which the error has to be kept too.
pub const FINER: [f64; 8] = [1.04, 1.13, 1.27, 1.41, 1.62, 2.0, 2.83, 4.0];
/// How finely the number of steps is found: one part in so many, or one step.
const RESOLUTION: u64 = 128;
/// Multiples of the first number of steps found beyond which no better one is looked for.
const HIGHEST: u64 = 8;
/// Doublings without a new least error after which rounding is to blame: a run that met a low error by luck is overtaken sooner by
/// a method of first order, whose error falls by this power of two meanwhile.
const STALLED: usize = 6;
/// A least error above this may be one far from convergence.
const CONVERGING: f64 = 0.1;

/// One run with so many steps.
pub fn attempt(need: &Need<'_>, candidate: Candidate, precision: Precision, steps: u64) -> Tried {
    let span = Span { end_s: need.end_s, steps };
    let run = candidate.run(need.scene, precision, span, need.truth.stride(steps));
    let error = run.as_ref().and_then(|run| need.truth.errors(run, steps)).map(|errors| errors.largest);
    Tried { steps, error, evaluations: run.map_or(0, |run| run.evaluations), finer: 0 }
}

/// The finer numbers of steps that are tried beside `m`.
pub fn finer(m: u64) -> Vec<u64> {
    distinct(FINER.map(|f| (m as f64 * f).ceil() as u64))
}

/// The largest step of a method that keeps the error.
pub fn search(need: &Need<'_>, candidate: Candidate, precision: Precision) -> Search {
    let run = |m: u64| attempt(need, candidate, precision, m * need.unit);
    let meets = |tried: &Tried| tried.error.is_some_and(|error| error <= need.error);
    let mut doubled: Vec<Tried> = Vec::new();
    let mut m = 1;
    let first = loop {
        let tried = run(m);
        doubled.push(tried);
        // Three in a row: the first of them, with two doublings that bear it out.
        if let [.., a, b, c] = &doubled[..]
            && meets(a)
            && meets(b)
            && meets(c)
        {
            break m / 4;
        }
        let kept = meets(&tried);
        if let Some(end) = hopeless(&doubled, need.error, candidate).filter(|_| !kept) {
            return end;
        }
        if tried.steps >= MOST_STEPS && !kept || tried.steps >= 4 * MOST_STEPS {
            let about = extrapolated(&doubled, need.error, candidate);
            return Search::TooMany { about, least: least(&doubled).map(|(_, least)| least) };
        }
        m *= 2;
    };
    narrow(first, meets, run)
}

/// Bisects between half of `first` and `first`, which is kept, and starts again above every finer step that breaks the level.
fn narrow(first: u64, meets: impl Fn(&Tried) -> bool, run: impl Fn(u64) -> Tried) -> Search {
    let (mut low, mut high) = (first / 2, first);
    let mut best = run(high);
    loop {
        while high - low > (high / RESOLUTION).max(1) {
            let middle = low + (high - low) / 2;
            let tried = run(middle);
            if meets(&tried) {
                (high, best) = (middle, tried);
            } else {
                low = middle;
            }
        }
        let finer = finer(high);
        let breaks = finer.iter().copied().filter(|&m| !meets(&run(m))).max();
        let Some(breaks) = breaks else { return Search::Found(Tried { finer: finer.len(), ..best }) };
        // Above the breaking one: the next that is kept. Where finer ones break it again and again, rounding does.
        (low, high) = (breaks, breaks + (breaks / RESOLUTION).max(1));
        best = run(high);
        while !meets(&best) && high <= HIGHEST * first {
            low = high;
            high += (high / 16).max(1);
            best = run(high);
        }
        if high > HIGHEST * first {
            return Search::Never { least: None };
        }
    }
}

/// Whether the doublings so far tell that no more of them will do.
fn hopeless(doubled: &[Tried], level: f64, candidate: Candidate) -> Option<Search> {
    let least = least(doubled);
    let stalled =
        |(i, least): &(usize, Tried)| i + STALLED < doubled.len() && least.error.is_some_and(|e| e < CONVERGING);
    if let Some((_, least)) = least.filter(stalled) {
        return Some(Search::Never { least: Some(least) });
    }
    let about = extrapolated(doubled, level, candidate)?;
    (about > 16.0 * MOST_STEPS as f64)
        .then_some(Search::TooMany { about: Some(about), least: least.map(|(_, least)| least) })
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
