//! The report's two pages in a browser, as a reader opens them: from the disk. Needs `chromium` and a report, and is
//! therefore no part of the plain test command:
//! `cargo test --release -p verification --test browser -- --ignored`
//!
//! Not seen here: other browsers, and whether the pages are pleasant.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use verification::chromium::Chromium;

/// Together the two pages are no larger than this, and the teaching page not than that: they are sent by mail.
const TWO_PAGES: u64 = 5_000_000;
const TEACHING_PAGE: u64 = 2_000_000;
/// A page that paints its first words later than this after it was asked for feels slow, ms.
const FIRST_PAINT_MS: f64 = 1000.0;
/// One picture of sixty in a second, ms.
const FRAME_MS: f64 = 16.0;
/// Stops of the teaching page.
const STOPS: usize = 10;

/// Texts with less contrast than this against what they stand on are hard to read (WCAG 2.2, 1.4.3).
const CONTRAST: f64 = 4.5;

/// A file of the report, in REPORT_DIR or where `cargo run --release` writes it.
fn page(name: &str) -> PathBuf {
    let directory = std::env::var_os("REPORT_DIR")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/report"), PathBuf::from);
    let file = directory.join(name);
    file.canonicalize().unwrap_or_else(|_| panic!("{}: write the report first, cargo run --release", file.display()))
}

/// Charts without a name that assistive technology would read.
const NAMELESS: &str = "[...document.querySelectorAll('svg, img, canvas, [role=img]')]
    .filter((e) => !e.closest('[aria-hidden=true]'))
    .filter((e) => !(e.getAttribute('aria-label') || e.getAttribute('aria-labelledby') || e.getAttribute('alt') || e.querySelector(':scope > title')?.textContent))
    .map((e) => e.outerHTML.slice(0, 120))";

/// Visible texts with less contrast than `LIMIT`, with the worst of each kind. What is drawn over a chart stands on the
/// nearest ground below it.
const FAINT: &str = r"(() => {
    const numbers = (c) => { const n = c.match(/[\d.]+/g).map(Number); return n.length > 3 ? n : [...n, 1]; };
    const light = ([r, g, b]) => { const f = (v) => ((v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4); return 0.2126 * f(r) + 0.7152 * f(g) + 0.0722 * f(b); };
    const over = (a, b) => [0, 1, 2].map((i) => a[i] * a[3] + b[i] * (1 - a[3])).concat(1);
    const ground = (e) => {
        const layers = [];
        for (; e; e = e.parentElement) { const c = numbers(getComputedStyle(e).backgroundColor); layers.push(c); if (c[3] === 1) break; }
        const dark = getComputedStyle(document.documentElement).colorScheme === 'dark';
        return layers.reverse().reduce((below, c) => over(c, below), dark ? [0, 0, 0, 1] : [255, 255, 255, 1]);
    };
    const faint = {}, walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
        const e = walk.currentNode.parentElement, text = walk.currentNode.textContent.trim();
        if (!text || e.closest('script, style, option, .skip, legend, noscript') || !e.getClientRects().length) continue;
        const style = getComputedStyle(e), below = ground(e);
        const ink = over(numbers(e.closest('svg') ? style.fill : style.color), below);
        const [a, b] = [light(ink), light(below)].sort((x, y) => y - x), ratio = (a + 0.05) / (b + 0.05);
        const kind = e.tagName + '.' + (e.getAttribute('class') ?? '');
        if (ratio < LIMIT && !(faint[kind]?.[0] <= ratio)) faint[kind] = [ratio, text.slice(0, 40)];
    }
    return faint;
})()";

const TWO_FRAMES: &str = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))";

/// Unfolds everything: what is folded has no size, and would be judged by nobody. How much there is.
const UNFOLD: &str = "(() => {
    const folded = [...document.querySelectorAll('details')];
    for (const details of folded) details.open = true;
    return folded.length;
})()";

/// What every page of the report owes its reader, in light and dark, on a desk and on a phone.
fn is_readable(name: &str, ready: &str) {
    let file = page(name);
    let mut browser = Chromium::start();
    for dark in [false, true] {
        for width in [1200_u32, 390] {
            browser.open(&file, width, dark);
            browser.wait(ready);
            let place = format!("{name}, {width} px, dark {dark}");
            assert!(browser.value(UNFOLD).as_u64() > Some(0), "{place}: nothing to unfold");
            browser.value(TWO_FRAMES);
            assert_eq!(browser.complaints(&file), Vec::<String>::new(), "{place}");
            assert!(browser.value("document.querySelectorAll('svg').length").as_u64() > Some(3), "{place}: charts");
            assert_eq!(browser.value(NAMELESS), json!([]), "{place}: charts without a name");
            let faint = browser.value(&FAINT.replace("LIMIT", &CONTRAST.to_string()));
            assert_eq!(faint, json!({}), "{place}: contrast below {CONTRAST}");
            let wide = browser.value("document.documentElement.scrollWidth").as_u64().expect("a number");
            assert!(wide <= u64::from(width), "{place}: {wide} px wide, it scrolls sideways");
        }
    }
}

#[test]
#[ignore = "needs chromium and a report"]
fn the_report_is_readable_and_loads_nothing() {
    is_readable("index.html", "true");
}

#[test]
#[ignore = "needs chromium and a report"]
fn the_teaching_page_is_readable_and_loads_nothing() {
    is_readable("teach.html", "!!window.teach");
}

#[test]
#[ignore = "needs chromium and a report"]
fn the_pages_are_small_enough_to_send() {
    let size = |name: &str| std::fs::metadata(page(name)).expect("a file").len();
    let (report, teaching) = (size("index.html"), size("teach.html"));
    assert!(teaching <= TEACHING_PAGE, "teach.html: {teaching} bytes");
    assert!(report + teaching <= TWO_PAGES, "index.html: {report} bytes, teach.html: {teaching} bytes");
}

/// The quickest of three openings: what else the machine does can only add.
#[test]
#[ignore = "needs chromium and a report"]
fn the_pages_paint_within_a_second() {
    let mut browser = Chromium::start();
    for name in ["index.html", "teach.html"] {
        let paint = "performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? null";
        let mut opened = || {
            browser.open(&page(name), 1200, false);
            browser.wait(&format!("({paint}) !== null"));
            browser.value(paint).as_f64().expect("a time")
        };
        let painted = (0..3).map(|_| opened()).fold(f64::INFINITY, f64::min);
        assert!(painted < FIRST_PAINT_MS, "{name}: first words after {painted} ms");
    }
}

fn teaching() -> (Chromium, PathBuf) {
    let file = page("teach.html");
    let mut browser = Chromium::start();
    browser.open(&file, 1200, false);
    browser.wait("!!window.teach");
    (browser, file)
}

#[test]
#[ignore = "needs chromium and a report"]
fn an_arrow_key_on_the_step_changes_the_pictures_and_the_numbers() {
    let (mut browser, file) = teaching();
    let seen = "['picture', 'track', 'energy', 'convergence', 'fourth', 'cost', 'story', 'h-value'].map((id) => document.getElementById(id).innerHTML)";
    let stops = browser.value("document.querySelectorAll('#stops button').length").as_u64().expect("a number");
    assert_eq!(stops, 10);
    for stop in 0..stops {
        browser.value(&format!("document.querySelectorAll('#stops button')[{stop}].click()"));
        browser.value(TWO_FRAMES);
        let before = browser.value(seen);
        browser.value("document.getElementById('h').focus()");
        browser.press("ArrowRight", 39);
        browser.value(TWO_FRAMES);
        let after = browser.value(seen);
        for (i, (a, b)) in
            before.as_array().into_iter().flatten().zip(after.as_array().into_iter().flatten()).enumerate()
        {
            assert_ne!(a, b, "stop {stop}, part {i}: nothing moved");
        }
        let story = browser.value("document.getElementById('story').innerText");
        let story = story.as_str().expect("text");
        assert!(story.len() > 200, "stop {stop} tells its story: {story}");
        assert!(
            !["NaN", "undefined", "null", "Infinity"].iter().any(|word| story.contains(word)),
            "stop {stop}: {story}"
        );
    }
    assert_eq!(browser.complaints(&file), Vec::<String>::new());
}

/// The page says itself how long it took; the proof in the worker is let finish before, as it wants a processor of its own.
#[test]
#[ignore = "needs chromium and a report"]
fn the_page_follows_the_hand() {
    let (mut browser, file) = teaching();
    browser.wait("document.getElementById('badge').dataset.finished === 'true'");
    let redrawn = "(async () => {
        const frame = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
        const slider = document.getElementById('h'), all = [];
        for (const button of document.querySelectorAll('#stops button')) {
            button.click();
            await frame();
            const took = [], edges = new Set();
            for (let value = +slider.min; value <= +slider.max; value += 8) {
                slider.value = value;
                slider.dispatchEvent(new Event('input'));
                await frame();
                took.push(window.teach.took);
                edges.add(slider.getBoundingClientRect().left);
            }
            all.push({ took, edges: edges.size });
        }
        return all;
    })()";
    // Another program on the machine adds time and never takes any away: the least of three is the page's own.
    let mut least = [f64::INFINITY; STOPS];
    for _ in 0..3 {
        let stops = browser.value(redrawn);
        let stops = stops.as_array().expect("a list");
        assert_eq!(stops.len(), STOPS);
        for (stop, (seen, least)) in stops.iter().zip(&mut least).enumerate() {
            let mut took: Vec<f64> = seen["took"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
            took.sort_by(f64::total_cmp);
            assert_eq!(took.len(), 31, "stop {stop}: a time for each place of the slider");
            let median = took[took.len() / 2];
            assert!(median > 0.0, "stop {stop}: {median} ms");
            *least = least.min(median);
            assert_eq!(seen["edges"], 1, "stop {stop}: the slider runs away from the hand");
        }
    }
    for (stop, ms) in least.into_iter().enumerate() {
        assert!(ms < FRAME_MS, "stop {stop}: half of the redraws take longer than {ms} ms");
    }
    assert_eq!(browser.complaints(&file), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium and a report"]
fn a_browser_that_lacks_something_is_told_so() {
    let file = page("teach.html");
    let mut browser = Chromium::start();
    let told = |browser: &mut Chromium, id: &str| {
        let text = browser.value(&format!("document.getElementById('{id}').innerText"));
        text.as_str().unwrap_or_default().to_owned()
    };
    let broken = [
        ("delete globalThis.DecompressionStream", "failed", "DecompressionStream"),
        ("delete globalThis.WebAssembly", "failed", "WebAssembly"),
        ("WebAssembly.instantiate = () => Promise.reject(new Error('no memory'))", "failed", "no memory"),
        ("globalThis.Worker = class { constructor() { throw new Error('no workers'); } }", "badge-text", "no workers"),
    ];
    for (source, place, word) in broken {
        let script = browser.send("Page.addScriptToEvaluateOnNewDocument", &json!({ "source": source }));
        browser.open(&file, 1200, false);
        browser.wait(&format!("document.getElementById('{place}').innerText.includes('{word}')"));
        assert_eq!(told(&mut browser, "failed").is_empty(), place != "failed", "{source}");
        browser.send("Page.removeScriptToEvaluateOnNewDocument", &script);
    }
}

#[test]
#[ignore = "needs chromium and a report"]
fn every_scene_and_method_is_drawn_and_a_wrong_parameter_is_refused() {
    let (mut browser, file) = teaching();
    let drawn = "(async () => {
        const missing = [], frame = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
        for (const { value } of document.getElementById('scene').options) {
            document.getElementById('scene').value = value;
            document.getElementById('scene').dispatchEvent(new Event('change', { bubbles: true }));
            for (const box of document.querySelectorAll('#methods input')) if (!box.checked) box.click();
            await frame();
            const lines = document.querySelectorAll('#picture .line:not(.exact):not(.wire):not(.behind):not(.cursor)').length;
            const rows = document.querySelectorAll('#cost tr').length, boxes = document.querySelectorAll('#methods input').length;
            if (lines < boxes || rows !== boxes) missing.push([value, lines, rows, boxes]);
        }
        return missing;
    })()";
    assert_eq!(browser.value(drawn), json!([]));
    let refused = "(async () => {
        document.getElementById('scene').value = 'kepler';
        document.getElementById('scene').dispatchEvent(new Event('change', { bubbles: true }));
        const field = document.querySelector('[name=eccentricity]'), told = [];
        for (const value of ['2', '0.25']) {
            field.value = value;
            field.dispatchEvent(new Event('change', { bubbles: true }));
            told.push(document.getElementById('refused').textContent);
        }
        return told;
    })()";
    let told = browser.value(refused);
    assert!(told[0].as_str().is_some_and(|text| text.contains("eccentricity") && text.contains("[0, 1)")), "{told}");
    assert_eq!(told[1], "");
    assert_eq!(browser.complaints(&file), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium and a report"]
fn the_browser_recomputes_every_number_of_the_badge() {
    let (mut browser, file) = teaching();
    browser.wait("document.getElementById('badge').dataset.finished === 'true'");
    let badge = browser.value(
        "({ ...document.getElementById('badge').dataset, text: document.getElementById('badge-text').textContent })",
    );
    let count = |name: &str| badge[name].as_str().and_then(|n| n.parse::<u64>().ok());
    // The page's rows in f32 and f64 of the report that lies beside it, three numbers each.
    let csv = std::fs::read_to_string(page("convergence.csv")).expect("the report's table");
    let shown = browser.value("DATA.scenes.map((s) => s.id)");
    let of_page = |line: &&str| {
        let mut fields = line.split(',');
        shown.as_array().is_some_and(|ids| ids.contains(&json!(fields.next())))
            && fields.nth(1) != Some("double-double")
    };
    let numbers = 3 * csv.lines().filter(of_page).count() as u64;
    assert!(numbers > 0, "a report without rows of the page proves nothing");
    assert_eq!([count("all"), count("done"), count("wrong")], [Some(numbers), Some(numbers), Some(0)], "{badge}");
    assert_eq!(browser.complaints(&file), Vec::<String>::new());
    // A row that is not what the browser computes is found.
    browser.value("DATA.rows.find((r) => r[2] === 1)[7] *= 1 + 2 ** -52; recompute(document.getElementById('module').textContent.trim())");
    browser.wait("document.getElementById('badge').dataset.wrong === '1' && document.getElementById('badge').dataset.finished === 'true'");
    let class: Value = browser.value("document.getElementById('badge').className");
    assert_eq!(class, "broken");
}
