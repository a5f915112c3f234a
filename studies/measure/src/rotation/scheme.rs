//! What is compared: a rule of a step, what the body stores, how its attitude is advanced.

use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::{AttitudeUpdate, Storage};

use scenes::any::AnyScene;
use scenes::run::{Precision, Run, Trajectory};

/// The rule of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// A general method.
    General(MethodId),
    /// A step that exists for rigid bodies only.
    Rigid(RigidStep),
}

/// One way to turn a rigid body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scheme {
    /// The rule of a step.
    pub rule: Rule,
    /// What the body stores.
    pub storage: Storage,
    /// How the attitude is advanced.
    pub update: AttitudeUpdate,
}

impl Scheme {
    /// A general method.
    pub fn general(method: MethodId, storage: Storage, update: AttitudeUpdate) -> Self {
        Scheme { rule: Rule::General(method), storage, update }
    }

    /// A step that exists for rigid bodies only.
    pub fn rigid(step: RigidStep, update: AttitudeUpdate) -> Self {
        Scheme { rule: Rule::Rigid(step), storage: step.storage(), update }
    }

    /// Every one that is compared, those of one stored quantity together.
    pub fn all() -> Vec<Scheme> {
        use AttitudeUpdate::{Exponential, Linear};
        use MethodId::{ExplicitEuler, ImplicitEuler, ImplicitMidpoint, Rk4, SemiImplicitEuler, VelocityVerlet};
        let mut all = Vec::new();
        for storage in Storage::ALL {
            let methods: &[MethodId] = match storage {
                Storage::BodyOmega => {
                    &[ExplicitEuler, SemiImplicitEuler, VelocityVerlet, Rk4, ImplicitEuler, ImplicitMidpoint]
                }
                Storage::WithoutGyroscopicTerm => &[ExplicitEuler, SemiImplicitEuler, VelocityVerlet, Rk4],
                _ => &[ExplicitEuler, SemiImplicitEuler, VelocityVerlet, Rk4, ImplicitMidpoint],
            };
            all.extend(methods.iter().map(|&method| Self::general(method, storage, Exponential)));
            all.extend([ExplicitEuler, SemiImplicitEuler].map(|method| Self::general(method, storage, Linear)));
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

    /// The name in a chart.
    pub fn label(self) -> String {
        let stored = match self.storage {
            Storage::WorldOmega => "world ω",
            Storage::BodyOmega => "body ω",
            Storage::WorldMomentum => "world L",
            Storage::WithoutGyroscopicTerm => "no gyroscopic term",
        };
        let rule = match self.rule {
            Rule::General(method) => format!("{}, {stored}", method.title()),
            Rule::Rigid(step) => step.title().to_owned(),
        };
        if self.update == AttitudeUpdate::Linear { format!("{rule}, linear step") } else { rule }
    }

    /// The order of the rule, on a body whose model is consistent.
    pub fn order(self) -> u32 {
        match self.rule {
            Rule::General(method) => method.order(),
            Rule::Rigid(step) => step.order(),
        }
    }

    /// Whether a step solves equations.
    pub fn is_implicit(self) -> bool {
        matches!(self.rule, Rule::General(method) if method.is_implicit())
    }

    /// Whether the gyroscopic term is left out.
    pub fn lacks_gyroscopic_term(self) -> bool {
        self.storage == Storage::WithoutGyroscopicTerm
    }

    /// A run that stores and moves as the scheme does.
    pub(super) fn stored<A>(self, run: Run<A>) -> Run<A> {
        run.storing(self.storage, self.update)
    }

    /// Runs a scene in f64; `None` for a step that the scene, which is no rigid body, cannot take.
    pub fn run(self, scene: &dyn AnyScene, end_s: f64, steps: u64, stride: u64) -> Option<Trajectory> {
        let precision = Precision::F64;
        match self.rule {
            Rule::General(method) => Some(scene.run(&self.stored(Run::new(method, precision, end_s, steps)), stride)),
            Rule::Rigid(step) => scene.run_step(&self.stored(Run::new(step, precision, end_s, steps)), stride),
        }
    }
}
