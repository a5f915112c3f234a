use nalgebra::Vector3;

use crate::methods::facts::Facts;
use crate::model::{Method, State};
use crate::pose::{Body, Pose, Twist, Update};
use crate::real::Real;
use crate::rigid_body::{BodyOmega, RigidBody, RigidModel};
use crate::rotation::{cross, dot};
use crate::space::{Space, Vector};

/// Semi-implicit Euler with the gyroscopic torque taken implicitly, by one Newton step in the body frame. Order 1, one
/// evaluation, no iteration.
///
/// With u = omega0 + h I^-1 tau(t0, q0, omega0), f(w) = I (w - u) + h w x I w and f' = I + h (`[u] I - [I u]`):
/// omega1 = u - f'(u)^-1 f(u), then q1 = q0 exp(h omega1); the translation is semi-implicit Euler's.
/// Source: E. Catto, Numerical Methods, Game Developers Conference (2015), slides on the gyroscopic torque.
#[derive(Clone, Copy, Debug, Default)]
pub struct ImplicitGyroscopic;

impl ImplicitGyroscopic {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "implicit-gyroscopic",
        title: "Implicit gyroscopic torque",
        order: 1,
        evaluations: Some(1),
        reversible: Some(false),
        worked_out: true,
        formula: "omega1 = u - f'(u)^-1 f(u), f(w) = I (w - u) + h w x I w, u = omega0 + h I^-1 tau0",
        latex: &[
            r"u = \omega_0 + h\,I^{-1}\tau_0,\quad f(w) = I\,(w - u) + h\,w\times I w",
            r"\omega_1 = u - f'(u)^{-1} f(u),\quad q_1 = q_0\exp(h\,\omega_1)",
        ],
        source: "E. Catto, Numerical Methods, GDC 2015; Bullet, MuJoCo's implicit integrator",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, B: RigidBody<T>, U: Update<Frame = Body>> Method<T, BodyOmega<B, U>> for ImplicitGyroscopic {
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
        let u = s.v.angular.add_scaled(torque.component_div(&inertia), h);
        let v = Twist {
            linear: s.v.linear.add_scaled(m.body().acceleration(t, &at), h),
            angular: u - newton_correction(inertia, u, h),
        };
        State { q: s.q.retract(v, h), v }
    }
}

/// f'(u)^-1 f(u) of f(w) = I (w - u) + h w x I w, by Cramer's rule.
#[inline(always)]
fn newton_correction<T: Real>(inertia: Vector3<T>, u: Vector3<T>, h: T) -> Vector3<T> {
    let l = inertia.component_mul(&u);
    let residual = cross(u, l) * h;
    let column = |i: usize| {
        let e = Vector3::from_fn(|j, _| T::lit(if i == j { 1.0 } else { 0.0 }));
        (e + cross(u, e) * h) * inertia[i] + cross(e, l) * h
    };
    let (a, b, c) = (column(0), column(1), column(2));
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    Vector3::new(dot(residual, bc), dot(residual, ca), dot(residual, ab)) / dot(a, bc)
}
