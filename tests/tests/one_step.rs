//! One step of every method on numbers without rounding: what comes out is known to the last bit.
//!
//! The expected numbers are the formulas evaluated in rational arithmetic; h = 3/4 makes h / 6 dyadic. One step sees every sign,
//! weight and stage time; that many steps follow each other rightly is the driver's matter (driver.rs).

use faer::fx128;
use integrator::counted::Counted;
use integrator::methods::{ExplicitEuler, ImplicitEuler, ImplicitMidpoint, MethodId, Rk4, Visitor};
use integrator::methods::{SemiImplicitEuler, VelocityVerlet};
use integrator::pose::{Body, Exponential, Fixed, Linear, Update, World};
use integrator::{Method, Model, Pose, Real, Rotation, Single, State, Twist, Vector};
use nalgebra::{Vector1, Vector3};

const T0: f64 = 0.5;
const H: f64 = 0.75;

/// x'' = t - x^2 + x' / 2.
struct Drag;
impl<T: Real> Model<T> for Drag {
    type Config = Vector1<T>;
    fn rate(&self, t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(t - s.q.x * s.q.x + s.v.x * T::lit(0.5))
    }
}

/// (t v_y - x, z/2 - v_x, t - y v_z / 4).
struct InSpace;
impl<T: Real> Model<T> for InSpace {
    type Config = Vector3<T>;
    fn rate(&self, t: T, s: &State<Vector3<T>>) -> Vector3<T> {
        let State { q, v } = *s;
        Vector3::new(t * v.y - q.x, q.z * T::lit(0.5) - v.x, t - q.y * v.z * T::lit(0.25))
    }
}

/// x' = x v, v' = t - x: the velocity depends on the configuration.
struct Curved;
impl<T: Real> Model<T> for Curved {
    type Config = Vector1<T>;
    fn rate(&self, t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(t - s.q.x)
    }
    fn velocity(&self, q: Vector1<T>, v: Vector1<T>) -> Vector1<T> {
        Vector1::new(q.x * v.x)
    }
}

fn line<T: Real>([q, v]: [f64; 2]) -> State<Vector1<T>> {
    State { q: Vector1::new(T::lit(q)), v: Vector1::new(T::lit(v)) }
}

fn space<T: Real>(q: [f64; 3], v: [f64; 3]) -> State<Vector3<T>> {
    State { q: Vector3::from(q).map(T::lit), v: Vector3::from(v).map(T::lit) }
}

fn step<T: Real, M: Model<T>>(method: &impl Method<T, M>, m: &M, s: State<M::Config>) -> State<M::Config> {
    method.step(m, T::lit(T0), T::lit(H), s)
}

// Fails if: semi-implicit Euler moves q by v0; Verlet evaluates its second force at v_half, or at t0.
#[test]
fn explicit_steps_on_a_line_are_exact_to_the_last_bit() {
    fn check<T: Real>() {
        let s = line::<T>([1.5, -1.0]);
        assert_eq!(step(&ExplicitEuler, &Drag, s), line([0.75, -2.6875]));
        assert_eq!(step(&SemiImplicitEuler, &Drag, s), line([-0.515625, -2.6875]));
        assert_eq!(step(&VelocityVerlet, &Drag, s), line([0.1171875, -1.8840560913085938]));
        assert_eq!(step(&Rk4, &Drag, s), line([0.3668045997619629, -1.689591646194458]));
    }
    check::<f64>();
    check::<fx128>();
}

// Fails if: a weight or stage of RK4 changes; explicit Euler moves q by v1.
#[test]
fn explicit_steps_in_space_are_exact_to_the_last_bit() {
    fn check<T: Real>() {
        let s = space::<T>([1.5, -0.5, 1.0], [-1.0, 0.5, 2.0]);
        let v1 = [-1.9375, 1.625, 2.5625];
        assert_eq!(step(&ExplicitEuler, &InSpace, s), space([0.75, -0.125, 2.5], v1));
        assert_eq!(step(&SemiImplicitEuler, &InSpace, s), space([0.046875, 0.71875, 2.921875], v1));
        let verlet = space([0.3984375, 0.296875, 2.7109375], [-0.8564453125, 2.29736328125, 2.678680419921875]);
        assert_eq!(step(&VelocityVerlet, &InSpace, s), verlet);
        let rk4 = space(
            [0.6386260986328125, 0.422943115234375, 2.75678426399827],
            [-0.9150161743164062, 2.049321174621582, 2.7021556250811045],
        );
        assert_eq!(step(&Rk4, &InSpace, s), rk4);
    }
    check::<f64>();
    check::<fx128>();
}

// Fails if: Verlet's drift takes its velocity at q0; a stage of RK4 takes its velocity at q0; explicit Euler leaves `velocity` out.
#[test]
fn a_velocity_that_depends_on_the_configuration_is_taken_where_the_method_says() {
    fn check<T: Real>() {
        let s = line::<T>([1.5, -1.0]);
        assert_eq!(step(&ExplicitEuler, &Curved, s), line([0.375, -1.75]));
        assert_eq!(step(&SemiImplicitEuler, &Curved, s), line([-0.46875, -1.75]));
        assert_eq!(step(&VelocityVerlet, &Curved, s), line([0.750732421875, -1.187774658203125]));
        assert_eq!(step(&Rk4, &Curved, s), line([0.6306136322091334, -1.1097352504730225]));
    }
    check::<f64>();
    check::<fx128>();
}

/// Whether |value| <= n eps |scale|.
fn is_rounding<T: Single>(value: T, eps: f64, scale: f64) -> bool {
    value.to_f64().abs() <= eps * T::EPSILON * scale
}

/// The equations of an implicit step, left side minus right side.
fn backward<T: Single, M: Model<T, Config = Vector1<T>>>(m: &M, h: T) -> [T; 2] {
    let (t, s0) = (T::lit(T0), line::<T>([1.5, -1.0]));
    let s1 = ImplicitEuler.step(m, t, h, s0);
    let q = s1.q - s0.q - m.velocity(s1.q, s1.v) * h;
    [q.x, (s1.v - s0.v - m.rate(t + h, &s1) * h).x]
}

fn midpoint<T: Single, M: Model<T, Config = Vector1<T>>>(m: &M, h: T) -> [T; 2] {
    let half = T::lit(0.5);
    let (t, s0) = (T::lit(T0), line::<T>([1.5, -1.0]));
    let s1 = ImplicitMidpoint.step(m, t, h, s0);
    let middle = State { q: (s0.q + s1.q) * half, v: (s0.v + s1.v) * half };
    let q = s1.q - s0.q - m.velocity(middle.q, middle.v) * h;
    [q.x, (s1.v - s0.v - m.rate(t + h * half, &middle) * h).x]
}

// Fails if: implicit Euler takes its force at t0, or its velocity at q0; midpoint its force at t0, or q1 = q0 + (h/2) w.
#[test]
fn implicit_steps_satisfy_their_equations_to_rounding() {
    fn check<T: Single>() {
        let h = T::lit(0.25);
        // Numbers below 4, some six operations, and the last Newton correction of at most 16 eps.
        for found in [backward(&Drag, h), midpoint(&Drag, h), backward(&Curved, h), midpoint(&Curved, h)] {
            assert!(found.iter().all(|r| is_rounding(*r, 16.0, 4.0)), "{found:?}");
        }
    }
    check::<f32>();
    check::<f64>();
    check::<fx128>();
}

/// x'' = -x.
struct Unit;
impl<T: Real> Model<T> for Unit {
    type Config = Vector1<T>;
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        -s.q
    }
}

// Fails if: implicit Euler returns its guess; midpoint returns the middle.
#[test]
fn implicit_steps_on_the_oscillator_are_those_of_the_closed_form() {
    // (1 + h^2) v1 = v0 - h q0, q1 = q0 + h v1; (1 + h^2/4) vm = v0 - (h/2) q0, v1 = 2 vm - v0, q1 = q0 + h vm.
    fn check<T: Single>() {
        let lit = T::lit;
        let s = line::<T>([1.5, -1.0]);
        let euler = step(&ImplicitEuler, &Unit, s);
        let v1 = -lit(34.0) / lit(25.0);
        assert!(is_rounding(euler.v.x - v1, 4.0, 2.0) && is_rounding(euler.q.x - lit(12.0) / lit(25.0), 4.0, 2.0));
        let middle = step(&ImplicitMidpoint, &Unit, s);
        let vm = -lit(1.5625) / lit(1.140625);
        assert!(is_rounding(middle.v.x - (vm + vm + lit(1.0)), 4.0, 4.0), "{:?}", middle.v.x);
        assert!(is_rounding(middle.q.x - (lit(1.5) + vm * lit(0.75)), 4.0, 2.0));
    }
    check::<f32>();
    check::<f64>();
    check::<fx128>();
}

/// v' = t^k: a step is a quadrature of t^k, and says at which times it looks.
struct Power(i32);
impl<T: Real> Model<T> for Power {
    type Config = Vector1<T>;
    fn rate(&self, t: T, _s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new((0..self.0).fold(T::lit(1.0), |power, _| power * t))
    }
}

// Fails if: any stage time of any method moves.
#[test]
fn every_method_looks_at_the_force_when_its_quadrature_says() {
    for k in 0..=4 {
        let f = |t: f64| t.powi(k);
        let (left, middle, right) = (f(T0), f(T0 + H / 2.0), f(T0 + H));
        let velocity = |method: &dyn Method<f64, Power>| step_of(method, &Power(k)) + 1.0;
        assert_eq!(velocity(&ExplicitEuler), H * left);
        assert_eq!(velocity(&SemiImplicitEuler), H * left);
        assert_eq!(velocity(&VelocityVerlet), H / 2.0 * (left + right));
        assert_eq!(velocity(&Rk4), H / 6.0 * (left + 4.0 * middle + right));
        // The Newton iteration's last correction rounds.
        assert!((velocity(&ImplicitEuler) - H * right).abs() <= 4.0 * f64::EPSILON);
        assert!((velocity(&ImplicitMidpoint) - H * middle).abs() <= 4.0 * f64::EPSILON);
    }
}

fn step_of(method: &dyn Method<f64, Power>, m: &Power) -> f64 {
    method.step(m, T0, H, line([1.5, -1.0])).v.x
}

/// [`InSpace`] or its momentum form p = m v with m = 4: q' = p / 4, p' = 4 rate.
struct Momentum<const MASS: u32>;
impl<T: Real, const MASS: u32> Model<T> for Momentum<MASS> {
    type Config = Vector3<T>;
    fn rate(&self, t: T, s: &State<Vector3<T>>) -> Vector3<T> {
        InSpace.rate(t, &State { q: s.q, v: self.velocity(s.q, s.v) }) * T::lit(f64::from(MASS))
    }
    fn velocity(&self, _q: Vector3<T>, p: Vector3<T>) -> Vector3<T> {
        p / T::lit(f64::from(MASS))
    }
}

struct OneStep<'a, M>(&'a M, State<Vector3<f64>>);
impl<M: Model<f64, Config = Vector3<f64>>> Visitor<f64, M> for OneStep<'_, M> {
    type Output = State<Vector3<f64>>;
    fn visit<A: Method<f64, M>>(self, method: &A) -> State<Vector3<f64>> {
        step(method, self.0, self.1)
    }
}

// Fails if: any method leaves `velocity` out of one of its stages.
#[test]
fn storing_a_momentum_gives_the_same_motion_with_every_method() {
    let s = space::<f64>([1.5, -0.5, 1.0], [-1.0, 0.5, 2.0]);
    let stored = State { q: s.q, v: s.v * 4.0 };
    for &method in MethodId::ALL {
        let plain = method.visit(OneStep(&InSpace, s));
        let momentum = method.visit(OneStep(&Momentum::<4>, stored));
        let apart = (momentum.q - plain.q).amax().max((momentum.v / 4.0 - plain.v).amax());
        // A power of two changes no bit; Newton's Jacobian by differences does, and with it the last correction.
        let bound = if method.is_implicit() { 16.0 * f64::EPSILON * 4.0 } else { 0.0 };
        assert!(apart <= bound, "{}: {apart:e}", method.id());
    }
}

/// A body at a fixed point that keeps its spin.
struct Spin<U>(std::marker::PhantomData<U>);
impl<T: Real, U: Update> Model<T> for Spin<U> {
    type Config = Pose<T, U, Fixed<T>>;
    fn rate(&self, _t: T, _s: &State<Self::Config>) -> Twist<T, Fixed<T>> {
        Twist::zero()
    }
}

struct Turn<T: Single>(Rotation<T>, Vector3<T>, T);
impl<T: Single, U: Update> Visitor<T, Spin<U>> for Turn<T> {
    type Output = Rotation<T>;
    fn visit<A: Method<T, Spin<U>>>(self, method: &A) -> Rotation<T> {
        let start = State { q: Pose::new(Fixed::zero(), self.0), v: Twist { linear: Fixed::zero(), angular: self.1 } };
        method.step(&Spin(std::marker::PhantomData), T::lit(T0), self.2, start).q.attitude
    }
}

fn apart<T: Single>(a: Rotation<T>, b: [f64; 4]) -> f64 {
    a.wxyz().iter().zip(b).map(|(x, y)| (*x - T::lit(y)).to_f64().abs()).fold(0.0, f64::max) / T::EPSILON
}

// Fails if: World composes from the right, or Body from the left; Linear turns by the whole omega h instead of its half; exp does not
// halve its angle.
#[test]
fn a_step_of_a_constant_spin_is_the_rotation_known_by_hand() {
    // q0 = (0, 1, 0, 0), a half turn about x. 120 degrees about (1, 1, 1) is (1, 1, 1, 1) / 2: from the left in the world, from
    // the right in the body. The linear update with omega h = (0, 0, 3/2) is (1, 0, 0, 3/4) / (5/4) = (4, 0, 0, 3) / 5.
    fn check<T: Single>(method: MethodId) {
        let q0 = Rotation::from_wxyz([0.0, 1.0, 0.0, 0.0].map(T::lit));
        let pi = T::lit(0.0).atan2(T::lit(-1.0));
        let h = T::lit(0.75);
        let third = Vector3::repeat(pi * T::lit(2.0) / (T::lit(3.0) * T::lit(3.0).sqrt()) / h);
        let lift = Vector3::new(T::lit(0.0), T::lit(0.0), T::lit(2.0));
        let turned = [
            apart(method.visit::<T, Spin<Exponential<World>>, _>(Turn(q0, third, h)), [-0.5, 0.5, 0.5, -0.5]),
            apart(method.visit::<T, Spin<Exponential<Body>>, _>(Turn(q0, third, h)), [-0.5, 0.5, -0.5, 0.5]),
        ];
        // Two roundings of pi and sqrt 3, those of sine and cosine (4 eps in double-double), and of the product.
        assert!(turned.iter().all(|d| *d <= 8.0), "{}: {turned:?}", method.id());
        // RK4 adds increments of equal spin, and the others take one.
        let linear = method.visit::<T, Spin<Linear<World>>, _>(Turn(q0, lift, h));
        let expected = [T::lit(0.0), T::lit(4.0) / T::lit(5.0), T::lit(3.0) / T::lit(5.0), T::lit(0.0)];
        let off = linear.wxyz().iter().zip(expected).map(|(x, y)| (*x - y).to_f64().abs()).fold(0.0, f64::max);
        assert!(off <= 8.0 * T::EPSILON, "{}: {linear:?}", method.id());
    }
    for &method in MethodId::ALL {
        check::<f32>(method);
        check::<f64>(method);
        check::<fx128>(method);
    }
}

/// Evaluations of one step of x'' = -x.
struct Count;
impl<T: Single> Visitor<T, Counted<Unit>> for Count {
    type Output = u64;
    fn visit<A: Method<T, Counted<Unit>>>(self, method: &A) -> u64 {
        let counted = Counted::new(Unit);
        assert!(step(method, &counted, line([1.5, -1.0])).is_finite());
        counted.evaluations()
    }
}

// Fails if: a method evaluates its force once more or less; Newton's iteration renews its Jacobian every time.
#[test]
fn evaluations_per_step_are_as_stated() {
    fn counts<T: Single>() -> Vec<u64> {
        MethodId::ALL.iter().map(|method| method.visit::<T, _, _>(Count)).collect()
    }
    assert_eq!(&counts::<f64>()[..4], [1, 1, 2, 4]);
    assert_eq!(&counts::<fx128>()[..4], [1, 1, 2, 4]);
    // At h w = 3/4: the guess 1, the residual there and after a step with the identity 2, a Jacobian of 2 (position and
    // velocity) at the guess, and three iterations, the last of which finds nothing left to correct: 8, or one more where
    // rounding leaves an eps to it.
    assert_eq!(&counts::<f32>()[4..], [8, 8]);
    assert_eq!(&counts::<f64>()[4..], [9, 9]);
    assert_eq!(&counts::<fx128>()[4..], [8, 8]);
}
