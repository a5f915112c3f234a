//! The exact motion of a rigid body without torque: any principal moments, any start.
//!
//! C. G. J. Jacobi, Sur la rotation d'un corps, J. reine angew. Math. 39 (1849) 293-350, in a form where nothing cancels:
//! E. Celledoni, F. Fasso, N. Saefstroem, A. Zanna, The exact computation of the free rigid body motion and its use in
//! splitting methods, SIAM J. Sci. Comput. 30 (2008) 2084-2112, is the nearest published one.
//!
//! With l = I omega (body frame), J = 1 / I and axes (a, b, c) where b is the intermediate axis and l circulates about c:
//! `l = (A cn u, s B sn u, C dn u)`, u = lambda t + u0. The attitude is q = q0 . p(0)* . Rz(chi) . p(t), where p is the
//! shortest rotation of l / L onto c and chi the angle about the fixed momentum.

use faer::fx128;
use integrator::real::{Real, Single};
use integrator::rotation::Rotation;
use nalgebra::Vector3;

use super::elementary::asinh;
use super::elliptic::{complete_pi, f_of, pi_of};
use super::expansion::Expansion;
use super::jacobi::{Jacobi, Modulus, parity};

/// A torque-free rigid body, ready to be evaluated at any time.
///
/// The set-up is in double-double from the exact f64 inputs, and the distance from the separatrix is exact. Error of the
/// attitude (measured): f64 below 1e-15 at any |t| where double-double resolves the phase, double-double about
/// 1e-32 times the larger of 10 and the angle turned through, 2 T t / L.
#[derive(Clone, Copy, Debug)]
pub struct FreeTop {
    /// Attitude at t = 0, body to world.
    attitude0: Rotation<fx128>,
    /// Angular velocity at t = 0 in the body frame, rad/s.
    omega0: Vector3<f64>,
    /// None if omega is constant.
    precession: Option<Precession>,
}

impl FreeTop {
    /// Principal moments (kg m^2, any order, positive), attitude (w, x, y, z) normalised in double-double, and angular
    /// velocity in the body frame (rad/s). Inputs that are not finite, or moments that are not positive, give NaN.
    pub fn new(inertia: [f64; 3], attitude0: [f64; 4], omega_body0: [f64; 3]) -> Self {
        let [w0, w1, w2] = omega_body0;
        let couples = |i: usize, j: usize, a: f64, b: f64| inertia[i] != inertia[j] && a != 0.0 && b != 0.0;
        // l x omega = 0 exactly: a principal axis (of possibly equal moments).
        let wobbles = couples(0, 1, w0, w1) || couples(1, 2, w1, w2) || couples(2, 0, w2, w0);
        Self {
            attitude0: Rotation::from_wxyz(attitude0.map(fx128::from_f64)),
            omega0: Vector3::from(omega_body0),
            precession: wobbles.then(|| Precession::new(inertia, omega_body0)),
        }
    }

    /// Attitude (body to world) and angular velocity in the body frame (rad/s) at time t (s).
    pub fn at<T: Single>(&self, t: T) -> (Rotation<T>, Vector3<T>) {
        let t = t.widen();
        let Some(precession) = &self.precession else {
            let attitude = self.attitude0 * Rotation::exp(self.omega0.map(fx128::from_f64) * t);
            return (narrow(attitude), self.omega0.map(T::lit));
        };
        let (turn, omega) = precession.at::<T>(t);
        ((narrow::<T>(self.attitude0) * turn).normalized(), omega)
    }

    /// The time in which omega_body comes back (s): infinite on the separatrix, zero for a steady rotation.
    pub fn body_period(&self) -> fx128 {
        match &self.precession {
            None => fx128::ZERO,
            Some(p) if p.modulus.mc.0 == 0.0 => fx128::INFINITY,
            Some(p) => fx128::from_f64(4.0) * p.modulus.quarter_period() / p.lambda,
        }
    }

    /// The complementary parameter mc = 1 - m of the motion in [0, 1]; 0 on the separatrix, 1 for a steady rotation.
    pub fn complementary_parameter(&self) -> fx128 {
        self.precession.as_ref().map_or(fx128::ONE, |p| p.modulus.mc)
    }
}

fn narrow<T: Single>(q: Rotation<fx128>) -> Rotation<T> {
    Rotation { w: T::narrow(q.w), v: q.v.map(T::narrow) }
}

/// Axes (a, b, c) as a signed permutation of the body's, of determinant +1, with l_a >= 0 and l_c > 0.
#[derive(Clone, Copy, Debug)]
struct Axes {
    index: [usize; 3],
    sign: [f64; 3],
}

impl Axes {
    fn new(index: [usize; 3], omega: [f64; 3]) -> Self {
        let sign_of = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        let parity = if (index[1] + 3 - index[0]) % 3 == 1 { 1.0 } else { -1.0 };
        let (a, c) = (sign_of(omega[index[0]]), sign_of(omega[index[2]]));
        Self { index, sign: [a, parity * a * c, c] }
    }

    fn canonical<T: Real>(self, v: Vector3<T>) -> Vector3<T> {
        Vector3::from_fn(|i, _| v[self.index[i]] * T::lit(self.sign[i]))
    }

    fn body<T: Real>(self, v: Vector3<T>) -> Vector3<T> {
        let mut body = v;
        for i in 0..3 {
            body[self.index[i]] = v[i] * T::lit(self.sign[i]);
        }
        body
    }
}

/// The motion in the axes (a, b, c), all constants in double-double.
#[derive(Clone, Copy, Debug)]
struct Precession {
    axes: Axes,
    /// Moments along a, b, c.
    inertia: Vector3<f64>,
    /// s = +1 if l circulates about the axis of the largest moment, -1 about that of the smallest.
    sense: f64,
    /// |J_a - J_b|, |J_a - J_c|, |J_b - J_c|.
    spread: Spread,
    /// L = |l|.
    momentum: fx128,
    /// A, B / A = sqrt(d_ac / d_bc), C of l = (A cn, s B sn, C dn).
    amplitude: fx128,
    ratio: fx128,
    offset: fx128,
    /// |L^2 J_b - 2 T|.
    distance: fx128,
    modulus: Modulus,
    /// u = lambda t + u0.
    lambda: fx128,
    u0: fx128,
    /// 2 T / L, rad/s.
    rate: fx128,
    /// Factor and complementary characteristic of Legendre's third integral in chi.
    kappa: fx128,
    nc: fx128,
    /// kappa Pi(pi/2), and kappa Pi(u0) - alpha(u0).
    complete: fx128,
    twist0: fx128,
    /// p(0)*.
    start: Rotation<fx128>,
}

#[derive(Clone, Copy, Debug)]
struct Spread {
    ab: fx128,
    ac: fx128,
    bc: fx128,
}

impl Precession {
    fn new(inertia: [f64; 3], omega: [f64; 3]) -> Self {
        let (index, sense, distance) = regime(inertia, omega);
        let axes = Axes::new(index, omega);
        let inertia = Vector3::from_fn(|i, _| inertia[index[i]]);
        let omega = axes.canonical(Vector3::from(omega).map(fx128::from_f64));
        let spread = Spread::new(inertia);
        let l = inertia.map(fx128::from_f64).component_mul(&omega);
        let square = l.component_mul(&l);
        let momentum = Real::sqrt(square.x + square.y + square.z);

        let ratio = Real::sqrt(spread.ac / spread.bc);
        let amplitude = Real::sqrt(square.x + square.y * spread.bc / spread.ac);
        let offset_squared = square.z + square.y * spread.ab / spread.ac;
        let offset = Real::sqrt(offset_squared);
        let modulus = Modulus::new(distance / (offset_squared * spread.bc));
        let (mc, nc) = (modulus.mc, modulus.mc / (ratio * ratio));
        let mut motion = Self {
            axes,
            inertia,
            sense,
            spread,
            momentum,
            amplitude,
            ratio,
            offset,
            distance,
            modulus,
            lambda: offset * Real::sqrt(spread.ac * spread.bc),
            u0: fx128::ZERO,
            rate: (l.x * omega.x + l.y * omega.y + l.z * omega.z) / momentum,
            kappa: offset / momentum * mc / ratio,
            nc,
            complete: fx128::ZERO,
            twist0: fx128::ZERO,
            start: to_third_axis(l, momentum).conjugate(),
        };
        motion.set_phase(l);
        motion
    }

    /// The constants that depend on where on its curve l starts.
    fn set_phase(&mut self, l: Vector3<fx128>) {
        let (sine, cosine) = (fx128::from_f64(self.sense) * l.y / self.ratio, l.x);
        let start = if self.amplitude.0 == 0.0 {
            Jacobi { sn: fx128::ZERO, cn: fx128::ONE, dn: l.z / self.offset }
        } else {
            Jacobi { sn: sine / self.amplitude, cn: cosine / self.amplitude, dn: l.z / self.offset }
        };
        let mc = self.modulus.mc;
        if mc.0 == 0.0 {
            self.u0 = asinh(start.sn / start.cn);
        } else {
            self.u0 = f_of(start.sn, start.cn, mc);
            self.complete = self.kappa * complete_pi(self.nc, mc);
        }
        self.twist0 = self.twist(start);
    }

    /// The rotation p(0)* . Rz(chi) . p(t) and omega at time t, both in the body's axes.
    fn at<T: Single>(&self, t: fx128) -> (Rotation<T>, Vector3<T>) {
        let (halves, functions) = self.modulus.reduced_at::<T>(self.lambda * t + self.u0);
        let Jacobi { sn, cn, dn } = functions;
        let amplitude = T::narrow(self.amplitude) * T::lit(parity(halves));
        let side = T::lit(self.sense) * amplitude * T::narrow(self.ratio) * sn;
        let l = Vector3::new(amplitude * cn, side, T::narrow(self.offset) * dn);

        let turns = halves * (self.complete + self.complete - fx128::PI);
        let twist = turns + (self.twist(functions).widen() - self.twist0);
        let chi = self.rate * t + fx128::from_f64(self.sense) * twist;
        let (sine, cosine) = (chi * fx128::from_f64(0.5)).sin_cos();
        let about_l = Rotation { w: T::narrow(cosine), v: Vector3::new(T::lit(0.0), T::lit(0.0), T::narrow(sine)) };
        let turn = narrow::<T>(self.start) * about_l * to_third_axis(l, T::narrow(self.momentum));
        let omega = l.component_div(&self.inertia.map(T::lit));
        (Rotation { w: turn.w, v: self.axes.body(turn.v) }, self.axes.body(omega))
    }

    /// kappa Pi - alpha at |u| <= K. Both swing fast near the separatrix; only their difference, from one set of
    /// sn, cn, dn, is well conditioned.
    ///
    /// alpha = atan2(S sn (|D|/dn + L C d_bc), (cn/dn) (C dn (L + C dn) d_ac + l_b^2 d_ab)), S = B / A.
    fn twist<T: Single>(&self, Jacobi { sn, cn, dn }: Jacobi<T>) -> T {
        let [ratio, l, c, ab, ac, bc] =
            [self.ratio, self.momentum, self.offset, self.spread.ab, self.spread.ac, self.spread.bc].map(T::narrow);
        let separatrix = self.modulus.mc.0 == 0.0;
        // On the separatrix cn = dn = sech u, which underflows in the end; their ratio does not.
        let (cd, distance) =
            if separatrix { (T::lit(1.0), T::lit(0.0)) } else { (cn / dn, T::narrow(self.distance) / dn) };
        let l_b = T::narrow(self.amplitude) * ratio * sn;
        let alpha = (ratio * sn * (distance + l * c * bc)).atan2(cd * (c * dn * (l + c * dn) * ac + l_b * l_b * ab));
        if separatrix {
            return -alpha;
        }
        T::narrow(self.kappa) * pi_of(T::narrow(self.nc), sn, cn, T::narrow(self.modulus.mc)) - alpha
    }
}

impl Spread {
    /// J_i - J_j = (I_j - I_i) / (I_i I_j), in which nothing cancels but the exact difference.
    fn new(inertia: Vector3<f64>) -> Self {
        let wide = inertia.map(fx128::from_f64);
        let between = |i: usize, j: usize| Real::abs(wide[j] - wide[i]) / (wide[i] * wide[j]);
        Self { ab: between(0, 1), ac: between(0, 2), bc: between(1, 2) }
    }
}

/// The body axes to be called (a, b, c), s, and |D| with D = L^2 J_b - 2 T, whose sign tells about which axis l circulates.
///
/// D I_b = I_hi w_hi^2 (I_hi - I_b) - I_lo w_lo^2 (I_b - I_lo), a polynomial of the inputs, is computed exactly.
fn regime(inertia: [f64; 3], omega: [f64; 3]) -> ([usize; 3], f64, fx128) {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| inertia[i].total_cmp(&inertia[j]));
    let [low, middle, high] = order;
    let term = |i: usize, large: usize, small: usize| {
        let difference = Expansion::sum(inertia[large], -inertia[small]);
        difference.times(inertia[i]).times(omega[i]).times(omega[i])
    };
    let d = term(high, high, middle).minus(&term(low, middle, low)).rounded() / fx128::from_f64(inertia[middle]);
    if d.0 < 0.0 { ([high, middle, low], -1.0, -d) } else { ([low, middle, high], 1.0, d) }
}

/// The shortest rotation of l onto the third axis, l_z > 0: (h, l_y / (2 h L), -l_x / (2 h L), 0), h = sqrt((1 + l_z / L) / 2).
fn to_third_axis<T: Real>(l: Vector3<T>, momentum: T) -> Rotation<T> {
    let h = ((T::lit(1.0) + l.z / momentum) * T::lit(0.5)).sqrt();
    let scale = T::lit(0.5) / (h * momentum);
    Rotation { w: h, v: Vector3::new(l.y * scale, -l.x * scale, T::lit(0.0)) }
}
