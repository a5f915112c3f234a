use nalgebra::Vector3;

use crate::methods::facts::{Conserved, Facts};
use crate::model::{Method, Model, State};
use crate::pose::{Pose, Twist, Update, World};
use crate::real::Real;
use crate::rigid_body::{RigidBody, RigidModel, WorldMomentum};
use crate::rotation::cross;
use crate::space::{Space, Vector};

/// One turn by a mean angular velocity, the angular momentum stored in the world frame; `bracket` times the second term of
/// Magnus's series, (h^2/12) omega' x omega, belongs to the mean.
#[inline(always)]
fn step<T: Real, B: RigidBody<T>, U: Update<Frame = World>>(
    bracket: f64,
    m: &WorldMomentum<B, U>,
    (t, h): (T, T),
    s: State<Pose<T, U, B::Position>>,
) -> State<Pose<T, U, B::Position>> {
    let half = h * T::lit(0.5);
    let load = m.rate(t, &s);
    let velocity = m.velocity(s.q, s.v);
    let (q, omega) = (s.q.attitude, velocity.angular);
    let moment = load.angular + cross(s.v.angular, omega);
    let turning: Vector3<T> = q.rotate(q.rotate_back(moment).component_div(&m.body().inertia()));
    let mean = Twist {
        linear: velocity.linear.add_scaled(load.linear, half),
        angular: omega
            .add_scaled(turning, half)
            .add_scaled(cross(turning, omega), h * h * T::lit(bracket) / T::lit(12.0)),
    };
    let moved = s.q.retract(mean, h);
    let last = m.rate(t + h, &State { q: moved, v: s.v.add_scaled(load, h) });
    State { q: moved, v: s.v.add_scaled(load + last, half) }
}

macro_rules! buss {
    ($($(#[$doc:meta])* $method:ident: $bracket:literal, $id:literal, $title:literal, $formula:literal, $latex:literal;)*) => {$(
        $(#[$doc])*
        ///
        /// omega' = I_w^-1 (tau0 + L0 x omega0). Without a torque L is kept exactly, as a vector. Here loads that change count
        /// with the mean of the two ends of the step (the paper takes them as constant).
        /// Source: S. R. Buss, J. Comput. Phys. 164 (2000) 377.
        #[derive(Clone, Copy, Debug, Default)]
        pub struct $method;

        impl $method {
            /// What is known of it.
            pub const FACTS: Facts = Facts {
                id: $id,
                title: $title,
                order: 2,
                evaluations: Some(2),
                reversible: Some(false),
                conserves: &[Conserved::Momentum],
                formula: $formula,
                latex: &[
                    $latex,
                    r"\dot\omega = I_w^{-1}(\tau_0 + L_0\times\omega_0),\quad L_1 = L_0 + \tfrac{h}{2}\,(\tau_0 + \tau_1)",
                ],
                source: "S. R. Buss, J. Comput. Phys. 164 (2000) 377",
                ..Facts::NOTHING_KNOWN
            };
        }

        impl<T: Real, B: RigidBody<T>, U: Update<Frame = World>> Method<T, WorldMomentum<B, U>> for $method {
            #[inline(always)]
            fn step(
                &self,
                m: &WorldMomentum<B, U>,
                t: T,
                h: T,
                s: State<Pose<T, U, B::Position>>,
            ) -> State<Pose<T, U, B::Position>> {
                step($bracket, m, (t, h), s)
            }
        }
    )*};
}

buss! {
    /// Buss's second-order step: q1 = exp(h (omega0 + (h/2) omega')) q0. Order 2, two evaluations.
    BussSecondOrder: 0.0, "buss-second-order", "Buss, second order", "q1 = exp(h (omega0 + h omega' / 2)) q0, L1 = L0 + h tau",
        r"q_1 = \exp(h\,\omega_0 + \tfrac{h^2}{2}\,\dot\omega)\,q_0";
    /// Buss's augmented second-order step: q1 = exp(h (omega0 + (h/2) omega' + (h^2/12) omega' x omega0)) q0. Order 2, two
    /// evaluations.
    BussAugmented: 1.0, "buss-augmented", "Buss, augmented second order",
        "q1 = exp(h (omega0 + h omega' / 2 + h^2 omega' x omega0 / 12)) q0, L1 = L0 + h tau",
        r"q_1 = \exp(h\,\omega_0 + \tfrac{h^2}{2}\,\dot\omega + \tfrac{h^3}{12}\,\dot\omega\times\omega_0)\,q_0";
}
