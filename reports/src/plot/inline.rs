//! A drawing as it stands in a page: the same shapes in a fraction of the bytes, its colours left to the page's style.
//!
//! The stand-alone file says the colour, width and font of every shape, so that any program shows it. A page with a hundred
//! drawings says each once: here colours become classes (`s0` strokes and `f0` fills with the first colour of the palette),
//! neighbours of one look become one path with relative whole coordinates, and what lies on a white edge keeps it.

use super::canvas::{GREY, INK, PALETTE};
use super::cells;
use plotters::prelude::RGBColor;
use std::fmt::Write as _;

/// The drawing for a page; its title and description get ids that start with `id`.
pub(crate) fn inline(svg: &str, id: &str) -> String {
    let between = |open: &str, close: &str| {
        let rest = svg.split_once(open).map_or("", |(_, rest)| rest);
        rest.split_once('>').and_then(|(_, words)| words.split_once(close)).map_or("", |(words, _)| words)
    };
    let view = svg.split_once("viewBox=\"").and_then(|(_, rest)| rest.split_once('"')).map_or("", |(view, _)| view);
    let mut out = format!(
        "<svg class=chart viewBox=\"{view}\" role=img aria-labelledby=\"{id}-t {id}-d\"><title id={id}-t>{}</title><desc id={id}-d>{}</desc>",
        between("<title", "</title>"),
        between("<desc", "</desc>"),
    );
    let mut joined = Joined::default();
    let mut lines = svg.lines();
    while let Some(line) = lines.next() {
        if line.starts_with("<text") {
            joined.flush(&mut out);
            text(&mut out, &Element(line), lines.next().unwrap_or_default());
        } else if let Some((look, path)) = shape(&Element(line)) {
            joined.add(&mut out, look, &path);
        }
    }
    joined.flush(&mut out);
    out + "</svg>"
}

/// A tag as the drawing library writes it: one line, every value in double quotes.
struct Element<'a>(&'a str);

impl<'a> Element<'a> {
    fn get(&self, name: &str) -> Option<&'a str> {
        let start = self.0.find(&format!(" {name}=\""))? + name.len() + 3;
        self.0[start..].split('"').next()
    }

    fn number(&self, name: &str) -> f64 {
        self.get(name).and_then(|value| value.parse().ok()).unwrap_or(0.0)
    }

    fn unit(&self, name: &str) -> i32 {
        self.number(name).round() as i32
    }
}

/// Shapes of one look that follow each other, and the white edges below them: marks on a line come as edge, mark, edge, mark.
#[derive(Default)]
struct Joined {
    edge: Option<(String, String)>,
    top: Option<(String, String)>,
}

impl Joined {
    fn add(&mut self, out: &mut String, look: String, path: &str) {
        let is_edge = look.contains("sw") || look.contains("fw");
        let same = |place: &Option<(String, String)>| place.as_ref().is_none_or(|(known, _)| *known == look);
        let fits =
            if is_edge { same(&self.edge) && (self.edge.is_some() || self.top.is_none()) } else { same(&self.top) };
        if !fits {
            self.flush(out);
        }
        let place = if is_edge { &mut self.edge } else { &mut self.top };
        place.get_or_insert_with(|| (look, String::new())).1.push_str(path);
    }

    fn flush(&mut self, out: &mut String) {
        for (look, path) in self.edge.take().into_iter().chain(self.top.take()) {
            let _ = write!(out, "<path {look} d=\"{path}\"/>");
        }
    }
}

/// Attributes and outline of a shape; `None` for what is no shape, and for the sheet itself, which the page has.
fn shape(element: &Element<'_>) -> Option<(String, String)> {
    let tag = element.0.trim_start_matches('<').split(' ').next()?;
    let (x, y) = (element.unit("x"), element.unit("y"));
    let path = match tag {
        "line" => outline(&[["x1", "y1"], ["x2", "y2"]].map(|[x, y]| (element.unit(x), element.unit(y))), false),
        "polyline" => outline(&points(element), false),
        "polygon" => outline(&points(element), true),
        "rect" if (x, y) == (0, 0) => return None,
        "rect" => format!("M{x} {y}h{}v{}h{}z", element.unit("width"), element.unit("height"), -element.unit("width")),
        "circle" => return Some(circle(element)),
        _ => return None,
    };
    Some((look(element), path))
}

fn look(element: &Element<'_>) -> String {
    let color = |name: &str| element.get(name).filter(|&color| color != "none");
    let (fill, stroke) = (color("fill"), color("stroke"));
    let mut look = match (fill, stroke) {
        (_, Some(stroke)) => painted('s', "stroke", stroke),
        (fill, None) => painted('f', "fill", fill.unwrap_or("#000000")),
    };
    if let Some(opacity) = element.get("opacity") {
        let _ = write!(look, " opacity={opacity}");
    }
    if stroke.is_some() {
        let _ = write!(look, " stroke-width={}", element.unit("stroke-width").max(1));
    }
    if let Some(dashes) = element.get("stroke-dasharray") {
        let _ = write!(look, " stroke-dasharray=\"{dashes}\"");
    }
    look
}

/// A full circle is a line of no length with round ends, a ring is drawn as one.
fn circle(element: &Element<'_>) -> (String, String) {
    let (x, y, r) = (element.unit("cx"), element.unit("cy"), element.unit("r"));
    match element.get("fill").filter(|&fill| fill != "none") {
        Some(fill) => (
            format!("{} stroke-linecap=round stroke-width={}", painted('s', "stroke", fill), 2 * r),
            format!("M{x} {y}h0"),
        ),
        None => (look(element), format!("M{} {y}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 {} 0", x - r, 2 * r, -2 * r)),
    }
}

/// A colour as a class of the page's style, or as itself where the style has no name for it.
fn painted(kind: char, attribute: &str, color: &str) -> String {
    name(color).map_or_else(|| format!("class={kind}x {attribute}={color}"), |name| format!("class={kind}{name}"))
}

fn name(color: &str) -> Option<String> {
    let is = |known: RGBColor| color.eq_ignore_ascii_case(&hex(known));
    let palette = || (0..PALETTE.len()).find(|&i| is(PALETTE[i])).map(|i| i.to_string());
    let kind = || (0..PALETTE.len()).find(|&i| is(cells::category(i))).map(|i| format!("k{i}"));
    let fixed =
        [("i", INK), ("g", GREY), ("w", RGBColor(255, 255, 255)), ("b", RGBColor(0, 0, 0)), ("e", cells::EMPTY)];
    fixed.into_iter().find(|&(_, known)| is(known)).map(|(name, _)| name.to_owned()).or_else(palette).or_else(kind)
}

pub(super) fn hex(RGBColor(r, g, b): RGBColor) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

fn points(element: &Element<'_>) -> Vec<(i32, i32)> {
    let pair = |pair: &str| {
        let (x, y) = pair.split_once(',')?;
        Some((x.parse().ok()?, y.parse().ok()?))
    };
    element.get("points").unwrap_or_default().split_whitespace().filter_map(pair).collect()
}

/// A line through points, relative from the second on; points in a row on a straight upright or level line are one.
fn outline(points: &[(i32, i32)], closed: bool) -> String {
    let Some(&(x, y)) = points.first() else { return String::new() };
    let mut path = format!("M{x} {y}");
    let (mut at, mut last) = ((x, y), ' ');
    for &(x, y) in &points[1..] {
        let (dx, dy) = (x - at.0, y - at.1);
        at = (x, y);
        let command = match (dx, dy) {
            (0, 0) => continue,
            (_, 0) => 'h',
            (0, _) => 'v',
            _ => 'l',
        };
        let values: &[i32] = if command == 'l' {
            &[dx, dy]
        } else if command == 'h' {
            &[dx]
        } else {
            &[dy]
        };
        if command != last {
            path.push(command);
        }
        for (i, value) in values.iter().enumerate() {
            let gap = if *value >= 0 && (i > 0 || command == last) { " " } else { "" };
            let _ = write!(path, "{gap}{value}");
        }
        last = command;
    }
    if closed {
        path.push('z');
    }
    path
}

/// Words with their base line worked out: what half an `ex` is depends on the font, and no two programs agree.
fn text(out: &mut String, element: &Element<'_>, words: &str) {
    let size = element.number("font-size");
    let down = match element.get("dy") {
        Some("0.5ex") => 0.36,
        Some("-0.5ex") => -0.27,
        Some("0.76em") => 0.76,
        Some("1ex") => 0.55,
        _ => 0.0,
    } * size;
    let turned = element.get("transform").is_some();
    let (x, y) = (element.unit("x"), element.unit("y"));
    let anchor = match element.get("text-anchor") {
        Some("middle") => " m",
        Some("end") => " e",
        _ => "",
    };
    let class = name(element.get("fill").unwrap_or_default()).unwrap_or_default();
    let place = if turned {
        format!("y={} transform=\"translate({x} {y})rotate(-90)\"", down.round())
    } else {
        format!("x={x} y={}", y + down.round() as i32)
    };
    let _ = write!(out, "<text class=\"f{class}{anchor}\" font-size={} {place}>{words}</text>", size.round());
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every point of a path of M, l, h, v and z in absolute units.
    fn places(path: &str) -> Vec<(i32, i32)> {
        let mut places = Vec::new();
        let mut at = (0, 0);
        for part in
            path.trim_end_matches('z').split_inclusive(|c: char| c.is_ascii_alphabetic()).collect::<Vec<_>>().windows(2)
        {
            let command = part[0].chars().last().expect("a command");
            let numbers = part[1].trim_end_matches(|c: char| c.is_ascii_alphabetic()).replace('-', " -");
            let numbers: Vec<i32> = numbers.split_whitespace().map(|n| n.parse().expect("a number")).collect();
            for step in numbers.chunks(if matches!(command, 'h' | 'v') { 1 } else { 2 }) {
                at = match command {
                    'M' => (step[0], step[1]),
                    'h' => (at.0 + step[0], at.1),
                    'v' => (at.0, at.1 + step[0]),
                    _ => (at.0 + step[0], at.1 + step[1]),
                };
                places.push(at);
            }
        }
        places
    }

    #[test]
    fn a_shortened_line_goes_through_the_same_points() {
        let points = [(5, 7), (5, -3), (12, -3), (12, 4), (-8, -9), (0, 0), (3, -2), (3, -20)];
        assert_eq!(places(&outline(&points, false)), points);
        assert_eq!(places(&outline(&points, true)), points);
        assert!(outline(&points, true).ends_with('z') && outline(&[], false).is_empty());
    }

    #[test]
    fn marks_on_white_edges_are_two_paths_whatever_their_number() {
        let mark = |x: i32| {
            format!(
                "<circle cx=\"{x}\" cy=\"5\" r=\"17\" fill=\"#FFFFFF\"/>\n<circle cx=\"{x}\" cy=\"5\" r=\"14\" fill=\"#0072B2\"/>\n"
            )
        };
        let svg = format!(
            "<svg viewBox=\"0 0 9 9\">\n<title id=\"a\">T</title>\n<desc id=\"b\">D</desc>\n{}</svg>",
            (0..4).map(mark).collect::<String>()
        );
        let drawn = inline(&svg, "x");
        assert_eq!(drawn.matches("<path").count(), 2, "{drawn}");
        assert!(
            drawn.contains("class=sw stroke-linecap=round stroke-width=34") && drawn.contains("class=s1"),
            "{drawn}"
        );
        assert!(drawn.contains("<title id=x-t>T</title><desc id=x-d>D</desc>"), "{drawn}");
        assert!(drawn.contains("d=\"M0 5h0M1 5h0M2 5h0M3 5h0\""), "{drawn}");
    }
}
