//! Numbers that other projects print, from this integrator.
//!
//! They see what no test written beside the code can: a convention misread in the same way twice.

use std::path::PathBuf;

use faer::fx128;
use integrator::methods::VelocityVerlet;
use integrator::{Single, drive};
use scenes::Oscillator;
use scenes::motion::Motion;
use serde::Deserialize;

#[derive(Deserialize)]
struct Published {
    id: String,
    scene: String,
    method: String,
    step_s: Option<f64>,
    quantity: String,
    value: f64,
    printed_digits: i32,
}

/// The one row of that id and scene.
fn published(id: &str, scene: &str) -> Published {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../studies/measure/data/published.csv");
    let mut reader = csv::Reader::from_path(&path).expect("studies/measure/data/published.csv");
    let rows = reader.deserialize().map(|row| row.expect("a well-formed row"));
    let mut of_id = rows.filter(|row: &Published| row.id == id && row.scene == scene);
    let row = of_id.next().expect("the row is there");
    assert!(of_id.next().is_none(), "{id} {scene} is not unique");
    row
}

/// max |E - 1/2| of the unit oscillator from (1, 0) over T = 500, in any arithmetic.
fn worst_energy_error<T: Single>(h: f64) -> f64 {
    let scene = Oscillator { mass: 1.0, stiffness: 1.0, x0: 1.0, v0: 0.0 };
    let half = T::lit(0.5);
    let mut worst = T::lit(0.0);
    let start = Motion::<T>::exact(&scene, T::lit(0.0));
    let steps = (500.0 / h).round() as u64;
    drive::integrate(&VelocityVerlet, &scene, start, T::lit(h), steps, |_, s| {
        let error = ((s.q.x * s.q.x + s.v.x * s.v.x) * half - half).abs();
        if error > worst {
            worst = error;
        }
    })
    .expect("finite");
    worst.to_f64()
}

// Fails if: Verlet's first kick is a whole one, its drift uses v0, or its second force is taken before the drift.
#[test]
fn principias_oscillator_energy_is_found_to_eleven_digits() {
    let row = published("principia-oscillator", "oscillator-unit");
    assert!(row.method.starts_with("velocity Verlet") && row.quantity == "max |E-0.5| over T=500");
    // Half a unit of the last digit that is compared.
    let tolerance = 0.5 * 10.0_f64.powi(1 - row.printed_digits) * row.value.abs();
    let h = row.step_s.expect("the row has a step");
    for found in [worst_energy_error::<f64>(h), worst_energy_error::<fx128>(h)] {
        println!("{found:.17e}, published {:.17e}", row.value);
        assert!((found - row.value).abs() <= tolerance, "{found:.14e}, published {:.14e}", row.value);
    }
}
