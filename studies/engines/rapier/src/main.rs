//! Runs a free body in rapier3d and prints a trajectory as CSV.
//!
//! `cargo run --release -- case.json RATE SECONDS > rapier.csv`, where case.json is what
//! `exact --scene torque-free-spin --case` prints.

use rapier3d_f64::prelude::*;
use serde_json::Value;

fn number(value: &Value, name: &str) -> Result<f64, String> {
    value.as_f64().ok_or_else(|| format!("{name} is not in the case: give a free body, as torque-free-spin"))
}

fn run() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, path, rate, seconds] = &arguments[..] else { return Err("give case.json RATE SECONDS".to_owned()) };
    let positive =
        |text: &String| text.parse::<f64>().ok().filter(|x| *x > 0.0).ok_or(format!("'{text}': give a number > 0"));
    let (rate, seconds) = (positive(rate)?, positive(seconds)?);
    let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let case: Value = serde_json::from_str(&text).map_err(|error| format!("{path}: {error}"))?;
    let start = |name: &str| number(&case["start"][name], name);
    let parameters = case["parameters"].as_array().ok_or("parameters are not in the case")?;
    let inertia = parameters.iter().find(|p| p["name"] == "inertia").ok_or("inertia is not in the case")?;
    let moment = |i: usize| number(&inertia["value"][i], "inertia");

    let mass = MassProperties::new(Vector::ZERO, 1.0, Vector::new(moment(0)?, moment(1)?, moment(2)?));
    let omega = ["x", "y", "z"].map(|axis| start(&format!("omega_world_{axis}_rad_s")));
    let [x, y, z] = omega;
    let mut body = RigidBodyBuilder::dynamic()
        .additional_mass_properties(mass)
        .angvel(Vector::new(x?, y?, z?))
        .can_sleep(false)
        .gyroscopic_forces_enabled(true)
        .build();
    body.set_rotation(Rotation::from_xyzw(start("qx")?, start("qy")?, start("qz")?, start("qw")?), true);

    let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
    let handle = bodies.insert(body);
    let parameters = IntegrationParameters { dt: 1.0 / rate, ..Default::default() };
    let (mut pipeline, mut islands) = (PhysicsPipeline::new(), IslandManager::new());
    let (mut broad, mut narrow) = (DefaultBroadPhase::new(), NarrowPhase::new());
    let (mut joints, mut multibodies) = (ImpulseJointSet::new(), MultibodyJointSet::new());
    let (mut soft, mut ccd) = (SoftBodySet::new(), CCDSolver::new());

    println!("t,qw,qx,qy,qz,wx_world,wy_world,wz_world");
    for i in 0..=(seconds * rate).round() as u64 {
        let body = &bodies[handle];
        let (q, w) = (body.rotation(), body.angvel());
        println!("{},{},{},{},{},{},{},{}", i as f64 / rate, q.w, q.x, q.y, q.z, w.x, w.y, w.z);
        pipeline.step(
            Vector::ZERO,
            &parameters,
            &mut islands,
            &mut broad,
            &mut narrow,
            &mut bodies,
            &mut colliders,
            &mut joints,
            &mut multibodies,
            &mut soft,
            &mut ccd,
            &(),
            &(),
        );
    }
    Ok(())
}

fn main() -> std::process::ExitCode {
    match run() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("engine-rapier: {error}");
            std::process::ExitCode::from(2)
        }
    }
}
