//! The times of a trajectory and their unit.

use super::orientation::ATTITUDES;
use super::*;

pub(super) fn take_time(out: &mut Trajectory, table: &Table, layout: &Layout) -> Result<(), Error> {
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

pub(super) fn scale_time(out: &mut Trajectory, factor: f64) {
    for t in &mut out.time {
        *t *= factor;
    }
    out.time_resolution *= factor;
}

const TIME_UNITS: [(f64, &str); 4] = [(1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns")];

/// The unit of stamps counted from 1970: 2001 to 2128 as seconds, ms, us or ns.
pub(super) fn epoch(out: &Trajectory) -> Option<(f64, String, String)> {
    let origin = (out.time_origin as f64).abs();
    let (factor, unit) = TIME_UNITS.into_iter().find(|(f, _)| (1e9..5e9).contains(&(origin * f)))?;
    Some((factor, unit.to_owned(), "counted from 1970".to_owned()))
}

/// The unit of time where the name has none: by x' = v or q' = q omega / 2, or by the size of whole numbers.
pub(super) fn unnamed_time(out: &Trajectory, table: &Table, layout: &Layout) -> (f64, String, String) {
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
