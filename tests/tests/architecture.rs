//! The direction of imports: crates by `cargo metadata`, files inside a crate by their `use` lines.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// The crates from the ground up. Each may import those before it and no other.
const LAYERS: [&str; 9] =
    ["integrator", "reports", "scenes", "audit", "measure", "gate", "programs", "web", "verification"];
/// What is not allowed although it points down: these two know nothing of each other.
const STRANGERS: [(&str, &str); 1] = [("reports", "integrator")];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace").to_owned()
}

// Fails if: a crate depends on one that stands above it, or a crate of the workspace is missing from the list.
#[test]
fn crates_import_only_those_below_them() {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let place = |name: &str| LAYERS.iter().position(|layer| *layer == name);
    let mut wrong = Vec::new();
    for package in packages {
        let name = package["name"].as_str().expect("a name");
        let Some(height) = place(name) else {
            wrong.push(format!("{name}: not in the list of layers"));
            continue;
        };
        for dependency in package["dependencies"].as_array().expect("dependencies") {
            let Some(other) = dependency["name"].as_str().filter(|other| place(other).is_some()) else { continue };
            if place(other) >= Some(height) || STRANGERS.contains(&(name, other)) {
                wrong.push(format!("{}: imports {other}, which is not below {name}", package["manifest_path"]));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A file of a crate with its path in modules: `src/plot/axis.rs` is `["plot", "axis"]`.
type Module = Vec<String>;

fn modules(source: &Path) -> BTreeMap<Module, String> {
    fn visit(directory: &Path, path: &Module, found: &mut BTreeMap<Module, String>) {
        for entry in std::fs::read_dir(directory).expect("a directory of sources") {
            let file = entry.expect("an entry").path();
            let stem = file.file_stem().expect("a name").to_string_lossy().into_owned();
            if file.is_dir() {
                if stem != "bin" {
                    visit(&file, &[&path[..], &[stem]].concat(), found);
                }
            } else if file.extension().is_some_and(|ending| ending == "rs") {
                let own =
                    if ["mod", "lib"].contains(&stem.as_str()) { path.clone() } else { [&path[..], &[stem]].concat() };
                found.insert(own, std::fs::read_to_string(&file).expect("a source file"));
            }
        }
    }
    let mut found = BTreeMap::new();
    visit(source, &Module::new(), &mut found);
    found
}

/// `a::{b, c::d}` as `a::b` and `a::c::d`.
fn leaves(tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some(open) = tree.find('{') else { return vec![tree.to_owned()] };
    let (prefix, inner) = (&tree[..open], &tree[open + 1..tree.rfind('}').expect("a closed brace")]);
    let (mut parts, mut depth, mut part) = (Vec::new(), 0, String::new());
    for c in inner.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if c == ',' && depth == 0 { parts.push(std::mem::take(&mut part)) } else { part.push(c) }
    }
    parts.push(part);
    let parts = parts.iter().filter(|part| !part.trim().is_empty());
    parts.flat_map(|part| leaves(part)).map(|leaf| format!("{prefix}{leaf}")).collect()
}

/// The modules that a file imports from, by its `use` lines outside its unit tests.
fn imports(own: &Module, text: &str, known: &BTreeMap<Module, String>) -> BTreeSet<Module> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let mut found = BTreeSet::new();
    let statement = |(at, _): (usize, &str)| {
        let before = code[..at].rsplit('\n').next().unwrap_or_default().trim();
        let is_use = before.is_empty() || before.starts_with("pub");
        code[at + 4..].split_once(';').map(|(tree, _)| tree).filter(|_| is_use)
    };
    for statement in code.match_indices("use ").filter_map(statement) {
        for leaf in leaves(statement) {
            let mut parts: Vec<String> = leaf.split("::").map(|part| part.trim().to_owned()).collect();
            let mut base = match parts.first().map(String::as_str) {
                Some("crate") => Module::new(),
                Some("self" | "super") => own.clone(),
                _ => continue,
            };
            while parts.first().is_some_and(|part| ["crate", "self", "super"].contains(&part.as_str())) {
                if parts.remove(0) == "super" {
                    base.pop();
                }
            }
            let path = [&base[..], &parts[..]].concat();
            let deepest = (0..=path.len()).rev().map(|n| path[..n].to_vec()).find(|path| known.contains_key(path));
            found.extend(deepest);
        }
    }
    found
}

/// The circles of a graph, as sets of nodes that reach one another.
fn circles(graph: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<BTreeSet<Module>> {
    let reach = |start: &Module| {
        let (mut seen, mut stack) = (BTreeSet::new(), vec![start.clone()]);
        while let Some(node) = stack.pop() {
            for next in graph.get(&node).into_iter().flatten() {
                if seen.insert(next.clone()) {
                    stack.push(next.clone());
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&Module, BTreeSet<Module>> = graph.keys().map(|node| (node, reach(node))).collect();
    let mut found: Vec<BTreeSet<Module>> = Vec::new();
    for (node, others) in &reached {
        let circle: BTreeSet<Module> = others
            .iter()
            .filter(|other| reached.get(*other).is_some_and(|back| back.contains(*node)))
            .cloned()
            .collect();
        if circle.len() > 1 && !found.contains(&circle) {
            found.push(circle);
        }
    }
    found
}

/// Imports between files. A module and the files of its folder are one room: a file may use what its folder's `mod.rs`
/// declares, and `mod.rs` what its files offer.
fn between_files(known: &BTreeMap<Module, String>) -> BTreeMap<Module, BTreeSet<Module>> {
    let related = |a: &Module, b: &Module| a.starts_with(b) || b.starts_with(a);
    let of = |(own, text): (&Module, &String)| {
        let others = imports(own, text, known).into_iter().filter(|other| !related(own, other)).collect();
        (own.clone(), others)
    };
    known.iter().map(of).collect()
}

/// The same between the top modules of a crate.
fn between_rooms(graph: &BTreeMap<Module, BTreeSet<Module>>) -> BTreeMap<Module, BTreeSet<Module>> {
    let room = |module: &Module| module[..1].to_vec();
    let mut rooms: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
    for (from, to) in graph.iter().filter(|(from, _)| !from.is_empty()) {
        let others = to.iter().filter(|to| !to.is_empty()).map(room).filter(|to| *to != room(from));
        rooms.entry(room(from)).or_default().extend(others);
    }
    rooms
}

fn assert_no_circle(name: &str, known: &BTreeMap<Module, String>) {
    let files = between_files(known);
    let found: Vec<String> = circles(&files)
        .into_iter()
        .chain(circles(&between_rooms(&files)))
        .map(|circle| circle.iter().map(|module| module.join("/")).collect::<Vec<_>>().join(", "))
        .collect();
    assert!(found.is_empty(), "{name}: these import one another in a circle:\n{}", found.join("\n"));
}

// Fails if: two files of a crate import each other, directly or through others.
#[test]
fn files_do_not_import_one_another_in_a_circle() {
    for (name, folder) in [
        ("integrator", "integrator"),
        ("reports", "reports"),
        ("scenes", "studies/scenes"),
        ("audit", "studies/audit"),
        ("measure", "studies/measure"),
        ("gate", "studies/gate"),
        ("programs", "studies/programs"),
    ] {
        let known = modules(&root().join(folder).join("src"));
        assert!(known.len() > 5, "{name}: its sources are not where this test samples");
        assert_no_circle(name, &known);
    }
}

// Fails if: the search for circles finds nothing in a crate that has one.
#[test]
fn a_circle_through_three_files_is_found() {
    let file = |path: &str, text: &str| (path.split('/').map(str::to_owned).collect::<Module>(), text.to_owned());
    let known = BTreeMap::from([
        file("a/one", "use crate::b::{two::X, other};"),
        file("b/two", "use super::super::c;\nuse std::fmt;"),
        file("b/other", ""),
        file("c", "use crate::a::one::Y;"),
    ]);
    let found = circles(&between_files(&known));
    let names: Vec<String> = found.iter().flatten().map(|module| module.join("/")).collect();
    assert_eq!(names, ["a/one", "b/two", "c"]);
    assert_eq!(circles(&between_rooms(&between_files(&known))).len(), 1);
}

// Fails if: an engine's tests, which depend on `gate`, compile a chart library or a command line.
#[test]
fn the_gate_pulls_in_no_charts_and_no_command_line() {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--package", "gate", "--edges", "normal", "--prefix", "none", "--offline", "--locked"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    let tree = String::from_utf8_lossy(&output.stdout).into_owned();
    let packages: Vec<&str> = tree.lines().filter_map(|line| line.split(' ').next()).collect();
    assert!(output.status.success() && packages.contains(&"measure"), "{}", String::from_utf8_lossy(&output.stderr));
    for package in ["plotters", "plotters-backend", "maud", "ttf-parser", "math-core", "resvg", "clap"] {
        assert!(!packages.contains(&package), "gate depends on {package}");
    }
}
