//! Which columns belong together, and what they are: by their names, or by their numbers where there are none.

use crate::read::names::{Known, NamedFrame, Role, recognise};
use crate::read::{Column, Table};

/// Columns that are one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// What it is.
    pub role: Role,
    /// The columns, in the order of the components: x y z; w x y z of a quaternion; row by row of a matrix.
    pub columns: Vec<usize>,
    /// Which axes a vector of fewer than three components has.
    pub axes: Vec<usize>,
    /// Whether the names leave the order of the components open (a quaternion `q0 q1 q2 q3`).
    pub order_is_open: bool,
    /// The frame that the names say.
    pub frame: Option<NamedFrame>,
    /// The factor to SI and the unit that the names say.
    pub unit: Option<(f64, String)>,
    /// Why it is taken for this.
    pub reason: String,
}

/// All groups of a table; columns that no group has are not used.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Layout {
    /// The groups.
    pub groups: Vec<Group>,
    /// Groups of a role that another group has already.
    pub unused: Vec<Group>,
}

impl Layout {
    /// The group of a role.
    pub fn get(&self, role: Role) -> Option<&Group> {
        self.groups.iter().find(|g| g.role == role)
    }

    fn owner(&self, column: usize) -> bool {
        self.groups.iter().chain(&self.unused).any(|g| g.columns.contains(&column))
    }
}

/// The roles in the order in which columns are given to them: those with most columns first.
const ORDER: [Role; 15] = [
    Role::Time,
    Role::Nanoseconds,
    Role::Other,
    Role::Matrix,
    Role::Quaternion,
    Role::Mrp,
    Role::Euler,
    Role::RotationVector,
    Role::Omega,
    Role::Velocity,
    Role::Position,
    Role::Angles,
    Role::Angle,
    Role::AngleRate,
    Role::Index,
];

/// The layout that the names of the columns say.
pub(crate) fn by_names(table: &Table) -> Layout {
    let known: Vec<Option<Known>> =
        table.columns.iter().map(|c| if c.is_numeric() { recognise(&c.name) } else { None }).collect();
    let mut layout = Layout::default();
    // Three components before two, two before one: `x y z` is a position even where `x` alone could be one.
    for wanted in [9, 4, 3, 2, 1] {
        for role in ORDER {
            add_groups(&mut layout, table, &known, role, wanted);
        }
    }
    layout
}

fn add_groups(layout: &mut Layout, table: &Table, known: &[Option<Known>], role: Role, wanted: usize) {
    if !sizes(role).contains(&wanted) {
        return;
    }
    // `omega_body_z` beside an angular velocity in space is a component of a second one, and no rate of an angle.
    if role == Role::AngleRate && layout.get(Role::Omega).is_some() && layout.get(Role::Angle).is_none() {
        return;
    }
    let mut stems: Vec<&str> = Vec::new();
    for known in known.iter().flatten().filter(|k| k.roles.contains(&role)) {
        if !stems.contains(&known.stem.as_str()) {
            stems.push(&known.stem);
        }
    }
    let mut found: Vec<(usize, Group)> = Vec::new();
    for stem in stems {
        let belongs = |i: &usize| {
            !layout.owner(*i) && known[*i].as_ref().is_some_and(|k| k.roles.contains(&role) && k.stem == stem)
        };
        let columns: Vec<usize> = (0..known.len()).filter(belongs).collect();
        if let Some(group) = group(table, known, role, &columns, wanted) {
            let dropped = known[group.columns[0]].as_ref().map_or(0, |k| k.dropped);
            found.push((dropped, group));
        }
    }
    found.sort_by_key(|(dropped, _)| *dropped);
    for (_, group) in found {
        if layout.get(role).is_none() { layout.groups.push(group) } else { layout.unused.push(group) }
    }
}

/// How many columns a role can have.
fn sizes(role: Role) -> &'static [usize] {
    match role {
        Role::Matrix => &[9],
        Role::Quaternion => &[4],
        Role::Mrp | Role::Euler | Role::RotationVector | Role::Angles | Role::Omega => &[3],
        Role::Position | Role::Velocity => &[3, 2, 1],
        Role::Other => &[3, 1],
        _ => &[1],
    }
}

/// The components of a set of names in order, if the set is complete.
fn group(table: &Table, known: &[Option<Known>], role: Role, columns: &[usize], wanted: usize) -> Option<Group> {
    let label = |i: usize| known[i].as_ref().map_or("", |k| k.component.as_str());
    let sets: &[(&[&str], &[usize], bool)] = match (role, wanted) {
        (_, 9) => &[
            (&["11", "12", "13", "21", "22", "23", "31", "32", "33"], &[], false),
            (&["00", "01", "02", "10", "11", "12", "20", "21", "22"], &[], false),
            (&["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"], &[], false),
            (&["0", "1", "2", "3", "4", "5", "6", "7", "8"], &[], false),
        ],
        (_, 4) => &[
            (&["w", "x", "y", "z"], &[], false),
            (&["w", "i", "j", "k"], &[], false),
            (&["r", "i", "j", "k"], &[], false),
            (&["r", "x", "y", "z"], &[], false),
            (&["s", "x", "y", "z"], &[], false),
            (&["real", "i", "j", "k"], &[], false),
            (&["0", "1", "2", "3"], &[], true),
            (&["1", "2", "3", "4"], &[], true),
        ],
        (_, 3) => &[
            (&["x", "y", "z"], &[0, 1, 2], false),
            (&["1", "2", "3"], &[0, 1, 2], false),
            (&["0", "1", "2"], &[0, 1, 2], false),
        ],
        (_, 2) => &[
            (&["x", "y"], &[0, 1], false),
            (&["x", "z"], &[0, 2], false),
            (&["y", "z"], &[1, 2], false),
            (&["0", "1"], &[0, 1], false),
            (&["1", "2"], &[0, 1], false),
        ],
        _ => &[
            (&[""], &[0], false),
            (&["x"], &[0], false),
            (&["y"], &[1], false),
            (&["z"], &[2], false),
            (&["0"], &[0], false),
        ],
    };
    sets.iter().find_map(|(labels, axes, order_is_open)| {
        let place = |l: &str| columns.iter().copied().find(|i| label(*i) == l);
        let columns: Vec<usize> = labels.iter().map(|l| place(l)).collect::<Option<_>>()?;
        let first = known[columns[0]].as_ref()?;
        let frame = columns.iter().find_map(|i| known[*i].as_ref().and_then(|k| k.frame));
        let names: Vec<&str> = columns.iter().map(|i| table.columns[*i].name.as_str()).collect();
        let reason = format!("names {}", names.join(" "));
        Some(Group {
            role,
            columns,
            axes: axes.to_vec(),
            order_is_open: *order_is_open,
            frame,
            unit: first.unit.clone(),
            reason,
        })
    })
}

/// The layout of a table without names, from its numbers alone: what grows is the time, four columns of norm one are a
/// quaternion, a triple whose differences another triple explains is a position with its velocity.
pub(crate) fn by_numbers(table: &Table) -> Layout {
    let numeric: Vec<usize> = (0..table.columns.len()).filter(|i| table.columns[*i].is_numeric()).collect();
    let grows = |i: &&usize| table.columns[**i].values.windows(2).all(|w| w[1] > w[0]);
    let growing: Vec<usize> = numeric.iter().filter(grows).copied().collect();
    let mut layout = Layout::default();
    let Some(&first) = growing.first() else { return layout };
    // A first column 0, 1, 2, ... beside another that grows is the number of the row.
    let counts = |i: usize| table.columns[i].values.windows(2).all(|w| w[1] - w[0] == 1.0);
    let time = match growing.get(1) {
        Some(&second) if counts(first) && second == first + 1 => {
            layout.groups.push(plain(Role::Index, vec![first], "counts the rows"));
            second
        }
        _ => first,
    };
    layout.groups.push(plain(Role::Time, vec![time], "no header; the first column that always grows"));
    let rest: Vec<usize> = numeric.into_iter().filter(|i| *i > time).collect();
    place_rest(&mut layout, &table.columns, time, &rest);
    layout
}

fn plain(role: Role, columns: Vec<usize>, reason: &str) -> Group {
    let axes = (0..columns.len()).collect();
    Group {
        role,
        columns,
        axes,
        order_is_open: role == Role::Quaternion,
        frame: None,
        unit: None,
        reason: reason.to_owned(),
    }
}

fn place_rest(layout: &mut Layout, columns: &[Column], time: usize, rest: &[usize]) {
    let unit_norm = |w: &[usize]| {
        let norm = |row: usize| w.iter().map(|i| columns[*i].values[row].powi(2)).sum::<f64>();
        (0..columns[time].values.len()).all(|row| (norm(row) - 1.0).abs() < 0.02)
    };
    let quaternion = rest.windows(4).find(|w| unit_norm(w)).map(<[usize]>::to_vec);
    let others: Vec<usize> =
        rest.iter().copied().filter(|i| !quaternion.as_ref().is_some_and(|q| q.contains(i))).collect();
    if let Some(q) = quaternion {
        layout.groups.push(plain(Role::Quaternion, q, "no header; four columns of norm 1"));
    }
    let size = match others.len() {
        3 | 6 | 9 => 3,
        4 => 2,
        1 | 2 => 1,
        _ => return,
    };
    let mut triples: Vec<Vec<usize>> = others.chunks(size).map(<[usize]>::to_vec).collect();
    let has_attitude = layout.get(Role::Quaternion).is_some();
    let pair = best_pair(columns, time, &triples);
    let behind = |triple: &[usize]| layout.get(Role::Quaternion).is_some_and(|q| q.columns[0] < triple[0]);
    if size == 3 && triples.len() == 1 && behind(&triples[0]) {
        let reason = "no header; three columns behind an attitude, and no position";
        layout.groups.push(plain(Role::Omega, triples.remove(0), reason));
    } else if let Some((p, v)) = pair {
        let reason = "no header; its differences are the velocity times the step";
        layout.groups.push(plain(Role::Position, triples[p].clone(), reason));
        layout.groups.push(plain(Role::Velocity, triples[v].clone(), "no header; explains how the position moves"));
        triples = triples.into_iter().enumerate().filter(|(i, _)| *i != p && *i != v).map(|(_, t)| t).collect();
    } else if !triples.is_empty() {
        let first = triples.remove(0);
        layout.groups.push(plain(Role::Position, first, "no header; the first columns after the time"));
    }
    if size == 3 && has_attitude && !triples.is_empty() {
        layout.groups.push(plain(Role::Omega, triples.remove(0), "no header; the columns left beside an attitude"));
    }
}

/// The two triples of which one is the rate of the other, better than half of its movement.
fn best_pair(columns: &[Column], time: usize, triples: &[Vec<usize>]) -> Option<(usize, usize)> {
    let t = &columns[time].values;
    let misfit = |p: usize, v: usize| {
        let (mut missed, mut moved) = (0.0, 0.0);
        for (i, j) in triples[p].iter().zip(&triples[v]) {
            let (x, v) = (&columns[*i].values, &columns[*j].values);
            for n in 0..t.len() - 1 {
                let dx = x[n + 1] - x[n];
                missed += (dx - (t[n + 1] - t[n]) * (v[n] + v[n + 1]) / 2.0).powi(2);
                moved += dx * dx;
            }
        }
        missed / moved
    };
    let pairs = (0..triples.len()).flat_map(|p| (0..triples.len()).map(move |v| (p, v))).filter(|(p, v)| p != v);
    let scored = pairs.map(|(p, v)| (misfit(p, v), (p, v))).filter(|(m, _)| *m < 0.25);
    scored.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, pair)| pair)
}
