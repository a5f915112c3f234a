//! What every study has: a plan, rows, figures and claims.

use std::sync::Arc;

use reports::{Claim, Figure, Table};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::Error;
use crate::game_loop::Loop;
use crate::shard::Shard;
use crate::sweep::{Progress, in_parallel};
use integrator::methods::MethodId;
use scenes::any::AnyScene;
use scenes::run::Precision;
use scenes::scheme::Scheme;

/// What to look at, for every study.
pub struct Selection {
    /// The scenes, with their parameters set.
    pub scenes: Vec<Box<dyn AnyScene>>,
    /// The methods.
    pub methods: Vec<MethodId>,
    /// Schemes for rigid bodies that were chosen by their own name, as `restored-momentum` or `rk4/world-momentum`.
    pub schemes: Vec<Scheme>,
    /// The precisions.
    pub precisions: Vec<Precision>,
    /// The numbers of steps of a sweep, in increasing order; empty for the halvings that each scene suggests.
    pub steps: Vec<u64>,
    /// The length of a run; `None` for the horizon of each scene.
    pub length: Option<Length>,
    /// The starts of an ensemble.
    pub draws: Draws,
    /// Fewer and shorter runs.
    pub quick: bool,
    /// How the step is used, where it was said.
    pub looped: Option<Loop>,
    /// The part of the work to be done; all of it without one.
    pub shard: Option<Arc<Shard>>,
    /// The bar to be shown.
    pub progress: Progress,
}

/// The length of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// In seconds.
    Seconds(f64),
    /// In periods of the scene: see [`scenes::scene::Scene::period_s`].
    Periods(f64),
}

impl Length {
    /// The number, of whatever it counts.
    pub fn number(self) -> f64 {
        match self {
            Length::Seconds(x) | Length::Periods(x) => x,
        }
    }

    /// The end of such a run of a scene, s.
    ///
    /// # Errors
    /// A scene without a period.
    pub fn end_s(self, scene: &dyn AnyScene) -> Result<f64, Error> {
        match self {
            Length::Seconds(s) => Ok(s),
            Length::Periods(n) => scene.scene().period_s().map(|period_s| n * period_s).ok_or_else(|| {
                let message = format!("{} has no period of its own; give seconds, such as 60", scene.id());
                Error::plan("--for", message)
            }),
        }
    }
}

/// How many starts of a scene are drawn, and from which seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draws {
    /// Members of an ensemble.
    pub members: usize,
    /// Seed of the generator.
    pub seed: u64,
}

impl Default for Draws {
    fn default() -> Self {
        Draws { members: 256, seed: 1 }
    }
}

/// No sweep that was not asked for takes more steps in a run.
const MOST_STEPS: u64 = 1 << 22;

impl Selection {
    /// Does the jobs of one list of a study on all cores and gives their rows in the order of the jobs: of a shard those of its own
    /// part. A unit of `cost` takes about `unit_s` seconds.
    pub(crate) fn rows<J: Sync, R: Send>(
        &self,
        jobs: &[J],
        unit_s: f64,
        cost: impl Fn(&J) -> u64,
        work: impl Fn(&J) -> Vec<R> + Sync,
    ) -> Vec<R> {
        self.rows_by(jobs, |i, _| i, unit_s, cost, work)
    }

    /// The same with jobs that only one shard may take together: neighbours with the same `group`, which counts from 0.
    pub(crate) fn rows_by<J: Sync, R: Send>(
        &self,
        jobs: &[J],
        group: impl Fn(usize, &J) -> usize,
        unit_s: f64,
        cost: impl Fn(&J) -> u64,
        work: impl Fn(&J) -> Vec<R> + Sync,
    ) -> Vec<R> {
        let groups: Vec<usize> = jobs.iter().enumerate().map(|(i, job)| group(i, job)).collect();
        let mut seconds = vec![0.0; groups.iter().max().map_or(0, |last| last + 1)];
        for (job, group) in jobs.iter().zip(&groups) {
            seconds[*group] += unit_s * cost(job) as f64;
        }
        let mine = self.takes(&seconds);
        let own: Vec<(usize, &J)> = groups.iter().copied().zip(jobs).filter(|(group, _)| mine[*group]).collect();
        let done = in_parallel(&own, |(_, job)| cost(job), &self.progress, |(_, job)| work(job));
        let mut counts: Vec<Option<usize>> = mine.iter().map(|mine| mine.then_some(0)).collect();
        for ((group, _), rows) in own.iter().zip(&done) {
            counts[*group] = counts[*group].map(|count| count + rows.len());
        }
        self.took(&counts);
        done.into_iter().flatten().collect()
    }

    /// Whether each group of work, which takes about so many seconds, is to be done. [`Self::took`] has to follow.
    pub(crate) fn takes(&self, seconds: &[f64]) -> Vec<bool> {
        self.shard.as_ref().map_or_else(|| vec![true; seconds.len()], |shard| shard.mine(seconds))
    }

    /// How many rows each group that was taken gave.
    pub(crate) fn took(&self, rows: &[Option<usize>]) {
        if let Some(shard) = &self.shard {
            shard.keep(rows);
        }
    }

    /// The end of an error run of a scene, s.
    pub fn end_s(&self, scene: &dyn AnyScene) -> f64 {
        self.given_end_s(scene).unwrap_or(scene.scene().info().horizon_s)
    }

    /// The end of a run of a scene, s, where a length is given and the scene has its unit.
    pub fn given_end_s(&self, scene: &dyn AnyScene) -> Option<f64> {
        self.length.and_then(|length| length.end_s(scene).ok())
    }

    /// The numbers of steps of an error sweep: those asked for, or the halvings from the scene's coarsest step.
    pub fn sweep(&self, scene: &dyn AnyScene, halvings: std::ops::RangeInclusive<u32>) -> Vec<u64> {
        if !self.steps.is_empty() {
            return self.steps.clone();
        }
        let coarsest = self.coarsest_steps(scene);
        halvings.map(|k| coarsest << k).filter(|&steps| steps <= MOST_STEPS).collect()
    }

    /// Steps of the coarsest run: as long as those of the scene's own horizon.
    pub fn coarsest_steps(&self, scene: &dyn AnyScene) -> u64 {
        let info = scene.scene().info();
        let longer = (self.end_s(scene) / info.horizon_s).log2().ceil().clamp(0.0, 40.0);
        info.coarsest_steps << longer as u32
    }
}

/// One question, from the runs to the verdicts. Everything after [`Study::measure`] can start from the CSV of its rows.
pub trait Study {
    /// One line of its CSV.
    type Row: Serialize + DeserializeOwned + Clone;

    /// The name: of the binary, and of the CSV.
    const ID: &'static str;
    /// What its binary does, in one line.
    const ABOUT: &'static str = Self::TITLE;
    /// Command lines worth trying, one a line.
    const EXAMPLES: &'static str = Self::ID;
    /// The question it answers.
    const TITLE: &'static str;
    /// How it answers it, for a reader of the report.
    const INTRO: &'static str;

    /// The keys of a plan that it heeds besides `scene`, `method`, `set` and `quick`. A plan of this study alone that gives another
    /// is refused.
    const HEEDS: &'static [&'static str];

    /// Whether it runs schemes that exist for rigid bodies only.
    const TAKES_SCHEMES: bool = false;

    /// The kinds of its rows, if there are several: each kind has a file of its own.
    const KINDS: &'static [Kind] = &[];

    /// The kind of a row: the `part` of one of [`Study::KINDS`].
    fn part(row: &Self::Row) -> &'static str {
        let _ = row;
        ""
    }

    /// Refuses a selection that leaves nothing to be run.
    ///
    /// # Errors
    /// What leaves nothing to be run, named with what would be right.
    fn check_selection(selection: &Selection) -> Result<(), Error> {
        let _ = selection;
        Ok(())
    }

    /// Tables of times, which follow from no row: a run makes them beside its rows, and nothing else does.
    ///
    /// # Errors
    /// A table that has no form as CSV.
    fn timings(selection: &Selection) -> Result<Vec<Derived>, Error> {
        let _ = selection;
        Ok(Vec::new())
    }

    /// Runs what it needs.
    fn measure(selection: &Selection) -> Vec<Self::Row>;

    /// What follows from the rows, as tables.
    ///
    /// # Errors
    /// A table that has no form as CSV.
    fn tables(rows: &[Self::Row]) -> Result<Vec<Derived>, Error>;

    /// Charts of the rows.
    fn figures(rows: &[Self::Row]) -> Vec<Figure>;

    /// What the rows show, against theory.
    fn claims(rows: &[Self::Row]) -> Vec<Claim>;

    /// Whether a run could have written this row.
    ///
    /// # Errors
    /// What could not: an unknown scene or method, no steps.
    fn check(row: &Self::Row) -> Result<(), String> {
        let _ = row;
        Ok(())
    }
}

/// A kind of row of a study, with a file of its own.
#[derive(Debug, PartialEq, Eq)]
pub struct Kind {
    /// Its name: the value of the field `part`, and a part of the file's name.
    pub part: &'static str,
    /// The columns of its file, separated by commas. Every other field has its default value.
    pub columns: &'static str,
}

/// Refuses a scene that is not in the catalogue.
pub(crate) fn check_scene(id: &str) -> Result<(), String> {
    if scenes::IDS.contains(&id) { Ok(()) } else { Err(format!("scene '{id}' is unknown")) }
}

/// Refuses a method of which this is not known to be the name.
pub(crate) fn check_method(id: &str, is_known: bool) -> Result<(), String> {
    if is_known { Ok(()) } else { Err(format!("method '{id}' is unknown")) }
}

/// Refuses steps that no run takes: there is at least one, and it lasts.
pub(crate) fn check_steps(steps: u64, h_s: f64) -> Result<(), String> {
    let lasts = h_s > 0.0 && h_s.is_finite();
    if steps > 0 && lasts { Ok(()) } else { Err(format!("no run has {steps} steps of {h_s} s")) }
}

/// A table that follows from the rows of a study.
#[derive(Clone, Debug)]
pub struct Derived {
    /// Name of its CSV, without the ending.
    pub name: &'static str,
    /// What it shows.
    pub caption: &'static str,
    /// All of it, as CSV.
    pub csv: String,
    /// What a reader is shown of it.
    pub table: Table,
}

/// A number for a reader: four digits, and a power of ten where it needs one.
pub fn short(x: Option<f64>) -> String {
    x.map_or_else(|| "–".to_owned(), |x| rounded(x, 4))
}

/// A number with so many significant digits, with an exponent where it is small or large.
pub fn rounded(x: f64, digits: u8) -> String {
    let after = i32::from(digits) - 1;
    match x {
        0.0 => "0".to_owned(),
        x if !x.is_finite() => x.to_string(),
        x if (1e-3..1e5).contains(&x.abs()) => {
            let places = (after - x.abs().log10().floor() as i32).max(0) as usize;
            format!("{x:.places$}")
        }
        x => format!("{x:.*e}", after as usize),
    }
}

/// The palette index of a method: the same in every chart.
pub fn color_of(method: MethodId) -> usize {
    MethodId::ALL.iter().position(|m| *m == method).unwrap_or(0)
}

/// The different values, in the order in which they first appear.
pub fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut seen = Vec::new();
    for value in values {
        if !seen.contains(&value) {
            seen.push(value);
        }
    }
    seen
}
