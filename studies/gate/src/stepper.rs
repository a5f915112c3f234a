//! The methods by the names of the file.

use integrator::methods::MethodId;
use integrator::rigid_body::{AttitudeUpdate, Formulation};

use measure::error::Error;
use measure::rotation::{Rule, Scheme};
use scenes::any::AnyScene;
use scenes::run::{Precision, Run, Trajectory, method_from_id};

/// A method, and of a rigid body also what is stored and how its attitude is advanced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepper {
    /// A general method on a flat scene.
    Flat(MethodId),
    /// A scheme for rigid bodies.
    Turning(Scheme),
}

/// What to run, and where to look at it.
#[derive(Clone, Copy)]
pub struct Ask<'a> {
    /// The scene.
    pub scene: &'a dyn AnyScene,
    /// The arithmetic.
    pub precision: Precision,
    /// End of the run, s.
    pub end_s: f64,
    /// Number of steps.
    pub steps: u64,
    /// Steps from one look to the next; the end is always looked at.
    pub stride: u64,
}

impl Stepper {
    /// Every one that a scene can be stepped with.
    pub fn all(scene: &dyn AnyScene) -> Vec<Stepper> {
        if scene.is_rigid() {
            Scheme::all().into_iter().map(Stepper::Turning).collect()
        } else {
            MethodId::ALL.iter().copied().map(Stepper::Flat).collect()
        }
    }

    /// The stepper of that name for a scene.
    ///
    /// # Errors
    /// An unknown name, with the list of those that the scene can be stepped with.
    pub fn from_id(id: &str, scene: &dyn AnyScene) -> Result<Self, Error> {
        if !scene.is_rigid() {
            return Ok(Stepper::Flat(method_from_id(id)?));
        }
        let known = || Scheme::all().into_iter().map(Scheme::id);
        Scheme::from_id(id).map(Stepper::Turning).ok_or_else(|| Error::unknown("method of a rigid body", id, known()))
    }

    /// The name in the file.
    pub fn id(self) -> String {
        match self {
            Stepper::Flat(method) => method.id().to_owned(),
            Stepper::Turning(scheme) => scheme.id(),
        }
    }

    /// The general method, where it is one.
    pub fn method(self) -> Option<MethodId> {
        match self {
            Stepper::Flat(method) | Stepper::Turning(Scheme { rule: Rule::General(method), .. }) => Some(method),
            Stepper::Turning(_) => None,
        }
    }

    /// The general method where a scene's theory speaks of it: on a flat scene, and of a body that stores its angular
    /// velocity in the world frame and turns by the exponential map.
    pub fn of_theory(self) -> Option<MethodId> {
        match self {
            Stepper::Turning(s) if (s.storage, s.update) != (Formulation::WorldOmega, AttitudeUpdate::Exponential) => {
                None
            }
            _ => self.method(),
        }
    }

    /// The same scheme with another general method.
    #[must_use]
    pub fn with(self, method: MethodId) -> Self {
        match self {
            Stepper::Flat(_) => Stepper::Flat(method),
            Stepper::Turning(s) => Stepper::Turning(Scheme { rule: Rule::General(method), ..s }),
        }
    }

    /// The order on a smooth problem.
    pub fn order(self) -> u32 {
        match self {
            Stepper::Flat(method) => method.order(),
            Stepper::Turning(scheme) => scheme.order(),
        }
    }

    /// Whether a step solves equations.
    pub fn is_implicit(self) -> bool {
        self.method().is_some_and(MethodId::is_implicit)
    }

    /// Runs; `None` where the scene cannot be stepped so.
    pub fn run(self, ask: &Ask<'_>) -> Option<Trajectory> {
        let &Ask { scene, precision, end_s, steps, stride } = ask;
        scene.run(&Run::new(self.scheme(), precision, end_s, steps), stride)
    }

    /// How a scene is stepped.
    pub fn scheme(self) -> Scheme {
        match self {
            Stepper::Flat(method) => method.into(),
            Stepper::Turning(scheme) => scheme,
        }
    }
}
