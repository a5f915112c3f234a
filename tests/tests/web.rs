//! The module of the teaching page answers as the machine at hand does, bit for bit, on every scene of the page.
//!
//! It is run by an interpreter, `wasmi`. Not seen here: that a browser keeps to the standard as the interpreter does; the
//! page itself recomputes the report's numbers and says so.

use std::io::Read;

use flate2::read::GzDecoder;
use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::Formulation;
use measure::convergence::{Convergence, Row};
use rayon::prelude::*;
use reports::write_csv;
use scenes::run::Precision;
use sha2::{Digest, Sha256};

use measure::study::{Selection, Study};
use measure::sweep::Progress;
use programs::teach::MODULE;
use wasmi::{Engine, Instance, Linker, Memory, Module, Store};
use web::answer::Desk;

/// The module, loaded.
struct Page {
    store: Store<()>,
    instance: Instance,
    memory: Memory,
}

impl Page {
    fn open() -> Self {
        let mut bytes = Vec::new();
        GzDecoder::new(MODULE).read_to_end(&mut bytes).expect("a gzip file");
        let engine = Engine::default();
        let module = Module::new(&engine, &bytes[..]).expect("a module");
        assert_eq!(module.imports().count(), 0, "the module asks nothing of its page");
        let mut store = Store::new(&engine, ());
        let instance = Linker::<()>::new(&engine).instantiate_and_start(&mut store, &module).expect("no imports");
        let memory = instance.get_memory(&store, "memory").expect("exported");
        Page { store, instance, memory }
    }

    fn call(&mut self, name: &str) -> i32 {
        let function = self.instance.get_typed_func::<(), i32>(&self.store, name).expect("exported");
        function.call(&mut self.store, ()).expect("no trap")
    }

    fn bytes(&self, from: i32, length: usize) -> &[u8] {
        &self.memory.data(&self.store)[from as usize..][..length]
    }

    /// The numbers and the text of an answer; the text alone is what was wrong.
    fn ask(&mut self, question: &str) -> Result<(Vec<f64>, String), String> {
        let input = self.instance.get_typed_func::<i32, i32>(&self.store, "input").expect("exported");
        let place = input.call(&mut self.store, question.len() as i32).expect("no trap");
        self.memory.data_mut(&mut self.store)[place as usize..][..question.len()].copy_from_slice(question.as_bytes());
        let count = self.call("ask");
        let (from, length) = (self.call("message"), self.call("message_length"));
        let text = String::from_utf8(self.bytes(from, length as usize).to_vec()).expect("text");
        if count < 0 {
            return Err(text);
        }
        let from = self.call("numbers");
        let (numbers, _) = self.bytes(from, 8 * count as usize).as_chunks::<8>();
        Ok((numbers.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect(), text))
    }
}

/// The same from the code compiled for this machine.
fn natively(question: &str) -> Result<(Vec<f64>, String), String> {
    let mut text = String::new();
    let numbers = Desk::default().answer(question, &mut text).map_err(|error| error.to_string())?;
    Ok((numbers, text))
}

/// Bits; all NaNs are one, as their payload is nobody's result.
fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|x| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() }).collect()
}

fn agrees(questions: &[String]) {
    questions.par_iter().with_max_len(1).for_each_init(Page::open, |page, question| {
        let module = page.ask(question).unwrap_or_else(|error| {
            panic!("{error}; a module that does not know a new method or scene is built by `bash studies/web/build.sh`")
        });
        let native = natively(question).expect("an answer");
        assert!(!native.0.is_empty() || !native.1.is_empty(), "an empty answer shows nothing: {question}");
        assert_eq!(module.1, native.1, "{question}");
        assert!(bits(&module.0) == bits(&native.0), "other bits: {question}");
    });
}

fn ids() -> Vec<&'static str> {
    scenes::taught().iter().map(|scene| scene.id()).collect()
}

fn is_rigid(scene: &str) -> bool {
    scenes::by_id(scene).expect("on the list").exact(faer::fx128::ZERO).rotation().is_some()
}

#[test]
fn the_module_is_the_one_whose_hash_is_committed() {
    let hash: String = Sha256::digest(MODULE).iter().map(|byte| format!("{byte:02x}")).collect();
    let committed = include_str!("../../studies/web/integrator.wasm.gz.sha256");
    assert_eq!(committed.split_whitespace().collect::<Vec<_>>(), [hash.as_str(), "integrator.wasm.gz"]);
}

/// 10^5 steps of 2^-10 s, every thousandth state with its energy and momenta. The interpreter needs a minute for as many of
/// an implicit step on a body: those are a tenth as many.
#[test]
fn explicit_runs_of_1e5_steps_have_the_same_bits_on_every_scene() {
    let mut questions = Vec::new();
    for scene in ids() {
        for method in MethodId::ALL.iter().filter(|method| !method.is_implicit()) {
            for precision in ["f32", "f64"] {
                let run = format!("method {}\nprecision {precision}", method.id());
                questions.push(format!("run\nscene {scene}\n{run}\nend_s 97.65625\nsteps 100000\nstride 1000"));
            }
        }
    }
    agrees(&questions);
}

#[test]
fn implicit_runs_and_the_steps_of_bodies_have_the_same_bits() {
    let mut questions = Vec::new();
    let long = |rule: &str, scene: &str, precision: &str, steps: u64| {
        let end_s = steps as f64 / 1024.0;
        format!("run\nscene {scene}\n{rule}\nprecision {precision}\nend_s {end_s}\nsteps {steps}\nstride 100")
    };
    for scene in ids() {
        let steps = if is_rigid(scene) { 10_000 } else { 100_000 };
        for method in MethodId::ALL.iter().filter(|method| method.is_implicit()) {
            questions.push(long(&format!("method {}", method.id()), scene, "f64", steps));
            questions.push(long(&format!("method {}", method.id()), scene, "f32", steps));
        }
        for method in MethodId::ALL {
            questions.push(long(&format!("method {}", method.id()), scene, "double-double", 200));
        }
        if !is_rigid(scene) {
            continue;
        }
        questions.extend(RigidStep::ALL.iter().map(|step| long(&format!("step {}", step.id()), scene, "f64", 100_000)));
        let storages = Formulation::ALL.iter().map(|storage| format!("storage {}", storage.id()));
        questions.extend(
            storages.map(|storage| long(&format!("method rk4\n{storage}\nupdate linear"), scene, "f64", 10_000)),
        );
    }
    agrees(&questions);
}

#[test]
fn exact_motions_descriptions_and_growth_factors_have_the_same_bits() {
    let mut questions = Vec::new();
    for scene in ids() {
        questions.push(format!("describe\nscene {scene}"));
        questions.push(format!("exact\nscene {scene}\nend_s 20\nsteps 50"));
    }
    for method in MethodId::ALL {
        questions.push(format!(
            "amplification\nscene damped-oscillator\nset zeta=0.3\nmethod {}\nend_s 1.5\nsteps 64",
            method.id()
        ));
    }
    agrees(&questions);
}

#[test]
fn a_wrong_question_is_answered_with_the_same_message() {
    let wrong = [
        "",
        "run\nscene keppler",
        "run\nscene kepler\nset eccentricity=2",
        "run\nscene kepler\nsteps 0",
        "run\nscene kepler\nstep free-splitting",
        "amplification\nscene kepler",
        "run\nwhatever 1",
    ];
    let mut page = Page::open();
    for question in wrong {
        let message = natively(question).expect_err(question);
        assert!(!message.is_empty());
        assert_eq!(page.ask(question), Err(message), "{question}");
    }
}

fn selection() -> Selection {
    Selection {
        scenes: ["pendulum", "bouncing-ball", "torque-free-spin"].map(|id| scenes::by_id(id).expect("a scene")).into(),
        methods: MethodId::ALL.to_vec(),
        schemes: Vec::new(),
        precisions: Precision::ALL.to_vec(),
        // With 2 steps some of the implicit ones are not solved.
        steps: vec![2, 64],
        length: None,
        quick: true,
        draws: Default::default(),
        looped: None,
        shard: None,
        progress: Progress::silent(),
    }
}

/// What the page's badge counts.
#[test]
fn the_module_recomputes_the_rows_of_the_report_bit_for_bit() {
    let rows = Convergence::measure(&selection());
    let runs: Vec<&[Row]> =
        rows.chunk_by(|a, b| (&a.method, a.steps, a.precision) == (&b.method, b.steps, b.precision)).collect();
    assert_eq!(runs.len(), 3 * 6 * 2 * 3);
    runs.par_iter().with_max_len(1).for_each_init(Page::open, |page, run| {
        let Row { scene, method, steps, precision, .. } = &run[0];
        let question = format!(
            "errors\nscene {scene}\nmethod {method}\nsteps {steps}\nprecision {}\ncheckpoints true\nrounding true",
            precision.id()
        );
        let (numbers, _) = page.ask(&question).expect("an answer");
        let (head, errors) = numbers.split_at(web::answer::HEAD);
        assert_eq!(head[2], run[0].evaluations as f64, "{question}");
        let of = |row: &Row| {
            [row.error_end, row.error_max, row.rounding_end, row.rounding_max].map(|x| x.unwrap_or(f64::NAN))
        };
        assert_eq!(bits(errors), bits(&run.iter().flat_map(of).collect::<Vec<_>>()), "{question}");
    });
}

/// The numbers that the page holds are those of the CSV, every row of a scene of the page and no other.
#[test]
fn the_rows_in_the_page_are_those_of_the_csv() {
    let mut selection = selection();
    selection.scenes.push(scenes::by_id("heavy-top").expect("a scene that the page does not show"));
    let csv = write_csv(&Convergence::measure(&selection)).expect("flat rows");
    let page =
        programs::teach::page(&csv, &["x0=1".to_owned()], &[("plan".to_owned(), "<all>".to_owned())]).expect("a page");
    let data = page.split("<script type=\"application/json\" id=\"data\">").nth(1).expect("the data");
    let data: serde_json::Value = serde_json::from_str(data.split("</script>").next().expect("its end")).expect("JSON");
    let name = |list: &str, place: &serde_json::Value| {
        let entry = &data[list][place.as_u64().expect("a place") as usize];
        entry.get("id").unwrap_or(entry).as_str().expect("a name").to_owned()
    };
    let shown: Vec<[String; 9]> = data["rows"]
        .as_array()
        .expect("rows")
        .iter()
        .map(|row| {
            let bits = |x: &serde_json::Value| x.as_f64().map_or(String::new(), |x| format!("{:016x}", x.to_bits()));
            [
                name("scenes", &row[0]),
                name("methods", &row[1]),
                name("precisions", &row[2]),
                row[3].to_string(),
                name("quantities", &row[4]),
                name("outcomes", &row[5]),
                row[6].to_string(),
                bits(&row[7]),
                bits(&row[8]),
            ]
        })
        .collect();
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let heads = reader.headers().expect("heads").clone();
    let columns =
        ["scene", "method", "precision", "steps", "quantity", "outcome", "evaluations", "error_end", "error_max"]
            .map(|head| heads.iter().position(|h| h == head).expect(head));
    let written: Vec<[String; 9]> = reader
        .records()
        .map(|record| {
            let record = record.expect("a row");
            let mut fields = columns.map(|c| record[c].to_owned());
            for field in &mut fields[7..] {
                *field = field.parse::<f64>().map_or(String::new(), |x| format!("{:016x}", x.to_bits()));
            }
            fields
        })
        .filter(|fields| fields[0] != "heavy-top")
        .collect();
    assert_eq!(written.len(), 3 * 6 * 2 * 3 * 2);
    assert_eq!(shown, written);
    assert_eq!(data["set"][0], "x0=1");
    assert!(page.contains("&lt;all>"), "what the report says of itself is text");
}

/// A page of the whole report: 2 MB at most, and nothing that is loaded from elsewhere.
#[test]
fn the_page_is_small_and_loads_nothing() {
    let rows = Convergence::measure(&selection());
    // 9 scenes, 6 methods, 13 steps, 3 precisions, 2 quantities.
    let whole: Vec<Row> = rows.iter().cycle().take(9 * 6 * 13 * 3 * 2).cloned().collect();
    let page = programs::teach::page(&write_csv(&whole).expect("flat rows"), &[], &[]).expect("a page");
    assert!(page.len() <= 2_000_000, "{} bytes", page.len());
    for loader in
        ["src=", "url(", "@import", "<link", "<iframe", "fetch(", "import(", "XMLHttpRequest", "http:", "https:"]
    {
        // A clip path is a place in the same drawing.
        let found = page.replace("url(#", "").find(loader);
        assert!(found.is_none(), "{loader} at {found:?}");
    }
    assert!(!page.contains("{{"), "every part of the page is filled in");
    for scene in ids() {
        assert!(page.contains(&format!("\"{scene}\": {{ title:")), "{scene} has its picture");
    }
}

/// Positions and velocities of the rows of an answer: of a scene with one coordinate the columns 2 and 3.
fn states(numbers: &[f64]) -> Vec<[f64; 3]> {
    let width = numbers[3] as usize;
    numbers[4..].chunks(width).map(|row| [row[1], row[2], row[3]]).collect()
}

// Fails if: the kick before the first step is not half of one, or the velocity is read elsewhere than between two kicks.
#[test]
fn semi_implicit_euler_with_half_a_kick_is_velocity_verlet() {
    for (scene, steps) in [("oscillator", 250), ("pendulum", 400)] {
        let run = |rule: &str| {
            let (numbers, _) =
                natively(&format!("run\nscene {scene}\n{rule}\nend_s 10\nsteps {steps}\nstride 7")).expect("a run");
            states(&numbers)
        };
        let (kicked, verlet) = (run("method semi-implicit-euler\nhalf_kick true"), run("method velocity-verlet"));
        let plain = run("method semi-implicit-euler");
        assert_eq!(kicked.len(), verlet.len());
        // Roundings of the steps, each amplified by at most the number of steps, of numbers below 8.
        let tolerance = f64::from(steps) * f64::from(steps) * f64::EPSILON * 8.0;
        let apart = |a: &[[f64; 3]], b: &[[f64; 3]]| {
            a.iter().zip(b).flat_map(|(a, b)| [1, 2].map(|i| (a[i] - b[i]).abs())).fold(0.0, f64::max)
        };
        assert!(kicked.iter().zip(&verlet).all(|(a, b)| a[0] == b[0]), "{scene}: times");
        assert!(apart(&kicked, &verlet) <= tolerance, "{scene}: {:e}", apart(&kicked, &verlet));
        assert!(apart(&plain, &verlet) > 1e-3, "{scene}: without it the two differ");
    }
    for wrong in [
        "scene bouncing-ball\nhalf_kick true",
        "scene tennis-racket\nhalf_kick true",
        "scene oscillator\nmethod rk4\nhalf_kick true",
    ] {
        assert!(natively(&format!("run\n{wrong}\nend_s 4\nsteps 100")).is_err(), "{wrong}");
    }
}

// Fails if: the steps do not end where they should, do not vary as they should, or a step is taken from another state than the last.
#[test]
fn steps_that_vary_end_where_even_ones_do() {
    let run = |rule: &str, steps: u64| {
        let (numbers, _) = natively(&format!("run\nscene oscillator\n{rule}\nend_s 8\nsteps {steps}")).expect("a run");
        states(&numbers)
    };
    let varied = run("method rk4\njitter 0.25", 200);
    assert_eq!((varied.len(), varied[0][0], varied[200][0]), (201, 0.0, 8.0));
    let lengths: Vec<f64> = varied.windows(2).map(|w| (w[1][0] - w[0][0]) * 25.0).collect();
    // Uniform in 1 +- 0.25 up to the scaling, by the mean of 200 of them: 0.25 / sqrt(3 x 200) = 0.0102, five times that.
    let (low, high) = lengths.iter().fold((f64::MAX, 0.0_f64), |(a, b), &x| (a.min(x), b.max(x)));
    assert!((0.70..0.80).contains(&low) && (1.20..1.31).contains(&high), "{low} {high}");
    // Each state near the exact one at its own time: RK4 errs by less than 1e-6 with these steps.
    let (w, x0, v0) = (2.0_f64, 0.75, -1.25);
    for [t, x, _] in &varied {
        let exact = x0 * (w * t).cos() + v0 / w * (w * t).sin();
        assert!((x - exact).abs() < 1e-5, "{t}: {x} {exact}");
    }
    let even = run("method rk4", 200);
    assert_ne!(even[100], varied[100]);
    assert!(natively("run\nscene oscillator\njitter 1\nend_s 4\nsteps 100").is_err());
}

// Fails if: the module was built from other sources.
#[test]
fn loops_have_the_same_bits_in_the_module() {
    let flat = ids().into_iter().filter(|id| !is_rigid(id) && *id != "bouncing-ball");
    let rules = ["half_kick true", "method rk4\njitter 0.3", "half_kick true\nprecision f32"];
    let mut questions = Vec::new();
    for scene in flat {
        questions.extend(rules.map(|rule| format!("run\nscene {scene}\n{rule}\nend_s 4\nsteps 300\nstride 9")));
        questions.push(format!("errors\nscene {scene}\nhalf_kick true\nsteps 128"));
    }
    agrees(&questions);
}
