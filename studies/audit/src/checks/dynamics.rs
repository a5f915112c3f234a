//! The equation of motion: what a file's accelerations are made of, by regression on a few terms.

use nalgebra::{Matrix2, Vector2, Vector3};

use crate::clock::Clock;
use crate::finding::{Check, Finding, Verdict, median, quantile};
use crate::physics::{Force, Moment, acceleration};
use crate::subject::{Ball, Subject};
use crate::trajectory::Trajectory;

/// y = a p + b q by least squares: the coefficients, their standard errors, the share of y that they explain.
struct Fit {
    coefficients: [f64; 2],
    errors: [f64; 2],
    /// Share of y that both terms explain.
    explained: f64,
    /// Share of what the first term leaves that the second explains.
    second: f64,
}

fn fit(rows: &[(Vector3<f64>, Vector3<f64>, Vector3<f64>)]) -> Option<Fit> {
    let (mut normal, mut right, mut size) = (Matrix2::zeros(), Vector2::zeros(), 0.0);
    for (y, p, q) in rows {
        normal += Matrix2::new(p.dot(p), p.dot(q), q.dot(p), q.dot(q));
        right += Vector2::new(p.dot(y), q.dot(y));
        size += y.norm_squared();
    }
    // A term that is nowhere there is left out by a unit on the diagonal.
    for i in 0..2 {
        if normal[(i, i)] == 0.0 {
            normal[(i, i)] = 1.0;
        }
    }
    let inverse = normal.try_inverse()?;
    let c = inverse * right;
    let left: f64 = rows.iter().map(|(y, p, q)| (y - p * c.x - q * c.y).norm_squared()).sum();
    let variance = left / (3 * rows.len() - 2) as f64;
    let pp: f64 = rows.iter().map(|(_, p, _)| p.norm_squared()).sum();
    let alone = if pp > 0.0 { rows.iter().map(|(y, p, _)| p.dot(y)).sum::<f64>() / pp } else { 0.0 };
    let without: f64 = rows.iter().map(|(y, p, _)| (y - p * alone).norm_squared()).sum();
    let second = 1.0 - left / without.max(f64::MIN_POSITIVE);
    let errors = [0, 1].map(|i| (variance * inverse[(i, i)]).max(0.0).sqrt());
    Some(Fit { coefficients: [c.x, c.y], errors, explained: 1.0 - left / size, second })
}

/// Standard errors that a coefficient must be away from what it should be.
const SURELY: f64 = 5.0;

fn finding(
    id: &'static str,
    verdict: Verdict,
    (quantity, value, unit): (&str, f64, &'static str),
    evidence: String,
) -> Finding {
    Finding::new(Check::Dynamics, id, verdict, (quantity.to_owned(), value, unit), evidence)
}

/// All findings. `damped`: whether the step was identified and has a damping; None where no step was identified.
pub fn check(t: &Trajectory, clock: &Clock, subject: &Subject, damped: [Option<bool>; 2]) -> Vec<Finding> {
    let mut found = Vec::new();
    let p = &subject.physics;
    if let Some(force) = p.force {
        found.extend(translation(t, clock, force, subject.ball, p.linear_damping.unwrap_or(0.0), damped[0]));
    }
    if let Some(inertia) = p.inertia {
        found.extend(rotation(t, clock, inertia, p.moment, p.angular_damping.unwrap_or(0.0), damped[1]));
    }
    if let Some(square) = p.pendulum {
        found.extend(swing(t, clock, square));
    }
    if let (Some(ball), Some(Force::Constant(g))) = (subject.ball, p.force) {
        found.extend(bounces(t, ball, g));
    }
    found
}

/// The factor of the force and a linear damping, from the change of the velocity between rows without a contact.
fn translation(
    t: &Trajectory,
    clock: &Clock,
    force: Force,
    ball: Option<Ball>,
    known: f64,
    damped: Option<bool>,
) -> Vec<Finding> {
    let (Some(x), Some(v)) = (&t.position, &t.velocity) else { return vec![] };
    let h = clock.interval;
    let flies = |i: &usize| match (ball, force) {
        (Some(ball), Force::Constant(g)) => ball.flies(t, g, *i, h),
        _ => true,
    };
    let regular: Vec<usize> = (0..t.rows() - 1).filter(|i| clock.is_regular(*i)).filter(flies).collect();
    // The force of the row before, of the middle or of the row after: a step takes one of them.
    let place = |i: usize, w: f64| acceleration(force, x.values[i] * (1.0 - w) + x.values[i + 1] * w);
    let rows = |w: f64| -> Vec<(Vector3<f64>, Vector3<f64>, Vector3<f64>)> {
        let all = regular.iter().map(|&i| {
            let mean = (v.values[i] + v.values[i + 1]) / 2.0;
            ((v.values[i + 1] - v.values[i]) / h + mean * known, place(i, w), -mean)
        });
        let all: Vec<_> = all.collect();
        let misfit: Vec<f64> = all.iter().map(|(y, f, _)| (y - f).norm()).collect();
        let usual = quantile(&misfit, 0.5);
        let size = all.iter().map(|(y, f, _)| y.norm().max(f.norm())).fold(0.0, f64::max);
        // Rows in which something else pushes, a contact, are left out.
        let limit = (20.0 * usual).max(0.05 * size);
        all.into_iter().zip(misfit).filter(|(_, m)| *m <= limit).map(|(r, _)| r).collect()
    };
    let best =
        [0.0, 0.5, 1.0].into_iter().filter_map(|w| fit(&rows(w))).max_by(|a, b| a.explained.total_cmp(&b.explained));
    let Some(fit) = best else { return vec![] };
    let mut found = Vec::new();
    let [factor, c] = fit.coefficients;
    let noise = v.resolution.absolute
        / h
        / 1e-9_f64.max(median(&regular.iter().map(|i| v.values[*i].norm()).collect::<Vec<_>>()));
    let curved = matches!(force, Force::Spring { .. } | Force::Kepler { .. });
    // Between rows the force of a curved field changes by a part of (h omega)^2.
    let blur = if curved { curvature(force, x.values[0], h) } else { 0.0 };
    if force != Force::None {
        // A damping that acts on the gain of the step too takes c h of the force.
        let bound = SURELY * fit.errors[0] + blur + c.abs() * h + 1e-9 + 4.0 * noise;
        let off = (factor - 1.0).abs();
        let evidence = format!(
            "velocities change by {factor:.6} (+- {:.1e}) times what the scene's force gives",
            2.0 * fit.errors[0]
        );
        let verdict = if off > bound.max(1e-4) { Verdict::Fault } else { Verdict::Pass };
        found.push(finding("force-factor", verdict, ("factor of the force", factor, ""), evidence));
    }
    let clear = !curved;
    let significant = c.abs() > SURELY * fit.errors[1] + 8.0 * noise && c.abs() > 1e-5;
    if clear && significant && damped != Some(false) {
        let what = if c > 0.0 { "a damping" } else { "a drive" };
        let evidence =
            format!("velocities change as by {what} -c v with c = {c:.5} 1/s (+- {:.1e})", 2.0 * fit.errors[1]);
        found.push(finding("linear-damping", Verdict::Fault, ("damping of the velocity", c, "1/s"), evidence));
    }
    found
}

/// The factor of the restoring moment of a pendulum, theta'' = -Omega^2 sin theta, and a damping of its rate.
fn swing(t: &Trajectory, clock: &Clock, square: f64) -> Vec<Finding> {
    let (Some(angle), Some(rate)) = (&t.angle, &t.angle_rate) else { return vec![] };
    let (h, along) = (clock.interval, |x: f64| Vector3::new(x, 0.0, 0.0));
    let rows = |w: f64| -> Vec<(Vector3<f64>, Vector3<f64>, Vector3<f64>)> {
        let row = |i: usize| {
            let sine = angle.values[i].sin() * (1.0 - w) + angle.values[i + 1].sin() * w;
            let mean = (rate.values[i] + rate.values[i + 1]) / 2.0;
            (along((rate.values[i + 1] - rate.values[i]) / h), along(-square * sine), along(-mean))
        };
        (0..t.rows() - 1).filter(|i| clock.is_regular(*i)).map(row).collect()
    };
    let best =
        [0.0, 0.5, 1.0].into_iter().filter_map(|w| fit(&rows(w))).max_by(|a, b| a.explained.total_cmp(&b.explained));
    let Some(fit) = best.filter(|fit| fit.explained > 0.5) else { return vec![] };
    let [factor, c] = fit.coefficients;
    let largest = rate.values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let noise = rate.resolution.absolute / (h * square.sqrt() * largest.max(1e-300));
    // A step takes the moment at one end of a row or as a mean: a part h Omega of it, and (h Omega)^2 / 12 of its bend.
    let bound = SURELY * fit.errors[0] + square * h * h + c.abs() * h + 1e-4 + 4.0 * noise;
    let evidence = format!(
        "the rate changes by {factor:.6} (+- {:.1e}) times what the pendulum's weight gives",
        2.0 * fit.errors[0]
    );
    let verdict = if (factor - 1.0).abs() > bound { Verdict::Fault } else { Verdict::Pass };
    let mut found = vec![finding("force-factor", verdict, ("factor of the moment", factor, ""), evidence)];
    if c > SURELY * fit.errors[1] + square * h + 8.0 * noise * square.sqrt() {
        let evidence =
            format!("the rate changes as by a damping -c omega with c = {c:.5} 1/s (+- {:.1e})", 2.0 * fit.errors[1]);
        found.push(finding("linear-damping", Verdict::Fault, ("damping of the rate", c, "1/s"), evidence));
    }
    found
}

/// (h omega)^2 of a field near a point: by how much a force read at one place misses its mean over a row.
fn curvature(force: Force, x: Vector3<f64>, h: f64) -> f64 {
    let rate = match force {
        Force::Spring { rate, .. } => rate,
        Force::Kepler { mu, centre } => mu / (x - centre).norm().powi(3),
        _ => 0.0,
    };
    rate * h * h
}

/// The factor of the gyroscopic term, and a damping of the angular velocity.
fn rotation(
    t: &Trajectory,
    clock: &Clock,
    inertia: Vector3<f64>,
    moment: Option<Moment>,
    known: f64,
    damped: Option<bool>,
) -> Vec<Finding> {
    let h = clock.interval;
    let Some(attitude) = &t.attitude else { return spin(t, clock, known) };
    let weight = |row: usize| match moment {
        Some(Moment::Weight { arm, gravity }) => {
            arm.cross(&attitude.at(row).rotate_back(gravity)).component_div(&inertia)
        }
        _ => Vector3::zeros(),
    };
    let term = |w: Vector3<f64>| inertia.component_mul(&w).cross(&w).component_div(&inertia);
    let (mut rows, mut turned, mut gyroscopic) = (Vec::new(), 0.0_f64, 0.0);
    for i in (0..t.rows() - 1).filter(|i| clock.is_regular(*i)) {
        let (Some(w0), Some(w1)) = (t.omega_body(i), t.omega_body(i + 1)) else { return vec![] };
        let (mean, g) = ((w0 + w1) / 2.0, (term(w0) + term(w1)) / 2.0);
        rows.push(((w1 - w0) / h - (weight(i) + weight(i + 1)) / 2.0 + mean * known, g, -mean));
        turned = turned.max(mean.norm());
        gyroscopic += g.norm_squared();
    }
    let rows = without_clamps(rows);
    let Some(fit) = fit(&rows) else { return vec![] };
    let [factor, c] = fit.coefficients;
    let size = (gyroscopic / rows.len().max(1) as f64).sqrt();
    let resolution = t.omega.as_ref().map_or(0.0, |w| w.resolution.absolute);
    let mut found = Vec::new();
    // The term must turn the angular velocity by more than rounding, and a thousandth of itself over the file.
    let matters = size * h > 64.0 * resolution && size * h * rows.len() as f64 > 1e-3 * turned;
    if matters {
        let evidence = format!(
            "omega' has {factor:.4} (+- {:.1e}) times the gyroscopic term I^-1 (I omega x omega)",
            2.0 * fit.errors[0]
        );
        let quantity = ("factor of the gyroscopic term", factor, "");
        // The mean over a row is off by a part (omega h)^2; a moment that turns with the body adds its own.
        let slack = if matches!(moment, Some(Moment::None)) { 0.01 + (turned * h).powi(2) } else { 0.1 };
        if factor.abs() < 0.2 && fit.errors[0] < 0.1 {
            found.push(finding("gyroscopic-term-missing", Verdict::Fault, quantity, evidence));
        } else if turned * h < 0.3 && ((factor - 1.0).abs() > slack + SURELY * fit.errors[0] || fit.explained < 0.98) {
            let evidence = format!("{evidence}: another inertia, or a wrong term");
            found.push(finding("gyroscopic-term-wrong", Verdict::Fault, quantity, evidence));
        } else {
            found.push(finding("gyroscopic-term", Verdict::Pass, quantity, evidence));
        }
    }
    let rigid = matches!(moment, Some(Moment::None)) && turned > 0.0;
    let significant = c > SURELY * fit.errors[1] + 8.0 * resolution / (h * turned.max(f64::MIN_POSITIVE)) && c > 1e-4;
    // A step without a damping may still lose momentum; that is its own law and not a damping.
    if rigid && significant && damped != Some(false) {
        // A method that loses momentum loses it in another pattern than -c omega.
        let alone = factor.abs() < 0.2 || !matters || damped == Some(true) || fit.second > 0.9;
        let evidence = format!("omega decays as by -c omega with c = {c:.5} 1/s (+- {:.1e})", 2.0 * fit.errors[1]);
        let verdict = if alone { Verdict::Fault } else { Verdict::Note };
        found.push(finding("angular-damping", verdict, ("damping of the angular velocity", c, "1/s"), evidence));
    }
    found
}

/// The damping of a spin about one axis, of a file without an attitude.
fn spin(t: &Trajectory, clock: &Clock, known: f64) -> Vec<Finding> {
    let Some(omega) = &t.omega else { return vec![] };
    let w = &omega.values;
    let straight = w.iter().all(|x| x.cross(&w[0]).norm() <= 1e-4 * w[0].norm_squared());
    let pairs = (0..t.rows() - 1).filter(|i| clock.is_regular(*i));
    let row = |i: usize| {
        let mean = (w[i] + w[i + 1]) / 2.0;
        ((w[i + 1] - w[i]) / clock.interval + mean * known, Vector3::zeros(), -mean)
    };
    let rows: Vec<Row> = pairs.map(row).collect();
    let Some(fit) = fit(&rows).filter(|_| straight) else { return vec![] };
    let c = fit.coefficients[1];
    if !(c > SURELY * fit.errors[1] && c > 1e-5) {
        return vec![];
    }
    let evidence = format!("omega decays as by -c omega with c = {c:.5} 1/s (+- {:.1e})", 2.0 * fit.errors[1]);
    vec![finding("angular-damping", Verdict::Fault, ("damping of the angular velocity", c, "1/s"), evidence)]
}

type Row = (Vector3<f64>, Vector3<f64>, Vector3<f64>);

/// Leaves out rows in which the angular velocity jumps.
fn without_clamps(rows: Vec<Row>) -> Vec<Row> {
    let change: Vec<f64> = rows.iter().map(|(y, _, _)| y.norm()).collect();
    let usual = quantile(&change, 0.9);
    rows.into_iter().zip(change).filter(|(_, c)| *c <= 10.0 * usual).map(|(r, _)| r).collect()
}

/// The part of the speed that the first bounces leave: from the energies of the rows on both sides of a contact.
fn bounces(t: &Trajectory, ball: Ball, g: Vector3<f64>) -> Option<Finding> {
    let (x, v) = (t.position.as_ref()?, t.velocity.as_ref()?);
    let up = -g.normalize();
    let energy = |i: usize| v.values[i].dot(&up).powi(2) + 2.0 * g.norm() * (x.values[i].dot(&up) - ball.radius);
    let bounces = (0..t.rows() - 1).filter(|&i| v.values[i].dot(&up) < 0.0 && v.values[i + 1].dot(&up) > 0.0);
    let kept: Vec<f64> =
        bounces.map(|i| (energy(i + 1).max(0.0) / energy(i)).sqrt()).filter(|e| e.is_finite()).take(1).collect();
    let measured = kept.first().copied().unwrap_or(f64::NAN);
    if !measured.is_finite() {
        return None;
    }
    let off = (measured - ball.restitution).abs();
    let squared = (measured - ball.restitution.powi(2)).abs() < 0.1 && off > 0.1;
    let meaning = if squared { ": the restitutions of both bodies are multiplied" } else { "" };
    let evidence = format!("the first bounce leaves {measured:.4} of the speed, {} is set{meaning}", ball.restitution);
    let verdict = if off > 0.1 { Verdict::Fault } else { Verdict::Note };
    Some(finding("restitution", verdict, ("restitution", measured, ""), evidence))
}
