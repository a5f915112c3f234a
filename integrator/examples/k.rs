use std::hint::black_box;
use std::time::Instant;
use integrator::lanes::Fused;
use integrator::methods::{Rk4, SemiImplicitEuler};
use integrator::pose::{Fixed, Pose, Twist};
use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, Torque};
use integrator::{Model, Real, Rotation, State, Vector, drive};
use nalgebra::Vector3;
struct Free<T: Real>(Vector3<T>);
impl<T: Real> RigidBody<T> for Free<T> {
    type Position = Fixed<T>;
    #[inline(always)]
    fn inertia(&self) -> Vector3<T> { self.0 }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> { Torque::None }
}
type F = Fused<f64>;
type M = BodyOmega<Free<F>>;
type S = State<<M as Model<F>>::Config>;

#[inline(never)]
fn se_kernel(m: &M, s: S, h: F, n: u64) -> Option<S> { drive::advance(&SemiImplicitEuler, m, s, h, n).ok() }

#[inline(never)]
fn rk_kernel(m: &M, s: S, h: F, n: u64) -> Option<S> { drive::advance(&Rk4, m, s, h, n).ok() }
fn clock() -> u64 {
    let mut x = black_box(3_u64);
    let by = black_box(0x9E37_79B9_7F4A_7C15_u64);
    for _ in 0..20000 { x = x.wrapping_mul(by) ^ by; }
    x
}
fn main() {
    let f = |x: f64| Fused(black_box(x));
    let m = M::new(Free(Vector3::new(f(1.25), f(0.75), f(1.75))));
    let s = State { q: Pose::new(Fixed::zero(), Rotation::identity()), v: Twist { linear: Fixed::zero(), angular: Vector3::new(f(1.5), f(-0.75), f(1.0)) } };
    let time = |w: &dyn Fn()| { let t = Instant::now(); w(); t.elapsed().as_secs_f64() };
    let (mut a, mut b) = (vec![], vec![]);
    for _ in 0..300 {
        let c = time(&|| { black_box(clock()); });
        let x = time(&|| { black_box(se_kernel(&m, s, f(0.001), 20000)); });
        let y = time(&|| { black_box(rk_kernel(&m, s, f(0.001), 20000)); });
        let d = c.min(time(&|| { black_box(clock()); })) / 80000.0;
        a.push(x / 20000.0 / d); b.push(y / 20000.0 / d);
    }
    a.sort_by(f64::total_cmp); b.sort_by(f64::total_cmp);
    println!("SE {:.2} {:.2}  RK4 {:.2} {:.2}", a[3], a[150], b[3], b[150]);
    println!("{:?}", se_kernel(&m, s, f(0.001), 1000).unwrap().q.attitude.wxyz());
}
