//! The teaching page: the report's rows, and the module that computes them again in the reader's browser.
//!
//! One file that loads nothing. The module is `studies/web`, built by its script and committed; the page asks it with the
//! names of the tables, so that what is dragged on the page and what stands in the CSV come from the same sources.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use integrator::methods::MethodId;
use serde::Serialize;

use measure::convergence::Row;
use measure::error::Error;
use scenes::any::AnyScene;
use scenes::observation::Quantity;
use scenes::run::{Outcome, Precision};

/// The module, packed.
pub const MODULE: &[u8] = include_bytes!("../../../web/integrator.wasm.gz");
/// The name of the page's file.
pub const FILE: &str = "teach.html";

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("style.css");
const BRIDGE: &str = include_str!("bridge.js");
const WORKER: &str = include_str!("badge.js");
const SCRIPT: [&str; 8] = [
    include_str!("charts.js"),
    include_str!("scenes.js"),
    include_str!("stops.js"),
    include_str!("app.js"),
    include_str!("draw.js"),
    include_str!("motion.js"),
    include_str!("address.js"),
    include_str!("controls.js"),
];

#[derive(Serialize)]
struct Data {
    methods: Vec<Method>,
    scenes: Vec<Scene>,
    precisions: [&'static str; 3],
    quantities: [&'static str; 4],
    outcomes: [Outcome; 3],
    /// Parameters that the report was made with.
    set: Vec<String>,
    rows: Vec<Shown>,
}

#[derive(Serialize)]
struct Method {
    id: &'static str,
    title: &'static str,
    order: u32,
    implicit: bool,
}

#[derive(Serialize)]
struct Scene {
    id: &'static str,
    /// Size of its first quantity at the horizon, in the unit of its error.
    scale: Option<f64>,
}

/// A row of `convergence.csv`: the places of scene, method and precision in their lists, steps, the places of quantity and
/// outcome, evaluations, the error at the end and the largest.
#[derive(Serialize)]
struct Shown(usize, usize, usize, u64, usize, usize, u64, Option<f64>, Option<f64>);

/// The page, from the rows of the convergence study, the parameters it was run with, and what the report says of itself.
///
/// # Errors
/// Rows that have no form as text.
pub fn page(convergence_csv: &str, set: &[String], about: &[(String, String)]) -> Result<String, Error> {
    let rows: Vec<Row> = reports::read_csv(convergence_csv, "convergence.csv")?;
    let data = serde_json::to_string(&data(&rows, set)).map_err(|error| Error::plan(FILE, error.to_string()))?;
    let parts = [
        ("{{STYLE}}", STYLE.to_owned()),
        ("{{FOOTER}}", footer(about)),
        // A '<' would end the script element it stands in.
        ("{{DATA}}", data.replace('<', "\\u003c")),
        ("{{MODULE}}", STANDARD.encode(MODULE)),
        ("{{BRIDGE}}", BRIDGE.to_owned()),
        ("{{WORKER}}", WORKER.to_owned()),
        ("{{SCRIPT}}", SCRIPT.concat()),
    ];
    Ok(parts.iter().fold(PAGE.to_owned(), |page, (name, part)| page.replacen(name, part, 1)))
}

fn data(rows: &[Row], set: &[String]) -> Data {
    let taught = scenes::taught();
    Data {
        methods: MethodId::ALL.iter().map(|&method| Method::of(method)).collect(),
        scenes: taught.iter().map(|scene| Scene::of(scene.as_ref(), rows)).collect(),
        precisions: Precision::ALL.map(Precision::id),
        quantities: Quantity::ALL.map(Quantity::id),
        outcomes: OUTCOMES,
        set: set.to_vec(),
        rows: rows.iter().filter_map(|row| shown(&taught, row)).collect(),
    }
}

const OUTCOMES: [Outcome; 3] = [Outcome::Finished, Outcome::Diverged, Outcome::NotConverged];

impl Method {
    fn of(method: MethodId) -> Self {
        Method { id: method.id(), title: method.title(), order: method.order(), implicit: method.is_implicit() }
    }
}

impl Scene {
    fn of(scene: &dyn AnyScene, rows: &[Row]) -> Self {
        let first = rows.iter().find(|row| row.scene == scene.id());
        Scene { id: scene.id(), scale: first.map(|row| row.scale) }
    }
}

/// The row as the page holds it; `None` for a scene that the page does not show.
fn shown(taught: &[Box<dyn AnyScene>], row: &Row) -> Option<Shown> {
    Some(Shown(
        taught.iter().position(|scene| scene.id() == row.scene)?,
        MethodId::ALL.iter().position(|method| method.id() == row.method)?,
        Precision::ALL.iter().position(|precision| *precision == row.precision)?,
        row.steps,
        Quantity::ALL.iter().position(|quantity| *quantity == row.quantity)?,
        OUTCOMES.iter().position(|outcome| *outcome == row.outcome)?,
        row.evaluations,
        row.error_end,
        row.error_max,
    ))
}

fn footer(about: &[(String, String)]) -> String {
    let escape = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
    let line = |(name, value): &(String, String)| format!("<dt>{}</dt><dd>{}</dd>", escape(name), escape(value));
    format!("<dl>{}</dl>", about.iter().map(line).collect::<String>())
}
