use nalgebra::Matrix2;

use crate::methods::facts::{Facts, LinearTheory, Rational};
use crate::model::{Method, Model, State};
use crate::real::Real;
use crate::space::{Space, Vector};

/// Velocity Verlet (kick, drift, kick): a0 = rate(t0, q0, v0), u = v0 + (h/2) a0, q1 = q0 + h velocity(q_half, u),
/// a1 = rate(t1, q1, v0 + h a0), v1 = u + (h/2) a1. Order 2, two evaluations.
///
/// The second force is evaluated at v0 + h a0, which keeps order 2 where the force depends on the velocity. The drift
/// takes its velocity at q_half = q0 + (h/2) velocity(q0, u): where the velocity does not depend on q that is u, and no work.
/// Source: L. Verlet, Phys. Rev. 159 (1967) 98; W. Swope et al., J. Chem. Phys. 76 (1982) 637, eq. 7-8.
#[derive(Clone, Copy, Debug, Default)]
pub struct VelocityVerlet;

impl VelocityVerlet {
    /// What is known of it.
    pub const FACTS: Facts = Facts {
        id: "velocity-verlet",
        title: "Velocity Verlet",
        order: 2,
        evaluations: Some(2),
        symplectic: Some(true),
        reversible: Some(true),
        linear: Some(LinearTheory::Partitioned { velocity: Rational::polynomial(&[1.0, 1.0, 0.5]), oscillator }),
        worked_out: true,
        formula: "u = v0 + h a0 / 2, q1 = q0 + h w(qh, u), v1 = u + h a(t1, q1, v0 + h a0) / 2",
        latex: &[
            r"a_0 = a(t_0, q_0, v_0),\quad q_1 = q_0 + h\,v_0 + \tfrac{h^2}{2}\,a_0",
            r"a_1 = a(t_1, q_1, v_0 + h\,a_0),\quad v_1 = v_0 + \tfrac{h}{2}\,(a_0 + a_1)",
        ],
        source: "L. Verlet, Phys. Rev. 159 (1967) 98; W. Swope et al., J. Chem. Phys. 76 (1982) 637",
        ..Facts::NOTHING_KNOWN
    };
}

impl<T: Real, M: Model<T>> Method<T, M> for VelocityVerlet {
    #[inline(always)]
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let half = h * T::lit(0.5);
        let a0 = m.rate(t, &s);
        let u = s.v.add_scaled(a0, half);
        let q_half = s.q.retract(m.velocity(s.q, u), half);
        let q = s.q.retract(m.velocity(q_half, u), h);
        let a1 = m.rate(t + h, &State { q, v: s.v.add_scaled(a0, h) });
        State { q, v: u.add_scaled(a1, half) }
    }
}

/// The step on x'' = -k x - c x' with h = 1: u = v - (k x + c v) / 2 and so on, multiplied out.
fn oscillator(k: f64, c: f64) -> Matrix2<f64> {
    let (half_k, half_c) = (0.5 * k, 0.5 * c);
    let of_x = -half_k * (2.0 - half_k - c);
    let of_v = 1.0 - c + half_c * c - half_k * (1.0 - half_c);
    Matrix2::new(1.0 - half_k, 1.0 - half_c, of_x, of_v)
}
