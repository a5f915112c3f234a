//! The same method with the same step, and a rigid body in a physics engine.

use std::hint::black_box;

use integrator::lanes::{Fused, Pack};
use integrator::methods::{ExplicitEuler, RestoredMomentum, Rk4, SemiImplicitEuler};
use integrator::rigid_body::BodyOmega;
use integrator::{Method, Real};
use wide::f64x4;

use crate::bodies::{Free, Ours, Rapier};
use crate::ours::{flat, flat_stored, spin};
use crate::peers::{self, End};
use crate::problem::{Planet, Problem, Spin, Spring, Swing};
use crate::row::Row;
use crate::timing::{Candidate, Timing, interleave};

/// 2^-10 s: dyadic, so that nobody's sum of steps rounds.
const H_S: f64 = 0.000_976_562_5;
const STEPS: u64 = 4096;
const END_S: f64 = H_S * STEPS as f64;

const STORES_NOTHING: &str = "stores the last state";
const STORES_ALL: &str = "stores every step";

/// One candidate of a comparison; the first is what the others are held against.
struct Entry<'a, const N: usize> {
    system: &'static str,
    method: &'static str,
    note: &'static str,
    run: Box<dyn Fn() -> [f64; N] + 'a>,
}

impl<'a, const N: usize> Entry<'a, N> {
    fn new(system: &'static str, method: &'static str, note: &'static str, run: impl Fn() -> [f64; N] + 'a) -> Self {
        Entry { system, method, note, run: Box::new(run) }
    }
    fn peer(system: &'static str, method: &'static str, run: impl Fn() -> End<N> + 'a) -> Self {
        Self::new(system, method, STORES_ALL, move || run().y)
    }
}

/// Runs the entries beside each other; `evaluations` of the force law in a step.
fn compare<P: Problem<N>, const N: usize>(rounds: usize, evaluations: u64, entries: &[Entry<'_, N>]) -> Vec<Row> {
    let candidates: Vec<Candidate<'_>> = entries
        .iter()
        .map(|entry| {
            Candidate::new(|| {
                black_box((entry.run)());
            })
        })
        .collect();
    let timings = interleave(&candidates, rounds);
    println!("\n{}, {} steps of 2^-10 s", P::SCENE, STEPS);
    println!("{:<100} {:>8} {:>8} {:>8} {:>9}  checksum", "", "cycles", "least", "median", "ratio");
    println!("{:<100} {:>8} {:>8} {:>8} {:>9}  error", "", "a step", "ns", "ns", "(median)");
    let exact = P::exact(END_S);
    let rows = entries.iter().zip(&timings).map(|(entry, timing)| {
        let mut row = Row::new("same-step", P::SCENE, entry.system, entry.method.to_owned());
        row.setting = "step 2^-10 s".to_owned();
        row.error = P::error(&(entry.run)(), &exact);
        row.evaluations = Some(evaluations * STEPS);
        row.note = entry.note.to_owned();
        print_line(
            &format!("{} {}, {}", entry.system, entry.method, entry.note),
            timing,
            &timings[0],
            STEPS,
            row.error,
        );
        row.timed(END_S, timing, &timings[0])
    });
    rows.collect()
}

fn print_line(name: &str, timing: &Timing, ours: &Timing, steps: u64, error: f64) {
    let each = |x: f64| x / steps as f64;
    println!(
        "{name:<100} {:>8.1} {:>8.2} {:>8.2} {:>9.2}  {error:.3e}",
        each(timing.least_cycles),
        each(timing.least_ns),
        each(timing.median_ns),
        timing.median_ratio(ours),
    );
}

macro_rules! flat_rk4 {
    ($rounds:ident, $problem:expr, $d:literal, $n:literal) => {{
        let p = $problem;
        let (y0, scene) = (exact_start(p), &p);
        compare_as(
            p,
            $rounds,
            4,
            &[
                Entry::new("integrator", "RK4, fused", STORES_NOTHING, move || {
                    flat::<Fused<f64>, _, _, $d, $n>((&Rk4, black_box(scene)), y0, END_S, STEPS)
                }),
                Entry::new("integrator", "RK4, f64", STORES_NOTHING, move || {
                    flat::<f64, _, _, $d, $n>((&Rk4, black_box(scene)), y0, END_S, STEPS)
                }),
                Entry::new("integrator", "RK4, f64", STORES_ALL, move || {
                    flat_stored::<_, _, $d, $n>((&Rk4, black_box(scene)), y0, END_S, STEPS)
                }),
                Entry::peer("ode_solvers", "RK4", move || peers::ode_solvers_rk4(p, y0, END_S, STEPS)),
                Entry::peer("differential-equations", "RK4", move || {
                    peers::differential_equations_rk4(p, y0, END_S, STEPS)
                }),
            ],
        )
    }};
}

fn exact_start<P: Problem<N>, const N: usize>(_p: P) -> [f64; N] {
    P::exact(0.0)
}

fn compare_as<P: Problem<N>, const N: usize>(
    _p: P,
    rounds: usize,
    evaluations: u64,
    entries: &[Entry<'_, N>],
) -> Vec<Row> {
    compare::<P, N>(rounds, evaluations, entries)
}

fn euler(rounds: usize) -> Vec<Row> {
    let p = Spring::default();
    let (y0, scene) = (exact_start(p), &p);
    compare_as(
        p,
        rounds,
        1,
        &[
            Entry::new("integrator", "explicit Euler, fused", STORES_NOTHING, move || {
                flat::<Fused<f64>, _, _, 1, 2>((&ExplicitEuler, black_box(scene)), y0, END_S, STEPS)
            }),
            Entry::new("integrator", "explicit Euler, f64", STORES_NOTHING, move || {
                flat::<f64, _, _, 1, 2>((&ExplicitEuler, black_box(scene)), y0, END_S, STEPS)
            }),
            Entry::new("integrator", "explicit Euler, f64", STORES_ALL, move || {
                flat_stored::<_, _, 1, 2>((&ExplicitEuler, black_box(scene)), y0, END_S, STEPS)
            }),
            Entry::peer("differential-equations", "Euler", move || {
                peers::differential_equations_euler(p, y0, END_S, STEPS)
            }),
        ],
    )
}

fn spinning(rounds: usize) -> Vec<Row> {
    let p = Spin::default();
    let (y0, scene) = (exact_start(p), &p);
    compare_as(
        p,
        rounds,
        4,
        &[
            Entry::new("integrator", "RK4 on SO(3), fused", STORES_NOTHING, move || {
                let model = BodyOmega::<_>::new(black_box(scene));
                spin::<Fused<f64>, _, _>((&Rk4, &model), y0, END_S, STEPS)
            }),
            Entry::new("integrator", "RK4 on SO(3), f64", STORES_NOTHING, move || {
                let model = BodyOmega::<_>::new(black_box(scene));
                spin::<f64, _, _>((&Rk4, &model), y0, END_S, STEPS)
            }),
            Entry::peer("ode_solvers", "RK4 on R^7", move || peers::ode_solvers_rk4(p, y0, END_S, STEPS)),
            Entry::peer("differential-equations", "RK4 on R^7", move || {
                peers::differential_equations_rk4(p, y0, END_S, STEPS)
            }),
        ],
    )
}

/// How a free body is stepped, and by whom.
struct Stepped {
    system: &'static str,
    method: &'static str,
    note: &'static str,
    run: Box<dyn Fn()>,
    /// The error after `STEPS` steps of one body.
    error: f64,
}

const PIPELINE: &str = "what a user pays: the whole pipeline, without colliders";

fn by_rapier(method: &'static str, iterations: Option<usize>, (count, frames): (usize, u64)) -> Stepped {
    let one = Rapier::new(1, H_S, iterations);
    (0..STEPS).for_each(|_| one.frame());
    let all = Rapier::new(count, H_S, iterations);
    let run = Box::new(move || (0..frames).for_each(|_| all.frame()));
    Stepped { system: "rapier3d-f64", method, note: PIPELINE, run, error: one.error() }
}

fn by_frames<T: Real + 'static, A: Method<T, Free<T>> + Copy + 'static>(
    (rule, method, note): (A, &'static str, &'static str),
    (count, frames): (usize, u64),
    lane: impl Fn(T) -> f64,
) -> Stepped {
    let one = Ours::new(rule, 1, H_S);
    (0..STEPS).for_each(|_| one.frame());
    let all = Ours::new(rule, count, H_S);
    let run = Box::new(move || (0..frames).for_each(|_| all.frame()));
    Stepped { system: "integrator", method, note, run, error: one.error(lane) }
}

fn by_driver(frames: u64) -> Stepped {
    let one = Ours::<Fused<f64>, _>::new(SemiImplicitEuler, 1, H_S);
    one.drive(STEPS);
    let error = one.error(|x| x.0);
    let run = Box::new(move || one.drive(frames));
    Stepped { system: "integrator", method: "semi-implicit Euler, fused", note: "256 steps a call", run, error }
}

/// Eight bodies in a pack.
type Lanes = Pack<Fused<f64x4>, 2>;

fn stepped(count: usize, frames: u64) -> Vec<Stepped> {
    let size = (count, frames);
    let (euler, restored) = ("semi-implicit Euler, f64", "|L| restored, f64");
    let fastest = if count == 1 {
        by_driver(frames)
    } else {
        let rule = (SemiImplicitEuler, "semi-implicit Euler, fused lanes", "eight bodies at a time");
        by_frames::<Lanes, _>(rule, (count / 8, frames), |x| x.0[0].0.to_array()[0])
    };
    vec![
        fastest,
        by_frames::<f64, _>((SemiImplicitEuler, euler, "one step a call"), size, |x| x),
        by_frames::<f64, _>((RestoredMomentum, restored, "one step a call; rapier's own rule"), size, |x| x),
        by_rapier("1 solver iteration", Some(1), size),
        by_rapier("default of 4 solver iterations", None, size),
    ]
}

/// A free body, `count` at a time, per body and step.
fn bodies(rounds: usize, count: usize) -> Vec<Row> {
    let frames = if count == 1 { 256 } else { 1 };
    let entries = stepped(count, frames);
    let candidates: Vec<Candidate<'_>> = entries.iter().map(|entry| Candidate::new(&entry.run)).collect();
    let timings = interleave(&candidates, rounds);
    println!("\na free rigid body with a position, {count} at a time, per body and step of 2^-10 s");
    let body_steps = frames * count as u64;
    let rows = entries.iter().zip(&timings).map(|(Stepped { system, method, note, error, .. }, timing)| {
        let mut row = Row::new("free-body", "torque-free-spin", system, (*method).to_owned());
        row.setting = format!("step 2^-10 s, {count} bodies");
        row.error = *error;
        row.note = (*note).to_owned();
        print_line(&format!("{system} {method}, {note}"), timing, &timings[0], body_steps, *error);
        Row { horizon_s: END_S, ..row.timed(H_S * body_steps as f64, timing, &timings[0]) }
    });
    rows.collect()
}

/// All comparisons of a step.
pub fn all(rounds: usize) -> Vec<Row> {
    let mut rows = flat_rk4!(rounds, Spring::default(), 1, 2);
    rows.extend(euler(rounds));
    rows.extend(flat_rk4!(rounds, Swing::default(), 1, 2));
    rows.extend(flat_rk4!(rounds, Planet::default(), 2, 4));
    rows.extend(spinning(rounds));
    rows.extend(bodies(rounds, 1));
    rows.extend(bodies(rounds.div_ceil(4), 10_000));
    rows
}

/// What is aimed at: the least ratio of a peer's time to ours.
pub fn targets(rows: &[Row]) {
    let ratio = |scene: &str, system: &str, method: &str, setting: &str| {
        rows.iter()
            .find(|r| r.scene == scene && r.system == system && r.method == method && r.setting.ends_with(setting))
            .map_or(f64::NAN, |r| r.ratio_to_ours)
    };
    println!("\ntargets: how many times the time of the integrator with fused arithmetic a peer takes");
    for (scene, system, method, setting, target) in [
        ("oscillator", "ode_solvers", "RK4", "", 1.4),
        ("oscillator", "differential-equations", "RK4", "", 2.0),
        ("oscillator", "differential-equations", "Euler", "", 5.0),
        ("torque-free-spin", "rapier3d-f64", "1 solver iteration", ", 1 bodies", 100.0),
        ("torque-free-spin", "rapier3d-f64", "1 solver iteration", ", 10000 bodies", 100.0),
    ] {
        let measured = ratio(scene, system, method, setting);
        let verdict = if measured >= target { "met" } else { "MISSED" };
        println!("  {scene}, {system} {method}{setting}: {measured:.1}, target {target}: {verdict}");
    }
}
