//! What is held to bounds: a built-in method, or one from outside.

use integrator::Method;
use integrator::counted::Counted;
use integrator::rigid_body::{BodyOmega, RigidBody, RigidModel, WorldOmega};

use super::stepper::{Ask, Stepper};
use measure::stability::bisect::Found;
use measure::stability::{amplification, limits};
use scenes::any::AnyScene;
use scenes::erased::{
    AnyMotion, BodyMotion, ErasedBody, FlatModel, FlatMotion, OnBodyOmega, OnFlatScenes, OnWorldOmega,
};
use scenes::observation::Observation;
use scenes::run::{Place, Precision, Schedule, Trajectory};
use scenes::stepping::Stepping;

/// What can be held to bounds.
pub trait Candidate: Sync {
    /// Runs a scene; `None` where it cannot.
    fn run(&self, ask: &Ask<'_>) -> Option<Trajectory>;

    /// The method's name in the rows that it is held to; on rigid bodies with what is stored.
    fn rows_of(&self, method: &str) -> String {
        method.to_owned()
    }

    /// The largest stable step on a scene; `None` where it cannot be asked.
    fn limit(&self, scene: &dyn AnyScene, precision: Precision) -> Option<Found> {
        let _ = (scene, precision);
        None
    }
}

impl Candidate for Stepper {
    fn run(&self, ask: &Ask<'_>) -> Option<Trajectory> {
        Stepper::run(*self, ask)
    }
    fn limit(&self, scene: &dyn AnyScene, precision: Precision) -> Option<Found> {
        let Stepper::Flat(method) = *self else { return None };
        let stepping = Stepping { scene, method, precision };
        Some(limits::measure(&stepping, amplification::limit(&stepping)?))
    }
}

/// A method from outside that can step any flat scene.
pub struct Flat<A>(pub A);

/// A method from outside that can turn any rigid body which stores its angular velocity in the world frame.
pub struct InWorld<A>(pub A);

/// A method from outside that can turn any rigid body which stores its angular velocity in the body frame.
pub struct InBody<A>(pub A);

impl<A: OnFlatScenes> Candidate for Flat<A> {
    fn run(&self, ask: &Ask<'_>) -> Option<Trajectory> {
        let clock = clock(ask)?;
        match ask.scene.any_motion() {
            AnyMotion::Few(scene) => Some(on_flat(&self.0, scene.motion(), clock)),
            AnyMotion::Many(scene) => Some(on_flat(&self.0, scene.motion(), clock)),
            AnyMotion::Pivoted(_) | AnyMotion::Flying(_) => None,
        }
    }
}

impl<A: OnWorldOmega> Candidate for InWorld<A> {
    fn rows_of(&self, method: &str) -> String {
        stored(method, "world-omega")
    }
    fn run(&self, ask: &Ask<'_>) -> Option<Trajectory> {
        let clock = clock(ask)?;
        match ask.scene.any_motion() {
            AnyMotion::Pivoted(motion) => Some(turning(&self.0, &WorldOmega::<_>::new(counted(motion)), motion, clock)),
            AnyMotion::Flying(motion) => Some(turning(&self.0, &WorldOmega::<_>::new(counted(motion)), motion, clock)),
            _ => None,
        }
    }
}

impl<A: OnBodyOmega> Candidate for InBody<A> {
    fn rows_of(&self, method: &str) -> String {
        stored(method, "body-omega")
    }
    fn run(&self, ask: &Ask<'_>) -> Option<Trajectory> {
        let clock = clock(ask)?;
        match ask.scene.any_motion() {
            AnyMotion::Pivoted(motion) => Some(turning(&self.0, &BodyOmega::<_>::new(counted(motion)), motion, clock)),
            AnyMotion::Flying(motion) => Some(turning(&self.0, &BodyOmega::<_>::new(counted(motion)), motion, clock)),
            _ => None,
        }
    }
}

/// A plain name with what is stored behind it; a name that says so already as it is.
fn stored(method: &str, what: &str) -> String {
    if method.contains('/') { method.to_owned() } else { format!("{method}/{what}") }
}

/// Methods from outside run in f64.
pub(super) fn clock(ask: &Ask<'_>) -> Option<Schedule> {
    let &Ask { end_s, steps, stride, precision, .. } = ask;
    (precision == Precision::F64).then_some(Schedule { end_s, steps, stride })
}

/// Runs a method on a flat scene of which only the space is known.
pub(super) fn on_flat<'a, const N: usize, A: Method<f64, FlatModel<'a, N>>>(
    method: &A,
    motion: FlatMotion<'a, N>,
    clock: Schedule,
) -> Trajectory {
    let counted: FlatModel<'a, N> = Counted::new(motion);
    let seen = clock.drive(method, &counted, motion.exact(0.0), |s| motion.observe(s));
    seen.trajectory(false, counted.evaluations())
}

/// A body of which only the kind of its position is known, with a count of what it is asked.
pub(super) fn counted<'a, P: Place<f64>>(motion: BodyMotion<'a, P>) -> ErasedBody<'a, P> {
    Counted::new(motion as &dyn RigidBody<f64, Position = P>)
}

/// Runs a method on a rigid body in what the model stores.
pub(super) fn turning<'a, P: Place<f64>, M: RigidModel<f64, Body = ErasedBody<'a, P>>, A: Method<f64, M>>(
    method: &A,
    model: &M,
    motion: BodyMotion<'a, P>,
    clock: Schedule,
) -> Trajectory {
    let start = model.state(&motion.exact(0.0));
    let seen = clock.drive(method, model, start, |s| Observation::of_body(model, s));
    seen.trajectory(false, model.body().evaluations())
}

#[cfg(test)]
mod tests {
    use integrator::methods::{MethodId, Rk4, SemiImplicitEuler};

    use super::*;

    // Fails if: a scene on its larger space loses its contact, its kick or a coordinate.
    #[test]
    fn a_method_from_outside_has_the_bits_of_the_built_in_one_on_every_flat_scene() {
        let mut dimensions = Vec::new();
        for any in scenes::all().iter().filter(|any| !any.is_rigid()) {
            let end_s = any.scene().info().horizon_s;
            let ask = Ask { scene: any.as_ref(), precision: Precision::F64, end_s, steps: 96, stride: 1 };
            let run = |candidate: &dyn Candidate| candidate.run(&ask).expect("a flat scene in f64");
            for (outside, method) in
                [(run(&Flat(SemiImplicitEuler)), MethodId::SemiImplicitEuler), (run(&Flat(Rk4)), MethodId::Rk4)]
            {
                let inside = run(&Stepper::Flat(method));
                assert_eq!(outside.seen.len(), 97, "{}", any.id());
                assert_eq!(format!("{outside:?}"), format!("{inside:?}"), "{} {}", any.id(), method.id());
            }
            dimensions.push(match any.any_motion() {
                AnyMotion::Few(scene) => scene.dimension,
                AnyMotion::Many(scene) => scene.dimension,
                AnyMotion::Pivoted(_) | AnyMotion::Flying(_) => 0,
            });
        }
        assert!([1, 2, 3, 16].iter().all(|n| dimensions.contains(n)) && !dimensions.contains(&0), "{dimensions:?}");
    }
}
