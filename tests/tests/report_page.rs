//! The page of a report against the CSV files beside it, and what a reader without eyes or network needs of it.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use verification::programs::{PROGRAMS, run};

/// The directory of a small report: a particle and a rigid body.
fn report() -> &'static Path {
    static REPORT: OnceLock<(tempfile::TempDir, PathBuf)> = OnceLock::new();
    let (_, path) = REPORT.get_or_init(|| {
        let out = tempfile::tempdir().expect("a temporary directory");
        let flags = ["--quick", "--quiet", "--scene", "oscillator", "--scene", "torque-free-spin"];
        assert!(run("report", &flags, out.path()).status.success());
        let path = out.path().to_owned();
        (out, path)
    });
    path
}

fn page() -> String {
    fs::read_to_string(report().join("index.html")).expect("the page")
}

fn csv(name: &str) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(report().join(name)).expect("the file");
    reader.deserialize().map(|row| row.expect("a row")).collect()
}

/// The words of a piece of HTML.
fn words(html: &str) -> String {
    let mut out = String::new();
    for (i, part) in html.split('<').enumerate() {
        out.push_str(if i == 0 { part } else { part.split_once('>').map_or("", |(_, words)| words) });
    }
    let plain = out.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&");
    plain.trim().to_owned()
}

/// The cells of the row that a piece of HTML starts with.
fn cells(row: &str) -> Vec<String> {
    let row = row.split("<tr").next().and_then(|row| row.split("</tbody>").next()).expect("a row");
    row.split("<td>").skip(1).map(words).collect()
}

// Fails if: a claim is lost between CSV and page, or any text of it is rounded, cut or swapped on the way.
#[test]
fn every_claim_on_the_page_is_the_line_of_its_csv() {
    let page = page();
    let shown: HashMap<String, Vec<String>> = page
        .split("<tr id=\"claim-")
        .skip(1)
        .map(|row| (words(row.split('"').next().expect("an id")), cells(row)))
        .collect();
    let mut count = 0;
    for study in PROGRAMS.into_iter().filter(|name| *name != "report") {
        for claim in csv(&format!("{study}-claims.csv")) {
            let row = shown.get(&claim["id"]).unwrap_or_else(|| panic!("{} is not on the page", claim["id"]));
            let verdict = row[4].split_once(' ').expect("a sign and a word").1.replace(' ', "_");
            for (column, cell) in ["statement", "theory", "measured", "bound"].iter().zip(row) {
                assert_eq!(&claim[*column], cell, "{column} of {}", claim["id"]);
            }
            assert_eq!(claim["verdict"], verdict, "{}", claim["id"]);
            count += 1;
        }
    }
    assert!(count > 100 && shown.len() == count, "{count} claims in the CSV files, {} on the page", shown.len());
}

/// The rows of the tables with that caption inside the group of that id.
fn table(page: &str, group: &str, caption: &str) -> Vec<Vec<String>> {
    let group = page.split(&format!("id=\"{group}\"")).nth(1).and_then(|rest| rest.split("</details>").next());
    let group = group.expect("the group");
    let table = group.split(&format!("<caption>{caption}")).nth(1).and_then(|rest| rest.split("</table>").next());
    let body = table.and_then(|table| table.split("<tbody>").nth(1)).expect("the table");
    body.split("<tr>").skip(1).map(cells).collect()
}

/// Whether a number as shown is the CSV's, to the last digit shown.
fn shows(shown: &str, value: &str) -> bool {
    match (shown.parse::<f64>(), value.parse::<f64>()) {
        (Ok(shown), Ok(value)) => (shown - value).abs() <= 0.5001e-3 * value.abs(),
        (Err(_), Err(_)) => value.is_empty(),
        _ => false,
    }
}

// Fails if: a table on the page is given another row's number, or is rounded to fewer than four digits.
#[test]
fn every_order_and_growth_on_the_page_is_in_its_csv() {
    let page = page();
    let mut seen = 0;
    for scene in ["oscillator", "torque-free-spin"] {
        let orders: Vec<_> = csv("orders.csv")
            .into_iter()
            .filter(|row| row["scene"] == scene && row["precision"] == "double-double")
            .collect();
        let shown = table(&page, &format!("convergence-{scene}"), "Observed orders");
        assert_eq!(shown.len(), orders.len(), "{scene}");
        for row in &shown {
            let named = |line: &&HashMap<String, String>| {
                [&line["method"], &line["quantity"], &line["measure"]] == [&row[0], &row[1], &row[2]]
            };
            let [line] = orders.iter().filter(named).collect::<Vec<_>>()[..] else { panic!("{row:?} is not one line") };
            assert!(shows(&row[4], &line["order"]), "{row:?} against {line:?}");
        }
        let laws: Vec<_> = csv("growth-laws.csv")
            .into_iter()
            .filter(|row| row["scene"] == scene && row["precision"] == "f64")
            .collect();
        let shown_laws = table(&page, &format!("drift-{scene}"), "Growth laws");
        assert_eq!(shown_laws.len(), laws.len(), "{scene}");
        for row in &shown_laws {
            let named = |line: &&HashMap<String, String>| line["method"] == row[0] && line["drift"] == row[1];
            let [line] = laws.iter().filter(named).collect::<Vec<_>>()[..] else { panic!("{row:?} is not one line") };
            assert!(shows(&row[2], &line["largest_error"]) && row[5] == line["law"], "{row:?} against {line:?}");
        }
        seen += shown.len() + shown_laws.len();
    }
    assert!(seen > 40, "{seen}");
}

// Fails if: a chart comes without role, title or description, two share an id, or a link leads nowhere.
#[test]
fn every_chart_has_a_name_and_every_link_a_target() {
    let page = page();
    let named = |chart: &&str| {
        let head = chart.split('>').next().unwrap_or_default();
        let ids = head.split("aria-labelledby=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap_or_default();
        let has = |id: &str, tag: &str| {
            let text = chart.split(&format!("<{tag} id=\"{id}\">")).nth(1).and_then(|rest| rest.split('<').next());
            text.is_some_and(|text| !text.trim().is_empty()) && page.matches(&format!("id=\"{id}\"")).count() == 1
        };
        let pair: Vec<&str> = ids.split(' ').collect();
        head.contains("role=\"img\"") && pair.len() == 2 && has(pair[0], "title") && has(pair[1], "desc")
    };
    let charts: Vec<&str> = page.split("<svg ").skip(1).collect();
    let nameless = charts.iter().filter(|chart| !named(chart)).count();
    assert!(charts.len() > 10 && nameless == 0, "{nameless} of {} charts without a name", charts.len());
    for link in page.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
        let found = match link.strip_prefix('#') {
            Some(id) => page.contains(&format!("id=\"{id}\"")),
            None => report().join(link).is_file(),
        };
        assert!(found, "{link} leads nowhere");
    }
}

// Fails if: the page asks for a font, a script or a picture from anywhere, or has a table without sortable columns.
#[test]
fn the_page_needs_nothing_but_itself() {
    let page = page();
    for load in ["http:", "https:", "src=", "@import", "url(", "fetch(", "<link"] {
        assert!(!page.contains(load), "{load}");
    }
    assert!(page.contains("aria-sort") && page.matches("<table class=\"sortable").count() > 20);
}
