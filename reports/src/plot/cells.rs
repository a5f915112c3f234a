//! Maps: cells of colour, and what the colours mean.

use super::axis::AxisMap;
use super::backend::{STYLE, rectangle};
use super::frame::{Frame, Mapped};
use super::sheet::{Anchor, Pixel, Rect, Sheet};
use super::style::area;
use super::text::wrap;
use crate::{Axis, Cells, Palette, Scale};
use plotters::element::Rectangle;
use std::collections::BTreeMap;

/// The look of a cell without a value: no other map colour is grey.
const EMPTY: &str = "class=\"empty\"";
/// From light to dark with even steps of lightness and one direction of hue (yellow, green, blue).
const STOPS: [[f64; 3]; 6] = [
    [255.0, 247.0, 188.0],
    [186.0, 222.0, 145.0],
    [104.0, 190.0, 140.0],
    [40.0, 145.0, 150.0],
    [38.0, 90.0, 140.0],
    [35.0, 35.0, 95.0],
];
/// Steps of the sequential palette; finer ones cannot be told apart and only make the file larger.
const LEVELS: f64 = 48.0;
/// Size of the words of a legend, and from one line to the next.
const SIZE: f64 = 12.5;
const STEP: f64 = 20.0;

/// What is wrong with a map, if anything.
pub(super) fn check(cells: &Cells) -> Result<(), String> {
    let wanted = cells.nx * cells.ny;
    if wanted == 0 || cells.values.len() != wanted {
        return Err(format!("{} values for {} by {} cells", cells.values.len(), cells.nx, cells.ny));
    }
    if let Palette::Categories { names } = &cells.palette {
        let kind = |v: f64| v >= 0.0 && v.fract() == 0.0 && v < names.len() as f64;
        if let Some(bad) = cells.values.iter().flatten().find(|v| !kind(**v)) {
            return Err(format!(
                "value {bad} names none of the {} kinds (0 to {})",
                names.len(),
                names.len().max(1) - 1
            ));
        }
    }
    Ok(())
}

/// A colour between light (0) and dark (1): red, green, blue.
fn sequential(fraction: f64) -> [u8; 3] {
    let place = fraction.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let first = (place as usize).min(STOPS.len() - 2);
    let part = place - first as f64;
    [0, 1, 2].map(|i| (STOPS[first][i] * (1.0 - part) + STOPS[first + 1][i] * part).round() as u8)
}

/// The look of a value, as an attribute.
fn level(fraction: f64) -> String {
    let [r, g, b] = sequential((fraction * LEVELS).round() / LEVELS);
    format!("fill=\"#{r:02x}{g:02x}{b:02x}\"")
}

fn kind(index: usize) -> String {
    format!("class=\"{}\"", area(index))
}

/// The axis of the values: the ends of the colour scale.
fn value_axis(cells: &Cells, scale: Scale) -> Option<AxisMap> {
    let values: Vec<f64> = cells.values.iter().flatten().copied().collect();
    let axis = Axis { label: String::new(), scale, range: None };
    AxisMap::new(&axis, &[], &values).ok().filter(|(_, any)| *any).map(|(map, _)| map)
}

fn looks(cells: &Cells) -> Vec<String> {
    let axis = match &cells.palette {
        Palette::Sequential { scale, .. } => value_axis(cells, *scale),
        Palette::Categories { .. } => None,
    };
    let look = |value: f64| match &cells.palette {
        Palette::Categories { .. } => Some(kind(value as usize)),
        Palette::Sequential { .. } => axis.as_ref().and_then(|axis| Some(level(axis.fraction(axis.map_value(value)?)))),
    };
    cells.values.iter().map(|value| value.and_then(look).unwrap_or_else(|| EMPTY.to_owned())).collect()
}

/// Edges of the cells in mapped coordinates, cut at the frame.
fn edges(axis: &AxisMap, ends: [f64; 2], count: usize) -> Option<Vec<f64>> {
    let (first, last) = (axis.map_value(ends[0])?, axis.map_value(ends[1])?);
    // Each end has its share, since the difference of two huge ends would be infinite.
    let at = |i: usize| first * (1.0 - i as f64 / count as f64) + last * (i as f64 / count as f64);
    Some((0..=count).map(|i| at(i).clamp(axis.low, axis.high)).collect())
}

/// Runs of equal cells, all those of one look as one path.
pub(super) fn draw(sheet: &mut Sheet, frame: &Frame, cells: &Cells) {
    let columns = edges(&frame.x, [cells.x0, cells.x1], cells.nx);
    let rows = edges(&frame.y, [cells.y0, cells.y1], cells.ny);
    let (Some(columns), Some(rows)) = (columns, rows) else { return };
    let looks = looks(cells);
    let mut areas: BTreeMap<&str, Vec<Rectangle<Mapped>>> = BTreeMap::new();
    for (j, row) in looks.chunks(cells.nx).enumerate() {
        let mut start = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let end = start + run.len();
            if columns[start] != columns[end] && rows[j] != rows[j + 1] {
                let area = Rectangle::new([(columns[start], rows[j]), (columns[end], rows[j + 1])], STYLE);
                areas.entry(&run[0]).or_default().push(area);
            }
            start = end;
        }
    }
    for (look, areas) in &areas {
        sheet.tiles(look, |area| {
            let inside = frame.inside(area);
            areas.iter().try_for_each(|cell| inside.draw(cell))
        });
    }
}

/// The legend of a map from `at` down, no wider than `width` CSS pixels, beside a frame of that height; gives where it ends.
pub(super) fn legend(sheet: &mut Sheet, cells: &Cells, (x, top): Pixel, width: f64, height: f64) -> f64 {
    let mut y = top;
    match &cells.palette {
        Palette::Categories { names } => {
            for (index, name) in names.iter().enumerate() {
                y = swatch(sheet, (x, y), &kind(index), name, width);
            }
        }
        Palette::Sequential { label, scale } => {
            y = sheet.paragraph(label, (x, y), SIZE, width);
            y = value_axis(cells, *scale).map_or(y, |axis| bar(sheet, &axis.with_ticks(7), (x, y), 0.5 * height));
        }
    }
    if cells.values.iter().any(Option::is_none) {
        y = swatch(sheet, (x, y), EMPTY, "no value", width);
    }
    y
}

fn swatch(sheet: &mut Sheet, (x, y): Pixel, look: &str, name: &str, width: f64) -> f64 {
    let rect = Rect { left: x, top: y - 6.0, right: x + 16.0, bottom: y + 6.0 };
    sheet.tiles(look, |area| area.draw(&rectangle(rect)));
    sheet.rect("thin sg", rect);
    let lines = wrap(name, SIZE, width - 22.0).len();
    sheet.paragraph(name, (x + 22.0, y), SIZE, width - 22.0) + if lines > 0 { STEP - 1.3 * SIZE } else { STEP }
}

fn bar(sheet: &mut Sheet, axis: &AxisMap, (x, top): Pixel, height: f64) -> f64 {
    let (bottom, right) = (top + height, x + 16.0);
    let row = |fraction: f64| bottom - height * fraction;
    for step in 0..=LEVELS as i32 {
        let fraction = f64::from(step) / LEVELS;
        let (above, below) = ((fraction + 0.5 / LEVELS).min(1.0), (fraction - 0.5 / LEVELS).max(0.0));
        let rect = Rect { left: x, top: row(above), right, bottom: row(below) };
        sheet.tiles(&level(fraction), |area| area.draw(&rectangle(rect)));
    }
    sheet.rect("thin sg", Rect { left: x, top, right, bottom });
    for tick in &axis.major {
        let y = row(axis.fraction(tick.at));
        sheet.line("axis", &[(right, y), (right + 4.0, y)]);
        sheet.text("fi", &tick.label, (right + 7.0, y), 12.0, Anchor::Start);
    }
    bottom + STEP
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(values: Vec<Option<f64>>, palette: Palette) -> Cells {
        Cells { x0: 0.0, x1: 1.0, nx: 2, y0: 0.0, y1: 1.0, ny: 2, values, palette }
    }

    fn kinds() -> Palette {
        Palette::Categories { names: vec!["stable".to_owned(), "unstable".to_owned()] }
    }

    #[test]
    fn a_map_with_too_few_values_or_an_unknown_kind_is_refused() {
        assert!(check(&cells(vec![Some(0.0); 4], kinds())).is_ok());
        assert!(check(&cells(vec![Some(0.0); 3], kinds())).is_err());
        for bad in [2.0, -1.0, 0.5, f64::NAN] {
            assert!(check(&cells(vec![Some(bad); 4], kinds())).is_err(), "{bad}");
        }
    }

    #[test]
    fn the_sequential_palette_darkens_all_the_way() {
        let light = |[r, g, b]: [u8; 3]| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        let steps: Vec<f64> = (0..=48).map(|i| light(sequential(f64::from(i) / 48.0))).collect();
        assert!(steps.windows(2).all(|pair| pair[1] < pair[0]), "{steps:?}");
    }

    #[test]
    fn on_a_log_axis_cells_have_equal_ratios() {
        let axis = Axis::log("x").with_range(1.0, 100.0);
        let (map, _) = AxisMap::new(&axis, &[], &[]).expect("a proper range");
        assert_eq!(edges(&map, [1.0, 100.0], 2), Some(vec![0.0, 1.0, 2.0]));
    }

    #[test]
    fn values_without_a_colour_are_grey_not_extreme() {
        let palette = Palette::Sequential { label: String::new(), scale: Scale::Log };
        let looks = looks(&cells(vec![Some(1.0), Some(10.0), Some(-1.0), None], palette));
        assert_eq!(looks, [level(0.0), level(1.0), EMPTY.to_owned(), EMPTY.to_owned()]);
    }
}
