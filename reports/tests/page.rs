//! Laws of the page, read back from the HTML.

use reports::{Block, Claim, Figure, Finding, Page, Section, Table, Verdict};

fn claim(id: &str, verdict: Verdict) -> Claim {
    Claim {
        id: id.to_owned(),
        study: "convergence".to_owned(),
        statement: format!("claim {id} & <b>"),
        theory: "4".to_owned(),
        measured: "3.98".to_owned(),
        bound: "3.95..4.05".to_owned(),
        verdict,
    }
}

fn page() -> Page {
    let words = str::to_owned;
    let figure = Figure { id: words("orders"), title: words("Orders"), data: words("orders.csv"), ..Figure::default() };
    let svg = reports::svg(&figure).expect("drawn");
    let mut table = Table::new(&["method", "order"], &["order"]);
    table.push(["RK4", "4"]);
    let blocks = vec![
        Block::Text(words("a < b")),
        Block::Table { caption: words("Orders"), table, csv: Some(words("orders.csv")) },
        Block::Claims(vec![claim("a", Verdict::Holds), claim("b", Verdict::Broken), claim("c", Verdict::NotTested)]),
        Block::Figure { figure, svg },
    ];
    Page {
        title: words("Report"),
        lead: words("What it is."),
        links: vec![(words("Try it"), words("teach.html"))],
        findings: vec![Finding {
            title: words("First"),
            number: words("3.98"),
            text: words("It holds."),
            figure: Some(words("orders")),
            claim: Some(words("a")),
        }],
        sections: vec![Section { id: words("convergence"), title: words("Convergence"), intro: words("How?"), blocks }],
        footer: vec![(words("rustc"), words("1.90 <stable>"))],
    }
}

#[test]
fn words_are_escaped_and_drawings_are_not() {
    let html = page().html().expect("a proper page");
    assert!(
        html.contains("a &lt; b") && html.contains("claim b &amp; &lt;b&gt;") && html.contains("1.90 &lt;stable&gt;")
    );
    assert!(html.contains("<svg xmlns=") && !html.contains("&lt;svg"));
}

#[test]
fn every_verdict_is_a_word_and_the_broken_come_first() {
    let html = page().html().expect("a proper page");
    for word in ["✓ </span>holds", "✗ </span>broken", "– </span>not tested"] {
        assert_eq!(html.matches(word).count(), 2, "{word}: once in the counts, once in the claims");
    }
    let (broken, section) =
        (html.find("Broken claims").expect("named"), html.find("id=\"convergence\"").expect("there"));
    assert!(broken < section && html.contains("href=\"#claim-b\"") && !html.contains("href=\"#claim-a\""));
}

#[test]
fn every_link_within_the_page_has_its_target() {
    let html = page().html().expect("a proper page");
    let targets: Vec<&str> = html.split("href=\"#").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(targets, ["main", "convergence", "claim-b", "figure-orders"]);
    assert!(targets.iter().all(|id| html.matches(&format!("id=\"{id}\"")).count() == 1), "{targets:?}");
}

#[test]
fn nothing_is_loaded_from_elsewhere() {
    let html = page().html().expect("a proper page").replace("http://www.w3.org/2000/svg", "");
    for load in ["http:", "https:", "src=", "@import", "url("] {
        assert!(!html.contains(load), "{load}");
    }
}

#[test]
fn every_region_that_scrolls_has_a_name_and_can_be_reached_by_key() {
    let html = page().html().expect("a proper page");
    let regions: Vec<&str> = html.split("<div class=\"scroll\"").skip(1).filter_map(|r| r.split('>').next()).collect();
    assert_eq!(regions.len(), 3);
    let named = |r: &&str| r.contains("tabindex=\"0\"") && r.contains("role=\"region\"") && !r.contains("label=\"\"");
    assert!(regions.iter().all(named), "{regions:?}");
    assert!(html.contains("lang=\"en\"") && html.contains("width=device-width") && html.contains("<main id=\"main\">"));
}

#[test]
fn ids_that_come_twice_and_figures_that_are_missing_are_refused() {
    let mut twice = page();
    twice.sections.push(twice.sections[0].clone());
    assert!(twice.html().expect_err("all twice").to_string().contains("'orders': comes twice"));
    let mut lost = page();
    lost.findings[0].figure = Some("nowhere".to_owned());
    let message = lost.html().expect_err("no such figure").to_string();
    assert!(message.contains("'First'") && message.contains("'nowhere'"), "{message}");
}

/// Relative luminance and contrast after WCAG 2.1, section 1.4.3: 4.5 for words of any size.
#[test]
fn every_colour_of_words_can_be_read_on_every_ground() {
    let style = include_str!("../src/page/style.css");
    let schemes: Vec<&str> = style.split(":root{").skip(1).take(2).filter_map(|rest| rest.split('}').next()).collect();
    assert_eq!(schemes.len(), 2, "light and dark");
    for scheme in schemes {
        for ground in ["ground", "card"] {
            for words in ["ink", "soft", "link", "holds", "broken", "untested"] {
                let (a, b) = (luminance(scheme, ground), luminance(scheme, words));
                let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
                assert!(contrast >= 4.5, "{words} on {ground}: {contrast:.2} in {scheme}");
            }
        }
    }
}

fn luminance(scheme: &str, name: &str) -> f64 {
    let value = scheme.split(&format!("--{name}:#")).nth(1).expect("the colour");
    let hex = value.split(';').next().expect("a value");
    let long: String = if hex.len() == 3 { hex.chars().flat_map(|c| [c, c]).collect() } else { hex.to_owned() };
    let part = |i: usize| {
        let c = f64::from(u8::from_str_radix(&long[2 * i..2 * i + 2], 16).expect("hexadecimal")) / 255.0;
        if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * part(0) + 0.7152 * part(1) + 0.0722 * part(2)
}
