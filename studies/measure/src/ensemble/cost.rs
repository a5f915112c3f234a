//! What many bodies cost: the time of 1, 2 and 4 times as many of them, and of 1, 2 and 4 times as many steps.

use std::hint::black_box;
use std::time::Instant;

use integrator::methods::MethodId;
use rayon::prelude::*;
use reports::Table;
use serde::Serialize;

use super::draw::{Members, draw, with_a_rule};
use super::lanes::{WIDTH, runs_in_lanes};
use crate::error::Error;
use crate::study::{Derived, Selection, short};

/// Every case is timed in turn so many times, and the least time counts: a busy machine only adds.
const ROUNDS: usize = 15;
/// Steps of the first case: what they take is well above what looking at the ends does.
const STEPS: u64 = 8192;
/// Bodies of the first case, at most.
const MOST_BODIES: usize = 64;

#[derive(Clone, Debug, Serialize)]
struct Case {
    /// Scene or preset.
    scene: String,
    /// Method.
    method: String,
    /// Threads.
    threads: usize,
    /// Bodies that are stepped together.
    bodies: usize,
    /// Steps of each body.
    steps: u64,
    /// Time, s.
    seconds: f64,
    /// Time of one step of one body, ns.
    nanoseconds_a_body_step: f64,
    /// The same over that of the first row.
    over_first: f64,
}

/// The cost of the first chosen scene with a rule, with the first chosen method that runs in lanes. A table of timings:
/// nothing is claimed about it.
///
/// # Errors
/// A table that has no form as CSV.
pub fn table(selection: &Selection, count: usize, seed: u64) -> Result<Derived, Error> {
    let known = with_a_rule();
    let scene = selection.scenes.iter().find(|scene| known.contains(&scene.id()));
    let method = selection.methods.iter().copied().find(|&method| runs_in_lanes(method));
    let cases = match (scene, method) {
        (Some(scene), Some(method)) => {
            let bodies = count.clamp(WIDTH, MOST_BODIES).next_multiple_of(WIDTH);
            let members = draw(scene.as_ref(), 4 * bodies, seed)?;
            measure(scene.id(), scene.scene().info().horizon_s, members.as_ref(), method, bodies)
        }
        _ => Vec::new(),
    };
    let numbers = ["threads", "bodies", "steps", "time (ms)", "ns a body-step", "over the first"];
    let mut table = Table::new(&[&["scene", "method"][..], &numbers].concat(), &numbers);
    for case in &cases {
        table.push([
            case.scene.clone(),
            case.method.clone(),
            case.threads.to_string(),
            case.bodies.to_string(),
            case.steps.to_string(),
            short(Some(case.seconds * 1e3)),
            short(Some(case.nanoseconds_a_body_step)),
            short(Some(case.over_first)),
        ]);
    }
    Ok(Derived {
        name: "ensemble-cost",
        caption: "What many bodies cost, on this machine: the time grows with bodies and with steps, and is shared by the cores. \
                  Whole runs in lanes, none of which failed; the least of 15 \
                  interleaved rounds",
        csv: reports::write_csv(&cases)?,
        table,
    })
}

fn measure(scene: &str, end_s: f64, members: &dyn Members, method: MethodId, bodies: usize) -> Vec<Case> {
    let mut plan = vec![(1, bodies, STEPS)];
    plan.extend([2, 4].map(|k| (1, k as usize * bodies, STEPS)));
    plan.extend([2, 4].map(|k| (1, bodies, k * STEPS)));
    let cores = rayon::current_num_threads();
    if cores > 1 {
        plan.push((cores, 4 * bodies, STEPS));
    }
    // A body that leaves the finite numbers ends its run early: what it takes is not the time of so many steps.
    let whole = |&(_, bodies, steps): &(usize, usize, u64)| {
        let ends = |i: usize| members.ends(i..i + WIDTH, method, end_s, steps);
        (0..bodies).step_by(WIDTH).all(|i| ends(i).is_some_and(|ends| ends.iter().all(Option::is_some)))
    };
    if !whole(&plan[0]) {
        return Vec::new();
    }
    plan.retain(whole);
    let mut least = vec![f64::INFINITY; plan.len()];
    for _ in 0..ROUNDS {
        for (least, &(threads, bodies, steps)) in least.iter_mut().zip(&plan) {
            let packs: Vec<usize> = (0..bodies).step_by(WIDTH).collect();
            let run = |&i: &usize| {
                black_box(members.ends(i..i + WIDTH, method, end_s, steps));
            };
            let clock = Instant::now();
            if threads > 1 {
                packs.par_iter().for_each(run);
            } else {
                packs.iter().for_each(run);
            }
            *least = least.min(clock.elapsed().as_secs_f64());
        }
    }
    let first = least[0];
    let case = |(&(threads, bodies, steps), seconds): (&(usize, usize, u64), f64)| Case {
        scene: scene.to_owned(),
        method: method.id().to_owned(),
        threads,
        bodies,
        steps,
        seconds,
        nanoseconds_a_body_step: seconds * 1e9 / (bodies as f64 * steps as f64),
        over_first: seconds / first,
    };
    plan.iter().zip(least).map(case).collect()
}
