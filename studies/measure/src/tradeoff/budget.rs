//! Advice for a budget: the smallest error for so much time per simulated second.

use super::asked::{Asked, Entry, MOST_FRAMES, Pick, Steady, TIMED_STEPS, task, timed};
use super::candidate::Candidate;
use super::clock::{Cost, Task, TimingEffort, costs};
use super::limit::limit;
use super::search::{Need, Search, Tried, attempt};
use scenes::run::Precision;

/// The least error of every way within the budget: the steps that it pays for, or half of them and half again where rounding
/// makes more of them worse.
pub(super) fn by_budget(asked: &Asked<'_>, ways: &[(Candidate, Precision)]) -> Vec<Entry> {
    let h_s = asked.need.scene.scene().info().horizon_s / TIMED_STEPS as f64;
    let tasks: Vec<Task> = ways.iter().map(|&(c, p)| task(asked, c, p, TIMED_STEPS, h_s)).collect();
    let first = costs(asked.need.scene, &tasks, TimingEffort::FULL);
    let mut entries = timed(
        asked,
        ways.iter()
            .copied()
            .zip(first.iter().map(|cost| affordable(asked, *cost, RESERVE)))
            .map(|(way, steps)| (way, best_of_halvings(asked, way, steps)))
            .collect(),
    );
    for (entry, first) in entries.iter_mut().zip(first) {
        within_budget(asked, entry, first);
    }
    entries
}

/// How often the number of steps is corrected by the time that they took.
const CORRECTIONS: u32 = 4;
/// Part by which a correction stays below the budget, so that the next timing meets it too.
const RESERVE: f64 = 1.02;
/// A cost above this part of the budget uses it up.
const USED: f64 = 0.9;

/// A step costs what its length makes of it, and a timing is not the same twice: what came out too dear takes fewer steps, what came
/// out too cheap more. The best that kept the budget counts.
fn within_budget(asked: &Asked<'_>, entry: &mut Entry, first: Option<Cost>) {
    let way = (entry.candidate, entry.precision);
    let over = |found: &Result<Pick, Search>| found.as_ref().ok().and_then(|pick| over_budget(asked, pick));
    let mut dearer = RESERVE;
    let mut kept: Option<Pick> = None;
    for correction in 0..=CORRECTIONS {
        let Some(over) = over(&entry.found) else { break };
        if let Ok(pick) = &entry.found
            && over <= 1.0
        {
            let error = |pick: &Pick| pick.tried.error.unwrap_or(f64::INFINITY);
            kept = Some(kept.filter(|best| error(best) <= error(pick)).unwrap_or(*pick));
            let is_halved = 4 * pick.tried.steps < 3 * affordable(asked, first, dearer);
            if over >= USED || is_halved {
                break;
            }
        }
        if correction < CORRECTIONS {
            dearer *= RESERVE * over;
            let again = best_of_halvings(asked, way, affordable(asked, first, dearer));
            entry.found = timed(asked, vec![(way, again)]).remove(0).found;
        }
    }
    let is_over = over(&entry.found).is_some_and(|over| over > 1.0);
    if let Some(kept) = kept {
        entry.found = Ok(kept);
    } else if is_over {
        entry.found = Err(Search::OverBudget);
    }
}

/// Cost over budget, if the cost is known.
pub(super) fn over_budget(asked: &Asked<'_>, pick: &Pick) -> Option<f64> {
    Some(pick.ns_per_simulated_second()? / (1e3 * asked.question.budget_us?))
}

/// The steps that the budget pays for, over `dearer`: a multiple of the unit, 0 if not even one unit.
fn affordable(asked: &Asked<'_>, cost: Option<Cost>, dearer: f64) -> u64 {
    let Some((cost, budget)) = cost.zip(asked.question.budget_us) else { return 0 };
    let steps = budget * 1e3 * asked.need.end_s / (cost.least_ns * dearer);
    (steps.min(MOST_FRAMES as f64) as u64) / asked.need.unit * asked.need.unit
}

fn best_of_halvings(asked: &Asked<'_>, way: (Candidate, Precision), steps: u64) -> Steady {
    let Need { scene, end_s, unit, .. } = asked.need;
    if steps < unit {
        return Err(Search::OverBudget);
    }
    let limit = limit(scene, way.0, way.1, end_s);
    let is_stable = |steps: &u64| asked.frames.is_none() || limit.allows(end_s / *steps as f64);
    if !is_stable(&steps) {
        return Err(Search::Unstable { limit_s: limit.h_s });
    }
    let ladder = (0..8).map(|k| (steps >> k) / unit * unit).filter(|&steps| steps >= unit);
    let tried = ladder.filter(is_stable).map(|steps| attempt(&asked.need, way.0, way.1, steps));
    let error = |tried: &Tried| tried.error.unwrap_or(f64::INFINITY);
    let least = tried.filter(|tried| tried.error.is_some()).min_by(|a, b| error(a).total_cmp(&error(b)));
    least.map(|least| (least, limit)).ok_or(Search::TooMany { about: None, least: None, searched: steps })
}
