use nalgebra::Vector3;

use crate::methods::facts::{Conserved, Facts};
use crate::model::{Method, State};
use crate::pose::{Body, Pose, Twist, Update};
use crate::real::Single;
use crate::rigid_body::{BodyOmega, RigidBody, RigidModel};
use crate::rotation::{Rotation, cross, dot};
use crate::space::Vector;

/// Newton steps before the iteration is given up.
const MOST_ITERATIONS: usize = 50;

/// The discrete rigid body of Moser and Veselov between two half kicks of the torque. Order 2, two evaluations; Newton's
/// iteration in three unknowns.
///
/// With l = I omega the turn of a step is the unit quaternion (1, c) / |(1, c)| of
/// h l0 (1 + |c|^2) = 2 (I c + c x I c), then q1 = q0 c and R l is left where it is. Without a torque it keeps R l and the
/// energy to rounding. Where the iteration does not converge the state becomes NaN, which the driver reports. The attitude
/// update of the model is not used: the turn is the unknown.
/// Source: J. Moser, A. P. Veselov, Commun. Math. Phys. 139 (1991) 217; with quaternions E. Hairer, G. Vilmart, J. Phys. A 39
/// (2006) 13225.
#[derive(Clone, Copy, Debug, Default)]
pub struct MoserVeselov;

impl MoserVeselov {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "moser-veselov",
        title: "Discrete Moser-Veselov",
        order: 2,
        evaluations: Some(2),
        implicit: true,
        symplectic: Some(true),
        reversible: Some(true),
        conserves: &[Conserved::Energy, Conserved::Momentum],
        formula: "kick h/2, h l0 (1 + |c|^2) = 2 (I c + c x I c), q1 = q0 (1, c) / |(1, c)|, R l kept, kick h/2",
        latex: &[
            r"h\,l_0\,(1 + |c|^2) = 2\,(I c + c\times I c),\quad q_1 = q_0\,\frac{(1, c)}{\sqrt{1 + |c|^2}},\quad R_1 l_1 = R_0 l_0",
            r"\text{between two kicks}\quad l\to l + \tfrac{h}{2}\,\tau",
        ],
        source: "J. Moser, A. P. Veselov, Commun. Math. Phys. 139 (1991) 217; E. Hairer, G. Vilmart, J. Phys. A 39 (2006) 13225",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Single, B: RigidBody<T>, U: Update<Frame = Body>> Method<T, BodyOmega<B, U>> for MoserVeselov {
    fn step(
        &self,
        m: &BodyOmega<B, U>,
        t: T,
        h: T,
        s: State<Pose<T, U, B::Position>>,
    ) -> State<Pose<T, U, B::Position>> {
        let half = h * T::lit(0.5);
        let inertia = m.body().inertia();
        let alpha = |t: T, s: &State<_>| {
            let at = m.kinematics(s);
            let torque = m.body().torque(t, &at).plus_in_body(s.q.attitude, Vector3::zero());
            Twist { linear: m.body().acceleration(t, &at), angular: torque.component_div(&inertia) }
        };
        let kick = alpha(t, &s);
        let u = s.v.add_scaled(kick, half);
        let l = inertia.component_mul(&u.angular);
        let turn = turn(inertia, l, h);
        let q = Pose::new(s.q.position.add_scaled(u.linear, h), s.q.attitude * turn);
        let v = Twist { linear: u.linear, angular: turn.rotate_back(l).component_div(&inertia) };
        let kick = alpha(t + h, &State { q, v: v.add_scaled(kick, half) });
        State { q, v: v.add_scaled(kick, half) }
    }
}

/// The turn of a step: Newton's iteration from c = h omega / 2, by Cramer's rule; NaN where it does not converge.
fn turn<T: Single>(inertia: Vector3<T>, l: Vector3<T>, h: T) -> Rotation<T> {
    let two = T::lit(2.0);
    let mut c = l.component_div(&inertia) * (h * T::lit(0.5));
    let mut last = f64::INFINITY;
    for _ in 0..MOST_ITERATIONS {
        let ic = inertia.component_mul(&c);
        let residual = (ic + cross(c, ic)) * two - l * (h * (T::lit(1.0) + dot(c, c)));
        let column = |i: usize| {
            let e = Vector3::from_fn(|j, _| T::lit(if i == j { 1.0 } else { 0.0 }));
            (e * inertia[i] + cross(e, ic) + cross(c, e) * inertia[i]) * two - l * (h * two * c[i])
        };
        let (x, y, z) = (column(0), column(1), column(2));
        let (yz, zx, xy) = (cross(y, z), cross(z, x), cross(x, y));
        let correction = Vector3::new(dot(residual, yz), dot(residual, zx), dot(residual, xy)) / dot(x, yz);
        c -= correction;
        let size = dot(correction, correction).to_f64().sqrt();
        let scale = dot(c, c).to_f64().sqrt();
        // The last correction was applied: what is left is its square, or rounding where it no longer falls.
        if size <= T::EPSILON.sqrt() * scale && (size <= T::EPSILON * scale || size >= 0.5 * last) || size == 0.0 {
            return Rotation { w: T::lit(1.0), v: c }.normalized();
        }
        last = size;
    }
    Rotation { w: T::lit(f64::NAN), v: Vector3::repeat(T::lit(f64::NAN)) }
}
