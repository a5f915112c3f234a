//! A candidate for the step of a file, and the state that it steps.

use nalgebra::Vector3;

/// A state as a file has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kin {
    /// Position, m.
    pub(super) x: Vector3<f64>,
    /// Velocity, m/s.
    pub(super) v: Vector3<f64>,
    /// Attitude (w, x, y, z), not normalised.
    pub(super) q: [f64; 4],
    /// Angular velocity in the frame of the file, rad/s.
    pub(super) w: Vector3<f64>,
    /// Angle and angle rate of a plane motion.
    pub(super) angle: [f64; 2],
}

/// What a candidate moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Moves {
    /// Position and velocity.
    Translation,
    /// Attitude and angular velocity.
    Rotation,
    /// An angle and its rate.
    Angle,
}

/// The arithmetic of a candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Precision {
    /// f64.
    Double,
    /// f32.
    Single,
}

impl Precision {
    /// Double, and single for a file that may be of single precision.
    pub(super) fn tried(single: bool) -> &'static [Precision] {
        if single { &[Precision::Double, Precision::Single] } else { &[Precision::Double] }
    }
}

/// Runs from a state: (start, h, steps in a row, rows) to the state at every row.
pub(super) type Run = Box<dyn Fn(&Kin, f64, u64, u64) -> Vec<Kin>>;

/// A step that may have computed a file.
pub(super) struct Candidate {
    /// Its parts in words.
    pub(super) id: String,
    /// Whether it has a memory, so that it cannot start from any row.
    pub(super) memory: bool,
    /// The steps in a row for which its damping was fitted to the file; None where none was.
    pub(super) steps: Option<u64>,
    /// The coefficient of its damping.
    pub(super) damping: Option<f64>,
    /// Substeps in a step.
    pub(super) substeps: u32,
    /// How it runs.
    pub(super) run: Run,
}
