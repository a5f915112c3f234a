//! The order of every method, observed in double-double over a window that the sweep itself shows: on R^3 with a force that
//! depends on time, position and velocity, and on SO(3) with each quantity that a body can store.
//!
//! One list of methods (`MethodId::ALL`): registering a method subjects it to every law here. Negative controls are methods
//! that are nearly right. An order does not see an error constant: those are the convergence study's claims.

use faer::fx128;
use integrator::methods::{MethodId, Rk4, Visitor};
use integrator::pose::{Body, Exponential, Fixed, Linear, Update, World};
use integrator::rigid_body::{
    BodyOmega, Kinematics, RigidBody, Torque, WithoutGyroscopicTerm, WorldMomentum, WorldOmega,
};
use integrator::{Method, Model, Pose, Real, Rotation, Space, State, Twist, Vector, drive};
use measure::order::{Expected, Limits, Order, Sample, Verdict, observe};
use nalgebra::Vector3;
use scenes::special::free_top::FreeTop;

type T = fx128;
type V3 = Vector3<fx128>;

fn lit(v: [f64; 3]) -> V3 {
    Vector3::from(v).map(Real::lit)
}

/// x* = (sin t, cos 2t / 2, e^(-t)), the motion of x'' = a*(t) + F(x, x') - F(x*(t), x*'(t)) with
/// F = -x |x|^2 / 4 + B x v - v |v|^2 / 8: it depends on everything, and is linear in nothing.
struct Manufactured;

impl Manufactured {
    fn motion(t: T) -> [V3; 3] {
        let ((s, c), (s2, c2), e) = (t.sin_cos(), (t + t).sin_cos(), (-t).exp());
        let (half, two) = (T::lit(0.5), T::lit(2.0));
        [Vector3::new(s, c2 * half, e), Vector3::new(c, -s2, -e), Vector3::new(-s, -c2 * two, e)]
    }
    fn force(x: V3, v: V3) -> V3 {
        let dot = integrator::rotation::dot;
        let turn = integrator::rotation::cross(lit([0.5, -0.25, 0.75]), v);
        turn - x * (dot(x, x) * T::lit(0.25)) - v * (dot(v, v) * T::lit(0.125))
    }
}

impl Model<T> for Manufactured {
    type Config = V3;
    fn rate(&self, t: T, s: &State<V3>) -> V3 {
        let [x, v, a] = Self::motion(t);
        a + Self::force(s.q, s.v) - Self::force(x, v)
    }
}

/// An asymmetric body, free; its inertia neither sorted nor with two equal moments.
struct Top;
const INERTIA: [f64; 3] = [1.25, 0.75, 1.75];
const ATTITUDE: [f64; 4] = [0.5, -0.75, 1.0, 0.25];
const OMEGA: [f64; 3] = [1.5, -0.75, 1.0];

impl RigidBody<T> for Top {
    type Position = Fixed<T>;
    fn inertia(&self) -> V3 {
        lit(INERTIA)
    }
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::None
    }
}

/// A model with its exact motion and the distance of two of its states.
trait Solved: Model<T> {
    const END: f64;
    fn exact(&self, t: T) -> State<Self::Config>;
    fn distance(&self, a: &State<Self::Config>, b: &State<Self::Config>) -> [f64; 2];
}

fn norm<V: Vector<T>>(v: V) -> f64 {
    (0..V::DIM).map(|i| v.component(i).0.powi(2)).sum::<f64>().sqrt()
}

impl Solved for Manufactured {
    const END: f64 = 1.375;
    fn exact(&self, t: T) -> State<V3> {
        let [q, v, _] = Self::motion(t);
        State { q, v }
    }
    fn distance(&self, a: &State<V3>, b: &State<V3>) -> [f64; 2] {
        [norm(a.q - b.q), norm(a.v - b.v)]
    }
}

/// What a model of a body stores, from the body's angular velocity.
macro_rules! solved_body {
    ($($model:ident, $frame:ident, |$q:ident, $omega:ident| $stored:expr;)*) => {$(
        impl<U: Update<Frame = $frame>> Solved for $model<Top, U> {
            const END: f64 = 2.25;
            fn exact(&self, t: T) -> State<Self::Config> {
                let ($q, $omega) = FreeTop::new(INERTIA, ATTITUDE, OMEGA).at(t);
                State { q: Pose::new(Fixed::zero(), $q), v: Twist { linear: Fixed::zero(), angular: $stored } }
            }
            fn distance(&self, a: &State<Self::Config>, b: &State<Self::Config>) -> [f64; 2] {
                let velocity = |s: &State<Self::Config>| self.velocity(s.q, s.v);
                [a.q.attitude.angle_to(b.q.attitude).0, norm(velocity(a) - velocity(b))]
            }
        }
    )*};
}
solved_body! {
    WorldOmega, World, |q, omega| q.rotate(omega);
    BodyOmega, Body, |q, omega| { let _: Rotation<T> = q; omega };
    WorldMomentum, World, |q, omega| q.rotate(omega.component_mul(&lit(INERTIA)));
    WithoutGyroscopicTerm, World, |q, omega| q.rotate(omega);
}

/// Errors of configuration and velocity after 2^k steps, k = 3..=12, of one method.
fn errors<M: Solved, A: Method<T, M>>(method: &A, model: &M) -> Vec<(f64, [f64; 2])> {
    let truth = model.exact(T::lit(M::END));
    let run = |k: u32| {
        let h = M::END / f64::from(1 << k);
        let end = drive::advance(method, model, model.exact(T::lit(0.0)), T::lit(h), 1 << k).expect("finite");
        (h, model.distance(&end, &truth))
    };
    (3..=12).map(run).collect()
}

/// What the sweep of each quantity shows, against an order to 0.02 either way.
fn observed(errors: &[(f64, [f64; 2])], order: f64) -> [Order; 2] {
    [0, 1].map(|i| {
        let samples: Vec<Sample> =
            errors.iter().map(|(h_s, e)| Sample { h_s: *h_s, error: Some(e[i]), floor: 0.0 }).collect();
        // Sizes are about 2; a million times the rounding unit is far below what is fitted.
        let limits = Limits { rounding_unit: 2.0 * f64::EPSILON * f64::EPSILON, saturation: 4.0 };
        observe(&samples, Expected::Order { order, tolerance: 0.02 }, limits)
    })
}

fn has_order<M: Solved, A: Method<T, M>>(what: &str, method: &A, model: &M, order: f64) {
    for (seen, quantity) in observed(&errors(method, model), order).iter().zip(["configuration", "velocity"]) {
        println!("{what} {quantity}: {}", seen.note);
        assert_eq!(seen.verdict, Verdict::AsExpected, "{what} {quantity}: {}", seen.note);
    }
}

struct HasOrder<'a, M>(&'a str, &'a M, f64);
impl<M: Solved> Visitor<T, M> for HasOrder<'_, M> {
    type Output = ();
    fn visit<A: Method<T, M>>(self, method: &A) {
        has_order(self.0, method, self.1, self.2);
    }
}

/// Every method with its order.
fn every_method_has_its_order<M: Solved>(where_: &str, model: &M) {
    for &method in MethodId::ALL {
        method.visit(HasOrder(&format!("{} {where_}", method.id()), model, f64::from(method.order())));
    }
}

// Fails if: a sign, weight or stage time of a method changes; the list's order of a method does.
#[test]
fn every_method_keeps_its_order_in_space() {
    every_method_has_its_order("R^3", &Manufactured);
}

// Fails if: the gyroscopic term of WorldOmega changes its sign; a bracket of RK4 its sign or its factor.
#[test]
fn every_method_keeps_its_order_on_so3_with_world_omega() {
    every_method_has_its_order("world omega", &WorldOmega::<_, Exponential<World>>::new(Top));
}

// Fails if: the body frame's bracket has the world's sign; the gyroscopic term of BodyOmega changes its sign.
#[test]
fn every_method_keeps_its_order_on_so3_with_body_omega() {
    every_method_has_its_order("body omega", &BodyOmega::<_, Exponential<Body>>::new(Top));
}

// Fails if: Verlet's drift or a stage of RK4 takes its velocity at q0.
#[test]
fn every_method_keeps_its_order_on_so3_with_world_momentum() {
    every_method_has_its_order("world momentum", &WorldMomentum::<_, Exponential<World>>::new(Top));
}

/// RK4 whose brackets can be left out one by one; with both it is the library's.
struct Brackets {
    in_stage_three: bool,
    at_the_end: bool,
}

impl<M: Model<T>> Method<T, M> for Brackets {
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let (half, two, sixth) = (h * T::lit(0.5), T::lit(2.0), h / T::lit(6.0));
        let slope = |t: T, s: &State<M::Config>| (m.velocity(s.q, s.v), m.rate(t, s));
        let factor = |wanted: bool, c: T| if wanted { c } else { T::lit(0.0) };
        let (w1, a1) = slope(t, &s);
        let (w2, a2) = slope(t + half, &State { q: s.q.retract(w1, half), v: s.v.add_scaled(a1, half) });
        let w2_corrected = M::Config::plus_bracket(w2, factor(self.in_stage_three, -h / T::lit(4.0)), w1, w2);
        let (w3, a3) = slope(t + half, &State { q: s.q.retract(w2_corrected, half), v: s.v.add_scaled(a2, half) });
        let (w4, a4) = slope(t + h, &State { q: s.q.retract(w3, h), v: s.v.add_scaled(a3, h) });
        let w = M::Config::plus_bracket(w1 + w4 + (w2 + w3) * two, factor(self.at_the_end, -half), w1, w4);
        State { q: s.q.retract(w, sixth), v: s.v.add_scaled(a1 + a4 + (a2 + a3) * two, sixth) }
    }
}

// Fails if: `plus_bracket` does nothing on a pose (the whole RK4 falls to order 2 too).
#[test]
fn rk4_without_its_brackets_loses_its_order_on_so3_and_not_in_space() {
    let (both, none) = ([true, true], [false, false]);
    let rk4 = |[in_stage_three, at_the_end]: [bool; 2]| Brackets { in_stage_three, at_the_end };
    let body = BodyOmega::<_, Exponential<Body>>::new(Top);
    let world = WorldMomentum::<_, Exponential<World>>::new(Top);
    // h [w1, w4] = O(h^2) at the end of a step is missed by a global O(h^2); h [w1, w2] = O(h^2) in a stage weighs h more.
    for (brackets, order) in [(both, 4.0), ([true, false], 2.0), ([false, true], 3.0), (none, 2.0)] {
        has_order(&format!("brackets {brackets:?}, world momentum"), &rk4(brackets), &world, order);
        // In the body frame omega does not depend on the attitude: it keeps order 4, and stage 3 needs no bracket.
        let of_attitude = if brackets[1] { 4.0 } else { 2.0 };
        for (i, p) in [of_attitude, 4.0].into_iter().enumerate() {
            let seen = &observed(&errors(&rk4(brackets), &body), p)[i];
            assert_eq!(seen.verdict, Verdict::AsExpected, "brackets {brackets:?}, body omega: {}", seen.note);
        }
    }
    has_order("no brackets, R^3", &rk4(none), &Manufactured, 4.0);
}

// Fails if: `Linear` turns by omega h exactly (the order would stay 4).
#[test]
fn the_linear_attitude_update_caps_rk4_at_order_two() {
    has_order("rk4, linear update", &Rk4, &WorldOmega::<_, Linear<World>>::new(Top), 2.0);
}

/// Velocity Verlet as it is often written, with the second force at the velocity of the half step.
struct VerletAtHalf;

impl<M: Model<T>> Method<T, M> for VerletAtHalf {
    fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        let half = h * T::lit(0.5);
        let u = s.v.add_scaled(m.rate(t, &s), half);
        let q = s.q.retract(m.velocity(s.q, u), h);
        State { q, v: u.add_scaled(m.rate(t + h, &State { q, v: u }), half) }
    }
}

// Fails if: the force has no velocity in it (Verlet at the half step would keep order 2).
#[test]
fn verlet_with_its_second_force_at_the_half_step_falls_to_order_one() {
    has_order("verlet at half, R^3", &VerletAtHalf, &Manufactured, 1.0);
    has_order("verlet at half, body omega", &VerletAtHalf, &BodyOmega::<_, Exponential<Body>>::new(Top), 1.0);
}

// Fails if: WithoutGyroscopicTerm gets its gyroscopic term.
#[test]
fn without_the_gyroscopic_term_no_method_converges() {
    let model = WithoutGyroscopicTerm::<_, Exponential<World>>::new(Top);
    for (method, _) in [(MethodId::SemiImplicitEuler, 1), (MethodId::Rk4, 4), (MethodId::ImplicitMidpoint, 2)] {
        method.visit(HasOrder(&format!("{} without gyroscopic term", method.id()), &model, 0.0));
    }
}
