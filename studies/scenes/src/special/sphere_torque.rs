//! The exact motion of a sphere under a torque that is constant in the world frame (Landau-Zener problem).
//!
//! omega = omega0 + (tau / I) t, but the attitude is elementary only where tau and omega0 are parallel: rotations about the
//! directions that omega passes through do not commute. C. Zener, Non-adiabatic crossing of energy levels, Proc. R.
//! Soc. A 137 (1932) 696-702, solves the same equation of a spin in a field that changes linearly. Its solution by Kummer's
//! functions cancels like e^(pi p), p = I omega_perp^2 / (8 |tau|); here q' = (omega0 + alpha t) q / 2 is summed by
//! its power series, one radian of q after the other, and where omega turns slowly by the series of `adiabatic`.

use faer::fx128;
use integrator::real::{Real, Single};
use integrator::rotation::{Rotation, cross, dot};
use nalgebra::Vector3;

use super::adiabatic::{self, Leg};
use super::scaled::{Scaled, exponent_of_largest, times_two_to, unit_quaternion};

/// A sphere (three equal moments) with constant torque in the world frame.
#[derive(Clone, Copy, Debug)]
pub struct SphereTop {
    /// Attitude at t = 0, body to world.
    attitude0: Rotation<fx128>,
    /// omega at t = 0 and its rate, world frame, in units of 2^unit rad/s and 4^unit rad/s^2.
    omega0: Vector3<fx128>,
    acceleration: Vector3<fx128>,
    unit: i64,
    /// None where omega keeps its direction.
    crossing: Option<Crossing>,
}

/// omega in the frame (x, y, z), z along the torque and omega0 in the plane of x and z.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// Attitude of that frame in the world.
    frame: Rotation<fx128>,
    /// |tau| / I.
    rate: fx128,
    /// omega_x, and omega_z at t = 0.
    across: fx128,
    along: fx128,
}

/// Steps of the power series, of a radian of q each, that are taken before omega is asked whether it turns slowly.
const FEW_STEPS: f64 = 24.0;
/// Most steps in one sum.
const MOST_STEPS: f64 = 2048.0;

impl SphereTop {
    /// Moment of inertia (kg m^2), attitude (w, x, y, z) normalised in double-double, omega (rad/s) and torque (N m) in the
    /// world frame.
    pub fn new(inertia: f64, attitude0: [f64; 4], omega_world0: [f64; 3], torque_world: [f64; 3]) -> Self {
        // The unit of time is that of the faster of omega0 and sqrt(|tau| / I).
        let torque_unit = exponent_of_largest(&torque_world);
        let strength = Scaled::of(1.0).shifted(torque_unit).over(Scaled::of(inertia));
        let is_free = torque_world == [0.0; 3];
        let of_torque = if is_free { i64::MIN } else { strength.sqrt().exponent() };
        let of_omega = if omega_world0 == [0.0; 3] { i64::MIN } else { exponent_of_largest(&omega_world0) };
        let unit = if is_free && of_omega == i64::MIN { 0 } else { of_torque.max(of_omega) };

        let omega0 = Vector3::from(omega_world0).map(|w| times_two_to(fx128::from_f64(w), -unit));
        let torque = Vector3::from(torque_world).map(|c| times_two_to(fx128::from_f64(c), -torque_unit));
        let acceleration = torque.map(|c| strength.times(Scaled::of_wide(c)).shifted(-2 * unit).value());
        let normal = cross(torque, omega0);
        let crosses = normal.iter().any(|c| c.0 != 0.0) && acceleration.iter().any(|c| c.0 != 0.0);
        let crossing = crosses.then(|| Crossing::new(omega0, torque, strength.shifted(-2 * unit)));
        Self { attitude0: unit_quaternion(attitude0), omega0, acceleration, unit, crossing }
    }

    /// Attitude (body to world) and angular velocity in the world frame (rad/s) at time t (s).
    ///
    /// Error (measured): f64 below 1e-15, double-double 1e-28, at any torque, while the phase is below 1e15.
    pub fn at<T: Single>(&self, t: T) -> (Rotation<T>, Vector3<T>) {
        let t = times_two_to(t.widen(), self.unit);
        let omega = self.omega0 + self.acceleration * t;
        let turn = match &self.crossing {
            Some(crossing) => self.crossed(crossing, t, omega),
            None => Rotation::exp((self.omega0 + self.acceleration * (t * fx128::from_f64(0.5))) * t),
        };
        let attitude = (turn * self.attitude0).normalized();
        let omega = omega.map(|w| T::narrow(times_two_to(w, self.unit)));
        (Rotation { w: T::narrow(attitude.w), v: attitude.v.map(T::narrow) }, omega)
    }

    /// q(t) q(0)*.
    fn crossed(&self, crossing: &Crossing, t: fx128, omega: Vector3<fx128>) -> Rotation<fx128> {
        let steps = steps(self.omega0, omega, t);
        let Crossing { frame, rate, across, along } = *crossing;
        let leg = Leg { rate, across, start: along, end: along + rate * t, time: t };
        if steps <= FEW_STEPS || (steps <= MOST_STEPS && !leg.is_adiabatic()) {
            return by_series(self.omega0, self.acceleration, t);
        }
        if leg.is_adiabatic() {
            return frame * leg.turn() * frame.conjugate();
        }
        // Where omega passes near zero it turns fast: adiabatic before and after, power series between.
        let slow = Real::sqrt(rate * fx128::from_f64(adiabatic::SLOWEST));
        let bounds = [leg.start, larger(leg.start, -slow), smaller(leg.end, slow), leg.end];
        let mut turn = Rotation::identity();
        for (i, pair) in bounds.windows(2).enumerate() {
            let (start, end) = (pair[0], pair[1]);
            if start >= end {
                continue;
            }
            let part = Leg { rate, across, start, end, time: (end - start) / rate };
            let part_turn = if i == 1 {
                let omega = Vector3::new(across, fx128::ZERO, start);
                by_series(omega, Vector3::new(fx128::ZERO, fx128::ZERO, rate), part.time)
            } else {
                part.turn()
            };
            turn = part_turn * turn;
        }
        frame * turn * frame.conjugate()
    }
}

impl Crossing {
    fn new(omega0: Vector3<fx128>, torque: Vector3<fx128>, strength: Scaled) -> Self {
        let size = Real::sqrt(dot(torque, torque));
        let z = torque.map(|c| c / size);
        let y = cross(z, omega0);
        let unit = exponent_of_largest(&[y.x.0, y.y.0, y.z.0]);
        let near_one = y.map(|c| times_two_to(c, -unit));
        let length = Real::sqrt(dot(near_one, near_one));
        let y = near_one.map(|c| c / length);
        Self {
            frame: frame_of(cross(y, z), y, z),
            rate: strength.times(Scaled::of_wide(size)).value(),
            across: times_two_to(length, unit),
            along: dot(omega0, z),
        }
    }
}

fn larger(a: fx128, b: fx128) -> fx128 {
    if a < b { b } else { a }
}

fn smaller(a: fx128, b: fx128) -> fx128 {
    if a < b { a } else { b }
}

/// Steps in which q turns by a radian at most: |omega| is largest at an end.
fn steps(start: Vector3<fx128>, end: Vector3<fx128>, t: fx128) -> f64 {
    let size = |w: Vector3<fx128>| w.iter().fold(0.0_f64, |sum, c| sum.hypot(c.0));
    (size(start).max(size(end)) * t.0.abs() * 0.5).ceil().max(1.0)
}

/// q(t) of q' = (omega + alpha t) q / 2, q(0) = 1, by power series about each of several times:
/// 2 (n + 1) q_(n+1) = omega q_n + alpha q_(n-1).
fn by_series(omega: Vector3<fx128>, alpha: Vector3<fx128>, t: fx128) -> Rotation<fx128> {
    let count = steps(omega, omega + alpha * t, t);
    let h = t / fx128::from_f64(count);
    let mut q = Rotation::identity();
    // The increments are formed in units of the step.
    let push = alpha * (h * h);
    for i in 0..count as u64 {
        let turn = (omega + alpha * (h * fx128::from_f64(i as f64))) * h;
        let (mut before, mut term) = (Rotation { w: fx128::ZERO, v: Vector3::repeat(fx128::ZERO) }, q);
        for n in 1..64 {
            let (a, b) = (times(turn, term), times(push, before));
            let scale = fx128::from_f64(0.5) / fx128::from_f64(f64::from(n));
            let next = Rotation { w: (a.w + b.w) * scale, v: (a.v + b.v) * scale };
            (before, term) = (term, next);
            q = Rotation { w: q.w + term.w, v: q.v + term.v };
            let size = |q: &Rotation<fx128>| q.v.iter().fold(q.w.0.abs(), |most, c| most.max(c.0.abs()));
            if size(&term) + size(&before) < 1e-35 {
                break;
            }
        }
    }
    q
}

/// (0, v) q.
fn times(v: Vector3<fx128>, q: Rotation<fx128>) -> Rotation<fx128> {
    Rotation { w: -dot(v, q.v), v: v * q.w + cross(v, q.v) }
}

/// The rotation whose matrix has the columns x, y, z (orthonormal, right-handed), from its largest component.
fn frame_of(x: Vector3<fx128>, y: Vector3<fx128>, z: Vector3<fx128>) -> Rotation<fx128> {
    let one = fx128::ONE;
    let candidates = [
        [one + x.x + y.y + z.z, y.z - z.y, z.x - x.z, x.y - y.x],
        [y.z - z.y, one + x.x - y.y - z.z, x.y + y.x, x.z + z.x],
        [z.x - x.z, x.y + y.x, one - x.x + y.y - z.z, y.z + z.y],
        [x.y - y.x, x.z + z.x, y.z + z.y, one - x.x - y.y + z.z],
    ];
    let best = (1..4).fold(0, |best, i| if candidates[i][i].0 > candidates[best][best].0 { i } else { best });
    Rotation::from_wxyz(candidates[best])
}
