//! What an error is the error of.

use std::borrow::Cow;

use faer::fx128;
use scenes::any::AnyScene;
use scenes::invariants::Invariant;
use scenes::observation::{Observation, Quantity, Value, distance, largest};

/// A quantity whose error is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Of {
    /// Positions in m, attitudes and angles in rad; the larger number where a scene has both.
    #[default]
    Configuration,
    /// One quantity.
    Quantity(Quantity),
    /// The energy or a momentum. A vector counts with its direction.
    Invariant(Invariant),
}

impl Of {
    /// Every one that has a name.
    pub const NAMED: [Of; 7] = [
        Of::Quantity(Quantity::Position),
        Of::Quantity(Quantity::Velocity),
        Of::Quantity(Quantity::Attitude),
        Of::Quantity(Quantity::AngularVelocity),
        Of::Invariant(Invariant::Energy),
        Of::Invariant(Invariant::Momentum),
        Of::Invariant(Invariant::AngularMomentum),
    ];

    /// The name on the command line.
    pub fn id(self) -> &'static str {
        match self {
            Of::Configuration => "configuration",
            Of::Quantity(quantity) => quantity.id(),
            Of::Invariant(invariant) => invariant.id(),
        }
    }

    /// The values of the quantity at the time `t`; empty where the scene does not have it.
    pub fn values<'a>(self, scene: &dyn AnyScene, t: fx128, seen: &'a Observation) -> Vec<Cow<'a, Value>> {
        let chosen = |wanted: &dyn Fn(Quantity) -> bool| {
            seen.values.iter().filter(|(q, _)| wanted(*q)).map(|(_, value)| Cow::Borrowed(value)).collect()
        };
        match self {
            Of::Configuration => chosen(&|q| matches!(q, Quantity::Position | Quantity::Attitude)),
            Of::Quantity(quantity) => chosen(&|q| q == quantity),
            Of::Invariant(invariant) => {
                let entries =
                    scene.scene().invariants(t, seen).into_iter().filter(|entry| entry.invariant == invariant);
                entries.map(|entry| Cow::Owned(Value::Vector(entry.value))).collect()
            }
        }
    }

    /// The unit of the error, where it is the same on every scene.
    pub fn named_unit(self) -> Option<&'static str> {
        match self {
            Of::Configuration => None,
            Of::Quantity(quantity) => Some(quantity.unit()),
            Of::Invariant(invariant) => Some(invariant.unit()),
        }
    }

    /// The unit of the error on a scene that looks like this at its start.
    pub fn unit(self, start: &Observation) -> &'static str {
        match self {
            Of::Quantity(quantity) => quantity.unit(),
            Of::Invariant(invariant) => invariant.unit(),
            Of::Configuration => match [Quantity::Position, Quantity::Attitude].map(|q| start.get(q).is_some()) {
                [true, true] => "m and rad",
                [false, true] => "rad",
                _ => "m",
            },
        }
    }
}

/// The largest distance of two lists of values; NaN where one is not a number, or where there are none.
pub fn largest_distance(a: &[Cow<'_, Value>], b: &[Cow<'_, Value>]) -> f64 {
    largest(a.iter().zip(b).map(|(a, b)| distance(a, b))).unwrap_or(f64::NAN)
}
