//! What the lists state of a step is what the step does: evaluations, its action on linear equations, whether it is a
//! symplectic map and whether it can be undone. A claim of 'no' is held too: the step must miss by far more than rounding.
//!
//! Not seen here: orders (order_of_methods.rs) and conserved quantities (rotation.rs of the tests of the workspace).

use integrator::counted::Counted;
use integrator::methods::{
    Conserved, Facts, LinearTheory, MethodId, MoreMethod, MoreRigidStep, RigidStep, RigidVisitor, Visitor,
};
use integrator::pose::{Fixed, Pose};
use integrator::rigid_body::{AttitudeUpdate, Kinematics, RigidBody, RigidModel, Torque};
use integrator::{DoubleDouble, Method, Model, Rotation, Single, State, Vector, drive};
use nalgebra::{Complex, Matrix2, Matrix3, SVector, Vector1, Vector2, Vector3};

type T = DoubleDouble;

fn every_fact() -> Vec<&'static Facts> {
    let general = MethodId::ALL.iter().map(|method| method.facts());
    let more = MoreMethod::ALL.iter().map(|method| method.facts());
    let rigid = RigidStep::ALL.iter().map(|step| step.facts());
    general.chain(more).chain(rigid).chain(MoreRigidStep::ALL.iter().map(|step| step.facts())).collect()
}

/// Calls a generic check with every step of both lists.
macro_rules! for_all {
    ($check:ident: $($list:ident),*) => {
        $(for &step in $list::ALL {
            $check!(step);
        })*
    };
}

// Fails if: two rows share an id; a row lacks a name, a formula or a source.
#[test]
fn every_step_has_a_name_of_its_own_a_formula_and_a_source() {
    let all = every_fact();
    for (i, facts) in all.iter().enumerate() {
        let texts = [facts.id, facts.title, facts.formula, facts.source].into_iter().chain(facts.latex.iter().copied());
        assert!(texts.into_iter().all(|text| !text.is_empty()) && !facts.latex.is_empty(), "{facts:?}");
        assert!(facts.order > 0 && (facts.implicit || facts.evaluations.is_some()), "{facts:?}");
        assert!(all[..i].iter().all(|other| other.id != facts.id), "{} stands twice", facts.id);
    }
}

/// x'' = -k x - c x'.
struct Oscillator {
    k: f64,
    c: f64,
}

impl<T: Single> Model<T> for Oscillator {
    type Config = Vector1<T>;
    fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
        -(s.q * T::lit(self.k) + s.v * T::lit(self.c))
    }
}

/// v' = lambda v in the complex plane.
struct Turning(Complex<f64>);

impl<T: Single> Model<T> for Turning {
    type Config = Vector2<T>;
    fn rate(&self, _t: T, s: &State<Vector2<T>>) -> Vector2<T> {
        let (re, im) = (T::lit(self.0.re), T::lit(self.0.im));
        Vector2::new(re * s.v.x - im * s.v.y, re * s.v.y + im * s.v.x)
    }
}

/// One step of h = 1 from (q, v).
struct OneStep<'a, M, const N: usize>(&'a M, [f64; N], [f64; N]);

impl<M: Model<T, Config = SVector<T, N>>, const N: usize> Visitor<T, M> for OneStep<'_, M, N> {
    type Output = State<SVector<T, N>>;
    fn visit<A: Method<T, M>>(self, method: &A) -> State<SVector<T, N>> {
        let lift = |x: [f64; N]| SVector::from(x).map(T::from_f64);
        method.step(self.0, T::from_f64(0.0), T::from_f64(1.0), State { q: lift(self.1), v: lift(self.2) })
    }
}

// Fails if: a coefficient of R(z) or an entry of a step matrix is another; a step does something else.
#[test]
fn a_step_does_to_linear_equations_what_its_theory_says() {
    macro_rules! check {
        ($method:ident) => {{
            let method = $method;
            let Some(linear) = method.facts().linear else { continue };
            for (k, c) in [(0.75, 0.0), (0.75, 0.375), (2.5, 0.25), (0.0625, 1.25)] {
                let model = Oscillator { k, c };
                let column = |q, v| {
                    let s = method.visit(OneStep(&model, [q], [v]));
                    [s.q.x.to_f64(), s.v.x.to_f64()]
                };
                let ([a, b], [d, e]) = (column(1.0, 0.0), column(0.0, 1.0));
                let apart = (Matrix2::new(a, d, b, e) - linear.oscillator(k, c)).amax();
                // Sums of at most ten terms below 16 in f64.
                assert!(apart <= 10.0 * 16.0 * f64::EPSILON, "{} k = {k}, c = {c}: {apart:e}", method.id());
            }
            for z in [Complex::new(-0.5, 0.75), Complex::new(-2.25, 0.0), Complex::new(0.0, 1.5)] {
                let v = method.visit(OneStep(&Turning(z), [0.0; 2], [1.0, 0.0])).v;
                let apart = (Complex::new(v.x.to_f64(), v.y.to_f64()) - linear.velocity().at(z)).norm();
                assert!(apart <= 10.0 * 16.0 * f64::EPSILON, "{} z = {z}: {apart:e}", method.id());
            }
        }};
    }
    for_all!(check: MethodId, MoreMethod);
    assert!(MethodId::ALL.iter().all(|method| method.facts().linear.is_some()));
}

// Fails if: `is_bounded` takes |trace| <= 1 - det.
#[test]
fn the_boundary_of_the_undamped_oscillator_is_where_theory_has_it() {
    let bounded = |method: MethodId, h: f64| {
        method.facts().linear.map(|theory: LinearTheory| theory.is_bounded(h * h, 0.0, 1e-14))
    };
    for (method, limit) in [
        (MethodId::SemiImplicitEuler, 2.0),
        (MethodId::VelocityVerlet, 2.0),
        (MethodId::Rk4, 8.0_f64.sqrt()),
        (MethodId::ExplicitEuler, 0.0),
    ] {
        assert_eq!(bounded(method, limit - 0.0009765625).filter(|_| limit > 0.0), (limit > 0.0).then_some(true));
        assert_eq!(bounded(method, limit + 0.0009765625), Some(false), "{}", method.id());
    }
    assert_eq!(bounded(MethodId::ImplicitMidpoint, 64.0), Some(true));
}

/// Evaluations in the ninth step of a run.
struct Count;
impl Visitor<T, Counted<Oscillator>> for Count {
    type Output = u64;
    fn visit<A: Method<T, Counted<Oscillator>>>(self, method: &A) -> u64 {
        let run = |steps| {
            let counted = Counted::new(Oscillator { k: 1.0, c: 0.5 });
            let start = State { q: Vector1::new(T::from_f64(1.5)), v: Vector1::new(T::from_f64(-1.0)) };
            drive::advance(method, &counted, start, T::from_f64(0.25), steps).expect("finite");
            counted.evaluations()
        };
        run(9) - run(8)
    }
}

// Fails if: a row states one evaluation more or less.
#[test]
fn a_step_evaluates_the_force_as_often_as_stated() {
    macro_rules! general {
        ($method:ident) => {{
            let (found, stated) = ($method.visit(Count), $method.facts().evaluations);
            assert!(stated.is_none_or(|stated| found == stated), "{}: {found}, stated {stated:?}", $method.id());
            assert!(stated.is_some() || found > 2, "{} solves equations", $method.id());
        }};
    }
    for_all!(general: MethodId, MoreMethod);
    macro_rules! rigid {
        ($step:ident) => {{
            let step = $step;
            let counted = Counted::new(Top);
            let body: &Counted<Top> = &counted;
            step.visit::<T, _, _>(AttitudeUpdate::Exponential, body, Walk { start: kinematics(OMEGA), steps: 1 });
            assert_eq!(Some(counted.evaluations()), step.facts().evaluations, "{}", step.id());
        }};
    }
    for_all!(rigid: RigidStep, MoreRigidStep);
}

/// Two pendulums coupled by a spring that is not one: x'' = -grad U(x), U = -cos x - 2 cos y + x^2 y / 2.
struct Coupled;
impl<T: Single> Model<T> for Coupled {
    type Config = Vector2<T>;
    fn rate(&self, _t: T, s: &State<Vector2<T>>) -> Vector2<T> {
        let (x, y) = (s.q.x, s.q.y);
        let (sin_x, sin_y) = (x.sin_cos().0, y.sin_cos().0);
        -Vector2::new(sin_x + x * y, sin_y * T::lit(2.0) + x * x * T::lit(0.5))
    }
}

/// Half of what the Jacobians of a map are found with, and the relative error of that: delta^2 of a third derivative.
const DELTA: f64 = 1.490_116_119_384_765_6e-8;

struct StepOf([T; 4], f64);
impl Visitor<T, Coupled> for StepOf {
    type Output = [T; 4];
    fn visit<A: Method<T, Coupled>>(self, method: &A) -> [T; 4] {
        let [a, b, c, d] = self.0;
        let s = State { q: Vector2::new(a, b), v: Vector2::new(c, d) };
        let s = method.step(&Coupled, T::from_f64(0.0), T::from_f64(self.1), s);
        [s.q.x, s.q.y, s.v.x, s.v.y]
    }
}

const START: [f64; 4] = [0.75, -0.5, 0.25, -1.25];

/// Largest entry of J^T Omega J - Omega of one step of h = 1/4.
fn symplectic_defect(step: impl Fn(StepOf) -> [T; 4]) -> f64 {
    let column = |i: usize| {
        let at = |side: f64| {
            let mut z = START.map(T::from_f64);
            z[i] += T::from_f64(side * DELTA);
            step(StepOf(z, 0.25))
        };
        let (plus, minus) = (at(1.0), at(-1.0));
        std::array::from_fn::<f64, 4, _>(|k| ((plus[k] - minus[k]) / T::from_f64(2.0 * DELTA)).to_f64())
    };
    let columns: [[f64; 4]; 4] = std::array::from_fn(column);
    let form = |a: [f64; 4], b: [f64; 4]| a[0] * b[2] - a[2] * b[0] + a[1] * b[3] - a[3] * b[1];
    let unit = |i: usize| std::array::from_fn::<f64, 4, _>(|k| if k == i { 1.0 } else { 0.0 });
    let pairs = (0..4).flat_map(|i| (0..4).map(move |j| (i, j)));
    pairs.map(|(i, j)| (form(columns[i], columns[j]) - form(unit(i), unit(j))).abs()).fold(0.0, f64::max)
}

/// Distance from the start of a step of h = 1/4, the velocity turned around, a step.
fn reversal_defect(step: impl Fn(StepOf) -> [T; 4]) -> f64 {
    let turned = |[a, b, c, d]: [T; 4]| [a, b, -c, -d];
    let there = step(StepOf(START.map(T::from_f64), 0.25));
    let back = turned(step(StepOf(turned(there), 0.25)));
    back.iter().zip(START).map(|(x, y)| (*x - T::from_f64(y)).to_f64().abs()).fold(0.0, f64::max)
}

/// `claim` against a defect: none but `rounding`, or more than any rounding and less than the step itself.
fn held(name: &str, what: &str, claim: Option<bool>, defect: f64, rounding: f64) {
    println!("{name} {what}: {claim:?}, {defect:e}");
    match claim {
        Some(true) => assert!(defect <= rounding, "{name} is not {what}: {defect:e}"),
        Some(false) => assert!(defect > 1e-7 && defect < 1.0, "{name} is {what}: {defect:e}"),
        None => (),
    }
}

// Fails if: semi-implicit Euler moves q by v0; Verlet's two kicks differ; a claim of a row is turned around.
#[test]
fn symplectic_and_reversible_are_the_methods_that_say_so_and_no_others() {
    macro_rules! check { ($method:ident) => {{
        let facts = $method.facts();
        let step = |of: StepOf| $method.visit(of);
        // Products of derivatives below 2, each wrong by delta^2 times a third derivative below 4 (and half an ulp of f64).
        held(facts.id, "symplectic", facts.symplectic, symplectic_defect(step), 64.0 * f64::EPSILON);
        held(facts.id, "reversible", facts.reversible, reversal_defect(step), 1024.0 * <T as Single>::EPSILON);
    }}}
    for_all!(check: MethodId, MoreMethod);
}

/// A free body; its inertia neither sorted nor with two equal moments.
struct Top;
const INERTIA: [f64; 3] = [1.25, 0.75, 1.75];
const OMEGA: [f64; 3] = [1.5, -0.75, 1.0];

impl RigidBody<T> for Top {
    type Position = Fixed<T>;
    fn inertia(&self) -> Vector3<T> {
        Vector3::from(INERTIA).map(T::from_f64)
    }
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::None
    }
}

fn kinematics(omega: [f64; 3]) -> Kinematics<T, Fixed<T>> {
    let attitude = Rotation::from_wxyz([0.5, -0.75, 1.0, 0.25].map(T::from_f64));
    let omega_body = Vector3::from(omega).map(T::from_f64);
    Kinematics { position: Fixed::zero(), velocity: Fixed::zero(), attitude, omega_body }
}

/// Steps of h = 1/8, the motion turned around between two of them.
struct Walk {
    start: Kinematics<T, Fixed<T>>,
    steps: u32,
}

impl<B: RigidBody<T, Position = Fixed<T>>> RigidVisitor<T, B> for Walk {
    type Output = Kinematics<T, Fixed<T>>;
    fn visit<M: RigidModel<T, Body = B>, A: Method<T, M>>(self, method: &A, model: &M) -> Self::Output {
        (0..self.steps).fold(self.start, |at, i| {
            let omega_body = if i == 0 { at.omega_body } else { -at.omega_body };
            let s: State<Pose<T, _, _>> = model.state(&Kinematics { omega_body, ..at });
            model.kinematics(&method.step(model, T::from_f64(0.0), T::from_f64(0.125), s))
        })
    }
}

/// Largest entry of J hat(l0) J^T - hat(l1) of a step l0 -> l1 of the momentum in the body frame.
fn poisson_defect(step: impl Fn(Walk) -> Kinematics<T, Fixed<T>>) -> f64 {
    let l = Vector3::from(OMEGA).component_mul(&Vector3::from(INERTIA));
    let end = |l: Vector3<T>| {
        let mut start = kinematics(OMEGA);
        start.omega_body = l.component_div(&Top.inertia());
        let at = step(Walk { start, steps: 1 });
        at.omega_body.component_mul(&Top.inertia())
    };
    let wide = l.map(T::from_f64);
    let column = |i: usize| {
        let moved = |side: f64| {
            let mut l = wide;
            l[i] += T::from_f64(side * DELTA);
            end(l)
        };
        ((moved(1.0) - moved(-1.0)) / T::from_f64(2.0 * DELTA)).map(Single::to_f64)
    };
    let jacobian = Matrix3::from_columns(&[column(0), column(1), column(2)]);
    (jacobian * l.cross_matrix() * jacobian.transpose() - end(wide).map(Single::to_f64).cross_matrix()).amax()
}

// Fails if: the splitting's turns are not palindromic (X Y Z X Y), or one of them turns the momentum forwards.
#[test]
fn rigid_steps_are_poisson_maps_and_reversible_as_they_say() {
    macro_rules! check {
        ($step:ident) => {{
            let facts = $step.facts();
            let step = |walk: Walk| $step.visit::<T, _, _>(AttitudeUpdate::Exponential, Top, walk);
            held(facts.id, "a Poisson map", facts.symplectic, poisson_defect(step), 64.0 * f64::EPSILON);
            let back = step(Walk { start: kinematics(OMEGA), steps: 2 });
            let start = kinematics(OMEGA);
            let turned = (back.omega_body + start.omega_body).map(|x| x.to_f64()).norm();
            let defect = turned.max(back.attitude.angle_to(start.attitude).to_f64());
            held(facts.id, "reversible", facts.reversible, defect, 1024.0 * <T as Single>::EPSILON);
            conserved(facts, &kinematics(OMEGA), &step(Walk { start: kinematics(OMEGA), steps: 1 }));
        }};
    }
    for_all!(check: RigidStep, MoreRigidStep);
}

/// Whether a step keeps what it says, to the roundings of at most seventeen steps of five turns.
fn conserved(facts: &Facts, start: &Kinematics<T, Fixed<T>>, end: &Kinematics<T, Fixed<T>>) {
    let momentum = |at: &Kinematics<T, Fixed<T>>| at.attitude.rotate(at.omega_body.component_mul(&Top.inertia()));
    let energy = |at: &Kinematics<T, Fixed<T>>| (at.omega_body.component_mul(&Top.inertia())).dot(&at.omega_body);
    for kept in facts.conserves {
        let change = match kept {
            Conserved::Energy => (energy(end) - energy(start)).to_f64().abs(),
            Conserved::Momentum => (momentum(end) - momentum(start)).map(Single::to_f64).norm(),
            Conserved::MomentumNorm => {
                let square = |at| integrator::rotation::dot(momentum(at), momentum(at));
                (square(end) - square(start)).to_f64().abs()
            }
        };
        assert!(change <= 1024.0 * <T as Single>::EPSILON, "{} keeps {kept:?}: {change:e}", facts.id);
    }
}
