//! How engines damp a velocity, and at which point of the step.

use integrator::Single;
use nalgebra::Vector3;

/// The factor by which a velocity is multiplied in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Rule {
    /// 1 - c h.
    Linear,
    /// 1 / (1 + c h).
    Implicit,
    /// (1 - c)^h.
    Power,
    /// exp(-c h).
    Exponential,
    /// The drag c v is part of the force.
    Force,
    /// The drag c (1 + |v|) v is part of the force.
    QuadraticForce,
}

impl Rule {
    /// Every one.
    pub(super) const ALL: [Rule; 6] =
        [Rule::Linear, Rule::Implicit, Rule::Power, Rule::Exponential, Rule::Force, Rule::QuadraticForce];

    /// As a formula.
    pub(super) fn formula(self) -> &'static str {
        match self {
            Rule::Linear => "v (1 - c h)",
            Rule::Implicit => "v / (1 + c h)",
            Rule::Power => "v (1 - c)^h",
            Rule::Exponential => "v exp(-c h)",
            Rule::Force => "force -c v",
            Rule::QuadraticForce => "force -c (1 + |v|) v",
        }
    }

    /// Whether it is a force.
    pub(super) fn is_force(self) -> bool {
        matches!(self, Rule::Force | Rule::QuadraticForce)
    }

    /// The factor of one step.
    pub(super) fn factor(self, c: f64, h: f64) -> f64 {
        match self {
            Rule::Linear => (1.0 - c * h).max(0.0),
            Rule::Implicit => 1.0 / (1.0 + c * h),
            Rule::Power => (1.0 - c).max(0.0).powf(h),
            Rule::Exponential => (-c * h).exp(),
            Rule::Force | Rule::QuadraticForce => 1.0,
        }
    }

    /// The c that gives this factor in a step, at this speed.
    pub(super) fn coefficient(self, factor: f64, h: f64, speed: f64) -> f64 {
        match self {
            Rule::Linear | Rule::Force => (1.0 - factor) / h,
            Rule::Implicit => (1.0 / factor - 1.0) / h,
            Rule::Power => 1.0 - factor.powf(1.0 / h),
            Rule::Exponential => -factor.ln() / h,
            Rule::QuadraticForce => (1.0 - factor) / h / (1.0 + speed),
        }
    }
}

/// When in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum When {
    /// Before the force acts.
    Before,
    /// After the force, before the move.
    Between,
    /// After the move.
    After,
}

impl When {
    /// Every one.
    pub(super) const ALL: [When; 3] = [When::Between, When::Before, When::After];

    /// In words.
    pub(super) fn name(self) -> &'static str {
        match self {
            When::Before => "before the force",
            When::Between => "before the move",
            When::After => "after the move",
        }
    }
}

/// A damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Damping {
    /// How.
    pub(super) rule: Rule,
    /// When; of no meaning for a force.
    pub(super) when: When,
    /// The coefficient, 1/s.
    pub(super) c: f64,
    /// The steps in a row for which the coefficient was fitted; None for one that was not.
    pub(super) steps: Option<u64>,
}

impl Damping {
    /// In words.
    pub(super) fn name(&self) -> String {
        let when = if self.rule.is_force() { String::new() } else { format!(" {}", self.when.name()) };
        format!("damping {} with c = {:.6}{when}", self.rule.formula(), self.c)
    }
}

/// The velocity after a damping that is a factor.
pub(super) fn apply<T: Single>(damping: Option<Damping>, when: When, h: f64, v: Vector3<T>) -> Vector3<T> {
    match damping {
        Some(d) if d.when == when && !d.rule.is_force() => v * T::lit(d.rule.factor(d.c, h)),
        _ => v,
    }
}
