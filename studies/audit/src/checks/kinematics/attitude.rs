//! Attitude against angular velocity: the rule that turns it, its norm, and what contradicts the names.

use nalgebra::Vector3;

use super::{ATTITUDE, Moved, ROUNDINGS, factor, lag, late_start, shifted_misfit, without_jumps};
use crate::clock::Clock;
use crate::finding::{Check, Finding, Verdict, quantile};
use crate::read::names::NamedFrame;
use crate::trajectory::Trajectory;
use crate::trajectory::readings::{OmegaFrame, log};

/// The turns of the attitude in the frame of the angular velocity.
fn turns(t: &Trajectory) -> Vec<Moved> {
    let (Some(a), Some(w)) = (&t.attitude, &t.omega) else { return vec![] };
    let mut next = a.at(0);
    (0..t.rows() - 1)
        .map(|i| {
            let (q0, q1) = (next, a.at(i + 1));
            next = q1;
            let (by, sign) = match t.omega_frame {
                OmegaFrame::World => (log(q1 * q0.conjugate()), -1.0),
                OmegaFrame::Body => (log(q0.conjugate() * q1), 1.0),
            };
            let (w0, w1, h) = (w.values[i], w.values[i + 1], t.time[i + 1] - t.time[i]);
            let mean = (w0 + w1) / 2.0 + w0.cross(&w1) * (sign * h / 12.0);
            Moved { by, rates: [w0, w1], mean, h }
        })
        .collect()
}

pub(super) fn attitude(t: &Trajectory, clock: &Clock, record_every: Option<u64>) -> Vec<Finding> {
    let (Some(a), Some(w), Some(scored)) = (&t.attitude, &t.omega, &t.scored) else { return vec![] };
    let moved = turns(t);
    let largest = moved.iter().map(|m| m.by.norm()).fold(0.0, f64::max);
    let tolerance = ROUNDINGS * (2.0 * a.resolution.absolute + clock.interval * w.resolution.absolute);
    if largest <= tolerance {
        return vec![];
    }
    if let Some((name, worst)) = attitude_rule(t, clock, tolerance) {
        let quantity = ("attitude moved by angular velocity".to_owned(), worst, "rad");
        return vec![
            Finding::new(
                Check::Kinematics,
                "attitude-rule",
                Verdict::Pass,
                quantity,
                format!("{name}, to {worst:.1e} rad"),
            )
            .within(tolerance),
        ];
    }
    let shifted = |s: i64| shifted_misfit(t.rows(), s, &|i, j| (moved[j].by, moved[i].mean * moved[i].h));
    let regular: Vec<&Moved> = moved.iter().enumerate().filter(|(i, _)| clock.is_regular(*i)).map(|(_, m)| m).collect();
    let regular = without_jumps(&regular);
    let mut found = Vec::new();
    if let Some(factor) = factor(ATTITUDE, &regular) {
        found.push(factor);
    } else if scored.misfit > 0.3 && regular.len() > 3 {
        let evidence = format!(
            "no frame, unit, order or direction makes q' = q omega / 2: the best misses {:.0} % of the turning",
            100.0 * scored.misfit
        );
        found.push(
            Finding::new(
                Check::Kinematics,
                "attitude-against-angular-velocity",
                Verdict::Fault,
                ("misfit", scored.misfit, ""),
                evidence,
            )
            .within(0.3),
        );
    }
    if found.is_empty() {
        found.extend(lag(ATTITUDE, &regular, clock.interval, record_every, tolerance, &shifted));
    }
    let still =
        a.raw[1] == a.raw[0] && largest > 0.0 && w.values[1].norm() > 0.0 && t.rows() > 3 && a.raw[2] != a.raw[1];
    let known = t.position.as_ref().zip(t.velocity.as_ref()).is_some_and(|(x, v)| late_start(t, x, v).is_some());
    if still && !known {
        let evidence = "the attitude of row 2 is that of row 1 while the body turns: the pose is written one step late";
        found.push(Finding::new(
            Check::Kinematics,
            "pose-late-by-one-step",
            Verdict::Fault,
            ("lag of the pose", 1.0, "steps"),
            evidence,
        ));
    }
    found
}

/// A rule of one step that holds in nine rows of ten.
fn attitude_rule(t: &Trajectory, clock: &Clock, tolerance: f64) -> Option<(&'static str, f64)> {
    let (a, w) = (t.attitude.as_ref()?, t.omega.as_ref()?);
    let frame = t.omega_frame;
    let turn = |q: [f64; 4], w: Vector3<f64>, h: f64, rule: usize| -> [f64; 4] {
        let q = integrator::Rotation { w: q[0], v: Vector3::new(q[1], q[2], q[3]) };
        let d = if rule == 0 {
            integrator::Rotation::from_rotation_vector(w, h)
        } else {
            integrator::Rotation { w: 1.0, v: w * (h / 2.0) }
        };
        let moved = if frame == OmegaFrame::World { d * q } else { q * d };
        if rule == 2 { moved.wxyz() } else { moved.normalized().wxyz() }
    };
    let names = [
        [
            "q1 = q0 exp(h omega0) (old rate)",
            "q1 = q0 exp(h omega1) (new rate)",
            "q1 = q0 exp(h (omega0 + omega1) / 2)",
        ],
        [
            "q1 = normalised q0 + h/2 omega0 q0 (old rate)",
            "q1 = normalised q0 + h/2 omega1 q0 (new rate)",
            "q1 = normalised q0 + h/2 (omega0 + omega1)/2 q0",
        ],
        [
            "q1 = q0 + h/2 omega0 q0, never normalised (old rate)",
            "q1 = q0 + h/2 omega1 q0, never normalised (new rate)",
            "q1 = q0 + h/2 (omega0 + omega1)/2 q0, never normalised",
        ],
    ];
    let mut best: Vec<(&str, f64)> = Vec::new();
    for (rule, names) in names.iter().enumerate() {
        for (which, name) in names.iter().enumerate() {
            let misfit = |i: usize| {
                let omega = match which {
                    0 => w.values[i],
                    1 => w.values[i + 1],
                    _ => (w.values[i] + w.values[i + 1]) / 2.0,
                };
                let told = turn(a.raw[i], omega, t.time[i + 1] - t.time[i], rule);
                let distance = |sign: f64| {
                    2.0 * told.iter().zip(&a.raw[i + 1]).map(|(x, y)| (x - sign * y).powi(2)).sum::<f64>().sqrt()
                };
                distance(1.0).min(distance(-1.0))
            };
            let misfits: Vec<f64> = (0..t.rows() - 1).filter(|i| clock.is_regular(*i)).map(misfit).collect();
            let most = quantile(&misfits, 0.9);
            if most <= tolerance {
                best.push((name, most));
            }
        }
    }
    match best.as_slice() {
        [] => None,
        [one] => Some(*one),
        [(name, worst), rest @ ..] => {
            let (_, second) = rest[0];
            Some(if second > 10.0 * worst {
                (name, *worst)
            } else {
                ("several rules fit alike, as the rate hardly changes", *worst)
            })
        }
    }
}

/// |q| against one.
pub(super) fn norm(t: &Trajectory) -> Option<Finding> {
    let a = t.attitude.as_ref()?;
    let norm = |q: &[f64; 4]| q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (row, worst) = a.raw.iter().map(|q| (norm(q) - 1.0).abs()).enumerate().max_by(|x, y| x.1.total_cmp(&y.1))?;
    let bound = (4.0 * a.resolution.absolute).max(1e-9 + 64.0 * f64::EPSILON);
    let value = norm(&a.raw[row]);
    let quantity = ("norm of the quaternion", value, "");
    if worst <= bound {
        let evidence = format!("within {worst:.1e} of 1");
        return Some(
            Finding::new(Check::Conservation, "quaternion-norm", Verdict::Pass, quantity, evidence).within(1.0 + bound),
        );
    }
    let evidence =
        format!("|q| = {value:.6} at {:.4} s (row {}): the quaternion is not normalised", t.time[row], row + 1);
    let verdict = if worst > 1e-6 { Verdict::Fault } else { Verdict::Note };
    Some(Finding::new(Check::Conservation, "quaternion-norm", verdict, quantity, evidence).within(1.0 + bound))
}

/// Where the numbers say another thing than the names.
pub fn contradictions(t: &Trajectory) -> Vec<Finding> {
    let (Some(scored), Some(attitude)) = (&t.scored, &t.attitude) else { return vec![] };
    let mut found = Vec::new();
    let frame = |f: OmegaFrame| if f == OmegaFrame::World { "world" } else { "body" };
    let named = match t.named_frame {
        Some(NamedFrame::Body) => Some(OmegaFrame::Body),
        Some(NamedFrame::World) => Some(OmegaFrame::World),
        None => None,
    };
    if let Some(named) = named.filter(|n| *n != t.omega_frame && scored.misfit < 0.3 && !attitude.reading.inverse) {
        let evidence = format!(
            "the names say {} axes; q' = q omega / 2 holds in {} axes (to {:.1e})",
            frame(named),
            frame(t.omega_frame),
            scored.misfit
        );
        found.push(Finding::new(
            Check::Reading,
            "frame-not-as-named",
            Verdict::Fault,
            ("misfit", scored.misfit, ""),
            evidence,
        ));
    }
    if t.order_not_as_named {
        let evidence = format!(
            "the names say the scalar first; q' = q omega / 2 holds with the scalar last (to {:.1e})",
            scored.misfit
        );
        found.push(Finding::new(
            Check::Reading,
            "quaternion-order-not-as-named",
            Verdict::Fault,
            ("misfit", scored.misfit, ""),
            evidence,
        ));
    }
    if attitude.reading.inverse && scored.misfit < 0.3 {
        let evidence = format!(
            "q' = q omega / 2 holds only for the inverse of the attitude (to {:.1e}): it turns world into body",
            scored.misfit
        );
        found.push(Finding::new(
            Check::Reading,
            "attitude-is-inverse",
            Verdict::Fault,
            ("misfit", scored.misfit, ""),
            evidence,
        ));
    }
    found
}
