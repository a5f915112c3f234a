//! What a scene keeps account of: energy and momenta.

use faer::fx128;
use serde::{Deserialize, Serialize};

/// A quantity that a scene keeps account of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Balance {
    /// Kinetic plus potential energy, J.
    Energy,
    /// Linear momentum, kg m/s.
    Momentum,
    /// Angular momentum about the centre of mass, the fixed point or the centre of force, kg m^2/s.
    AngularMomentum,
}

impl Balance {
    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            Balance::Energy => "energy",
            Balance::Momentum => "momentum",
            Balance::AngularMomentum => "angular-momentum",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Balance::Energy => "J",
            Balance::Momentum => "kg m/s",
            Balance::AngularMomentum => "kg m^2/s",
        }
    }
}

/// One line of a scene's account.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What is accounted for.
    pub balance: Balance,
    /// Its value: one component for a scalar, three for a vector.
    pub value: Vec<fx128>,
    /// Whether the exact motion conserves it.
    pub conserved: bool,
}
