//! Colours and line styles: the one list that stand-alone drawings and pages share.
//!
//! A drawing names looks by class (`line s0`), never by colour. A stand-alone file brings the rules with plain colours, and
//! dark ones under `prefers-color-scheme`, so that programs without CSS variables show it too; a page brings them as variables
//! that follow its theme.

use std::fmt::Write as _;

/// Number of colours of the palette.
pub(super) const COLORS: usize = 8;

/// Name, colour by day, colour by night.
///
/// `c0` to `c7`: Okabe and Ito, "Color Universal Design" (2008), told apart with any colour vision; its yellow, too light for
/// a line on white, is replaced by a dark purple, its orange, pink and sky blue are darkened for the same reason.
/// `k0` to `k7`: the same for areas, lightened so that curves and words on them can be read.
const THEME: [(&str, &str, &str); 20] = [
    ("ground", "#ffffff", "#14171a"),
    ("ink", "#1b1d20", "#e8eaec"),
    ("soft", "#51565d", "#b3bac1"),
    ("empty", "#d9d9d9", "#33383d"),
    ("c0", "#d55e00", "#ff8a3d"),
    ("c1", "#0072b2", "#4fb0f0"),
    ("c2", "#009e73", "#2fcf9f"),
    ("c3", "#c76fa0", "#ec9cc8"),
    ("c4", "#1a1a1a", "#f2f2f2"),
    ("c5", "#b88600", "#e0b02a"),
    ("c6", "#2e97cc", "#8ad0f5"),
    ("c7", "#6a3d9a", "#b78ce6"),
    ("k0", "#73cab2", "#0b5a47"),
    ("k1", "#d8bc73", "#665012"),
    ("k2", "#e8a673", "#7a3d0c"),
    ("k3", "#73b1d5", "#0c4a70"),
    ("k4", "#e0b0cb", "#6f3c59"),
    ("k5", "#8cc6e3", "#1f5f80"),
    ("k6", "#ad94c7", "#523a73"),
    ("k7", "#818181", "#6a7077"),
];

/// Widths, dashes and opacities, in CSS pixels.
const SHAPES: &str = "\
.major{stroke-width:.5;stroke-opacity:.15}.minor{stroke-width:.5;stroke-opacity:.06}.axis{stroke-width:1}\
.line{stroke-width:1.8}.dashed{stroke-dasharray:8 4}.dotted{stroke-dasharray:2 3}.mixed{stroke-dasharray:8 3 2 3}\
.over1{stroke-dasharray:6 6}.over2{stroke-dasharray:6 12}.over3{stroke-dasharray:6 18}\
.curve{stroke-width:1.4;stroke-dasharray:6 5}.halo{stroke-width:4;stroke-opacity:.75}\
.guide{stroke-width:1.1;stroke-dasharray:2 3}.whisker{stroke-width:1.2}.leader{stroke-width:.6;stroke-opacity:.7}\
.mark{stroke-width:1.6;paint-order:stroke}.failed{stroke-width:1.4}.thin{stroke-width:.5}.edge{stroke-width:.75;stroke-opacity:.6}\
.band{fill-opacity:.09}.floor{fill-opacity:.13}.veil{fill-opacity:.82}";

/// The class of a line in a palette colour; indices beyond the palette start again.
pub(super) fn stroke(color: usize) -> String {
    format!("s{}", color % COLORS)
}

/// The class of a mark filled with a palette colour.
pub(super) fn fill(color: usize) -> String {
    format!("f{}", color % COLORS)
}

/// The class of the area of a kind.
pub(super) fn area(kind: usize) -> String {
    format!("k{}", kind % COLORS)
}

/// The rules that say what colour a class has; `color` gives the value of a name of the theme.
fn rules(color: impl Fn(&str) -> String) -> String {
    let mut css = String::new();
    let mut rule = |classes: &str, property: &str, name: &str| {
        let _ = write!(css, "{classes}{{{property}:{}}}", color(name));
    };
    for i in 0..COLORS {
        rule(&format!(".s{i}"), "stroke", &format!("c{i}"));
        rule(&format!(".f{i}"), "fill", &format!("c{i}"));
        rule(&format!(".k{i}"), "fill", &format!("k{i}"));
    }
    rule(".si,.axis,.major,.minor", "stroke", "ink");
    rule(".sg", "stroke", "soft");
    rule(".fi", "fill", "ink");
    rule(".fg,.floor", "fill", "soft");
    rule(".band", "fill", "c1");
    rule(".empty", "fill", "empty");
    rule(".ground,.veil,.failed", "fill", "ground");
    rule(".halo,.mark", "stroke", "ground");
    css
}

/// The style of a stand-alone drawing.
pub(super) fn of_file() -> String {
    let value =
        |name: &str| THEME.iter().find(|(known, ..)| *known == name).map_or(("", ""), |&(_, day, night)| (day, night));
    let (day, night) = (rules(|name| value(name).0.to_owned()), rules(|name| value(name).1.to_owned()));
    format!("{SHAPES}{day}@media(prefers-color-scheme:dark){{{night}}}")
}

/// The style of all drawings of a page, and the variables that they share with it.
pub(crate) fn of_page() -> String {
    let variables: String =
        THEME.iter().map(|(name, day, night)| format!("--{name}:light-dark({day},{night});")).collect();
    format!(":root{{{variables}}}{SHAPES}{}", rules(|name| format!("var(--{name})")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_has_a_colour_and_areas_are_light_shades_of_the_palette() {
        assert!(!of_file().contains(":}") && !of_file().contains("var("), "{}", of_file());
        let channel = |hex: &str, i: usize| f64::from(u8::from_str_radix(&hex[1 + 2 * i..3 + 2 * i], 16).expect("hex"));
        let day = |name: String| THEME.iter().find(|(known, ..)| *known == name).expect("in the theme").1;
        for (kind, of) in [2, 5, 0, 1, 3, 6, 7, 4].into_iter().enumerate() {
            for i in 0..3 {
                let light = 0.55 * channel(day(format!("c{of}")), i) + 0.45 * 255.0;
                assert!((light - channel(day(format!("k{kind}")), i)).abs() <= 0.5, "k{kind}");
            }
        }
    }
}
