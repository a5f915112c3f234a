//! The exact motions that the rigid-body scenes give: against 30-digit reference solutions, and against the equations of
//! motion that the same scenes give to the integrator, nearly degenerate settings included.

use faer::fx128;
use integrator::Vector;
use integrator::real::Single;
use integrator::rigid_body::{Kinematics, Torque};
use integrator::rotation::{Rotation, cross};
use nalgebra::Vector3;
use proptest::prelude::*;
use scenes::motion::RigidMotion;
use scenes::{BoxTumbling, HeavyTop, Manufactured, PrincipalAxisTorque, SphereTorque, SymmetricTop, TorqueFreeSpin};
use verification::derivative;
use verification::reference::{self, Reference};

const EPS: f64 = <fx128 as Single>::EPSILON;

fn dd(x: f64) -> fx128 {
    fx128::from_f64(x)
}

/// The largest component, infinite if one is not a number.
fn largest(components: impl IntoIterator<Item = fx128>) -> f64 {
    components.into_iter().fold(0.0, |most, c| if c.is_finite() { c.0.abs().max(most) } else { f64::INFINITY })
}

/// Attitude (nearer sign) and omega in the body frame of one set, 8 ulp in f64 and 1e-25 in double-double.
fn agrees<B: RigidMotion<f64> + RigidMotion<fx128>>(case: &Reference, body: &B) {
    for row in &case.rows {
        let single = RigidMotion::<f64>::exact(body, row.t);
        let double = RigidMotion::<fx128>::exact(body, dd(row.t));
        let (q, omega) = (case.values::<4>(row, "qw"), case.values::<3>(row, "wbx"));
        let size = largest(omega);
        let wide = [
            (single.attitude.wxyz().map(dd), single.omega_body.map(dd), 8.0 * f64::EPSILON),
            (double.attitude.wxyz(), double.omega_body, 1e-25),
        ];
        for (found, omega_found, bound) in wide {
            let apart = |sign: f64| largest((0..4).map(|i| found[i] - q[i] * dd(sign)));
            let attitude = apart(1.0).min(apart(-1.0));
            let angular = largest((0..3).map(|i| omega_found[i] - omega[i])) / size;
            assert!(attitude <= bound && angular <= bound, "t = {}: {attitude:e}, {angular:e} > {bound:e}", row.t);
        }
    }
}

#[test]
fn the_scenes_give_the_reference_solutions() {
    let each = |case: &'static str| reference::sets(case).into_iter().map(move |set| reference::load(case, &set));
    let mut sets = 0;
    for case in each("rigid_axis_torque") {
        let [axis, omega, torque] = ["axis", "w0", "tau"].map(|name| case.number(name));
        let (inertia, attitude) = (case.vector("I"), case.vector("q0"));
        agrees(&case, &PrincipalAxisTorque { inertia, axis, attitude, omega, torque });
        sets += 1;
    }
    for case in each("sphere_torque") {
        let (attitude, omega, torque) = (case.vector("q0"), case.vector("w0"), case.vector("tau"));
        agrees(&case, &SphereTorque { inertia: case.number("I"), attitude, omega, torque });
        sets += 1;
    }
    for case in each("symmetric_free") {
        let [inertia_1, inertia_3] = ["I1", "I3"].map(|name| case.number(name));
        let (attitude, omega) = (case.vector("q0"), case.vector("wb0"));
        agrees(&case, &SymmetricTop { inertia_1, inertia_3, attitude, omega });
        sets += 1;
    }
    for case in each("lagrange_top") {
        let [inertia_1, inertia_3, mgl] = ["I1", "I3", "mgl"].map(|name| case.number(name));
        let (attitude, omega) = (case.vector("q0"), case.vector("wb0"));
        agrees(&case, &HeavyTop { inertia_1, inertia_3, mgl, attitude, omega });
        sets += 1;
    }
    assert_eq!(sets, 8);
}

/// Largest residuals at t, by differences of step h: of q' = q (0, omega) / 2 and x' = v, and of I omega' = tau - omega x I omega
/// and v' = force / mass.
fn residuals<B: RigidMotion<fx128>>(body: &B, t: f64, h: f64) -> [f64; 2] {
    let at = |x: fx128| body.exact(dd(t) + x);
    let now = at(fx128::ZERO);
    let inertia = body.inertia();
    let momentum = inertia.component_mul(&now.omega_body);
    let torque = match body.torque(dd(t), &now) {
        Torque::None => Vector3::repeat(fx128::ZERO),
        Torque::World(torque) => now.attitude.rotate_back(torque),
        Torque::Body(torque) => torque,
    };
    let angular = (cross(momentum, now.omega_body) + torque).component_div(&inertia);
    let turning = (now.attitude * Rotation { w: fx128::ZERO, v: now.omega_body * dd(0.5) }).wxyz();
    let acceleration = body.acceleration(dd(t), &now);
    let slope_q = derivative(h, |x| at(x).attitude.wxyz());
    let slope_omega: [fx128; 3] = derivative(h, |x| at(x).omega_body.into());
    let component = |v: &B::Position, i: usize| if i < B::Position::DIM { v.component(i) } else { fx128::ZERO };
    let slope_x: [fx128; 3] = derivative(h, |x| std::array::from_fn(|i| component(&at(x).position, i)));
    let slope_v: [fx128; 3] = derivative(h, |x| std::array::from_fn(|i| component(&at(x).velocity, i)));
    let kinematic = largest((0..4).map(|i| slope_q[i] - turning[i]));
    let path = largest((0..3).map(|i| slope_x[i] - component(&now.velocity, i)));
    let dynamic = largest((0..3).map(|i| slope_omega[i] - angular[i]));
    let force = largest((0..3).map(|i| slope_v[i] - component(&acceleration, i)));
    [kinematic.max(path), dynamic.max(force)]
}

/// The largest dyadic step not above 2^-12 / rate. The difference's error is then (k 2^-12)^8 / 630 = 1e-27 of the value where
/// it moves with k = 4 times the rate; rounding adds 2^12 rate eps times the operations of the closed form, some 64.
fn step(rate: f64) -> f64 {
    (-12.0 - rate.log2().ceil()).exp2()
}

fn bound(rate: f64) -> f64 {
    (4.0 * 2.0_f64.powi(-12)).powi(8) / 630.0 * rate + 64.0 * EPS / step(rate)
}

fn solves<B: RigidMotion<fx128>>(body: &B, t: f64, rate: f64, size: f64) -> Result<(), TestCaseError> {
    let [kinematic, dynamic] = residuals(body, t, step(rate));
    let limit = bound(rate) * size;
    prop_assert!(kinematic <= limit, "q', x': {kinematic:e}, bound {limit:e}");
    prop_assert!(dynamic <= limit * rate, "omega', v': {dynamic:e}, bound {:e}", limit * rate);
    Ok(())
}

fn components(size: f64) -> [std::ops::Range<f64>; 3] {
    [-size..size, -size..size, -size..size]
}

/// Moments of a body that exists, from flat through generic to spherical within 1e-12.
fn inertia() -> impl Strategy<Value = [f64; 3]> {
    let near = (-12.0..-1.0_f64).prop_map(|p| 10.0_f64.powf(p));
    prop_oneof![
        (0.5..1.0_f64, 0.5..1.0_f64, 0.5..1.0_f64).prop_map(|(a, b, c)| [a, b, (a + b) * c]),
        near.clone().prop_map(|e| [1.0, 1.0 + e, 1.5]),
        (near.clone(), near).prop_map(|(e, f)| [1.25, 1.25 * (1.0 + e), 1.25 * (1.0 - f)]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_principal_axis_torque(
        inertia in inertia(), axis in 0..3_u8, omega in -4.0..4.0_f64, torque in -2.0..2.0_f64, t in -8.0..8.0_f64,
    ) {
        let body = PrincipalAxisTorque { inertia, axis: axis.into(), omega, torque, ..Default::default() };
        let alpha = torque.abs() / inertia[usize::from(axis)];
        solves(&body, t, 1.0 + omega.abs() + alpha * (1.0 + t.abs()), 1.0 + alpha * t * t)?;
    }

    #[test]
    fn a_free_body_of_any_moments(inertia in inertia(), omega in components(3.0), t in -8.0..8.0_f64) {
        let body = TorqueFreeSpin { inertia, omega, ..Default::default() };
        solves(&body, t, 2.0 + 2.0 * Vector3::from(omega).norm(), 1.0 + t.abs())?;
    }

    /// A relative distance of 1e-13 to 1e-2 from the separatrix, where
    /// I_lo omega_lo^2 (I_mid - I_lo) = I_hi omega_hi^2 (I_hi - I_mid).
    #[test]
    fn a_free_body_near_its_separatrix(near in -13.0..-2.0_f64, side in any::<bool>(), y in -2.0..2.0_f64, t in -4.0..4.0_f64) {
        let [low, middle, high] = [0.75, 1.25, 1.75];
        let ratio = f64::sqrt(high * (high - middle) / (low * (middle - low)));
        let off = 10.0_f64.powf(near) * if side { 1.0 } else { -1.0 };
        let body = TorqueFreeSpin { inertia: [low, middle, high], omega: [ratio * (1.0 + off), y, 1.0], ..Default::default() };
        solves(&body, t, 2.0 + 2.0 * Vector3::from(body.omega).norm(), 8.0)?;
    }

    #[test]
    fn a_symmetric_top(i1 in 0.5..2.0_f64, ratio in 0.01..2.0_f64, omega in components(3.0), t in -8.0..8.0_f64) {
        let body = SymmetricTop { inertia_1: i1, inertia_3: i1 * ratio, omega, ..Default::default() };
        solves(&body, t, 2.0 + 2.0 * Vector3::from(omega).norm(), 1.0 + t.abs())?;
    }

    /// The two solutions of Kummer's equation are e^(pi |p|) larger than their combination, and lose 1 + |Z| in segments.
    #[test]
    fn a_sphere_under_an_oblique_torque(omega in components(1.5), torque in components(1.0), t in -4.0..4.0_f64) {
        let strength = Vector3::from(torque).norm();
        let across = Vector3::from(omega).cross(&Vector3::from(torque)).norm() / strength;
        let body = SphereTorque { omega, torque, ..Default::default() };
        let p = across * across * body.inertia / (8.0 * strength);
        prop_assume!(p < 1.5);
        let rate = 1.0 + Vector3::from(omega).norm() + strength / body.inertia * (1.0 + t.abs());
        solves(&body, t, rate, 8.0 * (1.0 + rate * rate) * (2.0 * std::f64::consts::PI * p).exp())?;
    }

    /// Started at a turning point of the tilt: about e1 tilted, so that omega_1 = 0 keeps the tilt for the moment.
    #[test]
    fn a_heavy_top_from_a_turning_point(half in 0.3..1.2_f64, w2 in -2.0..2.0_f64, w3 in 2.0..6.0_f64, t in -3.0..3.0_f64) {
        let attitude = [half.cos(), half.sin(), 0.0, 0.0];
        let top = HeavyTop { attitude, omega: [0.0, w2, w3], ..Default::default() };
        heavy_top_solves(&top, t)?;
    }

    /// Started 1e-4 to 1e-1 rad from the vertical, stable (L3^2 > 4 I1 mgl, omega_3 > 4.71 rad/s) and unstable.
    #[test]
    fn a_heavy_top_near_sleep(tilt in -4.0..-1.0_f64, w3 in 2.0..12.0_f64, wobble in -1.0..1.0_f64, t in -3.0..3.0_f64) {
        let tilt = 10.0_f64.powf(tilt);
        let omega = [0.3 * tilt, wobble * tilt, w3];
        heavy_top_solves(&HeavyTop { attitude: [1.0, 0.5 * tilt, 0.0, 0.25], omega, ..Default::default() }, t)?;
    }

    #[test]
    fn a_manufactured_motion(
        x0 in components(2.0), swing in components(1.0), frequency in 0.5..3.0_f64, stiffness in 0.0..4.0_f64,
        thrust in -2.0..2.0_f64, coupling in -2.0..2.0_f64, t in -8.0..8.0_f64,
    ) {
        let body = Manufactured { x0, swing, frequency, stiffness, thrust, coupling, ..Default::default() };
        // |a| - |b| - |c| = 0.11 bounds |p| from below: the attitude swings that much faster than its frequency.
        solves(&body, t, frequency * 8.0, 16.0)?;
    }

    #[test]
    fn a_box_in_flight(omega in components(4.0), v0 in components(4.0), t in -2.0..2.0_f64) {
        solves(&BoxTumbling { omega, v0, ..Default::default() }, t, 12.0 + 2.0 * Vector3::from(omega).norm(), 40.0)?;
    }
}

/// The closed form loses digits as 1 / sin^2 of the smallest tilt on the way, and as 1 / delta of the distance between
/// the two upper roots, which is at least that of the squares of the tilt.
fn heavy_top_solves(top: &HeavyTop, t: f64) -> Result<(), TestCaseError> {
    let sine_squared = |k: i32| {
        let at: Kinematics<f64, _> = top.exact(t + f64::from(k) * 0.02);
        let up = at.attitude.rotate_back(Vector3::new(0.0, 0.0, 1.0));
        up.x * up.x + up.y * up.y
    };
    let nearest = (-100..100).map(sine_squared).fold(1.0, f64::min);
    prop_assume!(nearest > 1e-10);
    let rate = 2.0 * (1.0 + Vector3::from(top.omega).norm() + (top.mgl / top.inertia_1).sqrt());
    solves(top, t, rate, 8.0 / nearest)
}
