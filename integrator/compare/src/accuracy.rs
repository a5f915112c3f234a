//! Time to accuracy: the coarsest setting of each method that meets an error at the horizon, and what it then costs.

use std::hint::black_box;

use crate::ours::{Solver, flat_solvers, spin_solvers};
use crate::peers::{End, differential_equations_dop853, ode_solvers_dop853};
use crate::problem::{Planet, Problem, Spin, Swing};
use crate::row::Row;
use crate::timing::{Candidate, interleave};

/// The errors asked for.
pub const ERRORS: [f64; 3] = [1e-3, 1e-6, 1e-9];

/// Finer settings that must meet the error too: an error that happens to cross zero is not accuracy.
const CONFIRMED: usize = 4;

/// A setting that just meets the error, with what it gave.
#[derive(Clone, Copy)]
struct Met<S> {
    setting: S,
    error: f64,
}

/// The error of each setting, from coarse to fine, until it is `CONFIRMED` to be below the least that is asked for.
fn errors<S: Copy>(settings: impl Iterator<Item = S>, error: impl Fn(S) -> f64) -> Vec<Met<S>> {
    let (least, mut confirmed) = (ERRORS[ERRORS.len() - 1], 0);
    let mut seen = Vec::new();
    for setting in settings {
        let error = error(setting);
        seen.push(Met { setting, error });
        confirmed = if error <= least { confirmed + 1 } else { 0 };
        if confirmed > CONFIRMED {
            break;
        }
    }
    seen
}

/// The coarsest setting from which on the error is met, `CONFIRMED` finer ones included.
fn coarsest<S: Copy>(seen: &[Met<S>], asked: f64) -> Option<Met<S>> {
    let (mut found, mut confirmed) = (None, 0);
    for &met in seen {
        if !(met.error <= asked) {
            (found, confirmed) = (None, 0);
            continue;
        }
        found = found.or(Some(met));
        confirmed += 1;
        if confirmed > CONFIRMED {
            return found;
        }
    }
    None
}

/// 1, 2, 3, ... with at most eight settings an octave.
fn step_counts() -> impl Iterator<Item = u64> {
    let mut last = 0;
    (0..8 * 23).filter_map(move |i| {
        let n = 2.0_f64.powf(f64::from(i) / 8.0).round() as u64;
        (n > last).then(|| {
            last = n;
            n
        })
    })
}

/// 10, ..., 1e-14 with eight settings a decade.
fn tolerances() -> impl Iterator<Item = f64> {
    (0..8 * 15).map(|i| 10.0_f64.powf(1.0 - f64::from(i) / 8.0))
}

/// A candidate that meets the error.
struct Runner<'a> {
    row: Row,
    ours: bool,
    run: Box<dyn Fn() + 'a>,
}

/// More steps than any method that has a chance needs, 1/s.
const MOST_STEPS: f64 = 2048.0;

/// A method and the errors of its settings.
type Tried<'a, const N: usize> = (&'a Solver<'a, N>, Vec<Met<u64>>);

fn tried<'a, P: Problem<N>, const N: usize>(solvers: &'a [Solver<'a, N>], end_s: f64) -> Vec<Tried<'a, N>> {
    let (exact, limit) = (P::exact(end_s), (end_s * MOST_STEPS) as u64);
    let seen = |solver: &Solver<'_, N>| {
        errors(step_counts().take_while(|&n| n <= limit), |n| P::error(&(solver.run)(n), &exact))
    };
    solvers.iter().map(|solver| (solver, seen(solver))).collect()
}

fn ours<'a, P: Problem<N>, const N: usize>(tried: &'a [Tried<'a, N>], asked: f64) -> Vec<Runner<'a>> {
    let runner = |(solver, seen): &'a Tried<'a, N>| {
        let met = coarsest(seen, asked)?;
        let method = format!("{}, {}", solver.method, solver.arithmetic);
        let mut row = Row::new("time-to-accuracy", P::SCENE, "integrator", method);
        row.setting = format!("{} steps", met.setting);
        row.error = met.error;
        row.evaluations = Some((solver.evaluations)(met.setting));
        row.note = "stores the last state".to_owned();
        let run = Box::new(move || {
            black_box((solver.run)(met.setting));
        });
        Some(Runner { row, ours: true, run })
    };
    tried.iter().filter_map(runner).collect()
}

fn peer<'a, P: Problem<N> + 'a, const N: usize>(
    (system, solve): (&'static str, impl Fn(P, [f64; N], f64, f64) -> End<N> + 'a),
    p: P,
    asked: f64,
    end_s: f64,
) -> Option<Runner<'a>> {
    let (y0, exact) = (P::exact(0.0), P::exact(end_s));
    let seen = errors(tolerances(), |tolerance| P::error(&solve(p, y0, end_s, tolerance).y, &exact));
    let met = coarsest(&seen, asked)?;
    let mut row = Row::new("time-to-accuracy", P::SCENE, system, "Dop853, adaptive".to_owned());
    row.setting = format!("tolerance {:.1e}", met.setting);
    row.error = met.error;
    row.evaluations = Some(solve(p, y0, end_s, met.setting).evaluations);
    row.note = "stores every step, no dense output".to_owned();
    let run = Box::new(move || {
        black_box(solve(p, y0, end_s, met.setting));
    });
    Some(Runner { row, ours: false, run })
}

/// The leaders of ours that are worth a second, longer look.
const FINALISTS: usize = 4;

fn contest<P: Problem<N>, const N: usize>(p: P, solvers: &[Solver<'_, N>], end_s: f64, rounds: usize) -> Vec<Row> {
    let mut rows = Vec::new();
    let tried = tried::<P, N>(solvers, end_s);
    for asked in ERRORS {
        let mut runners = ours::<P, N>(&tried, asked);
        let heats: Vec<Candidate<'_>> = runners.iter().map(|r| Candidate::new(&r.run)).collect();
        let heat = interleave(&heats, rounds.div_ceil(10));
        let mut order: Vec<usize> = (0..runners.len()).collect();
        order.sort_by(|&a, &b| heat[a].least_ns.total_cmp(&heat[b].least_ns));
        drop(heats);
        let mut finalists: Vec<Option<Runner<'_>>> = runners.drain(..).map(Some).collect();
        let mut field: Vec<Runner<'_>> =
            order.into_iter().take(FINALISTS).filter_map(|i| finalists[i].take()).collect();
        field.extend(peer(("ode_solvers", ode_solvers_dop853), p, asked, end_s));
        field.extend(peer(("differential-equations", differential_equations_dop853), p, asked, end_s));
        rows.extend(final_round::<P, N>(field, asked, end_s, rounds));
    }
    rows
}

fn final_round<P: Problem<N>, const N: usize>(
    field: Vec<Runner<'_>>,
    asked: f64,
    end_s: f64,
    rounds: usize,
) -> Vec<Row> {
    let candidates: Vec<Candidate<'_>> = field.iter().map(|r| Candidate::new(&r.run)).collect();
    let timings = interleave(&candidates, rounds);
    let best = |mine: bool| {
        let of = field.iter().zip(&timings).filter(|(r, _)| r.ours == mine);
        of.min_by(|a, b| a.1.least_ns.total_cmp(&b.1.least_ns))
    };
    let Some((leader, best_of_ours)) = best(true) else {
        println!("\n{}, error {asked:e} after {end_s} s: no method of ours meets it", P::SCENE);
        return Vec::new();
    };
    println!("\n{}, error at most {asked:e} after {end_s} s ({})", P::SCENE, P::NUMBERS);
    println!("{:<64} {:>16} {:>9} {:>6} {:>10} {:>8}", "", "setting", "error", "evals", "ns/s", "x ours");
    let mut rows = Vec::new();
    for (runner, timing) in field.iter().zip(&timings) {
        let mut row = runner.row.clone().timed(end_s, timing, best_of_ours);
        row.asked_error = Some(asked);
        println!(
            "{:<64} {:>16} {:>9.1e} {:>6} {:>10.1} {:>8.2}",
            format!("{} {}", row.system, row.method),
            row.setting,
            row.error,
            row.evaluations.unwrap_or(0),
            row.ns_per_simulated_second,
            row.ratio_to_ours
        );
        rows.push(row);
    }
    if let Some((peer, timing)) = best(false) {
        let ratio = timing.least_ns / best_of_ours.least_ns;
        let (who, by) = if ratio >= 1.0 { (leader, ratio) } else { (peer, 1.0 / ratio) };
        println!("leads: {} {}, by a factor of {by:.2}", who.row.system, who.row.method);
    }
    rows
}

/// All contests: each scene for its own horizon and for 32 of them, where the cost of starting no longer shows.
pub fn all(rounds: usize) -> Vec<Row> {
    let (swing, planet, spin) = (Swing::default(), Planet::default(), Spin::default());
    let mut rows = Vec::new();
    for horizons in [1.0, 32.0] {
        let end_s = horizons * Swing::horizon_s();
        let solvers = flat_solvers::<_, 1, 2>(&swing, Swing::exact(0.0), end_s);
        rows.extend(contest(swing, &solvers, end_s, rounds));
        let end_s = horizons * Planet::horizon_s();
        let solvers = flat_solvers::<_, 2, 4>(&planet, Planet::exact(0.0), end_s);
        rows.extend(contest(planet, &solvers, end_s, rounds));
        let end_s = horizons * Spin::horizon_s();
        let solvers = spin_solvers(&spin, Spin::exact(0.0), end_s);
        rows.extend(contest(spin, &solvers, end_s, rounds));
    }
    rows
}
