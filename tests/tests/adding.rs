//! A new method is one file and one row, and so is a new scene: a copy of the tree gets the files of the guide `adding.md` as they are
//! written there, a general method, a step for rigid bodies, a scene of four dimensions and a rigid one, and every study runs with them.
//! Nothing is known of the four but what their files state.
//!
//! Ignored, because it compiles the workspace again: `cargo test --release -p verification --test adding -- --ignored`.
//! The copy lies in `target/adding` and is compiled only where it changed.
//!
//! Not seen here: the teaching page runs the methods of its committed module, which `studies/web/build.sh` makes.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use verification::programs::{PROGRAMS, text};

const METHOD: &str = "explicit-midpoint";
const STEP: &str = "mean-omega";
const SCENE: &str = "oscillator-in-four";

const BODY: &str = "braked-spin";
const GUIDE: &str = include_str!("../../reports/guides/adding.md");

/// The new files of the guide: a line with the path, then the block of code.
fn new_files() -> Vec<(String, String)> {
    let blocks = GUIDE.split("```rust\n").collect::<Vec<_>>();
    let of = |pair: &[&str]| {
        let path = pair[0].trim_end().lines().last().unwrap_or_default().trim_matches(['`', ':']).to_owned();
        (path, pair[1].split("```").next().unwrap_or_default().to_owned())
    };
    blocks.windows(2).map(of).collect()
}

/// The lines that name them: file, the line before, the line. Of a list in one line the line itself grows.
const LINES: [(&str, &str, &str); 12] = [
    (METHODS, "mod explicit_euler;\n", "mod explicit_midpoint;\n"),
    (METHODS, "pub use explicit_euler::ExplicitEuler;\n", "pub use explicit_midpoint::ExplicitMidpoint;\n"),
    (METHODS, "core explicit: ExplicitEuler, SemiImplicitEuler, VelocityVerlet, Rk4", ", ExplicitMidpoint"),
    (METHODS, "mod kutta3;\n", "mod mean_omega;\n"),
    (METHODS, "pub use kutta3::Kutta3;\n", "pub use mean_omega::MeanOmega;\n"),
    (METHODS, "        FreeSplitting, BodyOmega, Body;\n", "        MeanOmega, BodyOmega, Body;\n"),
    (CATALOGUE, "pub mod box_tumbling;\n", "pub mod braked_spin;\n"),
    (CATALOGUE, "pub use box_tumbling::BoxTumbling;\n", "pub use braked_spin::BrakedSpin;\n"),
    (
        CATALOGUE,
        "    \"box-tumbling\" => Rigid(BoxTumbling::default());\n",
        "    \"braked-spin\" => Rigid(BrakedSpin::default());\n",
    ),
    (CATALOGUE, "pub mod oscillator;\n", "pub mod oscillator_in_four;\n"),
    (CATALOGUE, "pub use oscillator::Oscillator;\n", "pub use oscillator_in_four::OscillatorInFour;\n"),
    (
        CATALOGUE,
        "    \"spring-chain\" => Particles(SpringChain::default());\n",
        "    \"oscillator-in-four\" => Particles(OscillatorInFour::default());\n",
    ),
];
const METHODS: &str = "integrator/src/methods/mod.rs";
const CATALOGUE: &str = "studies/scenes/src/catalogue/mod.rs";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace").to_owned()
}

/// Every file of the tree that git knows or would take, with its bytes.
fn tree() -> BTreeMap<String, Vec<u8>> {
    let listed = Command::new("git")
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .current_dir(root())
        .output()
        .expect("git runs");
    let names = String::from_utf8(listed.stdout).expect("names are UTF-8");
    let read = |name: &str| Some((name.to_owned(), fs::read(root().join(name)).ok()?));
    names.split('\0').filter(|name| !name.is_empty()).filter_map(read).collect()
}

/// The tree with the new files, and the names of the old files that had to be changed.
fn extended() -> (BTreeMap<String, Vec<u8>>, BTreeSet<&'static str>) {
    let mut files = tree();
    let changed = LINES.iter().map(|(file, ..)| *file).collect();
    for (file, before, line) in LINES {
        let content = String::from_utf8(files[file].clone()).expect("a source is UTF-8");
        let at = content.find(before).unwrap_or_else(|| panic!("{file} has no line {before:?}")) + before.len();
        files.insert(file.to_owned(), [&content[..at], line, &content[at..]].concat().into_bytes());
    }
    for (file, content) in new_files() {
        assert!(files.insert(file.clone(), content.into()).is_none(), "{file} is there already");
    }
    (files, changed)
}

/// Makes a directory hold these files and no others. A file that is right already keeps its time, and is not compiled again.
fn write(directory: &Path, files: &BTreeMap<String, Vec<u8>>) {
    fn remove_others(directory: &Path, wanted: &BTreeSet<PathBuf>) {
        for entry in fs::read_dir(directory).expect("a directory of the copy") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                remove_others(&path, wanted);
            } else if !wanted.contains(&path) {
                fs::remove_file(&path).expect("a file of the copy can be removed");
            }
        }
    }
    fs::create_dir_all(directory).expect("a directory below target");
    remove_others(directory, &files.keys().map(|name| directory.join(name)).collect());
    for (name, bytes) in files {
        let path = directory.join(name);
        if fs::read(&path).is_ok_and(|old| old == *bytes) {
            continue;
        }
        fs::create_dir_all(path.parent().expect("a file lies in a directory")).expect("a directory of the copy");
        fs::write(&path, bytes).expect("a file of the copy can be written");
    }
}

/// Whether a program of the copy wrote, in one of its CSVs, a row with all these words in it.
fn has_row(out: &Path, file: &str, words: &[&str]) -> bool {
    let rows = fs::read_to_string(out.join(file)).unwrap_or_default();
    rows.lines().any(|row| words.iter().all(|word| row.split(',').any(|cell| cell == *word)))
}

// Fails if: the guide has another line than the copy gets, or names a place where nothing is registered.
#[test]
fn the_guide_shows_every_line_that_names_the_new_files() {
    let names: Vec<String> = new_files().into_iter().map(|(path, _)| path).collect();
    assert_eq!(names.len(), 4, "{names:?}");
    for (file, _, line) in LINES {
        assert!(GUIDE.contains(line.trim_matches(['\n', ' '])), "the guide does not show '{line}' of {file}");
        assert!(GUIDE.contains(&format!("`{file}`")), "the guide does not name {file}");
    }
    let (files, changed) = extended();
    assert_eq!(changed, BTreeSet::from([METHODS, CATALOGUE]), "one list of methods, one of scenes");
    for name in names {
        // As rustfmt writes it: whoever copies it finds it as the workspace wants it.
        let scratch = tempfile::tempdir().expect("a temporary directory");
        let (copy, settings) = (scratch.path().join("new.rs"), root().join("rustfmt.toml"));
        fs::write(&copy, &files[&name]).expect("writable");
        let output = Command::new("rustfmt")
            .args(["--check", "--edition", "2024", "--config-path"])
            .arg(settings)
            .arg(&copy)
            .output()
            .expect("rustfmt is a component of the toolchain");
        assert!(output.status.success(), "{name} is not formatted\n{}", text(&output.stdout));
    }
}

// Fails if: a match names every method; a scene's dimension is one of a list; theory that was not worked out is promised; the
// new rows are missing from a study.
#[test]
#[ignore = "compiles the workspace again"]
fn every_study_runs_with_a_method_a_step_and_a_scene_that_are_one_file_and_one_row_each() {
    let (files, changed) = extended();
    assert_eq!(changed, BTreeSet::from([METHODS, CATALOGUE]), "one list of methods, one of scenes");
    let place = root().join("target/adding");
    let (copy, target) = (place.join("tree"), place.join("target"));
    write(&copy, &files);
    let build = Command::new(env!("CARGO"))
        .args(["build", "--release", "--quiet", "--locked", "-p", "programs", "--bins"])
        .env("CARGO_TARGET_DIR", &target)
        // What the copy has in common with the workspace is compiled already.
        .env("CARGO_BUILD_BUILD_DIR", root().join("target"))
        .current_dir(&copy)
        .output()
        .expect("cargo runs");
    assert!(build.status.success(), "{}", text(&build.stderr));

    let run = |program: &str, arguments: &[&str]| {
        let mut command = Command::new(target.join("release").join(program));
        let output = command.args(arguments).current_dir(&copy).output().expect("the program was built");
        let said = format!("{}{}", text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.code(), Some(0), "{program} {arguments:?}\n{said}");
    };
    let out = place.join("report");
    let _ = fs::remove_dir_all(&out);
    run("report", &["--quick", "--out", &out.to_string_lossy()]);
    for (file, words) in [
        ("convergence.csv", &[SCENE, METHOD][..]),
        ("convergence.csv", &["kepler", METHOD]),
        ("convergence.csv", &[SCENE, "rk4"]),
        ("drift.csv", &[SCENE, METHOD]),
        ("rotation.csv", &["heavy-top", STEP]),
        ("rotation.csv", &["heavy-top", "explicit-midpoint/body-omega"]),
        ("stability.limit.csv", &[SCENE, METHOD]),
        ("tradeoff.run.csv", &[SCENE, METHOD]),
        ("tradeoff.run.csv", &["torque-free-spin", STEP]),
        ("convergence.csv", &[BODY, METHOD]),
        ("convergence.csv", &[BODY, "rk4"]),
        ("rotation.csv", &[BODY, STEP]),
        ("tradeoff.run.csv", &[BODY, STEP]),
    ] {
        assert!(has_row(&out, file, words), "{file} has no row of {words:?}");
    }
    let chosen = ["--quick", "--scene", SCENE, "--scene", "torque-free-spin", "--method", METHOD];
    PROGRAMS.iter().filter(|program| **program != "report").for_each(|program| run(program, &chosen));
    run("ensemble", &["--quick", "--scene", "kepler", "--method", METHOD, "--members", "64"]);
    run("tradeoff", &["--scene", SCENE, "--method", METHOD, "--error", "1e-3"]);
    run("stability", &["--scene", SCENE, "--method", METHOD]);
    run("convergence", &["--scene", BODY, "--scene", SCENE]);
    run("bounds", &["--quick"]);
}
