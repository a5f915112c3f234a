//! The candidates of a comparison: a rule of a step, on a rigid body with what is stored.

use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::{AttitudeUpdate, Formulation};
use reports::Marker;

use crate::study::color_of;
use scenes::any::AnyScene;
use scenes::observation::Observation;
use scenes::run::{Precision, Run, Shown, Trajectory};
use scenes::scheme::{Rule, Scheme};
use scenes::timed::{Repetitions, Timing};

/// One way to move a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// The rule of a step, and what a rigid body stores.
    pub scheme: Scheme,
    /// Whether the scene is a rigid body, so that there is something to choose.
    pub is_rigid: bool,
}

/// The number of steps and the end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// End of the run, s.
    pub end_s: f64,
    /// Number of steps.
    pub steps: u64,
}

/// Every way to move a scene with what is chosen. The steps that exist for rigid bodies only come with the full list of methods, or by
/// their own name.
pub fn candidates(scene: &dyn AnyScene, methods: &[MethodId], schemes: &[Scheme]) -> Vec<Candidate> {
    if !scene.is_rigid() {
        return methods.iter().map(|&method| Candidate::flat(method)).collect();
    }
    let mut all = for_bodies(methods);
    for &scheme in schemes {
        let candidate = Candidate { scheme, is_rigid: true };
        if !all.contains(&candidate) {
            all.push(candidate);
        }
    }
    all
}

fn for_bodies(methods: &[MethodId]) -> Vec<Candidate> {
    use AttitudeUpdate::Exponential;
    let general = |storage| methods.iter().map(move |&method| Scheme::general(method, storage, Exponential));
    let mut schemes: Vec<Scheme> =
        [Formulation::WorldOmega, Formulation::BodyOmega].into_iter().flat_map(general).collect();
    if methods.len() == MethodId::ALL.len() {
        schemes.extend(RigidStep::ALL.iter().map(|&step| Scheme::rigid(step, Exponential)));
    }
    schemes.into_iter().map(|scheme| Candidate { scheme, is_rigid: true }).collect()
}

impl Candidate {
    fn flat(method: MethodId) -> Self {
        let scheme = Scheme::general(method, Formulation::WorldOmega, AttitudeUpdate::Exponential);
        Candidate { scheme, is_rigid: false }
    }

    /// The name in rows: a method, on a rigid body with what is stored.
    pub fn id(self) -> String {
        match self.scheme.rule {
            Rule::General(method) if !self.is_rigid => method.id().to_owned(),
            _ => self.scheme.id(),
        }
    }

    /// The candidate of that name.
    pub fn from_id(id: &str) -> Option<Self> {
        let mut all = MethodId::ALL.iter().map(|&method| Self::flat(method)).chain(for_bodies(MethodId::ALL));
        all.find(|candidate| candidate.id() == id)
    }

    /// The name in a sentence.
    pub fn label(self) -> String {
        match self.scheme.rule {
            Rule::General(method) if !self.is_rigid => method.title().to_owned(),
            _ => self.scheme.label(),
        }
    }

    /// The name of the rule alone, whatever is stored.
    pub fn rule_id(self) -> &'static str {
        self.scheme.facts().id
    }

    /// The general method, if it is one.
    pub fn method(self) -> Option<MethodId> {
        match self.scheme.rule {
            Rule::General(method) => Some(method),
            Rule::Rigid(_) => None,
        }
    }

    /// The palette index: a general method has its own in every chart, and two steps for rigid bodies share what is left.
    pub fn color(self) -> usize {
        match self.scheme.rule {
            Rule::General(method) => color_of(method),
            Rule::Rigid(step) => MethodId::ALL.len() + RigidStep::ALL.iter().position(|s| *s == step).unwrap_or(0) % 2,
        }
    }

    /// The shape of a point where the colour alone does not tell the step for rigid bodies.
    pub fn marker(self) -> Option<Marker> {
        let Rule::Rigid(step) = self.scheme.rule else { return None };
        let shared = RigidStep::ALL.iter().position(|s| *s == step).is_some_and(|i| i >= 2);
        shared.then(|| Marker::ALL[(self.color() + 2) % Marker::ALL.len()])
    }

    /// Evaluations of the force law in a step, where the formula says so: an implicit step takes as many as it needs.
    pub fn evaluations_a_step(self) -> Option<u64> {
        self.scheme.facts().evaluations
    }

    /// One observed run; `None` for a step that the scene, which is no rigid body, cannot take.
    pub fn run(self, scene: &dyn AnyScene, precision: Precision, span: Span, stride: u64) -> Option<Trajectory> {
        scene.run(&Run::new(self.scheme, precision, span.end_s, span.steps), stride)
    }

    /// One run of which every step is shown; `None` as for [`Self::run`].
    pub fn show(
        self,
        scene: &dyn AnyScene,
        precision: Precision,
        span: Span,
        watch: &dyn Fn(u64, Observation),
    ) -> Option<Trajectory> {
        scene.show(&Run::new(self.scheme, precision, span.end_s, span.steps), Shown::To(watch))
    }

    /// Whether [`Self::time`] has code for it, or, in double-double, the observed run stands in.
    pub fn is_timed(self, precision: Precision) -> bool {
        let of_body = !self.is_rigid || self.scheme.storage != Formulation::WorldOmega;
        let is_core = self.method().is_none_or(MethodId::is_core);
        match precision {
            Precision::DoubleDouble => true,
            Precision::F64 => is_core && (of_body || !self.scheme.is_implicit()),
            Precision::F32 => is_core && of_body && !self.scheme.is_implicit(),
        }
    }

    /// One timed run; `None` for what is not compiled to be timed.
    pub fn time(self, scene: &dyn AnyScene, precision: Precision, span: Span, laps: Repetitions) -> Option<Timing> {
        scene.time(&Run::new(self.scheme, precision, span.end_s, span.steps), laps)
    }
}
