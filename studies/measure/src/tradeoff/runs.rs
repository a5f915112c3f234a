//! The runs: errors on all cores, then times on one with nothing beside.

use integrator::rigid_body::Formulation;

use super::candidate::{Candidate, Span, candidates};
use super::clock::{Cost, Task, TimingEffort, costs};
use super::exact::{ExactSamples, SAMPLES, apart};
use super::{Part, Row};
use crate::study::Selection;
use crate::sweep::{Progress, in_parallel};
use scenes::any::AnyScene;
use scenes::run::{Outcome, Precision, Trajectory};

/// No run of a study has more steps.
const MOST_STEPS: u64 = 1 << 18;

/// Halvings of the coarsest step. A method of first order needs more of them for the same error; a run in double-double costs a
/// hundred times as much, and is there to show what the others lose.
fn halvings(candidate: Candidate, precision: Precision, quick: bool) -> Option<u32> {
    let implicit = candidate.scheme.is_implicit();
    if precision == Precision::DoubleDouble {
        let halvings = if candidate.scheme.order() == 4 { 9 } else { 7 };
        return (!quick && !implicit).then_some(halvings);
    }
    Some(match (quick, implicit, candidate.scheme.order()) {
        (false, true, _) => 9,
        (false, false, 1) => 14,
        (false, false, _) => 11,
        (true, true, _) => 4,
        (true, false, 1) => 8,
        (true, false, _) => 6,
    })
}

struct Job<'a> {
    truth: &'a ExactSamples<'a>,
    scene: &'a dyn AnyScene,
    candidate: Candidate,
    /// Its number among the candidates of all scenes.
    group: usize,
    precisions: Vec<Precision>,
    span: Span,
}

/// The error and the evaluations of every run.
pub fn errors(selection: &Selection) -> Vec<Row> {
    let scenes: Vec<&dyn AnyScene> = selection.scenes.iter().map(AsRef::as_ref).collect();
    let horizon = |scene: &&dyn AnyScene| selection.end_s(*scene);
    let truths =
        in_parallel(&scenes, |_| 1, &Progress::silent(), |scene| ExactSamples::new(*scene, horizon(scene), SAMPLES));
    let (mut jobs, mut group) = (Vec::new(), 0);
    for (scene, truth) in selection.scenes.iter().zip(&truths) {
        for candidate in candidates(scene.as_ref(), &selection.methods, &selection.schemes) {
            jobs.extend(jobs_of(selection, scene.as_ref(), truth, (candidate, group)));
            group += 1;
        }
    }
    let cost = |job: &Job<'_>| {
        let arithmetic = if job.precisions.contains(&Precision::DoubleDouble) { 100 } else { 1 };
        job.span.steps * arithmetic * job.candidate.evaluations_a_step().unwrap_or(40)
    };
    // What is timed of a candidate follows from all of its runs: a shard takes them together.
    selection.rows_by(&jobs, |_, job| job.group, 1.8e-8, cost, Job::rows)
}

fn jobs_of<'a>(
    selection: &Selection,
    scene: &'a dyn AnyScene,
    truth: &'a ExactSamples<'a>,
    (candidate, group): (Candidate, usize),
) -> Vec<Job<'a>> {
    let (end_s, coarsest) = (selection.end_s(scene), selection.coarsest_steps(scene));
    let finest = |&precision: &Precision| {
        let given = selection.steps.iter().max().copied();
        given.or_else(|| Some(coarsest << halvings(candidate, precision, selection.quick)?))
    };
    let all: Vec<u64> = if selection.steps.is_empty() {
        (0..=14).map(|k| coarsest << k).filter(|&steps| steps <= MOST_STEPS).collect()
    } else {
        selection.steps.clone()
    };
    let job = |steps: u64| {
        let wanted = |p: &&Precision| finest(p).is_some_and(|finest| steps <= finest);
        let precisions: Vec<Precision> = selection.precisions.iter().filter(wanted).copied().collect();
        let span = Span { end_s, steps };
        (!precisions.is_empty()).then_some(Job { truth, scene, candidate, group, precisions, span })
    };
    all.into_iter().filter_map(job).collect()
}

impl Job<'_> {
    fn rows(&self) -> Vec<Row> {
        let wanted = |p| self.precisions.contains(&p);
        let run = |p| self.candidate.run(self.scene, p, self.span, self.truth.stride(self.span.steps));
        let finest = wanted(Precision::DoubleDouble).then(|| run(Precision::DoubleDouble)).flatten();
        let double = (wanted(Precision::F64) || wanted(Precision::F32)).then(|| run(Precision::F64)).flatten();
        let single = wanted(Precision::F32).then(|| run(Precision::F32)).flatten();
        let mut rows = Vec::new();
        let runs = [
            (Precision::F32, &single, &double),
            (Precision::F64, &double, &finest),
            (Precision::DoubleDouble, &finest, &None),
        ];
        for (precision, run, finer) in runs {
            if let Some(run) = run.as_ref().filter(|_| wanted(precision)) {
                rows.push(self.row(precision, run, finer.as_ref()));
            }
        }
        rows
    }

    fn row(&self, precision: Precision, run: &Trajectory, finer: Option<&Trajectory>) -> Row {
        let Span { end_s, steps } = self.span;
        let errors = self.truth.errors(run, steps);
        Row {
            time_scale_s: Some(self.scene.scene().info().time_scale_s),
            unit: self.truth.unit().to_owned(),
            outcome: run.outcome,
            error_end: errors.map(|e| e.end),
            error: errors.map(|e| e.largest),
            attitude_error: self.truth.attitude_error(run, steps),
            rounding: finer.and_then(|finer| apart(run, finer)),
            scale: Some(self.truth.scale()),
            evaluations: run.evaluations,
            ..Row::new(Part::Run, self.scene.id(), self.candidate.id(), precision, steps, end_s / steps as f64)
        }
    }
}

/// Steps of a run that is timed: enough that its start does not show.
const TIMED_STEPS: u64 = 1024;
/// The same in double-double.
const TIMED_STEPS_DOUBLE_DOUBLE: u64 = 128;
/// Lengths of the runs that show what a step of a long run costs.
const LENGTHS: [u64; 5] = [1 << 8, 1 << 10, 1 << 12, 1 << 14, 1 << 16];

/// Fills in the times of the runs, and adds the rows of [`Part::Length`].
pub fn time(selection: &Selection, rows: &mut Vec<Row>) {
    let care = if selection.quick { TimingEffort::QUICK } else { TimingEffort::FULL };
    let mut lengths = Vec::new();
    for scene in &selection.scenes {
        let of_scene = |row: &Row| row.part == Part::Run && row.scene == scene.id();
        let mut tasks = Vec::new();
        for candidate in candidates(scene.as_ref(), &selection.methods, &selection.schemes) {
            for &precision in &selection.precisions {
                let id = candidate.id();
                let sweep: Vec<&Row> =
                    rows.iter().filter(|r| of_scene(r) && r.method == id && r.precision == precision).collect();
                tasks.extend(to_be_timed(&sweep, candidate, precision, selection.quick));
            }
        }
        let costs = costs(scene.as_ref(), &tasks, care);
        let timed: Vec<(Task, Cost)> = tasks.into_iter().zip(costs).filter_map(|(t, c)| Some((t, c?))).collect();
        fill(rows, scene.id(), &timed);
        if !selection.quick && LONG.contains(&scene.id()) {
            let mine = selection.takes(&[0.5])[0];
            let before = lengths.len();
            if mine {
                lengths.extend(length_rows(scene.as_ref(), selection, care));
            }
            selection.took(&[mine.then_some(lengths.len() - before)]);
        }
    }
    rows.append(&mut lengths);
}

/// An explicit step costs the same whatever its length: it is timed once. An implicit one takes more iterations when it is long:
/// three lengths.
fn to_be_timed(sweep: &[&Row], candidate: Candidate, precision: Precision, quick: bool) -> Vec<Task> {
    let most = if precision == Precision::DoubleDouble { TIMED_STEPS_DOUBLE_DOUBLE } else { TIMED_STEPS };
    let finished: Vec<&&Row> = sweep.iter().filter(|row| row.scored().is_some()).collect();
    let mut short: Vec<u64> = finished.iter().map(|row| row.steps).filter(|&steps| steps <= most).collect();
    short.sort_unstable();
    let chosen: Vec<u64> = match short[..] {
        [] => finished.iter().map(|row| row.steps).min().into_iter().collect(),
        [first, .., last] if candidate.scheme.is_implicit() && !quick => vec![first, short[short.len() / 2], last],
        [.., last] => vec![last],
    };
    let end_s = sweep.first().map_or(0.0, |row| row.h_s * row.steps as f64);
    chosen.into_iter().map(|steps| Task { candidate, precision, span: Span { end_s, steps } }).collect()
}

/// Each run gets the time of an evaluation of the timed run that is nearest in length, times its own evaluations.
fn fill(rows: &mut [Row], scene: &str, timed: &[(Task, Cost)]) {
    let is_run = |row: &Row| row.part == Part::Run && row.scene == scene && row.scored().is_some();
    let per_step = |row: &Row| row.evaluations as f64 / row.steps as f64;
    for (task, cost) in timed {
        let (id, precision) = (task.candidate.id(), task.precision);
        let is_of = |row: &Row| is_run(row) && row.method == id && row.precision == precision;
        let Some(own) = rows.iter().find(|row| is_of(row) && row.steps == task.span.steps).map(per_step) else {
            continue;
        };
        for row in rows.iter_mut().filter(|row| is_of(row)) {
            let distance = |steps: u64| (steps as f64 / row.steps as f64).ln().abs();
            if row.timed_steps.is_some_and(|other| distance(other) <= distance(task.span.steps)) {
                continue;
            }
            let scale = per_step(row) / own;
            row.timed_steps = Some(task.span.steps);
            row.least_ns_per_step = Some(cost.least_ns * scale);
            row.median_ns_per_step = Some(cost.median_ns * scale);
            row.upper_ns_per_step = Some(cost.upper_ns * scale);
            row.cycles_per_step = Some(cost.cycles * scale);
        }
    }
}

/// Scenes of which the cost is followed over the length of a run.
const LONG: [&str; 3] = ["oscillator", "pendulum", "torque-free-spin"];

fn length_rows(scene: &dyn AnyScene, selection: &Selection, care: TimingEffort) -> Vec<Row> {
    let chosen = |candidate: &Candidate| {
        !candidate.scheme.is_implicit() && (!candidate.is_rigid || candidate.scheme.storage == Formulation::BodyOmega)
    };
    let end_s = selection.end_s(scene);
    let tasks: Vec<Task> = candidates(scene, &selection.methods, &selection.schemes)
        .into_iter()
        .filter(chosen)
        .flat_map(|candidate| LENGTHS.map(|steps| (candidate, steps)))
        .map(|(candidate, steps)| Task { candidate, precision: Precision::F64, span: Span { end_s, steps } })
        .collect();
    let row = |(task, cost): (&Task, Option<Cost>)| {
        let (steps, cost) = (task.span.steps, cost?);
        Some(Row {
            outcome: Outcome::Finished,
            evaluations: task.candidate.evaluations_a_step()? * steps,
            timed_steps: Some(steps),
            least_ns_per_step: Some(cost.least_ns),
            median_ns_per_step: Some(cost.median_ns),
            upper_ns_per_step: Some(cost.upper_ns),
            cycles_per_step: Some(cost.cycles),
            ..Row::new(Part::Length, scene.id(), task.candidate.id(), task.precision, steps, end_s / steps as f64)
        })
    };
    tasks.iter().zip(costs(scene, &tasks, care)).filter_map(row).collect()
}
