//! Arbitrary bytes to every reader, and random command lines to every program: an error or an answer, never a panic.
//! `HOSTILE_LINES=5000 cargo test --release --test hostile` tries more command lines than the suite does.

use std::fs;
use std::path::Path;

use measure::adequacy::Adequacy;
use measure::convergence::Convergence;
use measure::drift::DriftStudy;
use measure::loops::Loops;
use measure::rotation::Rotation;
use measure::stability::Stability;
use measure::study::Study;
use measure::tradeoff::Tradeoff;
use programs::options::Format;
use programs::plan::Plan;
use programs::produce::from_rows;
use programs::provenance::{MANIFEST, Manifest};
use proptest::prelude::*;
use verification::programs::{PROGRAMS, program, text};

/// Rows that can be read are drawn and judged; that they cannot be is an answer.
fn rows<S: Study>(text: &str) {
    if let Ok(rows) = reports::read_csv::<S::Row>(text, "rows.csv")
        && rows.iter().try_for_each(S::check).is_ok()
    {
        let _ = from_rows::<S>(&rows, &Plan::default(), Format::Svg);
    }
}

fn every_reader(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    rows::<Convergence>(&text);
    rows::<DriftStudy>(&text);
    rows::<Rotation>(&text);
    rows::<Adequacy>(&text);
    rows::<Stability>(&text);
    rows::<Loops>(&text);
    let _ = measure::loops::published::rows(&text, "published-loops.csv");
    let _ = measure::game_loop::Loop::read(&text.lines().take(4).collect::<Vec<_>>());
    rows::<Tradeoff>(&text);
    let _ = gate::Bounds::parse(bytes, "bounds.csv");
    let _ = reports::read_csv::<measure::rotation::published::Published>(&text, "published.csv");
    let directory = tempfile::tempdir().expect("a temporary directory");
    let plan = directory.path().join("plan.toml");
    fs::write(&plan, bytes).expect("writable");
    let _ = Plan::read(&plan);
    fs::write(directory.path().join(MANIFEST), bytes).expect("writable");
    let _ = Manifest::read(directory.path());
}

/// Files that each reader takes, to be spoilt.
fn good() -> Vec<String> {
    let data = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    let bounds = fs::read_to_string(data("../studies/gate/data/bounds.csv")).expect("committed");
    let published = fs::read_to_string(data("../studies/measure/data/published.csv")).expect("committed");
    let convergence = "scene,method,precision,steps,h_s,quantity,unit,outcome,failed_step,error_end,error_max,rounding_end,\
        rounding_max,scale,evaluations,theory_order,theory_is_envelope,theory_constant\n\
        oscillator,rk4,f64,16,0.171875,position,m,finished,,1e-3,2e-3,0.0,5e-324,0.75,64,4.0,false,0.1\n\
        oscillator,rk4,f64,32,0.0859375,position,m,finished,,1e-4,2e-4,0.0,1e308,0.75,128,4.0,false,0.1\n";
    let adequacy = "scene,model,consistent,method,h_s,steps,quantity,unit,error,outcome,evaluations,operations\n\
        kepler,full,true,rk4,0.1,64,position,m,5e-324,finished,256,1000\n\
        kepler,full,true,rk4,0.05,128,position,m,5e-324,finished,512,2000\n";
    let drift = "scene,method,precision,h_s,drift,unit,scale,t_s,error_min,error_max,outcome,failed_at_s,theory_law,theory_low,\
        theory_high\noscillator,rk4,f64,0.01,energy,J,1.0,1.0,-1e-9,1e-9,finished,,linear,,\n";
    let plan = "scene = [\"kepler\"]\nmethod = [\"rk4\"]\nset = [\"eccentricity=0.5\"]\nsteps = [64]\nquick = true\n";
    let manifest = "{\"schema\": 1, \"version\": \"0\", \"commit\": \"\", \"compiler\": \"\", \"target\": \"\", \"processor\": \"\", \
        \"plan\": {}, \"rows\": {\"drift.csv\": {\"rows\": 1, \"sha256\": \"\"}}}";
    let head = |text: String| text.lines().take(24).collect::<Vec<_>>().join("\n");
    [head(bounds), head(published), convergence.into(), adequacy.into(), drift.into(), plan.into(), manifest.into()]
        .into()
}

/// What is put into a good file.
const SPOILS: [&str; 16] = [
    "",
    "NaN",
    "inf",
    "-inf",
    "5e-324",
    "1e308",
    "-1",
    "0",
    "18446744073709551616",
    "\"",
    "\n",
    ",",
    "\0",
    "\u{feff}",
    "<!doctype html>",
    "é",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    // Fails if: a reader takes arbitrary bytes for text, a number or a line.
    #[test]
    fn no_reader_panics_on_arbitrary_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        every_reader(&bytes);
    }

    // Fails if: a reader, a table, a chart or a claim takes a number, a name or a count on trust.
    #[test]
    fn no_reader_panics_on_a_spoilt_file(
        file in 0..7_usize,
        cuts in prop::collection::vec((0.0..1.0_f64, 0..40_usize, 0..SPOILS.len()), 1..4),
    ) {
        let mut bytes = good()[file].clone().into_bytes();
        for (at, length, spoil) in cuts {
            let from = (at * bytes.len() as f64) as usize;
            let to = (from + length).min(bytes.len());
            bytes.splice(from..to, SPOILS[spoil].bytes());
        }
        every_reader(&bytes);
    }

    // Fails if: a number in a field of its own, at either end of what f64 has, stops a chart or a claim.
    #[test]
    fn no_study_panics_on_a_field_of_any_value(
        file in 2..5_usize,
        fields in prop::collection::vec((1..3_usize, 0..18_usize, 0..SPOILS.len()), 1..4),
    ) {
        let mut lines: Vec<Vec<String>> =
            good()[file].lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
        for (line, field, spoil) in fields {
            let rows = lines.len();
            let row = &mut lines[line.min(rows - 1)];
            let columns = row.len();
            row[field % columns] = SPOILS[spoil].to_owned();
        }
        let text: Vec<String> = lines.iter().map(|line| line.join(",")).collect();
        every_reader(text.join("\n").as_bytes());
    }
}

/// Numbers of a linear congruential generator (D. E. Knuth, The Art of Computer Programming 2 (1997), 3.3.4), the high bits.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
    fn pick<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len())]
    }
}

const FLAGS: [&str; 34] = [
    "--scene",
    "--method",
    "--precision",
    "--set",
    "--steps",
    "--quick",
    "--plan",
    "--from",
    "--out",
    "--format",
    "--figures-only",
    "--markdown",
    "--json",
    "--color",
    "--quiet",
    "--threads",
    "--error",
    "--budget-us",
    "--for",
    "--rate",
    "--members",
    "--seed",
    "--step",
    "--bounds",
    "--audit",
    "--mutants",
    "--update",
    "--reason",
    "--junit",
    "--baseline",
    "--help",
    "--version",
    "list",
    "man",
];
const VALUES: [&str; 36] = [
    "",
    "-",
    "--",
    "0",
    "-1",
    "1",
    "2,4",
    "4,2,x",
    "64,64",
    "1e308",
    "1e-308",
    "5e-324",
    "NaN",
    "inf",
    "-inf",
    "18446744073709551616",
    "constant-force",
    "kepler",
    "pendulum/rotation",
    "no-such-scene",
    "rk4",
    "semi-implicit-euler",
    "f32",
    "double-double",
    "mass=1",
    "mass=",
    "mass=-1",
    "=",
    "x0=1,2",
    "gravity=1e300",
    "no/such",
    "x/y",
    "svg",
    "always",
    "\u{202e}é",
    "bash",
];

// Fails if: a flag's value, or a combination of flags, is taken on trust.
#[test]
fn no_command_line_makes_a_program_panic() {
    let lines = std::env::var("HOSTILE_LINES").ok().and_then(|n| n.parse().ok()).unwrap_or(300);
    let mut random = Random(1);
    let out = tempfile::tempdir().expect("a temporary directory");
    for _ in 0..lines {
        let name = random.pick(&[&PROGRAMS[..], &["bounds"]].concat());
        let mut arguments: Vec<&str> = Vec::new();
        for _ in 0..1 + random.below(5) {
            arguments.push(random.pick(&FLAGS));
            if random.below(4) > 0 {
                arguments.push(random.pick(&VALUES));
            }
        }
        // What runs is small: `bounds` has rows of one scene, and the others one scene and few steps.
        let small: &[&str] = match name {
            "bounds" => &["--quick", "--scene", "constant-force"],
            _ => &["--quick", "--scene", "constant-force", "--steps", "4,8"],
        };
        if !arguments.iter().any(|a| ["--scene", "--plan", "--from", "--baseline"].contains(a)) {
            arguments.extend(small);
        }
        let mut command = program(name);
        let output = command.args(&arguments).current_dir(out.path()).output().expect("the binary was built");
        let said = text(&output.stderr);
        let code = output.status.code();
        assert!(code.is_some_and(|code| code <= 2), "{name} {arguments:?}: {code:?}\n{said}");
        assert!(
            !said.contains("panicked") && (code != Some(2) || said.contains("error:")),
            "{name} {arguments:?}:\n{said}"
        );
    }
}
