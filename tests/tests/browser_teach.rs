//! The teaching page in a browser: what moves, links, the table that it saves, and what keyboard and screen reader meet.
//! Needs `chromium` and a report, as `browser.rs` does:
//! `cargo test --release -p verification --test browser_teach -- --ignored`

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use verification::chromium::Chromium;

/// One picture of sixty in a second, ms.
const FRAME_MS: f64 = 16.0;
/// Lines and marks with less contrast than this against what they stand on are hard to see (WCAG 2.2, 1.4.11).
const CONTRAST_OF_LINES: f64 = 3.0;

const TWO_FRAMES: &str = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))";

fn teaching(dark: bool) -> (Chromium, PathBuf) {
    let directory = std::env::var_os("REPORT_DIR")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/report"), PathBuf::from);
    let file = directory.join("teach.html");
    let file = file.canonicalize().unwrap_or_else(|_| panic!("{}: write the report first", file.display()));
    let mut browser = Chromium::start();
    browser.open(&file, 1200, dark);
    browser.wait("!!window.teach?.took");
    (browser, file)
}

// Fails if: a control has no name for a screen reader, or one is not reached by the Tab key.
#[test]
#[ignore = "needs chromium and a report"]
fn every_control_has_a_name_and_is_reached_by_the_keyboard() {
    let (mut browser, file) = teaching(false);
    browser.value("document.getElementById('parameters').open = true");
    browser.value(TWO_FRAMES);
    browser.send("Accessibility.enable", &json!({}));
    let tree = browser.send("Accessibility.getFullAXTree", &json!({}));
    let of_controls =
        ["button", "slider", "combobox", "checkbox", "textbox", "link", "spinbutton", "DisclosureTriangle"];
    let nodes = tree["nodes"].as_array().expect("a tree");
    let controls: Vec<&Value> = nodes
        .iter()
        .filter(|node| node["ignored"] != json!(true))
        .filter(|node| of_controls.iter().any(|role| node["role"]["value"] == json!(role)))
        .collect();
    assert!(controls.len() > 30, "{} controls", controls.len());
    for node in &controls {
        assert!(node["name"]["value"].as_str().is_some_and(|name| name.trim().len() > 1), "without a name: {node}");
    }
    // Every picture has a text in its place, and tells numbers.
    let pictures: Vec<&Value> = nodes.iter().filter(|node| node["role"]["value"] == "image").collect();
    assert_eq!(pictures.iter().filter(|node| node["ignored"] != json!(true)).count(), 6);
    for node in pictures {
        let name = node["name"]["value"].as_str().unwrap_or_default();
        assert!(name.len() > 40 && name.contains(|c: char| c.is_ascii_digit()), "{name}");
    }
    let missed = browser.value(
        "(() => {
        const all = [...document.querySelectorAll('button, input, select, a[href], summary, [tabindex]')];
        return all.filter((e) => e.getClientRects().length && !e.disabled && e.tabIndex < 0).map((e) => e.outerHTML.slice(0, 80));
    })()",
    );
    assert_eq!(missed, json!([]));
    assert_eq!(browser.complaints(&file), Vec::<String>::new());
}

// Fails if: a method's colour, or that of the exact motion, is hardly seen on its card, in light or dark.
#[test]
#[ignore = "needs chromium and a report"]
fn the_lines_stand_out_from_their_ground() {
    let ratios = "(() => {
        const light = (hex) => { const f = (v) => ((v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4), n = parseInt(hex.slice(1), 16);
            return 0.2126 * f(n >> 16) + 0.7152 * f((n >> 8) & 255) + 0.0722 * f(n & 255); };
        const style = getComputedStyle(document.documentElement), value = (name) => style.getPropertyValue(name).trim();
        const names = ['--exact', ...Array.from({ length: 9 }, (_, i) => `--m${i}`)];
        return names.map((name) => { const [a, b] = [light(value(name)), light(value('--card'))].sort((x, y) => y - x); return [name, (a + 0.05) / (b + 0.05)]; });
    })()";
    for dark in [false, true] {
        let (mut browser, _) = teaching(dark);
        let all = browser.value(ratios);
        assert_eq!(all.as_array().map(Vec::len), Some(10));
        for pair in all.as_array().into_iter().flatten() {
            assert!(pair[1].as_f64().is_some_and(|ratio| ratio >= CONTRAST_OF_LINES), "dark {dark}: {pair}");
        }
    }
}

// Fails if: nothing moves, a frame takes longer than a sixtieth of a second, or a reader cannot stop it.
#[test]
#[ignore = "needs chromium and a report"]
fn the_motion_moves_can_be_stopped_and_stands_still_where_it_is_asked_to() {
    let (mut browser, file) = teaching(false);
    browser.wait("document.getElementById('badge').dataset.finished === 'true'");
    let picture = "document.getElementById('motion').innerHTML";
    let motions = "(async () => {
        const frame = () => new Promise((done) => requestAnimationFrame(done)), all = [];
        document.getElementById('motion').scrollIntoView();
        for (const { value } of document.getElementById('scene').options) {
            document.getElementById('scene').value = value;
            document.getElementById('scene').dispatchEvent(new Event('change', { bubbles: true }));
            for (const box of document.querySelectorAll('#methods input')) if (!box.checked) box.click();
            for (let i = 0; i < 5; i++) await frame();
            const took = [], pictures = new Set();
            for (let i = 0; i < 30; i++) { await frame(); took.push(window.teach.motion); pictures.add(document.getElementById('motion').innerHTML); }
            all.push([value, took.sort((a, b) => a - b)[15], pictures.size]);
        }
        return all;
    })()";
    let all = browser.value(motions);
    for scene in all.as_array().expect("a list") {
        assert!(scene[1].as_f64().is_some_and(|ms| ms < FRAME_MS), "{scene}: ms of a frame");
        assert!(scene[2].as_u64().is_some_and(|pictures| pictures > 10), "{scene}: it does not move");
    }
    browser.value("document.getElementById('play').click()");
    browser.value(TWO_FRAMES);
    let stands = browser.value(picture);
    std::thread::sleep(std::time::Duration::from_millis(200));
    assert_eq!(browser.value(picture), stands, "it moves on after Pause");
    assert_eq!(browser.value("document.getElementById('play').textContent"), "Play");
    browser.value("document.getElementById('t').focus()");
    browser.press("ArrowRight", 39);
    browser.value(TWO_FRAMES);
    assert_ne!(browser.value(picture), stands, "the time cannot be dragged");
    // A system that asks for less motion: it starts still.
    let less = json!({ "features": [{ "name": "prefers-reduced-motion", "value": "reduce" }] });
    browser.send("Emulation.setEmulatedMedia", &less);
    browser.send("Page.reload", &json!({}));
    std::thread::sleep(std::time::Duration::from_millis(500));
    browser.wait("document.readyState === 'complete' && !!window.teach?.took");
    let stands = browser.value(picture);
    std::thread::sleep(std::time::Duration::from_millis(200));
    assert_eq!(browser.value(picture), stands);
    assert_eq!(browser.value("document.getElementById('play').textContent"), "Play");
    assert_eq!(browser.complaints(&file), Vec::<String>::new());
}

// Fails if: a link loses a setting, or what a reader sets does not get into the address.
#[test]
#[ignore = "needs chromium and a report"]
fn a_link_opens_the_page_as_it_was() {
    let (mut browser, file) = teaching(false);
    let follow = |browser: &mut Chromium, hash: &str| {
        browser.value(&format!("location.hash = '{hash}'"));
        browser.value(TWO_FRAMES);
        browser.value(TWO_FRAMES);
        let kept = "({ hash: location.hash, told: document.getElementById('linked').textContent, h: state.h, steps: teach.steps, ...state })";
        browser.value(kept)
    };
    for hash in [
        "#stop=3&h=0.1",
        "#stop=1&h=0.05&methods=rk4,half-kick&precision=f32&substeps=4&jitter=0.2&set=mass%3A2",
        "#stop=6&h=0.02&scene=tennis-racket&methods=free-splitting&storage=body-omega",
        "#stop=8&h=0.03&scene=kepler&set=eccentricity%3A0.25&set=mu%3A3",
    ] {
        let seen = follow(&mut browser, hash);
        assert_eq!(seen["hash"], hash);
        assert_eq!(seen["told"], "", "{hash}");
    }
    let seen = follow(&mut browser, "#stop=1&h=0.05&methods=rk4&substeps=4&jitter=0.2&set=mass:3");
    assert_eq!(seen["methods"], json!(["rk4"]));
    assert_eq!((seen["substeps"].as_u64(), seen["h"].as_f64()), (Some(4), Some(0.05)));
    assert_eq!((seen["set"]["mass"].as_str(), seen["jitter"].as_f64()), (Some("3"), Some(0.2)));
    // 25 s in steps of 0.05 / 4 s.
    assert_eq!(seen["steps"], 2000);
    let wrong = follow(&mut browser, "#stop=12&scene=mars&h=1e9&methods=euler&set=charm:1&who=me");
    for word in ["stop=12", "scene=mars", "h=1e9", "methods=euler", "set=charm:1", "who=me"] {
        assert!(wrong["told"].as_str().is_some_and(|told| told.contains(word)), "{word}: {wrong}");
    }
    // What is set by hand.
    browser.value("go(1); document.querySelector('#methods input[value=rk4]').click()");
    browser.value(TWO_FRAMES);
    browser.value(TWO_FRAMES);
    assert_eq!(browser.value("location.hash"), "#stop=2&h=0.25&methods=semi-implicit-euler,rk4");
    assert_eq!(browser.complaints(&file), Vec::<String>::new());
}

// Fails if: the table that is saved has not the numbers of the pictures, or no names for its columns.
#[test]
#[ignore = "needs chromium and a report"]
fn the_table_that_is_saved_holds_the_runs_that_are_shown() {
    let (mut browser, _) = teaching(false);
    browser.value("location.hash = '#stop=1&h=0.05'");
    browser.value(TWO_FRAMES);
    browser.value(TWO_FRAMES);
    let table = browser.value("csv()");
    let table = table.as_str().expect("text");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("source,h_s,step,t_s,position_m,velocity_m_s,energy_J"));
    // The exact motion at 361 times, and each run of 500 steps at every second step.
    assert_eq!(table.lines().filter(|line| line.starts_with("exact,,")).count(), 361);
    assert_eq!(table.lines().filter(|line| line.starts_with("explicit-euler,0.05,")).count(), 251);
    // x1 = x0 + h v0, x2 = x1 + h (v0 - h w^2 x0), in f64.
    let (h, w2, x0, v0) = (0.05, 4.0, 0.75, -1.25);
    let second = table.lines().find(|line| line.starts_with("explicit-euler,0.05,2,")).expect("the second step");
    let x2: f64 = second.split(',').nth(4).expect("a column").parse().expect("a number");
    let exact: f64 = x0 + h * v0 + h * (v0 - h * w2 * x0);
    assert!((x2 - exact).abs() <= 4.0 * f64::EPSILON, "{x2} {exact}");
    for scene in ["tennis-racket", "kepler"] {
        browser.value(&format!("location.hash = '#stop=1&scene={scene}'"));
        browser.value(TWO_FRAMES);
        browser.value(TWO_FRAMES);
        let widths = browser.value("[...new Set(csv().trim().split('\\n').map((line) => line.split(',').length))]");
        assert_eq!(widths.as_array().map(Vec::len), Some(1), "{scene}: {widths}");
    }
}

const LESSON: &str = include_str!("../../reports/guides/lesson.md");
const WORKSHEET: &str = include_str!("../../reports/guides/worksheet.md");

/// The links of a text, each with the rest of its line.
fn links(text: &str) -> Vec<(&str, &str)> {
    text.lines().filter_map(|line| line.split_once("`#stop=").and_then(|(_, rest)| rest.split_once('`'))).collect()
}

// Fails if: a number of the lesson is not on the page that its link opens, or a number in bold has no link in its line; or a link of
// the worksheet is not one of the lesson's.
#[test]
#[ignore = "needs chromium and a report"]
fn every_number_of_the_lesson_is_on_the_page_that_its_link_opens() {
    let (mut browser, file) = teaching(false);
    let mut numbers = 0;
    for (link, rest) in links(LESSON) {
        browser.value(&format!("location.hash = '#stop={link}'"));
        browser.value(TWO_FRAMES);
        browser.value(TWO_FRAMES);
        let told = browser.value("document.getElementById('linked').textContent");
        assert_eq!(told, "", "{link}");
        let page =
            browser.value("['story', 'cost', 'h-value'].map((id) => document.getElementById(id).innerText).join(' ')");
        let page = page.as_str().expect("text");
        for number in rest.split("**").skip(1).step_by(2) {
            let is_there = page
                .split(|c: char| c.is_whitespace() || c == '=' || c == ';' || c == ':')
                .any(|word| word.trim_end_matches([',', '.', '×']) == number.trim_end_matches('×'));
            assert!(is_there, "#stop={link}: {number} is not on the page: {page}");
            numbers += 1;
        }
    }
    let bold =
        LESSON.split("**").skip(1).step_by(2).filter(|bold| bold.starts_with(|c: char| c.is_ascii_digit())).count();
    assert_eq!(numbers, bold, "a number in bold without a link in its line");
    assert!(numbers >= 30, "{numbers} numbers");
    let of_lesson: Vec<&str> = links(LESSON).into_iter().map(|(link, _)| link).collect();
    for (link, _) in links(WORKSHEET) {
        assert!(of_lesson.contains(&link), "the lesson has no answer for #stop={link}");
    }
    // What the worksheet asks about substeps: with 2 the energy still rises above twice its start, with 4 it does not.
    let mut highest = |substeps: u32| {
        browser.value(&format!("location.hash = '#stop=9&h=0.7&substeps={substeps}'"));
        browser.value(TWO_FRAMES);
        browser.value(TWO_FRAMES);
        browser
            .value("Math.max(...view.runs['semi-implicit-euler'].energy.map((p) => p[1]))")
            .as_f64()
            .expect("a number")
    };
    assert!(highest(2) > 2.0 && highest(4) < 2.0);
    assert_eq!(browser.complaints(&file), Vec::<String>::new());
}
