//! Advice against brute force: every step of every run is compared with the exact motion, evaluated there.

use std::cell::Cell;

use faer::fx128;
use integrator::Real;
use integrator::methods::MethodId;
use scenes::any::AnyScene;
use scenes::invariants::Invariant;
use scenes::observation::{Observation, Quantity};
use scenes::run::{Outcome, Precision, Run, Shown};

use measure::study::{Length, Selection};
use measure::sweep::Progress;
use measure::tradeoff::advice::{Question, advise};
use measure::tradeoff::candidate::{Candidate, candidates};
use measure::tradeoff::exact::ExactSamples;
use measure::tradeoff::quantity::Of;
use measure::tradeoff::search::{Need, Search, search, watched};

fn scene(id: &str, set: &[(&str, &str)]) -> Box<dyn AnyScene> {
    let mut scene = scenes::by_id(id).expect("a scene of the catalogue");
    for (name, value) in set {
        scene.scene_mut().set(id, name, value).expect("a value of the range");
    }
    scene
}

/// The largest error of position and attitude over all steps of a run; infinite for one that fails.
fn brute(scene: &dyn AnyScene, candidate: Candidate, precision: Precision, end_s: f64, steps: u64) -> f64 {
    let largest = Cell::new(0.0_f64);
    let see = |i: u64, seen: Observation| {
        let t = fx128::lit(end_s) * fx128::lit(i as f64) / fx128::lit(steps as f64);
        for (quantity, distance) in seen.distances(&scene.exact(t)) {
            if matches!(quantity, Quantity::Position | Quantity::Attitude) && !(distance <= largest.get()) {
                largest.set(distance);
            }
        }
    };
    let run = scene.show(&Run::new(candidate.scheme, precision, end_s, steps), Shown::To(&see)).expect("a step");
    if run.outcome == Outcome::Finished { largest.get() } else { f64::INFINITY }
}

/// A uniform random number in [0, 1), by xorshift.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn log(&mut self, low: f64, high: f64) -> f64 {
        (low.ln() + self.uniform() * (high / low).ln()).exp()
    }
}

/// Scenes whose exact motion takes a few microseconds, with the parameters that are drawn.
const DRAWN: [(&str, &[&str]); 8] = [
    ("oscillator", &["mass", "stiffness", "x0", "v0"]),
    ("damped-oscillator", &["mass", "stiffness", "zeta", "x0", "v0"]),
    ("forced-oscillator", &["mass", "stiffness", "damping", "force", "drive"]),
    ("linear-drag", &["mass", "drag"]),
    ("kepler", &["mu", "semi_major", "eccentricity"]),
    ("pendulum", &["length", "gravity", "omega"]),
    ("charged-particle", &["mass", "charge"]),
    ("bouncing-ball", &["gravity", "x0"]),
];

/// A scene with parameters within a factor of four of their defaults; eccentricities and damping ratios of all sizes.
fn draw(random: &mut Random, id: &str, names: &[&str]) -> Box<dyn AnyScene> {
    let mut scene = scene(id, &[]);
    for parameter in scene.scene().parameters().iter().filter(|p| names.contains(&p.name)) {
        let Ok(default) = parameter.value.parse::<f64>() else { continue };
        let value = match parameter.name {
            "eccentricity" => 0.95 * random.uniform(),
            "zeta" => random.log(1e-3, 4.0),
            _ => default * random.log(0.25, 4.0),
        };
        scene.scene_mut().set(id, parameter.name, &value.to_string()).expect("within the range");
    }
    scene
}

/// Draws per scene: a few in the suite, as many as wanted by the environment.
fn draws() -> usize {
    std::env::var("VERIFICATION_DRAWS").ok().and_then(|n| n.parse().ok()).unwrap_or(2)
}

// Fails if: an error is the largest of 64 samples; the polynomials of the exact motion are off by a per cent of the level;
// a search stops where a doubling misses the error.
#[test]
fn advice_on_random_parameters_agrees_with_brute_force() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let methods = [MethodId::SemiImplicitEuler, MethodId::VelocityVerlet, MethodId::Rk4, MethodId::ImplicitMidpoint];
    let (mut found, mut refused) = (0, 0);
    for (id, names) in DRAWN {
        for i in 0..draws() {
            let scene = draw(&mut random, id, names);
            if scene.scene().check().is_err() {
                continue;
            }
            let scene = scene.as_ref();
            let end_s = scene.scene().info().time_scale_s * random.log(2.0, 200.0);
            let candidate = candidates(scene, &methods, &[])[i % methods.len()];
            let precision = if random.uniform() < 0.25 { Precision::F32 } else { Precision::F64 };
            let sampled = ExactSamples::new(scene, end_s, 64);
            let order = f64::from(candidate.scheme.order());
            let error = sampled.scale() * random.log(10.0_f64.powf(-1.0 - order), 0.3);
            let truth = sampled.at_every_step(Of::Configuration, error);
            let need = Need { scene, truth: &truth, error, end_s, unit: 2 };
            let measured = |steps| brute(scene, candidate, precision, end_s, steps);
            let set: Vec<String> =
                scene.scene().parameters().iter().map(|p| format!("{}={}", p.name, p.value)).collect();
            let case = format!("{id} {set:?} {} {precision:?} error {error} over {end_s} s", candidate.id());
            match search(&need, candidate, precision) {
                Search::Found(tried) if tried.steps <= 1 << 15 => {
                    found += 1;
                    let all = measured(tried.steps);
                    assert!(all <= error, "{case}: {tried:?}, over all steps {all}");
                    // The polynomials are near enough for three digits.
                    let reported = tried.error.expect("found");
                    assert!((reported / all - 1.0).abs() <= 2e-3, "{case}: {tried:?}, over all steps {all}");
                }
                Search::Found(_) => {}
                Search::TooMany { searched, .. } | Search::Never { searched, .. } => {
                    refused += 1;
                    // No three doublings of those that were tried keep the error.
                    let doublings: Vec<bool> = (1..14)
                        .map(|k| 1 << k)
                        .filter(|steps| *steps <= searched)
                        .map(|steps| measured(steps) <= error)
                        .collect();
                    assert!(!doublings.windows(3).any(|w| w == [true; 3]), "{case}: {doublings:?}");
                }
                other => panic!("{case}: {other:?}"),
            }
        }
    }
    println!("{found} found, {refused} refused");
    assert!(found > 0 && found >= 3 * refused, "{found} found, {refused} refused");
}

fn selection(scene: Box<dyn AnyScene>, method: MethodId, precision: Precision) -> Selection {
    Selection {
        scenes: vec![scene],
        methods: vec![method],
        schemes: Vec::new(),
        precisions: vec![precision],
        steps: Vec::new(),
        length: None,
        quick: false,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    }
}

/// The spring that dies away between two samples of a minute: at its limits 64 of them see nothing.
const STIFF: [(&str, &str); 5] =
    [("mass", "1"), ("stiffness", "170"), ("zeta", "0.9970544855015815"), ("x0", "-1"), ("v0", "0")];

// Fails if: the largest error is that of 64 samples (1540 steps, 0.18 m over all).
#[test]
fn an_error_between_the_samples_counts() {
    let question = Question { error: Some(1e-3), length: Some(Length::Seconds(60.0)), ..Question::default() };
    let asked = |question| {
        let chosen = selection(scene("damped-oscillator", &STIFF), MethodId::SemiImplicitEuler, Precision::F64);
        advise(&chosen, question).expect("a good question").picks[0].expect("it can be reached")
    };
    let pick = asked(question);
    let spring = scene("damped-oscillator", &STIFF);
    let measured = |steps| brute(spring.as_ref(), pick.candidate, Precision::F64, 60.0, steps);
    assert!(measured(1540) > 0.17 && measured(pick.tried.steps) <= 1e-3, "{pick:?}");
    // Not more than needed: the search is as fine as one part in 128, and steps are even.
    assert!(measured(pick.tried.steps / 64 * 63 / 2 * 2 - 2) > 1e-3, "{pick:?}");
    // Frames of a sixtieth of a second: the states die away to denormal numbers, whose error is a number.
    let frames = Question { error: Some(2.7e-5), rate_hz: Some(60.0), ..question };
    let chosen = selection(scene("damped-oscillator", &STIFF), MethodId::Rk4, Precision::F64);
    let pick = advise(&chosen, frames).expect("a good question").picks[0].expect("2.67e-5 m at one step per frame");
    assert_eq!(pick.tried.steps, 3600);
    let all = measured_rk4(spring.as_ref(), 3600);
    assert!((all / pick.tried.error.expect("finished") - 1.0).abs() < 1e-6 && (2.6e-5..2.7e-5).contains(&all), "{all}");
}

fn measured_rk4(spring: &dyn AnyScene, steps: u64) -> f64 {
    brute(spring, candidates(spring, &[MethodId::Rk4], &[])[0], Precision::F64, 60.0, steps)
}

/// a = mu = 1, of eccentricity 0.9: the error is made at the pericentre, and largest beside it.
const ECCENTRIC: [(&str, &str); 3] = [("mu", "1"), ("semi_major", "1"), ("eccentricity", "0.9")];

// Fails if: the largest error is that of 64 samples; panels of the exact motion are not halved at the pericentre.
#[test]
fn the_error_at_a_pericentre_counts() {
    let orbit = scene("kepler", &ECCENTRIC);
    let end_s = 2.0 * std::f64::consts::TAU;
    let candidate = candidates(orbit.as_ref(), &[MethodId::Rk4], &[])[0];
    for error in [1e-3, 1e-6] {
        let truth = ExactSamples::new(orbit.as_ref(), end_s, 64).at_every_step(Of::Configuration, error);
        let need = Need { scene: orbit.as_ref(), truth: &truth, error, end_s, unit: 2 };
        let Search::Found(tried) = search(&need, candidate, Precision::F64) else { panic!("RK4 reaches {error}") };
        let all = brute(orbit.as_ref(), candidate, Precision::F64, end_s, tried.steps);
        assert!(all <= error && (tried.error.expect("found") / all - 1.0).abs() <= 2e-3, "{tried:?} {all}");
        let fewer = brute(orbit.as_ref(), candidate, Precision::F64, end_s, tried.steps / 64 * 63 / 2 * 2 - 2);
        assert!(fewer > error, "{tried:?}: {fewer}");
    }
}

// Implicit Euler's energy error after two steps is smaller than after eight: the doublings go on to where it falls for good.
// Fails if: an error that grows with the first doublings is taken for rounding.
#[test]
fn a_lucky_coarse_run_is_no_rounding_floor() {
    let top = scene("heavy-top", &[]);
    let end_s = top.scene().info().horizon_s;
    let of = Of::Invariant(Invariant::Energy);
    let truth = ExactSamples::new(top.as_ref(), end_s, 64).at_every_step(of, 0.05);
    let need = Need { scene: top.as_ref(), truth: &truth, error: 0.05, end_s, unit: 2 };
    for candidate in candidates(top.as_ref(), &[MethodId::ImplicitEuler], &[]) {
        let found = search(&need, candidate, Precision::F64);
        assert!(matches!(found, Search::Found(_)), "{}: {found:?}", candidate.id());
    }
}

// Fails if: a budget is exceeded by the noise of a timing.
#[test]
fn a_budget_is_a_bound() {
    for budget in [2.0, 5.0, 20.0] {
        let chosen = Selection {
            methods: vec![MethodId::SemiImplicitEuler, MethodId::VelocityVerlet, MethodId::Rk4],
            schemes: Vec::new(),
            precisions: vec![Precision::F32, Precision::F64],
            ..selection(scene("pendulum", &[]), MethodId::Rk4, Precision::F64)
        };
        let question = Question { budget_us: Some(budget), ..Question::default() };
        let advice = advise(&chosen, question).expect("a good question");
        let cost = advice.picks[0].and_then(|pick| pick.ns_per_simulated_second()).expect("timed");
        assert!(cost <= 1e3 * budget, "{cost} ns of {budget} us:\n{}", advice.text);
    }
}

// Fails if: the norm of numbers that are not numbers is 0; a quantity that a scene does not have has the error 0.
#[test]
fn what_has_no_error_is_refused() {
    let question = Question { error: Some(1e-3), ..Question::default() };
    let ask =
        |scene, question| advise(&selection(scene, MethodId::Rk4, Precision::F64), question).map(|advice| advice.text);
    let second = Question { length: Some(Length::Seconds(1.0)), ..question };
    let driven = ask(scene("forced-oscillator", &[("drive", "1e200")]), second);
    assert!(!matches!(&driven, Ok(text) if text.contains("met")), "{driven:?}");
    let refused = ask(scene("pendulum", &[]), Question { of: Of::Invariant(Invariant::Momentum), ..question });
    let message = refused.expect_err("a pendulum has no momentum that is accounted for").to_string();
    assert!(message.contains("--of: pendulum has no momentum"), "{message}");
}

// Fails if: --of changes nothing; the energy is taken at another time.
#[test]
fn an_error_of_another_quantity_is_that_of_the_quantity() {
    let spring = scene("oscillator", &[]);
    let (end_s, steps) = (11.0, 2000);
    let candidate = candidates(spring.as_ref(), &[MethodId::ExplicitEuler], &[])[0];
    let energy = |seen: &Observation| {
        let entries = spring.scene().invariants(fx128::ZERO, seen);
        entries.iter().find(|entry| entry.invariant == Invariant::Energy).expect("kept").value[0]
    };
    let largest = Cell::new([0.0_f64; 2]);
    let see = |i: u64, seen: Observation| {
        let exact = spring.exact(fx128::lit(end_s) * fx128::lit(i as f64) / fx128::lit(steps as f64));
        let velocity = seen.distances(&exact).into_iter().find(|(q, _)| *q == Quantity::Velocity).expect("kept").1;
        let [a, b] = largest.get();
        largest.set([a.max(velocity), b.max((energy(&seen) - energy(&exact)).to_f64_abs())]);
    };
    let run = Run::new(candidate.scheme, Precision::F64, end_s, steps);
    spring.show(&run, Shown::To(&see)).expect("a step");
    let of = [Of::Quantity(Quantity::Velocity), Of::Invariant(Invariant::Energy)];
    for (of, expected) in of.into_iter().zip(largest.get()) {
        let truth = ExactSamples::new(spring.as_ref(), end_s, 64).at_every_step(of, expected);
        let need = Need { scene: spring.as_ref(), truth: &truth, error: expected, end_s, unit: 2 };
        let found = watched(&need, candidate, Precision::F64, steps).error.expect("finished");
        assert!((found / expected - 1.0).abs() < 1e-12, "{of:?}: {found} {expected}");
    }
}

trait Size {
    fn to_f64_abs(self) -> f64;
}

impl Size for fx128 {
    fn to_f64_abs(self) -> f64 {
        self.0.abs()
    }
}
