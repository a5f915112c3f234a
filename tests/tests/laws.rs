//! The laws of the spaces in which configurations live: retraction, frames, brackets, rotations. Drawn at zero, at 1e-8,
//! generic, and within 1e-9 of half a turn.
//!
//! Tolerances count roundings in eps of the arithmetic; a rotation by a large angle is as ill conditioned as the angle is large.
//! Not seen here: what a method makes of a space (one_step.rs, order_of_methods.rs).

use std::f64::consts::PI;

use faer::fx128;
use integrator::pose::{Body, Exponential, Fixed, Linear, Update, World};
use integrator::rotation::{cross, dot};
use integrator::{Pose, Real, Rotation, Single, Space, Twist, Vector};
use nalgebra::{SMatrix, Vector1, Vector3};
use proptest::prelude::*;

/// Everything a law is drawn from, in f64; the arithmetic is the law's.
#[derive(Clone, Copy, Debug)]
struct Draw {
    attitude: [f64; 4],
    position: [f64; 3],
    linear: [f64; 3],
    /// An angular velocity whose size is one of the four classes.
    omega: [f64; 3],
    other: [f64; 3],
    third: [f64; 3],
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-1.0..1.0_f64)
        .prop_filter("not too short to have a direction", |v| Vector3::from(*v).norm() > 0.1)
}

/// Sizes at which formulas change or cancel.
fn size() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1e-8), 0.01..3.0, Just(PI - 1e-9), Just(PI), Just(PI + 1e-9)]
}

fn draw() -> impl Strategy<Value = Draw> {
    let attitude = (vector(), size());
    (attitude, vector(), vector(), (vector(), size()), vector(), vector()).prop_map(
        |((axis, angle), position, linear, (direction, size), other, third)| {
            let omega = (Vector3::from(direction).normalize() * size).into();
            let half = Vector3::from(axis).normalize() * (angle / 2.0).sin();
            Draw { attitude: [(angle / 2.0).cos(), half.x, half.y, half.z], position, linear, omega, other, third }
        },
    )
}

fn lit<T: Real>(v: [f64; 3]) -> Vector3<T> {
    Vector3::from(v).map(T::lit)
}

impl Draw {
    fn attitude<T: Real>(&self) -> Rotation<T> {
        Rotation::from_wxyz(self.attitude.map(T::lit))
    }
    fn pose<T: Real, U>(&self) -> Pose<T, U> {
        Pose::new(lit(self.position), self.attitude())
    }
    fn twist<T: Real>(&self) -> Twist<T> {
        Twist { linear: lit(self.linear), angular: lit(self.omega) }
    }
}

/// Largest component of a - b, in eps.
fn apart<T: Single, V: Vector<T>>(a: V, b: V) -> f64 {
    (0..V::DIM).map(|i| (a.component(i) - b.component(i)).to_f64().abs()).fold(0.0, f64::max) / T::EPSILON
}

/// Largest difference of two quaternions (not of the rotations: the sign counts), in eps.
fn quaternions_apart<T: Single>(a: Rotation<T>, b: Rotation<T>) -> f64 {
    apart(a.v, b.v).max((a.w - b.w).to_f64().abs() / T::EPSILON)
}

fn poses_apart<T: Single, U: Update, P: Vector<T>>(a: Pose<T, U, P>, b: Pose<T, U, P>) -> f64 {
    apart(a.position, b.position).max(quaternions_apart(a.attitude, b.attitude))
}

/// Roundings of a product of quaternions, an exponential with 4 eps of sine and cosine, and an angle of up to pi.
const FEW: f64 = 24.0;

fn zero_velocity_stays<T: Single, U: Update + PartialEq>(d: &Draw) {
    let q: Pose<T, U> = d.pose();
    assert_eq!(q.retract(Twist::zero(), T::lit(0.75)), q);
    assert_eq!(q.retract(d.twist(), T::lit(0.0)), q);
    let fixed: Pose<T, U, Fixed<T>> = Pose::new(Fixed::zero(), q.attitude);
    assert_eq!(fixed.retract(Twist::zero(), T::lit(0.75)), fixed);
    let point: Vector3<T> = lit(d.position);
    assert_eq!(point.retract(Vector3::zero(), T::lit(0.75)), point);
}

fn two_halves_make_a_whole<T: Single, U: Update>(d: &Draw) {
    let (h, half) = (T::lit(0.75), T::lit(0.375));
    let (q, v): (Pose<T, U>, _) = (d.pose(), d.twist());
    let found = poses_apart(q.retract(v, half).retract(v, half), q.retract(v, h));
    assert!(found <= FEW, "pose: {found} eps");
    let (fixed, spin) =
        (Pose::<T, U, Fixed<T>>::new(Fixed::zero(), q.attitude), Twist { linear: Fixed::zero(), angular: v.angular });
    let found = poses_apart(fixed.retract(spin, half).retract(spin, half), fixed.retract(spin, h));
    assert!(found <= FEW, "attitude: {found} eps");
    let (x, v): (Vector3<T>, Vector3<T>) = (lit(d.position), lit(d.linear));
    assert!(apart(x.retract(v, half).retract(v, half), x.retract(v, h)) <= 2.0);
    // And back again.
    assert!(poses_apart(q.retract(d.twist(), h).retract(-d.twist(), h), q) <= FEW);
}

fn frames_agree<T: Single>(d: &Draw) {
    let h = T::lit(0.75);
    let g: Rotation<T> = Rotation::exp(lit(d.other));
    let q: Rotation<T> = d.attitude();
    let turned = g * q;
    let (x, linear): (Vector3<T>, Vector3<T>) = (lit(d.position), lit(d.linear));
    let body: Vector3<T> = lit(d.omega);
    let world = q.rotate(body);
    fn moved<T: Single, U: Update>(
        x: Vector3<T>,
        q: Rotation<T>,
        linear: Vector3<T>,
        angular: Vector3<T>,
        h: T,
    ) -> Pose<T, U> {
        Pose::new(x, q).retract(Twist { linear, angular }, h)
    }
    let in_world: Pose<T, Exponential<World>> = moved(x, q, linear, world, h);
    let in_body: Pose<T, Exponential<Body>> = moved(x, q, linear, body, h);
    assert!(quaternions_apart(in_world.attitude, in_body.attitude) <= FEW, "the same spin in two frames");
    let in_world_linear: Pose<T, Linear<World>> = moved(x, q, linear, world, h);
    let in_body_linear: Pose<T, Linear<Body>> = moved(x, q, linear, body, h);
    assert!(quaternions_apart(in_world_linear.attitude, in_body_linear.attitude) <= FEW, "linear, in two frames");
    // The whole scene turned by g: world vectors turn, body vectors do not.
    let turned_world: Pose<T, Exponential<World>> = moved(g.rotate(x), turned, g.rotate(linear), g.rotate(world), h);
    let turned_body: Pose<T, Exponential<Body>> = moved(g.rotate(x), turned, g.rotate(linear), body, h);
    for after in [turned_world.attitude, turned_body.attitude] {
        assert!(quaternions_apart(after, g * in_world.attitude) <= FEW, "turned scene");
    }
    assert!(apart(turned_world.position, g.rotate(in_world.position)) <= FEW);
    assert_eq!(turned_world.position, turned_body.position);
}

fn rotations_are_a_group_of_isometries<T: Single>(d: &Draw) {
    let (a, b): (Rotation<T>, Rotation<T>) = (d.attitude(), Rotation::exp(lit(d.omega)));
    let c: Rotation<T> = Rotation::exp(lit(d.other));
    let (x, y): (Vector3<T>, Vector3<T>) = (lit(d.position), lit(d.linear));
    assert!(quaternions_apart((a * b) * c, a * (b * c)) <= 8.0, "associative");
    assert_eq!(a * Rotation::identity(), a);
    assert!(quaternions_apart(a * a.conjugate(), Rotation::identity()) <= 8.0, "inverse");
    assert!(apart((a * b).rotate(x), a.rotate(b.rotate(x))) <= FEW, "a product rotates by one, then the other");
    assert!(apart(a.rotate_back(a.rotate(x)), x) <= FEW, "there and back");
    assert!((dot(a.rotate(x), a.rotate(y)) - dot(x, y)).to_f64().abs() <= FEW * T::EPSILON, "angles and lengths");
    assert!(apart(a.rotate(cross(x, y)), cross(a.rotate(x), a.rotate(y))) <= FEW, "right-handed");
    let m = a.matrix();
    let [e1, e2, e3] = [0, 1, 2].map(|i| m.column(i).into_owned());
    assert!(apart(e1 * x.x + e2 * x.y + e3 * x.z, a.rotate(x)) <= FEW, "the matrix is the rotation");
    for (i, e) in [e1, e2, e3].into_iter().enumerate() {
        let products = Vector3::new(dot(e, e1), dot(e, e2), dot(e, e3));
        assert!(apart(products, Vector3::from_fn(|j, _| T::lit(if i == j { 1.0 } else { 0.0 }))) <= FEW, "orthogonal");
    }
    assert!((dot(cross(e1, e2), e3) - T::lit(1.0)).to_f64().abs() <= FEW * T::EPSILON, "det = 1");
    // exp(phi) turns by |phi| about phi, by Rodrigues' formula.
    let phi: Vector3<T> = lit(d.omega);
    let angle = dot(phi, phi).sqrt();
    let (cosine, sinc) = T::cos_sinc(dot(phi, phi));
    // (1 - cos a) / a^2 = sinc(a / 2)^2 / 2
    let (_, half_sinc) = T::cos_sinc(dot(phi, phi) * T::lit(0.25));
    let rodrigues = x * cosine + cross(phi, x) * sinc + phi * (dot(phi, x) * half_sinc * half_sinc * T::lit(0.5));
    assert!(apart(b.rotate(x), rodrigues) <= 2.0 * FEW, "exp by angle {angle:?}");
}

fn brackets_are_a_lie_algebra<T: Single, U: Update>(d: &Draw, sign: f64) {
    let twist = |v: [f64; 3]| Twist { linear: lit::<T>(d.linear), angular: lit(v) };
    let [a, b, c] = [d.position, d.other, d.third].map(twist);
    let bracket = |a, b| <Pose<T, U> as Space>::plus_bracket(Twist::zero(), T::lit(1.0), a, b);
    assert_eq!(bracket(a, b), -bracket(b, a));
    assert_eq!(bracket(a, a).angular, Vector3::zero());
    let jacobi = bracket(a, bracket(b, c)) + bracket(b, bracket(c, a)) + bracket(c, bracket(a, b));
    assert!(apart(jacobi.angular, Vector3::zero()) <= FEW, "{jacobi:?}");
    // Translations commute, and k and the factor enter linearly.
    assert_eq!(bracket(a, b).linear, Vector3::zero());
    assert_eq!(bracket(a, b).angular, cross(a.angular, b.angular) * T::lit(sign));
    let shifted = <Pose<T, U> as Space>::plus_bracket(c, T::lit(-0.25), a, b);
    assert!(apart(shifted, c + bracket(a, b) * T::lit(-0.25)) <= 2.0);
    assert_eq!(<Vector3<T> as Space>::plus_bracket(c.angular, T::lit(1.0), a.angular, b.angular), c.angular);
}

fn settling_touches_the_norm_only<T: Single, U: Update>(d: &Draw, stretch: f64) {
    let unit: Pose<T, U> = d.pose();
    let long = Rotation { w: unit.attitude.w * T::lit(stretch), v: unit.attitude.v * T::lit(stretch) };
    let settled = Pose::<T, U>::new(unit.position, long).settled();
    assert_eq!(settled.position, unit.position);
    assert!(quaternions_apart(settled.attitude, unit.attitude) <= 6.0, "the direction stays");
    assert!(((settled.attitude.norm_squared() - T::lit(1.0)).to_f64() / T::EPSILON).abs() <= 6.0, "the norm is 1");
    assert!(quaternions_apart(settled.settled().attitude, settled.attitude) <= 3.0, "once is enough");
}

/// The angle between q and exp(phi) q is |phi|, or what is missing to a whole turn, for both signs of either.
fn distances_are_angles<T: Single>(d: &Draw, angle: f64) {
    let axis: Vector3<T> = lit(d.other);
    let phi = axis * (T::lit(angle) / dot(axis, axis).sqrt());
    let q: Rotation<T> = d.attitude();
    let r = Rotation::exp(phi) * q;
    let minus = |q: Rotation<T>| Rotation { w: -q.w, v: -q.v };
    for (a, b) in [(q, r), (r, q), (minus(q), r), (q, minus(r))] {
        let error = (a.angle_to(b) - T::lit(angle)).to_f64().abs() / T::EPSILON;
        // Rounded components, whatever the angle: an error of eps of 1, not of the root of it.
        assert!(error <= FEW, "{angle}: {error} eps");
    }
    assert!(q.angle_to(q) == T::lit(0.0) && q.angle_to(minus(q)) == T::lit(0.0));
}

fn in_every_arithmetic_and_update(d: &Draw) {
    macro_rules! laws {
        ($($t:ty),*) => {$(
            zero_velocity_stays::<$t, Exponential<World>>(d);
            zero_velocity_stays::<$t, Exponential<Body>>(d);
            zero_velocity_stays::<$t, Linear<World>>(d);
            zero_velocity_stays::<$t, Linear<Body>>(d);
            two_halves_make_a_whole::<$t, Exponential<World>>(d);
            two_halves_make_a_whole::<$t, Exponential<Body>>(d);
            frames_agree::<$t>(d);
            rotations_are_a_group_of_isometries::<$t>(d);
            brackets_are_a_lie_algebra::<$t, Exponential<World>>(d, 1.0);
            brackets_are_a_lie_algebra::<$t, Linear<World>>(d, 1.0);
            brackets_are_a_lie_algebra::<$t, Exponential<Body>>(d, -1.0);
            settling_touches_the_norm_only::<$t, Exponential<World>>(d, 1.5);
            settling_touches_the_norm_only::<$t, Linear<Body>>(d, 1.0 - 1e-6);
            for angle in [0.0, 1e-12, 1e-8, 0.7, 2.0, PI - 1e-9] {
                distances_are_angles::<$t>(d, angle);
            }
        )*};
    }
    laws!(f64, fx128);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    // Fails if: Body composes from the left; a sign of the product, of a bracket or of the matrix changes; exp does not halve its
    // angle; settled moves the position; angle_to forgets one of the two signs, or is an arc cosine.
    #[test]
    fn spaces_keep_their_laws(d in draw()) {
        in_every_arithmetic_and_update(&d);
    }
}

/// exp(b) after exp(a) is the retraction by a + b - [a, b] / 2 to second order, in both frames: the bracket of a space belongs to its
/// retraction. With the other sign the error is of second order.
fn bracket_error<U: Update>(h: f64, c: f64) -> f64 {
    let a = Twist { linear: Vector3::zero(), angular: lit::<fx128>([0.5, -0.75, 0.25]) };
    let b = Twist { linear: Vector3::zero(), angular: lit([-0.25, 0.5, 1.0]) };
    let q: Pose<fx128, U> = Pose::new(Vector3::zero(), Rotation::from_wxyz([0.5, -0.75, 1.0, 0.25].map(Real::lit)));
    let h = fx128::from_f64(h);
    let both = <Pose<fx128, U> as Space>::plus_bracket(a + b, h * fx128::from_f64(c), a, b);
    let (one, other) = (q.retract(a, h).retract(b, h), q.retract(both, h));
    one.attitude.angle_to(other.attitude).0
}

// Fails if: the bracket of World or of Body changes its sign.
#[test]
fn brackets_belong_to_their_retractions() {
    fn ratio<U: Update>(c: f64) -> f64 {
        (bracket_error::<U>(1.0 / 512.0, c) / bracket_error::<U>(1.0 / 1024.0, c)).log2()
    }
    // Local orders at h = 1/512 are off by about h.
    for (right, wrong) in [
        (ratio::<Exponential<World>>(-0.5), ratio::<Exponential<World>>(0.5)),
        (ratio::<Exponential<Body>>(-0.5), ratio::<Exponential<Body>>(0.5)),
    ] {
        assert!((right - 3.0).abs() < 0.01 && (wrong - 2.0).abs() < 0.01, "{right} {wrong}");
    }
}

// Fails if: `Linear` is the exponential map, or turns by anything but 2 atan(|omega| h / 2).
#[test]
fn linear_updates_lack_the_half_step_law_by_a_known_angle() {
    fn check<U: Update>() {
        let spin = Twist { linear: Vector3::zero(), angular: lit::<fx128>([1.5, -0.75, 1.0]) };
        let size = dot(spin.angular, spin.angular).sqrt().0;
        let q: Pose<fx128, U> = Pose::new(Vector3::zero(), Rotation::from_wxyz([0.5, -0.75, 1.0, 0.25].map(Real::lit)));
        for h in [0.25, 0.0625, 0.015625] {
            let (whole, half) = (fx128::from_f64(h), fx128::from_f64(h / 2.0));
            let found = q.retract(spin, half).retract(spin, half).attitude.angle_to(q.retract(spin, whole).attitude).0;
            // 2 (2 atan(z / 4)) - 2 atan(z / 2) = z^3 / 16 - ..., z = |omega| h; the subtraction costs eps z.
            let z = size * h;
            let expected = 4.0 * (z / 4.0).atan() - 2.0 * (z / 2.0).atan();
            assert!((found - expected).abs() <= 4.0 * f64::EPSILON * z, "{found:e} {expected:e}");
            assert!((found / z.powi(3) * 16.0 - 1.0).abs() < 0.25 * z * z, "third order: {found:e}");
        }
    }
    check::<Linear<World>>();
    check::<Linear<Body>>();
}

// Fails if: a twist's components come in another order, or DIM is not the sum of its parts.
#[test]
fn vectors_are_their_components() {
    fn check<T: Single, V: Vector<T> + PartialEq>(dim: usize) {
        assert_eq!(V::DIM, dim);
        let v = V::from_fn(|i| T::lit(1.5 + i as f64));
        assert!((0..dim).all(|i| v.component(i) == T::lit(1.5 + i as f64)));
        let r = V::from_fn(|i| T::lit(0.25 * i as f64 - 1.0));
        let h = T::lit(-0.5);
        let by_components = |f: &dyn Fn(T, T) -> T| V::from_fn(|i| f(v.component(i), r.component(i)));
        assert!(v + r == by_components(&|a, b| a + b) && v - r == by_components(&|a, b| a - b));
        assert!(-v == by_components(&|a, _| -a) && v * h == by_components(&|a, _| a * h));
        assert!(v.add_scaled(r, h) == by_components(&|a, b| a + b * h) && V::zero() == v - v);
        assert!(v.is_finite());
        for bad in 0..dim {
            assert!(!V::from_fn(|i| T::lit(if i == bad { f64::NAN } else { 1.0 })).is_finite(), "{bad}");
        }
    }
    macro_rules! check_in { ($($t:ty),*) => {$(
        check::<$t, Vector1<$t>>(1);
        check::<$t, SMatrix<$t, 3, 4>>(12);
        check::<$t, Twist<$t>>(6);
        check::<$t, Twist<$t, Fixed<$t>>>(3);
    )*}; }
    check_in!(f32, f64, fx128);
    let twist = Twist::<f64>::from_fn(|i| i as f64);
    assert_eq!((twist.linear, twist.angular), (Vector3::new(0.0, 1.0, 2.0), Vector3::new(3.0, 4.0, 5.0)));
}
