//! The page of CSV columns is what the row types say of themselves.

use std::path::{Path, PathBuf};

use measure::stability::Stability;
use measure::study::{Kind, Study};
use measure::tradeoff::Tradeoff;
use verification::programs::{files, run, text};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace").to_owned()
}

/// A file of a report, what one row of it is, and the type that is written.
const FILES: [(&str, &str, &str, &str); 31] = [
    ("convergence.csv", "the errors of one quantity in one run", "studies/measure/src/convergence/mod.rs", "Row"),
    ("orders.csv", "the order of one sweep", "studies/measure/src/convergence/order_row.rs", "OrderRow"),
    ("drift.csv", "one invariant over a stretch of a long run", "studies/measure/src/drift/mod.rs", "Row"),
    ("growth-laws.csv", "the law by which one error grows", "studies/measure/src/drift/laws.rs", "LawRow"),
    ("rotation.csv", "one measured number of a scheme for rigid bodies", "studies/measure/src/rotation/row.rs", "Row"),
    ("adequacy.csv", "one run of a model", "studies/measure/src/adequacy/mod.rs", "Row"),
    (
        "stability.*.csv",
        "one limit, one cell of a map or one point of a picture",
        "studies/measure/src/stability/mod.rs",
        "Row",
    ),
    ("tradeoff.*.csv", "one run with its error and its cost", "studies/measure/src/tradeoff/mod.rs", "Row"),
    ("loops.csv", "one measured number of a loop around a step", "studies/measure/src/loops/row.rs", "Row"),
    ("loops-orders.csv", "the order of one quantity in one loop", "studies/measure/src/loops/show.rs", "OrderLine"),
    ("loops-laws.csv", "one case of which theory knows the number", "studies/measure/src/loops/row.rs", "Row"),
    ("loops-published.csv", "one number printed elsewhere", "studies/measure/src/loops/row.rs", "Row"),
    ("ensemble.csv", "the errors of one quantity over all starts", "studies/measure/src/ensemble/mod.rs", "Row"),
    ("ensemble-finest.csv", "the errors of the smallest step", "studies/measure/src/ensemble/show.rs", "Finest"),
    ("ensemble-cost.csv", "one timed ensemble", "studies/measure/src/ensemble/cost.rs", "Case"),
    (
        "adequacy-recommendations.csv",
        "the cheapest model for an error",
        "studies/measure/src/adequacy/show.rs",
        "Recommendation",
    ),
    ("adequacy-models.csv", "one model with one method", "studies/measure/src/adequacy/show.rs", "ModelError"),
    ("rotation-schemes.csv", "one scheme for rigid bodies", "studies/measure/src/rotation/tables.rs", "SchemeLine"),
    (
        "rotation-orders.csv",
        "the order of one scheme on one scene",
        "studies/measure/src/rotation/tables.rs",
        "OrderLine",
    ),
    (
        "rotation-published.csv",
        "one number printed elsewhere",
        "studies/measure/src/rotation/tables.rs",
        "PublishedLine",
    ),
    (
        "tradeoff-which-method.csv",
        "the method for one kind of scene and one error",
        "studies/measure/src/tradeoff/which_table.rs",
        "WhichRow",
    ),
    (
        "tradeoff-60-hz.csv",
        "one scheme on one free body at 60 Hz",
        "studies/measure/src/tradeoff/step_rate.rs",
        "AtRate",
    ),
    (
        "tradeoff-cost-at-error.csv",
        "the cheapest method for an error",
        "studies/measure/src/tradeoff/tables.rs",
        "IsoRow",
    ),
    ("tradeoff-fronts.csv", "one run of a Pareto front", "studies/measure/src/tradeoff/tables.rs", "FrontRow"),
    (
        "tradeoff-question.csv",
        "the count over all scenes",
        "studies/measure/src/tradeoff/comparison_tables.rs",
        "QuestionRow",
    ),
    (
        "tradeoff-semi-implicit-*.csv",
        "semi-implicit Euler beside others on one scene",
        "studies/measure/src/tradeoff/comparison_tables.rs",
        "ComparisonRow",
    ),
    (
        "tradeoff-rounding-optimum.csv",
        "the step of least error of a sweep",
        "studies/measure/src/tradeoff/rounding_optimum.rs",
        "Minimum",
    ),
    ("tradeoff-peers.csv", "one setting of one system", "studies/measure/src/tradeoff/peers.rs", "Line"),
    (
        "tradeoff-formulation.csv",
        "one method in both frames",
        "studies/measure/src/tradeoff/cost_tables.rs",
        "StorageRow",
    ),
    ("*-claims.csv", "one claim with its verdict", "reports/src/claim.rs", "Claim"),
    ("bounds.csv", "one committed bound", "studies/gate/src/row.rs", "Row"),
];

/// A file of a report whose records are those of another, with all of its columns, and which of them.
const PARTS: [(&str, &str, &str); 5] = [
    ("stability-limits.csv", "stability.*.csv", "largest stable steps"),
    ("stability-other.csv", "stability.*.csv", "limits that no matrix tells"),
    ("tradeoff-steps.csv", "tradeoff.*.csv", "the timed run of each sweep"),
    ("tradeoff-lengths.csv", "tradeoff.*.csv", "timed runs of several lengths"),
    ("tradeoff-stagnation.csv", "tradeoff.*.csv", "bodies that stand still"),
];

/// Name, type and documentation of the fields of a struct, as its source has them. A field that is not serialized is left out.
fn fields(source: &str, name: &str) -> Vec<[String; 3]> {
    let heads = [format!("struct {name} {{\n"), format!("struct {name}<'a> {{\n")];
    let body = heads.iter().find_map(|head| source.split(head.as_str()).nth(1));
    let body = body.unwrap_or_else(|| panic!("no struct {name}"));
    let body = body.split("\n}").next().unwrap_or_default();
    let (mut found, mut doc, mut skipped) = (Vec::new(), Vec::new(), false);
    for line in body.lines().map(str::trim) {
        if let Some(text) = line.strip_prefix("///") {
            doc.push(text.trim().to_owned());
        } else if line.starts_with("#[serde(skip") {
            skipped = true;
        } else if let Some((name, kind)) =
            line.trim_start_matches("pub ").split_once(": ").filter(|_| !line.starts_with('#'))
        {
            let name = name.trim_start_matches("pub(super) ");
            if !std::mem::take(&mut skipped) {
                found.push([name.to_owned(), kind.trim_end_matches(',').to_owned(), doc.join(" ")]);
            }
            doc.clear();
        }
    }
    found
}

/// What a cell holds, in words.
fn cell(kind: &str) -> String {
    let (inner, may_be_empty) = match kind.strip_prefix("Option<").and_then(|kind| kind.strip_suffix('>')) {
        Some(inner) => (inner, ", or empty"),
        None => (kind, ""),
    };
    let word = match inner {
        "f64" => "number",
        "u64" | "u32" | "usize" => "whole number",
        "bool" => "true or false",
        "String" | "&'a str" | "&'static str" => "text",
        _ => "name",
    };
    format!("{word}{may_be_empty}")
}

/// The kinds of rows of a study that has several files, as the study lists them.
fn kinds(file: &str) -> &'static [Kind] {
    match file {
        "stability.*.csv" => Stability::KINDS,
        "tradeoff.*.csv" => Tradeoff::KINDS,
        _ => &[],
    }
}

fn page() -> String {
    let mut page = String::from(
        "# Columns of the CSV files\n\n\
         Each file has one header line and one record per line. Numbers are written so that they read back exactly. An empty cell is a \
         value that does not exist, for example the error of a run that diverged; it is never zero. A file without records is empty. The suffix of a name is its unit: \
         `_s` seconds, `_m` metres. `schema` in `manifest.json` is raised when a column changes its name or meaning.\n",
    );
    for (file, what, source, name) in FILES {
        let text = std::fs::read_to_string(root().join(source)).unwrap_or_else(|error| panic!("{source}: {error}"));
        page += &format!("\n## {file}\n\nOne record is {what}.\n\n| column | cell | meaning |\n|---|---|---|\n");
        for [column, kind, doc] in fields(&text, name) {
            // It is the file's name.
            if column != "part" {
                page += &format!("| `{column}` | {} | {} |\n", cell(&kind), doc.replace('|', "\\|"));
            }
        }
        let study = file.split('.').next().unwrap_or_default();
        if !kinds(file).is_empty() {
            page +=
                "\nEach kind of record has a file and the columns that it needs:\n\n| file | columns |\n|---|---|\n";
        }
        for Kind { part, columns } in kinds(file) {
            page += &format!("| `{study}.{part}.csv` | {} |\n", columns.replace(',', ", "));
        }
    }
    page += "\n## Parts of other files\n\n| file | its records | columns of |\n|---|---|---|\n";
    for (file, of, what) in PARTS {
        page += &format!("| `{file}` | {what} | {of}, all of them |\n");
    }
    page
}

// Fails if: a column is added, renamed or documented otherwise without the page.
#[test]
fn the_page_of_columns_is_what_the_row_types_say() {
    let path = root().join("reports/guides/columns.md");
    let page = page();
    if std::env::var_os("UPDATE_COLUMNS").is_some() {
        std::fs::write(&path, &page).expect("the page can be written");
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    let remedy = "run `UPDATE_COLUMNS=1 cargo test --release -p verification --test columns`";
    assert!(committed == page, "reports/guides/columns.md is not what the row types say; {remedy}");
}

// Fails if: a kind of record has a column that its row type does not, or a name that its file cannot be read back by.
#[test]
fn every_kind_of_record_has_columns_of_its_row_type() {
    for (file, _, source, name) in FILES {
        let text = std::fs::read_to_string(root().join(source)).expect("a source file");
        let fields: Vec<String> = fields(&text, name).into_iter().map(|[name, _, _]| name).collect();
        for column in kinds(file).iter().flat_map(|kind| kind.columns.split(',')) {
            assert!(fields.iter().any(|field| field == column), "{file}: no field '{column}'");
        }
    }
}

// Fails if: a column has no documentation, or a file of the list has other columns than the program writes.
#[test]
fn every_column_is_documented_and_is_the_one_that_is_written() {
    for (file, _, source, name) in FILES {
        let text = std::fs::read_to_string(root().join(source)).expect("a source file");
        let fields = fields(&text, name);
        assert!(fields.len() > 3, "{file}");
        assert!(
            fields.iter().all(|[_, _, doc]| doc.ends_with('.') || !doc.is_empty()),
            "{file}: a column without words"
        );
    }
    let committed = std::fs::read_to_string(root().join("studies/gate/data/bounds.csv")).expect("the committed bounds");
    let header = committed.lines().find(|line| !line.starts_with('#')).expect("a header");
    let text = std::fs::read_to_string(root().join("studies/gate/src/row.rs")).expect("a source file");
    let columns: Vec<String> = fields(&text, "Row").into_iter().map(|[name, _, _]| name).collect();
    for column in header.split(',') {
        assert!(
            columns.iter().any(|known| known == column),
            "bounds.csv has a column '{column}' that no field explains"
        );
    }
}

/// Whether a name is of a pattern with at most one star.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        Some((head, tail)) => name.len() >= head.len() + tail.len() && name.starts_with(head) && name.ends_with(tail),
        None => pattern == name,
    }
}

// Fails if: a report has a CSV, or a CSV a column, that the page does not explain.
#[test]
fn every_csv_of_a_report_is_explained() {
    let out = tempfile::tempdir().expect("a temporary directory");
    let scenes = [
        "--scene",
        "oscillator",
        "--scene",
        "kepler",
        "--scene",
        "torque-free-spin",
        "--scene",
        "pendulum",
        "--scene",
        "symmetric-top/disc",
    ];
    let output = run("report", &[&["--quick"][..], &scenes].concat(), out.path());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let output = run("ensemble", &["--quick", "--scene", "kepler", "--members", "64"], out.path());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let mut seen = 0;
    for (name, bytes) in files(out.path()).into_iter().filter(|(name, _)| name.ends_with(".csv")) {
        let of = PARTS.iter().find(|(file, ..)| *file == name).map_or(name.as_str(), |(_, of, _)| of);
        let known = FILES.iter().find(|(pattern, ..)| *pattern == of || matches(pattern, of));
        let (_, _, source, row) = known.unwrap_or_else(|| panic!("{name} is not on the page of columns"));
        let source = std::fs::read_to_string(root().join(source)).expect("a source file");
        let fields = fields(&source, row);
        for column in text(&bytes).lines().next().unwrap_or_default().split(',').filter(|c| !c.is_empty()) {
            assert!(fields.iter().any(|[field, ..]| field == column), "{name}: column '{column}' is not on the page");
        }
        seen += 1;
    }
    assert!(seen >= 25, "{seen} files");
}
