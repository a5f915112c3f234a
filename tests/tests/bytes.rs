//! The rows of a small plan, byte for byte: a change that is meant to change no number changes none.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use integrator::methods::MethodId;
use measure::convergence::Convergence;
use measure::drift::DriftStudy;
use measure::rotation::Rotation;
use measure::study::{Selection, Study};
use measure::sweep::Progress;
use scenes::run::Precision;
use sha2::{Digest, Sha256};

const SCENES: [&str; 6] =
    ["oscillator", "quadratic-drag/fall", "kepler", "bouncing-ball", "torque-free-spin", "box-tumbling"];

fn rows<S: Study>(scene: &str) -> String {
    let selection = Selection {
        scenes: vec![scenes::by_id(scene).expect("a scene")],
        methods: MethodId::ALL.to_vec(),
        schemes: Vec::new(),
        precisions: Precision::ALL.to_vec(),
        steps: Vec::new(),
        length: None,
        draws: Default::default(),
        quick: true,
        looped: None,
        shard: None,
        progress: Progress::silent(),
    };
    reports::write_csv(&S::measure(&selection)).expect("rows have a form")
}

fn line<S: Study>(scene: &str) -> String {
    let digest = Sha256::digest(rows::<S>(scene));
    let hex = digest.iter().fold(String::new(), |mut hex, byte| {
        // Writing to a string does not fail.
        let _ = write!(hex, "{byte:02x}");
        hex
    });
    format!("{hex}  {} {scene}\n", S::ID)
}

// Fails if: a step, a scene or an estimator gives another bit anywhere. The eigenvalues of the stability study are left out: the
// linear algebra behind them picks its instructions by the processor.
#[test]
fn the_rows_of_a_small_plan_are_the_committed_bytes() {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/rows.sha256");
    let mut found = String::new();
    for scene in SCENES {
        found += &line::<Convergence>(scene);
        found += &line::<DriftStudy>(scene);
    }
    found += &line::<Rotation>("torque-free-spin");
    if std::env::var_os("UPDATE_ROWS").is_some() {
        std::fs::write(&path, &found).expect("the list can be written");
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    let changed: Vec<&str> = found.lines().filter(|line| !committed.contains(line)).collect();
    let remedy =
        "if the numbers are meant to change, run `UPDATE_ROWS=1 cargo test --release -p verification --test bytes`";
    assert!(changed.is_empty() && found == committed, "these rows have other bytes; {remedy}:\n{}", changed.join("\n"));
}
