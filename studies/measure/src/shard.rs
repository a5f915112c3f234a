//! A part of a plan: what one of several runs takes, so that together they take everything once.
//!
//! A study lists its work as groups with costs, in an order that follows from the plan alone. The groups are given out, the dearest
//! first, each to the shard that has least to do; every shard makes the same list and takes its own part. How many rows each group
//! gave is kept, so that the rows of all shards can be put back in the order of one run.

use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};

/// One of `count` parts, counted from 1.
#[derive(Debug)]
pub struct Shard {
    /// Which part, from 1 to `count`.
    pub index: usize,
    /// How many parts there are.
    pub count: usize,
    log: Mutex<Log>,
}

/// A group of work that was taken, and the rows that it gave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Taken {
    /// Its number in the plan.
    pub group: usize,
    /// Its rows.
    pub rows: usize,
}

/// What a study did of its work.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Part {
    /// Groups of the whole study.
    pub groups: usize,
    /// Those that were taken, in their order.
    pub taken: Vec<Taken>,
}

#[derive(Debug, Default)]
struct Log {
    part: Part,
    /// Seconds given to each shard so far, roughly: over all studies of a run.
    loads: Vec<f64>,
    /// Seconds of all groups of the study.
    seconds: f64,
}

impl Shard {
    /// The part `index` of `count`.
    pub fn new(index: usize, count: usize) -> Self {
        Shard { index, count, log: Mutex::new(Log { loads: vec![0.0; count], ..Log::default() }) }
    }

    fn log(&self) -> MutexGuard<'_, Log> {
        // A log of plain numbers is whole whenever it is unlocked.
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Gives out groups that take so many seconds each, roughly: whether each is this shard's.
    pub(crate) fn mine(&self, seconds: &[f64]) -> Vec<bool> {
        let mut log = self.log();
        let mut order: Vec<usize> = (0..seconds.len()).collect();
        order.sort_by(|&a, &b| seconds[b].total_cmp(&seconds[a]).then(a.cmp(&b)));
        let mut mine = vec![false; seconds.len()];
        for group in order {
            let least = (0..self.count).min_by(|&a, &b| log.loads[a].total_cmp(&log.loads[b]).then(a.cmp(&b)));
            let least = least.unwrap_or(0);
            log.loads[least] += seconds[group];
            mine[group] = least + 1 == self.index;
        }
        log.seconds += seconds.iter().sum::<f64>();
        mine
    }

    /// Keeps how many rows each group of the last list gave; `None` for those of other shards.
    pub(crate) fn keep(&self, rows: &[Option<usize>]) {
        let mut log = self.log();
        let first = log.part.groups;
        let taken = rows.iter().enumerate().filter_map(|(i, rows)| Some(Taken { group: first + i, rows: (*rows)? }));
        log.part.taken.extend(taken);
        log.part.groups += rows.len();
    }

    /// What the study that ran last did, and how many seconds all of its groups take, roughly. The next study starts anew.
    pub fn finish(&self) -> (Part, f64) {
        let mut log = self.log();
        (std::mem::take(&mut log.part), std::mem::take(&mut log.seconds))
    }
}

/// Puts the rows of all shards of a study in the order of one run. Each shard brings what it took and its rows.
///
/// # Errors
/// A group that is missing or was taken twice, or rows that are not as many as were counted.
pub fn in_order<R>(shards: Vec<(Part, Vec<R>)>) -> Result<Vec<R>, String> {
    let groups = shards.first().map_or(0, |(part, _)| part.groups);
    let mut slots: Vec<Option<Vec<R>>> = (0..groups).map(|_| None).collect();
    for (part, rows) in shards {
        let counted: usize = part.taken.iter().map(|taken| taken.rows).sum();
        if part.groups != groups || counted != rows.len() {
            return Err(format!(
                "{} rows of {} groups, where {counted} of {groups} were counted",
                rows.len(),
                part.groups
            ));
        }
        let mut rows = rows.into_iter();
        for taken in part.taken {
            let slot =
                slots.get_mut(taken.group).ok_or_else(|| format!("group {} is none of {groups}", taken.group))?;
            if slot.replace(rows.by_ref().take(taken.rows).collect()).is_some() {
                return Err(format!("group {} was taken twice", taken.group));
            }
        }
    }
    let missing = slots.iter().position(Option::is_none);
    missing.map_or(Ok(()), |group| Err(format!("group {group} is missing")))?;
    Ok(slots.into_iter().flatten().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        // Fails if: a group is taken by no shard or by two, the rows come back in another order, or a shard has much more to do.
        #[test]
        fn shards_take_everything_once(
            lists in prop::collection::vec(prop::collection::vec(0.0..5.0_f64, 0..40), 1..5), count in 1_usize..17,
        ) {
            let mut parts = Vec::new();
            let mut loads = Vec::new();
            for index in 1..=count {
                let shard = Shard::new(index, count);
                let mut rows = Vec::new();
                for (l, list) in lists.iter().enumerate() {
                    let mine = shard.mine(list);
                    let own = mine.iter().enumerate().map(|(i, mine)| mine.then_some(i % 3)).collect::<Vec<_>>();
                    rows.extend(own.iter().enumerate().flat_map(|(i, n)| vec![(l, i); n.unwrap_or(0)]));
                    shard.keep(&own);
                }
                loads.push(shard.log().loads[index - 1]);
                parts.push((shard.finish().0, rows));
            }
            let whole: Vec<(usize, usize)> = lists
                .iter()
                .enumerate()
                .flat_map(|(l, list)| (0..list.len()).flat_map(move |i| vec![(l, i); i % 3]))
                .collect();
            prop_assert_eq!(in_order(parts.clone()).expect("all there"), whole);
            // The dearest group is the most by which two shards differ.
            let (least, most) = loads.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), x| (l.min(*x), m.max(*x)));
            prop_assert!(most - least <= 5.0 * lists.len() as f64);
            if parts.iter().any(|(part, _)| !part.taken.is_empty()) {
                let lost = parts.iter().position(|(part, _)| !part.taken.is_empty()).expect("one");
                let mut twice = parts.clone();
                twice.push(parts[lost].clone());
                prop_assert!(in_order(twice).is_err());
                parts.remove(lost);
                prop_assert!(parts.is_empty() || in_order(parts).is_err());
            }
        }
    }
}
