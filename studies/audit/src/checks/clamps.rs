//! Limits that an engine puts on a velocity: a norm or a component that stands at a largest value.

use nalgebra::Vector3;

use crate::finding::{Check, Finding, Verdict};
use crate::trajectory::{Trajectory, Vectors};

/// Clamped angular and linear velocities.
pub fn check(t: &Trajectory) -> Vec<Finding> {
    let mut found = Vec::new();
    if let Some(omega) = &t.omega {
        found.extend(clamp(t, omega, "angular velocity", "rad/s", "angular-velocity-clamped"));
    }
    if let Some(v) = &t.velocity {
        found.extend(clamp(t, v, "velocity", "m/s", "velocity-clamped"));
    }
    found
}

fn clamp(t: &Trajectory, v: &Vectors, what: &'static str, unit: &'static str, id: &'static str) -> Option<Finding> {
    let finding = |value: f64, evidence: String| {
        Finding::new(Check::Conservation, id, Verdict::Fault, (format!("limit of the {what}"), value, unit), evidence)
    };
    let norms: Vec<f64> = v.values.iter().map(Vector3::norm).collect();
    // A jump down in the first step that nothing later comes near: the start was beyond the limit.
    let fall = |i: usize| (norms[i] - norms[i + 1]) / norms[i].max(f64::MIN_POSITIVE);
    let later = (1..norms.len().min(200) - 1).map(|i| fall(i).abs()).fold(0.0, f64::max);
    let same_direction = v.values[0].normalize().dot(&v.values[1].normalize());
    if norms.len() > 8 && fall(0) > 0.1 && fall(0) > 10.0 * later && same_direction > 0.9 {
        let evidence = format!(
            "|{what}| falls from {:.4} to {:.4} {unit} in the first interval and by at most {:.1e} of itself later",
            norms[0], norms[1], later
        );
        return Some(finding(norms[1], evidence));
    }
    if let Some((value, rows)) = plateau(&norms, 3, v.resolution.absolute) {
        return Some(finding(value, format!("|{what}| stands at {value:.4} {unit} in {rows} rows, and nowhere above")));
    }
    (0..3).find_map(|axis| {
        let sign = v.values.iter().map(|v: &Vector3<f64>| v[axis]).max_by(|a, b| a.abs().total_cmp(&b.abs()))?.signum();
        let component: Vec<f64> = v.values.iter().map(|v| v[axis] * sign).collect();
        let (value, rows) = plateau(&component, 2, v.resolution.absolute)?;
        // The other components must go on changing.
        Some(finding(
            value,
            format!(
                "component {} of the {what} stands at {value:.4} {unit} in {rows} rows of {}, and nowhere above",
                ["x", "y", "z"][axis],
                t.rows()
            ),
        ))
    })
}

/// The largest value, if the series rises to it and stands there for some rows but not for most of the file.
fn plateau(series: &[f64], least: usize, resolution: f64) -> Option<(f64, usize)> {
    let largest = series.iter().copied().fold(0.0, f64::max);
    let stands = |x: &f64| (largest - x) <= 2.0 * resolution;
    let rows = series.iter().filter(|x| stands(x)).count();
    let runs = series.windows(least).any(|w| w.iter().all(stands));
    let first = series.iter().position(stands)?;
    let smallest = series.iter().copied().fold(f64::INFINITY, f64::min);
    let moves = largest - smallest > 0.02 * largest;
    // Near a smooth maximum two rows agree only if they differ by less than the resolution; a rise of a hundred times that is none.
    let rise = if first > 0 { largest - series[first - 1] } else { 0.0 };
    let after = series.iter().skip(first).find(|x| !stands(x)).map_or(0.0, |x| largest - x);
    let sharp = rise.max(after) > 1e6 * resolution && rise.max(after) > 1e-3 * largest;
    (largest > 0.0 && runs && moves && sharp && rows * 2 < series.len() && first > 0).then_some((largest, rows))
}
