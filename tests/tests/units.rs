//! Units on the command line: errors, lengths of runs, steps; and a damping by ratio or by coefficient.

use faer::fx128;
use integrator::{Real, Single};
use measure::study::Length;
use programs::plan::{Plan, RunLength};
use scenes::any::AnyScene;
use scenes::observation::Quantity;
use scenes::settings;
use verification::programs::{program, text};

/// Exit code, standard output and standard error.
fn ask(binary: &str, arguments: &str) -> (Option<i32>, String, String) {
    let output = program(binary).args(arguments.split(' ')).output().expect("the binary was built");
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

const BOX: &str = "--scene box-tumbling --for 0.5 --method rk4 --precision f64 --error";

// Fails if: a unit is not taken, or an angle is taken for the larger of a position and an angle.
#[test]
fn an_error_in_degrees_is_one_of_the_attitude() {
    let (code, out, message) = ask("tradeoff", &format!("{BOX} 1deg"));
    assert_eq!(code, Some(0), "{out}{message}");
    assert!(out.contains("an error of at most 0.0174533 rad in the attitude"), "{out}");
    let (_, out, _) = ask("tradeoff", &format!("{BOX} 5mm"));
    assert!(out.contains("an error of at most 0.005 m in the position"), "{out}");
    let (_, out, _) = ask("tradeoff", &format!("{BOX} 1e-3"));
    assert!(out.contains("an error of at most 0.001 m and rad over"), "{out}");
    let (_, out, _) = ask("tradeoff", &format!("{BOX} 1mJ"));
    assert!(out.contains("J in the energy"), "{out}");
}

// Fails if: a per cent is one of something else than the quantity's largest size. |x| of the oscillator is at most its amplitude,
// sqrt(x0^2 + (v0 / w)^2) = sqrt(0.5625 + 0.390625) = 0.976281 m, which it reaches nearly at one of the samples.
#[test]
fn a_per_cent_is_one_of_the_size_of_the_quantity() {
    let (code, out, message) = ask("tradeoff", "--scene oscillator --method rk4 --precision f64 --error 1%");
    assert_eq!(code, Some(0), "{message}");
    let error = out.split("at most ").nth(1).and_then(|rest| rest.split(' ').next()).map(str::parse::<f64>);
    let error = error.expect("an error").expect("a number");
    // 64 samples over 5.5 rad of phase: the nearest is within 0.043 rad of the turn, 1 - cos of which is below 1e-3.
    assert!((0.00976281 * (1.0 - 1e-3)..=0.00976282).contains(&error), "{error}");
}

#[test]
fn units_that_do_not_fit_are_refused_with_a_remedy() {
    let wrong = [
        ("tradeoff", "--scene pendulum --error 1dge", "--error '1dge': unit 'dge': unknown; did you mean 'deg'?"),
        (
            "tradeoff",
            "--scene pendulum --error 1mm",
            "pendulum has no position; give --of attitude, or angular-velocity",
        ),
        ("tradeoff", "--scene pendulum --error 1deg --of energy", "its unit is of rad, and --of energy is in J"),
        ("tradeoff", "--scene pendulum --error 1e-3 --of energi", "quantity 'energi': unknown; did you mean 'energy'?"),
        ("tradeoff", "--scene tennis-racket --error 1%", "an attitude has no size"),
        (
            "tradeoff",
            "--scene pendulum --error 1e-3 --for 2mins",
            "--for '2mins': unit 'mins': unknown; did you mean 'min'?",
        ),
        ("tradeoff", "--scene heavy-top --error 1e-3 --for 10rev", "heavy-top has no period of its own; give seconds"),
        ("exact", "--scene linear-drag --for 1rev", "linear-drag has no period of its own"),
        ("exact", "--scene kepler --for 1ref", "did you mean 'rev'?"),
        ("stability", "--scene pendulum --method rk4 --step 1rev", "periods are no unit of a step"),
        ("stability", "--scene pendulum --method rk4 --step 1/0", "--step '1/0': not a positive number"),
        ("convergence", "--scene oscillator --for 0s", "--for '0s': not a positive number"),
        ("convergence", "--scene oscillator --set c=1", "parameter 'c': unknown"),
    ];
    for (binary, arguments, expected) in wrong {
        let (code, out, message) = ask(binary, arguments);
        assert_eq!(code, Some(2), "{arguments}: {out}{message}");
        assert!(message.contains(expected), "{arguments}: {message}");
    }
}

// Fails if: a fraction is cut to its first number, or a unit is forgotten.
#[test]
fn a_step_is_taken_as_a_part_of_a_second() {
    let answer =
        |step: &str| ask("stability", &format!("--scene oscillator --method semi-implicit-euler --step {step}"));
    let (one, same) = (answer("1/64"), answer("15.625ms"));
    assert_eq!(one.0, Some(0), "{}", one.2);
    assert_eq!(one.1, same.1);
    assert!(one.1.contains("0.015625"), "{}", one.1);
}

// Fails if: a period is not that of the exact motion. Where it is, the motion is the same again after it.
#[test]
fn after_a_period_the_motion_is_the_same_again() {
    let mut periodic = 0;
    for scene in scenes::all().iter().filter(|scene| !scene.is_rigid()) {
        let Some(period_s) = scene.scene().period_s() else { continue };
        // What is damped or driven from another state comes back only in part, and crossed fields let the charge drift.
        if scene.id().starts_with("damped") || scene.id().starts_with("forced") || scene.id() == "charged-particle" {
            continue;
        }
        periodic += 1;
        let [start, after] = [0.0, period_s].map(|t| scene.exact(fx128::lit(t)));
        for (quantity, error) in start.distances(&after) {
            let turn = std::f64::consts::TAU;
            let error = if quantity == Quantity::Attitude { error.min((error - turn).abs()) } else { error };
            // The period is rounded to f64, and the fastest motion here moves at most 40 of its units per second.
            let tolerance = 64.0 * f64::EPSILON * period_s * 40.0;
            assert!(error <= tolerance, "{}: {quantity:?} {error:e} after {period_s} s", scene.id());
        }
    }
    assert!(periodic >= 10, "{periodic}");
    // The zeros of a damped swing are half a period apart: x'' = 0 at neither, so that x changes its sign.
    let damped = scenes::by_id("damped-oscillator").expect("a scene");
    let (period_s, zeta, w) = (damped.scene().period_s().expect("under-damped"), 0.125_f64, 2.0);
    let x = |t: f64| damped.exact(fx128::lit(t)).vector(Quantity::Position)[0].to_f64();
    let ratio = x(0.5 + period_s) / x(0.5);
    assert!((ratio - (-zeta * w * period_s).exp()).abs() < 1e-13, "{ratio}");
}

fn with(settings: &[&str]) -> Result<Box<dyn AnyScene>, String> {
    let set = settings.iter().map(|s| (*s).to_owned()).collect();
    let plan = Plan { scene: vec!["damped-oscillator".to_owned()], set, ..Plan::default() };
    plan.selection().map(|mut selection| selection.scenes.remove(0)).map_err(|error| error.to_string())
}

fn zeta(scene: &dyn AnyScene) -> f64 {
    let all = scene.scene().parameters();
    all.iter().find(|p| p.name == "zeta").expect("a parameter").value.parse().expect("a number")
}

// Fails if: the coefficient is taken before mass and stiffness are set, in whatever order they are given.
#[test]
fn a_damping_is_set_by_its_ratio_or_by_its_coefficient() {
    // zeta = c / (2 sqrt(k m)) = 0.8 / (2 sqrt(4 x 0.25)) = 0.4
    for settings in [["c=0.8", "mass=0.25", "stiffness=4"], ["mass=0.25", "stiffness=4", "damping=0.8"]] {
        assert!((zeta(with(&settings).expect("a scene").as_ref()) - 0.4).abs() <= 0.4 * 2.0 * f64::EPSILON);
    }
    let both = ["mass=0.25", "stiffness=4", "zeta=0.4", "c=0.8"];
    assert_eq!(zeta(with(&both).expect("they agree").as_ref()), 0.4);
    let refused = |settings: &[&str]| with(settings).err().expect("a refusal");
    assert!(refused(&["zeta=0.5", "c=0.8", "mass=0.25", "stiffness=4"]).contains("contradicts zeta = 0.5; give one"));
    assert!(refused(&["c=0.8", "damping=0.9"]).contains("parameter 'damping' = 0.9: contradicts c = 0.8"));
    assert!(refused(&["c=-1"]).contains("parameter 'c' = -1: makes zeta = -0.16"));
    assert!(refused(&["c=much"]).contains("must be a finite number"));
    assert!(refused(&["d=1"]).contains("parameter 'd': unknown"));
    // The driven one has the coefficient of its own, and takes the ratio.
    let mut driven = scenes::by_id("forced-oscillator").expect("a scene");
    settings::apply(driven.as_mut(), &[("zeta", "0.25")]).expect("a ratio");
    let damping = driven.scene().parameters().into_iter().find(|p| p.name == "damping").expect("it has one").value;
    // 2 zeta sqrt(k m) = 0.5 sqrt(6 x 1.5) = 1.5
    assert!((damping.parse::<f64>().expect("a number") - 1.5).abs() <= 1.5 * 2.0 * f64::EPSILON);
}

// Fails if: a plan file loses the unit, or a length in seconds is written otherwise than as a number.
#[test]
fn a_length_in_periods_survives_the_plan_file() {
    for (length, line) in [(Length::Periods(100.0), "for = \"100rev\""), (Length::Seconds(2.5), "for = 2.5")] {
        let plan = Plan { length: Some(RunLength(length)), scene: vec!["kepler".to_owned()], ..Plan::default() };
        let toml = plan.to_toml().expect("it has a form");
        assert!(toml.contains(line), "{toml}");
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(file.path(), toml).expect("writable");
        assert_eq!(Plan::read(file.path()).expect("a plan"), plan);
    }
}

// Fails if: two presets of a scene read alike in the list, or a scene does not tell what else it takes.
#[test]
fn presets_are_described_one_by_one() {
    let (code, out, _) = ask("convergence", "list");
    assert_eq!(code, Some(0));
    let about = |id: &str| {
        let line = out.lines().find(|line| line.split_whitespace().next() == Some(id));
        line.unwrap_or_else(|| panic!("{id} is not listed")).trim_start().trim_start_matches(id).trim().to_owned()
    };
    let mut all: Vec<String> = scenes::IDS.iter().map(|id| about(id)).collect();
    all.sort();
    all.dedup();
    // The two free bodies of `torque_free_spin.rs` differ in their start alone.
    assert!(all.len() + 1 >= scenes::IDS.len(), "{} lines for {} scenes", all.len(), scenes::IDS.len());
    let (_, out, _) = ask("convergence", "list damped-oscillator");
    assert!(out.contains("in the place of zeta") && out.contains("period (--for 10rev) 3.1664 s"), "{out}");
}
