//! A lane computes what one number alone computes, to the last bit: SIMD vectors have the bits of `f64`, and everything with
//! fused arithmetic those of `Fused<f64>`.

use integrator::Real;
use integrator::lanes::{Fused, Pack};
use wide::f64x4;

/// Arguments of both forms of the exponential's functions, on both sides of their bound 1/16, and mixed within a vector.
const FOURS: [[f64; 4]; 4] =
    [[0.0, 1e-9, 0.03, 0.0625], [0.07, 0.5, 3.0, 40.0], [0.0625, 0.06250001, 1e-3, 9.75], [2.0, 0.25, 0.04, 0.01]];

/// Every operation of [`Real`] on x and y; of the first result of a pair and of the second.
fn operations<T: Real>(x: T, y: T) -> [T; 9] {
    let ((cosine, sinc), (sine, cosine_of_x)) = (T::cos_sinc(x), x.sin_cos());
    [
        x.sqrt(),
        (-y).abs(),
        -x,
        x.mul_add(y, T::lit(-0.3)),
        cosine,
        sinc,
        sine,
        cosine_of_x,
        x * y + x / (y + T::lit(1.0)) - y,
    ]
}

/// `lanes` of what is `made` of four numbers, against `one` number at a time.
fn same_bits<T: Real, S: Real>(
    made: impl Fn([f64; 4]) -> T,
    lanes: impl Fn(T) -> [f64; 4],
    one: impl Fn(f64) -> S,
    plain: impl Fn(S) -> f64,
) {
    for (x, y) in FOURS.into_iter().flat_map(|x| FOURS.map(|y| (x, y))) {
        let wide = operations(made(x), made(y)).map(&lanes);
        for i in 0..4 {
            let single = operations(one(x[i]), one(y[i])).map(&plain);
            for (k, (got, expected)) in wide.iter().zip(single).enumerate() {
                assert_eq!(got[i].to_bits(), expected.to_bits(), "operation {k} of {} and {}", x[i], y[i]);
            }
        }
    }
}

#[test]
fn lanes_have_the_bits_of_single_numbers() {
    same_bits(f64x4::from, f64x4::to_array, |x| x, |x| x);
    same_bits(|x| Fused(f64x4::from(x)), |x| x.0.to_array(), Fused, |x| x.0);
    same_bits(Pack, |x| x.0, |x| x, |x| x);
    same_bits(|x| Pack(x.map(Fused)), |x| x.0.map(|y| y.0), Fused, |x| x.0);
    let halves = |x: [f64; 4]| Pack([f64x4::from(x), f64x4::from(x)].map(Fused));
    same_bits(halves, |x| x.0[0].0.to_array(), Fused, |x| x.0);
    same_bits(halves, |x| x.0[1].0.to_array(), Fused, |x| x.0);
}

/// (1 + e)(1 - e) - 1 = -e^2 is lost where the product is rounded by itself.
#[test]
fn fused_rounds_once_and_plain_lanes_twice() {
    let e = 2.0_f64.powi(-40);
    let probe = |lane: f64| Fused(1.0 + lane).mul_add(Fused(1.0 - lane), Fused(-1.0)).0;
    assert_eq!(probe(e), -e * e);
    let (a, b, c) = (f64x4::splat(1.0 + e), f64x4::splat(1.0 - e), f64x4::splat(-1.0));
    assert_eq!(Real::mul_add(a, b, c).to_array(), [0.0; 4]);
    assert_eq!(Fused(a).mul_add(Fused(b), Fused(c)).0.to_array(), [-e * e; 4]);
}

/// Fused values of the exponential's functions agree with plain ones to their roundings, on both sides of the bound.
#[test]
fn fused_functions_are_those_of_plain_numbers() {
    for x in FOURS.into_iter().flatten() {
        let ((a, b), (Fused(c), Fused(d))) = (f64::cos_sinc(x), Fused::<f64>::cos_sinc(Fused(x)));
        // The error of either is that of the doubled angle, about 2 |x| eps, and two roundings of a sum near 1.
        let tolerance = (4.0 * x.sqrt() + 4.0) * f64::EPSILON;
        assert!((a - c).abs() <= tolerance && (b - d).abs() <= tolerance, "{x}: {a} {c}, {b} {d}");
        assert_eq!(Fused(x).sin_cos().0.0, Real::sin_cos(x).0);
        assert_eq!((-Fused(x)).0.to_bits(), (-x).to_bits());
    }
}

#[test]
fn one_lane_that_is_not_finite_is_seen() {
    let finite = [1.0, -2.0, 0.0, 1e300];
    let check = |x: [f64; 4], expected: bool| {
        assert_eq!(Real::is_finite(f64x4::from(x)), expected);
        assert_eq!(Fused(f64x4::from(x)).is_finite(), expected);
        assert_eq!(Pack(x).is_finite(), expected);
        assert_eq!(Pack(x.map(Fused)).is_finite(), expected);
        assert_eq!(x.iter().all(|&lane| Fused(lane).is_finite()), expected);
    };
    check(finite, true);
    for (i, bad) in (0..4).flat_map(|i| [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|bad| (i, bad))) {
        let mut x = finite;
        x[i] = bad;
        check(x, false);
    }
}
