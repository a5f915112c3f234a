//! `exact`: what it prints is the motion, and the audit reads it back as such.

use std::f64::consts::FRAC_1_SQRT_2;
use std::fs;
use std::path::Path;
use std::process::Output;

use tempfile::TempDir;
use verification::programs::{program, text};

fn exact(arguments: &[&str]) -> Output {
    program("exact").args(arguments).output().expect("the binary was built")
}

/// The header and the records of a CSV.
fn table(output: &Output) -> (Vec<String>, Vec<Vec<f64>>) {
    let csv = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let mut lines = csv.lines();
    let header = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let number = |cell: &str| cell.parse().expect("a number");
    (header, lines.map(|line| line.split(',').map(number).collect()).collect())
}

fn audited(file: &Path, arguments: &[&str]) -> audit::Report {
    let set: Vec<(String, String)> = arguments[1..]
        .iter()
        .map(|pair| pair.split_once('=').expect("NAME=VALUE"))
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .collect();
    let settings = audit::subject::Settings { scene: Some(arguments[0].to_owned()), set, inertia: None };
    let args = audit::Args { files: vec![file.to_owned()], settings, ..Default::default() };
    audit::run(&args).expect("the file is read")
}

/// Scenes that the audit knows, with the parameters that `exact list` shows for their defaults.
const READ_BACK: [(&str, &[&str]); 10] = [
    ("tennis-racket", &["inertia=0.75,1,1.5"]),
    ("torque-free-spin", &["inertia=1.25,0.75,1.75"]),
    ("symmetric-top/disc", &["inertia_1=1.25", "inertia_3=2.25"]),
    ("pendulum", &["mass=0.75", "length=1.5", "gravity=9.8125"]),
    ("kepler", &["mu=2"]),
    ("oscillator", &["mass=1.5", "stiffness=6"]),
    ("bouncing-ball", &["gravity=9.8125"]),
    ("box-tumbling", &["inertia=0.808333,0.683333,0.141667", "gravity=0,0,-9.8"]),
    ("heavy-top", &["inertia_1=1.25", "inertia_3=0.75", "mgl=2.5"]),
    ("pendulum/rotation", &["mass=0.75", "length=1.5", "gravity=9.8125"]),
];

// Fails if: a column has another meaning for the two programs (order, frame, unit, sign), or a digit is lost.
#[test]
fn the_audit_finds_the_exact_motion_in_what_is_printed() {
    let directory = TempDir::new().expect("a temporary directory");
    for (scene, parameters) in READ_BACK {
        let file = directory.path().join("exact.csv");
        let output = exact(&["--scene", scene, "--rate", "60", "--for", "2", "--out", file.to_str().expect("plain")]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let arguments = [&[scene], parameters].concat();
        let report = audited(&file, &arguments);
        assert_eq!(report.exit_code(), 0, "{scene}: {}", report.text());
        let said = report.text();
        assert!(said.contains("no step: the exact motion to rounding") || scene == "bouncing-ball", "{scene}: {said}");
    }
    // Negative control: another gravity, another moment.
    for (scene, wrong) in [("pendulum", "length=1.25"), ("tennis-racket", "inertia=0.75,1.1,1.5")] {
        let file = directory.path().join("wrong.csv");
        exact(&["--scene", scene, "--rate", "60", "--for", "2", "--out", file.to_str().expect("plain")]);
        let arguments = [&[scene, wrong][..], &["gravity=9.8125"][..usize::from(scene == "pendulum")]].concat();
        assert_eq!(audited(&file, &arguments).exit_code(), 1, "{scene} {wrong}");
    }
    // A moment that is 2 % off is 5 % of the gyroscopic term.
    let file = directory.path().join("disc.csv");
    exact(&["--scene", "symmetric-top/disc", "--rate", "60", "--for", "2", "--out", file.to_str().expect("plain")]);
    assert_eq!(audited(&file, &["symmetric-top", "inertia_1=1.25", "inertia_3=2.2"]).exit_code(), 1);
}

// Fails if: a time, a position or an energy is another. The numbers are those of the formulas, worked out here.
#[test]
fn the_numbers_are_those_of_the_formulas() {
    let oscillator =
        ["--scene", "oscillator", "--set", "mass=2", "--set", "stiffness=8", "--set", "x0=1", "--set", "v0=0"];
    let (header, rows) = table(&exact(&[&oscillator[..], &["--at", "0,0.25,1"]].concat()));
    assert_eq!(header, ["t_s", "x_m", "vx_m_s", "energy_J"]);
    for (row, t) in rows.iter().zip([0.0_f64, 0.25, 1.0]) {
        // omega = 2 rad/s, E = k x0^2 / 2 = 4 J.
        let expected = [t, (2.0 * t).cos(), -2.0 * (2.0 * t).sin(), 4.0];
        assert!(row.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 4.0 * f64::EPSILON), "{row:?} {expected:?}");
    }
    // A disc that turns about its axis by a quarter turn: q = (cos, 0, 0, sin)(pi / 4).
    let disc = ["--scene", "symmetric-top/disc", "--set", "attitude=1,0,0,0", "--set", "omega=0,0,0.5"];
    let quarter = std::f64::consts::PI.to_string();
    let (header, rows) = table(&exact(&[&disc[..], &["--at", &quarter]].concat()));
    let at = |name: &str| rows[0][header.iter().position(|column| column == name).expect("a column")];
    assert!((at("qw") - FRAC_1_SQRT_2).abs() < 1e-15 && (at("qz") - FRAC_1_SQRT_2).abs() < 1e-15, "{rows:?}");
    assert!(at("omega_world_z_rad_s") == 0.5 && at("omega_body_z_rad_s") == 0.5 && at("omega_body_x_rad_s") == 0.0);
}

// Fails if: an attitude changes its sign from one record to the next, though the body turns by little.
#[test]
fn the_quaternion_is_continuous() {
    for scene in ["tennis-racket", "symmetric-top/rod", "heavy-top", "sphere-torque"] {
        let (header, rows) = table(&exact(&["--scene", scene, "--rate", "100", "--for", "10"]));
        let first = header.iter().position(|name| name == "qw").expect("an attitude");
        assert_eq!(rows.len(), 1001);
        let dot = |a: &[f64], b: &[f64]| (first..first + 4).map(|i| a[i] * b[i]).sum::<f64>();
        assert!(rows.windows(2).all(|w| dot(&w[0], &w[1]) > 0.99), "{scene}");
    }
}

// Fails if: the case lacks a parameter, or its start is not the first record.
#[test]
fn the_case_says_what_the_rows_start_from() {
    for scene in scenes::IDS {
        let case: serde_json::Value =
            serde_json::from_slice(&exact(&["--scene", scene, "--case"]).stdout).expect("JSON");
        let (header, rows) = table(&exact(&["--scene", scene, "--at", "0"]));
        let known = scenes::by_id(scene).expect("a scene");
        let names: Vec<&str> = known.scene().parameters().iter().map(|p| p.name).collect();
        let listed = case["parameters"].as_array().expect("parameters");
        assert_eq!(listed.iter().map(|p| p["name"].as_str().expect("a name")).collect::<Vec<_>>(), names, "{scene}");
        for (name, x) in header.iter().zip(&rows[0]).skip(1) {
            assert_eq!(case["start"][name].as_f64(), Some(*x), "{scene} {name}");
        }
        assert!(case["conventions"]["quaternion"].as_str().is_some_and(|text| text.contains("w, x, y, z")));
        assert_eq!(case["columns"].as_array().map(Vec::len), Some(header.len()));
    }
}

// Fails if: a wrong question is answered, or the message lacks the place or the remedy.
#[test]
fn a_wrong_question_is_refused_with_place_and_remedy() {
    let directory = TempDir::new().expect("a temporary directory");
    let file = directory.path().join("times.txt");
    fs::write(&file, "t\n0\n0.5\nsoon\n").expect("writable");
    let times = file.to_str().expect("plain");
    let cases: [(&[&str], &str, &str); 8] = [
        (&["--scene", "pendulm"], "pendulm", "did you mean 'pendulum'"),
        (&["--scene", "pendulum", "--set", "length=-1"], "length", "> 0"),
        (&["--scene", "pendulum", "--at", "0,-1"], "--at: '-1' is no time", "from 0 on"),
        (&["--scene", "pendulum", "--rate", "0"], "--rate", "above zero"),
        (&["--scene", "pendulum", "--times", times], "times.txt:4:1: 'soon' is no time", "seconds"),
        (&["--scene", "pendulum", "--times", "/no/file"], "/no/file: cannot be read", "give a text"),
        (&["--scene", "bouncing-ball/inelastic", "--at", "1e6"], "is known before", "leave the time"),
        (&["--scene", "pendulum", "--rate", "1e9", "--for", "1e9"], "too many", "smaller"),
    ];
    for (arguments, place, remedy) in cases {
        let output = exact(arguments);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.contains(place) && message.contains(remedy), "{arguments:?}: {message}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    fs::write(&file, "# mine\ntime;x\n0;1\n0.5;2\n").expect("writable");
    assert_eq!(table(&exact(&["--scene", "pendulum", "--times", times])).1.len(), 2);
}
