//! The parts of a trajectory, each from its group of columns.

mod orientation;
mod time;

use orientation::take_attitude;
use time::{epoch, scale_time, take_time, unnamed_time};

use super::*;

const DEGREE: f64 = std::f64::consts::PI / 180.0;

pub(super) fn trajectory(table: &Table, layout: &Layout, choices: &Choices) -> Result<Trajectory, Error> {
    let rounding = rounding(table, layout);
    let mut out = Trajectory {
        time: Vec::new(),
        time_origin: 0,
        time_resolution: 0.0,
        position: None,
        velocity: None,
        attitude: None,
        omega: None,
        omega_frame: OmegaFrame::World,
        angle: None,
        angle_rate: None,
        rounding,
        recognised: Vec::new(),
        unused: Vec::new(),
        ties: Vec::new(),
        scored: None,
        order_not_as_named: false,
        named_frame: None,
    };
    take_time(&mut out, table, layout)?;
    let named = layout.get(Role::Time).and_then(|g| g.unit.clone());
    let by_name =
        named.map(|(factor, unit)| (factor, unit.clone(), format!("unit {unit} in the name"))).or_else(|| epoch(&out));
    if let Some((factor, ..)) = &by_name {
        scale_time(&mut out, *factor);
    }
    let vectors =
        |role: Role| layout.get(role).map(|g| take_vectors(table, g, rounding, g.unit.as_ref().map_or(1.0, |u| u.0)));
    out.position = vectors(Role::Position);
    out.velocity = vectors(Role::Velocity);
    out.angle = layout.get(Role::Angle).map(|g| scalars(table, g, rounding, true));
    out.angle_rate = layout.get(Role::AngleRate).map(|g| scalars(table, g, rounding, false));
    let (_, unit, why) = by_name.unwrap_or_else(|| {
        let by_numbers = unnamed_time(&out, table, layout);
        scale_time(&mut out, by_numbers.0);
        by_numbers
    });
    if let Some(group) = layout.get(Role::Time) {
        let mut read = recognised(table, group, unit);
        read.reason = format!("{}; {why}", read.reason);
        out.recognised.push(read);
    }
    take_attitude(&mut out, table, layout, choices);
    for role in [Role::Position, Role::Velocity, Role::Angle, Role::AngleRate] {
        if let Some(group) = layout.get(role) {
            let unit = match (&group.unit, role) {
                (Some((_, unit)), _) => unit.replace('_', "/"),
                (None, Role::Position) => "m".to_owned(),
                (None, Role::Velocity) => "m/s".to_owned(),
                (None, Role::Angle) => "rad".to_owned(),
                _ => "rad/s".to_owned(),
            };
            out.recognised.push(recognised(table, group, unit));
        }
    }
    let used: Vec<usize> =
        layout.groups.iter().filter(|g| g.role != Role::Other).flat_map(|g| g.columns.clone()).collect();
    out.unused =
        (0..table.columns.len()).filter(|i| !used.contains(i)).map(|i| table.columns[i].name.clone()).collect();
    if out.position.is_none()
        && out.attitude.is_none()
        && out.angle.is_none()
        && out.velocity.is_none()
        && out.omega.is_none()
    {
        return Err(nothing_moves(table));
    }
    Ok(out)
}

fn recognised(table: &Table, group: &Group, reading: String) -> Recognised {
    let columns = group.columns.iter().map(|i| table.columns[*i].name.clone()).collect();
    Recognised { role: group.role, columns, reading, reason: group.reason.clone() }
}

/// The error where no column was recognised: what each is taken for, and the flag that helps.
fn nothing_moves(table: &Table) -> Error {
    let names: Vec<&str> = table.columns.iter().map(|c| c.name.as_str()).take(14).collect();
    let message = format!("no position, attitude or angle among the columns {}", names.join(", "));
    let remedy = "name the columns in order, as --columns t,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz; - leaves one out";
    Error::at(&table.path, table.first_line.saturating_sub(1).max(1), 1, message, remedy)
}

/// How a file was rounded: told by all its columns but the time.
fn rounding(table: &Table, layout: &Layout) -> Rounding {
    let times: Vec<usize> = layout
        .groups
        .iter()
        .filter(|g| matches!(g.role, Role::Time | Role::Index | Role::Nanoseconds))
        .flat_map(|g| g.columns.clone())
        .collect();
    let digits: Vec<Digits> = (0..table.columns.len())
        .filter(|i| !times.contains(i) && table.columns[*i].is_numeric())
        .map(|i| table.columns[i].digits)
        .collect();
    let significant = digits.iter().map(|d| d.significant).max().unwrap_or(0);
    if digits.iter().all(|d| d.single) && significant > 7 {
        return Rounding::Single;
    }
    let broken: Vec<&Digits> = digits.iter().filter(|d| d.fraction).collect();
    let decimals = broken.first().map_or(0, |d| d.decimals);
    if !broken.is_empty() && decimals >= 3 && broken.iter().all(|d| d.fixed && d.decimals == decimals) {
        return Rounding::Decimals(decimals.unsigned_abs());
    }
    if significant >= 15 { Rounding::Double } else { Rounding::Significant(significant) }
}

fn resolution(largest: f64, scale: f64, rounding: Rounding) -> Resolution {
    let relative = match rounding {
        Rounding::Double => f64::EPSILON / 2.0,
        Rounding::Single => f64::from(f32::EPSILON) / 2.0,
        Rounding::Significant(n) => 5.0 * 10.0_f64.powi(-(n as i32)),
        Rounding::Decimals(n) => {
            let absolute = 0.5 * 10.0_f64.powi(-(n as i32)) * scale;
            return Resolution { absolute, relative: absolute / largest.max(f64::MIN_POSITIVE) };
        }
    };
    Resolution { absolute: largest * relative, relative }
}

fn take_vectors(table: &Table, group: &Group, rounding: Rounding, scale: f64) -> Vectors {
    let axes: Vec<usize> = if group.axes.is_empty() { (0..group.columns.len()).collect() } else { group.axes.clone() };
    let rows = table.columns[group.columns[0]].values.len();
    let mut values = vec![Vector3::zeros(); rows];
    let mut largest = 0.0_f64;
    for (column, axis) in group.columns.iter().zip(&axes) {
        let column = &table.columns[*column];
        let origin = column.origin as f64;
        for (value, x) in values.iter_mut().zip(&column.values) {
            value[*axis] = (x + origin) * scale;
            largest = largest.max(value[*axis].abs());
        }
    }
    Vectors { values, axes, resolution: resolution(largest, scale, rounding) }
}

fn scalars(table: &Table, group: &Group, rounding: Rounding, is_angle: bool) -> Scalars {
    let column = &table.columns[group.columns[0]];
    let scale = group.unit.as_ref().map_or(1.0, |u| u.0);
    let mut values: Vec<f64> = column.values.iter().map(|x| x * scale).collect();
    let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut unwrapped = 0;
    if is_angle {
        let turn = std::f64::consts::TAU;
        let mut added = 0.0;
        for i in 1..values.len() {
            let jump = values[i] + added - values[i - 1];
            if jump.abs() > 0.9 * turn && jump.abs() < 1.1 * turn {
                added -= turn * jump.signum();
                unwrapped += 1;
            }
            values[i] += added;
        }
    }
    Scalars { values, resolution: resolution(largest, scale, rounding), unwrapped }
}
