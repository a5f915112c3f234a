//! How wrong is it, from anywhere? The error over many starts of one law of motion instead of one.

pub mod cost;
pub mod draw;
pub mod lanes;
pub use crate::random;
mod show;

use std::ops::Range;

use faer::fx128;
use integrator::Real;
use integrator::methods::MethodId;
use reports::{Claim, Figure};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::study::{Derived, Selection, Study};
use crate::sweep::in_parallel;
use draw::{Members, draw, with_a_rule};
use lanes::runs_in_lanes;
use scenes::any::AnyScene;
use scenes::observation::{Observation, Quantity, largest};
use scenes::run::Precision;
use scenes::theory::ExpectedOrder;

/// Halvings of the step from the coarsest to the finest run.
const HALVINGS: u32 = 8;
/// The same with `--quick`.
const QUICK_HALVINGS: u32 = 5;
/// Members of a job: enough that both cores are busy, few enough that no one waits for the last.
const CHUNK: usize = 64;
/// The largest ensemble: each member takes about a kilobyte a scene.
const MOST_MEMBERS: usize = 1 << 20;

/// The errors of one quantity over an ensemble, with one method and step.
///
/// A member that failed is worse than every one that finished: a quantile that falls on it is empty, and never 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Scene or preset.
    pub scene: String,
    /// How its starts were drawn.
    pub rule: String,
    /// Seed of the starts.
    pub seed: u64,
    /// Method.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// Number of steps.
    pub steps: u64,
    /// Step, s.
    pub h_s: f64,
    /// What was compared, at the end of the run.
    pub quantity: Quantity,
    /// Unit of the errors.
    pub unit: String,
    /// Members of the ensemble.
    pub members: usize,
    /// Members that left the finite numbers.
    pub failed: usize,
    /// The error that half of the members do not exceed.
    pub median: Option<f64>,
    /// The error that 95 % of the members do not exceed.
    pub percentile_95: Option<f64>,
    /// The largest error.
    pub worst: Option<f64>,
    /// Number of the member with the largest error, or of the first that failed; counted from 0.
    pub worst_member: usize,
    /// Its start, as parameters of the scene.
    pub worst_start: String,
    /// Largest size of the quantity among the exact motions at the end, in the same unit.
    pub scale: f64,
    /// The order that theory predicts for every start; empty where it predicts no error but rounding, or only a bound.
    pub theory_order: Option<f64>,
}

/// The study.
pub struct Ensemble;

impl Study for Ensemble {
    type Row = Row;
    const ID: &'static str = "ensemble";
    const HEEDS: &'static [&'static str] = &["precision", "steps", "for", "members", "seed"];
    const ABOUT: &'static str =
        "Starts each scene from many states drawn by its rule, and ranks the errors: median, 95 %, worst";
    const EXAMPLES: &'static str = "ensemble --scene kepler --members 1000
        ensemble --scene torque-free-spin --method rk4 --members 10000 --seed 7";

    fn check_selection(selection: &Selection) -> Result<(), Error> {
        check(selection, selection.draws.members, selection.draws.seed)
    }
    fn timings(selection: &Selection) -> Result<Vec<Derived>, Error> {
        Ok(vec![cost::table(selection, selection.draws.members, selection.draws.seed)?])
    }
    const TITLE: &'static str = "How wrong is it, from anywhere? Ensembles";
    const INTRO: &'static str = "One initial condition may be unrepresentative. Here each scene is started from many states, drawn by its rule from a \
        seed, and its errors at the end are ranked: the median, the 95th percentile and the worst, and where the worst one started. \
        The members run in SIMD lanes and on all cores, with the bits they have alone. A member that fails ranks above all others.";

    fn measure(selection: &Selection) -> Vec<Row> {
        measure(selection, selection.draws.members, selection.draws.seed)
    }
    fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
        show::tables(rows)
    }
    fn figures(rows: &[Row]) -> Vec<Figure> {
        show::figures(rows)
    }
    fn claims(rows: &[Row]) -> Vec<Claim> {
        show::claims(rows)
    }
}

/// Refuses a size or a choice that leaves nothing to be run.
///
/// # Errors
/// What leaves nothing to be run, named with what would be right.
pub fn check(selection: &Selection, count: usize, seed: u64) -> Result<(), Error> {
    if !(1..=MOST_MEMBERS).contains(&count) {
        return Err(Error::plan("--members", format!("{count} members; give 1 to {MOST_MEMBERS}")));
    }
    if !selection.precisions.contains(&Precision::F64) {
        return Err(Error::plan("--precision", "lanes compute in f64; leave --precision out"));
    }
    if !selection.methods.iter().any(|&method| runs_in_lanes(method)) {
        let lanes = MethodId::ALL.iter().filter(|&&method| runs_in_lanes(method)).map(|method| method.id());
        let message = format!(
            "an implicit step compares numbers, each member for itself, and does not run in lanes; give one of {}",
            lanes.collect::<Vec<_>>().join(", ")
        );
        return Err(Error::plan("--method", message));
    }
    // A scene without a rule is left out among others; where nothing is left, it is said why.
    let known = with_a_rule();
    if let (Some(first), false) = (selection.scenes.first(), selection.scenes.iter().any(|s| known.contains(&s.id()))) {
        draw(first.as_ref(), 1, seed)?;
    }
    Ok(())
}

/// A scene with its members and their exact motions.
struct Drawing<'a> {
    scene: &'a dyn AnyScene,
    members: Box<dyn Members>,
    /// End of a run, s.
    end_s: f64,
    exact: Vec<Observation>,
}

struct Job<'a> {
    drawing: &'a Drawing<'a>,
    method: MethodId,
    steps: u64,
    members: Range<usize>,
}

/// The errors of one member, or `None` if it failed.
type Errors = Option<Vec<(Quantity, f64)>>;

/// The rows of every chosen scene, method and step that can run as an ensemble.
pub fn measure(selection: &Selection, count: usize, seed: u64) -> Vec<Row> {
    let drawings: Vec<Drawing<'_>> = selection
        .scenes
        .iter()
        .filter_map(|scene| {
            let members = draw(scene.as_ref(), count, seed).ok()?;
            let end_s = selection.end_s(scene.as_ref());
            let end = fx128::lit(end_s);
            let all: Vec<usize> = (0..count).collect();
            let exact = in_parallel(&all, |_| 1, &crate::sweep::Progress::silent(), |&i| members.alone(i).exact(end));
            Some(Drawing { scene: scene.as_ref(), members, end_s, exact })
        })
        .collect();
    let mut sweeps = Vec::new();
    for drawing in &drawings {
        for &method in selection.methods.iter().filter(|&&method| runs_in_lanes(method)) {
            sweeps.extend(steps(selection, drawing.scene).into_iter().map(|steps| (drawing, method, steps)));
        }
    }
    let chunks: Vec<Range<usize>> = (0..count).step_by(CHUNK).map(|i| i..count.min(i + CHUNK)).collect();
    let cost = |steps: u64, method: MethodId| steps * u64::from(method.order());
    // A step of a member takes about 20 ns.
    let seconds: Vec<f64> = sweeps.iter().map(|&(_, m, n)| 2e-8 * (cost(n, m) * count as u64) as f64).collect();
    let mine = selection.takes(&seconds);
    let own: Vec<_> = sweeps.iter().zip(&mine).filter(|(_, mine)| **mine).map(|(sweep, _)| *sweep).collect();
    let jobs: Vec<Job<'_>> = own
        .iter()
        .flat_map(|&(drawing, method, steps)| {
            chunks.iter().map(move |members| Job { drawing, method, steps, members: members.clone() })
        })
        .collect();
    let done = in_parallel(&jobs, |job| cost(job.steps, job.method), &selection.progress, Job::errors);
    let errors = done.chunks(chunks.len()).map(<[_]>::concat);
    let rows: Vec<Vec<Row>> =
        own.iter().zip(errors).map(|(&(drawing, method, steps), e)| rows(drawing, method, steps, seed, &e)).collect();
    let mut each = rows.iter();
    let counts: Vec<Option<usize>> =
        mine.iter().map(|mine| if *mine { each.next().map(Vec::len) } else { None }).collect();
    selection.took(&counts);
    rows.concat()
}

fn steps(selection: &Selection, scene: &dyn AnyScene) -> Vec<u64> {
    let halvings = if selection.quick { QUICK_HALVINGS } else { HALVINGS };
    let halved = (0..=halvings).map(|k| scene.scene().info().coarsest_steps << k);
    if selection.steps.is_empty() { halved.collect() } else { selection.steps.clone() }
}

impl Job<'_> {
    fn errors(&self) -> Vec<Errors> {
        let Drawing { members, exact, end_s, .. } = self.drawing;
        let packs = self.members.clone().step_by(lanes::WIDTH).map(|i| i..self.members.end.min(i + lanes::WIDTH));
        let ends = packs.flat_map(|pack| members.ends(pack, self.method, *end_s, self.steps).unwrap_or_default());
        let error = |(end, exact): (Option<Observation>, &Observation)| {
            Some(end?.distances(exact)).filter(|errors| errors.iter().all(|(_, error)| error.is_finite()))
        };
        ends.zip(&exact[self.members.clone()]).map(error).collect()
    }
}

fn rows(drawing: &Drawing<'_>, method: MethodId, steps: u64, seed: u64, errors: &[Errors]) -> Vec<Row> {
    let scene = drawing.scene.scene();
    let quantities = drawing.exact[0].values.iter().map(|(quantity, _)| *quantity);
    let row = |quantity| {
        let of = |errors: &Errors| Some(errors.as_ref()?.iter().find(|(q, _)| *q == quantity)?.1);
        let ranked = Ranked::new(errors.iter().map(of));
        let ExpectedOrder::Of(order) = scene.expected_error(method, quantity, drawing.end_s).order else {
            return (quantity, ranked, None);
        };
        (quantity, ranked, Some(order))
    };
    quantities
        .map(row)
        .map(|(quantity, ranked, theory_order)| Row {
            scene: drawing.scene.id().to_owned(),
            rule: drawing.members.rule().to_owned(),
            seed,
            method: method.id().to_owned(),
            precision: Precision::F64,
            steps,
            h_s: drawing.end_s / steps as f64,
            quantity,
            unit: quantity.unit().to_owned(),
            members: errors.len(),
            failed: ranked.failed,
            median: ranked.quantile(50),
            percentile_95: ranked.quantile(95),
            worst: ranked.quantile(100),
            worst_member: ranked.worst_member,
            worst_start: start(scene, drawing.members.alone(ranked.worst_member).scene()),
            scale: largest(drawing.exact.iter().map(|exact| exact.scale(quantity))).unwrap_or(f64::NAN),
            theory_order,
        })
        .collect()
}

/// The parameters in which a member differs from its scene, as `--set` takes them.
fn start(scene: &dyn scenes::scene::Scene, member: &dyn scenes::scene::Scene) -> String {
    let both = scene.parameters().into_iter().zip(member.parameters());
    let differing = both.filter(|(a, b)| a.value != b.value).map(|(_, b)| format!("{}={}", b.name, b.value));
    differing.collect::<Vec<_>>().join(" ")
}

/// Errors in order, the failed above all others.
struct Ranked {
    finished: Vec<f64>,
    failed: usize,
    worst_member: usize,
}

impl Ranked {
    fn new(errors: impl Iterator<Item = Option<f64>>) -> Self {
        let errors: Vec<Option<f64>> = errors.collect();
        let mut finished: Vec<f64> = errors.iter().flatten().copied().collect();
        finished.sort_by(f64::total_cmp);
        let rank = |error: Option<f64>| error.unwrap_or(f64::INFINITY);
        // The first of equals.
        let worst = (0..errors.len()).rev().max_by(|&i, &j| rank(errors[i]).total_cmp(&rank(errors[j])));
        Ranked { failed: errors.len() - finished.len(), finished, worst_member: worst.unwrap_or(0) }
    }

    /// The least error that `percent` % of all members do not exceed; `None` where that is a member that failed.
    fn quantile(&self, percent: usize) -> Option<f64> {
        let rank = ((self.finished.len() + self.failed) * percent).div_ceil(100);
        self.finished.get(rank.max(1) - 1).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // Fails if: a failed member is dropped before the ranks are counted, or ranks as 0.
    #[test]
    fn a_member_that_failed_ranks_above_all_others() {
        let errors = [Some(3.0), None, Some(1.0), Some(2.0)];
        let ranked = Ranked::new(errors.into_iter());
        assert_eq!([25, 50, 75, 100].map(|p| ranked.quantile(p)), [Some(1.0), Some(2.0), Some(3.0), None]);
        assert_eq!((ranked.failed, ranked.worst_member), (1, 1));
        let none = Ranked::new([None, None].into_iter());
        assert_eq!([1, 50, 100].map(|p| none.quantile(p)), [None; 3]);
    }

    // Fails if: the rank is rounded down, or the last of equals is named.
    #[test]
    fn quantiles_are_nearest_ranks_and_the_first_of_equals_is_the_worst() {
        let ranked = Ranked::new([7.0, 7.0, 5.0].into_iter().map(Some));
        assert_eq!([1, 33, 34, 66, 67, 95].map(|p| ranked.quantile(p)), [5.0, 5.0, 7.0, 7.0, 7.0, 7.0].map(Some));
        assert_eq!((ranked.failed, ranked.worst_member), (0, 0));
    }
}
