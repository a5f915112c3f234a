//! A large angle less its quarter turns.
//!
//! M. H. Payne, R. N. Hanek, Radian reduction for trigonometric functions, SIGNUM Newsletter 18 (1983) 19-24: only those bits of
//! 2 / pi are multiplied that do not make whole turns of the angle.

use qd::Quad as DoubleDouble;

/// Angles from here on are reduced here: 2^55.
pub(crate) const LARGE: f64 = 36_028_797_018_963_968.0;

/// 2 / pi = 0.w0 w1 w2 ... in words of 64 bits; the largest f64 meets the last of them.
#[rustfmt::skip]
const TWO_OVER_PI: [u64; 20] = [
    0xa2f9_836e_4e44_1529, 0xfc27_57d1_f534_ddc0, 0xdb62_9599_3c43_9041, 0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0, 0x0649_2eea_09d1_921c, 0xfe1d_eb1c_b129_a73e, 0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41, 0x3991_d639_8353_39f4, 0x9c84_5f8b_bdf9_283b, 0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f, 0x6d36_7ecf_27cb_09b7, 0x4f46_3f66_9e5f_ea2d, 0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea, 0x6bfb_5fb1_1f8d_5d08, 0x5603_3046_fc7b_6bab, 0xf0cf_bc20_9af4_361d,
];

/// Quarter turns modulo 4, and an angle below [`LARGE`] that is left, of any finite angle.
pub(crate) fn folded(x: DoubleDouble) -> (u64, DoubleDouble) {
    let fold = |part: f64| if part.abs() < LARGE { (0, DoubleDouble::from_f64(part)) } else { of_large(part) };
    let (high, low) = (fold(x.0), fold(x.1));
    ((high.0 + low.0) % 4, high.1.add_accurate(low.1))
}

/// |x| = m 2^e: the first e - 2 bits of 2 / pi make whole turns. The product of m with the next 256 bits, modulo 2^256, is
/// |x| modulo four quarter turns, in units of 2^-254, with an error below m.
fn of_large(x: f64) -> (u64, DoubleDouble) {
    let bits = x.abs().to_bits();
    let (mantissa, skipped) = ((bits & ((1 << 52) - 1)) | (1 << 52), (bits >> 52) as usize - 1077);
    let (word, shift) = (skipped / 64, skipped % 64);
    // Least significant word first.
    let window: [u64; 4] = std::array::from_fn(|i| {
        let at = word + 3 - i;
        if shift == 0 { TWO_OVER_PI[at] } else { TWO_OVER_PI[at] << shift | TWO_OVER_PI[at + 1] >> (64 - shift) }
    });
    let mut carry = 0;
    let mut product = window.map(|w| {
        let sum = u128::from(w) * u128::from(mantissa) + carry;
        carry = sum >> 64;
        sum as u64
    });
    let mut quarters = product[3] >> 62;
    // The fraction of a quarter turn, in units of 2^-256; above a half it is the next quarter turn less something.
    product = std::array::from_fn(|i| product[i] << 2 | if i == 0 { 0 } else { product[i - 1] >> 62 });
    let above = product[3] >> 63 == 1;
    if above {
        quarters += 1;
        product = product.map(|w| !w);
    }
    let fraction = product.iter().fold(DoubleDouble::ZERO, |sum, &w| {
        let halves = [(w & 0xffff_ffff) as f64, (w >> 32) as f64 * 4_294_967_296.0];
        let scaled = halves.iter().fold(sum, |sum, &half| sum.add_accurate(DoubleDouble::from_f64(half)));
        DoubleDouble(scaled.0 / 18_446_744_073_709_551_616.0, scaled.1 / 18_446_744_073_709_551_616.0)
    });
    let left = fraction * DoubleDouble::PI * DoubleDouble::from_f64(0.5);
    let negative = above != (x < 0.0);
    let quarters = if x < 0.0 { 8 - quarters } else { quarters };
    (quarters % 4, if negative { -left } else { left })
}
