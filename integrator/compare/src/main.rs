//! The integrator beside its peers, in one process. In this directory, on an idle machine:
//!
//! ```text
//! cargo run --release -- --rounds 400 --csv ../../studies/measure/data/peers.csv
//! cargo run --release -- --problems /tmp/problems.json
//! python3 -m venv /tmp/peers && /tmp/peers/bin/pip install heyoka mujoco numpy
//! /tmp/peers/bin/python with_heyoka.py /tmp/problems.json ../../studies/measure/data/peers.csv
//! /tmp/peers/bin/python with_mujoco.py ../../studies/measure/data/peers.csv
//! ```
//!
//! Same method and step: `ode_solvers` and `differential-equations` for RK4 and Euler, `rapier3d-f64` for a free body.
//! Time to accuracy: the best fixed-step method against adaptive Dop853. Every run's end is held against the exact motion
//! of the scene. Nothing is asserted of a time; a run that computes something else than it should is named, and exits with 1.
//!
//! The package is a workspace of its own: neither the build nor the tests of the main one compile the peers. The two Python
//! scripts are optional; each replaces its own rows of the table.

mod accuracy;
mod bodies;
mod ours;
mod peers;
mod problem;
mod row;
mod same_step;
mod timing;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

use crate::problem::{Planet, Problem, Spin, Swing};
use crate::row::Row;

/// Times the integrator beside its peers.
#[derive(Parser)]
struct Arguments {
    /// Rounds of every comparison.
    #[arg(long, default_value_t = 200)]
    rounds: usize,
    /// Writes every measurement as a row.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Writes starts and exact ends as JSON, for the comparisons from Python, and measures nothing.
    #[arg(long, value_name = "FILE")]
    problems: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &Arguments) -> Result<ExitCode, Box<dyn std::error::Error>> {
    if let Some(file) = &arguments.problems {
        std::fs::write(file, serde_json::to_string_pretty(&problems())? + "\n")?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut rows = same_step::all(arguments.rounds);
    same_step::targets(&rows);
    rows.extend(accuracy::all(arguments.rounds));
    if let Some(file) = &arguments.csv {
        row::write(&rows, file)?;
    }
    let wrong = wrong(&rows);
    for row in &wrong {
        println!("WRONG: {} {} on {} ends {:e} from the exact motion", row.system, row.method, row.scene, row.error);
    }
    Ok(if wrong.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// Rows of a fixed step whose end is not where the method's order puts it: tens of the order-p error of these scenes,
/// whose rates are of the order of a few per second.
fn wrong(rows: &[Row]) -> Vec<&Row> {
    let bound = |row: &Row| match row.comparison {
        "same-step" if row.method.contains("RK4") => 1e-9,
        "same-step" | "free-body" => 5e-2,
        _ => row.asked_error.unwrap_or(f64::NAN),
    };
    rows.iter().filter(|row| !(row.error <= bound(row))).collect()
}

fn problems() -> serde_json::Value {
    fn of<P: Problem<N>, const N: usize>() -> serde_json::Value {
        let ends: Vec<_> = [1.0, 32.0]
            .map(|n| n * P::horizon_s())
            .map(|t| serde_json::json!({ "horizon_s": t, "exact": P::exact(t).to_vec() }))
            .into();
        serde_json::json!({ "start": P::exact(0.0).to_vec(), "ends": ends })
    }
    serde_json::json!({
        "errors": accuracy::ERRORS,
        "pendulum": { "problem": of::<Swing, 2>(), "minus_w0_squared": Swing::default().minus_w0_squared },
        "kepler": { "problem": of::<Planet, 4>(), "minus_mu": Planet::default().minus_mu },
        "torque-free-spin": { "problem": of::<Spin, 7>(), "ratios": Spin::default().ratios },
    })
}
