//! One file from its path to its findings: the checks in their order.

use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use serde::Serialize;

use crate::checks::error::ErrorOf;
use crate::checks::{self, clamps, conservation, dynamics, kinematics, time};
use crate::clock::Clock;
use crate::error::Error;
use crate::finding::{Check, Finding, Verdict};
use crate::step::{self, Identified, Moves, StepVerdict};
use crate::subject::{Settings, Subject, subject};
use crate::trajectory::readings::log;
use crate::trajectory::{Recognised, Scalars, Trajectory};
use crate::{Choices, load};

/// What is asked.
#[derive(Clone, Debug, Default)]
pub struct Args {
    /// The files.
    pub files: Vec<PathBuf>,
    /// What the columns are.
    pub choices: Choices,
    /// What the body is.
    pub settings: Settings,
    /// Steps in a row.
    pub record_every: Option<u64>,
    /// The largest error of a pose, m or rad.
    pub max_error: Option<f64>,
}

/// The clock of a file.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TimeOf {
    /// Rows.
    pub rows: usize,
    /// First time, s, without what was taken off.
    pub start_s: f64,
    /// Last time, s.
    pub end_s: f64,
    /// The usual time between two rows, s.
    pub interval_s: f64,
}

/// What is said of a file.
#[derive(Clone, Debug, Serialize)]
pub struct FileReport {
    /// The file.
    pub path: PathBuf,
    /// How its columns were read.
    pub columns: Vec<Recognised>,
    /// Columns that were not used.
    pub unused: Vec<String>,
    /// How its numbers were rounded.
    pub rounding: String,
    /// Its clock.
    pub time: TimeOf,
    /// All findings, faults first.
    pub findings: Vec<Finding>,
    /// Errors against the exact motion.
    pub error: Vec<ErrorOf>,
    /// The step of each part of the motion.
    pub step: Vec<Identified>,
}

impl FileReport {
    /// The findings that are faults.
    pub fn faults(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(|f| f.verdict == Verdict::Fault)
    }
}

/// Judges one file.
///
/// # Errors
/// A file that is no trajectory; a flag that fits no scene.
pub fn judge(path: &Path, args: &Args) -> Result<FileReport, Error> {
    let mut t = load(path, &args.choices)?;
    let subject = subject(&args.settings, &t)?;
    if let Some(subject) = &subject {
        hinge(&mut t, subject);
    }
    let (clock, mut findings) = time::check(&t);
    findings.extend(checks::reading(&t));
    let kinematic = kinematics::check(&t, &clock, args.record_every);
    let late = pose_late(&kinematic, &t, &clock, args.record_every);
    findings.extend(kinematic);
    findings.extend(clamps::check(&t));
    let (mut errors, mut steps) = (vec![], vec![]);
    if let Some(subject) = &subject {
        if let Some(inertia) = subject.physics.inertia {
            findings.extend(conservation::check(&t, inertia));
        }
        let found;
        (errors, found) = checks::error::check(&t, subject, late, args.max_error);
        findings.extend(found);
        let exact = checks::error::is_exact(&t, &errors);
        steps = step::identify(&t, &clock, &subject.physics, subject.ball, args.record_every);
        for step in steps.iter_mut().filter(|_| exact) {
            step.verdict = StepVerdict::Exact;
        }
        let damped = |moves| damped(&steps, moves);
        findings.extend(dynamics::check(&t, &clock, subject, [damped(Moves::Translation), damped(Moves::Rotation)]));
        findings.extend(steps.iter().map(of_step));
        let known = findings.iter().any(|f| f.id == "pose-late-by-one-step");
        if steps.iter().any(|s| s.pose_late) && !known {
            let evidence = "from the first row on the pose is that of the step before its rate, to rounding";
            let quantity = ("lag of the pose", 1.0, "steps");
            findings.push(Finding::new(Check::Kinematics, "pose-late-by-one-step", Verdict::Fault, quantity, evidence));
        }
    }
    findings.sort_by_key(|f| (f.verdict, f.check));
    let end = |i: usize| t.time[i];
    Ok(FileReport {
        path: path.to_owned(),
        columns: t.recognised.clone(),
        unused: t.unused.clone(),
        rounding: t.rounding.to_string(),
        time: TimeOf { rows: t.rows(), start_s: end(0), end_s: end(t.rows() - 1), interval_s: clock.interval },
        findings,
        error: errors,
        step: steps,
    })
}

/// How late the pose is, where a fault says so.
fn pose_late(found: &[Finding], t: &Trajectory, clock: &Clock, record_every: Option<u64>) -> Option<f64> {
    let fault = |id: &str| found.iter().find(|f| f.id == id && f.verdict == Verdict::Fault);
    let one_step = || fault("pose-late-by-one-step").map(|_| clock.interval / record_every.unwrap_or(1) as f64);
    let lag = ["position-lags", "attitude-lags", "angle-lags"].iter().find_map(|id| fault(id)).map(|f| f.value);
    one_step().or(lag).filter(|_| t.rows() > 2)
}

/// Whether the step of a part is known, and has a damping.
fn damped(steps: &[Identified], moves: Moves) -> Option<bool> {
    let step = steps.iter().find(|s| s.moves == moves)?;
    match step.verdict {
        StepVerdict::Identified | StepVerdict::OneOf => step.candidates.first().map(|c| c.damping.is_some()),
        StepVerdict::Exact => Some(false),
        StepVerdict::NoneOf => None,
    }
}

fn of_step(step: &Identified) -> Finding {
    let what = match step.moves {
        Moves::Translation => "step of the position",
        Moves::Rotation => "step of the attitude",
        Moves::Angle => "step of the angle",
    };
    let best = &step.candidates[0];
    let (id, verdict, evidence) = match step.verdict {
        StepVerdict::Exact => ("exact", Verdict::Pass, "no step: the exact motion to rounding".to_owned()),
        StepVerdict::Identified => {
            let evidence = format!(
                "{}, h = {:.6} s, {} step(s) a row: {} of {} rows, to {:.1} half units in the last place",
                best.id, best.h_s, best.steps_per_row, best.rows, step.rows, best.largest_difference
            );
            ("identified", Verdict::Pass, evidence)
        }
        StepVerdict::OneOf => {
            let names: Vec<&str> = step.candidates.iter().take(3).map(|c| c.id.as_str()).collect();
            ("one-of", Verdict::Note, format!("one of {}: {}", step.candidates.len(), names.join(" | ")))
        }
        StepVerdict::NoneOf => {
            let evidence = format!(
                "none of {}; nearest {} at {:.1e} half units in the last place",
                step.tried, best.id, best.largest_difference
            );
            ("none-of", Verdict::Note, evidence)
        }
    };
    Finding::new(Check::Step, id, verdict, (what, best.largest_difference, ""), evidence)
}

/// The angle of a body on a hinge from its attitude, where a pendulum is asked for and the file has no angle.
fn hinge(t: &mut Trajectory, subject: &Subject) {
    let (Some(_), None, Some(attitude), Some(_)) = (subject.physics.pendulum, &t.angle, &t.attitude, &t.omega) else {
        return;
    };
    let world = |row: usize| t.omega_world(row).unwrap_or(Vector3::zeros());
    let fastest = (0..t.rows()).max_by(|a, b| world(*a).norm().total_cmp(&world(*b).norm())).unwrap_or(0);
    let Some(axis) = world(fastest).try_normalize(0.0) else { return };
    let phi: Vec<Vector3<f64>> = (0..t.rows()).map(|i| log(attitude.at(i))).collect();
    let off = phi.iter().map(|p| (p - axis * p.dot(&axis)).norm()).fold(0.0, f64::max);
    // Rotations about another axis, or from another rest: the angle of the hinge is not that of the attitude.
    if off > 1e-2 {
        return;
    }
    let scalars = |values: Vec<f64>, resolution| Scalars { values, resolution, unwrapped: 0 };
    let rate = (0..t.rows()).map(|i| world(i).dot(&axis)).collect();
    let omega = t.omega.as_ref().map_or(attitude.resolution, |w| w.resolution);
    let angle = scalars(phi.iter().map(|p| p.dot(&axis)).collect(), attitude.resolution);
    t.angle = Some(angle);
    t.angle_rate = Some(scalars(rate, omega));
}
