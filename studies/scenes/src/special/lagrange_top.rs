//! The exact motion of Lagrange's heavy symmetric top, spinning about a fixed point.
//!
//! J.-L. Lagrange, Mecanique analytique (1788), second part, section IX; the elliptic solution as in E. T. Whittaker, A
//! Treatise on the Analytical Dynamics of Particles and Rigid Bodies (1904), sections 71-72, with half-angles as in
//! F. Klein, A. Sommerfeld, Ueber die Theorie des Kreisels (1897): each needs one integral of the third kind.

use faer::fx128;
use integrator::real::{Real, Single};
use integrator::rotation::Rotation;
use nalgebra::{Vector2, Vector3};

use super::elliptic::{complete_pi, f_of, pi_of};
use super::jacobi::{Jacobi, Modulus};
use super::scaled::{Scaled, exponent_of_largest, times_two_to, unit_quaternion};
use super::symmetric_top::SymmetricTop;
use super::top_series::{Pull, Spherical, halves, turn, turned};

/// A heavy top with moments (I1, I1, I3) about its fixed point and its centre of mass on the body's third axis.
///
/// With u = cos theta the height of the axis, u'^2 = (2 mgl / I1)(u - u1)(u - u2)(u - u3), u1 <= u <= u2 <= 1 <= u3:
/// u = u1 + (u2 - u1) sn^2(kappa t + phase), kappa = sqrt(mgl (u3 - u1) / (2 I1)), 1 - m = (u3 - u2) / (u3 - u1). The attitude is
/// (sqrt((1+u)/2) cos p, sqrt((1-u)/2) cos d, sqrt((1-u)/2) sin d, sqrt((1+u)/2) sin p), and p and d advance by L3 (1/I3 - 1/I1) t / 2 each
/// way and an integral of the third kind. All in double-double, so that f64 results are the exact ones rounded.
///
/// Where the axis passes the vertical, or within 1e-6 of it in 1 - |u|, the half-angles are singular: there the motion is
/// summed by power series over one nutation, and the nutations before it turn p and d by as much each; see `top_series`.
#[derive(Clone, Copy, Debug)]
pub struct LagrangeTop {
    attitude0: Rotation<fx128>,
    /// In units of 2^unit rad/s, as all rates below.
    omega0: Vector3<fx128>,
    unit: i64,
    motion: Motion,
}

#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "one at a time, on the stack")]
enum Motion {
    /// A top that sleeps upright or hangs.
    Steady,
    /// Gravity is below the rounding.
    Free(SymmetricTop),
    Nutating(Nutation),
    NearVertical {
        pull: Pull,
        relative_spin: fx128,
        period: fx128,
    },
}

/// Below this part of the square of the fastest rate, m g l / I1 changes nothing while phases are resolved.
const WEAK: f64 = 1e-48;
/// Nearest 1 - |u| of the closed form: half of the digits of double-double are left.
const NEAR: f64 = 1e-6;

/// One of the half-angles p and d.
#[derive(Clone, Copy, Debug)]
struct HalfAngle {
    /// Its value at t = 0 without the integral's, rad, and what it gains by the spin, rad/s.
    start: fx128,
    spin: fx128,
    /// Factor, complementary characteristic and complete value of its integral.
    factor: fx128,
    nc: fx128,
    complete: fx128,
}

#[derive(Clone, Copy, Debug)]
struct Nutation {
    /// 1 + u1, 1 - u1, u2 - u1.
    above: fx128,
    below: fx128,
    swing: fx128,
    modulus: Modulus,
    kappa: fx128,
    phase: fx128,
    sum: HalfAngle,
    difference: HalfAngle,
    /// L_z / I1 and L_3 / I1, rad/s.
    vertical: fx128,
    axial: fx128,
}

impl LagrangeTop {
    /// I1, I3 (kg m^2), m g l (N m, positive), attitude (w, x, y, z) normalised in double-double, omega in the body
    /// frame (rad/s). Gravity points along -z of the world.
    pub fn new(inertia_1: f64, inertia_3: f64, mgl: f64, attitude0: [f64; 4], omega_body0: [f64; 3]) -> Self {
        let q = unit_quaternion(attitude0);
        let pull = Scaled::of(mgl).over(Scaled::of(inertia_1));
        let of_omega = if omega_body0 == [0.0; 3] { i64::MIN } else { exponent_of_largest(&omega_body0) };
        let unit = of_omega.max(pull.sqrt().exponent());
        let omega = Vector3::from(omega_body0).map(|w| times_two_to(fx128::from_f64(w), -unit));
        let gravity = pull.shifted(-2 * unit).value();
        let ratio = Scaled::of(inertia_3).over(Scaled::of(inertia_1)).value();

        let tilted = (q.v.x.0 != 0.0 || q.v.y.0 != 0.0) && (q.w.0 != 0.0 || q.v.z.0 != 0.0);
        let motion = if !tilted && omega.x.0 == 0.0 && omega.y.0 == 0.0 {
            Motion::Steady
        } else if gravity.0 < WEAK {
            Motion::Free(SymmetricTop::new(inertia_1, inertia_3, attitude0, omega_body0))
        } else {
            nutating(ratio, gravity, q, omega)
        };
        Self { attitude0: q, omega0: omega, unit, motion }
    }

    /// Attitude (body to world) and angular velocity in the body frame (rad/s) at time t (s).
    pub fn at<T: Single>(&self, t: T) -> (Rotation<T>, Vector3<T>) {
        if let Motion::Free(top) = &self.motion {
            return top.at(t);
        }
        let t = times_two_to(t.widen(), self.unit);
        let (attitude, omega) = match &self.motion {
            Motion::Nutating(nutation) => nutation.at(t, self.omega0.z),
            Motion::NearVertical { pull, relative_spin, period } => {
                self.near_vertical(pull, *relative_spin, *period, t)
            }
            _ => (self.attitude0 * Rotation::exp(self.omega0 * t), self.omega0),
        };
        let omega = omega.map(|w| T::narrow(times_two_to(w, self.unit)));
        (Rotation { w: T::narrow(attitude.w), v: attitude.v.map(T::narrow) }, omega)
    }

    /// By power series from the start, or from the start of the nutation that is on.
    fn near_vertical(
        &self,
        pull: &Pull,
        relative_spin: fx128,
        period: fx128,
        t: fx128,
    ) -> (Rotation<fx128>, Vector3<fx128>) {
        let start = Spherical { attitude: self.attitude0, omega: self.omega0.xy() };
        let whole = if period.is_finite() { (t / period - fx128::from_f64(0.5)).round() } else { fx128::ZERO };
        let now = if whole.0.abs() < 2.0 {
            pull.after(start, t)
        } else {
            let mut at = pull.after(start, t - whole * period);
            let [p, d] = self.gained_by_a_nutation(pull, period).map(|angle| angle * whole);
            let [sum, difference] = halves(at.attitude);
            let (sum, difference) = (turn(sum, p), turn(difference, d));
            at.attitude = Rotation { w: sum.x, v: Vector3::new(difference.x, difference.y, sum.y) };
            // psi = p - d turns the frame in which omega is seen.
            at.omega = turn(at.omega, d - p);
            at
        };
        // The body turns about its axis in the frame of the series.
        let angle = relative_spin * t;
        let (sine, cosine) = Real::sin_cos(angle * fx128::from_f64(0.5));
        let spin = Rotation { w: cosine, v: Vector3::new(fx128::ZERO, fx128::ZERO, sine) };
        let across = turn(now.omega, -angle);
        (now.attitude * spin, Vector3::new(across.x, across.y, self.omega0.z))
    }

    /// What the half-angles p and d gain in a nutation, each seen where its part of the quaternion is large: at the start
    /// or half a nutation later.
    fn gained_by_a_nutation(&self, pull: &Pull, period: fx128) -> [fx128; 2] {
        let half = period * fx128::from_f64(0.5);
        let mut at = Spherical { attitude: self.attitude0, omega: self.omega0.xy() };
        let seen = [0, 1, 2, 3].map(|_| {
            let here = halves(at.attitude);
            at = pull.after(at, half);
            here
        });
        [0, 1].map(|i| {
            let size = |half: Vector2<fx128>| half.x.0.hypot(half.y.0);
            let from = if size(seen[0][i]) >= size(seen[1][i]) { 0 } else { 1 };
            turned([seen[from + 2][i], seen[from][i]])
        })
    }
}

/// The closed form, or where it is singular the power series. `ratio` is I3 / I1, `gravity` m g l / I1.
fn nutating(ratio: fx128, gravity: fx128, q: Rotation<fx128>, omega: Vector3<fx128>) -> Motion {
    let start = Start::new(ratio, q, omega);
    let roots = start.roots(gravity);
    let [low, high, _] = roots;
    if (start.up + low).0 >= NEAR && (start.down - high).0 >= NEAR {
        return Motion::Nutating(Nutation::new(ratio, gravity, q, omega));
    }
    let (modulus, kappa) = modulus_and_rate(roots, gravity);
    let axial = ratio * omega.z;
    Motion::NearVertical {
        pull: Pull { gravity, axial },
        relative_spin: omega.z - axial,
        period: modulus.quarter_period() * fx128::from_f64(2.0) / kappa,
    }
}

/// The height u of the axis at the start, and what stays of the motion.
struct Start {
    /// 1 + u and 1 - u, without the subtraction.
    up: fx128,
    down: fx128,
    u: fx128,
    u_rate: fx128,
    /// L_3 / I1, L_z / I1, and the square of omega across the axis.
    axial: fx128,
    vertical: fx128,
    across: fx128,
}

impl Start {
    fn new(ratio: fx128, q: Rotation<fx128>, omega: Vector3<fx128>) -> Self {
        let (one, two) = (fx128::ONE, fx128::from_f64(2.0));
        let Rotation { w, v } = q;
        let (up, down) = (two * (w * w + v.z * v.z), two * (v.x * v.x + v.y * v.y));
        let (gx, gy) = vertical_in_body(q);
        let u = if up.0 < down.0 { up - one } else { one - down };
        let axial = ratio * omega.z;
        Self {
            up,
            down,
            u,
            u_rate: gx * omega.y - gy * omega.x,
            axial,
            vertical: gx * omega.x + gy * omega.y + axial * u,
            across: omega.x * omega.x + omega.y * omega.y,
        }
    }

    /// Of u'^2 = f0 + f1 v + f2 v^2 + lift v^3 with v = u(t) - u(0): the constants do not cancel.
    fn roots(&self, gravity: fx128) -> [fx128; 3] {
        let Self { up, down, u, u_rate, axial, vertical, across } = *self;
        let (two, lift) = (fx128::from_f64(2.0), gravity + gravity);
        let f0 = u_rate * u_rate;
        let f1 = two * axial * (vertical - axial * u) - two * u * across - lift * up * down;
        let f2 = lift * two * u - across - axial * axial;
        roots_about_start(f0 / lift, f1 / lift, f2 / lift)
    }
}

/// The modulus and kappa = sqrt(m g l (u3 - u1) / (2 I1)).
fn modulus_and_rate([low, high, top]: [fx128; 3], gravity: fx128) -> (Modulus, fx128) {
    let span = top - low;
    (Modulus::new((top - high) / span), Real::sqrt(gravity * span * fx128::from_f64(0.5)))
}

impl Nutation {
    fn new(ratio: fx128, gravity: fx128, q: Rotation<fx128>, omega: Vector3<fx128>) -> Self {
        let (one, half) = (fx128::ONE, fx128::from_f64(0.5));
        let Rotation { w, v } = q;
        let start = Start::new(ratio, q, omega);
        let roots = start.roots(gravity);
        let ([low, high, _], (modulus, kappa)) = (roots, modulus_and_rate(roots, gravity));
        let Start { up, down, u_rate, axial, vertical, .. } = start;
        let swing = high - low;
        let (above, below) = (up + low, down - low);
        let (sn, cn) = if swing.0 == 0.0 {
            (fx128::ZERO, one)
        } else {
            let sine = Real::sqrt(-low / swing);
            (if u_rate.0 < 0.0 { -sine } else { sine }, Real::sqrt(high / swing))
        };
        let spin = omega.z * (one - ratio) * half;
        let half_angle = |start: fx128, spin: fx128, rate: fx128, distance: fx128, nc: fx128| {
            let factor = rate * half / (kappa * distance);
            let complete = factor * complete_pi(nc, modulus.mc);
            let start = start - factor * pi_of(nc, sn, cn, modulus.mc);
            HalfAngle { start, spin, factor, nc, complete }
        };
        Self {
            above,
            below,
            swing,
            modulus,
            kappa,
            phase: f_of(sn, cn, modulus.mc),
            sum: half_angle(v.z.atan2(w), spin, vertical + axial, above, (up + high) / above),
            difference: half_angle(v.y.atan2(v.x), -spin, vertical - axial, below, (down - high) / below),
            vertical,
            axial,
        }
    }

    fn at(&self, t: fx128, omega_3: fx128) -> (Rotation<fx128>, Vector3<fx128>) {
        let half = fx128::from_f64(0.5);
        let (halves, functions) = self.modulus.reduced_at::<fx128>(self.kappa * t + self.phase);
        let Jacobi { sn, cn, dn } = functions;
        let rise = self.swing * sn * sn;
        let (up, down) = (self.above + rise, self.below - rise);
        let (p_sine, p_cosine) = self.sum.at(t, halves, functions, self.modulus.mc).sin_cos();
        let (d_sine, d_cosine) = self.difference.at(t, halves, functions, self.modulus.mc).sin_cos();
        let (cosine, sine) = (Real::sqrt(up * half), Real::sqrt(down * half));
        let q = Rotation { w: cosine * p_cosine, v: Vector3::new(sine * d_cosine, sine * d_sine, cosine * p_sine) };

        // omega across the axis, from what it does to the vertical (gx, gy, u) and from L_z.
        let u = if up.0 < down.0 { up - fx128::ONE } else { fx128::ONE - down };
        let u_rate = (self.kappa + self.kappa) * self.swing * sn * cn * dn;
        let (gx, gy) = vertical_in_body(q);
        let (along, square) = (self.vertical - self.axial * u, up * down);
        let omega = Vector3::new((along * gx - u_rate * gy) / square, (along * gy + u_rate * gx) / square, omega_3);
        (q, omega)
    }
}

impl HalfAngle {
    fn at(&self, t: fx128, halves: fx128, Jacobi { sn, cn, .. }: Jacobi<fx128>, mc: fx128) -> fx128 {
        self.start + self.spin * t + (halves + halves) * self.complete + self.factor * pi_of(self.nc, sn, cn, mc)
    }
}

/// The first two components of the world's vertical in the body frame.
fn vertical_in_body(Rotation { w, v }: Rotation<fx128>) -> (fx128, fx128) {
    let two = fx128::from_f64(2.0);
    (two * (v.x * v.z - w * v.y), two * (v.y * v.z + w * v.x))
}

/// The roots v1 <= 0 <= v2 <= v3 of f0 + f1 v + f2 v^2 + v^3, f0 >= 0.
///
/// v3 by Newton's method from above, where it falls monotonically; then (v - v3)(v^2 + p v + q) with
/// q = -f0 / v3 <= 0, p = (q - f1) / v3, whose roots need no subtraction.
fn roots_about_start(f0: fx128, f1: fx128, f2: fx128) -> [fx128; 3] {
    let half = fx128::from_f64(0.5);
    let mut top = fx128::from_f64(1.0 + f0.0.abs().max(f1.0.abs()).max(f2.0.abs()));
    for _ in 0..400 {
        let value = ((top + f2) * top + f1) * top + f0;
        let slope = (fx128::from_f64(3.0) * top + f2 + f2) * top + f1;
        let next = top - value / slope;
        if next >= top {
            break;
        }
        top = next;
    }
    let q = -f0 / top;
    let p = (q - f1) / top;
    let far = Real::sqrt(p * p * half * half - q) + Real::abs(p) * half;
    let near = if far.0 == 0.0 { far } else { -q / far };
    if p.0 > 0.0 { [-far, near, top] } else { [-near, far, top] }
}
