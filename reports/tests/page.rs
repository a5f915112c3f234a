//! Laws of the page, read back from the HTML.

use reports::{Block, Claim, Figure, Finding, Page, Section, Table, Verdict};

fn claim(id: &str, verdict: Verdict) -> Claim {
    let statement = format!("claim {id} & <b>");
    let texts = [statement.as_str(), "4", "3.98", "3.95..4.05"].map(str::to_owned);
    Claim::new("convergence", id.to_owned(), texts, verdict)
}

fn page() -> Page {
    let words = str::to_owned;
    let figure = Figure { id: words("orders"), title: words("Orders"), data: words("orders.csv"), ..Figure::default() };
    let mut table = Table::new(&["method", "order"], &["order"]);
    table.push(["RK4", "4"]);
    let blocks = vec![
        Block::Text(words("a < b")),
        Block::Table { caption: words("Orders"), table, csv: Some(words("orders.csv")) },
        Block::Claims(vec![claim("a", Verdict::Holds), claim("b", Verdict::Broken), claim("c", Verdict::NotTested)]),
        Block::Group {
            id: words("convergence-kepler"),
            title: words("Kepler"),
            note: words("1 chart"),
            blocks: vec![Block::Formula(words(r"m\ddot{x} = -k x")), Block::Figure(figure)],
        },
    ];
    Page {
        title: words("Report"),
        lead: words("What it is."),
        links: vec![(words("Try it"), words("teach.html"))],
        answer: vec![Block::Text(words("Which <method>?"))],
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

// Fails if: the answer is left out, or comes after the findings.
#[test]
fn the_answer_comes_before_the_findings() {
    let html = page().html().expect("a proper page");
    let [answer, findings] = ["Which &lt;method&gt;?", "id=\"findings\""].map(|part| html.find(part));
    assert!(answer.is_some() && answer < findings, "{answer:?} {findings:?}");
}

#[test]
fn words_are_escaped_and_drawings_are_not() {
    let html = page().html().expect("a proper page");
    assert!(
        html.contains("a &lt; b") && html.contains("claim b &amp; &lt;b&gt;") && html.contains("1.90 &lt;stable&gt;")
    );
    assert!(html.contains("<svg class=\"chart\"") && !html.contains("&lt;svg") && html.contains("<mi>k</mi>"));
}

#[test]
fn every_verdict_is_a_word_and_the_broken_come_first() {
    let html = page().html().expect("a proper page");
    for word in ["✓ </span>holds", "✗ </span>broken", "– </span>not tested"] {
        assert_eq!(html.matches(word).count(), 2, "{word}: once in the counts, once in the claims");
        let row = format!("<option value=\"{0}\">{0}", word.rsplit('>').next().expect("a word"));
        assert!(html.contains(&row), "{row}: to be searched for");
    }
    let (broken, section) =
        (html.find("Broken claims").expect("named"), html.find("id=\"convergence\"").expect("there"));
    let findings = html.find("What matters").expect("named");
    assert!(broken < findings && findings < section, "{broken} {findings} {section}");
    let listed = &html[broken..findings];
    assert!(listed.contains("href=\"#claim-b\"") && !listed.contains("href=\"#claim-a\""), "{listed}");
}

#[test]
fn every_link_within_the_page_has_its_target() {
    let html = page().html().expect("a proper page");
    let targets: Vec<&str> = html.split("href=\"#").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    // The table of verdicts comes last.
    let expected = ["main", "main", "convergence", "claim-b", "claim-a", "figure-orders", "convergence"];
    assert_eq!(targets, expected);
    assert!(targets.iter().all(|id| html.matches(&format!("id=\"{id}\"")).count() == 1), "{targets:?}");
    assert_eq!(html.matches("href=\"teach.html\"").count(), 2, "in the navigation and at the top");
}

#[test]
fn nothing_is_loaded_from_elsewhere() {
    let html = page().html().expect("a proper page");
    for load in ["http:", "https:", "src=", "@import", "url("] {
        assert!(!html.contains(load), "{load}");
    }
}

#[test]
fn every_region_that_scrolls_has_a_name_and_can_be_reached_by_key() {
    let html = page().html().expect("a proper page");
    let regions: Vec<&str> = html.split("<div class=\"scroll\"").skip(1).filter_map(|r| r.split('>').next()).collect();
    assert_eq!(regions.len(), 4, "a table, claims, a chart, and the chart of the finding");
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
    let mut unclaimed = page();
    unclaimed.findings[0].claim = Some("nowhere".to_owned());
    assert!(unclaimed.html().expect_err("no such claim").to_string().contains("claim 'nowhere'"));
}

#[test]
fn every_chart_is_an_image_with_a_name_and_a_description_of_its_own() {
    let html = page().html().expect("a proper page");
    let charts: Vec<&str> = html.split("<svg ").skip(1).filter_map(|rest| rest.split('>').next()).collect();
    assert_eq!(charts.len(), 2);
    for chart in charts {
        let ids = chart.split("aria-labelledby=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("named");
        assert!(chart.contains("role=\"img\""), "{chart}");
        for (tag, id) in ["title", "desc"].iter().zip(ids.split(' ')) {
            assert_eq!(html.matches(&format!("<{tag} id=\"{id}\">")).count(), 1, "{tag} of {chart}");
        }
    }
    assert_eq!(html.matches("-t\">Orders</title>").count(), 2);
}

#[test]
fn a_chart_on_the_page_is_that_of_the_file_with_its_colours_left_to_the_style() {
    let (html, page) = (page().html().expect("a proper page"), page());
    let Block::Group { blocks, .. } = &page.sections[0].blocks[3] else { panic!("the group") };
    let Block::Figure(figure) = &blocks[1] else { panic!("the figure") };
    let file = reports::svg(figure).expect("drawn");
    let drawn = html.split("<svg ").nth(1).and_then(|rest| rest.split("</svg>").next()).expect("the chart");
    let elements = |svg: &str| svg.lines().filter(|l| l.starts_with("<path") || l.starts_with("<text")).count();
    assert!(!drawn.contains('#') && drawn.contains("class=\"fi") && drawn.contains("no finite data"), "{drawn}");
    let (_, body) = file.split_once("</style>").expect("a style");
    assert!(drawn.lines().skip(2).filter(|line| !line.is_empty()).all(|line| body.contains(line)));
    assert_eq!(elements(drawn) + 1, elements(&file), "the file has its ground besides");
}

/// Relative luminance and contrast after WCAG 2.1: 4.5 for words (1.4.3), 3 for what is drawn (1.4.11).
#[test]
fn every_colour_can_be_seen_on_every_ground_by_day_and_by_night() {
    for night in [false, true] {
        for ground in ["ground", "card"] {
            for words in ["ink", "soft", "link", "holds", "broken", "untested"] {
                let contrast = contrast(words, ground, night);
                assert!(contrast >= 4.5, "{words} on {ground}: {contrast:.2}, night: {night}");
            }
        }
        for line in 0..8 {
            let contrast = contrast(&format!("c{line}"), "ground", night);
            assert!(contrast >= 3.0, "line {line}: {contrast:.2}, night: {night}");
        }
    }
}

fn contrast(a: &str, b: &str, night: bool) -> f64 {
    let (a, b) = (luminance(a, night), luminance(b, night));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

fn luminance(name: &str, night: bool) -> f64 {
    let style = Page::default().html().expect("an empty page");
    let value = style.split(&format!("--{name}:light-dark(#")).nth(1).expect("the colour");
    let pair: Vec<&str> = value.split(')').next().expect("a pair").split(",#").collect();
    let hex = pair[usize::from(night)];
    let part = |i: usize| {
        let c = f64::from(u8::from_str_radix(&hex[2 * i..2 * i + 2], 16).expect("hexadecimal")) / 255.0;
        if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * part(0) + 0.7152 * part(1) + 0.0722 * part(2)
}
