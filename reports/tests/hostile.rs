//! Figures of any numbers whatever: no panic, no hang, a proper document.

use proptest::prelude::*;
use reports::{Axis, AxisName, Cells, Figure, Layer, Line, Marker, Palette, Scale, Series, svg};

/// Doubles of every kind: any bits, the ends of the range, and neighbours of one.
fn number() -> impl Strategy<Value = f64> {
    let special = [
        0.0,
        -0.0,
        5e-324,
        -5e-324,
        1e-323,
        f64::MIN_POSITIVE,
        f64::MAX,
        f64::MIN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        1.0,
        1.0 + f64::EPSILON,
        -1.0,
        1e-300,
        1e300,
    ];
    prop_oneof![
        3 => proptest::sample::select(special.to_vec()),
        2 => any::<u64>().prop_map(f64::from_bits),
        1 => -10.0..10.0,
    ]
}

fn axis() -> impl Strategy<Value = Axis> {
    let range = proptest::option::weighted(0.3, [number(), number()]);
    (any::<bool>(), range).prop_map(|(log, range)| Axis {
        label: "x (m)".to_owned(),
        scale: if log { Scale::Log } else { Scale::Linear },
        range,
    })
}

fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
    prop_oneof![
        proptest::collection::vec([number(), number()], 0..12),
        // All equal, and all on a line.
        (number(), number(), 1_usize..6).prop_map(|(x, y, n)| vec![[x, y]; n]),
        (number(), 1_usize..6).prop_map(|(y, n)| (0..n).map(|i| [i as f64, y]).collect()),
    ]
}

fn series() -> impl Strategy<Value = Layer> {
    let line = proptest::sample::select(vec![None, Some(Line::Solid), Some(Line::Dashed), Some(Line::Dotted)]);
    let marker = proptest::option::of(proptest::sample::select(Marker::ALL.to_vec()));
    let looks = (".{0,40}", 0_usize..20, line, marker);
    (points(), looks, proptest::collection::vec(number(), 0..4), number()).prop_map(
        |(points, (name, color, line, marker), failed, whisker)| {
            let whiskers = points.iter().map(|[_, y]| [y - whisker, y + whisker]).collect();
            Layer::Series(Series { name, points, color, marker, line, failed, whiskers })
        },
    )
}

fn cells() -> impl Strategy<Value = Layer> {
    let ends = [number(), number(), number(), number()];
    (ends, 1_usize..5, 1_usize..5, any::<bool>(), any::<bool>())
        .prop_flat_map(|(ends, nx, ny, log, kinds)| {
            let value =
                proptest::option::of(if kinds { (0_u8..3).prop_map(f64::from).boxed() } else { number().boxed() });
            (Just((ends, nx, ny, log, kinds)), proptest::collection::vec(value, nx * ny))
        })
        .prop_map(|(([x0, x1, y0, y1], nx, ny, log, kinds), values)| {
            let scale = if log { Scale::Log } else { Scale::Linear };
            let palette = if kinds {
                Palette::Categories { names: ["a", "b", "c"].map(str::to_owned).to_vec() }
            } else {
                Palette::Sequential { label: "what it means".to_owned(), scale }
            };
            Layer::Cells(Cells { x0, x1, nx, y0, y1, ny, values, palette })
        })
}

fn layer() -> impl Strategy<Value = Layer> {
    let name = || proptest::sample::select(vec![AxisName::X, AxisName::Y]);
    let words = || ".{0,60}";
    prop_oneof![
        4 => series(),
        1 => cells(),
        1 => number().prop_map(|order| Layer::SlopeTriangle { order }),
        1 => (number(), words()).prop_map(|(y, label)| Layer::Floor { y, label }),
        1 => (name(), number(), words()).prop_map(|(axis, at, label)| Layer::Guide { axis, at, label }),
        1 => (name(), number(), number(), words())
            .prop_map(|(axis, from, to, label)| Layer::Band { axis, from, to, label }),
        1 => (words(), points(), proptest::option::of(0_usize..20))
            .prop_map(|(name, points, color)| Layer::Curve { name, points, color }),
        1 => (number(), number(), words()).prop_map(|(x, y, text)| Layer::Text { at: [x, y], text }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    // Fails if: a tick, a place or a length is taken from a number that has none, or a letter stands that XML cannot carry.
    #[test]
    fn any_numbers_give_a_proper_document_or_an_error_with_its_place(
        (x, y) in (axis(), axis()),
        layers in proptest::collection::vec(layer(), 0..5),
        (title, width, height) in (".{0,80}", 200_u32..900, 200_u32..700),
        equal in proptest::bool::weighted(0.2),
    ) {
        let equal_axes = equal && x.scale == Scale::Linear && y.scale == Scale::Linear;
        let figure = Figure { id: "any".to_owned(), title, x, y, layers, width, height, equal_axes, ..Figure::default() };
        match svg(&figure) {
            Ok(text) => {
                let document = roxmltree::Document::parse(&text);
                prop_assert!(document.is_ok(), "{document:?}\n{text}");
                let (_, body) = text.split_once("</style>").expect("a style");
                let numbers = ["NaN", "inf", "e+", "922337203685477"];
                let attributes = body.split('"').skip(1).step_by(2);
                for value in attributes.filter(|value| !value.contains(|c: char| c.is_ascii_lowercase() && !"hvlaz".contains(c))) {
                    prop_assert!(!numbers.iter().any(|bad| value.contains(bad)), "{value}");
                }
                prop_assert!(text.len() < 400_000, "{} bytes", text.len());
            }
            Err(error) => prop_assert!(error.to_string().contains("range"), "{error}"),
        }
    }
}
