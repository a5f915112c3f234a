//! Maps and pictures.

use integrator::methods::MethodId;
use reports::{Axis, AxisName, Cells, Figure, Layer, Line, Marker, Palette, Scale, Series};

use super::failure::Failure;
use super::maps::{self, Grid};
use super::models::{Scheme, modulus, stability_function};
use super::spin::{FACTOR_TOLERANCE, SpinScheme, blow_up_bound};
use super::{Part, Row};
use crate::study::distinct;

pub(super) fn all(rows: &[Row]) -> Vec<Figure> {
    let pictures = rows.iter().filter(|row| row.part == Part::Picture);
    let pictured = distinct(pictures.map(|row| row.scene.as_str()));
    let of = |part: Part, figures: Vec<Option<Figure>>| {
        let data = format!("stability.{}.csv", part.id());
        figures.into_iter().flatten().map(|figure| Figure { data: data.clone(), ..figure }).collect::<Vec<_>>()
    };
    [
        of(Part::DampedMap, Scheme::ALL.into_iter().map(|scheme| damped(rows, scheme)).collect()),
        of(Part::Region, maps::ONE_STEP.into_iter().map(|method| region(rows, method)).collect()),
        of(Part::SpinMap, SpinScheme::ALL.into_iter().map(|scheme| spin(rows, scheme)).collect()),
        of(Part::KeplerMap, maps::ORBITING.into_iter().map(|method| kepler(rows, method)).collect()),
        of(Part::PendulumAmplitude, vec![pendulum(rows)]),
        of(Part::Picture, pictured.into_iter().map(|id| picture(rows, id)).collect()),
    ]
    .concat()
}

fn chosen<'a>(rows: &'a [Row], part: Part, method: &str) -> Option<Vec<&'a Row>> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.part == part && row.method == method).collect();
    (!rows.is_empty()).then_some(rows)
}

fn cells(rows: &[&Row], full: Grid, palette: Palette, value: impl Fn(&Row) -> Option<f64>) -> Cells {
    let grid = if rows.len() == full.nx * full.ny { full } else { full.coarse() };
    let values = rows.iter().map(|row| value(row)).collect();
    Cells { x0: grid.x[0], x1: grid.x[1], nx: grid.nx, y0: grid.y[0], y1: grid.y[1], ny: grid.ny, values, palette }
}

fn kinds(names: &[&str]) -> Palette {
    Palette::Categories { names: names.iter().map(|&name| name.to_owned()).collect() }
}

fn figure(id: &str, title: String, caption: &str, x: Axis, y: Axis, layers: Vec<Layer>, scene: &str) -> Figure {
    Figure {
        id: format!("stability-{}", id.replace('/', "-")),
        title,
        caption: caption.to_owned(),
        x,
        y,
        layers,
        scene: Some(scene.to_owned()),
        ..Figure::default()
    }
}

fn curve(name: &str, points: Vec<[f64; 2]>) -> Layer {
    Layer::Curve { name: name.to_owned(), points, color: None }
}

fn damped(rows: &[Row], scheme: Scheme) -> Option<Figure> {
    let rows = chosen(rows, Part::DampedMap, scheme.id())?;
    let map = cells(&rows, maps::DAMPED, kinds(&["bounded", "grows without bound"]), |row| Some(1.0 - row.measured?));
    let zetas = (0..=300).map(|i| f64::from(i) * maps::DAMPED.y[1] / 300.0);
    let points: Vec<[f64; 2]> = zetas.map(|zeta| [scheme.limit(zeta), zeta]).filter(|[h, _]| h.is_finite()).collect();
    let mut layers = vec![Layer::Cells(map)];
    if !points.is_empty() {
        layers.push(curve("theory", points));
    }
    let caption = match scheme {
        Scheme::Listed(MethodId::ExplicitEuler) => {
            "Without damping no step is stable: the curve starts at zero, and damping alone opens room for a step."
        }
        Scheme::Listed(MethodId::SemiImplicitEuler) => {
            "Damping taken explicitly makes it worse: the more damping, the smaller the largest step."
        }
        Scheme::ImplicitDamping => {
            "One division turns the tables: with implicit damping more damping allows a larger step."
        }
        Scheme::Listed(MethodId::ImplicitEuler) => {
            "Bounded everywhere: no step is too large to be stable, only to be right."
        }
        Scheme::Listed(_) => "The boundary measured on running oscillators follows theory's curve cell by cell.",
    };
    let x = Axis::linear("step, h ω").with_range(maps::DAMPED.x[0], maps::DAMPED.x[1]);
    let y = Axis::linear("damping ratio ζ").with_range(maps::DAMPED.y[0], maps::DAMPED.y[1]);
    let title = format!("Damped oscillator: {}", scheme.title());
    Some(figure(&format!("map-damped-{}", scheme.id()), title, caption, x, y, layers, "damped-oscillator"))
}

fn region(rows: &[Row], method: MethodId) -> Option<Figure> {
    let rows = chosen(rows, Part::Region, method.id())?;
    let map = cells(&rows, maps::REGION, kinds(&["shrinks", "grows"]), |row| {
        // No number stands for a pole.
        Some(f64::from(u8::from(row.measured.is_none_or(|r| r > 1.0))))
    });
    let layers = vec![Layer::Cells(map), curve("theory, |R| = 1", region_boundary(method))];
    let caption = match method {
        MethodId::ExplicitEuler => "A disc that only touches the imaginary axis: every undamped oscillation grows.",
        MethodId::Rk4 => "The region takes in the imaginary axis up to 2.83 and the real axis down to -2.79.",
        MethodId::ImplicitEuler => "Everything outside one disc shrinks, even what should grow.",
        _ => "The left half-plane exactly: what should decay decays, what should grow grows.",
    };
    let [left, right] = maps::REGION.x;
    let [low, high] = maps::REGION.y;
    let x = Axis::linear("Re h λ").with_range(left, right);
    let y = Axis::linear("Im h λ").with_range(low, high);
    let title = format!("y' = λ y: where one step of {} shrinks y", method.title());
    let figure = figure(&format!("region-{}", method.id()), title, caption, x, y, layers, "oscillator");
    Some(Figure { equal_axes: true, ..figure })
}

/// The curve |R(z)| = 1 from z = 0: along it R = e^(i phi), z follows by Newton's iteration from the last point.
fn region_boundary(method: MethodId) -> Vec<[f64; 2]> {
    let turns = if method == MethodId::Rk4 { 4.0 } else { 1.0 };
    let steps = 720;
    let mut z = (0.0, 0.0);
    let mut points = vec![[0.0, 0.0]];
    for i in 1..=steps {
        // The midpoint rule maps the circle to the whole imaginary axis: stop before infinity.
        let phi = turns * std::f64::consts::TAU * f64::from(i) / f64::from(steps);
        for _ in 0..20 {
            z = newton_step(method, z, phi);
        }
        if modulus(z) > 30.0 {
            break;
        }
        points.push([z.0, z.1]);
    }
    if method == MethodId::ImplicitMidpoint {
        let mirrored: Vec<[f64; 2]> = points.iter().rev().map(|[x, y]| [*x, -*y]).collect();
        points.splice(0..0, mirrored);
    }
    points
}

/// One Newton step towards R(z) = e^(i phi), with the derivative by a central difference along the real direction.
fn newton_step(method: MethodId, z: (f64, f64), phi: f64) -> (f64, f64) {
    let d = 1e-6;
    let r = stability_function(method, z);
    let (ahead, back) = (stability_function(method, (z.0 + d, z.1)), stability_function(method, (z.0 - d, z.1)));
    let slope = ((ahead.0 - back.0) / (2.0 * d), (ahead.1 - back.1) / (2.0 * d));
    let miss = (r.0 - phi.cos(), r.1 - phi.sin());
    let n = slope.0 * slope.0 + slope.1 * slope.1;
    (z.0 - (miss.0 * slope.0 + miss.1 * slope.1) / n, z.1 - (miss.1 * slope.0 - miss.0 * slope.1) / n)
}

fn spin(rows: &[Row], scheme: SpinScheme) -> Option<Figure> {
    let rows = chosen(rows, Part::SpinMap, scheme.id())?;
    let kind = |row: &Row| {
        let factor = row.measured?;
        let excess = factor - 1.0;
        Some(if excess.abs() <= FACTOR_TOLERANCE {
            1.0
        } else if excess > 0.0 {
            2.0
        } else {
            0.0
        })
    };
    let map = cells(&rows, maps::SPIN, kinds(&["nutation dies out", "nutation is kept", "nutation grows"]), kind);
    let mut layers = vec![Layer::Cells(map)];
    let thetas: Vec<f64> = (1..=200).map(|i| f64::from(i) * std::f64::consts::PI / 200.0).collect();
    match scheme {
        SpinScheme::WorldExplicit => {
            let points = thetas.iter().map(|&t| [t, 1.0 - 2.0 * t.sin() / t]).filter(|[_, rho]| *rho >= 0.0).collect();
            layers.push(curve("theory: 1 - 2 sin(x) / x", points));
        }
        SpinScheme::BodyRk4 => {
            let limit = 8.0_f64.sqrt();
            layers.push(curve(
                "theory: sqrt(8)",
                thetas.iter().map(|&t| [t, 1.0 - limit / t]).filter(|p| p[1] >= 0.0).collect(),
            ));
        }
        _ => {}
    }
    layers.push(Layer::Guide { axis: AxisName::Y, at: 1.0, label: "sphere".to_owned() });
    let caption = match scheme {
        SpinScheme::BodySemiImplicit | SpinScheme::WorldSemiImplicit => {
            "The nutation of every body but a sphere grows at every step: semi-implicit Euler conserves nothing here."
        }
        SpinScheme::WorldExplicit => {
            "Only the attitude moves with the old ω, and a different map results: the nutation of a rod dies out, that of a disc grows."
        }
        SpinScheme::Momentum => "The nutation of a disc (above the line) grows, that of a rod (below) dies out.",
        SpinScheme::BodyImplicit => "The nutation of every body dies out, whether or not it should.",
        SpinScheme::BodyRk4 => {
            "The nutation dies out slowly, and grows only for long rods at steps of nearly half a turn."
        }
        SpinScheme::BodyMidpoint => "The nutation of every body is kept at every step.",
    };
    let x = Axis::linear("spin in one step, h ω₃ (rad)").with_range(maps::SPIN.x[0], maps::SPIN.x[1]);
    let y = Axis::linear("ratio of inertia I₃ / I₁").with_range(maps::SPIN.y[0], maps::SPIN.y[1]);
    let title = format!("Spinning body: {}", scheme.title().replace("omega", "ω"));
    Some(figure(&format!("map-spin-{}", scheme.id()), title, caption, x, y, layers, "torque-free-spin"))
}

fn kepler(rows: &[Row], method: MethodId) -> Option<Figure> {
    let rows = chosen(rows, Part::KeplerMap, method.id())?;
    let palette = Palette::Sequential { label: "orbits until the energy is half wrong".to_owned(), scale: Scale::Log };
    let map = cells(&rows, maps::KEPLER, palette, |row| row.measured);
    let grid = Cells { x0: map.x0.exp2(), x1: map.x1.exp2(), ..map };
    let eccentricities = (0..=200).map(|i| f64::from(i) * maps::KEPLER.y[1] / 200.0);
    // h (angular velocity of a circle through the pericentre) = the limit on the oscillator.
    let (limit, label) = if method == MethodId::Rk4 {
        (8.0_f64.sqrt(), "h ω = √8 at the pericentre")
    } else {
        (2.0, "h ω = 2 at the pericentre")
    };
    let points = eccentricities.map(|e| [limit * (1.0 - e).powf(1.5) / std::f64::consts::TAU, e]).collect();
    let layers = vec![Layer::Cells(grid), curve(label, points)];
    let x = Axis::log("step over period").with_range(maps::KEPLER.x[0].exp2(), maps::KEPLER.x[1].exp2());
    let y = Axis::linear("eccentricity").with_range(maps::KEPLER.y[0], maps::KEPLER.y[1]);
    let title = format!("Kepler: how many orbits {} survives", method.title());
    let caption = if method == MethodId::Rk4 {
        "The pericentre sets the step. RK4 loses energy there long before its limit of stability (dashed): the orbit shrinks."
    } else {
        "The pericentre sets the step: near the curve not one orbit survives, and the more eccentric, the smaller the step."
    };
    Some(figure(&format!("map-kepler-{}", method.id()), title, caption, x, y, layers, "kepler"))
}

fn pendulum(rows: &[Row]) -> Option<Figure> {
    let rows = chosen(rows, Part::PendulumAmplitude, "semi-implicit-euler")?;
    let points = rows.iter().filter_map(|row| Some([row.value?, row.low?])).collect();
    let series = Series::new("first step that fails", 1, points);
    let guide = Layer::Guide { axis: AxisName::Y, at: 2.0, label: "linear theory: 2".to_owned() };
    let caption =
        "Linear theory promises 2 at any amplitude; a pendulum that swings widely goes over the top much earlier.";
    let title = "Pendulum: the largest step falls with the amplitude".to_owned();
    let x = Axis::linear("amplitude (rad)").with_range(0.0, 3.2);
    let y = Axis::linear("largest h ω").with_range(0.0, 2.4);
    Some(figure("pendulum-amplitude", title, caption, x, y, vec![Layer::Series(series), guide], "pendulum"))
}

/// Title, sentence, scene, label of the vertical axis, whether it is logarithmic.
fn about(id: &str) -> Option<(&'static str, &'static str, &'static str, &'static str, bool)> {
    Some(match id {
        "exponential-growth" => (
            "Exponential growth: a straight line on a logarithmic axis",
            "Just below h ω = 2 Verlet's error stays bounded, just above it grows by the same factor in every step.",
            "oscillator",
            "largest displacement so far (m)",
            true,
        ),
        "finite-time-blow-up" => (
            "Blow-up in finite time: steeper and steeper",
            "The faster the body turns, the faster it gains: the curves turn upright at a finite time, halving the step only doubles it.",
            "torque-free-spin",
            "angular velocity (rad/s)",
            true,
        ),
        "wrong-frequency" => (
            "Bounded but wrong: too slow",
            "The amplitude is kept exactly and the dots never fail, but they swing at 0.72 of the true frequency.",
            "oscillator",
            "displacement (m)",
            false,
        ),
        "flipped-axis" => (
            "Bounded but wrong: a disc turned over",
            "A disc of 60 rad/s at 60 steps a second should keep its axis (cosine 1); explicit Euler tips it over within a fifth of a second, and it tumbles on.",
            "torque-free-spin",
            "cosine between axis and its start (1)",
            false,
        ),
        "aliasing" => (
            "Bounded but wrong: a fast force seen as a constant one",
            "One step a period sees the oscillating force always at its crest, and settles where a constant force would push it.",
            "forced-oscillator",
            "displacement (m)",
            false,
        ),
        "oscillating-decay" => (
            "A decay that oscillates: 1 < k h < 2",
            "Beyond k h = 1 drag turns the motion round in every step; it still dies out up to k h = 2, and grows beyond.",
            "linear-drag",
            "velocity (m/s)",
            false,
        ),
        "newton-not-converging" => (
            "Newton's iteration finds no solution",
            "With a step of many swings the equations of a step have many solutions, and the iteration wanders between them: the run ends.",
            "pendulum",
            "angular velocity (rad/s)",
            false,
        ),
        "order-lost" => (
            "Order lost: a kink in the force",
            "RK4 keeps order four on the way down; through the apex, where v |v| has a kink, the error falls more slowly and by jumps.",
            "quadratic-drag",
            "position error (m)",
            true,
        ),
        "drift" => (
            "Drift: the energy changes for good while |L| is kept",
            "|L| is kept to rounding and nothing looks wrong, while the body slowly turns to another axis and its energy moves with it.",
            "torque-free-spin",
            "kinetic energy over its start (1)",
            false,
        ),
        _ => return None,
    })
}

fn picture(rows: &[Row], id: &str) -> Option<Figure> {
    let (title, caption, scene, label, logarithmic) = about(id)?;
    let of: Vec<&Row> = rows.iter().filter(|row| row.part == Part::Picture && row.scene == id).collect();
    let mut layers = Vec::new();
    for (i, name) in distinct(of.iter().map(|row| row.method.as_str())).into_iter().enumerate() {
        let run: Vec<&&Row> = of.iter().filter(|row| row.method == name).collect();
        let points: Vec<[f64; 2]> = run.iter().filter_map(|row| Some([row.value?, row.measured?])).collect();
        // Where the run ends before its time, the reader must see that it does.
        let ends = |row: &&&Row| matches!(row.failure, Failure::NewtonNotConverging | Failure::FiniteTimeBlowUp);
        let failed = points.last().filter(|_| run.iter().any(ends)).map(|[t, _]| *t).into_iter().collect();
        layers.push(if name == "exact" {
            // A series, so that the axis makes room for it.
            Layer::Series(Series { marker: None, line: Some(Line::Dashed), ..Series::new("exact", 7, points) })
        } else {
            let marker = (points.len() <= 64).then(|| Marker::of_color(i));
            let words = name.replace("omega", "ω").replace("zeta", "ζ");
            Layer::Series(Series { marker, failed, ..Series::new(words, i, points) })
        });
    }
    if id == "finite-time-blow-up" {
        for n in [64.0, 128.0, 256.0] {
            let label = format!("not before, h = 1/{n} s");
            layers.push(Layer::Guide { axis: AxisName::X, at: blow_up_bound(1.0 / n), label });
        }
    }
    let y = if logarithmic { Axis::log(label) } else { Axis::linear(label) };
    let x = match id {
        "order-lost" => Axis::log("step (s)"),
        "finite-time-blow-up" => Axis::log("time (s)"),
        _ => Axis::linear("time (s)"),
    };
    let y = if id == "exponential-growth" { y.with_range(0.5, 1e6) } else { y };
    Some(figure(id, title.to_owned(), caption, x, y, layers, scene))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_boundary_of_every_region_lies_on_the_unit_circle() {
        for method in maps::ONE_STEP {
            for [x, y] in region_boundary(method) {
                let r = modulus(stability_function(method, (x, y)));
                assert!((r - 1.0).abs() < 1e-9, "{} at {x} + {y} i: |R| = {r}", method.id());
            }
        }
    }
}
