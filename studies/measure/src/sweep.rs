//! Work on all cores, with the same result whatever their number.

use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

/// Does every job and returns the results in the order of the jobs. The dearest jobs are started first, so that no core
/// is left with a long one at the end.
pub fn in_parallel<J: Sync, R: Send>(
    jobs: &[J],
    cost: impl Fn(&J) -> u64,
    progress: &Progress,
    work: impl Fn(&J) -> R + Sync,
) -> Vec<R> {
    let mut order: Vec<usize> = (0..jobs.len()).collect();
    order.sort_by_key(|&i| std::cmp::Reverse(cost(&jobs[i])));
    let bar = progress.bar(jobs.len());
    let mut done: Vec<(usize, R)> = order
        .into_par_iter()
        .with_max_len(1)
        .map(|i| {
            let result = work(&jobs[i]);
            bar.inc(1);
            (i, result)
        })
        .collect();
    bar.finish_and_clear();
    done.sort_by_key(|(i, _)| *i);
    done.into_iter().map(|(_, result)| result).collect()
}

/// Whether a person is watching.
#[derive(Clone, Debug, Default)]
pub struct Progress {
    /// What is being done, or `None` to be silent.
    pub label: Option<String>,
}

impl Progress {
    /// No bar.
    pub fn silent() -> Self {
        Progress { label: None }
    }

    /// A bar of that label if a person is watching standard error.
    pub fn on_terminal(label: &str, quiet: bool) -> Self {
        let watched = !quiet && std::io::IsTerminal::is_terminal(&std::io::stderr());
        Progress { label: watched.then(|| label.to_owned()) }
    }

    /// The same bar, if there is one, with another label.
    pub fn name(&mut self, name: &str) {
        if let Some(label) = &mut self.label {
            name.clone_into(label);
        }
    }

    fn bar(&self, length: usize) -> ProgressBar {
        let Some(label) = &self.label else { return ProgressBar::hidden() };
        let template = "{prefix:>14} [{bar:40}] {pos}/{len} {eta}";
        let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        ProgressBar::new(length as u64).with_style(style.progress_chars("=> ")).with_prefix(label.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_the_order_of_the_jobs_whatever_the_cost() {
        let jobs: Vec<u64> = (0..1000).collect();
        let results = in_parallel(&jobs, |j| j * 7919 % 1009, &Progress::silent(), |j| j * j);
        assert_eq!(results, jobs.iter().map(|j| j * j).collect::<Vec<_>>());
    }
}
