//! Draws one figure of each kind into `target/gallery`, to look at after a change of the drawing. The data are made up.
//!
//! `cargo run -p reports --release --example gallery`

use reports::{
    Axis, AxisName, Block, Cells, Claim, Error, Figure, Finding, Layer, OutputDir, Page, Palette, Scale, Section,
};
use reports::{Series, Table, Verdict};

fn main() -> Result<(), Error> {
    let output = OutputDir::create("target/gallery")?;
    let mut blocks = vec![Block::Text("One of each kind.".to_owned()), table(), Block::Claims(claims())];
    for figure in all() {
        let svg = reports::svg(&figure)?;
        if reports::DRAWS_PNG {
            output.write(&format!("{}.png", figure.id), reports::png(&svg, &figure.id)?)?;
        }
        output.write(&format!("{}.svg", figure.id), svg)?;
        blocks.push(Block::Figure(figure));
    }
    let [id, title, intro] = ["all", "All kinds", "What the drawing can do."].map(str::to_owned);
    let [head, text] = ["RK4 keeps its order", "Fourth order down to the round-off of f64."].map(str::to_owned);
    let page = Page {
        title: "Gallery".to_owned(),
        lead: "Every kind of figure, table and claim, with made-up data.".to_owned(),
        links: Vec::new(),
        answer: Vec::new(),
        findings: vec![Finding { title: head, text, figure: Some("convergence".to_owned()), ..Finding::default() }; 3],
        sections: vec![Section { id, title, intro, blocks }],
        footer: vec![("command".to_owned(), "cargo run -p reports --release --example gallery".to_owned())],
    };
    output.write("index.html", page.html()?)?;
    Ok(())
}

fn all() -> [Figure; 10] {
    [convergence(), double_double(), drift(), linear(), coincident(), stability(), disc(), radius(), empty(), many()]
}

fn table() -> Block {
    let mut table = Table::new(&["method", "order", "error (m)", "outcome"], &["order", "error (m)"]);
    for (i, (name, order, _)) in METHODS.into_iter().enumerate() {
        let error = if i == 2 { String::new() } else { format!("{:.2e}", 0.3_f64.powi(7 * (i as i32 % 4))) };
        table.push([name.to_owned(), order.to_string(), error, "finished".to_owned()]);
    }
    Block::Table { caption: "Methods".to_owned(), table, csv: Some("methods.csv".to_owned()) }
}

fn claims() -> Vec<Claim> {
    let verdicts = [Verdict::Holds, Verdict::Broken, Verdict::NotTested];
    let claim = |(i, verdict): (usize, Verdict)| {
        let statement = format!("{} has order {} on the harmonic oscillator", METHODS[i].0, METHODS[i].1);
        let [theory, measured, bound] = [&METHODS[i].1.to_string(), "0.998 ± 0.003", "0.95 to 1.05"].map(str::to_owned);
        Claim::new("gallery", format!("gallery.{i}"), [statement, theory, measured, bound], verdict)
    };
    verdicts.into_iter().enumerate().map(claim).collect()
}

fn figure(id: &str, title: &str, x: Axis, y: Axis, layers: Vec<Layer>) -> Figure {
    let caption = format!("{title}, with made-up data.");
    Figure { id: id.to_owned(), title: title.to_owned(), caption, x, y, layers, ..Figure::default() }
}

const METHODS: [(&str, f64, f64); 6] = [
    ("explicit Euler", 1.0, 3.0),
    ("semi-implicit Euler", 1.0, 0.5),
    ("velocity Verlet", 2.0, 0.2),
    ("RK4", 4.0, 0.05),
    ("implicit Euler", 1.0, 2.2),
    ("implicit midpoint", 2.0, 0.4),
];

fn errors(order: f64, constant: f64, floor: f64) -> Vec<[f64; 2]> {
    let noise = |i: i32| floor * (1.0 + 0.6 * f64::from((i * 7) % 5));
    let h = |i: i32| 2.0_f64.powi(i - 14);
    (0..14).map(|i| [h(i), (constant * h(i).powf(order)).max(noise(i))]).collect()
}

fn convergence() -> Figure {
    let mut layers: Vec<Layer> = (0..6)
        .map(|i| {
            let (name, order, constant) = METHODS[i];
            let mut series = Series::new(name, i, errors(order, constant, 2e-16));
            if i == 0 {
                series.failed = vec![0.25, 0.5];
                series.points.truncate(12);
            }
            if i == 2 {
                series.whiskers = series.points.iter().map(|[_, y]| [y / 2.5, y * 2.5]).collect();
                series.failed = vec![0.5];
                series.points[12][1] = f64::NAN;
            }
            Layer::Series(series)
        })
        .collect();
    layers.extend([1.0, 2.0, 4.0].map(|order| Layer::SlopeTriangle { order }));
    layers.push(Layer::Floor { y: 2.2e-16, label: "round-off of f64".to_owned() });
    let title = "Global error after one period, harmonic oscillator";
    figure("convergence", title, Axis::log("step size h (s)"), Axis::log("|x(T) − x*(T)| (m)"), layers)
}

fn double_double() -> Figure {
    let mut layers: Vec<Layer> = (0..6)
        .map(|i| Layer::Series(Series::new(METHODS[i].0, i, errors(2.0 * METHODS[i].1, METHODS[i].2, 1e-31))))
        .collect();
    layers.extend([2.0, 4.0, 8.0].map(|order| Layer::SlopeTriangle { order }));
    layers.push(Layer::Floor { y: 1e-31, label: "round-off of double-double".to_owned() });
    layers.push(Layer::Guide { axis: AxisName::Y, at: 2.2e-16, label: "ε of f64".to_owned() });
    let title = "The same in double-double arithmetic: the orders go on to 10⁻³¹, so that what f64 loses below 10⁻¹⁵ is rounding";
    figure("double_double", title, Axis::log("step size h (s)"), Axis::log("|x(T) − x*(T)| (m)"), layers)
}

fn drift() -> Figure {
    let grow = |f: &dyn Fn(f64) -> f64| (0..200).map(|i| f64::from(i) * 5.0).map(|t| [t, f(t)]).collect::<Vec<_>>();
    let mut euler = Series::new("explicit Euler", 0, grow(&|t| 1e-4 * (t / 40.0).exp()));
    let mut semi = Series::new("semi-implicit Euler", 1, grow(&|t| 2e-3 * (1.1 + (t / 9.0).sin())));
    let mut rk4 = Series::new("RK4", 3, grow(&|t| 1e-9 * t));
    (euler.marker, semi.marker, rk4.marker) = (None, None, None);
    euler.failed = vec![760.0];
    euler.points.truncate(150);
    rk4.line = Some(reports::Line::Dashed);
    let theory = Layer::Curve { name: "theory, t h⁴".to_owned(), points: grow(&|t| 1.4e-9 * t), color: None };
    let band = Layer::Band { axis: AxisName::X, from: 100.0, to: 300.0, label: "window of the fit".to_owned() };
    let layers = vec![band, Layer::Series(euler), Layer::Series(semi), Layer::Series(rk4), theory];
    figure(
        "drift",
        "Energy error over a thousand seconds",
        Axis::linear("time t (s)"),
        Axis::log("|E − E₀| / E₀"),
        layers,
    )
}

fn linear() -> Figure {
    let wave =
        |a: f64| (0..80).map(move |i| f64::from(i) * 0.25).map(|t| [t, a * (t * 0.9).sin() * 1e-5]).collect::<Vec<_>>();
    let mut layers: Vec<Layer> =
        (0..3).map(|i| Layer::Series(Series::new(METHODS[i].0, i, wave(1.0 + i as f64 * 0.02)))).collect();
    layers.push(Layer::Guide { axis: AxisName::Y, at: 0.0, label: "exact".to_owned() });
    layers.push(Layer::Text { at: [14.0, 8e-6], text: "a remark".to_owned() });
    figure("linear", "Linear axes & <small> values", Axis::linear("t (s)"), Axis::linear("error of x (m)"), layers)
}

fn stability() -> Figure {
    let (nx, ny) = (120, 80);
    let at = |i: usize, n: usize, a: f64, b: f64| a + (b - a) * (i as f64 + 0.5) / n as f64;
    let kind = |i: usize| {
        let (x, y) = (at(i % nx, nx, 0.0, 3.0), at(i / nx, ny, 0.0, 1.5));
        if x > 2.8 && y > 1.2 {
            None
        } else if x * x + 2.0 * x * y < 4.0 {
            Some(if y > 0.9 { 1.0 } else { 0.0 })
        } else {
            Some(2.0)
        }
    };
    let names = ["stable", "damped", "unstable"].map(str::to_owned).to_vec();
    let palette = Palette::Categories { names };
    let cells = Cells { x0: 0.0, x1: 3.0, nx, y0: 0.0, y1: 1.5, ny, values: (0..nx * ny).map(kind).collect(), palette };
    let limit = (0..100).map(|i| at(i, 100, 0.0, 1.5)).map(|y| [-y + (y * y + 4.0).sqrt(), y]).collect();
    let theory = Layer::Curve { name: "theory".to_owned(), points: limit, color: None };
    let title = "Stability of semi-implicit Euler with damping";
    let layers =
        vec![Layer::Cells(cells), theory, Layer::Guide { axis: AxisName::X, at: 2.0, label: "h ω = 2".to_owned() }];
    figure("stability", title, Axis::linear("h ω"), Axis::linear("damping ratio ζ"), layers)
}

fn coincident() -> Figure {
    let names = ["full, semi-implicit, with the gyroscopic term in the body frame", "momentum", "one step a period"];
    let mut layers: Vec<Layer> = (0..3)
        .map(|i| {
            let points = errors(2.0, if i < 2 { 1.0 } else { 1.02 }, 1e-14);
            let bend = |[h, e]: [f64; 2]| [h, if i == 2 && h > 0.01 { 30.0 * e } else { e }];
            Layer::Series(Series::new(names[i], i, points.into_iter().map(bend).collect()))
        })
        .collect();
    let theory = errors(2.0, 1.0, 0.0);
    layers.push(Layer::Curve { name: "theory".to_owned(), points: theory, color: None });
    let title = "Lines that lie on each other are all seen";
    figure("coincident", title, Axis::log("h (s)"), Axis::log("error (m)"), layers)
}

fn disc() -> Figure {
    let (nx, ny) = (120, 120);
    let at = |i: usize| -3.0 + 4.0 * (i as f64 + 0.5) / 120.0;
    let value = |i: usize| {
        let (x, y) = (at(i % nx) + 1.0, at(i / nx) + 1.0);
        Some(f64::from(u8::from(x.hypot(y) > 1.0)))
    };
    let palette = Palette::Categories { names: ["shrinks", "grows"].map(str::to_owned).to_vec() };
    let values = (0..nx * ny).map(value).collect();
    let cells = Cells { x0: -3.0, x1: 1.0, nx, y0: -2.0, y1: 2.0, ny, values, palette };
    let circle = (0..=100).map(|i| f64::from(i) * std::f64::consts::TAU / 100.0);
    let points = circle.map(|phi| [phi.cos() - 1.0, phi.sin()]).collect();
    let theory = Layer::Curve { name: "theory, |R| = 1".to_owned(), points, color: None };
    let [x, y] = ["Re h λ", "Im h λ"].map(Axis::linear);
    let title = "Where one step of explicit Euler shrinks y";
    Figure { equal_axes: true, ..figure("disc", title, x, y, vec![Layer::Cells(cells), theory]) }
}

fn radius() -> Figure {
    let (nx, ny) = (90, 60);
    let value = |i: usize| {
        let (x, y) = ((i % nx) as f64 / nx as f64, (i / nx) as f64 / ny as f64);
        Some(10_f64.powf(-6.0 * x * (1.0 - 0.5 * y)))
    };
    let palette = Palette::Sequential { label: "relative error of the energy".to_owned(), scale: Scale::Log };
    let cells =
        Cells { x0: 1e-3, x1: 10.0, nx, y0: 0.0, y1: 1.0, ny, values: (0..nx * ny).map(value).collect(), palette };
    figure(
        "radius",
        "A map on a logarithmic axis",
        Axis::log("h ω"),
        Axis::linear("eccentricity e"),
        vec![Layer::Cells(cells)],
    )
}

fn empty() -> Figure {
    let nothing = Series {
        failed: vec![0.1, 0.2],
        ..Series::new("explicit Euler", 0, vec![[1.0, f64::NAN], [f64::INFINITY, 2.0]])
    };
    figure("empty", "Every run failed", Axis::log("h (s)"), Axis::log("error (m)"), vec![Layer::Series(nothing)])
}

fn many() -> Figure {
    let one = |i: usize| Series::new(format!("variant {i} of the method"), i, errors(1.0 + 0.3 * i as f64, 1.0, 1e-14));
    let layers = (0..11).map(|i| Layer::Series(one(i))).collect();
    figure(
        "many",
        "More series than can be named beside their ends",
        Axis::log("h (s)"),
        Axis::log("error (m)").with_range(1e-10, 1e-1),
        layers,
    )
}
