//! Numbers with their units, as the command line takes them: `1deg`, `2min`, `100rev`, `1/60`.

use measure::study::Length;

/// A unit, the unit that it is counted in, and how many of that it is.
struct Unit {
    name: &'static str,
    base: &'static str,
    factor: f64,
}

const fn unit(name: &'static str, base: &'static str, factor: f64) -> Unit {
    Unit { name, base, factor }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Of times.
const TIMES: [Unit; 8] = [
    unit("s", "s", 1.0),
    unit("ms", "s", 1e-3),
    unit("us", "s", 1e-6),
    unit("min", "s", 60.0),
    unit("h", "s", 3600.0),
    unit("rev", "periods", 1.0),
    unit("period", "periods", 1.0),
    unit("periods", "periods", 1.0),
];

/// Of errors. The bases are the units of the quantities.
const ERRORS: [Unit; 17] = [
    unit("m", "m", 1.0),
    unit("cm", "m", 1e-2),
    unit("mm", "m", 1e-3),
    unit("um", "m", 1e-6),
    unit("km", "m", 1e3),
    unit("rad", "rad", 1.0),
    unit("mrad", "rad", 1e-3),
    unit("deg", "rad", DEGREE),
    unit("m/s", "m/s", 1.0),
    unit("mm/s", "m/s", 1e-3),
    unit("rad/s", "rad/s", 1.0),
    unit("deg/s", "rad/s", DEGREE),
    unit("J", "J", 1.0),
    unit("mJ", "J", 1e-3),
    unit("kg m/s", "kg m/s", 1.0),
    unit("kg m^2/s", "kg m^2/s", 1.0),
    unit("%", "%", 1e-2),
];

/// The longest beginning that is a number, and the rest without the blanks between the two; `None` where no number begins it.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    // `inf` and `nan` are no numbers here, and a unit may begin with `e`.
    let ends = text.char_indices().map(|(at, letter)| at + letter.len_utf8()).collect::<Vec<_>>();
    ends.into_iter().rev().find_map(|end| {
        let (number, rest) = text.split_at(end);
        let rest = rest.trim();
        // '//60' is no unit: a name does not begin with a sign.
        let is_split = number.ends_with(|c: char| c.is_ascii_digit() || c == '.') && !rest.starts_with('/');
        is_split.then(|| fraction(number))?.map(|x| (x, rest))
    })
}

/// `0.5`, `1e-3` or `1/60`.
fn fraction(text: &str) -> Option<f64> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    match text.split_once('/') {
        Some((above, below)) => Some(number(above)? / number(below)?),
        None => number(text),
    }
}

/// The number in the base of its unit, and that base; `None` for a number without a unit.
fn measured(text: &str, units: &'static [Unit], such_as: &str) -> Result<(f64, Option<&'static str>), String> {
    let refuse = || format!("not a positive number; give {such_as}");
    let (number, name) = split(text).ok_or_else(refuse)?;
    let (value, base) = if name.is_empty() {
        (number, None)
    } else {
        let known = units.iter().map(|unit| unit.name.to_owned());
        let unit = units
            .iter()
            .find(|unit| unit.name == name)
            .ok_or_else(|| scenes::error::Error::unknown("unit", name, known).to_string())?;
        (number * unit.factor, Some(unit.base))
    };
    if value.is_finite() && value > 0.0 { Ok((value, base)) } else { Err(refuse()) }
}

/// Seconds: `0.01`, `1/60`, `5ms`.
///
/// # Errors
/// No positive time.
pub fn seconds(text: &str) -> Result<f64, String> {
    match length(text, "seconds, such as 0.01 or 1/60")? {
        Length::Seconds(s) => Ok(s),
        Length::Periods(_) => Err("periods are no unit of a step; give seconds, such as 0.01 or 1/60".to_owned()),
    }
}

/// The length of a run: seconds, `2min`, `100rev`.
///
/// # Errors
/// No positive length.
pub fn length(text: &str, such_as: &str) -> Result<Length, String> {
    Ok(match measured(text, &TIMES, such_as)? {
        (periods, Some("periods")) => Length::Periods(periods),
        (s, _) => Length::Seconds(s),
    })
}

/// The size of an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorSize {
    /// In the base of its unit, or as a part where that is `%`.
    pub value: f64,
    /// `m`, `rad`, `m/s`, ..., or `%`; `None` where none is given.
    pub base: Option<&'static str>,
}

/// An error: `1e-3`, `1deg`, `5mm`, `1%`.
///
/// # Errors
/// No positive error, or an unknown unit.
pub fn error_size(text: &str) -> Result<ErrorSize, String> {
    let (value, base) = measured(text, &ERRORS, "an error such as 1e-3, 1deg, 5mm or 1%")?;
    Ok(ErrorSize { value, base })
}

#[cfg(test)]
mod tests {
    use super::*;

    // Fails if: a unit is cut from the wrong place, a factor is wrong, or the words of a wrong unit lead nowhere.
    #[test]
    fn numbers_are_read_with_their_units() {
        assert_eq!(seconds("1/60"), Ok(1.0 / 60.0));
        assert_eq!(seconds(" 5 ms "), Ok(5e-3));
        assert_eq!(seconds("1e-3s"), Ok(1e-3));
        let for_ = |text| length(text, "seconds");
        assert_eq!(for_("2min"), Ok(Length::Seconds(120.0)));
        assert_eq!(for_("0.5h"), Ok(Length::Seconds(1800.0)));
        assert_eq!(for_("100rev"), Ok(Length::Periods(100.0)));
        assert_eq!(for_("1 period"), Ok(Length::Periods(1.0)));
        let error = |text: &str| error_size(text).map(|size| (size.value, size.base));
        assert_eq!(error("180deg"), Ok((180.0 * DEGREE, Some("rad"))));
        assert_eq!(error("1e-3"), Ok((1e-3, None)));
        assert_eq!(error("5e-1mm"), Ok((5e-4, Some("m"))));
        assert_eq!(error("1%"), Ok((1e-2, Some("%"))));
        assert_eq!(error("2 kg m^2/s"), Ok((2.0, Some("kg m^2/s"))));
    }

    #[test]
    fn what_is_no_number_or_no_unit_is_refused() {
        for text in ["", "m", "-1m", "0", "NaN", "inf", "1e999", "1/0", "0/1", "1//60", "--", "deg1"] {
            assert!(error_size(text).is_err_and(|words| words.starts_with("not a positive number; give")), "{text}");
            assert!(seconds(text).is_err(), "{text}");
        }
        let words = error_size("1dge").expect_err("no unit");
        assert!(words.starts_with("unit 'dge': unknown; did you mean 'deg'? known: m, cm"), "{words}");
        let words = length("2mins", "").expect_err("no unit");
        assert!(words.contains("did you mean 'min'?"), "{words}");
        assert!(seconds("3rev").is_err_and(|words| words.starts_with("periods are no unit of a step")));
    }
}
