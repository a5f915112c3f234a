//! Energy, size and direction of the angular momentum of a body whose inertia is known.

use nalgebra::Vector3;

use crate::finding::{Check, Finding, Verdict};
use crate::trajectory::Trajectory;

/// What a body does with its energy and its angular momentum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conserved {
    /// Largest |E / E0 - 1|, rotational energy.
    pub energy: f64,
    /// Largest ||L| / |L0| - 1|.
    pub momentum_size: f64,
    /// Largest angle between L and L0 in the world, rad.
    pub momentum_direction: f64,
}

/// Measures them; None without attitude or angular velocity, or of a body that does not turn.
pub fn measure(t: &Trajectory, inertia: Vector3<f64>) -> Option<Conserved> {
    let attitude = t.attitude.as_ref()?;
    let state = |row: usize| {
        let omega = t.omega_body(row)?;
        let l = inertia.component_mul(&omega);
        Some((omega.dot(&l) / 2.0, attitude.at(row).rotate(l)))
    };
    let (e0, l0) = state(0)?;
    if !(e0 > 0.0) {
        return None;
    }
    let mut out = Conserved { energy: 0.0, momentum_size: 0.0, momentum_direction: 0.0 };
    for row in 1..t.rows() {
        let (e, l) = state(row)?;
        out.energy = out.energy.max((e / e0 - 1.0).abs());
        out.momentum_size = out.momentum_size.max((l.norm() / l0.norm() - 1.0).abs());
        out.momentum_direction = out.momentum_direction.max(l.cross(&l0).norm().atan2(l.dot(&l0)));
    }
    Some(out)
}

/// Findings; `free`: the scene says that no torque acts.
pub fn check(t: &Trajectory, inertia: Vector3<f64>) -> Vec<Finding> {
    let Some(c) = measure(t, inertia) else { return vec![] };
    let finding = |id, quantity: &str, value, unit, evidence: String| {
        Finding::new(Check::Conservation, id, Verdict::Note, (quantity.to_owned(), value, unit), evidence)
    };
    vec![
        finding(
            "energy",
            "largest relative change of the rotational energy",
            c.energy,
            "",
            format!("{:.3e} of the start", c.energy),
        ),
        finding(
            "momentum-size",
            "largest relative change of |L|",
            c.momentum_size,
            "",
            format!("{:.3e} of the start", c.momentum_size),
        ),
        finding(
            "momentum-direction",
            "largest angle of L from its start, world frame",
            c.momentum_direction,
            "rad",
            format!("{:.4} rad", c.momentum_direction),
        ),
    ]
}
