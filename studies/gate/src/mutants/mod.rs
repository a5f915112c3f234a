//! Wrong methods, models and drivers that the bounds must not let pass. Each goes through the gate as a method from outside
//! does, under the name of the method that it pretends to be.

mod wrong;

use integrator::methods::{MethodId, RigidStep};
use integrator::pose::Fixed;
use integrator::rigid_body::{AttitudeUpdate, BodyOmega, Formulation, RigidBody, RigidModel, WorldOmega};
use integrator::{Method, Model, State};

use super::candidate::{Candidate, clock, counted, on_flat, turning};
use super::stepper::{Ask, Stepper};
use measure::error::Error;
use measure::rotation::{Rule, Scheme};
use scenes::any::AnyScene;
use scenes::erased::{AnyMotion, BodyMotion, FlatMotion};
use scenes::observation::Observation;
use scenes::run::{Place, Precision, Run, Samples, Schedule, Trajectory};

use measure::stability::bisect::Found;
use wrong::{
    AccumulatedTime, Altered, Loads, Negated, NotNormalised, StaleForce, StoredInSingle, WrongRk4, WrongSide, built_in,
};

macro_rules! mutants {
    ($($name:ident, $id:literal, $about:literal;)*) => {
        /// A built-in fault.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Mutant {
            $(
                #[doc = concat!($about, ".")]
                $name,
            )*
        }

        impl Mutant {
            /// Every one, the more particular first.
            pub const ALL: &'static [Mutant] = &[$(Mutant::$name),*];

            /// The name in the file.
            pub fn id(self) -> &'static str {
                match self { $(Mutant::$name => $id),* }
            }

            /// What is wrong.
            pub fn about(self) -> &'static str {
                match self { $(Mutant::$name => $about),* }
            }
        }
    };
}

mutants! {
    NotNormalised, "not-normalised", "nobody normalises the quaternion";
    WrongSide, "increment-side", "a rotation increment in body components multiplies from the left";
    MomentumRescaled, "momentum-rescaled", "the length of the angular momentum is rescaled after every step";
    OldVelocity, "old-velocity", "semi-implicit Euler moves with the old velocity";
    NewVelocity, "new-velocity", "explicit Euler moves with the new velocity";
    EquationsNotSolved, "equations-not-solved", "an implicit method takes its first guess, explicit Euler's step";
    AccumulatedTime, "accumulated-time", "time is summed, t += h, where it should be i h";
    StaleForce, "stale-force", "velocity Verlet kicks twice with the first force";
    StageTime, "rk4-stage-time", "every stage of RK4 is evaluated at the time of the first";
    Curvature, "rk4-without-curvature", "RK4 on a rotation without the brackets of Munthe-Kaas";
    SingleParameters, "f32-parameters", "the parameters are rounded to f32";
    SingleAccumulation, "f32-accumulation", "the state is stored in f32 between the steps";
    GyroscopicMissing, "gyroscopic-term-missing", "the gyroscopic term omega x I omega is left out";
    GyroscopicSign, "gyroscopic-term-sign", "the gyroscopic term has the wrong sign";
    GyroscopicAdded, "gyroscopic-term-added", "the gyroscopic term acts where the model leaves it out";
    WrongFrame, "wrong-frame", "a torque in world components is taken for one in body components";
    MassIgnored, "mass-ignored", "the mass is taken for 1 kg";
    ForceSign, "force-sign", "force and torque have the wrong sign";
    OneStepShort, "one-step-short", "the last step is not taken";
}

impl Mutant {
    /// The mutant of that name.
    ///
    /// # Errors
    /// An unknown name, with the list.
    pub fn from_id(id: &str) -> Result<Self, Error> {
        let known = || Self::ALL.iter().map(|mutant| mutant.id().to_owned());
        Self::ALL.iter().copied().find(|mutant| mutant.id() == id).ok_or_else(|| Error::unknown("mutant", id, known()))
    }

    /// What the reason of a row says that is about this fault and not about any.
    pub fn words(self) -> &'static [&'static str] {
        match self {
            Mutant::NotNormalised => &["|q| is restored"],
            Mutant::WrongSide => &["q' = q (0, omega)"],
            Mutant::MomentumRescaled => &["every step adds"],
            Mutant::OldVelocity | Mutant::StaleForce => &["symplectic", "w h <= 2"],
            Mutant::NewVelocity => &["|R(i z)|^2", "|1 + h l|^2"],
            Mutant::EquationsNotSolved => &["A-stable"],
            Mutant::AccumulatedTime => &["t = i h"],
            Mutant::StageTime => &["order 4"],
            Mutant::Curvature => &["brackets of SO(3)"],
            Mutant::SingleAccumulation | Mutant::SingleParameters => &["rounding"],
            Mutant::GyroscopicMissing | Mutant::GyroscopicSign => &["tau - omega x I"],
            Mutant::GyroscopicAdded => &["without omega x I omega"],
            Mutant::WrongFrame => &["= tau"],
            Mutant::MassIgnored => &["F . (a t h", "x'' = -w^2 x", "w h <="],
            Mutant::ForceSign => &["m g^2 h^2"],
            Mutant::OneStepShort => &["evaluations make a step"],
        }
    }

    /// Whether the fault can be made in a method, scene and precision.
    pub fn applies(self, stepper: Stepper, scene: &dyn AnyScene, precision: Precision) -> bool {
        let storage = match stepper {
            Stepper::Flat(_) => None,
            Stepper::Turning(scheme) => Some((scheme.storage, scheme.update)),
        };
        let is = |method| stepper.method() == Some(method);
        let (world, body) = (Formulation::WorldOmega, Formulation::BodyOmega);
        let exponential = |stored| Some((stored, AttitudeUpdate::Exponential));
        let in_double = precision == Precision::F64;
        match self {
            Mutant::OneStepShort => true,
            Mutant::OldVelocity => is(MethodId::SemiImplicitEuler),
            Mutant::NewVelocity => is(MethodId::ExplicitEuler),
            Mutant::EquationsNotSolved => stepper.is_implicit(),
            Mutant::MomentumRescaled => {
                is(MethodId::SemiImplicitEuler) && storage.is_some_and(|(stored, _)| stored == body)
            }
            Mutant::SingleParameters => precision != Precision::F32 && in_single(scene).is_some(),
            Mutant::MassIgnored => mass_of(scene).is_some_and(|mass| mass != "1"),
            Mutant::ForceSign => in_double,
            Mutant::GyroscopicMissing | Mutant::GyroscopicSign => {
                in_double && storage.is_some_and(|(stored, _)| stored != Formulation::WithoutGyroscopicTerm)
            }
            Mutant::GyroscopicAdded => {
                in_double && storage.is_some_and(|(stored, _)| stored == Formulation::WithoutGyroscopicTerm)
            }
            Mutant::WrongFrame => in_double && storage.is_some(),
            Mutant::StageTime => in_double && is(MethodId::Rk4) && (storage.is_none() || storage == exponential(world)),
            Mutant::StaleForce => in_double && is(MethodId::VelocityVerlet) && storage.is_none(),
            Mutant::AccumulatedTime | Mutant::SingleAccumulation => in_double && is(MethodId::Rk4) && storage.is_none(),
            Mutant::Curvature => {
                in_double && is(MethodId::Rk4) && [exponential(world), exponential(body)].contains(&storage)
            }
            Mutant::WrongSide => in_double && is(MethodId::SemiImplicitEuler) && storage == exponential(body),
            Mutant::NotNormalised => {
                in_double
                    && is(MethodId::SemiImplicitEuler)
                    && storage.is_some_and(|(stored, _)| stored == world)
                    && matches!(scene.any_motion(), AnyMotion::Pivoted(_))
            }
        }
    }

    /// The fault in a method.
    pub fn of(self, stepper: Stepper) -> Box<dyn Candidate> {
        Box::new(Wrong { mutant: self, stepper })
    }
}

/// The value of a scene's mass, if it has one.
fn mass_of(scene: &dyn AnyScene) -> Option<String> {
    scene.scene().parameters().into_iter().find(|parameter| parameter.name == "mass").map(|parameter| parameter.value)
}

struct Wrong {
    mutant: Mutant,
    stepper: Stepper,
}

impl Wrong {
    /// The built-in method that the fault turns this one into, if it does.
    fn other(&self) -> Option<Stepper> {
        match (self.mutant, self.stepper) {
            (Mutant::OldVelocity | Mutant::EquationsNotSolved, stepper) => Some(stepper.with(MethodId::ExplicitEuler)),
            (Mutant::NewVelocity, stepper) => Some(stepper.with(MethodId::SemiImplicitEuler)),
            (Mutant::MomentumRescaled, Stepper::Turning(scheme)) => {
                Some(Stepper::Turning(Scheme { rule: Rule::Rigid(RigidStep::RestoredMomentum), ..scheme }))
            }
            _ => None,
        }
    }
}

impl Candidate for Wrong {
    fn run(&self, ask: &Ask<'_>) -> Option<Trajectory> {
        if let Some(other) = self.other() {
            return other.run(ask);
        }
        match self.mutant {
            Mutant::OneStepShort => one_step_short(self.stepper, ask),
            Mutant::SingleParameters => self.stepper.run(&Ask { scene: in_single(ask.scene)?.as_ref(), ..*ask }),
            Mutant::MassIgnored => self.stepper.run(&Ask { scene: without_mass(ask.scene)?.as_ref(), ..*ask }),
            _ => match ask.scene.any_motion() {
                AnyMotion::Few(scene) => self.on_flat(scene.motion(), clock(ask)?),
                AnyMotion::Many(scene) => self.on_flat(scene.motion(), clock(ask)?),
                AnyMotion::Pivoted(motion) => match self.mutant {
                    Mutant::NotNormalised => self.never_settled(motion, clock(ask)?),
                    _ => self.turning(motion, ask),
                },
                AnyMotion::Flying(motion) => self.turning(motion, ask),
            },
        }
    }

    fn limit(&self, scene: &dyn AnyScene, precision: Precision) -> Option<Found> {
        match self.mutant {
            Mutant::SingleParameters => self.stepper.limit(in_single(scene)?.as_ref(), precision),
            Mutant::MassIgnored => self.stepper.limit(without_mass(scene)?.as_ref(), precision),
            _ => self.other()?.limit(scene, precision),
        }
    }
}

impl Wrong {
    fn on_flat<const N: usize>(&self, motion: FlatMotion<'_, N>, clock: Schedule) -> Option<Trajectory> {
        Some(match self.mutant {
            Mutant::ForceSign => built_in(self.stepper.method()?, &Negated(motion), clock),
            Mutant::StageTime => on_flat(&WrongRk4 { stage_times: false, curvature: true }, motion, clock),
            Mutant::StaleForce => on_flat(&StaleForce, motion, clock),
            Mutant::AccumulatedTime => on_flat(&AccumulatedTime::default(), motion, clock),
            Mutant::SingleAccumulation => on_flat(&StoredInSingle, motion, clock),
            _ => return None,
        })
    }

    fn turning<P: Place<f64>>(&self, motion: BodyMotion<'_, P>, ask: &Ask<'_>) -> Option<Trajectory> {
        let Stepper::Turning(scheme) = self.stepper else { return None };
        let clock = clock(ask)?;
        let in_world = scheme.storage == Formulation::WorldOmega;
        let loads = match self.mutant {
            Mutant::ForceSign => Loads::Negated,
            Mutant::WrongFrame => Loads::WrongFrame,
            Mutant::GyroscopicMissing => Loads::Gyroscopic(1.0),
            Mutant::GyroscopicSign => Loads::Gyroscopic(2.0),
            Mutant::GyroscopicAdded => Loads::Gyroscopic(-1.0),
            Mutant::WrongSide => {
                return Some(turning(&WrongSide, &BodyOmega::<_>::new(counted(motion)), motion, clock));
            }
            Mutant::StageTime | Mutant::Curvature => {
                let curvature = self.mutant != Mutant::Curvature;
                let wrong = WrongRk4 { stage_times: self.mutant != Mutant::StageTime, curvature };
                return Some(if in_world {
                    turning(&wrong, &WorldOmega::<_>::new(counted(motion)), motion, clock)
                } else {
                    turning(&wrong, &BodyOmega::<_>::new(counted(motion)), motion, clock)
                });
            }
            _ => return None,
        };
        Some(with_loads(scheme, &Altered { body: motion, loads }, motion, ask))
    }

    /// A run whose driver leaves the quaternion as it is.
    fn never_settled(&self, motion: BodyMotion<'_, Fixed<f64>>, clock: Schedule) -> Option<Trajectory> {
        let Stepper::Turning(Scheme { update, .. }) = self.stepper else { return None };
        let method = NotNormalised { linear: update == AttitudeUpdate::Linear };
        let model = WorldOmega::<_>::new(counted(motion));
        let start = model.state(&motion.exact(0.0));
        let seen = driven(&method, &model, start, clock, NEVER, |s| Observation::of_body(&model, s));
        Some(seen.trajectory(false, model.body().evaluations()))
    }
}

/// No run has as many steps.
const NEVER: u64 = u64::MAX;

/// The driver, whose state is settled after as many steps as one likes.
fn driven<M: Model<f64>, A: Method<f64, M>>(
    method: &A,
    model: &M,
    start: State<M::Config>,
    clock: Schedule,
    settle_every: u64,
    observe: impl Fn(&State<M::Config>) -> Observation,
) -> Samples {
    let h = clock.end_s / clock.steps as f64;
    let mut s = start;
    let mut seen = vec![(0, observe(&s))];
    for i in 1..=clock.steps {
        s = model.contact(&s, method.step(model, (i - 1) as f64 * h, h, s));
        if !s.is_finite() {
            return Samples { seen, failed_step: Some(i) };
        }
        if i % settle_every == 0 {
            s = s.settled();
        }
        if i % clock.stride == 0 || i == clock.steps {
            seen.push((i, observe(&s)));
        }
    }
    Samples { seen, failed_step: None }
}

/// A built-in scheme on a body with wrong loads.
fn with_loads<P: Place<f64>>(
    scheme: Scheme,
    body: &Altered<'_, P>,
    motion: BodyMotion<'_, P>,
    ask: &Ask<'_>,
) -> Trajectory {
    let body: &dyn RigidBody<f64, Position = P> = body;
    let start = motion.exact(0.0);
    P::run(body, start, &Run::new(scheme, ask.precision, ask.end_s, ask.steps), ask.stride)
}

/// n - 1 steps of the length of n, taken for n.
fn one_step_short(stepper: Stepper, ask: &Ask<'_>) -> Option<Trajectory> {
    let taken = ask.steps.checked_sub(1).filter(|&steps| steps > 0)?;
    let end_s = ask.end_s / ask.steps as f64 * taken as f64;
    let mut trajectory = stepper.run(&Ask { end_s, steps: taken, ..*ask })?;
    if let Some((step, _)) = trajectory.seen.last_mut().filter(|(step, _)| *step == taken) {
        *step = ask.steps;
    }
    Some(trajectory)
}

/// The scene with its parameters rounded to f32; `None` where that changes none of them.
fn in_single(scene: &dyn AnyScene) -> Option<Box<dyn AnyScene>> {
    let mut other = scenes::by_id(scene.id()).ok()?;
    let id = other.id();
    let mut changed = false;
    for parameter in other.scene().parameters() {
        let numbers = parameter.value.split(',').map(|text| text.trim().parse().ok());
        let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
        let rounded: Vec<f64> = numbers.iter().map(|&x| f64::from(x as f32)).collect();
        if rounded != numbers {
            changed = true;
            let text: Vec<String> = rounded.iter().map(f64::to_string).collect();
            other.scene_mut().set(id, parameter.name, &text.join(",")).ok()?;
        }
    }
    changed.then_some(other)
}

fn without_mass(scene: &dyn AnyScene) -> Option<Box<dyn AnyScene>> {
    let mut other = scenes::by_id(scene.id()).ok()?;
    let id = other.id();
    other.scene_mut().set(id, "mass", "1").ok()?;
    Some(other)
}

#[cfg(test)]
mod tests {
    use integrator::drive::SETTLE_EVERY;
    use integrator::methods::SemiImplicitEuler;

    use super::*;

    const RIGHT_RK4: WrongRk4 = WrongRk4 { stage_times: true, curvature: true };

    /// 200 steps, which settle three times.
    fn ask(scene: &dyn AnyScene) -> Ask<'_> {
        Ask { scene, precision: Precision::F64, end_s: 1.0, steps: 200, stride: 1 }
    }

    fn built_in_run(method: &str, ask: &Ask<'_>) -> Trajectory {
        Stepper::from_id(method, ask.scene).expect("a method").run(ask).expect("it runs")
    }

    fn assert_same(a: &Trajectory, b: &Trajectory) {
        assert_eq!(a.seen.len(), 201);
        assert_eq!(format!("{:?}", a.seen), format!("{:?}", b.seen));
        assert_eq!((a.outcome, a.failed_step), (b.outcome, b.failed_step));
    }

    // Fails if: the wrong RK4 has another fault than the one that it is named for.
    #[test]
    fn the_wrong_rk4_with_its_faults_switched_off_is_rk4_bit_for_bit() {
        let flat = scenes::by_id("forced-oscillator").expect("a scene");
        let clock_of = |ask: &Ask<'_>| clock(ask).expect("f64");
        let asked = ask(flat.as_ref());
        let AnyMotion::Few(erased) = flat.any_motion() else { panic!("one coordinate") };
        assert_same(&on_flat(&RIGHT_RK4, erased.motion(), clock_of(&asked)), &built_in_run("rk4", &asked));
        let body = scenes::by_id("heavy-top").expect("a scene");
        let asked = ask(body.as_ref());
        let AnyMotion::Pivoted(motion) = body.any_motion() else { panic!("a pivoted body") };
        let world = turning(&RIGHT_RK4, &WorldOmega::<_>::new(counted(motion)), motion, clock_of(&asked));
        assert_same(&world, &built_in_run("rk4/world-omega", &asked));
        let inside = turning(&RIGHT_RK4, &BodyOmega::<_>::new(counted(motion)), motion, clock_of(&asked));
        assert_same(&inside, &built_in_run("rk4/body-omega", &asked));
    }

    // Fails if: the driver that never settles differs in anything else.
    #[test]
    fn the_driver_that_settles_as_it_should_is_the_driver_bit_for_bit() {
        let body = scenes::by_id("heavy-top").expect("a scene");
        let asked = ask(body.as_ref());
        let AnyMotion::Pivoted(motion) = body.any_motion() else { panic!("a pivoted body") };
        let model = WorldOmega::<_>::new(counted(motion));
        let run = |every: u64| {
            let start = model.state(&motion.exact(0.0));
            let clock = clock(&asked).expect("f64");
            let observe = |s: &_| Observation::of_body(&model, s);
            driven(&SemiImplicitEuler, &model, start, clock, every, observe).trajectory(false, 0)
        };
        let right = built_in_run("semi-implicit-euler/world-omega", &asked);
        assert_same(&run(SETTLE_EVERY), &right);
        assert_ne!(format!("{:?}", run(NEVER).seen), format!("{:?}", right.seen));
    }
}
