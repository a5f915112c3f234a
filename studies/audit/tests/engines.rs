//! Files that seven engines wrote, each with what is known of it: how it was computed, and what is wrong with it.

use std::path::PathBuf;

use audit::step::StepVerdict;
use audit::subject::Settings;
use audit::{Args, FileReport, judge};
use nalgebra::Vector3;

/// The box of all files: 3 kg, edges 1.5, 2, 1 m.
const INERTIA: [f64; 3] = [1.25, 0.8125, 1.5625];

fn settings(case: &str) -> Settings {
    let with = |scene: &str, set: &[(&str, &str)], inertia: Option<[f64; 3]>| Settings {
        scene: Some(scene.to_owned()),
        set: set.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect(),
        inertia: inertia.map(Vector3::from),
    };
    match case {
        "B" => with("constant-force", &[("gravity", "0,0,-9.81")], None),
        "C" => with("spring-3d", &[("stiffness", "12.5"), ("mass", "3"), ("anchor", "0.5,-0.25,1")], None),
        "E" => with("bouncing-ball", &[("radius", "0.25"), ("restitution", "0.5")], None),
        "F" => with("pendulum", &[("mass", "3"), ("length", "1.25"), ("inertia_pivot", "5.5")], None),
        // The moments about the fixed point: 3 kg at 1.25 m along the third axis.
        "G" => with("asymmetric-top", &[("mgl", "36.7875")], Some([5.9375, 5.5, 1.5625])),
        "H" => with("kepler", &[("mu", "1")], None),
        _ => with("torque-free-spin", &[], Some(INERTIA)),
    }
}

fn report(file: &str, record_every: u64) -> FileReport {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(format!("{file}.csv"));
    let name = file.split('/').nth(1).expect("engine/file");
    let args = Args { settings: settings(&name[..1]), record_every: Some(record_every), ..Args::default() };
    judge(&path, &args).unwrap_or_else(|error| panic!("{error}"))
}

fn faults(report: &FileReport) -> Vec<&'static str> {
    let mut ids: Vec<&str> = report.faults().map(|f| f.id).collect();
    ids.sort_unstable();
    ids
}

/// The engine's step as its source says: the parts that its name must have.
const IDENTIFIED: &[(&str, u64, &[&str])] = &[
    ("cannon-es/AG_240", 12, &["without-gyroscopic-term/linear"]),
    ("cannon-es/A3_240", 16, &["without-gyroscopic-term/linear", "v (1 - c)^h with c = 0.010000"]),
    ("cannon-es/Bdef_240", 16, &["semi-implicit-euler", "v (1 - c)^h with c = 0.010000"]),
    ("cannon-es/D_240", 12, &["semi-implicit-euler", "v (1 - c)^h with c = 0.350000"]),
    ("drake/A_480_discrete", 32, &["semi-implicit-euler/world-omega/quaternion never normalised"]),
    ("drake/A_240_runge_kutta3", 16, &["kutta3/world-omega/quaternion never normalised"]),
    ("drake/A_120_runge_kutta2", 8, &["heun/world-omega/quaternion never normalised"]),
    ("drake/F_480_runge_kutta3", 24, &["kutta3"]),
    ("drake/C_240_discrete", 32, &["semi-implicit-euler"]),
    ("jsbsim/A_240_AB2_AB2", 16, &["adams-bashforth-2/body-omega/quaternion normalised"]),
    ("jsbsim/A_240_AB3_AB3", 16, &["adams-bashforth-3/body-omega/quaternion normalised"]),
    ("jsbsim/A_240_Trapezoidal", 16, &["mean-of-two-derivatives/body-omega/quaternion normalised"]),
    ("jsbsim/A_240_full_default", 1, &["explicit-euler/body-omega/linear"]),
    ("mujoco/A_240_Euler", 16, &["semi-implicit-euler/body-omega/exponential"]),
    ("mujoco/A_240_RK4", 16, &["rk4-munthe-kaas"]),
    ("mujoco/A_240_implicitfast", 16, &["implicit-gyroscopic/exponential"]),
    ("mujoco/C_60_Euler", 2, &["semi-implicit-euler"]),
    ("mujoco/F_240_Euler", 12, &["semi-implicit-euler"]),
    ("mujoco/G_240_RK4", 12, &["rk4-munthe-kaas"]),
    ("mujoco/H_240_Euler", 16, &["semi-implicit-euler"]),
    ("mujoco/A_60_Euler_xpos_lag", 1, &["semi-implicit-euler/body-omega/exponential", "one step late"]),
    ("mujoco/C_60_Euler_xpos_lag", 2, &["semi-implicit-euler", "one step late"]),
    ("pybullet/A_240", 16, &["semi-implicit-euler/body-omega/exponential"]),
    ("pybullet/A3_240", 16, &["semi-implicit-euler/body-omega/exponential", "force -c (1 + |v|) v with c = 0.040000"]),
    ("pybullet/AG_240_maximal", 12, &["implicit-gyroscopic/exponential"]),
    ("pybullet/F_240", 12, &["semi-implicit-euler"]),
    ("pybullet/G_240", 12, &["semi-implicit-euler/body-omega/exponential"]),
    ("rapier_f64/A_60", 1, &["restored-momentum/linear, 4 substeps"]),
    ("rapier_f64/A_240_iter1", 16, &["restored-momentum/linear"]),
    ("rapier_f64/A_240_nogyro", 16, &["without-gyroscopic-term/linear, 4 substeps"]),
    ("rapier_f64/C_240", 32, &["semi-implicit-euler, 4 substeps, force held over the step"]),
    ("rapier_f64/C_240_iter1", 32, &["semi-implicit-euler"]),
];

// Fails if a candidate is dropped, a damping acts at another point of the step, or a tolerance lets another candidate in.
#[test]
fn steps_of_engines_in_double_precision_are_identified() {
    for (file, record_every, parts) in IDENTIFIED {
        let report = report(file, *record_every);
        let step = report.step.last().unwrap_or_else(|| panic!("{file}: no step"));
        assert_eq!(step.verdict, StepVerdict::Identified, "{file}: {:?}", step.candidates);
        let id = &step.candidates[0].id;
        assert!(parts.iter().all(|part| id.contains(part)), "{file}: {id}, expected {parts:?}");
    }
}

// Fails if the rounding of single precision is taken for that of double precision.
#[test]
fn steps_of_an_engine_in_single_precision_are_among_those_that_fit() {
    for (file, record_every, part) in [
        ("jolt/A_240_full", 1, "restored-momentum/exponential"),
        ("jolt/A3_240", 16, "without-gyroscopic-term/exponential, damping v (1 - c h) with c = 0.050000"),
        ("jolt/D_240", 12, "damping v (1 - c h) with c = 0.350000"),
    ] {
        let report = report(file, record_every);
        let step = report.step.last().unwrap_or_else(|| panic!("{file}: no step"));
        assert!(matches!(step.verdict, StepVerdict::Identified | StepVerdict::OneOf), "{file}: {:?}", step.verdict);
        let named = |id: &String| id.contains(part);
        assert!(
            step.candidates.iter().any(|c| named(&c.id) || c.same_as.iter().any(named)),
            "{file}: {:?}",
            step.candidates.iter().map(|c| &c.id).collect::<Vec<_>>()
        );
    }
}

/// Every fault of a file, and no other.
const FAULTS: &[(&str, u64, &[&str])] = &[
    ("cannon-es/AG_240", 12, &["gyroscopic-term-missing"]),
    ("cannon-es/A3_60", 1, &["angular-damping", "gyroscopic-term-missing", "linear-damping"]),
    ("cannon-es/Bdef_240", 16, &["linear-damping"]),
    ("cannon-es/D_240", 12, &["angular-damping", "linear-damping"]),
    ("drake/A_480_discrete", 32, &["quaternion-norm"]),
    ("drake/C_240_discrete", 32, &[]),
    ("drake/F_480_runge_kutta3", 24, &[]),
    ("jolt/A_60", 1, &[]),
    ("jolt/A_240_full", 1, &[]),
    ("jolt/A5_240", 1, &["angular-damping", "angular-velocity-clamped", "gyroscopic-term-missing", "linear-damping"]),
    ("jolt/D_240", 12, &["angular-damping", "linear-damping"]),
    ("jsbsim/A_240_AB2_AB2", 16, &[]),
    ("jsbsim/A_240_Trapezoidal", 16, &["attitude-lags"]),
    ("jsbsim/A_240_full_default", 1, &[]),
    ("mujoco/A_240_Euler", 16, &[]),
    ("mujoco/A_240_RK4", 16, &[]),
    ("mujoco/A_240_implicitfast", 16, &[]),
    ("mujoco/A5_240", 1, &["clock-reset"]),
    ("mujoco/C_60_Euler", 2, &[]),
    ("mujoco/D_240_Euler", 12, &["angular-damping", "linear-damping"]),
    ("mujoco/F_240_Euler", 12, &[]),
    ("mujoco/G_240_RK4", 12, &[]),
    ("mujoco/H_240_Euler", 16, &[]),
    ("mujoco/A_60_Euler_xpos_lag", 1, &["pose-late-by-one-step"]),
    ("mujoco/C_60_Euler_xpos_lag", 2, &["pose-late-by-one-step"]),
    ("pybullet/A_240", 16, &[]),
    ("pybullet/A5_240", 1, &["angular-damping", "angular-velocity-clamped", "linear-damping"]),
    ("pybullet/AG_240_maximal", 12, &[]),
    ("pybullet/E05_60", 1, &["restitution"]),
    ("rapier_f64/A_60", 1, &[]),
    ("rapier_f64/A_240_nogyro", 16, &["gyroscopic-term-missing"]),
    ("rapier_f64/C_240", 32, &[]),
];

// Fails if a check misses its fault, or finds one in a file that has none.
#[test]
fn faults_of_engines_are_named_and_no_others() {
    for (file, record_every, expected) in FAULTS {
        let report = report(file, *record_every);
        assert_eq!(&faults(&report), expected, "{file}");
    }
}

fn value(report: &FileReport, id: &str) -> f64 {
    report.findings.iter().find(|f| f.id == id).unwrap_or_else(|| panic!("no {id}")).value
}

// Fails if a number of the engines' settings is read wrong: limits in rad/s, dampings in 1/s, a norm, a restitution.
#[test]
fn numbers_of_faults_are_those_of_the_settings() {
    // Bullet limits each component to 100 rad/s, Jolt the norm to 47.12389 = 15 pi.
    assert_eq!(value(&report("pybullet/A5_240", 1), "angular-velocity-clamped"), 100.0);
    let limit = value(&report("jolt/A5_240", 1), "angular-velocity-clamped");
    assert!((limit - 15.0 * std::f64::consts::PI).abs() < 4.0 * f64::from(f32::EPSILON) * limit, "{limit}");
    // v (1 - c)^h loses at the rate -ln(1 - c); a row of the trapezoidal difference adds (c H)^2 / 12 of it.
    let rate = value(&report("cannon-es/D_240", 12), "linear-damping");
    let exact = -(1.0_f64 - 0.35).ln();
    let interval = 12.0 / 240.0;
    assert!((rate / exact - 1.0 + (exact * interval).powi(2) / 12.0).abs() < 1e-6, "{rate}");
    // q + h/2 omega q lengthens q by sqrt(1 + (h |omega| / 2)^2) a step, with 2.17 <= |omega| <= 2.60 of this motion.
    let norm = value(&report("drake/A_480_discrete", 32), "quaternion-norm");
    let grown = |omega: f64| (1.0 + (omega / 960.0).powi(2)).powf(4800.0 / 2.0);
    assert!(grown(2.17) < norm && norm < grown(2.6), "{norm}");
    // Bullet multiplies the restitutions of both bodies; one step of a contact adds h g of 5.9 m/s.
    let left = value(&report("pybullet/E05_60", 1), "restitution");
    assert!((left - 0.25).abs() < 0.05, "{left}");
}

// Largest errors over all rows against reference solutions that were integrated by another program (RK4, steps of 1/900 s
// and less, in NumPy; the spring from its closed form). Fails if an exact motion or the map onto its coordinates is wrong.
#[test]
fn errors_are_those_of_an_independent_reference() {
    for (file, record_every, quantity, reference) in [
        ("mujoco/A_240_implicitfast", 16, "attitude", 0.050914647555),
        ("rapier_f64/A_240_iter1", 16, "attitude", 0.017234525151),
        ("drake/A_480_discrete", 32, "attitude", 0.025820393996),
        ("mujoco/F_240_Euler", 12, "angle", 0.005225397554),
        ("mujoco/H_240_Euler", 16, "position", 0.025281877813),
        ("rapier_f64/C_240", 32, "position", 0.067536139826),
    ] {
        let report = report(file, record_every);
        let found =
            report.error.iter().find(|e| e.quantity == quantity).unwrap_or_else(|| panic!("{file}: no {quantity}"));
        // The reference's own error is below 1e-9.
        assert!((found.max - reference).abs() < 2e-9, "{file}: {} instead of {reference}", found.max);
    }
}
