//! What the body of a file is: a scene of the catalogue mapped onto three dimensions, its parameters from flags, its start and
//! its place in space from the first rows.

use nalgebra::Vector3;

use crate::error::Error;
use crate::physics::{Force, Moment, Physics};
use crate::trajectory::Trajectory;

/// What the flags say of the body.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The scene.
    pub scene: Option<String>,
    /// Its parameters.
    pub set: Vec<(String, String)>,
    /// Principal moments of inertia, kg m^2.
    pub inertia: Option<Vector3<f64>>,
}

/// A law of motion with the words for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// The scene, or `body` for an inertia alone.
    pub name: String,
    /// The law.
    pub physics: Physics,
    /// A ball over a floor.
    pub ball: Option<Ball>,
}

/// A ball that bounces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Height of its centre at a contact, m.
    pub radius: f64,
    /// Part of the speed that a bounce leaves.
    pub restitution: f64,
}

impl Ball {
    /// Whether the ball is above the floor from row i to the next, by more than it can fall in a row.
    pub fn flies(&self, t: &Trajectory, g: Vector3<f64>, i: usize, h: f64) -> bool {
        let (Some(x), Some(v)) = (&t.position, &t.velocity) else { return true };
        let up = -g.normalize();
        let above = |row: usize| x.values[row].dot(&up) - self.radius - 0.25 * h * v.values[row].norm();
        above(i) > 0.02 && above(i + 1) > 0.02
    }
}

/// Scenes that a file can be held against, each with the parameters that can be set.
pub const SCENES: &[(&str, &[&str])] = &[
    ("torque-free-spin", &["inertia", "gravity"]),
    ("tennis-racket", &["inertia", "gravity"]),
    ("symmetric-top", &["inertia_1", "inertia_3", "gravity"]),
    ("box-tumbling", &["inertia", "gravity", "mass"]),
    ("damped-spin", &["inertia", "damping", "linear_damping"]),
    ("constant-force", &["mass", "force", "gravity"]),
    ("linear-drag", &["mass", "drag", "gravity"]),
    ("oscillator", &["mass", "stiffness", "anchor"]),
    ("spring-3d", &["mass", "stiffness", "anchor"]),
    ("kepler", &["mu", "centre"]),
    ("pendulum", &["mass", "length", "gravity", "inertia_pivot"]),
    ("heavy-top", &["inertia_1", "inertia_3", "mgl"]),
    ("asymmetric-top", &["inertia", "mgl"]),
    ("bouncing-ball", &["gravity", "restitution", "radius", "mass"]),
];

struct Values<'a>(&'a [(String, String)]);

impl Values<'_> {
    fn vector(&self, name: &str) -> Result<Option<Vector3<f64>>, Error> {
        let Some((_, text)) = self.0.iter().find(|(n, _)| n == name) else { return Ok(None) };
        numbers(text)
            .and_then(|n| <[f64; 3]>::try_from(n).ok())
            .map(|n| Some(n.into()))
            .ok_or_else(|| Error::flag("--set", format!("{name}={text}: three numbers are expected, as {name}=1,2,3")))
    }

    fn number(&self, name: &str) -> Result<Option<f64>, Error> {
        let Some((_, text)) = self.0.iter().find(|(n, _)| n == name) else { return Ok(None) };
        match numbers(text).as_deref() {
            Some([x]) => Ok(Some(*x)),
            _ => Err(Error::flag("--set", format!("{name}={text}: one finite number is expected"))),
        }
    }

    fn positive(&self, name: &str, default: f64) -> Result<f64, Error> {
        let x = self.number(name)?.unwrap_or(default);
        if x > 0.0 { Ok(x) } else { Err(Error::flag("--set", format!("{name}={x}: give a number > 0"))) }
    }

    fn needed(&self, name: &str, scene: &str) -> Result<f64, Error> {
        let x = self.number(name)?;
        x.filter(|x| *x > 0.0).ok_or_else(|| Error::flag("--set", format!("{scene} needs {name}=NUMBER > 0")))
    }
}

/// Finite numbers parted by commas.
pub(crate) fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|x| x.trim().parse::<f64>().ok().filter(|x| x.is_finite())).collect()
}

/// The subject that the flags name.
///
/// # Errors
/// An unknown scene or parameter; a value out of range; a parameter that is needed and not given.
pub fn subject(settings: &Settings, t: &Trajectory) -> Result<Option<Subject>, Error> {
    let values = Values(&settings.set);
    let mut physics = Physics { inertia: settings.inertia, ..Physics::UNKNOWN };
    let Some(name) = &settings.scene else {
        if let Some((name, _)) = settings.set.first() {
            return Err(Error::flag("--set", format!("'{name}' is set without a scene; give --scene NAME too")));
        }
        let body = settings.inertia.map(|_| Subject { name: "body".to_owned(), physics, ball: None });
        return Ok(body);
    };
    let base = name.split('/').next().unwrap_or(name);
    let Some((_, known)) = SCENES.iter().find(|(id, _)| *id == base) else {
        let all: Vec<&str> = SCENES.iter().map(|(id, _)| *id).collect();
        return Err(Error::flag(
            "--scene",
            format!("'{name}' is no scene a file can be held against; known: {}", all.join(", ")),
        ));
    };
    if let Some((unknown, _)) = settings.set.iter().find(|(n, _)| !known.contains(&n.as_str())) {
        return Err(Error::flag("--set", format!("{base} has no parameter '{unknown}'; it has {}", known.join(", "))));
    }
    let gravity = values.vector("gravity");
    let mut ball = None;
    match base {
        "torque-free-spin" | "tennis-racket" | "symmetric-top" | "box-tumbling" | "damped-spin" => {
            let symmetric = values.number("inertia_1")?.zip(values.number("inertia_3")?);
            let set = values.vector("inertia")?.or(symmetric.map(|(a, c)| Vector3::new(a, a, c)));
            physics.inertia = set.or(physics.inertia);
            let positive = physics.inertia.is_some_and(|i| i.iter().all(|x| *x > 0.0));
            if !positive {
                return Err(Error::flag(
                    "--inertia",
                    format!("{base} needs the principal moments, as --inertia 1.25,0.75,1.75"),
                ));
            }
            physics.moment = Some(Moment::None);
            physics.force = Some(gravity?.filter(|g| g.norm() > 0.0).map_or(Force::None, Force::Constant));
            physics.angular_damping = values.number("damping")?;
            physics.linear_damping = values.number("linear_damping")?;
        }
        "constant-force" | "linear-drag" => {
            let mass = values.positive("mass", 1.0)?;
            let force = values.vector("force")?.map(|f| f / mass);
            physics.force = Some(Force::Constant(force.or(gravity?).unwrap_or(Vector3::new(0.0, 0.0, -9.81))));
            physics.linear_damping = values.number("drag")?.map(|c| c / mass);
        }
        "oscillator" | "spring-3d" => {
            let rate = values.needed("stiffness", base)? / values.positive("mass", 1.0)?;
            let anchor = values.vector("anchor")?.unwrap_or(Vector3::zeros());
            physics.force = Some(Force::Spring { rate, anchor });
        }
        "kepler" => {
            let centre = values.vector("centre")?.unwrap_or(Vector3::zeros());
            physics.force = Some(Force::Kepler { mu: values.positive("mu", 1.0)?, centre });
        }
        "pendulum" => {
            let (mass, length) = (values.positive("mass", 1.0)?, values.needed("length", base)?);
            let gravity = values.positive("gravity", 9.81)?;
            let inertia = values.positive("inertia_pivot", mass * length * length)?;
            physics.pendulum = Some(mass * gravity * length / inertia);
        }
        "heavy-top" | "asymmetric-top" => {
            let symmetric = values.number("inertia_1")?.zip(values.number("inertia_3")?);
            let set = values.vector("inertia")?.or(symmetric.map(|(a, c)| Vector3::new(a, a, c)));
            physics.inertia = set.or(physics.inertia);
            if physics.inertia.is_none() {
                return Err(Error::flag(
                    "--inertia",
                    format!("{base} needs the principal moments about the fixed point"),
                ));
            }
            let arm = Vector3::new(0.0, 0.0, values.needed("mgl", base)?);
            physics.moment = Some(Moment::Weight { arm, gravity: Vector3::new(0.0, 0.0, -1.0) });
        }
        _ => {
            let g = values.positive("gravity", 9.81)?;
            physics.force = Some(Force::Constant(Vector3::new(0.0, 0.0, -g)));
            ball = Some(Ball {
                radius: values.number("radius")?.unwrap_or(0.0),
                restitution: values.number("restitution")?.unwrap_or(1.0),
            });
        }
    }
    fit_axes(&mut physics, t);
    Ok(Some(Subject { name: name.clone(), physics, ball }))
}

/// Puts a vertical force onto the axis that a file of one or two dimensions has.
fn fit_axes(physics: &mut Physics, t: &Trajectory) {
    let axes = t.position.as_ref().map_or(&[0, 1, 2][..], |p| &p.axes);
    let Some(Force::Constant(g)) = physics.force else { return };
    if axes.len() < 3 && !axes.contains(&2) && g.x == 0.0 && g.y == 0.0 {
        let last = axes.last().copied().unwrap_or(0);
        physics.force = Some(Force::Constant(Vector3::from_fn(|i, _| if i == last { g.z } else { 0.0 })));
    }
}

/// Principal moments from a flag.
///
/// # Errors
/// Anything but three numbers > 0 of which none exceeds the sum of the others.
pub fn inertia(text: &str) -> Result<Vector3<f64>, Error> {
    let moments = numbers(text).and_then(|n| <[f64; 3]>::try_from(n).ok()).filter(|m| m.iter().all(|x| *x > 0.0));
    let Some([a, b, c]) = moments else {
        return Err(Error::flag("--inertia", format!("'{text}': three numbers > 0 are expected, as 1.25,0.75,1.75")));
    };
    let slack = 1.0 + 8.0 * f64::EPSILON;
    if a > (b + c) * slack || b > (c + a) * slack || c > (a + b) * slack {
        return Err(Error::flag(
            "--inertia",
            format!("'{text}': no body has one moment larger than the sum of the others"),
        ));
    }
    Ok(Vector3::new(a, b, c))
}
