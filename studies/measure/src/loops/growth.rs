//! Steps drawn at random on an oscillator: the rate at which an error grows.

use integrator::methods::MethodId;
use scenes::run::{Outcome, Precision};
use scenes::stepping::Stepping;

use super::row::{Experiment, Row};
use crate::stability::frames::jitter_over;
use crate::study::Selection;

/// The parts by which a step varies in the chart; the first is small enough for the theory.
pub const PARTS: [f64; 3] = [0.1, 0.3, 0.6];

/// The growth per step of semi-implicit Euler on an oscillator with steps h (1 + s u), u uniform in \[-1, 1\], for small s:
/// s^2 z^4 / (6 (4 - z^2)) with z = h omega.
///
/// Derivation: in coordinates in which the ellipse of the step h is a circle, a step h + d turns and stretches by exp(d S) with the
/// eigenvalues +-r of the symmetric part of S, r^2 = omega^2 z^2 / (4 - z^2). The mean of ln |exp(d S) u| over the directions is
/// d^2 r^2 / 2, and d^2 is h^2 s^2 / 3 in the mean.
pub fn small(z: f64, part: f64) -> f64 {
    part * part * z.powi(4) / (6.0 * (4.0 - z * z))
}

/// Measured rates over h omega, for each part.
pub(super) fn rows(selection: &Selection) -> Vec<Row> {
    let Ok(mut scene) = scenes::by_id("oscillator") else { return Vec::new() };
    for name in ["mass", "stiffness"] {
        if scene.scene_mut().set("oscillator", name, "1").is_err() {
            return Vec::new();
        }
    }
    let method = MethodId::SemiImplicitEuler;
    let stepping = Stepping { scene: scene.as_ref(), method, precision: Precision::F64 };
    let (points, blocks) = if selection.quick { (4, 4) } else { (12, 8) };
    let jobs: Vec<(f64, f64)> = PARTS
        .iter()
        .flat_map(|&part| (1..=points).map(move |i| (part, 1.8 * f64::from(i) / f64::from(points))))
        .collect();
    selection.rows(
        &jobs,
        5e-2,
        |_| 1,
        |&(part, z)| {
            let found = jitter_over(&stepping, z, part, 1, blocks);
            let (theory, is_small) = (small(z, part), part == PARTS[0]);
            // The next term is a part (part / (1 - z^2 / 4))^2 or so of the rate, four times that is allowed; and twice the 95 % interval.
            let next = 4.0 * (part / (1.0 - 0.25 * z * z)).powi(2) * theory;
            vec![Row {
                experiment: Experiment::Jitter,
                choice: "jitter".to_owned(),
                settings: format!("jitter={part}"),
                subject: "oscillator, omega = 1 rad/s".to_owned(),
                method: method.id().to_owned(),
                h_s: z,
                frames: found.map_or(1, |f| f.steps),
                quantity: "growth per step".to_owned(),
                unit: "1".to_owned(),
                value: found.map(|f| f.rate),
                theory: is_small.then_some(theory),
                tolerance: found.filter(|_| is_small).map(|f| 2.0 * f.half_width + next),
                theory_order: None,
                outcome: if found.is_some() { Outcome::Finished } else { Outcome::Diverged },
            }]
        },
    )
}
