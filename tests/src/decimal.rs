//! Decimal numbers as double-double.

use faer::fx128;

/// The double-double nearest to a decimal number of at most 38 significant digits, to 2^-103 relative (two roundings).
///
/// # Panics
/// On anything but `[-]digits[.digits][e[-]digits]` or `inf`: a malformed table must not pass for a result.
pub fn parse_fx128(text: &str) -> fx128 {
    let (negative, unsigned) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
    let (mantissa, exponent) = unsigned.split_once(['e', 'E']).unwrap_or((unsigned, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let size = if unsigned == "inf" {
        fx128::INFINITY
    } else {
        let digits: u128 = format!("{whole}{fraction}").parse().unwrap_or_else(|_| panic!("not a decimal: {text:?}"));
        let exponent: i32 = exponent.parse().unwrap_or_else(|_| panic!("not a decimal: {text:?}"));
        scaled(from_u128(digits), exponent - i32::try_from(fraction.len()).expect("a short string"))
    };
    if negative { -size } else { size }
}

/// Exact up to 2^106, correctly rounded beyond.
fn from_u128(n: u128) -> fx128 {
    let high = n as f64;
    let rest = n.abs_diff(high as u128) as f64;
    fx128::from_f64(high) + fx128::from_f64(if high as u128 > n { -rest } else { rest })
}

/// x 10^exponent, by powers of ten of at most 10^45, which are exact in double-double.
fn scaled(x: fx128, exponent: i32) -> fx128 {
    let mut x = x;
    let mut left = exponent.abs();
    while left > 0 {
        let part = left.min(45);
        let power = (0..part).fold(fx128::ONE, |power, _| power * fx128::from_f64(10.0));
        x = if exponent < 0 { x / power } else { x * power };
        left -= part;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_read_to_the_last_bit_of_a_double_double() {
        assert_eq!(parse_fx128("-0.375"), fx128::from_f64(-0.375));
        assert_eq!(parse_fx128("1e45") / parse_fx128("1e23"), parse_fx128("1e22"));
        // 2^-60 + 1, exactly, and pi to 36 digits.
        let sum = parse_fx128("1.000000000000000000867361737988403547");
        assert_eq!((sum.0, sum.1.log2().round()), (1.0, -60.0));
        let error = parse_fx128("3.14159265358979323846264338327950288") - fx128::PI;
        assert!(error.0.abs() < 2.0 * fx128::EPSILON.0, "{error:?}");
        let small = parse_fx128("5.92059166791474166043151087544e-24") * parse_fx128("1e24");
        let error = small - parse_fx128("5.92059166791474166043151087544");
        assert!(error.0.abs() < 12.0 * fx128::EPSILON.0, "{error:?}");
    }

    #[test]
    #[should_panic(expected = "not a decimal")]
    fn a_malformed_number_is_refused() {
        parse_fx128("1.5x");
    }
}
