//! The free top against its own equations of motion, in every regime and limit.
//!
//! What the tables cannot see: moments in any order, signs, nearly equal moments, the neighbourhood of the separatrix, long times.

use faer::fx128;
use integrator::real::{Real, Single};
use integrator::rotation::{Rotation, cross, dot};
use nalgebra::Vector3;
use proptest::prelude::*;
use scenes::special::free_top::FreeTop;
use scenes::special::symmetric_top::SymmetricTop;
use verification::derivative;

const EPS: f64 = <fx128 as Single>::EPSILON;

/// A body and its start.
#[derive(Clone, Copy, Debug)]
struct Body {
    inertia: [f64; 3],
    attitude: [f64; 4],
    omega: [f64; 3],
}

impl Body {
    fn top(&self) -> FreeTop {
        FreeTop::new(self.inertia, self.attitude, self.omega)
    }

    fn rate(&self) -> f64 {
        Vector3::from(self.omega).norm()
    }

    /// What |omega| cannot exceed at any time, by its energy: |omega0| sqrt(I_max / I_min).
    fn most_rate(&self) -> f64 {
        let inertia = Vector3::from(self.inertia);
        self.rate() * (inertia.max() / inertia.min()).sqrt()
    }
}

fn dd(x: f64) -> fx128 {
    fx128::from_f64(x)
}

/// The largest component, infinite if one is not a number.
fn largest(components: impl IntoIterator<Item = fx128>) -> f64 {
    components.into_iter().fold(0.0, |most, c| if c.is_finite() { c.0.abs().max(most) } else { f64::INFINITY })
}

fn apart(a: Rotation<fx128>, b: Rotation<fx128>) -> f64 {
    largest([a.w - b.w, a.v.x - b.v.x, a.v.y - b.v.y, a.v.z - b.v.z])
}

/// Moments that a body can have (each below the sum of the others), in any order: from masses spread along three axes.
fn moments() -> impl Strategy<Value = [f64; 3]> {
    let generic = [0.1..3.0_f64, 0.1..3.0_f64, 0.1..3.0_f64];
    let needle = [1e-4..1e-1_f64, 1e-4..1e-1_f64, 1.0..2.0_f64];
    let plate = [1e-5..1e-3_f64, 0.5..2.0_f64, 0.5..2.0_f64];
    let from_spread = |[a, b, c]: [f64; 3]| [b + c, c + a, a + b];
    let nearly = (-12.0..-3.0_f64, 0.5..2.0_f64, any::<bool>()).prop_map(|(p, axis, sphere)| {
        let close = 1.0 + 10.0_f64.powf(p);
        if sphere { [1.0, close, 1.0 + 0.7 * (close - 1.0)] } else { [1.0, axis, close] }
    });
    prop_oneof![
        generic.prop_map(from_spread),
        needle.prop_map(from_spread),
        plate.prop_map(from_spread),
        nearly,
        Just([1.0, 1.0, 0.5]),
        Just([2.0, 1.0, 2.0])
    ]
    .prop_flat_map(|moments| Just(moments.to_vec()).prop_shuffle())
    .prop_map(|v| [v[0], v[1], v[2]])
}

/// Random, near a principal axis (also the intermediate one), or at a relative distance of 1e-15 to 1e-2 from the separatrix.
fn body() -> impl Strategy<Value = Body> {
    let component = || prop_oneof![-2.0..-0.1_f64, 0.1..2.0_f64];
    let omega = [component(), component(), component()];
    let attitude = [component(), component(), component(), component()];
    (moments(), attitude, omega, 0..3_u8, 0..3_usize, -15.0..-2.0_f64).prop_map(
        |(inertia, attitude, omega, start, axis, p)| {
            let mut omega = omega;
            match start {
                0 => {}
                1 => (0..3).filter(|&i| i != axis).for_each(|i| omega[i] *= 10.0_f64.powf(0.5 * p)),
                _ => {
                    let mut order = [0, 1, 2];
                    order.sort_by(|&i, &j| inertia[i].total_cmp(&inertia[j]));
                    let [lo, mid, hi] = order.map(|i| inertia[i]);
                    let ratio = (lo * (mid - lo) / (hi * (hi - mid))).sqrt();
                    if ratio.is_finite() && ratio > 1e-3 && ratio < 1e3 {
                        omega[order[2]] = omega[order[0]] * ratio * (1.0 + 10.0_f64.powf(p));
                    }
                }
            }
            Body { inertia, attitude, omega }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// q' = q (0, omega) / 2 and I omega' = I omega x omega. With h |omega| <= 2^-12 and rates up to 4 |omega| (a body cannot
    /// wobble faster than it spins), the difference's error is (4 / 2^12)^8 * 4 / 630 = 5e-27 of |omega|; rounding adds 2^13
    /// times that of the values. h is dyadic: its multiples must be exact.
    #[test]
    fn attitude_and_omega_solve_the_equations_of_motion(body in body(), t in prop_oneof![-3.0..3.0_f64, -1e3..1e3_f64, -1e6..1e6_f64]) {
        let (top, rate) = (body.top(), body.rate());
        let (q, omega) = top.at(dd(t));
        let h = (-12.0 - rate.log2().ceil()).exp2();
        let slopes = derivative(h, |x| {
            let (q, w) = top.at(dd(t) + x);
            [q.w, q.v.x, q.v.y, q.v.z, w.x, w.y, w.z]
        });
        let kinematic = q * Rotation { w: fx128::ZERO, v: omega * dd(0.5) };
        let bound = 5e-27 + 8192.0 * 16.0 * EPS * (1.0 + rate * t.abs());
        let attitude_error = largest([slopes[0] - kinematic.w, slopes[1] - kinematic.v.x, slopes[2] - kinematic.v.y, slopes[3] - kinematic.v.z]);
        prop_assert!(attitude_error <= bound * rate, "q': {attitude_error:e}, bound {:e}", bound * rate);
        let inertia = Vector3::from(body.inertia).map(dd);
        let torque = cross(inertia.component_mul(&omega), omega).component_div(&inertia);
        let omega_error = largest((0..3).map(|i| slopes[4 + i] - torque[i]));
        prop_assert!(omega_error <= bound * rate * rate, "omega': {omega_error:e}, bound {:e}", bound * rate * rate);
    }

    #[test]
    fn the_motion_starts_where_it_is_told_to(body in body()) {
        let (q, omega) = body.top().at(fx128::ZERO);
        let attitude = Rotation::from_wxyz(body.attitude.map(dd));
        prop_assert!(apart(q, attitude) <= 32.0 * EPS, "{:e}", apart(q, attitude));
        prop_assert!(largest((0..3).map(|i| omega[i] - dd(body.omega[i]))) <= 64.0 * EPS * body.rate());
    }

    #[test]
    fn momentum_and_energy_are_those_of_the_start(body in body(), t in -1e6..1e6_f64) {
        let inertia = Vector3::from(body.inertia).map(dd);
        let momentum = |(q, w): (Rotation<fx128>, Vector3<fx128>)| q.rotate(inertia.component_mul(&w));
        let energy = |(_, w): (Rotation<fx128>, Vector3<fx128>)| dot(inertia.component_mul(&w), w);
        let top = body.top();
        let (first, later) = (top.at(fx128::ZERO), top.at(dd(t)));
        let (l, drift) = (momentum(first), momentum(later) - momentum(first));
        prop_assert!(largest(drift.iter().copied()) <= 64.0 * EPS * Real::sqrt(dot(l, l)).0, "{drift:?}");
        prop_assert!(largest([energy(later) - energy(first)]) <= 64.0 * EPS * energy(first).0);
    }

    /// Four products and a normalisation in f64, at any time: what grows with t is in double-double.
    #[test]
    fn f64_is_as_good_after_a_million_seconds_as_at_the_start(body in body(), t in prop_oneof![-3.0..3.0_f64, -1e3..1e3_f64, -1e6..1e6_f64]) {
        let top = body.top();
        let ((q, omega), (exact, omega_exact)) = (top.at(t), top.at(dd(t)));
        let wide = Rotation { w: dd(q.w), v: q.v.map(dd) };
        prop_assert!(apart(wide, exact) <= 4.0 * f64::EPSILON, "attitude {:e}", apart(wide, exact));
        let omega_error = largest((0..3).map(|i| omega.map(dd)[i] - omega_exact[i]));
        prop_assert!(omega_error <= 4.0 * f64::EPSILON * body.most_rate(), "omega {omega_error:e}");
    }

    #[test]
    fn the_attitude_never_jumps_sign(body in body(), t in -1e3..1e3_f64) {
        let top = body.top();
        let step = 0.25 / body.most_rate();
        let mut before = top.at(t).0;
        for i in 1..100 {
            let after = top.at(t + f64::from(i) * step).0;
            // The angle between them is 0.25 rad at most.
            prop_assert!(before.w * after.w + dot(before.v, after.v) > 0.99);
            before = after;
        }
    }

    #[test]
    fn two_equal_moments_give_the_symmetric_top(i1 in 0.5..2.0_f64, i3 in 0.1..3.0_f64, omega in [-2.0..2.0_f64, -2.0..2.0_f64, -2.0..2.0_f64], t in -1e4..1e4_f64) {
        let attitude = [0.5, -0.25, 1.0, 0.125];
        let (q, w) = FreeTop::new([i1, i1, i3], attitude, omega).at(dd(t));
        let (p, v) = SymmetricTop::new(i1, i3, attitude, omega).at(dd(t));
        // Both phases are formed in double-double: 2 T t / L and L t / I1.
        let bound = 64.0 * EPS * (4.0 + 8.0 * Vector3::from(omega).norm() * t.abs());
        prop_assert!(apart(q, p) <= bound, "{:e} {bound:e}", apart(q, p));
        prop_assert!(largest((0..3).map(|i| w[i] - v[i])) <= 2.0 * bound);
    }
}

#[test]
fn a_steady_rotation_about_any_axis_is_exponential() {
    let attitude = [0.5, -0.25, 1.0, 0.125];
    let cases = [
        ([1.0, 2.0, 3.0], [0.0, 1.5, 0.0]),
        ([1.0, 2.0, 3.0], [-1.5, 0.0, 0.0]),
        ([3.0, 2.0, 1.0], [0.0, 0.0, -0.75]),
        ([2.0, 2.0, 1.0], [0.5, -1.5, 0.0]),
        ([2.0, 2.0, 2.0], [0.5, -1.5, 0.25]),
        ([1.0, 2.0, 3.0], [0.0, 0.0, 0.0]),
    ];
    for (inertia, omega) in cases {
        for t in [0.0, 0.7, -1e5] {
            let (q, w) = FreeTop::new(inertia, attitude, omega).at(dd(t));
            let phi = Vector3::from(omega).map(dd) * dd(t);
            let exact = Rotation::from_wxyz(attitude.map(dd)) * Rotation::exp(phi);
            assert!(apart(q, exact) <= 8.0 * EPS, "{inertia:?} {omega:?} {t}");
            assert_eq!(w.map(|c| c.0), Vector3::from(omega));
        }
    }
}

/// I = (2, 3, 6), omega = (1.5, 0.25, w): D I_b = 18 w^2 - 4.5 exactly, zero at w = 1/2, which D = L^2 / I_b - 2 T in
/// double-double would only know to 1e-31, and mc to 1e-31 / mc.
#[test]
fn the_distance_from_the_separatrix_is_exact() {
    let top = |w: f64| FreeTop::new([2.0, 3.0, 6.0], [1.0, 0.0, 0.0, 0.0], [1.5, 0.25, w]);
    assert_eq!(top(0.5).complementary_parameter(), fx128::ZERO);
    assert_eq!(top(0.5).body_period(), fx128::INFINITY);
    // D I_b = 4.5 (2 e + e^2); d_bc = d_ab = 1/6, d_ac = 1/3, l = (3, 3/4, 6 w): mc = (D I_b / 3) / (C^2 / 6), C^2 = 36 w^2 + 9/32.
    let e = f64::EPSILON;
    let w = dd(0.5 * (1.0 + e));
    let expected = dd(4.5) * (dd(2.0) * dd(e) + dd(e) * dd(e)) * dd(2.0) / (dd(36.0) * w * w + dd(9.0 / 32.0));
    let error = top(w.0).complementary_parameter() / expected - dd(1.0);
    assert!(error.0.abs() <= 8.0 * EPS, "{error:?}");
}

#[test]
fn what_is_not_finite_stays_not_finite() {
    let (q, _) = FreeTop::new([1.0, 2.0, 3.0], [1.0, 0.0, 0.0, 0.0], [1.0, 0.5, 0.25]).at(f64::NAN);
    assert!(!q.is_finite());
    let (q, _) = FreeTop::new([1.0, 2.0, 3.0], [1.0, 0.0, 0.0, 0.0], [f64::NAN, 0.5, 0.25]).at(1.0);
    assert!(!q.is_finite());
}
