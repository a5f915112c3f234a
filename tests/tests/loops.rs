//! The loop around a step: public cases with their numbers, the plain loop bit for bit, and claims that break.

use std::collections::BTreeMap;

use integrator::methods::MethodId;
use integrator::{Model, State, drive};
use measure::game_loop::Loop;
use measure::game_loop::drive::{Job, Until};
use measure::loops::clocks::{f32_clock, in_turn, steps_of_f32_clock};
use measure::loops::contacts::contacts;
use measure::loops::laws::{Fall, Spring, at, clamp, drawn, falls, jumps, leapfrog_energy, terminal_speeds};
use measure::loops::{Experiment, Loops, Row};
use measure::study::{Selection, Study};
use nalgebra::Vector1;
use proptest::prelude::*;
use reports::Verdict;
use verification::programs::{program, text};

fn near(value: Option<f64>, right: f64, digit: f64) {
    assert!(value.is_some_and(|v| (v - right).abs() <= 0.5 * digit), "{value:?} is not {right} +- {}", 0.5 * digit);
}

// Fails if: a step falls by another rule. Printed: free fall of 1 s at 60 Hz ends g h T / 2 = 0.08175 m low.
#[test]
fn a_fall_is_as_low_as_printed() {
    let rows = falls(9.81, 1.0 / 60.0, 60);
    near(rows[1].value, -0.08175, 1e-10);
    near(rows[0].value, 0.08175, 1e-10);
}

// Fails if: the half kick is a whole one, or goes the other way. Printed for a jump of 0.941 m at 50 Hz.
#[test]
fn a_jump_has_the_printed_peaks() {
    let rows = jumps(9.81, (2.0 * 9.81 * 0.941_f64).sqrt(), 0.02);
    near(rows[0].value, 0.898_208_567_1, 1e-10);
    near(rows[1].value, 0.940_980_403_6, 1e-10);
}

// Fails if: damping is applied before the force, or by another rule. Printed for F / m = 800, damping 30 per s.
#[test]
fn damped_speeds_are_as_printed() {
    for (rate_hz, speed) in [(30.0, 0.0), (60.0, 13.333_333_333_3), (200.0, 22.666_666_666_7)] {
        let rows = terminal_speeds(800.0, 30.0, 1.0 / rate_hz);
        near(rows[0].value, speed, 1e-10);
        // The implicit rule has the speed of the motion itself.
        near(rows[1].value, 26.666_666_666_7, 1e-10);
    }
}

// Fails if: a stored velocity is read as though it were that of the position's time. Printed: +-0.05, and -0.0025 to 0.
#[test]
fn the_energy_of_leapfrog_depends_on_how_it_is_read() {
    let rows = leapfrog_energy(1.0, 0.1, 4096);
    // The extreme lies between two of 4096 phases: within 1 - cos of their distance, and the distance is below 1e-2.
    for (row, right) in rows.iter().zip([-0.05, 0.05, -0.0025, 0.0]) {
        near(row.value, right, 1e-4 * right.abs().max(0.0025));
    }
}

// Fails if: the clamp cuts another part, or the clock is not an f32. Printed: 71980 steps instead of 72000.
#[test]
fn clocks_are_as_printed() {
    near(f32_clock(0.3, 21_600.0).value, 71_980.0, 1e-9);
    near(clamp(0.05, 0.032, 1000)[0].value, 18.0, 1e-9);
    near(drawn(10.0, 9.81, 1.0 / 60.0)[2].value, 0.166_666_666_7, 1e-10);
}

// Fails if: an impact is turned at another point of the step. g = 98.1 m/s^2 at 120 Hz: the rules differ by 2 g h |w|.
#[test]
fn a_ball_gains_or_loses_by_the_rule_of_contact() {
    let values: Vec<Option<f64>> = contacts(98.1, 1.0, 1.0 / 120.0, 100).iter().map(|row| row.value).collect();
    for (value, right) in values.iter().zip([-1.0, -1.0, 1.0, 0.0]) {
        near(*value, right, 1e-10);
    }
    // By hand, one bounce from 0.01 m at -10 m/s: end of step and after kick.
    let (g, h, y, v) = (98.1, 1.0 / 120.0, 0.01, -10.0);
    let one = |rule: &str| {
        let plan = Loop::read(&[format!("contact={rule}")]).expect("settings");
        let model = Fall { gravity: g, restitution: Some(1.0) };
        let job = Job { model: &model, method: MethodId::SemiImplicitEuler, plan: &plan, h_s: h, start: at(y, v) };
        job.run(Until::Frames(1), |_| {}).expect("finite").state
    };
    let kicked = v - g * h;
    assert_eq!(one("end"), at(y + h * kicked, -kicked));
    // Above the floor there is nothing to turn before the move.
    assert_eq!(one("after-kick"), at(y + h * kicked, kicked));
    let tau = 2.0 * y / ((v * v + 4.0 * g * y).sqrt() - v);
    let up = (v - g * tau).abs();
    let end = (h - tau) * (up - g * (h - tau));
    let found = one("impact");
    assert!((found.q.x - end).abs() < 1e-14 && (found.v.x - (up - g * (h - tau))).abs() < 1e-12, "{found:?}");
}

// Fails if: frames follow one another in another order or number. 'Factor 2.0 per two frames' is that of omega = 14.03 rad/s.
#[test]
fn frames_in_turn_have_the_factor_of_their_product() {
    // z1 z2 = 0.0065 w^2 and z1 + z2 = 0.18 w: trace -2.5, so that r + 1 / r = 2.5, at w^2 = (0.0324 - sqrt(0.0324^2 - 18 c)) / (2 c), c = 0.0065^2.
    let c = 0.0065_f64.powi(2);
    let square = (0.0324 - (0.0324_f64.powi(2) - 18.0 * c).sqrt()) / (2.0 * c);
    near(in_turn(square.sqrt(), 0.05, 0.13).value, 2.0, 1e-10);
}

// Fails if: a sum in f32 is summed in another precision. An independent count: the sum itself.
#[test]
fn the_theory_of_an_f32_clock_is_that_of_the_sum() {
    for (h, end) in [(0.3, 21_600.0), (1.0 / 60.0, 3600.0), (0.1, 10_000.0), (0.25, 4096.0), (1.0 / 144.0, 600.0)] {
        let (mut t, mut steps) = (0.0_f32, 0.0);
        while f64::from(t) < end {
            t += h as f32;
            steps += 1.0;
        }
        let theory = steps_of_f32_clock(h, end);
        assert!((theory - steps).abs() <= 1.0, "{h} {end}: {theory} {steps}");
    }
}

// Fails if: the default loop does anything beside the step.
#[test]
fn the_plain_loop_is_the_driver_bit_for_bit() {
    struct Walk<'a>(&'a Spring);
    impl integrator::methods::Visitor<f64, Spring> for Walk<'_> {
        type Output = State<Vector1<f64>>;
        fn visit<A: integrator::Method<f64, Spring>>(self, method: &A) -> Self::Output {
            drive::advance(method, self.0, at(1.0, 0.25), 0.03, 777).expect("finite")
        }
    }
    let spring = Spring { omega: 2.5 };
    for &method in MethodId::ALL {
        let plain = Loop::default();
        let job = Job { model: &spring, method, plan: &plain, h_s: 0.03, start: at(1.0, 0.25) };
        let seen = job.run(Until::Frames(777), |_| {}).expect("finite");
        assert_eq!(seen.state, method.visit(Walk(&spring)), "{}", method.id());
        assert!((seen.simulated_s - 777.0 * 0.03).abs() < 1e-13 && seen.steps == 777);
    }
}

/// x'' = cos t: a force that sees the clock.
struct Driven;
impl Model<f64> for Driven {
    type Config = Vector1<f64>;
    fn rate(&self, t: f64, _s: &State<Self::Config>) -> Vector1<f64> {
        Vector1::new(t.cos())
    }
}

// Fails if: substeps see the time of the frame, or a pattern's times are not summed.
#[test]
fn the_force_sees_the_time_of_the_substep() {
    let run = |settings: &[&str], h_s: f64, frames: u64| {
        let plan = Loop::read(settings).expect("settings");
        let job = Job { model: &Driven, method: MethodId::Rk4, plan: &plan, h_s, start: at(-1.0, 0.0) };
        job.run(Until::Frames(frames), |_| {}).expect("finite")
    };
    // x = -cos t; the error of RK4 is h^4 T / 2880 or less.
    for (settings, frames) in
        [(&["substeps=4"][..], 50), (&["frames=0.05,0.15"], 50), (&["inner=0.025"], 50), (&["jitter=0.4:3"], 50)]
    {
        let seen = run(settings, 0.1, frames);
        let error = seen.state.q.x + seen.simulated_s.cos();
        assert!(error.abs() < 0.15_f64.powi(4) * 5.0 / 2880.0 * 2.0, "{settings:?}: {error}");
    }
}

fn everything() -> Selection {
    Selection {
        scenes: scenes::all(),
        methods: MethodId::ALL.to_vec(),
        schemes: Vec::new(),
        precisions: scenes::run::Precision::ALL.to_vec(),
        steps: Vec::new(),
        length: None,
        draws: Default::default(),
        quick: false,
        looped: None,
        shard: None,
        progress: measure::sweep::Progress::silent(),
    }
}

// Fails if: a claim holds although its loop did something else. The mutant of a law gives a row the number of a neighbour, that of another
// setting of the same loop; the mutant of an order gives a sweep the errors of another choice.
#[test]
fn every_claim_holds_and_is_broken_by_another_loop() {
    let rows = Loops::measure(&everything());
    let verdicts = |rows: &[Row]| -> BTreeMap<String, Verdict> {
        Loops::claims(rows).into_iter().map(|claim| (claim.id.clone(), claim.verdict)).collect()
    };
    let right = verdicts(&rows);
    let not: Vec<_> = right.iter().filter(|(_, verdict)| **verdict != Verdict::Holds).collect();
    assert!(right.len() > 35 && not.is_empty(), "{} claims, {not:?}", right.len());
    let broken = |mutated: &[Row], id: &str| {
        let after = verdicts(mutated);
        assert_eq!(after[id], Verdict::Broken, "{id}");
        let others: Vec<_> = right.iter().filter(|(other, v)| *other != id && after[*other] != **v).collect();
        assert!(others.is_empty(), "{id} also breaks {others:?}");
    };
    let mut laws: Vec<&str> =
        rows.iter().filter(|r| r.experiment == Experiment::Law).map(|r| r.choice.as_str()).collect();
    laws.dedup();
    for law in laws {
        let own: Vec<usize> =
            (0..rows.len()).filter(|&i| rows[i].experiment == Experiment::Law && rows[i].choice == law).collect();
        let mut mutated = rows.clone();
        let at = own
            .iter()
            .find(|&&i| own.iter().any(|&j| rows[j].theory != rows[i].theory && rows[j].quantity == rows[i].quantity));
        match at {
            Some(&i) => {
                let other =
                    own.iter().find(|&&j| rows[j].theory != rows[i].theory && rows[j].quantity == rows[i].quantity);
                mutated[i].value = other.and_then(|&j| rows[j].value);
            }
            // One number for all: velocity Verlet is not reached without the half kick, by h a / 2.
            None => mutated[own[0]].value = Some(0.05),
        }
        broken(&mutated, &format!("loops.{law}"));
    }
    let mut mutated = rows.clone();
    for row in mutated.iter_mut().filter(|r| r.experiment == Experiment::Jitter) {
        row.value = Some(0.0);
    }
    broken(&mutated, "loops.jitter-growth");
    // The plain sweep's errors stand for those of a frozen force, and the other way round.
    for (choice, donor, id) in [
        ("four substeps, force frozen", "plain", "loops.order.four-substeps-force-frozen.rk4"),
        ("four fresh substeps", "four substeps, force frozen", "loops.order.four-fresh-substeps.rk4"),
        ("uneven frames", "interpolated", "loops.order.uneven-frames.rk4"),
        ("interpolated", "plain", "loops.order.interpolated.rk4"),
    ] {
        let errors: BTreeMap<_, _> = rows
            .iter()
            .filter(|r| r.choice == donor && r.method == "rk4" && r.experiment == Experiment::Error)
            .map(|r| ((r.subject.clone(), r.quantity.clone(), r.frames), r.value))
            .collect();
        let mut mutated = rows.clone();
        for row in mutated.iter_mut().filter(|r| r.choice == choice && r.method == "rk4") {
            row.value = errors[&(row.subject.clone(), row.quantity.clone(), row.frames)];
        }
        broken(&mutated, id);
    }
}

proptest! {
    // Fails if: a setting is not shown as it is read, or the name of another is taken.
    #[test]
    fn a_loop_is_read_from_what_it_shows(
        substeps in 2_u32..64, clamp in 1e-4..1.0_f64, c in 0.0..50.0_f64, pick in 0_usize..6, seed in any::<u64>(),
    ) {
        let settings = [
            format!("substeps={substeps} force=frozen"),
            format!("clamp={clamp} inner={} drawn=interpolated", clamp / 3.0),
            format!("damping=exponential:{c} damped=before-move"),
            format!("jitter={}:{seed} clock=sum-f32", clamp / 2.0),
            format!("frames={clamp},{} position=f32 velocity=f32", 2.0 * clamp),
            "start=half-kick read=synchronised contact=impact".to_owned(),
        ];
        let read = |text: &str| Loop::read(&text.split(' ').collect::<Vec<_>>()).expect("settings");
        let plan = read(&settings[pick]);
        prop_assert!(plan != Loop::default());
        prop_assert_eq!(&read(&plan.to_string()), &plan);
    }
}

// Fails if: an answer hides that a loop is unstable, or wrong input ends in anything but 2 with its place.
#[test]
fn the_command_answers_and_refuses() {
    let ask = |arguments: &[&str]| {
        let output = program("loops").args(arguments).output().expect("the binary was built");
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    };
    let spring = ["--scene", "oscillator", "--set", "mass=1", "--set", "stiffness=210.25", "--step", "0.05"];
    let euler = ["--method", "semi-implicit-euler"];
    let (code, said, _) = ask(&[&spring[..], &euler, &["--loop", "frames=0.05,0.13"]].concat());
    assert!(code == Some(1) && said.contains("NOT stable") && said.contains("per 2 frames"), "{said}");
    let (code, said, _) = ask(&[&spring[..], &euler, &["--loop", "clamp=0.032"]].concat());
    assert!(code == Some(0) && said.contains("0.9900 s behind, 36.00 %"), "{said}");
    // omega = 14.5 rad/s. At z = h omega = 2 an error grows linearly, which is not exponential; above it by z^2 / 2 - 1 + z sqrt(z^2 - 4) / 2.
    for (step, code_of_it, verdict) in [
        ("0.1379310344827586", Some(0), "  stable: an error changes by a factor of 1.000000 "),
        ("0.1379308965517241", Some(0), "  stable: an error changes by a factor of 1.000000 "),
        ("0.1379311724137931", Some(1), "NOT stable: an error grows by a factor of 1.002832 "),
    ] {
        let near_two = ["--step", step, "--for", "2"];
        let (code, said, _) = ask(&[&spring[..6], &euler, &near_two, &["--loop", "substeps=1"]].concat());
        assert!(code == code_of_it && said.contains(verdict), "{step}: {code:?} {said}");
    }
    // A frame shorter than the inner step draws the start, at its own time.
    let early = ["--step", "0.01", "--for", "0.01", "--loop", "inner=0.02", "--loop", "drawn=interpolated"];
    let (code, said, _) = ask(&[&spring[..6], &euler, &early].concat());
    assert!(
        code == Some(0) && said.contains("configuration at the end: 0 (") && !said.contains("drawn:"),
        "{code:?} {said}"
    );
    for (arguments, place) in [
        (&["--loop", "substeps=x"][..], "--loop substeps"),
        (&["--loop", "contct=end"], "did you mean 'contact'"),
        (&["--loop", "frames=0.1,-1"], "'-1' is no length of a frame"),
        (&["--loop", "frames=missing.csv"], "missing.csv: cannot be read"),
        (&["--method", "rk4", "--loop", "contact=no-move"], "give --method semi-implicit-euler"),
        (&["--scene", "torque-free-spin"], "every scene chosen is a rigid body"),
    ] {
        let scene: &[&str] = if arguments.contains(&"--scene") { &[] } else { &["--scene", "oscillator"] };
        let (code, _, error) = ask(&[scene, &["--step", "0.01"], arguments].concat());
        assert!(code == Some(2) && error.contains(place), "{arguments:?}: {code:?} {error}");
    }
}
