//! The error against the exact motion, at the end and the largest of all rows; and what is left without a lag that was found.

use serde::Serialize;

use crate::exact::{Exact, exact};
use crate::finding::{Check, Finding, Verdict};
use crate::subject::Subject;
use crate::trajectory::Trajectory;

/// The error of one quantity.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct ErrorOf {
    /// The quantity.
    pub quantity: &'static str,
    /// At the last row.
    pub end: f64,
    /// The largest of all rows.
    pub max: f64,
    /// The unit.
    pub unit: &'static str,
}

/// Errors of all quantities that the subject has an exact motion of.
pub fn measure(t: &Trajectory, motion: &Exact) -> Vec<ErrorOf> {
    let mut out = Vec::new();
    let mut add = |quantity, unit, errors: Vec<f64>| {
        let max =
            errors.iter().copied().fold(0.0, |m: f64, e| if e.is_nan() || m.is_nan() { f64::NAN } else { m.max(e) });
        out.extend(errors.last().map(|end| ErrorOf { quantity, end: *end, max, unit }));
    };
    if let (Some(point), Some(x), Some(v)) = (&motion.point, &t.position, &t.velocity) {
        add("position", "m", point.iter().zip(&x.values).map(|(e, x)| (e[0] - x).norm()).collect());
        add("velocity", "m/s", point.iter().zip(&v.values).map(|(e, v)| (e[1] - v).norm()).collect());
    }
    if let (Some(body), Some(attitude)) = (&motion.body, &t.attitude) {
        add("attitude", "rad", body.iter().enumerate().map(|(i, e)| e.0.angle_to(attitude.at(i))).collect());
        let omega =
            |(i, e): (usize, &(_, nalgebra::Vector3<f64>))| t.omega_world(i).map_or(f64::NAN, |w| (w - e.1).norm());
        add("angular-velocity", "rad/s", body.iter().enumerate().map(omega).collect());
    }
    if let (Some(angle), Some(a), Some(r)) = (&motion.angle, &t.angle, &t.angle_rate) {
        add("angle", "rad", angle.iter().zip(&a.values).map(|(e, a)| (e[0] - a).abs()).collect());
        add("angle-rate", "rad/s", angle.iter().zip(&r.values).map(|(e, r)| (e[1] - r).abs()).collect());
    }
    out
}

/// Errors, and findings: a bound that is broken, an exact motion, what a lag is responsible for.
pub fn check(
    t: &Trajectory,
    subject: &Subject,
    pose_late: Option<f64>,
    max_error: Option<f64>,
) -> (Vec<ErrorOf>, Vec<Finding>) {
    let motion = exact(subject, t, 0.0);
    let errors = measure(t, &motion);
    let mut found = Vec::new();
    let source = motion.source.join(", ");
    for e in &errors {
        let evidence = format!("largest {:.3e} {}, {:.3e} at the end; exact motion: {source}", e.max, e.unit, e.end);
        let broken =
            max_error.filter(|bound| !(e.max <= *bound) && matches!(e.quantity, "position" | "attitude" | "angle"));
        let verdict = if broken.is_some() { Verdict::Fault } else { Verdict::Note };
        let mut finding = Finding::new(Check::Error, "error", verdict, (e.quantity, e.max, e.unit), evidence);
        finding.bound = max_error;
        found.push(finding);
    }
    if let Some(late) = pose_late {
        let without = measure(t, &exact(subject, t, late));
        for (with, without) in errors.iter().zip(&without).filter(|(a, b)| b.max < 0.9 * a.max) {
            let evidence = format!(
                "without the lag of {late:.6} s the largest error falls from {:.3e} to {:.3e} {}",
                with.max, without.max, with.unit
            );
            found.push(Finding::new(
                Check::Error,
                "error-without-lag",
                Verdict::Note,
                (with.quantity, without.max, with.unit),
                evidence,
            ));
        }
    }
    (errors, found)
}

/// Whether a file is the exact motion to its own rounding.
pub fn is_exact(t: &Trajectory, errors: &[ErrorOf]) -> bool {
    let resolution = |q: &str| match q {
        "position" => t.position.as_ref().map(|v| v.resolution.absolute),
        "velocity" => t.velocity.as_ref().map(|v| v.resolution.absolute),
        "attitude" => t.attitude.as_ref().map(|v| v.resolution.absolute),
        "angular-velocity" => t.omega.as_ref().map(|v| v.resolution.absolute),
        "angle" => t.angle.as_ref().map(|v| v.resolution.absolute),
        _ => t.angle_rate.as_ref().map(|v| v.resolution.absolute),
    };
    // The start is rounded like every row, and its error grows with the motion: a thousand half units at most.
    !errors.is_empty() && errors.iter().all(|e| resolution(e.quantity).is_some_and(|r| e.max <= 1024.0 * r.max(1e-15)))
}
