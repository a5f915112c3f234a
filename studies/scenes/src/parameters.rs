//! Parameters of scenes: declared once, listed, parsed and checked by what the declaration says.

use crate::error::Error;

/// A parameter as a reader sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// The name after `--set`.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub about: &'static str,
    /// Its value; the components of a vector are separated by commas.
    pub value: String,
    /// The allowed values.
    pub range: Range,
}

/// The values allowed for a parameter (for each component of a vector).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Any finite number.
    Finite,
    /// Greater than zero.
    Positive,
    /// Zero or greater.
    NonNegative,
    /// At least the first and less than the second.
    HalfOpen(f64, f64),
    /// Between the two, ends included.
    Closed(f64, f64),
}

impl Range {
    /// Whether a number is allowed. Infinite numbers and NaN never are.
    pub fn contains(self, x: f64) -> bool {
        x.is_finite()
            && match self {
                Range::Finite => true,
                Range::Positive => x > 0.0,
                Range::NonNegative => x >= 0.0,
                Range::HalfOpen(low, high) => low <= x && x < high,
                Range::Closed(low, high) => low <= x && x <= high,
            }
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Range::Finite => write!(f, "finite"),
            Range::Positive => write!(f, "finite and > 0"),
            Range::NonNegative => write!(f, "finite and >= 0"),
            Range::HalfOpen(low, high) => write!(f, "in [{low}, {high})"),
            Range::Closed(low, high) => write!(f, "in [{low}, {high}]"),
        }
    }
}

/// A type that a parameter can have.
pub trait ParameterValue: Sized {
    /// From text; `None` if it is not of the form.
    fn parse(text: &str) -> Option<Self>;
    /// As text that [`Self::parse`] reads back to the same bits.
    fn show(&self) -> String;
    /// Every number in it.
    fn numbers(&self) -> Vec<f64>;
    /// The form, for an error message.
    fn form() -> String;
}

impl ParameterValue for f64 {
    fn parse(text: &str) -> Option<Self> {
        text.trim().parse().ok()
    }
    fn show(&self) -> String {
        self.to_string()
    }
    fn numbers(&self) -> Vec<f64> {
        vec![*self]
    }
    fn form() -> String {
        "a number".to_owned()
    }
}

impl<const N: usize> ParameterValue for [f64; N] {
    fn parse(text: &str) -> Option<Self> {
        let numbers: Option<Vec<f64>> = text.split(',').map(f64::parse).collect();
        numbers?.try_into().ok()
    }
    fn show(&self) -> String {
        self.map(|x| x.to_string()).join(",")
    }
    fn numbers(&self) -> Vec<f64> {
        self.to_vec()
    }
    fn form() -> String {
        format!("{N} numbers separated by commas")
    }
}

/// Parameters with names. `scene_parameters!` implements it.
pub trait Parameters {
    /// All of them.
    fn parameters(&self) -> Vec<Parameter>;

    /// Sets one from its text.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a value that is not of the form or outside the range, [`Error::UnknownName`] for a name
    /// that the scene does not have.
    fn set(&mut self, scene: &str, name: &str, text: &str) -> Result<(), Error>;
}

/// A parameter that stands for one of the scene's own: `of` = `factor` times what is given, with the scene's other parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Substitute {
    /// The name after `--set`.
    pub name: &'static str,
    /// The parameter that it sets.
    pub of: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub about: &'static str,
    /// What one of it makes of the parameter.
    pub factor: f64,
}

/// Reads a value and checks its range.
///
/// # Errors
/// [`Error::Parameter`], naming the parameter, the value and what is allowed.
pub fn read<V: ParameterValue>(scene: &str, name: &str, text: &str, range: Range) -> Result<V, Error> {
    let refuse = |expected: String| Error::Parameter {
        scene: scene.to_owned(),
        parameter: name.to_owned(),
        value: text.to_owned(),
        expected,
    };
    let value = V::parse(text).ok_or_else(|| refuse(format!("must be {}", V::form())))?;
    let allowed = value.numbers().into_iter().all(|x| range.contains(x));
    if allowed { Ok(value) } else { Err(refuse(format!("must be {range}"))) }
}

/// Declares a scene's parameters: `/// what it is` `name: type = default, "unit", range;`.
macro_rules! scene_parameters {
    (
        $(#[$doc:meta])*
        pub struct $scene:ident {
            $( #[doc = $about:literal] $name:ident: $type:ty = $default:expr, $unit:literal, $range:expr; )*
        }
    ) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $scene {
            $( #[doc = concat!($about, " Unit: ", $unit, ".")] pub $name: $type, )*
        }

        impl Default for $scene {
            fn default() -> Self {
                $scene { $( $name: $default, )* }
            }
        }

        impl $crate::parameters::Parameters for $scene {
            fn parameters(&self) -> Vec<$crate::parameters::Parameter> {
                use $crate::parameters::{Parameter, ParameterValue, Range};
                vec![$( Parameter {
                    name: stringify!($name),
                    unit: $unit,
                    about: $about.trim_ascii(),
                    value: self.$name.show(),
                    range: { use Range::*; $range },
                }, )*]
            }

            fn set(&mut self, scene: &str, name: &str, text: &str) -> Result<(), $crate::error::Error> {
                use $crate::parameters::Range;
                match name {
                    $( stringify!($name) => {
                        let range = { use Range::*; $range };
                        self.$name = $crate::parameters::read(scene, name, text, range)?;
                    } )*
                    _ => {
                        let known = [$( stringify!($name) ),*].map(str::to_owned);
                        return Err($crate::error::Error::unknown("parameter", name, known));
                    }
                }
                Ok(())
            }
        }
    };
}
pub(crate) use scene_parameters;
