use nalgebra::Vector3;

use crate::methods::facts::{Conserved, Facts};
use crate::model::{Method, State};
use crate::pose::{Body, Pose, Twist, Update};
use crate::real::Real;
use crate::rigid_body::{BodyOmega, RigidBody, RigidModel};
use crate::space::Vector;

/// The free body split into rotations about its three axes, each exact, composed symmetrically between two half kicks of
/// the torque. Order 2, two evaluations (of a free body: none that cost anything).
///
/// With l = I omega, X(h): 'turn by h l_x / I_x about the body's x axis', which carries the attitude along and leaves
/// R l where it is, and Y, Z alike: kick by h/2, X(h/2) Y(h/2) Z(h) Y(h/2) X(h/2), kick by h/2. Each kick is
/// l + (h/2) tau, the second with the predicted velocities u + (h/2) I^-1 tau0 and v0 + h a0; the translation is
/// velocity Verlet's. Without a torque R l is kept, and the energy error stays bounded: a Poisson map.
/// Source: R. I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043; S. Reich, Physica D 76 (1994) 375.
#[derive(Clone, Copy, Debug, Default)]
pub struct FreeSplitting;

impl FreeSplitting {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "free-splitting",
        title: "Splitting into axis rotations",
        order: 2,
        evaluations: Some(2),
        symplectic: Some(true),
        reversible: Some(true),
        conserves: &[Conserved::Momentum],
        worked_out: true,
        formula: "kick h/2, X(h/2) Y(h/2) Z(h) Y(h/2) X(h/2), kick h/2; X(h): turn by h l_x / I_x about the body's x axis",
        latex: &[
            r"X_{h/2}\circ Y_{h/2}\circ Z_h\circ Y_{h/2}\circ X_{h/2}\quad\text{between two kicks}\quad l\to l + \tfrac{h}{2}\,\tau",
            r"X_h: \text{turn by the angle}\ h\,l_x / I_x\ \text{about the body's}\ x\ \text{axis}",
        ],
        source: "R. I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043; S. Reich, Physica D 76 (1994) 375",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, B: RigidBody<T>, U: Update<Frame = Body>> Method<T, BodyOmega<B, U>> for FreeSplitting {
    #[inline(always)]
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
        let q = Pose::new(s.q.position.add_scaled(u.linear, h), s.q.attitude);
        let drifted = drift(inertia, half, State { q, v: u });
        let predicted = drifted.v.add_scaled(kick, half);
        let kick = alpha(t + h, &State { q: drifted.q, v: predicted });
        State { q: drifted.q, v: drifted.v.add_scaled(kick, half) }
    }
}

/// X(half) Y(half) Z(2 half) Y(half) X(half) on attitude and angular velocity.
#[inline(always)]
fn drift<T: Real, U: Update<Frame = Body>, P: Vector<T>>(
    inertia: Vector3<T>,
    half: T,
    s: State<Pose<T, U, P>>,
) -> State<Pose<T, U, P>> {
    let start = (s.q.attitude, inertia.component_mul(&s.v.angular));
    let turns = [(0, half), (1, half), (2, half + half), (1, half), (0, half)];
    let (attitude, l) = turns.into_iter().fold(start, |(attitude, l), (axis, time)| {
        let omega = Vector3::from_fn(|i, _| if i == axis { l[i] / inertia[i] } else { T::lit(0.0) });
        let turn = U::increment(omega, time);
        (attitude * turn, turn.rotate_back(l))
    });
    State { q: Pose::new(s.q.position, attitude), v: Twist { linear: s.v.linear, angular: l.component_div(&inertia) } }
}
