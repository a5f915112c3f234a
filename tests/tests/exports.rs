//! Results that are made anew: from rows, from a plan; and in other forms, for people, machines and shells.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Output;

use measure::convergence::Row;
use reports::{Claim, Verdict};
use sha2::{Digest, Sha256};
use tempfile::TempDir;
use verification::programs::{PROGRAMS, assert_same, files, program, run, text, untimed};

/// Two scenes, one of them rigid, and a parameter: every study has rows, and every part of a plan but one is used.
const SMALL: [&str; 12] = [
    "--quick",
    "--scene",
    "oscillator",
    "--scene",
    "heavy-top",
    "--set",
    "stiffness=24",
    "--precision",
    "double-double",
    "--precision",
    "f64",
    "--method=rk4",
];

fn temporary() -> TempDir {
    tempfile::tempdir().expect("a temporary directory")
}

fn report(arguments: &[&str]) -> (TempDir, Output) {
    let out = temporary();
    let output = run("report", arguments, out.path());
    (out, output)
}

fn path(path: &Path) -> &str {
    path.to_str().expect("temporary directories have plain names")
}

// Fails if: a figure, table, claim or the page needs what is not in the rows or the manifest, or CSV loses a bit.
#[test]
fn a_report_made_from_its_rows_alone_has_the_same_bytes() {
    let (first, ran) = report(&SMALL);
    let bare = temporary();
    for (name, bytes) in files(first.path()) {
        let row = name.strip_suffix(".csv").and_then(|name| name.split('.').next());
        let row = row.is_some_and(|study| PROGRAMS.contains(&study));
        if row || name == "manifest.json" {
            fs::write(bare.path().join(name), bytes).expect("writable");
        }
    }
    let (second, again) = report(&["--from", path(bare.path())]);
    let made = files(second.path());
    assert!(made.contains_key("index.html") && made.contains_key("plan.toml") && made.len() > 20, "{:?}", made.keys());
    assert_same(&files(first.path()), &made);
    assert_eq!((ran.status.code(), ran.stdout), (again.status.code(), again.stdout));
}

// Fails if: a study cannot be made anew by its own program, or does not find its rows among a report's.
#[test]
fn each_study_is_made_anew_from_its_own_rows_and_from_those_of_a_report() {
    let (whole, _) = report(&SMALL);
    for study in PROGRAMS.into_iter().filter(|name| *name != "report") {
        let (first, second) = (temporary(), temporary());
        // `stability` would take a scene with a method for a question.
        run(study, &["--from", path(whole.path())], first.path());
        run(study, &["--from", path(first.path())], second.path());
        let files = [first, second].map(|directory| files(directory.path()));
        let is_rows = |name: &String| name.starts_with(&format!("{study}.")) && name.ends_with(".csv");
        assert!(files[0].keys().any(is_rows), "{study}: {:?}", files[0].keys());
        assert_same(&files[0], &files[1]);
    }
}

// Fails if: a plan leaves out what decides a number, or a flag beside it is ignored.
#[test]
fn a_plan_runs_again_what_it_was_written_by_and_flags_take_its_place() {
    let (first, _) = report(&SMALL);
    let plan = first.path().join("plan.toml");
    let (again, _) = report(&["--plan", path(&plan)]);
    assert_same(&untimed(files(first.path())), &untimed(files(again.path())));

    let flags = ["--scene", "oscillator", "--set", "stiffness=6", "--set", "mass=2", "--steps", "64,128,256,512"];
    let (other, _) = report(&[&["--plan", path(&plan)], &flags[..]].concat());
    let expected = "scene = [\"oscillator\"]\nmethod = [\"rk4\"]\nprecision = [\"double-double\", \"f64\"]\n\
        set = [\"stiffness=6\", \"mass=2\"]\nsteps = [64, 128, 256, 512]\nquick = true\n";
    let written = fs::read_to_string(other.path().join("plan.toml")).expect("each report carries its plan");
    assert!(written.ends_with(expected) && written.starts_with("# "), "{written}");
    let page = fs::read_to_string(other.path().join("index.html")).expect("written");
    assert!(page.contains("stiffness=6, mass=2") && page.contains("--plan plan.toml"), "the page names its plan");
    // Under a chart stands the command that makes it: with the plan's parameters, but for those that its scene lacks.
    let made = "--bin convergence -- --scene oscillator --method rk4 --precision double-double --precision f64 --set stiffness=6";
    assert!(page.contains(made), "{made}");
}

// Fails if: a message lacks the file, the line, the column or what would be right.
#[test]
fn what_cannot_be_read_is_named_by_file_line_and_column() {
    let (whole, _) = report(&["--quick", "--scene", "constant-force"]);
    let rows = whole.path().join("convergence.csv");
    let good = fs::read_to_string(&rows).expect("written");
    let spoilt = |change: &dyn Fn(&str) -> String, expected: &str| {
        fs::write(&rows, change(&good)).expect("writable");
        let (out, output) = report(&["--from", path(whole.path())]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.starts_with("error: ") && message.contains(expected), "{expected}: {message}");
        assert!(files(out.path()).is_empty(), "something was written");
    };
    spoilt(&|good| good.replacen(",f32,4,", ",f32,four,", 1), "convergence.csv:2:4: 'steps': ");
    let columns = good.lines().next().expect("a header").split(',').count();
    let short = format!("convergence.csv:2:{columns}: {} fields where the header has {columns}", columns - 1);
    spoilt(&|good| good.replacen(",finished,", ",", 1), &short);
    spoilt(&|good| good.replacen(",quantity,", ",measure,", 1), "quantity");
    spoilt(&|good| good.replacen("h_s", "\u{fffd}", 1), "h_s");
    fs::write(&rows, &good).expect("writable");
    fs::remove_file(whole.path().join("drift.csv")).expect("it was there");
    let (_, output) = report(&["--from", path(whole.path())]);
    assert!(text(&output.stderr).contains("drift.csv: cannot be read"), "{}", text(&output.stderr));
    fs::write(whole.path().join("manifest.json"), "{\n\"version\": 1}").expect("writable");
    let (_, output) = report(&["--from", path(whole.path())]);
    assert!(text(&output.stderr).contains("manifest.json:2:12: invalid type"), "{}", text(&output.stderr));
}

// Fails if: a key is ignored, or a plan's error has no line.
#[test]
fn a_plan_that_says_nothing_sensible_is_refused_with_its_line() {
    let directory = temporary();
    let plan = directory.path().join("mine.toml");
    let cases = [
        (
            "quick = true\n\nscens = [\"kepler\"]\n",
            "mine.toml:3: unknown field `scens`",
            "the keys of a plan are scene,",
        ),
        ("steps = [-3]\n", "mine.toml:1: ", "steps (a list of numbers)"),
        ("scene = \"kepler\"\n", "mine.toml:1: ", "lists of texts"),
        ("scene = [\n", "mine.toml:", "the keys of a plan are"),
        ("steps = [0]\n", "mine.toml: steps: ", "at least 1 step"),
        ("scene = [\"keppler\"]\n", "mine.toml: scene 'keppler': unknown", "did you mean 'kepler'?"),
        ("set = [\"mass=-1\"]\n", "mine.toml: ", "must be finite and > 0"),
    ];
    for (content, place, remedy) in cases {
        fs::write(&plan, content).expect("writable");
        let (out, output) = report(&["--plan", path(&plan)]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{content}: {message}");
        assert!(message.contains(place) && message.contains(remedy), "{content}: {message}");
        assert!(files(out.path()).is_empty(), "{content}: something was written");
    }
}

// Fails if: charts are not told from other files, or differ from those of the whole report.
#[test]
fn charts_alone_are_the_charts_of_the_report() {
    let (whole, _) = report(&SMALL);
    let (charts, _) = report(&["--from", path(whole.path()), "--figures-only"]);
    let expected: BTreeMap<_, _> = files(whole.path()).into_iter().filter(|(name, _)| name.ends_with(".svg")).collect();
    assert!(expected.len() > 10);
    assert_same(&expected, &files(charts.path()));
}

// Fails if: PNG is promised by a program that cannot draw it.
#[test]
fn png_is_drawn_or_the_way_to_it_is_told() {
    let (whole, _) = report(&["--quick", "--scene", "constant-force"]);
    let (charts, output) = report(&["--from", path(whole.path()), "--figures-only", "--format", "both"]);
    let made = files(charts.path());
    if reports::DRAWS_PNG {
        let svg = made.keys().filter_map(|name| name.strip_suffix(".svg"));
        assert!(svg.clone().count() > 0 && svg.clone().all(|id| made.contains_key(&format!("{id}.png"))));
    } else {
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains("--features png") && made.is_empty(), "{}", text(&output.stderr));
    }
}

/// The claims that a report has written, study by study.
fn written_claims(directory: &Path) -> Vec<Claim> {
    let read = |name: &str| {
        let text = fs::read_to_string(directory.join(name)).expect("written");
        reports::read_csv::<Claim>(&text, name).expect("what was written")
    };
    PROGRAMS
        .into_iter()
        .filter(|name| *name != "report")
        .flat_map(|study| read(&format!("{study}-claims.csv")))
        .collect()
}

// Fails if: a key is renamed, or standard output holds anything but the JSON.
#[test]
fn json_tells_machines_what_the_files_say() {
    let (out, output) = report(&[&SMALL[..], &["--json"]].concat());
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).expect("nothing but JSON on stdout");
    let manifest: serde_json::Value =
        serde_json::from_slice(&files(out.path())["manifest.json"]).expect("what was written");
    for key in ["version", "commit", "compiler", "target", "processor", "plan"] {
        assert!(!manifest[key].is_null() && all[key] == manifest[key], "{key}");
    }
    assert_eq!(all["format"], 1);
    assert_eq!(all["holds"], output.status.success());
    let claims: Vec<Claim> = serde_json::from_value(all["claims"].clone()).expect("claims");
    assert!(claims.len() > 10);
    assert_eq!(claims, written_claims(out.path()));
    let studies = all["studies"].as_array().expect("a list");
    let sum = |key: &str| studies.iter().map(|study| study[key].as_u64().expect("a number")).sum::<u64>();
    assert_eq!(sum("holds") + sum("broken") + sum("not_tested"), claims.len() as u64);
    assert_eq!(studies[0]["study"], "convergence");
}

/// Writes the manifest as if a run had written these rows.
fn sealed(directory: &Path, name: &str, bytes: &[u8]) {
    let path = directory.join("manifest.json");
    let text = fs::read_to_string(&path).expect("written");
    let mut manifest: serde_json::Value = serde_json::from_str(&text).expect("what was written");
    manifest["rows"][name]["sha256"] = format!("{:x}", Sha256::digest(bytes)).into();
    fs::write(&path, serde_json::to_string_pretty(&manifest).expect("JSON")).expect("writable");
}

// Fails if: rows that are not those of the manifest are judged, or the message lacks the file and the line.
#[test]
fn rows_that_no_run_wrote_or_another_run_wrote_are_refused() {
    let (whole, _) = report(&["--quick", "--scene", "constant-force", "--method", "rk4"]);
    let (other, _) = report(&["--quick", "--scene", "constant-force", "--method", "velocity-verlet"]);
    let good = files(whole.path());
    let refused = |name: &str, bytes: &[u8], expected: &str| {
        fs::write(whole.path().join(name), bytes).expect("writable");
        let (out, output) = report(&["--from", path(whole.path())]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{name}, {expected}: {message}");
        assert!(message.starts_with("error: ") && message.contains(expected), "{name}, {expected}: {message}");
        assert!(files(out.path()).is_empty(), "something was written");
        fs::write(whole.path().join(name), &good[name]).expect("writable");
    };
    let rows = text(&good["convergence.csv"]);
    let lines: Vec<&str> = rows.lines().collect();
    let cut = |n: usize| lines[..n].join("\n") + "\n";
    refused("convergence.csv", b"<!doctype html>\n<title>404</title>\n", "convergence.csv:2");
    refused("convergence.csv", b"", "convergence.csv:1: 0 rows where manifest.json counts");
    refused("convergence.csv", cut(1).as_bytes(), "convergence.csv:1: 0 rows where manifest.json counts");
    refused("convergence.csv", cut(9).as_bytes(), "convergence.csv:9: 8 rows where manifest.json counts");
    let header = |row: &str| row.split(',').filter(|name| *name != "theory_constant").collect::<Vec<_>>().join(",");
    let column = lines[0].split(',').position(|name| name == "theory_constant").expect("a column");
    let less = |row: &&str| {
        row.split(',').enumerate().filter(|(i, _)| *i != column).map(|(_, x)| x).collect::<Vec<_>>().join(",")
    };
    let missing = [vec![header(lines[0])], lines[1..].iter().map(less).collect()].concat().join("\n");
    refused("convergence.csv", missing.as_bytes(), "convergence.csv:1: the columns are not those of schema 2");
    let scene = rows.replacen("\nconstant-force,", "\nconstant-farce,", 1);
    refused("convergence.csv", scene.as_bytes(), "convergence.csv:2: scene 'constant-farce' is unknown");
    let method = rows.replacen(",rk4,", ",rk5,", 1);
    refused("convergence.csv", method.as_bytes(), "convergence.csv:2: method 'rk5' is unknown");
    let steps = rows.replacen(",4,0.375,", ",0,0.375,", 1);
    refused("convergence.csv", steps.as_bytes(), "convergence.csv:2: no run has 0 steps");
    let edited = rows.replacen(",finished,", ",diverged,", 1);
    refused("convergence.csv", edited.as_bytes(), "convergence.csv:1: not the file that manifest.json describes");
    // Another run's manifest beside these rows, and these rows' manifest with another plan.
    refused("manifest.json", &files(other.path())["manifest.json"], "not the file that manifest.json describes");
    let plan = text(&good["manifest.json"]).replace("\"rk4\"", "\"velocity-verlet\"");
    refused("manifest.json", plan.as_bytes(), "manifest.json:8: not the plan that the rows were measured by");
    let schema = text(&good["manifest.json"]).replace("\"schema\": 2", "\"schema\": 3");
    refused(
        "manifest.json",
        schema.as_bytes(),
        "manifest.json:2: rows of schema 3, and this program reads schema 2; run again",
    );
    let (_, output) = report(&["--from", path(whole.path())]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

// Fails if: a broken claim is left out of the comment, or the provenance.
#[test]
fn markdown_has_the_verdicts_and_every_broken_claim() {
    let (whole, _) = report(&SMALL);
    let markdown = |from: &Path| {
        let (out, output) = report(&["--from", path(from), "--markdown", "--quiet"]);
        (out, text(&output.stdout), output.status.code())
    };
    let (_, good, code) = markdown(whole.path());
    assert!(good.starts_with("### ✓ Accuracy: ") && !good.contains("| broken claim |"), "{good}");
    assert!(good.contains("| convergence | ") && good.contains("| stability | ") && good.contains("set: stiffness=24"));
    assert_eq!(code, Some(0));
    // The error of every other run tenfold: no two neighbouring slopes agree, and no order is left to hold.
    let rows = whole.path().join("convergence.csv");
    let measured = fs::read_to_string(&rows).expect("written");
    let mut all: Vec<Row> = reports::read_csv(&measured, "convergence.csv").expect("what was written");
    for row in all.iter_mut().filter(|row| row.steps.ilog2() % 2 == 0) {
        row.error_end = row.error_end.map(|error| 10.0 * error);
    }
    let spoilt = reports::write_csv(&all).expect("flat rows");
    fs::write(&rows, &spoilt).expect("writable");
    sealed(whole.path(), "convergence.csv", spoilt.as_bytes());
    let (out, bad, code) = markdown(whole.path());
    let broken: Vec<Claim> =
        written_claims(out.path()).into_iter().filter(|claim| claim.verdict == Verdict::Broken).collect();
    assert!(!broken.is_empty() && code == Some(1), "{bad}");
    assert!(
        bad.starts_with("### ✗ Accuracy: ") && bad.contains("| broken claim | theory | measured | bound |"),
        "{bad}"
    );
    assert!(broken.iter().all(|claim| bad.contains(&format!("| {} | ", claim.id))), "{bad}");
}

/// Programs that need no run: they print and write nothing.
fn said(name: &str, arguments: &[&str]) -> String {
    let output = program(name).args(arguments).output().expect("the binary was built");
    assert_eq!(output.status.code(), Some(0), "{name} {arguments:?}: {}", text(&output.stderr));
    assert!(output.stderr.is_empty(), "{name} {arguments:?}");
    text(&output.stdout)
}

// Fails if: a scene or a method is missing, or shells and manual know another set of flags than the program.
#[test]
fn every_program_lists_completes_and_documents_itself() {
    for name in PROGRAMS.into_iter().chain(["bounds"]) {
        let list = said(name, &["list"]);
        let ids = scenes::IDS.iter().copied();
        for id in ids.chain(integrator::methods::MethodId::ALL.iter().map(|m| m.id())).chain(["double-double"]) {
            assert!(list.lines().any(|line| line.split_whitespace().next() == Some(id)), "{name}: {id}");
        }
        let flag = if name == "bounds" { "baseline" } else { "figures-only" };
        let one = said(name, &["list", "heavy-top"]);
        assert!(one.contains("inertia_1") && one.contains("kg m^2") && one.contains("> 0"), "{one}");
        for (shell, mark) in [
            ("bash", format!("complete -F _{name}")),
            ("zsh", format!("#compdef {name}")),
            ("fish", format!("complete -c {name}")),
        ] {
            let script = said(name, &["completions", shell]);
            assert!(
                script.contains(&mark) && script.contains(flag) && script.contains("torque-free-spin"),
                "{name} {shell}"
            );
        }
        let manual = said(name, &["man"]);
        assert!(
            manual.contains(&format!(".TH {name} 1")) && manual.contains(&flag.replace('-', "\\-")),
            "{name}: {manual}"
        );
        assert!(manual.contains("Examples:"), "{name}");
    }
}

// Fails if: colour goes where it was not asked for.
#[test]
fn colour_is_for_terminals_or_on_request() {
    let (whole, _) = report(&["--quick", "--scene", "constant-force"]);
    let shown = |color: &[&str], no_color: bool| {
        let out = temporary();
        let mut command = program("convergence");
        command.env_remove("NO_COLOR");
        if no_color {
            command.env("NO_COLOR", "1");
        }
        let output = command.args(color).arg("--from").arg(whole.path()).arg("--out").arg(out.path()).output();
        text(&output.expect("the binary was built").stdout).contains('\u{1b}')
    };
    assert!(!shown(&[], false), "a pipe is no terminal");
    assert!(shown(&["--color", "always"], true) && shown(&["--color=always"], false));
    assert!(!shown(&["--color", "never"], false));
}
