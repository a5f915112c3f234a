use nalgebra::Vector3;

use crate::methods::facts::Facts;
use crate::model::{Method, Model, State};
use crate::pose::{Body, Pose, Update};
use crate::real::Single;
use crate::rigid_body::{BodyOmega, RigidBody};
use crate::rotation::{Rotation, cross, dot};
use crate::space::Vector;

/// The attitude by local linearisation, the rates by explicit Euler, as JSBSim can be set. Order 1, one evaluation.
///
/// With w = omega0, d = omega' at the start, r = h |w| / 2, s = sin r / r: q1 = q0 e / |e|,
/// e = (cos r - C4 w . d / 4, C2 w / 2 + C3 d / 2 + C4 w x d / 4), C2 = h s, C3 = 4 (1 - cos r) / |w|^2, C4 = 4 (h - C2) / |w|^2;
/// v1 = v0 + h rate(t0, q0, v0), x1 = x0 + h v0. The attitude alone is of order 2 for a known omega(t).
/// Source: L. E. Barker, R. L. Bowles, L. H. Williams, NASA TN D-7347 (1973); JSBSim, `FGPropagate`, eLocalLinearization.
#[derive(Clone, Copy, Debug, Default)]
pub struct LocalLinearization;

impl LocalLinearization {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "local-linearization",
        title: "Local linearisation, rates by explicit Euler",
        order: 1,
        evaluations: Some(1),
        reversible: Some(false),
        formula: "q1 = q0 e / |e|, e = (cos r - C4 w.d / 4, C2 w / 2 + C3 d / 2 + C4 w x d / 4), r = h |w| / 2; omega1 = omega0 + h d",
        latex: &[
            r"e = \left(\cos r - \tfrac{C_4}{4}\,\omega_0\cdot\dot\omega,\ \tfrac{C_2}{2}\,\omega_0 + \tfrac{C_3}{2}\,\dot\omega + \tfrac{C_4}{4}\,\omega_0\times\dot\omega\right),\quad r = \tfrac{h}{2}|\omega_0|",
            r"C_2 = h\,\tfrac{\sin r}{r},\quad C_3 = \tfrac{4 (1 - \cos r)}{|\omega_0|^2},\quad C_4 = \tfrac{4 (h - C_2)}{|\omega_0|^2}",
            r"q_1 = q_0\,e / |e|,\quad \omega_1 = \omega_0 + h\,\dot\omega",
        ],
        source: "L. E. Barker, R. L. Bowles, L. H. Williams, NASA TN D-7347 (1973); JSBSim",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Single, B: RigidBody<T>, U: Update<Frame = Body>> Method<T, BodyOmega<B, U>> for LocalLinearization {
    #[inline(always)]
    fn step(
        &self,
        m: &BodyOmega<B, U>,
        t: T,
        h: T,
        s: State<Pose<T, U, B::Position>>,
    ) -> State<Pose<T, U, B::Position>> {
        let rate = m.rate(t, &s);
        let q = Pose::new(s.q.position.add_scaled(s.v.linear, h), s.q.attitude * turn(s.v.angular, rate.angular, h));
        State { q, v: s.v.add_scaled(rate, h) }
    }
}

/// The turn e / |e| of a step.
#[inline(always)]
fn turn<T: Single>(w: Vector3<T>, d: Vector3<T>, h: T) -> Rotation<T> {
    let (half, quarter) = (T::lit(0.5), T::lit(0.25));
    let r_squared = dot(w, w) * h * h * quarter;
    let (cosine, sinc) = T::cos_sinc(r_squared);
    let (_, half_sinc) = T::cos_sinc(r_squared * quarter);
    let c2 = h * sinc;
    // 1 - cos r = 2 sin^2(r/2); the rounding of 1 - s is one of h in the whole, and a body at rest has the limit.
    let c3 = h * h * half * half_sinc * half_sinc;
    let tiny = T::lit(T::EPSILON.sqrt());
    let c4 = if r_squared > tiny { h * h * h * (T::lit(1.0) - sinc) / r_squared } else { h * h * h / T::lit(6.0) };
    let v = (w * c2 + d * c3) * half + cross(w, d) * (c4 * quarter);
    Rotation { w: cosine - c4 * quarter * dot(w, d), v }.normalized()
}
