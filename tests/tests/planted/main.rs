//! Planted faults, chosen at run time: coefficients, forces, loads, drivers and accounts, one wrong at a time. Each has to be noticed by
//! the claims of the report, by the committed bounds, or by the laws that the suite holds every scene to.
//! `cargo test --release --test planted -- --nocapture` prints who sees what.
//!
//! The faults act in f64: claims see them where f64 and double-double are compared. The gate's own mutants (`bounds --mutants`) are
//! held to every row that names them; those not in this list are in bounds.rs.

mod accounts;
mod methods;
mod models;
mod other_steps;

use std::collections::BTreeMap;

use gate::row::Kind;
use gate::stepper::Ask;
use gate::{Bounds, Candidate};
use integrator::drive::SETTLE_EVERY;
use integrator::methods::MethodId;
use integrator::rigid_body::{RigidBody, RigidModel, WorldOmega};
use integrator::{Method, Model, State, Vector};
use measure::convergence::{Convergence, Row};
use measure::study::{Selection, Study};
use measure::sweep::Progress;
use methods::{EXPLICIT, IMPLICIT, MIDPOINT, RK4, SEMI_IMPLICIT, Steps, VERLET};
use models::{Drive, Flat, Law, Loads, Wrong};
use other_steps::other_steps;
use reports::Verdict;
use scenes::any::AnyScene;
use scenes::erased::{AnyMotion, BodyMotion, FlatScene};
use scenes::errors::{self, ExactSamples};
use scenes::observation::Observation;
use scenes::run::{Place, Precision, Samples, Trajectory};

/// One fault, in the place of a built-in method.
#[derive(Clone, Copy)]
struct Fault {
    method: MethodId,
    steps: Steps,
    law: Law,
    loads: Loads,
    drive: Drive,
}

fn right(method: MethodId, steps: Steps) -> Fault {
    Fault { method, steps, law: Law::Right, loads: Loads::Right, drive: Drive::Right }
}

impl Candidate for Fault {
    fn run(&self, ask: &Ask<'_>) -> Option<Trajectory> {
        if ask.precision != Precision::F64 {
            return None;
        }
        Some(match ask.scene.any_motion() {
            AnyMotion::Few(scene) => self.flat(&scene, ask),
            AnyMotion::Many(scene) => self.flat(&scene, ask),
            AnyMotion::Pivoted(motion) => self.turning(motion, ask),
            AnyMotion::Flying(motion) => self.turning(motion, ask),
        })
    }
}

impl Fault {
    fn flat<const N: usize>(&self, scene: &FlatScene<'_, N>, ask: &Ask<'_>) -> Trajectory {
        let motion = scene.motion();
        let model = Flat { motion, dimension: scene.dimension, law: self.law };
        self.driven(&model, motion.exact(0.0), ask, |s| motion.observe(s))
    }

    fn turning<P: Place<f64>>(&self, motion: BodyMotion<'_, P>, ask: &Ask<'_>) -> Trajectory {
        let body = Wrong { motion, loads: self.loads };
        let body: &dyn RigidBody<f64, Position = P> = &body;
        let model = WorldOmega::<_>::new(body);
        self.driven(&model, model.state(&motion.exact(0.0)), ask, |s| Observation::of_body(&model, s))
    }

    fn driven<M: Model<f64>>(
        &self,
        model: &M,
        start: State<M::Config>,
        ask: &Ask<'_>,
        observe: impl Fn(&State<M::Config>) -> Observation,
    ) -> Trajectory {
        let mut h = ask.end_s / ask.steps as f64;
        let mut s = start;
        match self.drive {
            Drive::StepOnePercent => h *= 1.01,
            Drive::StartInSingle => s.v = Vector::from_fn(|i| f64::from(start.v.component(i) as f32)),
            Drive::StartVelocityNegative => s.v = -start.v,
            _ => {}
        }
        let mut seen = vec![(0, observe(&s))];
        let mut failed_step = None;
        let mut summed = 0.0_f32;
        let last = ask.steps;
        for i in 0..last {
            let t = match self.drive {
                Drive::FirstTimeIsOne => (i + 1) as f64 * h,
                Drive::TimeSummedInSingle => f64::from(summed),
                _ => i as f64 * h,
            };
            summed += h as f32;
            let before = s;
            let skipped = self.drive == Drive::OneStepShort && i + 1 == last;
            for _ in 0..if skipped { 0 } else { 1 + u32::from(self.drive == Drive::OneStepMore && i + 1 == last) } {
                s = model.contact(&s, self.steps.step(model, t, h, s));
            }
            if !s.is_finite() {
                failed_step = Some(i + 1);
                break;
            }
            if (i + 1) % SETTLE_EVERY == 0 {
                s = s.settled();
            }
            if (i + 1) % ask.stride == 0 || i + 1 == last {
                seen.push((i + 1, observe(if self.drive == Drive::SeenOneStepLate { &before } else { &s })));
            }
        }
        Samples { seen, failed_step }.trajectory(false, 0)
    }
}

static FLAT: [&str; 5] = ["forced-oscillator", "charged-particle", "bouncing-ball", "kepler", "linear-drag"];
static BODIES: [&str; 3] = ["manufactured", "heavy-top", "box-tumbling"];

/// What claims are judged by: the rows of a built-in method, and its runs in double-double.
struct Baseline {
    scene: Box<dyn AnyScene>,
    truth: ExactSamples,
    rows: Vec<Row>,
    references: BTreeMap<u64, Trajectory>,
}

impl Baseline {
    fn of(scene: &str, method: MethodId) -> Self {
        let by_id = || scenes::by_id(scene).expect("a scene");
        let selection = Selection {
            scenes: vec![by_id()],
            methods: vec![method],
            schemes: Vec::new(),
            precisions: Precision::ALL.to_vec(),
            steps: (0..8).map(|k| by_id().scene().info().coarsest_steps << k).collect(),
            length: None,
            quick: true,
            draws: Default::default(),
            looped: None,
            shard: None,
            progress: Progress::silent(),
        };
        let rows = Convergence::measure(&selection);
        let scene = by_id();
        let end_s = scene.scene().info().horizon_s;
        let reference = |row: &Row| {
            (
                row.steps,
                errors::run(scene.as_ref(), method, Precision::DoubleDouble, end_s, row.steps)
                    .expect("a general method"),
            )
        };
        let mut references = BTreeMap::new();
        for row in &rows {
            references.entry(row.steps).or_insert_with(|| reference(row).1);
        }
        Baseline { truth: ExactSamples::of(scene.as_ref(), end_s), rows, references, scene }
    }

    /// The claims that are broken with the candidate's runs in the place of those in f64.
    fn broken(&self, candidate: &dyn Candidate) -> Vec<String> {
        let mut rows = self.rows.clone();
        let scene = self.scene.as_ref();
        let end_s = scene.scene().info().horizon_s;
        for (&steps, reference) in &self.references {
            let ask = Ask { scene, precision: Precision::F64, end_s, steps, stride: errors::stride(steps) };
            let Some(run) = candidate.run(&ask) else { continue };
            for error in self.truth.compare(scene, steps, &run, reference) {
                let is_it = |row: &&mut Row| {
                    row.precision == Precision::F64 && row.steps == steps && row.quantity == error.quantity
                };
                for row in rows.iter_mut().filter(is_it) {
                    row.outcome = run.outcome;
                    (row.error_end, row.error_max) = (error.end, error.max);
                    (row.rounding_end, row.rounding_max) = (error.rounding_end, error.rounding_max);
                }
            }
        }
        let broken = Convergence::claims(&rows).into_iter().filter(|claim| claim.verdict == Verdict::Broken);
        broken.map(|claim| claim.id).collect()
    }
}

/// The committed bounds of errors and invariants in f64 on the scenes of this test.
fn bounds() -> Bounds {
    let mut bounds = Bounds::committed().expect("the committed bounds can be read");
    let kinds = [Kind::Order, Kind::ErrorAtStep, Kind::ErrorConstant, Kind::Drift];
    bounds.rows.retain(|row| {
        let is_here = FLAT.contains(&row.scene.as_str()) || BODIES.contains(&row.scene.as_str());
        is_here && kinds.contains(&row.kind) && row.precision == Precision::F64
    });
    bounds
}

/// The numbers of claims and bounds that a fault breaks.
struct Judge {
    bounds: Bounds,
    baselines: BTreeMap<(usize, &'static str), Baseline>,
}

impl Judge {
    fn new() -> Self {
        Judge { bounds: bounds(), baselines: BTreeMap::new() }
    }

    fn seen_by(&mut self, fault: &Fault, scenes: &[&'static str]) -> [usize; 2] {
        let index = MethodId::ALL.iter().position(|m| *m == fault.method).expect("a method");
        let mut claims = 0;
        let (_, steps) = METHODS[index];
        for &scene in scenes {
            let baseline = self.baselines.entry((index, scene)).or_insert_with(|| Baseline::of(scene, fault.method));
            let anyway = baseline.broken(&right(fault.method, steps));
            claims += baseline.broken(fault).into_iter().filter(|id| !anyway.contains(id)).count();
        }
        let name = fault.method.id();
        let name = if BODIES.contains(&scenes[0]) { format!("{name}/world-omega") } else { name.to_owned() };
        let held = self.bounds.hold(&name, fault).expect("the method has bounds");
        let here = held.broken().into_iter().filter(|one| scenes.contains(&one.row.scene.as_str())).count();
        [claims, here]
    }
}

const METHODS: [(MethodId, Steps); 6] = [
    (MethodId::ExplicitEuler, EXPLICIT),
    (MethodId::SemiImplicitEuler, SEMI_IMPLICIT),
    (MethodId::VelocityVerlet, VERLET),
    (MethodId::Rk4, RK4),
    (MethodId::ImplicitEuler, IMPLICIT),
    (MethodId::ImplicitMidpoint, MIDPOINT),
];

fn scenes_of(method: MethodId) -> &'static [&'static str] {
    // By fixed-point iteration, and in double-double: two scenes will do.
    if method.is_implicit() { &["forced-oscillator", "linear-drag"] } else { &FLAT[..] }
}

// Fails if: a method of this file has a fault already, and each planted one is seen because of it.
#[test]
fn without_a_fault_nothing_is_broken() {
    let mut judge = Judge::new();
    for (method, steps) in METHODS {
        assert_eq!(judge.seen_by(&right(method, steps), scenes_of(method)), [0, 0], "{}", method.id());
        for &scene in scenes_of(method).iter().filter(|_| !method.is_implicit()) {
            // Fixed-point iterations round in another way than Newton's.
            let broken = Baseline::of(scene, method).broken(&right(method, steps));
            assert!(broken.is_empty(), "{} on {scene}: {broken:?}", method.id());
        }
        if method == MethodId::Rk4 {
            assert_eq!(judge.seen_by(&right(method, steps), &BODIES[..]), [0, 0], "{} on bodies", method.id());
        }
    }
}

/// Every fault of a run: its name, and the scenes that it is looked for on.
fn faults() -> Vec<(String, Fault, &'static [&'static str])> {
    let mut all = Vec::new();
    for (method, steps) in METHODS {
        let named = |(name, wrong): (String, Steps)| {
            (format!("{}: {name}", method.id()), right(method, wrong), scenes_of(method))
        };
        all.extend(methods::faults(steps).into_iter().map(named));
    }
    let other = other_steps().into_iter();
    all.extend(other.map(|(name, method, steps, scenes)| (name.to_owned(), right(method, steps), scenes)));
    let rk4 = right(MethodId::Rk4, RK4);
    all.extend(Law::ALL.map(|(law, name)| (name.to_owned(), Fault { law, ..rk4 }, &FLAT[..])));
    all.extend(Loads::ALL.map(|(loads, name)| (name.to_owned(), Fault { loads, ..rk4 }, &BODIES[..])));
    for (drive, name) in Drive::ALL {
        let scenes = if drive == Drive::StartInSingle { &BODIES[..] } else { &FLAT[..] };
        all.push((name.to_owned(), Fault { drive, ..rk4 }, scenes));
    }
    all
}

/// Faults that change no number: nothing could see them.
// The forced oscillator is driven by a cosine, and no other scene of this test looks at the time.
const WITHOUT_EFFECT: [&str; 1] = ["the force at the time -t"];

// Fails if: a planted fault is seen by nobody.
#[test]
fn every_planted_fault_is_seen() {
    let mut judge = Judge::new();
    let all = faults();
    let mut survivors = Vec::new();
    println!("{:<60} claims bounds", "fault");
    for (name, fault, scenes) in &all {
        let [claims, bounds] = judge.seen_by(fault, scenes);
        println!("{name:<60} {claims:>6} {bounds:>6}");
        if claims + bounds == 0 && !WITHOUT_EFFECT.contains(&name.as_str()) {
            survivors.push(name.clone());
        }
    }
    let accounts = accounts::faults();
    for (name, seen) in &accounts {
        println!("{name:<60} laws: {seen}");
        if *seen == 0 {
            survivors.push((*name).to_owned());
        }
    }
    println!("{} faults, {} survive", all.len() + accounts.len(), survivors.len());
    assert!(survivors.is_empty(), "{survivors:#?}");
    assert!(all.len() + accounts.len() >= 89, "{}", all.len() + accounts.len());
}
