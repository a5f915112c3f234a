//! Laws of the drawings, read back from the SVG.

use reports::{Axis, Cells, Figure, Layer, Palette, Scale, Series, svg};

/// Places on the sheet are rounded to a tenth of a CSS pixel; two of them are compared.
const TOLERANCE: f64 = 0.1 + 1e-9;

fn figure(x: Axis, y: Axis, layers: Vec<Layer>) -> Figure {
    let [title, caption] = ["A <title> & more", "What \"to\" see."].map(str::to_owned);
    Figure { id: "some figure".to_owned(), title, caption, x, y, layers, ..Figure::default() }
}

fn loglog(layers: Vec<Layer>) -> Figure {
    figure(Axis::log("h (s)"), Axis::log("error (m)"), layers)
}

fn line(points: Vec<[f64; 2]>) -> Series {
    Series { marker: None, ..Series::new("line", 0, points) }
}

/// Value of an attribute of an element.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let start = element.find(&format!(" {name}=\"")).expect("the attribute") + name.len() + 3;
    element[start..].split('"').next().expect("a value")
}

/// The points of every outline of a path of M, l, h and v, in CSS pixels.
fn outlines(d: &str) -> Vec<Vec<[f64; 2]>> {
    let mut found: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut at = [0.0, 0.0];
    let parts: Vec<&str> = d.split_inclusive(|c: char| c.is_ascii_alphabetic()).collect();
    for part in parts.windows(2) {
        let command = part[0].chars().last().expect("a command");
        let numbers = part[1].trim_end_matches(|c: char| c.is_ascii_alphabetic()).replace('-', " -");
        let numbers: Vec<f64> = numbers.split_whitespace().map(|n| n.parse().expect("a number")).collect();
        for step in numbers.chunks(if matches!(command, 'h' | 'v') { 1 } else { 2 }) {
            at = match command {
                'M' => [step[0], step[1]],
                'h' => [at[0] + step[0], at[1]],
                'v' => [at[0], at[1] + step[0]],
                _ => [at[0] + step[0], at[1] + step[1]],
            };
            if command == 'M' {
                found.push(Vec::new());
            }
            found.last_mut().expect("M comes first").push(at);
        }
    }
    found
}

/// The lines of the first palette colour, without the sample in the margin, which comes last.
fn lines(svg: &str) -> Vec<Vec<[f64; 2]>> {
    let mut all: Vec<_> = of_class(svg, "line s0").flat_map(|element| outlines(attribute(element, "d"))).collect();
    all.pop();
    all
}

fn of_class<'a>(svg: &'a str, class: &'a str) -> impl Iterator<Item = &'a str> {
    svg.lines()
        .filter(move |line| line.starts_with("<path") && line.contains("class=") && attribute(line, "class") == class)
}

/// The words on the sheet with the place of their anchor.
fn texts(svg: &str) -> Vec<(String, f64, f64)> {
    let level = svg.lines().filter(|line| line.starts_with("<text") && !line.contains("transform"));
    let read = |element: &str| {
        let at = |name| attribute(element, name).parse::<f64>().expect("a number");
        let words = element.split_once('>').and_then(|(_, rest)| rest.split_once('<')).expect("words").0;
        (words.to_owned(), at("x"), at("y"))
    };
    level.map(read).collect()
}

fn places_of(svg: &str, label: &str) -> Vec<(f64, f64)> {
    let places: Vec<_> = texts(svg).into_iter().filter(|(text, ..)| text == label).map(|(_, x, y)| (x, y)).collect();
    assert!(!places.is_empty(), "no {label} in {:?}", texts(svg));
    places
}

/// Column of a tick label of the x axis: the lowest on the sheet with these words.
fn column_of(svg: &str, label: &str) -> f64 {
    places_of(svg, label).into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).expect("one").0
}

/// Row of a tick label of the y axis: the leftmost on the sheet with these words.
fn row_of(svg: &str, label: &str) -> f64 {
    places_of(svg, label).into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("one").1
}

fn decade(exponent: i32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| c.to_digit(10).map_or('⁻', |d| digits[d as usize]);
    "10".to_owned() + &exponent.to_string().chars().map(raise).collect::<String>()
}

/// y = x^4 runs out of the range shown; what is left must still rise four decades a decade.
#[test]
fn a_line_that_leaves_the_frame_keeps_its_slope() {
    let power = [1e-6_f64, 1.0].map(|h| [h, h.powi(4)]).to_vec();
    let mut figure = loglog(vec![Layer::Series(line(power))]);
    figure.x = figure.x.with_range(1e-3, 10.0);
    figure.y = figure.y.with_range(1e-8, 10.0);
    let svg = svg(&figure).expect("drawn");
    let [a, b] = lines(&svg)[0][..] else { panic!("one segment") };
    let per_x = (column_of(&svg, "10⁻¹") - column_of(&svg, "10⁻³")) / 2.0;
    let per_y = (row_of(&svg, "10⁻⁴") - row_of(&svg, "10⁻⁸")) / 4.0;
    // The line enters where y = 1e-8, that is at x = 1e-2. A label's base line is .36 of its 12.5 pixels below its tick.
    let entry = [column_of(&svg, "10⁻²"), row_of(&svg, "10⁻⁸") - 0.36 * 12.5];
    assert!((0..2).all(|i| (a[i] - entry[i]).abs() <= TOLERANCE), "{a:?} {entry:?}");
    let slope = ((b[1] - a[1]) / per_y) / ((b[0] - a[0]) / per_x);
    // Its ends, and the labels that give the scale, are rounded to a twentieth of a pixel each; the line is over 225 pixels
    // wide and 375 high, the labels over 225 apart.
    assert!((slope - 4.0).abs() < 4.0 * (4.0 * 0.1 / 225.0), "{slope}");
}

#[test]
fn what_cannot_be_shown_breaks_the_line_and_is_not_bridged() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0] {
        let points = vec![[1e-3, 1e-6], [1e-2, 1e-5], [3e-2, bad], [1e-1, 1e-4], [1.0, 1e-3]];
        let drawn = lines(&svg(&loglog(vec![Layer::Series(line(points))])).expect("drawn"));
        assert_eq!(drawn.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2], "{bad}");
        assert!(drawn[0][1][0] < drawn[1][0][0], "{bad}: {drawn:?}");
    }
}

#[test]
fn decades_below_the_spacing_of_doubles_have_their_labels() {
    let points = (0..30).map(|i| [10_f64.powi(-i / 8), 10_f64.powi(-i)]).collect();
    let svg = svg(&loglog(vec![Layer::Series(line(points))])).expect("drawn");
    let rows: Vec<f64> = [-18, -21, -24, -27].map(|e| row_of(&svg, &decade(e))).to_vec();
    let steps: Vec<f64> = rows.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(steps.iter().all(|step| (step - steps[0]).abs() <= 2.0 * TOLERANCE && *step > 15.0), "{steps:?}");
}

#[test]
fn a_figure_with_nothing_to_draw_says_so_and_has_a_frame() {
    let nothing = vec![[f64::NAN, 1.0], [1.0, f64::INFINITY]];
    for layers in [vec![], vec![Layer::Series(line(nothing))]] {
        for axis in [Axis::linear("x"), Axis::log("x")] {
            let svg = svg(&figure(axis.clone(), axis.clone(), layers.clone())).expect("drawn");
            assert!(svg.contains("no finite data") && of_class(&svg, "axis").count() == 1, "{axis:?}");
        }
    }
    let something = svg(&loglog(vec![Layer::Series(line(vec![[1.0, 1.0]]))])).expect("drawn");
    assert!(!something.contains("no finite data"));
}

#[test]
fn a_failed_run_is_shown_even_where_nothing_else_is() {
    let crosses = |failed: Vec<f64>| {
        let series = Series { failed, ..line(vec![[0.01, 1.0], [0.1, 2.0]]) };
        let svg = svg(&loglog(vec![Layer::Series(series)])).expect("drawn");
        of_class(&svg, "failed s0").count()
    };
    assert_eq!([vec![], vec![0.5], vec![0.5, 2.0], vec![f64::NAN, -1.0]].map(crosses), [0, 1, 2, 2]);
}

#[test]
fn names_stand_in_the_right_margin_without_touching() {
    let end = |i: usize| vec![[1e-3, 1e-9], [1.0, 1.0 + 0.01 * i as f64]];
    let layers = (0..8).map(|i| Layer::Series(Series::new(format!("name {i}"), i, end(i)))).collect();
    let svg = svg(&loglog(layers)).expect("drawn");
    let frame = column_of(&svg, "10⁰");
    let places: Vec<_> = texts(&svg).into_iter().filter(|(text, ..)| text.starts_with("name ")).collect();
    let mut rows: Vec<f64> = places.iter().map(|(.., y)| *y).collect();
    rows.sort_by(f64::total_cmp);
    assert!(places.len() == 8 && places.iter().all(|(_, x, _)| *x > frame), "{places:?}");
    assert!(rows.windows(2).all(|pair| pair[1] - pair[0] >= 16.0), "{rows:?}");
}

#[test]
fn the_drawing_has_an_accessible_name_and_escaped_words() {
    let series = Series::new("a < b & c", 0, vec![[1.0, 1.0]]);
    let svg = svg(&loglog(vec![Layer::Series(series)])).expect("drawn");
    assert!(svg.contains("width=\"800\" height=\"560\" viewBox=\"0 0 800 560\" role=\"img\""));
    assert!(svg.contains("aria-labelledby=\"some_figure-title some_figure-desc\""));
    assert!(svg.contains("<title id=\"some_figure-title\">A &lt;title&gt; &amp; more</title>"));
    assert!(svg.contains("<desc id=\"some_figure-desc\">What \"to\" see.</desc>"));
    assert!(svg.contains("a &lt; b &amp; c") && !svg.contains("a < b"));
    assert!(svg.contains("sans-serif") && svg.trim_end().ends_with("</svg>") && svg.matches("<svg").count() == 1);
}

#[test]
fn the_same_figure_gives_the_same_bytes_from_any_thread() {
    let layers = vec![
        Layer::Series(Series::new("one", 3, (1..20).map(|i| [0.5_f64.powi(i), 0.1_f64.powi(i)]).collect())),
        Layer::SlopeTriangle { order: 2.0 },
        Layer::Floor { y: 1e-16, label: "floor".to_owned() },
    ];
    let figure = loglog(layers);
    let first = svg(&figure).expect("drawn");
    let draw = |figure: Figure| std::thread::spawn(move || svg(&figure).expect("drawn"));
    let others: Vec<_> = (0..4).map(|_| draw(figure.clone())).collect();
    assert!(others.into_iter().all(|thread| thread.join().expect("finished") == first));
}

#[test]
fn a_figure_survives_its_own_json() {
    let values = vec![Some(1.5), None];
    let palette = Palette::Sequential { label: "a".to_owned(), scale: Scale::Log };
    let cells = Cells { x0: 0.1, x1: 10.0, nx: 1, y0: 0.0, y1: 1.0, ny: 2, values, palette };
    let before = loglog(vec![Layer::Cells(cells), Layer::Series(Series::new("b", 1, vec![[0.1, 1.0 / 3.0]]))]);
    let text = serde_json::to_string(&before).expect("plain data");
    assert_eq!(serde_json::from_str::<Figure>(&text).expect("what was written"), before);
}

#[test]
fn contradictions_are_refused_with_their_place() {
    let whiskers = Series { whiskers: vec![[0.0, 1.0]], ..line(vec![[1.0, 1.0], [2.0, 2.0]]) };
    let message = svg(&loglog(vec![Layer::Series(whiskers)])).expect_err("one whisker for two points").to_string();
    assert!(message.contains("'some figure', layer 1:") && message.contains("1 whiskers for 2"), "{message}");
    let mut flat = loglog(vec![]);
    flat.y = flat.y.with_range(1.0, 1.0);
    assert!(svg(&flat).expect_err("an empty range").to_string().contains("y axis"));
    let uneven = Figure { equal_axes: true, ..loglog(vec![]) };
    assert!(svg(&uneven).expect_err("no unit on a log axis").to_string().contains("two linear axes"));
}

/// Runs itself once more with a font configuration that knows no font: the drawing must not change.
#[test]
fn no_font_of_the_machine_is_used() {
    let series = Series::new("θ, h⁴", 0, vec![[0.1, 0.2]]);
    let drawn = svg(&loglog(vec![Layer::Series(series)])).expect("drawn");
    if let Some(copy) = std::env::var_os("REPORTS_TEST_COPY") {
        std::fs::write(copy, drawn).expect("written");
        return;
    }
    let directory = tempfile::tempdir().expect("a temporary directory");
    let (fonts, copy) = (directory.path().join("fonts.conf"), directory.path().join("drawn.svg"));
    std::fs::write(&fonts, "<?xml version=\"1.0\"?><fontconfig></fontconfig>").expect("written");
    let status = std::process::Command::new(std::env::current_exe().expect("this program"))
        .args(["--exact", "no_font_of_the_machine_is_used"])
        .env_clear()
        .env("FONTCONFIG_FILE", fonts)
        .env("REPORTS_TEST_COPY", &copy)
        .stdout(std::process::Stdio::null())
        .status();
    assert!(status.expect("started").success());
    assert_eq!(std::fs::read_to_string(copy).expect("the copy"), drawn);
}

#[test]
fn a_line_under_another_is_seen_between_its_dashes_and_a_mark_around_it() {
    let points: Vec<[f64; 2]> = (1..6).map(|i| [f64::from(i), f64::from(i * i)]).collect();
    let apart: Vec<[f64; 2]> = points.iter().map(|[x, y]| [*x, y + 9.0]).collect();
    let series = |name: &str, color, points: &Vec<[f64; 2]>| Layer::Series(Series::new(name, color, points.clone()));
    let layers =
        vec![series("a", 0, &points), series("b", 1, &points), series("c", 2, &apart), series("d", 3, &points)];
    let svg = svg(&figure(Axis::linear("x"), Axis::linear("y"), layers)).expect("drawn");
    // Of every name the line and its sample in the margin.
    let counts = ["line s0", "line s1", "line s1 over1", "line s2", "line s3 over2"].map(|c| of_class(&svg, c).count());
    assert_eq!(counts, [2, 1, 1, 2, 1]);
    let width = |class: &str| {
        let mark = outlines(attribute(of_class(&svg, class).next().expect("marks"), "d")).swap_remove(0);
        let xs = || mark.iter().map(|p| p[0]);
        xs().fold(f64::MIN, f64::max) - xs().fold(f64::MAX, f64::min)
    };
    // A square of half diagonal 1.27 times 3.6 pixels, and a diamond of 1.4 times; one mark lies on the square.
    assert!(
        (width("mark f1") - 1.45 * 2.0 * 0.5_f64.sqrt() * 1.27 * 3.6).abs() <= 2.0 * TOLERANCE,
        "{}",
        width("mark f1")
    );
    assert!((width("mark f3") - 2.0 * 1.4 * 3.6).abs() <= 2.0 * TOLERANCE);
}

#[test]
fn with_equal_axes_a_disc_is_round() {
    for size in [(800, 560), (300, 900)] {
        let circle =
            (0..=64).map(|i| f64::from(i) * std::f64::consts::TAU / 64.0).map(|t| [3.0 * t.cos(), 3.0 * t.sin()]);
        let mut disc = figure(Axis::linear("x").with_range(-5.0, 4.0), Axis::linear("y").with_range(-4.0, 4.0), vec![]);
        disc.layers.push(Layer::Series(line(circle.collect())));
        let disc = Figure { equal_axes: true, width: size.0, height: size.1, ..disc };
        let drawn = lines(&svg(&disc).expect("drawn")).swap_remove(0);
        let extent = |i: usize| {
            let of = || drawn.iter().map(|p| p[i]);
            of().fold(f64::MIN, f64::max) - of().fold(f64::MAX, f64::min)
        };
        assert!((extent(0) - extent(1)).abs() <= 2.0 * TOLERANCE && extent(0) > 50.0, "{} {}", extent(0), extent(1));
    }
}

#[test]
fn no_word_is_cut_however_long_a_name() {
    let long = "a name of very many words that has to be set in lines, with-one-that-is-wider-than-any-margin-and-has-no-blank";
    let [x, y] = [Axis::linear(long), Axis::linear(long)];
    let palette = Palette::Categories { names: vec![long.to_owned()] };
    let cells = Cells { x0: 0.0, x1: 1.0, nx: 1, y0: 0.0, y1: 1.0, ny: 1, values: vec![Some(0.0)], palette };
    let curve = Layer::Curve { name: long.to_owned(), points: vec![[0.0, 0.0], [1.0, 1.0]], color: None };
    let mut figure =
        figure(x, y, vec![Layer::Cells(cells), Layer::Series(Series::new(long, 0, vec![[0.5, 0.5]])), curve]);
    figure.title = long.to_owned();
    let svg = svg(&figure).expect("drawn");
    let words = svg.lines().filter(|l| l.starts_with("<text")).filter_map(|l| l.split_once('>')?.1.split('<').next());
    let all = words.collect::<String>().replace(' ', "");
    assert_eq!(all.matches(&long.replace(' ', "")).count(), 6, "title, two axes, a kind, a series, a curve: {all}");
}
