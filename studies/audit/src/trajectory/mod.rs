//! A trajectory in SI units and in one convention, made from a table; and how each column was read.

pub mod attitude;
pub mod readings;
pub mod roles;

use integrator::Rotation;
use nalgebra::Vector3;
use serde::Serialize;

use crate::error::Error;
use crate::read::names::{self, NamedFrame, Role};
use crate::read::{Digits, Table};
use attitude::{Notation, Reading};
use readings::{CLEARLY, OmegaFrame, Scored};
use roles::{Group, Layout};

/// What the flags say about the columns.
#[derive(Clone, Debug, Default)]
pub struct Choices {
    /// Names of the columns, in order; `-` for one to be left out.
    pub columns: Option<Vec<String>>,
    /// Units: a column's name or a role, and the unit.
    pub units: Vec<(String, String)>,
    /// The frame of the angular velocity.
    pub omega_frame: Option<OmegaFrame>,
    /// Rows to read.
    pub rows: Option<usize>,
}

/// How columns were read, and why.
#[derive(Clone, Debug, Serialize)]
pub struct Recognised {
    /// The quantity.
    pub role: Role,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Notation, frame and unit.
    pub reading: String,
    /// Why.
    pub reason: String,
}

/// Readings that the numbers cannot tell apart.
#[derive(Clone, Debug, Serialize)]
pub struct Tie {
    /// What is open.
    pub what: String,
    /// The readings, the one that is used first.
    pub readings: Vec<String>,
    /// The flag that decides.
    pub flag: &'static str,
}

/// How fine the numbers of a quantity are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Resolution {
    /// Half a unit in the last place of the largest value, in SI.
    pub absolute: f64,
    /// The same divided by the largest value.
    pub relative: f64,
}

/// How the numbers of a file were rounded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rounding {
    /// All digits of double precision.
    Double,
    /// Numbers of single precision.
    Single,
    /// So many digits behind the decimal mark.
    Decimals(u32),
    /// So many significant digits.
    Significant(u32),
}

impl std::fmt::Display for Rounding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Rounding::Double => write!(f, "f64, all digits"),
            Rounding::Single => write!(f, "f32"),
            Rounding::Decimals(n) => write!(f, "{n} decimals"),
            Rounding::Significant(n) => write!(f, "{n} significant digits"),
        }
    }
}

/// A vector at every row.
#[derive(Clone, Debug)]
pub struct Vectors {
    /// The values, SI, world or body components; components that a file has not are zero.
    pub values: Vec<Vector3<f64>>,
    /// The axes that the file has.
    pub axes: Vec<usize>,
    /// How fine they are.
    pub resolution: Resolution,
}

/// An angle, or its rate, at every row.
#[derive(Clone, Debug)]
pub struct Scalars {
    /// The values, rad or rad/s; an angle without jumps by a turn.
    pub values: Vec<f64>,
    /// How fine they are.
    pub resolution: Resolution,
    /// Rows at which a turn was added or taken off.
    pub unwrapped: usize,
}

/// An attitude at every row.
#[derive(Clone, Debug)]
pub struct Attitudes {
    /// (w, x, y, z), body to world, as the file has them: not normalised.
    pub raw: Vec<[f64; 4]>,
    /// How they were read.
    pub reading: Reading,
    /// How fine they are, in rad.
    pub resolution: Resolution,
}

impl Attitudes {
    /// The attitude of a row.
    pub fn at(&self, row: usize) -> Rotation<f64> {
        readings::rotation(self.raw[row])
    }
}

/// A trajectory.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// Times, s; counted from the whole number `time_origin` in the unit of the file.
    pub time: Vec<f64>,
    /// What was taken off the times.
    pub time_origin: i64,
    /// How fine the times are, s.
    pub time_resolution: f64,
    /// Position, m.
    pub position: Option<Vectors>,
    /// Velocity, world components, m/s.
    pub velocity: Option<Vectors>,
    /// Attitude.
    pub attitude: Option<Attitudes>,
    /// Angular velocity, rad/s, in `omega_frame`.
    pub omega: Option<Vectors>,
    /// The frame of `omega`.
    pub omega_frame: OmegaFrame,
    /// Angle of a plane motion, rad.
    pub angle: Option<Scalars>,
    /// Its rate, rad/s.
    pub angle_rate: Option<Scalars>,
    /// How its numbers were rounded.
    pub rounding: Rounding,
    /// What was recognised.
    pub recognised: Vec<Recognised>,
    /// Columns that are not used.
    pub unused: Vec<String>,
    /// What the numbers could not decide.
    pub ties: Vec<Tie>,
    /// How the readings of the attitude compare; the chosen one first.
    pub(crate) scored: Option<Scored>,
    /// Whether the names of the quaternion's components say another order than the numbers.
    pub order_not_as_named: bool,
    /// The frame that the names say.
    pub named_frame: Option<NamedFrame>,
}

impl Trajectory {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.time.len()
    }

    /// Angular velocity of a row in body components.
    pub fn omega_body(&self, row: usize) -> Option<Vector3<f64>> {
        let omega = self.omega.as_ref()?.values[row];
        match self.omega_frame {
            OmegaFrame::Body => Some(omega),
            OmegaFrame::World => Some(self.attitude.as_ref()?.at(row).rotate_back(omega)),
        }
    }

    /// Angular velocity of a row in world components.
    pub fn omega_world(&self, row: usize) -> Option<Vector3<f64>> {
        let omega = self.omega.as_ref()?.values[row];
        match self.omega_frame {
            OmegaFrame::World => Some(omega),
            OmegaFrame::Body => Some(self.attitude.as_ref()?.at(row).rotate(omega)),
        }
    }
}

/// Makes a trajectory from a table.
///
/// # Errors
/// No time; nothing that moves; a flag that fits no column.
pub fn of_table(table: &Table, choices: &Choices) -> Result<Trajectory, Error> {
    let named = !table.dialect.names.is_empty();
    let mut layout = if named { roles::by_names(table) } else { roles::by_numbers(table) };
    if named && layout.get(Role::Time).is_none() {
        let numbers = roles::by_numbers(table);
        if layout.groups.is_empty() {
            layout = numbers;
        } else if let Some(time) = numbers.get(Role::Time) {
            let free = !layout.groups.iter().any(|g| g.columns.contains(&time.columns[0]));
            layout.groups.extend(
                free.then(|| Group { reason: "the first column that always grows".to_owned(), ..time.clone() }),
            );
        }
    }
    apply_units(&mut layout, table, choices)?;
    build::trajectory(table, &layout, choices)
}

/// Puts units from flags and from a line of units into the groups.
fn apply_units(layout: &mut Layout, table: &Table, choices: &Choices) -> Result<(), Error> {
    for group in &mut layout.groups {
        let below = table.columns[group.columns[0]].unit.as_deref().and_then(names::unit);
        if group.unit.is_none() {
            group.unit = below;
        }
    }
    for (target, text) in &choices.units {
        let unit = names::unit(text)
            .ok_or_else(|| Error::flag("--unit", format!("'{text}' is no unit that is known; as deg/s, ms, mm, ft")))?;
        let is_target = |g: &&mut Group| {
            role_id(g.role) == target.as_str() || g.columns.iter().any(|i| table.columns[*i].name == *target)
        };
        let group = layout.groups.iter_mut().find(is_target).ok_or_else(|| {
            let message =
                format!("'{target}' is no column and no quantity of {}; give COLUMN=UNIT", table.path.display());
            Error::flag("--unit", message)
        })?;
        group.unit = Some(unit);
    }
    Ok(())
}

/// The name of a role in messages.
pub fn role_id(role: Role) -> &'static str {
    match role {
        Role::Time => "time",
        Role::Nanoseconds => "nanoseconds",
        Role::Index => "index",
        Role::Position => "position",
        Role::Velocity => "velocity",
        Role::Quaternion | Role::Matrix | Role::RotationVector | Role::Euler | Role::Angles | Role::Mrp => "attitude",
        Role::Omega => "angular-velocity",
        Role::Angle => "angle",
        Role::AngleRate => "angle-rate",
        Role::Other => "other",
    }
}

mod build;
