//! Derivatives by differences, for the residual of an equation of motion.

use faer::fx128;

/// f'(0) by the central difference of order 8: 4/5, -1/5, 4/105, -1/280 of f(k h) - f(-k h), over h.
///
/// Its error is h^8 f''''''''' / 630 and rounding of the values over h. The step must be dyadic: its multiples are taken as exact.
pub fn derivative<const N: usize>(h: f64, f: impl Fn(fx128) -> [fx128; N]) -> [fx128; N] {
    let weight = |n: f64, d: f64| fx128::from_f64(n) / fx128::from_f64(d);
    let weights = [weight(4.0, 5.0), weight(-1.0, 5.0), weight(4.0, 105.0), weight(-1.0, 280.0)];
    let mut sum = [fx128::ZERO; N];
    for (k, &w) in weights.iter().enumerate() {
        let x = fx128::from_f64(h * (k as f64 + 1.0));
        let (ahead, behind) = (f(x), f(-x));
        for i in 0..N {
            sum[i] += w * (ahead[i] - behind[i]) / fx128::from_f64(h);
        }
    }
    sum
}
