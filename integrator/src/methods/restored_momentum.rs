use nalgebra::Vector3;

use crate::methods::facts::{Conserved, Facts};
use crate::model::{Method, State};
use crate::pose::{Body, Pose, Twist, Update};
use crate::real::Single;
use crate::rigid_body::{BodyOmega, RigidBody, RigidModel};
use crate::rotation::{cross, dot};
use crate::space::{Space, Vector};

/// Semi-implicit Euler with the explicit gyroscopic torque in the body frame, after which the length of the angular
/// momentum is restored. Order 1, one evaluation.
///
/// With l = I omega0: l* = l + h l x omega0, omega1 = I^-1 (l* |l| / |l*| + h tau(t0, q0, omega0)), then
/// q1 = q0 exp(h omega1); the translation is semi-implicit Euler's. The length of L is kept, its direction is not.
/// Source: the step of PhysX, Jolt (`MotionProperties::ApplyGyroscopicForceInternal`), Rapier and Avian.
#[derive(Clone, Copy, Debug, Default)]
pub struct RestoredMomentum;

impl RestoredMomentum {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "restored-momentum",
        title: "Explicit gyroscopic torque, |L| restored",
        order: 1,
        evaluations: Some(1),
        reversible: Some(false),
        conserves: &[Conserved::MomentumNorm],
        worked_out: true,
        formula: "l* = l + h l x omega0, I omega1 = l* |l| / |l*| + h tau0",
        latex: &[
            r"l = I\omega_0,\quad l^\ast = l + h\,l\times\omega_0",
            r"I\omega_1 = l^\ast\,\frac{|l|}{|l^\ast|} + h\,\tau_0,\quad q_1 = q_0\exp(h\,\omega_1)",
        ],
        source: "PhysX, Jolt, Rapier, Avian",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Single, B: RigidBody<T>, U: Update<Frame = Body>> Method<T, BodyOmega<B, U>> for RestoredMomentum {
    #[inline(always)]
    fn step(
        &self,
        m: &BodyOmega<B, U>,
        t: T,
        h: T,
        s: State<Pose<T, U, B::Position>>,
    ) -> State<Pose<T, U, B::Position>> {
        let inertia = m.body().inertia();
        let at = m.kinematics(&s);
        let torque = m.body().torque(t, &at).plus_in_body(s.q.attitude, Vector3::zero());
        let l = inertia.component_mul(&s.v.angular);
        let turned = l.add_scaled(cross(l, s.v.angular), h);
        let momentum = (turned * restoring(l, turned)).add_scaled(torque, h);
        let v = Twist {
            linear: s.v.linear.add_scaled(m.body().acceleration(t, &at), h),
            angular: momentum.component_div(&inertia),
        };
        State { q: s.q.retract(v, h), v }
    }
}

/// |l| / |l*|; 1 for a body at rest.
#[inline(always)]
fn restoring<T: Single>(l: Vector3<T>, turned: Vector3<T>) -> T {
    let squared = dot(turned, turned);
    if squared == T::lit(0.0) { T::lit(1.0) } else { (dot(l, l) / squared).sqrt() }
}
