//! Time reversal: n steps, the velocity turned, n steps, turned again. Symmetric methods come back to rounding; the
//! others do not, by an amount that the oscillator knows exactly.
//!
//! Not seen here: orders, and rotations (their retraction is symmetric by laws.rs).

use faer::fx128;
use integrator::methods::{MethodId, Visitor};
use integrator::{Method, Model, Single, State, drive};
use nalgebra::Vector1;

/// x'' = -w^2 x with w = 2, or the pendulum x'' = -w^2 sin x.
struct Spring {
    pendulum: bool,
}

impl<T: Single> Model<T> for Spring {
    type Config = Vector1<T>;
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        let x = s.q.x;
        Vector1::new((if self.pendulum { x.sin_cos().0 } else { x }) * T::lit(-4.0))
    }
}

/// (w x, v) after the way there and back, each of n steps of h, relative to |(w x, v)| at the start; and the start.
struct ThereAndBack<'a> {
    model: &'a Spring,
    h: f64,
    steps: u64,
}

impl<T: Single> Visitor<T, Spring> for ThereAndBack<'_> {
    type Output = [[f64; 2]; 2];
    fn visit<A: Method<T, Spring>>(self, method: &A) -> [[f64; 2]; 2] {
        let start = State { q: Vector1::new(T::lit(0.75)), v: Vector1::new(T::lit(-1.25)) };
        let run = |s| drive::advance(method, self.model, s, T::lit(self.h), self.steps).expect("finite");
        let turned = |s: State<Vector1<T>>| State { q: s.q, v: -s.v };
        let back = turned(run(turned(run(start))));
        let pair = |s: State<Vector1<T>>| [s.q.x.to_f64() * 2.0, s.v.x.to_f64()];
        let size = pair(start)[0].hypot(pair(start)[1]);
        let difference = [(back.q.x - start.q.x).to_f64() * 2.0, (back.v.x - start.v.x).to_f64()];
        [difference.map(|d| d / size), pair(start).map(|x| x / size)]
    }
}

const H: f64 = 0.015625;
const STEPS: u64 = 512;

fn distance<T: Single>(method: MethodId, pendulum: bool, h: f64, steps: u64) -> f64 {
    let [[x, v], _] = method.visit::<T, _, _>(ThereAndBack { model: &Spring { pendulum }, h, steps });
    x.hypot(v)
}

/// 2 n steps of about four roundings each, half an eps apiece and at most. On the pendulum an error of the velocity shifts the
/// phase in proportion to the time that is left, 2 T w = 32 at most.
fn rounding<T: Single>(pendulum: bool) -> f64 {
    let growth = if pendulum { 32.0 } else { 1.0 };
    growth * 4.0 * STEPS as f64 * T::EPSILON
}

const REVERSIBLE: [MethodId; 2] = [MethodId::VelocityVerlet, MethodId::ImplicitMidpoint];

// Fails if: Verlet's second force is taken at the position before the step, or midpoint's at t0 + h, q0 + h w.
#[test]
fn verlet_and_implicit_midpoint_come_back_to_rounding() {
    for method in REVERSIBLE {
        for pendulum in [false, true] {
            let found = [distance::<f64>(method, pendulum, H, STEPS), distance::<fx128>(method, pendulum, H, STEPS)];
            println!("{} {pendulum}: {found:?}", method.id());
            assert!(found[0] <= rounding::<f64>(pendulum), "{}: {found:?}", method.id());
            assert!(found[1] <= rounding::<fx128>(pendulum), "{}: {found:?}", method.id());
        }
    }
}

/// On the oscillator the way there multiplies w x + i v by R(-iz)^n and the way back by its conjugate: |R|^(2n) - 1 is left.
fn left_over(method: MethodId) -> Option<f64> {
    let z = 2.0 * H;
    let squared = match method {
        MethodId::ExplicitEuler => z * z,
        MethodId::ImplicitEuler => -z * z / (1.0 + z * z),
        MethodId::Rk4 => -z.powi(6) / 72.0 + z.powi(8) / 576.0,
        _ => return None,
    };
    Some((STEPS as f64 * squared.ln_1p()).exp_m1())
}

// Fails if: any of the three is made to take another method's step (RK4 with a weight changed: 1/6, 1/3, 1/3, 1/6 -> 1/4 each).
#[test]
fn irreversible_methods_miss_the_start_by_what_theory_says() {
    for &method in MethodId::ALL {
        let Some(expected) = left_over(method) else { continue };
        let [difference, start] =
            method.visit::<fx128, _, _>(ThereAndBack { model: &Spring { pendulum: false }, h: H, steps: STEPS });
        for (d, s) in difference.iter().zip(start) {
            // The expected number is f64: a few eps, times n in the power.
            let tolerance = 8.0 * STEPS as f64 * f64::EPSILON * (expected.abs() + f64::EPSILON);
            assert!((d - expected * s).abs() <= tolerance, "{}: {d:e}, expected {:e}", method.id(), expected * s);
        }
        assert!(expected.abs() > 1e6 * rounding::<fx128>(false), "the test can tell them from the reversible ones");
    }
}

// Fails if: stage 3 of RK4 takes its velocity from a1 instead of a2.
#[test]
fn on_the_pendulum_irreversible_methods_come_back_with_an_error_of_their_order() {
    // RK4 misses by h^5: its h^4 error is that of a reversible flow, |R|^2 - 1 = -z^6 / 72 a step.
    for (method, order) in [(MethodId::ExplicitEuler, 1.0), (MethodId::ImplicitEuler, 1.0), (MethodId::Rk4, 5.0)] {
        let at = |k: u32| distance::<fx128>(method, true, H / 16.0 / f64::from(1 << k), (STEPS * 4) << k);
        let observed = (at(0) / at(1)).log2();
        println!("{}: {observed:.4}", method.id());
        // First-order corrections in h T w: 8 % of an order at most at h = 1/1024, T = 2.
        assert!((observed - order).abs() < 0.08, "{}: order {observed}", method.id());
    }
}
