//! The parts of a trajectory, each from its group of columns.

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

fn take_time(out: &mut Trajectory, table: &Table, layout: &Layout) -> Result<(), Error> {
    let Some(group) = layout.get(Role::Time) else {
        let names: Vec<&str> = table.columns.iter().map(|c| c.name.as_str()).take(14).collect();
        let message = format!("no column of times among {}", names.join(", "));
        let remedy = "name the columns in order with --columns, the time as t";
        return Err(Error::at(&table.path, table.first_line, 1, message, remedy));
    };
    let column = &table.columns[group.columns[0]];
    out.time.clone_from(&column.values);
    out.time_origin = column.origin;
    let digits = column.digits;
    let largest = column.values.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
    let whole = !digits.fraction;
    out.time_resolution = if whole {
        0.5
    } else if digits.single && digits.significant > 7 {
        largest * f64::from(f32::EPSILON) / 2.0
    } else if digits.significant < 15 {
        0.5 * 10.0_f64.powi(-digits.decimals)
    } else {
        largest * f64::EPSILON / 2.0
    };
    if let Some(rest) = layout.get(Role::Nanoseconds) {
        let ns = &table.columns[rest.columns[0]];
        for (t, n) in out.time.iter_mut().zip(&ns.values) {
            *t += (n + ns.origin as f64) * 1e-9;
        }
        out.time_resolution = 0.5e-9;
    }
    Ok(())
}

fn scale_time(out: &mut Trajectory, factor: f64) {
    for t in &mut out.time {
        *t *= factor;
    }
    out.time_resolution *= factor;
}

const TIME_UNITS: [(f64, &str); 4] = [(1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns")];

/// The unit of stamps counted from 1970: 2001 to 2128 as seconds, ms, us or ns.
fn epoch(out: &Trajectory) -> Option<(f64, String, String)> {
    let origin = (out.time_origin as f64).abs();
    let (factor, unit) = TIME_UNITS.into_iter().find(|(f, _)| (1e9..5e9).contains(&(origin * f)))?;
    Some((factor, unit.to_owned(), "counted from 1970".to_owned()))
}

/// The unit of time where the name has none: by x' = v or q' = q omega / 2, or by the size of whole numbers.
fn unnamed_time(out: &Trajectory, table: &Table, layout: &Layout) -> (f64, String, String) {
    let mut steps: Vec<f64> = out.time.windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let step = steps[steps.len() / 2];
    if step >= 1.0 {
        let of_position =
            out.position.as_ref().zip(out.velocity.as_ref()).and_then(|(x, v)| rate_ratio(&out.time, x, v));
        let of_angle = out.angle.as_ref().zip(out.angle_rate.as_ref()).and_then(|(x, v)| {
            let flat = |s: &Scalars| Vectors {
                values: s.values.iter().map(|x| Vector3::new(*x, 0.0, 0.0)).collect(),
                axes: vec![0],
                resolution: s.resolution,
            };
            rate_ratio(&out.time, &flat(x), &flat(v))
        });
        let near = |ratio: f64| TIME_UNITS.into_iter().find(|(f, _)| (ratio / f - 1.0).abs() < 0.1);
        if let Some((factor, unit)) = of_position.or(of_angle).and_then(near) {
            return (factor, unit.to_owned(), "so that x' = v".to_owned());
        }
        let attitude = ATTITUDES.iter().find_map(|role| layout.get(*role));
        if let (Some(attitude), Some(omega)) = (attitude, layout.get(Role::Omega)) {
            let misfit = |factor: f64| {
                let time: Vec<f64> = out.time.iter().map(|t| t * factor).collect();
                readings::score(table, &time, attitude, omega)[0].misfit
            };
            let best = TIME_UNITS.into_iter().map(|(f, unit)| (misfit(f), f, unit)).min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((_, factor, unit)) = best.filter(|b| b.0 < 0.1) {
                return (factor, unit.to_owned(), "so that q' = q omega / 2".to_owned());
            }
        }
    }
    if step >= 1e5 {
        return (1e-9, "ns".to_owned(), "whole numbers, too far apart for s, ms or us".to_owned());
    }
    (1.0, "s".to_owned(), "no unit in the name".to_owned())
}

/// r of x1 - x0 = r (t1 - t0) (v0 + v1) / 2, if that explains the movement.
fn rate_ratio(time: &[f64], x: &Vectors, v: &Vectors) -> Option<f64> {
    let (mut above, mut below, mut moved) = (0.0, 0.0, 0.0);
    for i in 0..time.len() - 1 {
        let dx = x.values[i + 1] - x.values[i];
        let told = (v.values[i] + v.values[i + 1]) * ((time[i + 1] - time[i]) / 2.0);
        above += dx.dot(&told);
        below += told.norm_squared();
        moved += dx.norm_squared();
    }
    let ratio = above / below;
    (moved > 0.0 && above * above > 0.9 * below * moved).then_some(ratio)
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

const ATTITUDES: [Role; 6] =
    [Role::Quaternion, Role::Matrix, Role::Mrp, Role::Euler, Role::RotationVector, Role::Angles];

fn take_attitude(out: &mut Trajectory, table: &Table, layout: &Layout, choices: &Choices) {
    let attitude = ATTITUDES.iter().find_map(|role| layout.get(*role));
    let omega = layout.get(Role::Omega);
    out.named_frame = omega.and_then(|g| g.frame);
    let mut why = String::new();
    let reading = match (attitude, omega) {
        (Some(attitude), Some(omega)) => Some(decide(out, table, attitude, omega, choices, &mut why)),
        (Some(attitude), None) => Some(undecided(out, table, attitude, layout, &mut why)),
        _ => None,
    };
    if let (Some(group), Some(reading)) = (attitude, reading) {
        let mut cells = Vec::new();
        let quaternion = |row| {
            attitude::row(table, group, row, &mut cells);
            reading.quaternion(&cells)
        };
        let raw: Vec<[f64; 4]> = (0..out.time.len()).map(quaternion).collect();
        let largest = match reading.notation {
            Notation::Euler(_) | Notation::RotationVector => {
                group.columns.iter().flat_map(|i| &table.columns[*i].values).fold(0.0_f64, |m, x| m.max(x.abs()))
                    * reading.scale
            }
            _ => 1.0,
        };
        let resolution = resolution(largest, reading.scale, out.rounding);
        // An angle is twice the difference of unit quaternions.
        let resolution = Resolution { absolute: 2.0 * resolution.absolute.max(f64::EPSILON / 2.0), ..resolution };
        out.attitude = Some(Attitudes { raw, reading, resolution });
        let mut read = recognised(table, group, reading.name());
        read.reason = format!("{}; {why}", read.reason);
        out.recognised.push(read);
    }
    if let Some(group) = omega {
        let named = group.unit.as_ref().map(|u| u.0);
        let scale = named.or(out.scored.map(|s| s.omega_scale)).unwrap_or(1.0);
        out.omega = Some(take_vectors(table, group, out.rounding, scale));
        if attitude.is_none() {
            out.omega_frame = match (choices.omega_frame, out.named_frame) {
                (Some(frame), _) => frame,
                (None, Some(NamedFrame::Body)) => OmegaFrame::Body,
                _ => OmegaFrame::World,
            };
        }
        let frame = if out.omega_frame == OmegaFrame::World { "world" } else { "body" };
        let unit = if scale == 1.0 { "rad/s" } else { "deg/s" };
        let mut read = recognised(table, group, format!("{frame} axes, {unit}"));
        if attitude.is_some() {
            read.reason = format!("{}; {why}", read.reason);
        }
        out.recognised.push(read);
    }
}

/// Decides between the readings by q' = q omega / 2.
fn decide(
    out: &mut Trajectory,
    table: &Table,
    attitude: &Group,
    omega: &Group,
    choices: &Choices,
    why: &mut String,
) -> Reading {
    let mut scored = readings::score(table, &out.time, attitude, omega);
    if let Some(frame) = choices.omega_frame {
        scored.retain(|s| s.frame == frame);
    }
    let floor = floor(out.rounding);
    let best = scored[0].misfit.max(floor);
    // Among those as good, the usual one: they were made in that order and the frame that the name says is preferred.
    let named = match out.named_frame {
        Some(NamedFrame::Body) => Some(OmegaFrame::Body),
        Some(NamedFrame::World) => Some(OmegaFrame::World),
        None => None,
    };
    let mut tied: Vec<Scored> = scored.iter().filter(|s| s.misfit < CLEARLY * best).copied().collect();
    let renamed = |s: &Scored| !attitude.order_is_open && s.reading.notation == Notation::Xyzw;
    if tied.iter().any(|s| !renamed(s)) {
        tied.retain(|s| !renamed(s));
    }
    tied.sort_by_key(|s| (s.reading.inverse, named.is_some_and(|n| n != s.frame), s.frame == OmegaFrame::Body));
    if scored.iter().all(|s| s.turning < 1e-12) {
        "the body does not turn".clone_into(why);
        let reading = Scored {
            frame: if named == Some(OmegaFrame::Body) { OmegaFrame::Body } else { OmegaFrame::World },
            ..usual(&scored)
        };
        out.omega_frame = reading.frame;
        return reading.reading;
    }
    let unexplained = best > 0.3;
    let chosen = if unexplained { by_factor(&scored) } else { tied[0] };
    out.scored = Some(chosen);
    out.order_not_as_named = renamed(&chosen) && !unexplained;
    out.omega_frame = chosen.frame;
    let other = scored.iter().find(|s| s.misfit >= CLEARLY * best).map(|s| s.misfit);
    *why = match other {
        _ if unexplained => format!("no reading satisfies q' = q omega / 2 (best misses {best:.1e} of the turning)"),
        Some(next) => {
            format!("q' = q omega / 2 to {:.1e} of the turning, the next reading to {next:.1e}", chosen.misfit)
        }
        None => format!("q' = q omega / 2 to {:.1e} of the turning", chosen.misfit),
    };
    let differs = |s: &&Scored| {
        s.reading != chosen.reading
            || s.omega_scale != chosen.omega_scale
            || (s.frame != chosen.frame && chosen.frames_differ > chosen.misfit.max(1e-6))
    };
    let open: Vec<&Scored> = tied.iter().filter(differs).collect();
    if !unexplained && !open.is_empty() {
        let name = |s: &Scored| {
            let frame = if s.frame == OmegaFrame::World { "world" } else { "body" };
            format!("{}, omega in {frame} axes", s.reading.name())
        };
        let readings = std::iter::once(&chosen).chain(open.into_iter().take(3)).map(name).collect();
        let what = "the numbers fit several readings of attitude and angular velocity".to_owned();
        out.ties.push(Tie { what, readings, flag: "--columns or --frame" });
    }
    chosen.reading
}

/// The reading that programs use most.
fn usual(scored: &[Scored]) -> Scored {
    let usual = |s: &&Scored| !s.reading.inverse && s.omega_scale == 1.0;
    scored.iter().find(usual).copied().unwrap_or(scored[0])
}

/// Where no reading fits as it stands: the usual reading whose angular velocity is right but for a factor.
fn by_factor(scored: &[Scored]) -> Scored {
    let best = scored.iter().map(|s| s.free_misfit).fold(f64::INFINITY, f64::min);
    let close = |s: &&Scored| s.free_misfit < (CLEARLY * best).min(0.3);
    let plain = |s: &&Scored| (s.omega_scale != 1.0, s.reading.notation == Notation::Xyzw, s.reading.inverse);
    scored.iter().filter(close).min_by_key(plain).copied().unwrap_or(scored[0])
}

/// The part of the turning in a step that the digits of the file leave open.
fn floor(rounding: Rounding) -> f64 {
    match rounding {
        Rounding::Double => 1e-9,
        Rounding::Single => 1e-5,
        Rounding::Decimals(n) | Rounding::Significant(n) => 10.0_f64.powi(1 - n.min(12) as i32),
    }
}

/// An attitude without an angular velocity: the usual reading, and a tie where the names leave another open.
fn undecided(out: &mut Trajectory, table: &Table, attitude: &Group, layout: &Layout, why: &mut String) -> Reading {
    let largest = attitude.columns.iter().flat_map(|i| &table.columns[*i].values).fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut all = attitude::readings(attitude, largest);
    all.retain(|r| attitude.order_is_open || r.notation != Notation::Xyzw);
    let tum = table.dialect.names.is_empty() && table.dialect.cells == 8 && layout.get(Role::Position).is_some();
    if tum && attitude.role == Role::Quaternion {
        "eight columns without names are t x y z qx qy qz qw (TUM)".clone_into(why);
        return Reading { notation: Notation::Xyzw, scale: 1.0, inverse: false };
    }
    let open: Vec<&Reading> = all.iter().filter(|r| !r.inverse).collect();
    let tied = open.len() > 1 && !matches!(attitude.role, Role::Euler if attitude.unit.is_some());
    if tied {
        let what = "without an angular velocity the numbers cannot decide how the attitude is written".to_owned();
        let readings = open.iter().take(4).map(|r| r.name()).collect();
        out.ties.push(Tie { what, readings, flag: "--columns" });
    }
    "body to world taken, nothing in the file says so".clone_into(why);
    let fits = |r: &&Reading| r.scale == 1.0 || largest > std::f64::consts::TAU || (r.scale - DEGREE).abs() > 1e-9;
    open.iter().copied().find(fits).copied().unwrap_or(all[0])
}
