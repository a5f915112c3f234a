//! The implicit methods' equations are solved to rounding, in every arithmetic and far beyond explicit stability limits, and a
//! problem without a solution ends as a run that failed.
//!
//! Not seen here: how many iterations it takes (one_step.rs pins them on a linear problem).

use faer::fx128;
use integrator::methods::{ImplicitEuler, ImplicitMidpoint, MethodId, Rk4};
use integrator::pose::{Body, Exponential, Fixed};
use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, Torque};
use integrator::rotation::dot;
use integrator::{Method, Model, Pose, Real, Rotation, Single, State, Twist, Vector, drive};
use nalgebra::{Vector1, Vector3};
use scenes::any::AnyScene;
use scenes::observation::Quantity;
use scenes::run::{Outcome, Precision, Run};

/// x'' = -x.
struct Unit;
impl<T: Real> Model<T> for Unit {
    type Config = Vector1<T>;
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        -s.q
    }
}

/// The complex number x + i v, of which the oscillator is c' = -i c.
fn amplitude<T: Single>(s: &State<Vector1<T>>) -> [fx128; 2] {
    [s.q.x.widen(), s.v.x.widen()]
}

/// c (1 - i a) / (1 + i b).
fn amplified([x, v]: [fx128; 2], a: fx128, b: fx128) -> [fx128; 2] {
    let (x1, v1) = (x + a * v, v - a * x);
    let size = fx128::ONE + b * b;
    [(x1 + b * v1) / size, (v1 - b * x1) / size]
}

/// The worst error of a step against c1 = c0 (1 - i a h) / (1 + i b h), in eps |c0|, along 100 steps.
fn worst<T: Single, A: Method<T, Unit>>(method: &A, h: f64, a: f64, b: f64) -> f64 {
    let start = State { q: Vector1::new(T::lit(0.75)), v: Vector1::new(T::lit(-1.25)) };
    let mut before = amplitude(&start);
    let mut worst = 0.0_f64;
    let wide = |x: f64| fx128::from_f64(x) * fx128::from_f64(h);
    let end = drive::integrate(method, &Unit, start, T::lit(h), 100, |i, s| {
        let now = amplitude(s);
        if i > 0 && before[0].0.hypot(before[1].0) > 1e-20 {
            let expected = amplified(before, wide(a), wide(b));
            let error = (now[0] - expected[0]).0.hypot((now[1] - expected[1]).0);
            worst = worst.max(error / (T::EPSILON * before[0].0.hypot(before[1].0)));
        }
        before = now;
    });
    assert!(end.is_ok());
    worst
}

// Fails if: solve takes 1e6 eps for rounding; sizes below 1e-30 do not count as zero in f32 (the amplitude dies away); a velocity that passes
// through zero may not stop the iteration above its own rounding (f32, h = 3/4).
#[test]
fn linear_problems_are_solved_to_rounding_for_small_and_huge_steps() {
    fn check<T: Single>() {
        for h in [0.015625, 0.75, 16.0, 1000.0] {
            let (euler, midpoint) =
                (worst::<T, _>(&ImplicitEuler, h, 0.0, 1.0), worst::<T, _>(&ImplicitMidpoint, h, 0.5, 0.5));
            println!("h = {h}: {euler:.2} {midpoint:.2} eps");
            // The position is q0 + h w, and h w is of the size of q0 (Euler) or twice that: three roundings of such numbers, and
            // h times an iterate's last correction of an eps or two of w, 4 |c0| / h at most.
            assert!(euler <= 8.0 && midpoint <= 8.0, "h = {h}: {euler} {midpoint}");
        }
    }
    check::<f32>();
    check::<f64>();
    check::<fx128>();
}

/// v' = 1 + v^2: no real v1 = v0 + h (1 + v1^2) where 4 h (h + v0) > 1.
struct Runaway;
impl<T: Real> Model<T> for Runaway {
    type Config = Vector1<T>;
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(T::lit(1.0) + s.v.x * s.v.x)
    }
}

// Fails if: solve returns its last iterate where it has not converged.
#[test]
fn a_step_without_a_solution_ends_the_run_and_nothing_else() {
    fn check<T: Single>() {
        let start = State { q: Vector1::new(T::lit(0.5)), v: Vector1::new(T::lit(0.25)) };
        let failed = Err(drive::Diverged { step: 1 });
        let big = T::lit(4.0);
        assert_eq!(drive::advance(&ImplicitEuler, &Runaway, start, big, 3), failed);
        assert_eq!(drive::advance(&ImplicitMidpoint, &Runaway, start, big, 3), failed);
        // 4 h (h + v0) = 0.14: two solutions, and the near one is found: v1 = (1 - sqrt(1 - 4 h (h + v0))) / (2 h).
        let h = T::lit(0.09375);
        let end = drive::advance(&ImplicitEuler, &Runaway, start, h, 1).expect("a solution");
        let discriminant = T::lit(1.0) - T::lit(4.0) * h * (h + start.v.x);
        let near = (T::lit(1.0) - discriminant.sqrt()) / (h + h);
        // The formula for it loses a digit to cancellation: 1 / (2 h v1) = 15.
        assert!((end.v.x - near).to_f64().abs() <= 16.0 * T::EPSILON, "{:?} {near:?}", end.v.x);
    }
    check::<f32>();
    check::<f64>();
    check::<fx128>();
}

/// A force that is not a number, or infinite, from the first evaluation on.
struct Broken(f64);
impl<T: Real> Model<T> for Broken {
    type Config = Vector1<T>;
    fn rate(&self, _t: T, _s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(T::lit(self.0))
    }
}

// Fails if: decompose does not look whether the scale is finite and solve not whether the correction is.
#[test]
fn a_force_that_is_not_finite_ends_the_run_without_a_panic() {
    for force in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let start = State { q: Vector1::new(0.5), v: Vector1::new(0.25) };
        let failed = Err(drive::Diverged { step: 1 });
        assert_eq!(drive::advance(&ImplicitEuler, &Broken(force), start, 0.5, 3), failed);
        assert_eq!(drive::advance(&ImplicitMidpoint, &Broken(force), start, 0.5, 3), failed);
    }
}

/// v' = t.
struct Ramp;
impl<T: Real> Model<T> for Ramp {
    type Config = Vector1<T>;
    fn rate(&self, t: T, _s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(t)
    }
}

// Fails if: the differences of the Jacobian are scaled to the unknowns alone, which are zero here.
#[test]
fn a_start_at_rest_is_no_obstacle() {
    fn check<T: Single>() {
        let line = |x: [f64; 2]| State { q: Vector1::new(T::lit(x[0])), v: Vector1::new(T::lit(x[1])) };
        let h = T::lit(0.75);
        assert_eq!(drive::advance(&ImplicitEuler, &Unit, line([0.0; 2]), h, 3), Ok(line([0.0; 2])));
        assert_eq!(drive::advance(&ImplicitMidpoint, &Unit, line([0.0; 2]), h, 3), Ok(line([0.0; 2])));
        // No force at t = 0, and one at the end of the step: v1 = h t1, q1 = h v1; and h^2 / 2, h^3 / 4.
        let close = |found: Result<State<Vector1<T>>, drive::Diverged>, [q, v]: [f64; 2]| {
            let found = found.expect("a solution");
            let apart = (found.q.x - T::lit(q)).abs().to_f64() + (found.v.x - T::lit(v)).abs().to_f64();
            assert!(apart <= 4.0 * T::EPSILON, "{found:?}");
        };
        close(drive::advance(&ImplicitEuler, &Ramp, line([0.0; 2]), h, 1), [0.421875, 0.5625]);
        close(drive::advance(&ImplicitMidpoint, &Ramp, line([0.0; 2]), h, 1), [0.10546875, 0.28125]);
    }
    check::<f32>();
    check::<f64>();
    check::<fx128>();
}

/// A free asymmetric body.
struct Top;
impl<T: Real> RigidBody<T> for Top {
    type Position = Fixed<T>;
    fn inertia(&self) -> Vector3<T> {
        Vector3::new(1.25, 0.75, 1.75).map(T::lit)
    }
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::None
    }
}

/// Largest relative changes of 2 E = omega . I omega and of |I omega|^2 along a run.
fn worst_changes<T: Single, A: Method<T, BodyOmega<Top>>>(method: &A, steps: u64) -> [f64; 2] {
    let start = State {
        q: Pose::<T, Exponential<Body>, Fixed<T>>::new(
            Fixed::zero(),
            Rotation::from_wxyz([0.5, -0.75, 1.0, 0.25].map(T::lit)),
        ),
        v: Twist { linear: Fixed::zero(), angular: Vector3::new(1.5, -0.75, 1.0).map(T::lit) },
    };
    let invariants = |omega: Vector3<T>| {
        let omega = omega.map(Single::widen);
        let momentum = omega.component_mul(&RigidBody::<fx128>::inertia(&Top));
        [dot(omega, momentum), dot(momentum, momentum)]
    };
    let first = invariants(start.v.angular);
    let mut worst = [0.0_f64; 2];
    let end = drive::integrate(method, &BodyOmega::new(Top), start, T::lit(0.0625), steps, |_, s| {
        let now = invariants(s.v.angular);
        worst = std::array::from_fn(|i| worst[i].max((now[i] / first[i] - fx128::ONE).0.abs()));
    });
    assert!(end.is_ok());
    worst
}

// Fails if: midpoint takes its force at the end of the step; v1 = vm.
#[test]
fn implicit_midpoint_conserves_energy_and_momentum_of_a_free_body_to_rounding() {
    // Every step rounds omega by an eps or two, and the iteration leaves as much: in no step more than 8 eps of a quadratic form.
    let single = worst_changes::<f64, _>(&ImplicitMidpoint, 10_000);
    let double = worst_changes::<fx128, _>(&ImplicitMidpoint, 1000);
    println!("{single:?} {double:?}");
    assert!(single.iter().all(|x| *x <= 8.0 * 1e4 * f64::EPSILON), "{single:?}");
    assert!(double.iter().all(|x| *x <= 8.0 * 1e3 * fx128::EPSILON.0), "{double:?}");
    // RK4 does not: its h^4 errors lie far above either bound.
    let other = worst_changes::<fx128, _>(&Rk4, 1000);
    assert!(other.iter().all(|x| *x > 1e-9), "{other:?}");
}

/// A linear step commutes with a scale that is a power of two, to the last bit: no size counts as zero before squares underflow.
// Fails if: 1e-30 counts as zero in f64.
#[test]
fn small_numbers_are_solved_as_well_as_large_ones() {
    let scale = 2.0_f64.powi(-150);
    let start = |scale: f64| State { q: Vector1::new(0.75 * scale), v: Vector1::new(-1.25 * scale) };
    for h in [0.015625, 16.0] {
        let end = |scale: f64| {
            [ImplicitEuler.step(&Unit, 0.0, h, start(scale)), ImplicitMidpoint.step(&Unit, 0.0, h, start(scale))]
        };
        for (large, small) in end(1.0).into_iter().zip(end(scale)) {
            assert_eq!([large.q.x * scale, large.v.x * scale], [small.q.x, small.v.x], "h = {h}");
        }
    }
}

/// A scene with parameters, and its steps in natural time scales.
type Resting = (&'static str, &'static [(&'static str, &'static str)], &'static [f64]);

/// Bodies that are at rest, start from rest, come to rest, turn round, or die away. A step of four time scales has a solution
/// where the force is linear.
const RESTING: [Resting; 12] = [
    ("forced-oscillator", &[("drive", "0"), ("damping", "2")], &[1e-3, 0.25, 4.0, 1000.0]),
    ("forced-oscillator", &[("drive", "0"), ("damping", "2"), ("x0", "0"), ("v0", "0")], &[1e-3, 0.25, 4.0]),
    ("forced-oscillator", &[("drive", "0"), ("stiffness", "0.021"), ("x0", "-0.35"), ("v0", "119")], &[0.25, 4.0]),
    ("damped-oscillator", &[("mass", "1"), ("stiffness", "170"), ("zeta", "0.997"), ("v0", "0")], &[0.05, 0.25, 4.0]),
    ("damped-oscillator/over-damped", &[("x0", "0")], &[0.25, 4.0]),
    ("oscillator", &[("v0", "0")], &[1e-3, 0.25, 4.0]),
    ("oscillator", &[("x0", "0"), ("v0", "0")], &[0.25, 4.0]),
    ("linear-drag", &[], &[1e-3, 0.25, 4.0, 1000.0]),
    ("quadratic-drag/fall", &[], &[1e-3, 0.25]),
    ("pendulum", &[("angle", "0"), ("omega", "0")], &[1e-3, 0.25]),
    ("pendulum", &[("omega", "0")], &[1e-3, 0.25]),
    ("spring-chain", &[], &[1e-3, 4.0]),
];

fn resting((id, set, _): Resting) -> Box<dyn AnyScene> {
    let mut scene = scenes::by_id(id).expect("a scene of the catalogue");
    for (name, value) in set {
        scene.scene_mut().set(id, name, value).expect("a value of the range");
    }
    scene
}

// Fails if: the iteration stops at rounding of the unknowns alone, which are next to nothing at rest, or the differences of the Jacobian are
// lost in the rounding of the configuration there; what dies away to denormal numbers is compared with their own epsilon.
#[test]
fn a_body_at_rest_under_a_load_keeps_stepping() {
    let mut failed = Vec::new();
    for case in RESTING {
        let scene = resting(case);
        let scale = scene.scene().info().time_scale_s;
        for method in [MethodId::ImplicitEuler, MethodId::ImplicitMidpoint] {
            for (precision, steps) in [(Precision::F32, 4000), (Precision::F64, 4000), (Precision::DoubleDouble, 400)] {
                for z in case.2 {
                    let run = Run::new(method, precision, z * scale * steps as f64, steps);
                    let run = scene.run(&run, steps).expect("a general method");
                    if run.outcome != Outcome::Finished {
                        failed.push(format!(
                            "{} {:?} {} {precision:?} h = {z}: step {:?}",
                            case.0,
                            case.1,
                            method.id(),
                            run.failed_step
                        ));
                    }
                }
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

// Fails if: the iteration takes a correction of a body at rest for rounding that is not.
#[test]
fn a_body_comes_to_rest_where_its_load_is_carried() {
    // -k x + F = 0 with F / k = 2.25 / 6 = 0.375: implicit Euler is there after 400 steps of a time scale.
    let scene = resting(RESTING[0]);
    let end_s = 400.0 * scene.scene().info().time_scale_s;
    for precision in Precision::ALL {
        let run = scene.run(&Run::new(MethodId::ImplicitEuler, precision, end_s, 400), 400).expect("a general method");
        let end = run.end().expect("finished").vector(Quantity::Position)[0];
        let error = (end - fx128::lit(0.375)).0.abs();
        // The position rounds by an eps of it a step and moves back by h^2 k / (m + h c + h^2 k) of what it is off.
        assert!(error <= 64.0 * precision.epsilon() * 0.375, "{precision:?}: {error:e}");
    }
}
