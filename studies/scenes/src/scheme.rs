//! How to step: a rule of a step, what a rigid body stores, how its attitude is advanced.

use integrator::methods::{Facts, MethodId, RigidStep};
use integrator::rigid_body::{AttitudeUpdate, Formulation};

/// The rule of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// A general method.
    General(MethodId),
    /// A step that exists for rigid bodies only.
    Rigid(RigidStep),
}

/// One way to step a scene. A flat scene has nothing to choose but the rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scheme {
    /// The rule of a step.
    pub rule: Rule,
    /// What the body stores.
    pub storage: Formulation,
    /// How the attitude is advanced.
    pub update: AttitudeUpdate,
}

/// The method with the formulation and the attitude update that a rigid body has by default.
impl From<MethodId> for Scheme {
    fn from(method: MethodId) -> Self {
        Scheme::general(method, Formulation::default(), AttitudeUpdate::default())
    }
}

/// The step with the attitude update that a rigid body has by default.
impl From<RigidStep> for Scheme {
    fn from(step: RigidStep) -> Self {
        Scheme::rigid(step, AttitudeUpdate::default())
    }
}

impl Scheme {
    /// A general method.
    pub fn general(method: MethodId, storage: Formulation, update: AttitudeUpdate) -> Self {
        Scheme { rule: Rule::General(method), storage, update }
    }

    /// A step that exists for rigid bodies only.
    pub fn rigid(step: RigidStep, update: AttitudeUpdate) -> Self {
        Scheme { rule: Rule::Rigid(step), storage: step.storage(), update }
    }

    /// Every one that is compared, those of one stored quantity together.
    pub fn all() -> Vec<Scheme> {
        use AttitudeUpdate::{Exponential, Linear};
        let mut all = Vec::new();
        for storage in Formulation::ALL {
            // Where the frame turns with the step, equations are solved only for what a symplectic method keeps.
            let takes = |method: &MethodId| match storage {
                Formulation::BodyOmega => true,
                Formulation::WithoutGyroscopicTerm => !method.is_implicit(),
                _ => !method.is_implicit() || method.facts().symplectic == Some(true),
            };
            let methods = || MethodId::ALL.iter().copied().filter(takes);
            all.extend(methods().map(|method| Self::general(method, storage, Exponential)));
            let simplest = methods().filter(|method| method.order() == 1 && !method.is_implicit());
            all.extend(simplest.map(|method| Self::general(method, storage, Linear)));
        }
        all.extend(RigidStep::ALL.iter().map(|&step| Self::rigid(step, Exponential)));
        // The second-order steps lose nothing by the linear update, and nobody takes it for them.
        all.extend(RigidStep::ALL.iter().filter(|step| step.order() == 1).map(|&step| Self::rigid(step, Linear)));
        all
    }

    /// The name in tables: `semi-implicit-euler/world-omega/linear`; the exponential map is not named.
    pub fn id(self) -> String {
        let rule = match self.rule {
            Rule::General(method) => format!("{}/{}", method.id(), self.storage.id()),
            Rule::Rigid(step) => step.id().to_owned(),
        };
        if self.update == AttitudeUpdate::Linear { format!("{rule}/linear") } else { rule }
    }

    /// The scheme of that name, if it is compared.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::all().into_iter().find(|scheme| scheme.id() == id)
    }

    /// Whether this is the name of a scheme, compared or not.
    pub fn is_known(id: &str) -> bool {
        let rule = id.strip_suffix("/linear").unwrap_or(id);
        Self::all().into_iter().any(|scheme| scheme.id() == rule)
    }

    /// The name in a chart.
    pub fn label(self) -> String {
        let stored = match self.storage {
            Formulation::WorldOmega => "world ω",
            Formulation::BodyOmega => "body ω",
            Formulation::WorldMomentum => "world L",
            Formulation::WithoutGyroscopicTerm => "no gyroscopic term",
        };
        let rule = match self.rule {
            Rule::General(method) => format!("{}, {stored}", method.title()),
            Rule::Rigid(step) => step.title().to_owned(),
        };
        if self.update == AttitudeUpdate::Linear { format!("{rule}, linear step") } else { rule }
    }

    /// What is known of the rule.
    pub fn facts(self) -> &'static Facts {
        match self.rule {
            Rule::General(method) => method.facts(),
            Rule::Rigid(step) => step.facts(),
        }
    }

    /// The order of the rule, on a body whose model is consistent.
    pub fn order(self) -> u32 {
        self.facts().order_on_rotations.unwrap_or(self.facts().order)
    }

    /// Whether a step solves equations.
    pub fn is_implicit(self) -> bool {
        self.facts().implicit
    }

    /// Whether the gyroscopic term is left out.
    pub fn lacks_gyroscopic_term(self) -> bool {
        self.storage == Formulation::WithoutGyroscopicTerm
    }
}
