//! The invariants of a scene: energy and momenta.

use faer::fx128;
use serde::{Deserialize, Serialize};

/// An energy or a momentum of a scene, conserved or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Invariant {
    /// Kinetic plus potential energy, J.
    Energy,
    /// Linear momentum, kg m/s.
    Momentum,
    /// Angular momentum about the centre of mass, the fixed point or the centre of force, kg m^2/s.
    AngularMomentum,
}

impl Invariant {
    /// The name in tables.
    pub fn id(self) -> &'static str {
        match self {
            Invariant::Energy => "energy",
            Invariant::Momentum => "momentum",
            Invariant::AngularMomentum => "angular-momentum",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Invariant::Energy => "J",
            Invariant::Momentum => "kg m/s",
            Invariant::AngularMomentum => "kg m^2/s",
        }
    }
}

/// One invariant of a scene with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What is accounted for.
    pub invariant: Invariant,
    /// Its value: one component for a scalar, three for a vector.
    pub value: Vec<fx128>,
    /// Whether the exact motion conserves it.
    pub conserved: bool,
}
