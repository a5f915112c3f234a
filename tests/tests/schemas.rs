//! Every JSON that a program writes is what its committed schema says, and no schema says more than is written.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use verification::programs::{program, text};
use verification::schema::Schema;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace").to_owned()
}

fn schema(name: &str) -> Schema {
    let path = root().join(format!("reports/schemas/{name}.schema.json"));
    Schema::read(&fs::read_to_string(path).expect("committed"))
}

/// What a program prints, as JSON.
fn json(binary: &str, arguments: &[&str], directory: &Path) -> Value {
    let output = program(binary).args(arguments).current_dir(directory).output().expect("the binary was built");
    let said = text(&output.stdout);
    serde_json::from_str(&said)
        .unwrap_or_else(|e| panic!("{binary} {arguments:?}: {e}\n{said}{}", text(&output.stderr)))
}

/// Each value fits the schema; together they have all of its properties, and each of these is described.
fn assert_fits(name: &str, values: &[Value]) {
    let mut schema = schema(name);
    for value in values {
        assert_eq!(schema.faults(value), Vec::<String>::new(), "{name}");
    }
    let (unmet, silent) = schema.unmet();
    assert_eq!(silent, Vec::<String>::new(), "{name}: not described");
    assert_eq!(unmet, Vec::<String>::new(), "{name}: written by none of {} outputs", values.len());
}

// Fails if: a key of a study's or report's JSON is renamed, added, left out or of another kind without its schema.
#[test]
fn claims_and_manifest_are_what_their_schemas_say() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let small =
        ["--quick", "--scene", "oscillator", "--scene", "tennis-racket", "--method", "rk4", "--precision", "f64"];
    let runs: [(&str, &[&str]); 4] = [
        (
            "convergence",
            &[
                "--quick",
                "--scene",
                "kepler",
                "--set",
                "eccentricity=0.3",
                "--steps",
                "64,128",
                "--for",
                "1rev",
                "--json",
            ],
        ),
        ("rotation", &["--quick", "--scene", "tennis-racket", "--method", "rk4", "--json"]),
        ("ensemble", &["--quick", "--scene", "kepler", "--members", "4", "--seed", "3", "--json"]),
        ("report", &[]),
    ];
    let mut claims = Vec::new();
    for (binary, arguments) in runs {
        let own = if binary == "report" { [&small[..], &["--json"]].concat() } else { arguments.to_vec() };
        claims.push(json(binary, &own, directory.path()));
    }
    let loops = ["--quick", "--scene", "pendulum", "--method", "rk4", "--loop", "substeps=2"];
    let output = program("loops").args(loops).current_dir(directory.path()).output().expect("the binary was built");
    assert!(output.status.success());
    let part = ["--quick", "--scene", "oscillator", "--method", "rk4", "--shard", "1/2"];
    let output = program("drift").args(part).current_dir(directory.path()).output().expect("the binary was built");
    assert!(output.status.success());
    let manifest = |name: &str| fs::read_to_string(directory.path().join("target").join(name).join("manifest.json"));
    let manifests: Vec<Value> = ["convergence", "ensemble", "report", "loops", "drift"]
        .map(|name| serde_json::from_str(&manifest(name).expect("written")).expect("JSON"))
        .into();
    assert_fits("claims", &claims);
    assert_fits("manifest", &manifests);
    // A claim that is not tested has a word of its own, and none else.
    let mut wrong = claims[0].clone();
    wrong["claims"][0]["verdict"] = "not tested".into();
    assert_eq!(schema("claims").faults(&wrong).len(), 1);
    wrong["claims"][0].as_object_mut().expect("a claim").remove("scene");
    wrong["holds"] = 1.into();
    assert_eq!(schema("claims").faults(&wrong).len(), 3);
}

// Fails if: the JSON of `order` changes without its schema.
#[test]
fn the_json_of_order_is_what_its_schema_says() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let write = |name: &str, rows: &str| fs::write(directory.path().join(name), rows).expect("writable");
    write("errors.csv", "h,error,capped\n0.1,1e-2,1\n0.05,2.5e-3,0.5\n0.025,,0.25\n0.0125,1.5e-4,0.125\n");
    write(
        "values.csv",
        "h,f,wavy,apart,flat\n4,1.2000,1.0000,1.0000,1.0\n2,1.0500,2.0000,2.0000,1.0\n1,1.0125,1.0000,4.0000,1.0\n",
    );
    let errors = json("order", &["errors.csv", "--errors", "--expect", "2", "--json"], directory.path());
    let values = json("order", &["values.csv", "--values", "--json"], directory.path());
    assert_fits("order", &[errors, values]);
}

// Fails if: the JSON of `audit` changes without its schema. The files are of engines, the last two the exact motion itself.
#[test]
fn the_json_of_audit_is_what_its_schema_says() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let data = root().join("studies/audit/tests/data");
    let file = |name: &str| data.join(name).to_str().expect("a plain path").to_owned();
    let (jolt, mujoco) = (file("jolt/A3_240.csv"), file("mujoco/C_240_RK4.csv"));
    for (name, rate) in [("15.csv", "15"), ("30.csv", "30")] {
        let exact = ["--scene", "torque-free-spin", "--for", "4", "--rate", rate, "--out", name];
        let output = program("exact").args(exact).current_dir(directory.path()).output().expect("built");
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    let inertia = ["--inertia", "1.25,0.75,1.75", "--json", "-"];
    let body = [&["--scene", "torque-free-spin"][..], &inertia].concat();
    let outputs = [
        json("audit", &["--json", "-", &jolt], directory.path()),
        json("audit", &[&[mujoco.as_str()][..], &inertia].concat(), directory.path()),
        json("audit", &[&["15.csv", "30.csv"][..], &body].concat(), directory.path()),
    ];
    assert_fits("audit", &outputs);
}

// Fails if: the JSON of `exact --case` changes without its schema, for any scene.
#[test]
fn the_case_of_every_scene_is_what_its_schema_says() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let cases: Vec<Value> =
        scenes::IDS.iter().map(|id| json("exact", &["--scene", id, "--case"], directory.path())).collect();
    assert_fits("case", &cases);
}

// Fails if: the JSON of `bounds` changes without its schema.
#[test]
fn the_json_of_bounds_is_what_its_schema_says() {
    let small = ["--quick", "--scene", "oscillator", "--method", "rk4", "--format", "json"];
    let rows = json("bounds", &small, &root());
    assert!(rows.as_array().is_some_and(|rows| rows.len() > 3), "{rows}");
    assert_fits("bounds", &[rows]);
}
