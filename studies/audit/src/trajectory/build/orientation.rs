//! The attitude and the angular velocity of a trajectory, and the decision between their readings.

use super::*;

pub(super) const ATTITUDES: [Role; 6] =
    [Role::Quaternion, Role::Matrix, Role::Mrp, Role::Euler, Role::RotationVector, Role::Angles];

pub(super) fn take_attitude(out: &mut Trajectory, table: &Table, layout: &Layout, choices: &Choices) {
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
