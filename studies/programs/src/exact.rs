//! The exact motion of a scene at given times, as CSV, and everything that sets the case up elsewhere, as JSON.

use faer::fx128;
use integrator::{Rotation, Single};
use nalgebra::Vector3;
use rayon::prelude::*;
use serde_json::{Value as Json, json};

use measure::error::Error;
use scenes::any::AnyScene;
use scenes::observation::{Observation, Quantity, Value};

/// One column: its name, its unit and what it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name, with the unit.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub about: &'static str,
}

/// Names of components in space.
const AXES: [&str; 3] = ["x", "y", "z"];

fn column(name: impl Into<String>, unit: &'static str, about: &'static str) -> Column {
    Column { name: name.into(), unit, about }
}

/// What is seen at a time, in the order of the columns.
fn entries(scene: &dyn AnyScene, t: fx128, seen: &Observation) -> Vec<(Column, f64)> {
    let mut all = vec![(column("t_s", "s", "time"), t.to_f64())];
    let body = seen.rotation();
    for (quantity, value) in &seen.values {
        match value {
            Value::Rotation(q) => {
                let q = upper(*q);
                let parts = [("qw", q.w), ("qx", q.v.x), ("qy", q.v.y), ("qz", q.v.z)];
                let about = "attitude as a unit quaternion (w, x, y, z), from the body frame to the world frame";
                all.extend(parts.map(|(name, x)| (column(name, "1", about), x.to_f64())));
            }
            Value::Vector(x) => all.extend(vector(*quantity, x, body.is_some())),
        }
    }
    if let (Some(q), [x, y, z]) = (body, seen.vector(Quantity::AngularVelocity)) {
        let omega = q.conjugate().rotate(Vector3::new(*x, *y, *z));
        let about = "angular velocity in the body frame";
        let name = |axis: &str| column(format!("omega_body_{axis}_rad_s"), "rad/s", about);
        all.extend(AXES.iter().zip(omega.iter()).map(|(axis, x)| (name(axis), x.to_f64())));
    }
    for entry in scene.scene().invariants(t, seen) {
        let (id, unit) = (entry.invariant.id().replace('-', "_"), entry.invariant.unit());
        let about = if entry.conserved { "conserved along the exact motion" } else { "changes along the exact motion" };
        let suffix = unit.replace([' ', '/'], "_").replace('^', "");
        let many = entry.value.len() > 1;
        for (i, x) in entry.value.iter().enumerate() {
            let name = if many { format!("{id}_{}_{suffix}", AXES[i % 3]) } else { format!("{id}_{suffix}") };
            all.push((column(name, unit, about), x.to_f64()));
        }
    }
    all
}

fn vector(quantity: Quantity, x: &[fx128], is_body: bool) -> Vec<(Column, f64)> {
    let (stem, suffix, unit, about) = match quantity {
        Quantity::Position => ("", "m", "m", "position"),
        Quantity::Velocity => ("v", "m_s", "m/s", "velocity"),
        Quantity::Attitude => ("theta", "rad", "rad", "angle"),
        Quantity::AngularVelocity if is_body => {
            ("omega_world_", "rad_s", "rad/s", "angular velocity in the world frame")
        }
        Quantity::AngularVelocity => ("theta_dot", "rad_s", "rad/s", "rate of the angle"),
    };
    let is_angle = !is_body && matches!(quantity, Quantity::Attitude | Quantity::AngularVelocity);
    let axis = |i: usize| match x.len() {
        _ if is_angle => String::new(),
        1..=3 => AXES[i].to_owned(),
        _ if stem.is_empty() => format!("x{}", i + 1),
        _ => format!("{}", i + 1),
    };
    let name = |i: usize| column(format!("{stem}{}_{suffix}", axis(i)), unit, about);
    x.iter().enumerate().map(|(i, x)| (name(i), x.to_f64())).collect()
}

/// The one of q and -q, which are the same attitude, whose first component other than zero is positive.
fn upper(q: Rotation<fx128>) -> Rotation<fx128> {
    let first = [q.w, q.v.x, q.v.y, q.v.z].into_iter().map(Single::to_f64).find(|x| *x != 0.0);
    if first.is_some_and(|x| x < 0.0) { Rotation { w: -q.w, v: -q.v } } else { q }
}

/// The exact motion of a scene at these times: a header, and one record for each time. Numbers read back exactly.
///
/// # Errors
/// A time at which the motion is not known.
pub fn csv(scene: &dyn AnyScene, times: &[f64]) -> Result<String, Error> {
    let ends_s = scene.scene().ends_s();
    if let Some(late) = times.iter().find(|t| **t >= ends_s) {
        let message = format!("the motion of {} is known before {ends_s} s; leave the time {late} out", scene.id());
        return Err(Error::plan("time", message));
    }
    let columns = columns(scene);
    let record = |&t_s: &f64| {
        let t = fx128::from_f64(t_s);
        let all: Vec<f64> = entries(scene, t, &scene.exact(t)).into_iter().map(|(_, x)| x).collect();
        if let Some((column, x)) = columns.iter().zip(&all).find(|(_, x)| !x.is_finite()) {
            let message =
                format!("{} of {} is {x} at {t_s} s; give times at which it is finite", column.name, scene.id());
            return Err(Error::plan("time", message));
        }
        Ok(all)
    };
    let mut records = times.par_iter().map(record).collect::<Result<Vec<Vec<f64>>, Error>>()?;
    if let Some(first) = columns.iter().position(|column| column.name == "qw") {
        continuous(&mut records, first);
    }
    let header: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let line = |numbers: &Vec<f64>| numbers.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(",") + "\n";
    Ok(header.join(",") + "\n" + &records.par_iter().map(line).collect::<String>())
}

/// Of q and -q, which are the same attitude, the one nearer to that of the record before.
fn continuous(records: &mut [Vec<f64>], first: usize) {
    for i in 1..records.len() {
        let (before, after) = records.split_at_mut(i);
        let (last, q) = (&before[i - 1][first..first + 4], &mut after[0][first..first + 4]);
        if last.iter().zip(q.iter()).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
            q.iter_mut().for_each(|x| *x = -*x);
        }
    }
}

/// The columns of the CSV of a scene.
pub fn columns(scene: &dyn AnyScene) -> Vec<Column> {
    let start = scene.exact(fx128::ZERO);
    entries(scene, fx128::ZERO, &start).into_iter().map(|(column, _)| column).collect()
}

/// Everything that another program needs to compute the same motion.
pub fn case(scene: &dyn AnyScene) -> Json {
    let info = scene.scene().info();
    let numbers = |text: &str| -> Json {
        let all: Vec<f64> = text.split(',').filter_map(|x| x.parse().ok()).collect();
        if let [one] = all[..] { json!(one) } else { json!(all) }
    };
    let parameters: Vec<Json> = scene
        .scene()
        .parameters()
        .into_iter()
        .map(|p| json!({"name": p.name, "value": numbers(&p.value), "unit": p.unit, "about": p.about, "allowed": p.range.to_string()}))
        .collect();
    let start = scene.exact(fx128::ZERO);
    let all = entries(scene, fx128::ZERO, &start);
    let at_start: serde_json::Map<String, Json> =
        all.iter().skip(1).map(|(column, x)| (column.name.clone(), json!(x))).collect();
    let columns: Vec<Json> =
        all.iter().map(|(c, _)| json!({"name": c.name, "unit": c.unit, "about": c.about})).collect();
    let ends_s = scene.scene().ends_s();
    json!({
        "format": 1,
        "scene": scene.id(),
        "about": scenes::about(scene),
        "equation_latex": info.equation,
        "exact_motion": info.source,
        "parameters": parameters,
        "start": at_start,
        "columns": columns,
        "horizon_s": info.horizon_s,
        "time_scale_s": info.time_scale_s,
        "period_s": scene.scene().period_s(),
        "ends_s": ends_s.is_finite().then_some(ends_s),
        "conventions": {
            "units": "SI: m, kg, s, rad",
            "quaternion": "(w, x, y, z), Hamilton's product, turns a vector of the body frame into the world frame",
            "frames": "right-handed; the body frame is that of the principal axes",
            "rounding": "every number is rounded once from double-double and reads back exactly",
        },
    })
}
