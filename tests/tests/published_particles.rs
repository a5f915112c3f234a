//! Numbers about particles that other projects print, reproduced with this project's integrator and exact motions.

use std::path::PathBuf;

use faer::fx128;
use integrator::methods::SemiImplicitEuler;
use integrator::{Single, State, drive};
use nalgebra::Vector2;
use scenes::motion::Motion;
use scenes::{Kepler, Pendulum};

/// (step, quantity, value, digits that can be reproduced) of the rows of one id.
fn rows(id: &str) -> Vec<(String, String, f64, i32)> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../studies/measure/data/published.csv");
    let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let records = reader.records().map(|r| r.expect("a well-formed table"));
    records
        .filter(|r| &r[0] == id)
        .map(|r| (r[4].to_owned(), r[5].to_owned(), r[6].parse().expect("a value"), r[7].parse().expect("digits")))
        .collect()
}

/// Half a unit of the last of `digits` significant digits.
fn half_unit(value: f64, digits: i32) -> f64 {
    0.5 * 10.0_f64.powi(value.abs().log10().floor() as i32 + 1 - digits)
}

fn energy(s: &State<Vector2<f64>>) -> f64 {
    0.5 * s.v.dot(&s.v) - 1.0 / s.q.norm()
}

#[test]
fn sundials_prints_the_energy_errors_of_our_semi_implicit_euler_on_a_kepler_orbit() {
    let planet = Kepler { mass: 1.0, mu: 1.0, semi_major: 1.0, eccentricity: 0.6, anomaly: 0.0 };
    let table = rows("sundials-kepler");
    assert_eq!(table.len(), 5);
    for (step, _, value, digits) in table {
        let steps = (50.0 / step.parse::<f64>().expect("a step")).round();
        let start: State<Vector2<f64>> = planet.exact(0.0);
        let end =
            drive::advance(&SemiImplicitEuler, &planet, start, 50.0 / steps, steps as u64).expect("a finite orbit");
        let error = energy(&end) - energy(&start);
        // Either run rounds a step's state by half an eps, which moves an energy whose parts are of order 1 by about an eps / 2:
        // two independent walks of that many steps.
        let walks = (2.0 * steps).sqrt() * f64::EPSILON;
        let bound = half_unit(value, digits) + walks;
        assert!((error - value).abs() <= bound, "h = {step}: {error:e}, printed {value:e}, +- {bound:e}");
    }
}

#[test]
fn hairer_prints_our_exact_pendulum_after_the_time_two_pi() {
    let pendulum = Pendulum { mass: 1.0, length: 1.0, gravity: 1.0, angle: 0.0, omega: 1.0 };
    let end = Motion::<fx128>::exact(&pendulum, fx128::PI + fx128::PI);
    let table = rows("hairer-pendulum");
    assert_eq!(table.len(), 2);
    for (_, quantity, value, digits) in table {
        let found = if quantity.starts_with('q') { end.q.x } else { end.v.x }.to_f64();
        assert!((found - value).abs() <= half_unit(value, digits), "{quantity}: {found}, printed {value}");
    }
}
