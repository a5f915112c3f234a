//! Charts as PNG: the size, the text, the same bytes each time. `cargo test --release -p reports --features png`
#![cfg(feature = "png")]

use reports::{Axis, Figure, Layer, Series};
use resvg::tiny_skia::Pixmap;

fn figure() -> Figure {
    let series = Series::new("RK4", 0, vec![[0.1, 1e-3], [0.01, 1e-7]]);
    Figure {
        id: "sample".to_owned(),
        title: "Order of RK4".to_owned(),
        x: Axis::log("step size h (s)"),
        y: Axis::log("error (m)"),
        layers: vec![Layer::Series(series)],
        ..Figure::default()
    }
}

fn drawn(figure: &Figure) -> (Vec<u8>, Pixmap) {
    let svg = reports::svg(figure).expect("it can be drawn");
    let bytes = reports::png(&svg, &figure.id).expect("it can be drawn");
    let pixels = Pixmap::decode_png(&bytes).expect("it is a PNG");
    (bytes, pixels)
}

/// Pixels darker than half in the rows `from..to` of the picture.
fn dark(pixels: &Pixmap, from: u32, to: u32) -> usize {
    let rows = (from * pixels.width()) as usize..(to * pixels.width()) as usize;
    pixels.pixels()[rows].iter().filter(|p| p.red() < 128 && p.green() < 128 && p.blue() < 128).count()
}

// Fails if: the scale is left out, or drawing depends on anything but the figure.
#[test]
fn a_png_has_two_pixels_for_each_of_the_svg_and_the_same_bytes_each_time() {
    let (bytes, pixels) = drawn(&figure());
    assert_eq!((pixels.width(), pixels.height()), (2 * 800, 2 * 560));
    assert!(bytes == drawn(&figure()).0);
}

// Fails if: the embedded font is not found under the name that the drawing uses; a missing font leaves text out silently.
#[test]
fn text_is_drawn_with_the_embedded_font() {
    // A title of one dot leaves all else where it is.
    let dot = Figure { title: ".".to_owned(), ..figure() };
    let title_rows = |figure: &Figure| dark(&drawn(figure).1, 0, 70);
    // Ten letters, about 24 pixels high, each with a stroke at least two pixels wide over most of its height.
    let (dot, title) = (title_rows(&dot), title_rows(&figure()));
    assert!(title > dot + 10 * 24, "{dot} {title}");
}

#[test]
fn what_is_no_drawing_is_refused_by_name() {
    let error = reports::png("<svg", "broken").expect_err("not an SVG");
    assert!(error.to_string().contains("'broken'"), "{error}");
}

// Fails if: the rules of the drawing's style are not read, or those for a dark ground are taken.
#[test]
fn colours_are_those_of_the_style_by_day() {
    let pixels = drawn(&figure()).1;
    let count = |wanted: [u8; 3]| pixels.pixels().iter().filter(|p| [p.red(), p.green(), p.blue()] == wanted).count();
    // A line across most of the chart, at least two pixels wide, in the first colour; the white ground around it.
    let (line, ground) = (count([0xd5, 0x5e, 0x00]), count([255, 255, 255]));
    assert!(line > 1000 && ground > pixels.pixels().len() / 2, "{line} {ground}");
}
