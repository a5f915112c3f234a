//! Advice of the tradeoff study, checked by running what it advises. Times are not looked at: they are not the same twice.

use integrator::methods::MethodId;
use scenes::run::Precision;

use measure::study::{Length, Selection};
use measure::sweep::Progress;
use measure::tradeoff::advice::{Advice, Question, advise};
use measure::tradeoff::candidate::candidates;
use measure::tradeoff::exact::ExactSamples;
use measure::tradeoff::quantity::Of;
use measure::tradeoff::search::{Need, Search, attempt, finer, search};
use verification::programs::program;

fn selection(id: &str) -> Selection {
    Selection {
        scenes: vec![scenes::by_id(id).expect("a scene of the catalogue")],
        methods: MethodId::ALL.to_vec(),
        schemes: Vec::new(),
        precisions: vec![Precision::F64],
        steps: Vec::new(),
        length: None,
        quick: false,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    }
}

/// Largest step of each method, found by running: it keeps the error, twice the step does not, and neither do finer ones break it.
#[test]
fn an_advised_step_keeps_the_error_and_twice_the_step_does_not() {
    for (id, end_s) in [("pendulum", 2.75), ("kepler", 2.25), ("oscillator", 11.0), ("heavy-top", 1.75)] {
        let scene = scenes::by_id(id).expect("a scene");
        for error in [1e-2, 1e-4] {
            let truth = ExactSamples::new(scene.as_ref(), end_s, 64).at_every_step(Of::default(), error);
            let need = Need { scene: scene.as_ref(), truth: &truth, error, end_s, unit: 2 };
            let mut found = 0;
            for candidate in
                candidates(scene.as_ref(), &[MethodId::SemiImplicitEuler, MethodId::VelocityVerlet, MethodId::Rk4], &[])
            {
                let Search::Found(tried) = search(&need, candidate, Precision::F64) else { continue };
                found += 1;
                let error_at =
                    |steps: u64| attempt(&need, candidate, Precision::F64, steps).error.unwrap_or(f64::INFINITY);
                assert!(error_at(tried.steps) <= error, "{id} {candidate:?} {tried:?}");
                assert!(error_at(tried.steps / 2) > error, "{id} {candidate:?} {tried:?}");
                for finer in [1.2, 1.5, 3.0] {
                    let steps = (tried.steps as f64 / 2.0 * finer).ceil() as u64 * 2;
                    assert!(error_at(steps) <= error, "{id} {candidate:?}: {steps} steps miss what {tried:?} meets");
                }
            }
            assert!(found >= 3, "{id} at {error}: {found} methods");
        }
    }
}

#[test]
fn rounding_and_too_many_steps_are_told_apart() {
    let scene = scenes::by_id("oscillator").expect("a scene");
    let truth = ExactSamples::new(scene.as_ref(), 2.75, 64).at_every_step(Of::default(), 1e-9);
    let need = |error| Need { scene: scene.as_ref(), truth: &truth, error, end_s: 2.75, unit: 2 };
    let ask = |error, method, precision| {
        let candidate = candidates(scene.as_ref(), &[method], &[])[0];
        search(&need(error), candidate, precision)
    };
    // f32 has seven digits.
    assert!(matches!(ask(1e-9, MethodId::Rk4, Precision::F32), Search::Never { least: Some(_), .. }));
    assert!(matches!(ask(1e-9, MethodId::Rk4, Precision::F64), Search::Found(_)));
    // error = C h with C of the order of 1: 1e-12 takes 1e12 steps.
    let Search::TooMany { about: Some(steps), .. } = ask(1e-12, MethodId::ExplicitEuler, Precision::F64) else {
        panic!("explicit Euler cannot have 1e-12");
    };
    assert!((1e11..1e14).contains(&steps), "{steps}");
}

#[test]
fn advice_in_frames_takes_whole_substeps_and_budgets_are_kept_by_counting() {
    let chosen = selection("tennis-racket");
    let question =
        Question { error: Some(1e-3), length: Some(Length::Seconds(4.0)), rate_hz: Some(60.0), ..Question::default() };
    let advice = advise(&chosen, question).expect("a good question");
    let pick = advice.picks[0].expect("it can be had");
    assert!(advice.possible && pick.tried.steps.is_multiple_of(240));
    assert!(pick.tried.error.is_some_and(|error| error <= 1e-3));
    assert!((pick.h_s * pick.tried.steps as f64 - 4.0).abs() < 1e-12);
    assert!(advice.text.contains("substeps per frame") && advice.text.contains("a whole frame"), "{}", advice.text);
    // The other way round: what the budget buys is an error.
    let budget = Question { budget_us: Some(50.0), error: None, ..question };
    let bought = advise(&chosen, budget).expect("a good question").picks[0].expect("something can be had");
    assert!(bought.tried.error.is_some() && bought.tried.steps.is_multiple_of(240));
    // Not even one step a frame.
    let nothing = advise(&chosen, Question { budget_us: Some(1e-6), ..budget }).expect("a good question");
    assert!(!nothing.possible && nothing.picks == [None]);
}

#[test]
fn a_question_without_sense_is_refused_with_its_remedy() {
    let good = Question { error: Some(1e-3), ..Question::default() };
    let cases = [
        (Question { error: Some(0.0), ..good }, true, "--error"),
        (Question { error: Some(-1.0), ..good }, true, "--error"),
        (Question { error: Some(f64::NAN), ..good }, true, "--error"),
        (Question { rate_hz: Some(0.0), ..good }, true, "--rate"),
        (Question { length: Some(Length::Seconds(f64::INFINITY)), ..good }, true, "--for"),
        (Question { budget_us: Some(-5.0), ..good }, true, "--budget-us"),
        (good, false, "--scene pendulum"),
        (Question { error: None, rate_hz: Some(60.0), ..good }, true, "--error 1e-3"),
    ];
    for (question, has_scene, word) in cases {
        let message = question.check(has_scene).expect_err("refused").to_string();
        assert!(message.contains(word), "{question:?}: {message}");
    }
    assert!(good.check(true).is_ok());
    let long = Question { length: Some(Length::Seconds(1e6)), rate_hz: Some(1e3), ..good };
    assert!(advise(&selection("pendulum"), long).expect_err("refused").to_string().contains("shorten --for"));
}

fn asked(id: &str, methods: &[MethodId], precision: Precision, question: Question) -> Advice {
    let chosen = Selection { methods: methods.to_vec(), precisions: vec![precision], ..selection(id) };
    advise(&chosen, question).expect("a good question")
}

// Explicit Euler keeps 0.3 m over a second and has no stable step: a loop of frames goes on, a run of a second does not.
#[test]
fn a_loop_of_frames_is_not_advised_a_step_that_is_not_stable() {
    let second = Question { error: Some(0.3), length: Some(Length::Seconds(1.0)), ..Question::default() };
    let frames = Question { rate_hz: Some(60.0), ..second };
    let euler = |question| asked("oscillator", &[MethodId::ExplicitEuler], Precision::F64, question);
    let refused = euler(frames);
    assert!(!refused.possible && refused.picks == [None], "{}", refused.text);
    assert!(refused.text.contains("no stable step"), "{}", refused.text);
    let once = euler(second);
    assert!(once.possible && once.text.contains("NOT STABLE"), "{}", once.text);
    // A budget buys it no more than an error does.
    let bought = euler(Question { error: None, budget_us: Some(1e3), ..frames });
    assert!(!bought.possible && bought.text.contains("no stable step"), "{}", bought.text);
    // Among others another one is advised.
    let other = asked("oscillator", MethodId::ALL, Precision::F64, frames).picks[0].expect("RK4 is stable");
    assert!(other.candidate.method() != Some(MethodId::ExplicitEuler) && other.limit.allows(other.h_s), "{other:?}");
}

// omega = 4 / s at one frame a second: a step of semi-implicit Euler is stable up to h = 2 / omega.
#[test]
fn a_loop_of_frames_is_cut_into_stable_substeps() {
    let question =
        Question { error: Some(1e3), length: Some(Length::Seconds(40.0)), rate_hz: Some(0.1), ..Question::default() };
    let pick =
        asked("oscillator", &[MethodId::SemiImplicitEuler], Precision::F64, question).picks[0].expect("it can be had");
    assert!(pick.limit.allows(pick.h_s) && pick.tried.steps.is_multiple_of(4), "{pick:?}");
}

// 1e-18 is below the rounding of every arithmetic that is tried; RK4 in f64 comes nearest.
#[test]
fn a_refusal_names_the_arithmetic_that_came_nearest() {
    let question = Question { error: Some(1e-18), length: Some(Length::Seconds(2.0)), ..Question::default() };
    let all =
        Selection { methods: vec![MethodId::Rk4], precisions: Precision::ALL.to_vec(), ..selection("oscillator") };
    let text = advise(&all, question).expect("a good question").text;
    assert!(text.contains("nearest: Runge-Kutta 4 in f64: rounding") || text.contains("in f64: rounding"), "{text}");
    assert!(!text.contains("f32"), "{text}");
    assert!(text.contains("double-double was not tried: --precision double-double"), "{text}");
    let chosen = asked("oscillator", &[MethodId::Rk4], Precision::F64, question).text;
    assert!(!chosen.contains("double-double"), "{chosen}");
}

#[test]
fn the_finer_steps_counted_are_those_that_were_tried() {
    // Half of 2 steps: 1.04 x 1 .. 2 x 1 are all 2, 2.83 x 1 is 3 and 4 x 1 is 4.
    assert_eq!(finer(1, 2), [2, 3, 4]);
    let question = Question { error: Some(0.3), length: Some(Length::Seconds(1.0)), ..Question::default() };
    let advice = asked("oscillator", &[MethodId::Rk4], Precision::F64, question);
    let pick = advice.picks[0].expect("it can be had");
    assert!(
        pick.tried.finer < 8 && advice.text.contains(&format!("{} finer steps keep", pick.tried.finer)),
        "{}",
        advice.text
    );
}

#[test]
fn a_budget_for_what_is_not_timed_is_refused() {
    let chosen =
        Selection { methods: vec![MethodId::ImplicitEuler], precisions: vec![Precision::F32], ..selection("pendulum") };
    let budget = Question { budget_us: Some(5e3), ..Question::default() };
    let message = advise(&chosen, budget).expect_err("not timed").to_string();
    assert!(message.contains("is not timed in f32"), "{message}");
}

#[test]
fn an_answer_refuses_the_flags_that_it_would_not_hear() {
    let asked: [(&str, &[&str]); 2] = [
        ("tradeoff", &["--scene", "pendulum", "--error", "0.1"]),
        ("stability", &["--scene", "pendulum", "--method", "rk4"]),
    ];
    let flags: [&[&str]; 6] =
        [&["--json"], &["--markdown"], &["--out", "x"], &["--figures-only"], &["--format", "both"], &["--steps", "8"]];
    let refused = |name: &str, arguments: &[&str], flag: &str| {
        let output = program(name).args(arguments).output().expect("the binary was built");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{name} {arguments:?}: {message}");
        assert!(message.contains(&format!("{flag}: an answer ")) && message.contains("leave it out"), "{message}");
    };
    for (name, question) in asked {
        for flag in flags {
            refused(name, &[question, flag].concat(), flag[0]);
        }
    }
    refused("stability", &["--step", "0.1", "--from", "x"], "--from");
}
