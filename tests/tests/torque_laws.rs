//! Exact motions under a torque against their own equations: Lagrange's heavy top, and a sphere under a constant torque.

use faer::fx128;
use integrator::real::Single;
use integrator::rotation::{Rotation, cross};
use nalgebra::Vector3;
use proptest::prelude::*;
use scenes::special::lagrange_top::LagrangeTop;
use scenes::special::sphere_torque::SphereTop;
use verification::derivative;

const EPS: f64 = <fx128 as Single>::EPSILON;

fn dd(x: f64) -> fx128 {
    fx128::from_f64(x)
}

/// The largest component, infinite if one is not a number.
fn largest(components: impl IntoIterator<Item = fx128>) -> f64 {
    components.into_iter().fold(0.0, |most, c| if c.is_finite() { c.0.abs().max(most) } else { f64::INFINITY })
}

/// q' - q (0, omega_body) / 2 at t by differences of step h.
fn kinematic_residual(h: f64, t: f64, omega_body: Vector3<fx128>, attitude: impl Fn(fx128) -> Rotation<fx128>) -> f64 {
    let slopes = derivative(h, |x| attitude(dd(t) + x).wxyz());
    let expected = (attitude(dd(t)) * Rotation { w: fx128::ZERO, v: omega_body * dd(0.5) }).wxyz();
    largest((0..4).map(|i| slopes[i] - expected[i]))
}

fn components(low: f64, high: f64) -> [std::ops::Range<f64>; 3] {
    [low..high, low..high, low..high]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// I omega' = I omega x omega + mgl (e3 x down). With h = 2^-14 / (rate of all that moves) the difference's error is
    /// (4 / 2^14)^8 / 100 = 1e-31 of the rate; rounding adds 2^14 times that of the values, which is eps / sin^2 theta.
    #[test]
    fn the_heavy_top_solves_its_equations_of_motion(
        i1 in 0.3..2.0_f64, i3 in 0.1..2.0_f64, mgl in 0.2..4.0_f64, omega in components(-6.0, 6.0),
        tilt in 0.2..1.3_f64, turn in components(-1.0, 1.0), t in -50.0..50.0_f64,
    ) {
        let attitude = [tilt.cos(), tilt.sin(), 0.25 * turn[0], 0.5 * turn[1]];
        let top = LagrangeTop::new(i1, i3, mgl, attitude, omega);
        let (q, w) = top.at(dd(t));
        let spin = Vector3::from(omega).norm() * (1.0 + i3 / i1) + (mgl / i1).sqrt();
        let vertical = q.rotate_back(Vector3::new(fx128::ZERO, fx128::ZERO, fx128::ONE));
        // The axis passes the vertical at a distance of sin theta >= |L_z - L_3 u| / I1 / |omega_perp|: the rate there, and its magnification.
        let nearest = (0..100).map(|k| { let g = top.at(t + f64::from(k - 50) * 0.04).0; 1.0 - (g.w * g.w + g.v.z * g.v.z - g.v.x * g.v.x - g.v.y * g.v.y).abs() })
            .fold(1.0, f64::min);
        prop_assume!(nearest > 0.02);
        let h = (-14.0 - (spin / nearest).log2().ceil()).exp2();
        let bound = 1e-30 * (spin / nearest) + 64.0 * EPS * (1.0 + spin * t.abs()) / (h * nearest * nearest);

        let error = kinematic_residual(h, t, w, |t| top.at(t).0);
        prop_assert!(error <= bound, "q': {error:e}, bound {bound:e}, near {nearest}");
        let slopes = derivative(h, |x| top.at(dd(t) + x).1.into());
        let inertia = Vector3::new(i1, i1, i3).map(dd);
        let torque = Vector3::new(vertical.y, -vertical.x, fx128::ZERO) * dd(mgl);
        let expected = (cross(inertia.component_mul(&w), w) + torque).component_div(&inertia);
        let error = largest((0..3).map(|i| slopes[i] - expected[i]));
        prop_assert!(error <= bound * spin, "omega': {error:e}, bound {:e}", bound * spin);
        // And it starts where it is told to.
        let (q0, w0) = top.at(fx128::ZERO);
        let start = Rotation::from_wxyz(attitude.map(dd)).wxyz();
        prop_assert!(largest((0..4).map(|i| q0.wxyz()[i] - start[i])) <= 256.0 * EPS / nearest);
        prop_assert!(largest((0..3).map(|i| w0[i] - dd(omega[i]))) <= 256.0 * EPS * spin / (nearest * nearest));
    }

    /// I omega' = tau in the world, q' = (0, omega_world) q / 2: with h = 2^-13 / |omega| as above.
    #[test]
    fn the_sphere_under_a_constant_torque_solves_its_equations_of_motion(
        inertia in 0.2..2.0_f64, omega in components(-2.0, 2.0), torque in components(-0.5, 0.5), t in -12.0..12.0_f64,
    ) {
        let attitude = [0.5, -0.25, 1.0, 0.125];
        let sphere = SphereTop::new(inertia, attitude, omega, torque);
        let (q, w) = sphere.at(dd(t));
        let rate = Vector3::from(omega).norm() + Vector3::from(torque).norm() / inertia * t.abs() + 1.0;
        let h = (-13.0 - rate.log2().ceil()).exp2();
        let error = kinematic_residual(h, t, q.rotate_back(w), |t| sphere.at(t).0);
        // The two solutions of Kummer's equation are larger than 1 where omega0 is across the torque: e^(pi |p|) at most.
        let across = Vector3::from(omega).cross(&Vector3::from(torque)).norm() / Vector3::from(torque).norm();
        let p = across * across * inertia / (8.0 * Vector3::from(torque).norm());
        let bound = 1e-29 * rate + 64.0 * EPS * (1.0 + rate * rate * 50.0) / h * (std::f64::consts::PI * p).exp().powi(2);
        prop_assume!(p < 3.0);
        prop_assert!(error <= bound, "{error:e}, bound {bound:e}");
        let expected = Vector3::from(omega).map(dd) + Vector3::from(torque).map(dd) * (dd(t) / dd(inertia));
        prop_assert!(largest((w - expected).iter().copied()) <= 8.0 * EPS * rate);
        let start = Rotation::from_wxyz(attitude.map(dd)).wxyz();
        let q0 = sphere.at(fx128::ZERO).0.wxyz();
        prop_assert!(largest((0..4).map(|i| q0[i] - start[i])) <= 1e3 * EPS * (std::f64::consts::PI * p).exp().powi(2));
    }
}

#[test]
fn a_top_on_the_vertical_without_nutation_sleeps() {
    let top = LagrangeTop::new(1.0, 0.5, 2.0, [0.6, 0.0, 0.0, 0.8], [0.0, 0.0, -7.0]);
    let (q, w) = top.at(0.75_f64);
    let exact = Rotation::from_wxyz([0.6, 0.0, 0.0, 0.8]) * Rotation::exp(Vector3::new(0.0, 0.0, -5.25));
    assert!(q.angle_to(exact) <= 8.0 * f64::EPSILON && w == Vector3::new(0.0, 0.0, -7.0));
}

/// With the axis horizontal (u = 0) the steady precession is Omega = mgl / L_3 = 2 / (0.5 * 8), about the body's second axis here.
#[test]
fn a_steady_precession_stays_steady() {
    let top = LagrangeTop::new(1.0, 0.5, 2.0, [1.0, 1.0, 0.0, 0.0], [0.0, 0.5, 8.0]);
    for t in 0..50 {
        let axis = top.at(f64::from(t)).0.rotate(Vector3::new(0.0, 0.0, 1.0));
        let angle = 0.5 * f64::from(t);
        let exact = Vector3::new(angle.sin(), -angle.cos(), 0.0);
        assert!((axis - exact).norm() <= 8.0 * f64::EPSILON, "{axis:?} at {t} s");
    }
}
