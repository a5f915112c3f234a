//! Notations of an attitude, each turned into a unit quaternion (w, x, y, z), body to world.

use integrator::Rotation;
use nalgebra::{Matrix3, Vector3};

use super::roles::Group;
use crate::read::Table;
use crate::read::names::Role;

/// One way to read the columns of an attitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notation {
    /// Four numbers, the scalar first.
    Wxyz,
    /// Four numbers, the scalar last.
    Xyzw,
    /// Nine numbers, row by row.
    Matrix,
    /// Axis times angle.
    RotationVector,
    /// R = R_a(first) R_b(second) R_c(third) about these axes, each angle in its column: the i-th number is the index of
    /// the column, which turns about the axis beside it.
    Euler([(usize, usize); 3]),
    /// Axis times tan(angle / 4).
    Mrp,
}

/// A notation with its unit and direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The notation.
    pub notation: Notation,
    /// Factor to rad of its angles.
    pub scale: f64,
    /// Whether the numbers turn world into body, so that their inverse is the attitude.
    pub inverse: bool,
}

impl Reading {
    /// In words.
    pub fn name(&self) -> String {
        let notation = match self.notation {
            Notation::Wxyz => "quaternion, scalar first".to_owned(),
            Notation::Xyzw => "quaternion, scalar last".to_owned(),
            Notation::Matrix => "rotation matrix".to_owned(),
            Notation::RotationVector => "rotation vector".to_owned(),
            Notation::Euler(turns) => {
                let axes: String = turns.iter().map(|(_, axis)| ['X', 'Y', 'Z'][*axis]).collect();
                format!("Euler angles {axes}")
            }
            Notation::Mrp => "modified Rodrigues parameters".to_owned(),
        };
        let unit = match self.notation {
            Notation::Euler(_) | Notation::RotationVector if self.scale == 1.0 => " in rad",
            Notation::Euler(_) | Notation::RotationVector => " in degrees",
            _ => "",
        };
        format!("{notation}{unit}, {}", if self.inverse { "world to body" } else { "body to world" })
    }

    /// The quaternion (w, x, y, z) of one row, not normalised.
    pub fn quaternion(&self, c: &[f64]) -> [f64; 4] {
        let [w, x, y, z] = match self.notation {
            Notation::Wxyz => [c[0], c[1], c[2], c[3]],
            Notation::Xyzw => [c[3], c[0], c[1], c[2]],
            Notation::Matrix => of_matrix(&Matrix3::from_row_slice(c)),
            Notation::RotationVector => Rotation::exp(Vector3::from_column_slice(c) * self.scale).wxyz(),
            Notation::Mrp => {
                let s = Vector3::from_column_slice(c);
                let (square, v) = (s.norm_squared(), s * 2.0);
                let below = 1.0 + square;
                [(1.0 - square) / below, v.x / below, v.y / below, v.z / below]
            }
            Notation::Euler(turns) => {
                let turn = |(column, axis): (usize, usize)| {
                    Rotation::exp(Vector3::from_fn(|i, _| if i == axis { c[column] * self.scale } else { 0.0 }))
                };
                (turn(turns[0]) * turn(turns[1]) * turn(turns[2])).wxyz()
            }
        };
        if self.inverse { [w, -x, -y, -z] } else { [w, x, y, z] }
    }
}

/// The quaternion of a rotation matrix, by the largest of its four components.
fn of_matrix(r: &Matrix3<f64>) -> [f64; 4] {
    let [a, b, c] = [r[(0, 0)], r[(1, 1)], r[(2, 2)]];
    let squares = [1.0 + a + b + c, 1.0 + a - b - c, 1.0 - a + b - c, 1.0 - a - b + c];
    let largest = (0..4).max_by(|i, j| squares[*i].total_cmp(&squares[*j])).unwrap_or(0);
    let s = squares[largest].max(0.0).sqrt() * 2.0;
    let (p, m) = (
        [r[(2, 1)] + r[(1, 2)], r[(0, 2)] + r[(2, 0)], r[(1, 0)] + r[(0, 1)]],
        [r[(2, 1)] - r[(1, 2)], r[(0, 2)] - r[(2, 0)], r[(1, 0)] - r[(0, 1)]],
    );
    match largest {
        0 => [s / 4.0, m[0] / s, m[1] / s, m[2] / s],
        1 => [m[0] / s, s / 4.0, p[2] / s, p[1] / s],
        2 => [m[1] / s, p[2] / s, s / 4.0, p[0] / s],
        _ => [m[2] / s, p[1] / s, p[0] / s, s / 4.0],
    }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The orders of three turns about three axes, the usual one of aerospace first.
const TAIT_BRYAN: [[usize; 3]; 6] = [[2, 1, 0], [0, 1, 2], [2, 0, 1], [0, 2, 1], [1, 0, 2], [1, 2, 0]];
const PROPER: [[usize; 3]; 6] = [[2, 0, 2], [2, 1, 2], [0, 1, 0], [0, 2, 0], [1, 0, 1], [1, 2, 1]];

/// Every reading that the names of the columns leave open, the usual one first.
pub(crate) fn readings(group: &Group, largest: f64) -> Vec<Reading> {
    let scales = match (&group.unit, group.role) {
        (Some((factor, _)), Role::Euler | Role::Angles | Role::RotationVector) => vec![*factor],
        // An angle beyond four turns is no angle in rad.
        (None, Role::Euler | Role::Angles | Role::RotationVector) if largest > 26.0 => vec![DEGREE],
        (None, Role::Euler | Role::Angles | Role::RotationVector) => vec![1.0, DEGREE],
        _ => vec![1.0],
    };
    let named_axes = || TAIT_BRYAN.iter().map(|order| Notation::Euler(order.map(|axis| (axis, axis))));
    let in_order = |axes: &[usize; 3]| Notation::Euler([(0, axes[0]), (1, axes[1]), (2, axes[2])]);
    let notations: Vec<Notation> = match group.role {
        // A program may write the scalar last under names that say first: the second is taken only where the first fails.
        Role::Quaternion => vec![Notation::Wxyz, Notation::Xyzw],
        Role::Matrix => vec![Notation::Matrix],
        Role::RotationVector => vec![Notation::RotationVector],
        Role::Mrp => vec![Notation::Mrp],
        Role::Euler => named_axes().chain(PROPER.iter().map(in_order)).collect(),
        _ => named_axes().chain([Notation::RotationVector]).collect(),
    };
    let mut all = Vec::new();
    for inverse in [false, true] {
        for scale in &scales {
            all.extend(notations.iter().map(|n| Reading { notation: *n, scale: *scale, inverse }));
        }
    }
    all
}

/// The numbers of one row of a group.
pub(crate) fn row(table: &Table, group: &Group, row: usize, into: &mut Vec<f64>) {
    into.clear();
    into.extend(group.columns.iter().map(|i| table.columns[*i].values[row]));
}
