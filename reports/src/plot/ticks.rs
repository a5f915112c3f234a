//! Where the ticks of an axis stand and what they say.

use crate::Scale;

/// A labelled tick in mapped coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) at: f64,
    pub(super) label: String,
}

/// At most about `most` labelled ticks between the mapped ends, and the unlabelled ones between them.
pub(super) fn ticks(scale: Scale, low: f64, high: f64, most: usize) -> (Vec<Tick>, Vec<f64>) {
    match scale {
        Scale::Linear => (linear(low, high, most, 0), Vec::new()),
        Scale::Log => log(low, high, most),
    }
}

/// The integers k with low <= k * step <= high, a rounding error inside or out.
fn multiples(low: f64, high: f64, step: f64) -> Vec<f64> {
    let slack = 1e-9;
    let (first, last) = ((low / step - slack).ceil(), (high / step + slack).floor());
    let count = (last - first).clamp(-1.0, 1000.0);
    (0..=count as i64).map(|i| first + i as f64).take(if count < 0.0 { 0 } else { 1001 }).collect()
}

/// 1, 2 or 5 times a power of ten that is no less than `least`, given as digit and exponent.
fn nice_step(least: f64) -> (f64, i32) {
    let exponent = least.log10().floor() as i32;
    let choices = [(1.0, exponent), (2.0, exponent), (5.0, exponent), (1.0, exponent + 1)];
    let fits = |&&(digit, e): &&(f64, i32)| digit * power_of_ten(e) >= least * (1.0 - 1e-9);
    *choices.iter().find(fits).unwrap_or(&(1.0, exponent + 1))
}

/// Evenly spaced ticks from `low` to `high`; the labels name the values times 10^shift.
fn linear(low: f64, high: f64, most: usize, shift: i32) -> Vec<Tick> {
    // Between two numbers that differ by too little to be divided, or by more than there is, no step is nice.
    let least = (high - low) / most.max(2) as f64;
    if !(least > 0.0 && least.is_finite()) {
        return Vec::new();
    }
    let (digit, exponent) = nice_step(least);
    let step = digit * power_of_ten(exponent);
    let (unit, largest) = (exponent + shift, low.abs().max(high.abs()).log10().floor() as i32 + shift);
    let plain = (-4..=5).contains(&largest) && unit >= -5;
    // `multiple * digit` is an integer: the label is made from it and the exponent, not from a rounded product.
    let label = |multiple: f64| match multiple * digit {
        0.0 => "0".to_owned(),
        units if plain => fixed(units * power_of_ten(unit), -unit),
        units => scientific(units, unit, largest),
    };
    multiples(low, high, step).into_iter().map(|k| Tick { at: k * step, label: label(k) }).collect()
}

fn log(low: f64, high: f64, most: usize) -> (Vec<Tick>, Vec<f64>) {
    let decades = multiples(low, high, 1.0);
    if decades.len() < 2 {
        return within_a_decade(low, high, most);
    }
    let step = [1, 2, 3, 4, 5, 10, 20, 50, 100, 200].into_iter().find(|s| decades.len().div_ceil(*s) <= most.max(2));
    let step = step.unwrap_or(500) as i64;
    let labelled = |k: &&f64| (**k as i64).rem_euclid(step) == 0;
    let major = decades.iter().filter(labelled).map(|&k| Tick { at: k, label: format!("10{}", superscript(k as i64)) });
    let minor = if decades.len() <= 7 {
        let digits = |k: f64| (2..10).map(move |d| k + f64::from(d).log10());
        let below = decades[0] - 1.0;
        let all = std::iter::once(below).chain(decades.iter().copied()).flat_map(digits);
        all.filter(|&m| low <= m && m <= high).collect()
    } else {
        decades.iter().filter(|k| !labelled(k)).copied().collect()
    };
    (major.collect(), minor)
}

/// Fewer than two decades in sight: 1, 2, 5 of each, or evenly spaced numbers where even these are too few.
fn within_a_decade(low: f64, high: f64, most: usize) -> (Vec<Tick>, Vec<f64>) {
    let decade = (low + 1e-9).floor() as i32;
    let mut major = Vec::new();
    for exponent in decade..=decade + 2 {
        for digit in [1.0_f64, 2.0, 5.0] {
            let at = f64::from(exponent) + digit.log10();
            if low - 1e-9 <= at && at <= high + 1e-9 {
                let plain = (-3..=4).contains(&exponent);
                let value = digit * power_of_ten(exponent);
                let label = if plain { fixed(value, -exponent) } else { scientific(digit, exponent, exponent) };
                major.push(Tick { at, label });
            }
        }
    }
    if major.len() < 2 {
        // Ten to the power of the ends may overflow or vanish; less whole decades it does not.
        let [from, to] = [low, high].map(|end| 10_f64.powf(end - f64::from(decade)));
        let even = linear(from, to, most.min(6), decade);
        major = even.into_iter().map(|tick| Tick { at: f64::from(decade) + tick.at.log10(), ..tick }).collect();
    }
    (major, Vec::new())
}

/// 10^e, correctly rounded also below the reach of `powi`'s repeated products.
fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(if exponent < 0 { 0.0 } else { f64::INFINITY })
}

fn fixed(value: f64, decimals: i32) -> String {
    format!("{value:.*}", usize::try_from(decimals).unwrap_or(0)).replace('-', "−")
}

/// `units * 10^exponent` with the point after the digit that stands for 10^largest.
fn scientific(units: f64, exponent: i32, largest: i32) -> String {
    let mantissa = fixed(units * power_of_ten(exponent - largest), largest - exponent);
    match mantissa.as_str() {
        "1" => format!("10{}", superscript(i64::from(largest))),
        _ => format!("{mantissa}×10{}", superscript(i64::from(largest))),
    }
}

fn superscript(exponent: i64) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize]);
    exponent.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &[Tick]) -> Vec<&str> {
        ticks.iter().map(|tick| tick.label.as_str()).collect()
    }

    // Fails if: an axis about the least or the greatest of all numbers asks for digits without end.
    #[test]
    fn an_axis_at_the_ends_of_the_numbers_has_ticks_or_none() {
        for at in [5e-324_f64, 1e-320, f64::MIN_POSITIVE, 1e308, f64::MAX] {
            for width in [0.0, 1e-12, 0.1, 0.5, 3.0] {
                let at = at.log10();
                let (major, minor) = log(at - width, at + width, 8);
                assert!(major.iter().map(|tick| tick.at).chain(minor).all(f64::is_finite), "{at} {width}");
            }
            assert!(linear(-at, at, 8, 0).len() + linear(at, at, 8, 0).len() < 1001);
        }
    }

    #[test]
    fn decades_far_below_the_spacing_of_doubles_keep_their_ticks() {
        let (major, minor) = log(-32.0, -16.0, 20);
        let exponents: Vec<f64> = major.iter().map(|tick| tick.at).collect();
        assert_eq!(exponents, (-32..=-16).map(f64::from).collect::<Vec<_>>());
        assert_eq!((labels(&major)[0], labels(&major)[16]), ("10⁻³²", "10⁻¹⁶"));
        assert!(minor.is_empty());
    }

    #[test]
    fn labels_thin_out_to_what_fits_and_the_rest_become_minor_ticks() {
        let (major, minor) = log(-32.0, 1.0, 12);
        assert_eq!(
            labels(&major),
            ["10⁻³⁰", "10⁻²⁷", "10⁻²⁴", "10⁻²¹", "10⁻¹⁸", "10⁻¹⁵", "10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "10⁰"]
        );
        assert_eq!(major.len() + minor.len(), 34);
    }

    #[test]
    fn a_short_log_axis_has_eight_minor_ticks_a_decade() {
        let (major, minor) = log(-2.0, 0.0, 10);
        assert_eq!((major.len(), minor.len()), (3, 16));
        assert!(minor.contains(&(-1.0 + 5_f64.log10())), "{minor:?}");
    }

    #[test]
    fn less_than_a_decade_is_labelled_in_plain_numbers() {
        assert_eq!(labels(&log(0.15, 0.95, 10).0), ["2", "5"]);
        assert_eq!(labels(&log(2.0_f64.log10(), 2.5_f64.log10(), 6).0), ["2.0", "2.1", "2.2", "2.3", "2.4", "2.5"]);
    }

    // Ten to the power of -324 is zero as a double, and of 308.3 infinite.
    #[test]
    fn the_ends_of_the_doubles_are_labelled_too() {
        assert_eq!(
            labels(&log(-323.35, -323.25, 6).0),
            ["4.6×10⁻³²⁴", "4.8×10⁻³²⁴", "5.0×10⁻³²⁴", "5.2×10⁻³²⁴", "5.4×10⁻³²⁴", "5.6×10⁻³²⁴"]
        );
        assert_eq!(labels(&log(308.21, 308.31, 4).0), ["1.8×10³⁰⁸", "2.0×10³⁰⁸"]);
    }

    #[test]
    fn linear_labels_carry_the_digits_their_step_needs() {
        assert_eq!(
            labels(&linear(-0.5, 1.0, 5, 0)),
            ["−0.5", "0.0", "0.5", "1.0"].map(|l| if l == "0.0" { "0" } else { l })
        );
        assert_eq!(labels(&linear(0.0, 2e-7, 4, 0)), ["0", "0.5×10⁻⁷", "1.0×10⁻⁷", "1.5×10⁻⁷", "2.0×10⁻⁷"]);
        assert_eq!(labels(&linear(0.0, 100.0, 6, 0)), ["0", "20", "40", "60", "80", "100"]);
        assert_eq!(
            labels(&linear(0.0, 3e6, 4, 0)),
            ["0", "1×10⁶", "2×10⁶", "3×10⁶"].map(|l| if l == "1×10⁶" { "10⁶" } else { l })
        );
    }

    #[test]
    fn a_range_of_one_rounding_error_gives_a_finite_number_of_ticks() {
        assert!(linear(1.0, 1.0 + f64::EPSILON, 8, 0).len() <= 1001);
        assert!(multiples(5.0, 4.0, 1.0).is_empty());
    }
}
