//! The exact motion of Lagrange's heavy symmetric top, spinning about a fixed point.
//!
//! J.-L. Lagrange, Mecanique analytique (1788), second part, section IX; the elliptic solution as in E. T. Whittaker, A
//! Treatise on the Analytical Dynamics of Particles and Rigid Bodies (1904), sections 71-72, with half-angles as in
//! F. Klein, A. Sommerfeld, Ueber die Theorie des Kreisels (1897): each needs one integral of the third kind.

use faer::fx128;
use integrator::real::{Real, Single};
use integrator::rotation::Rotation;
use nalgebra::Vector3;

use super::elliptic::{complete_pi, f_of, pi_of};
use super::jacobi::{Jacobi, Modulus};

/// A heavy top with moments (I1, I1, I3) about its fixed point and its centre of mass on the body's third axis.
///
/// With u = cos theta the height of the axis, u'^2 = (2 mgl / I1)(u - u1)(u - u2)(u - u3), u1 <= u <= u2 <= 1 <= u3:
/// u = u1 + (u2 - u1) sn^2(kappa t + phase), kappa = sqrt(mgl (u3 - u1) / (2 I1)), 1 - m = (u3 - u2) / (u3 - u1). The attitude is
/// (sqrt((1+u)/2) cos p, sqrt((1-u)/2) cos d, sqrt((1-u)/2) sin d, sqrt((1+u)/2) sin p), and p and d advance by L3 (1/I3 - 1/I1) t / 2 each
/// way and an integral of the third kind. All in double-double, so that f64 results are the exact ones rounded.
///
/// Fails (NaN) for mgl <= 0, and where the axis passes exactly through the vertical while it nutates; near it, digits are
/// lost in proportion to 1 / sin^2 theta.
#[derive(Clone, Copy, Debug)]
pub struct LagrangeTop {
    attitude0: Rotation<fx128>,
    omega0: Vector3<fx128>,
    /// None for a top that sleeps upright or hangs: a steady rotation.
    nutation: Option<Nutation>,
}

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
        let q = Rotation::from_wxyz(attitude0.map(fx128::from_f64));
        let omega = Vector3::from(omega_body0).map(fx128::from_f64);
        let tilted = (q.v.x.0 != 0.0 || q.v.y.0 != 0.0) && (q.w.0 != 0.0 || q.v.z.0 != 0.0);
        let nutates = tilted || omega.x.0 != 0.0 || omega.y.0 != 0.0;
        let [i1, i3, mgl] = [inertia_1, inertia_3, mgl].map(fx128::from_f64);
        Self { attitude0: q, omega0: omega, nutation: nutates.then(|| Nutation::new(i1, i3, mgl, q, omega)) }
    }

    /// Attitude (body to world) and angular velocity in the body frame (rad/s) at time t (s).
    pub fn at<T: Single>(&self, t: T) -> (Rotation<T>, Vector3<T>) {
        let t = t.widen();
        let (attitude, omega) = match &self.nutation {
            None => (self.attitude0 * Rotation::exp(self.omega0 * t), self.omega0),
            Some(nutation) => nutation.at(t, self.omega0.z),
        };
        (Rotation { w: T::narrow(attitude.w), v: attitude.v.map(T::narrow) }, omega.map(T::narrow))
    }
}

impl Nutation {
    fn new(i1: fx128, i3: fx128, mgl: fx128, q: Rotation<fx128>, omega: Vector3<fx128>) -> Self {
        let (one, two, half) = (fx128::ONE, fx128::from_f64(2.0), fx128::from_f64(0.5));
        let Rotation { w, v } = q;
        // 1 + u and 1 - u at the start, without the subtraction; the world's vertical in the body frame.
        let (up, down) = (two * (w * w + v.z * v.z), two * (v.x * v.x + v.y * v.y));
        let (gx, gy) = vertical_in_body(q);
        let u = if up.0 < down.0 { up - one } else { one - down };
        let u_rate = gx * omega.y - gy * omega.x;
        let axial = i3 * omega.z / i1;
        let vertical = gx * omega.x + gy * omega.y + axial * u;

        let lift = mgl * two / i1;
        let across = omega.x * omega.x + omega.y * omega.y;
        // u'^2 = f0 + f1 v + f2 v^2 + lift v^3 with v = u(t) - u(0): the constants do not cancel.
        let f0 = u_rate * u_rate;
        let f1 = two * axial * (vertical - axial * u) - two * u * across - lift * up * down;
        let f2 = lift * two * u - across - axial * axial;
        let [low, high, top] = roots_about_start(f0 / lift, f1 / lift, f2 / lift);

        let (swing, span) = (high - low, top - low);
        let modulus = Modulus::new((top - high) / span);
        let kappa = Real::sqrt(mgl * span / (two * i1));
        let (above, below) = (up + low, down - low);
        let (sn, cn) = if swing.0 == 0.0 {
            (fx128::ZERO, one)
        } else {
            let sine = Real::sqrt(-low / swing);
            (if u_rate.0 < 0.0 { -sine } else { sine }, Real::sqrt(high / swing))
        };
        let spin = i3 * omega.z * (one / i3 - one / i1) * half;
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
    for _ in 0..200 {
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
