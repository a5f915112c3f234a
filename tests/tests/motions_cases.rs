//! Exact motions at parameters that once gave a wrong answer, none, or one after minutes; and parameters that are refused.
//!
//! `data/motions.csv` holds values of 34 digits from an independent computation (mpmath at 60 to 700 digits): linear equations by
//! the roots of their characteristic polynomial, the ball bounce by bounce, a charge by the exponential series of its matrix, a
//! sphere and a heavy top by power series in many short steps.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use faer::fx128;
use integrator::Real;
use scenes::any::AnyScene;
use scenes::by_id;
use scenes::observation::{Observation, Value};
use scenes::run::Precision;
use verification::parse_fx128;

fn scene(id: &str, settings: &str) -> Box<dyn AnyScene> {
    let mut scene = by_id(id).unwrap_or_else(|e| panic!("{e}"));
    let name = scene.id();
    for setting in settings.split_whitespace() {
        let (parameter, value) = setting.split_once('=').expect("name=value");
        scene.scene_mut().set(name, parameter, value).unwrap_or_else(|e| panic!("{e}"));
    }
    scene
}

fn components(seen: &Observation, quantity: &str) -> Vec<fx128> {
    let (_, value) = seen.values.iter().find(|(q, _)| q.id() == quantity).expect("a quantity of the scene");
    match value {
        Value::Vector(components) => components.clone(),
        Value::Rotation(q) => q.wxyz().to_vec(),
    }
}

/// The largest distance, of the nearer sign for a quaternion; infinite if one is not a number.
fn apart(found: &[fx128], truth: &[fx128]) -> f64 {
    let of = |sign: f64| {
        let each = found.iter().zip(truth).map(|(&a, &b)| (a - b * fx128::lit(sign)).0.abs());
        each.fold(0.0_f64, |most, x| if x.is_finite() { most.max(x) } else { f64::INFINITY })
    };
    if truth.len() == 4 { of(1.0).min(of(-1.0)) } else { of(1.0) }
}

/// Fails if a motion is off by more than 8 eps of its size, or takes more than a second.
#[test]
fn motions_have_their_independent_values() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data/motions.csv");
    let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut wrong = Vec::new();
    for record in reader.records() {
        let record = record.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let [id, settings, t, quantity, value] = [0, 1, 2, 3, 4].map(|i| &record[i]);
        let truth: Vec<fx128> = value.split(';').map(parse_fx128).collect();
        let t: f64 = t.parse().expect("a time");
        let scene = scene(id, settings);
        scene.scene().check().unwrap_or_else(|e| panic!("{e}"));
        let began = Instant::now();
        let seen = [scene.exact_in(Precision::F64, t), scene.exact(fx128::lit(t))];
        assert!(began.elapsed() < Duration::from_secs(1), "{id} {settings} at {t}: {:?}", began.elapsed());
        let size = truth.iter().map(|c| c.0.abs()).fold(0.0, f64::max);
        for (seen, eps) in seen.iter().zip([8.0 * f64::EPSILON, 1e-24]) {
            let error = apart(&components(seen, quantity), &truth);
            if error > eps * size {
                wrong.push(format!("{id} {settings} at {t}: {quantity} off by {:.1e}, bound {eps:.1e}", error / size));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Fails if a parameter without an answer in double-double is let through, or another one is blamed.
#[test]
fn parameters_without_an_answer_are_refused_by_name() {
    let cases = [
        ("oscillator", "stiffness=1e40", "stiffness"),
        ("forced-oscillator", "drive=1e30", "drive"),
        ("pendulum", "omega=1e20", "omega"),
        ("kepler", "semi_major=1e-20", "mu"),
        ("charged-particle", "magnetic=1e30,0,0", "magnetic"),
        ("charged-particle", "magnetic=0,0,0", "magnetic"),
        ("spring-chain", "stiffness=1e40", "stiffness"),
        ("bouncing-ball", "x0=1e-16 v0=0 restitution=0.9999999999", "x0"),
        ("bouncing-ball", "x0=1e-9 v0=0 restitution=0.5", "restitution"),
        ("constant-force", "x0=1e308,0,0 v0=1e308,0,0", "v0"),
        ("principal-axis-torque", "torque=1e20", "torque"),
        ("sphere-torque", "torque=1e20,0,0", "torque"),
        ("symmetric-top/disc", "omega=1e20,0,0", "omega"),
        ("torque-free-spin", "omega=1e20,0,0", "omega"),
        ("heavy-top", "mgl=1e40", "mgl"),
    ];
    for (id, settings, parameter) in cases {
        let any = scene(id, settings);
        // A horizon that follows the parameters may leave a phase that has an answer.
        let Err(refused) = any.scene().check() else {
            let end = any.exact_in(Precision::F64, any.scene().info().horizon_s);
            let finite = |value: &Value| match value {
                Value::Vector(v) => v.iter().all(|c| c.is_finite()),
                Value::Rotation(q) => q.is_finite(),
            };
            assert!(
                end.values.iter().all(|(_, value)| finite(value)),
                "{id} {settings} is let through without an answer"
            );
            continue;
        };
        let message = refused.to_string();
        assert!(message.contains(&format!("'{parameter}'")), "{id} {settings}: {message}");
    }
}

/// Fails if a parameter that has an answer is refused, or its motion is not finite from start to end.
#[test]
fn odd_parameters_have_an_answer_at_once() {
    let cases = [
        ("torque-free-spin", "inertia=3,5,7 omega=0,0.4,1e-155"),
        ("torque-free-spin", "inertia=1.25e-23,0.75e-23,1.75e-23"),
        ("torque-free-spin", "inertia=1.25e-300,0.75e-300,1.75e-300 omega=1e-150,1e-151,1e-152"),
        ("symmetric-top/rod", "inertia_1=1e250 inertia_3=1e249"),
        ("sphere-torque", "torque=0,0,0"),
        ("sphere-torque", "torque=1e12,1e3,1"),
        ("sphere-torque", "inertia=1e-290 torque=1e-300,1e-290,1e-320"),
        ("heavy-top", "inertia_1=1e-30 inertia_3=1e-30 mgl=1e-29"),
        ("bouncing-ball", "gravity=1e9"),
        ("quadratic-drag/rise", "drag=1e-300"),
        ("damped-oscillator", "zeta=1e200"),
        ("pendulum", "angle=1e30 omega=1e-200"),
        ("kepler", "anomaly=1e300"),
    ];
    for (id, settings) in cases {
        let scene = scene(id, settings);
        scene.scene().check().unwrap_or_else(|e| panic!("{e}"));
        let began = Instant::now();
        for k in 0..=8 {
            let t = scene.scene().info().horizon_s * f64::from(k) / 8.0;
            for precision in [Precision::F32, Precision::F64, Precision::DoubleDouble] {
                // There is no such time in f32.
                if precision == Precision::F32 && t > f64::from(f32::MAX) {
                    continue;
                }
                for (quantity, value) in &scene.exact_in(precision, t).values {
                    let finite = match value {
                        Value::Vector(v) => v.iter().all(|c| c.is_finite()),
                        Value::Rotation(q) => q.is_finite(),
                    };
                    assert!(finite, "{id} {settings} at {t}: {} in {precision:?}: {value:?}", quantity.id());
                }
            }
        }
        assert!(began.elapsed() < Duration::from_secs(2), "{id} {settings}: {:?}", began.elapsed());
    }
}
