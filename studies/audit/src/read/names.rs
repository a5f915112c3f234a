//! What the name of a column means, by the table `names.txt`.

use std::sync::LazyLock;

/// What a column is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// Time, s.
    Time,
    /// A part of the time, to be added to it: whole nanoseconds beside whole seconds.
    Nanoseconds,
    /// The number of the row or of the step.
    Index,
    /// Position of the centre of mass, world frame, m.
    Position,
    /// Its velocity, world frame, m/s.
    Velocity,
    /// Attitude as a quaternion.
    Quaternion,
    /// Attitude as a rotation matrix.
    Matrix,
    /// Attitude as a rotation vector, rad.
    RotationVector,
    /// Attitude as Euler angles, rad.
    Euler,
    /// Attitude as three angles of which the name does not say whether they are Euler angles or a rotation vector.
    Angles,
    /// Attitude as modified Rodrigues parameters, axis tan(angle / 4).
    Mrp,
    /// Angular velocity, rad/s.
    Omega,
    /// The angle of a plane motion, rad.
    Angle,
    /// Its rate, rad/s.
    AngleRate,
    /// Something that is not used.
    Other,
}

/// The frame in which a name says that a vector is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NamedFrame {
    /// Axes that do not turn.
    World,
    /// Axes that turn with the body.
    Body,
}

/// A name that the table knows.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// What it may be, the most likely first; the other columns decide.
    pub roles: Vec<Role>,
    /// The component: `x`, `0`, `11`, `w`; empty for a scalar.
    pub component: String,
    /// The name without component, unit and frame: columns that share it belong together.
    pub stem: String,
    /// The frame that the name says.
    pub frame: Option<NamedFrame>,
    /// The factor to SI that the name says, with the unit as written.
    pub unit: Option<(f64, String)>,
    /// Leading words that were dropped: the fewer, the better the match.
    pub dropped: usize,
}

struct Pattern {
    role: Role,
    frame: Option<NamedFrame>,
    stem: String,
    /// None: a whole name. Some(None): any component. Some(Some(c)): this one.
    component: Option<Option<String>>,
}

struct Unit {
    kind: Kind,
    factor: f64,
    name: String,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Time,
    Length,
    Speed,
    Angle,
    Rate,
}

struct Names {
    patterns: Vec<Pattern>,
    units: Vec<Unit>,
}

static NAMES: LazyLock<Names> = LazyLock::new(|| {
    let mut names = Names { patterns: Vec::new(), units: Vec::new() };
    for line in include_str!("names.txt").lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["role", role, patterns @ ..] => {
                names.patterns.extend(patterns.iter().filter_map(|p| pattern(role, p)));
            }
            ["unit", kind, factor, units @ ..] => {
                let kind = match *kind {
                    "time" => Kind::Time,
                    "length" => Kind::Length,
                    "speed" => Kind::Speed,
                    "angle" => Kind::Angle,
                    _ => Kind::Rate,
                };
                let factor = factor.parse().unwrap_or(f64::NAN);
                names.units.extend(units.iter().map(|name| Unit { kind, factor, name: (*name).to_owned() }));
            }
            _ => {}
        }
    }
    names
});

fn pattern(role: &str, text: &str) -> Option<Pattern> {
    let (role, frame) = match role.split_once('/') {
        Some((role, "body")) => (role, Some(NamedFrame::Body)),
        Some((role, _)) => (role, Some(NamedFrame::World)),
        None => (role, None),
    };
    let role = match role {
        "time" | "milliseconds" => Role::Time,
        "nanoseconds" => Role::Nanoseconds,
        "index" => Role::Index,
        "position" => Role::Position,
        "velocity" => Role::Velocity,
        "quaternion" => Role::Quaternion,
        "matrix" => Role::Matrix,
        "rotation-vector" => Role::RotationVector,
        "euler" => Role::Euler,
        "angles" => Role::Angles,
        "mrp" => Role::Mrp,
        "omega" => Role::Omega,
        "angle" => Role::Angle,
        "angle-rate" => Role::AngleRate,
        "other" => Role::Other,
        _ => return None,
    };
    let (stem, component) = match text.split_once('=') {
        Some(("*", "*")) => (String::new(), Some(None)),
        Some((name, component)) => (name.to_owned(), Some(Some(component.to_owned()))),
        None => match text.strip_suffix('*') {
            Some(stem) => (stem.to_owned(), Some(None)),
            None => (text.to_owned(), None),
        },
    };
    Some(Pattern { role, frame, stem, component })
}

/// Lower case, with '_' at every change of case and in place of every mark.
fn normalised(name: &str) -> String {
    let mut out = String::with_capacity(name.len() + 4);
    let mut previous = ' ';
    for c in name.chars() {
        if c.is_uppercase() && previous.is_lowercase() {
            out.push('_');
        }
        if c.is_alphanumeric() {
            out.extend(c.to_lowercase());
        } else if !out.is_empty() && !out.ends_with('_') {
            out.push('_');
        }
        previous = c;
    }
    out.trim_end_matches('_').to_owned()
}

/// Whether a text may be the name of a column: something that is no number.
pub(super) fn looks_like_a_name(text: &str) -> bool {
    !text.is_empty() && text.chars().any(char::is_alphabetic) && text.parse::<f64>().is_err()
}

/// The factor to SI of a unit as it is written: `deg/s`, `[mm]`, `rad s^-1`.
pub(crate) fn unit(text: &str) -> Option<(f64, String)> {
    let name = unit_name(text);
    NAMES.units.iter().find(|u| u.name == name).map(|u| (u.factor, name.clone()))
}

fn unit_name(text: &str) -> String {
    normalised(&text.replace("^-1", "").replace("**-1", "").replace('°', "deg").replace("·", " "))
        .trim_start_matches('_')
        .replace("_1", "")
}

fn fits(role: Role, kind: Kind) -> bool {
    match role {
        Role::Time | Role::Nanoseconds => kind == Kind::Time,
        Role::Position => kind == Kind::Length,
        Role::Velocity => kind == Kind::Speed,
        Role::Euler | Role::Angles | Role::RotationVector | Role::Angle => kind == Kind::Angle,
        Role::Omega | Role::AngleRate => kind == Kind::Rate,
        _ => false,
    }
}

/// What the name of a column means; None if the table does not know it.
pub(crate) fn recognise(name: &str) -> Option<Known> {
    let (bare, bracketed) = without_brackets(name);
    let whole = normalised(&bare);
    let mut endings = vec![(whole.clone(), bracketed)];
    if endings[0].1.is_none() {
        let words: Vec<&str> = whole.split('_').collect();
        for taken in (1..words.len().min(4)).rev() {
            let (rest, last) = words.split_at(words.len() - taken);
            if unit(&last.join("_")).is_some() {
                endings.push((rest.join("_"), Some(last.join("_"))));
            }
        }
    }
    // With a unit taken off first: `x_m` is a position in metres, not the component m of x.
    endings.reverse();
    endings.iter().find_map(|(rest, unit_text)| by_patterns(rest, unit_text.as_deref()))
}

/// The name without a unit in brackets, and the unit.
fn without_brackets(name: &str) -> (String, Option<String>) {
    let Some(open) = name.rfind(['[', '(']) else { return (name.to_owned(), None) };
    let inner = name[open + 1..].trim_end().trim_end_matches([']', ')']);
    let is_unit = inner.is_empty() || unit(inner).is_some();
    if open == 0 || !is_unit { (name.to_owned(), None) } else { (name[..open].to_owned(), Some(inner.to_owned())) }
}

const FRAMES: [(&str, NamedFrame); 8] = [
    ("world", NamedFrame::World),
    ("global", NamedFrame::World),
    ("inertial", NamedFrame::World),
    ("eci", NamedFrame::World),
    ("ned", NamedFrame::World),
    ("body", NamedFrame::Body),
    ("local", NamedFrame::Body),
    ("rel", NamedFrame::Body),
];

fn by_patterns(name: &str, unit_text: Option<&str>) -> Option<Known> {
    let words: Vec<&str> = name.split('_').filter(|w| !w.is_empty()).collect();
    let frame_at = |word: &str| FRAMES.iter().find(|(name, _)| *name == word).map(|(_, frame)| *frame);
    // A first word is the name of an object, not a frame.
    let named_frame = words.iter().skip(1).find_map(|w| frame_at(w));
    let kept: Vec<&str> =
        words.iter().enumerate().filter(|(i, w)| *i == 0 || frame_at(w).is_none()).map(|(_, w)| *w).collect();
    (0..kept.len()).find_map(|dropped| {
        let rest = kept[dropped..].join("_");
        let mut found: Vec<(&Pattern, String)> =
            NAMES.patterns.iter().filter_map(|p| Some((p, matched(p, &rest)?))).collect();
        if let Some(text) = unit_text.filter(|t| !t.is_empty()) {
            let kinds: Vec<Kind> = NAMES.units.iter().filter(|u| u.name == unit_name(text)).map(|u| u.kind).collect();
            found.retain(|(p, _)| kinds.iter().any(|k| fits(p.role, *k)));
        }
        let (first, component) = found.first()?;
        let unit = unit_text.and_then(unit);
        let mut roles: Vec<Role> = Vec::new();
        for (pattern, _) in &found {
            if !roles.contains(&pattern.role) {
                roles.push(pattern.role);
            }
        }
        let prefix = kept[..dropped].join("_");
        let stem = if rest.ends_with(component.as_str()) {
            rest[..rest.len() - component.len()].trim_end_matches('_').to_owned()
        } else {
            String::new()
        };
        let frame = named_frame.or(found.iter().find_map(|(p, _)| p.frame)).or(first.frame);
        Some(Known { roles, component: component.clone(), stem: format!("{prefix}/{stem}"), frame, unit, dropped })
    })
}

/// The component, if the pattern fits the name.
fn matched(pattern: &Pattern, name: &str) -> Option<String> {
    match &pattern.component {
        None => (pattern.stem == name).then(String::new),
        Some(Some(component)) => (pattern.stem == name).then(|| component.clone()),
        Some(None) => {
            let rest = name.strip_prefix(pattern.stem.as_str())?.trim_start_matches('_').replace('_', "");
            is_component(pattern.role, &rest).then_some(rest)
        }
    }
}

fn is_component(role: Role, text: &str) -> bool {
    let one = |set: &str| text.len() == 1 && set.contains(text);
    match role {
        Role::Quaternion => one("wxyzijkrs01234") || text == "real",
        Role::Matrix => text.len() == 2 && text.bytes().all(|b| b"0123xyz".contains(&b)) || one("012345678"),
        Role::Other => one("xyz0123") || text.is_empty(),
        Role::Euler | Role::Angles => one("xyz0123"),
        _ => one("xyz0123"),
    }
}
