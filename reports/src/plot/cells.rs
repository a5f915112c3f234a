//! Maps: cells of colour, and what the colours mean.

use super::axis::AxisMap;
use super::canvas::{Canvas, Drawn, GREY, INK, LEFT, Pixel, Rect, UNITS, palette, shorten, stroke, units, wrap};
use crate::{Axis, Cells, Palette, Scale};
use plotters::prelude::*;

/// Colour of a cell without a value: no other map colour is grey.
pub(super) const EMPTY: RGBColor = RGBColor(0xD9, 0xD9, 0xD9);
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

/// A colour between light (0) and dark (1).
fn sequential(fraction: f64) -> RGBColor {
    let place = fraction.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let first = (place as usize).min(STOPS.len() - 2);
    let part = place - first as f64;
    let [r, g, b] = [0, 1, 2].map(|i| (STOPS[first][i] * (1.0 - part) + STOPS[first + 1][i] * part).round() as u8);
    RGBColor(r, g, b)
}

/// Kinds are areas, not lines: the palette, lightened so that curves and words on it can be read.
pub(super) fn category(index: usize) -> RGBColor {
    let RGBColor(r, g, b) = palette([2, 5, 0, 1, 3, 6, 7, 4][index % 8]);
    let light = |c: u8| (f64::from(c) * 0.55 + 255.0 * 0.45).round() as u8;
    RGBColor(light(r), light(g), light(b))
}

/// The axis of the values: the ends of the colour scale.
fn value_axis(cells: &Cells, scale: Scale) -> Option<AxisMap> {
    let values: Vec<f64> = cells.values.iter().flatten().copied().collect();
    let axis = Axis { label: String::new(), scale, range: None };
    AxisMap::new(&axis, &[], &values).ok().filter(|(_, any)| *any).map(|(map, _)| map)
}

fn colors(cells: &Cells) -> Vec<RGBColor> {
    let axis = match &cells.palette {
        Palette::Sequential { scale, .. } => value_axis(cells, *scale),
        Palette::Categories { .. } => None,
    };
    let color = |value: f64| match (&cells.palette, &axis) {
        (Palette::Categories { .. }, _) => category(value as usize),
        (Palette::Sequential { .. }, Some(axis)) => {
            axis.map_value(value).map_or(EMPTY, |m| sequential((axis.fraction(m) * LEVELS).round() / LEVELS))
        }
        (Palette::Sequential { .. }, None) => EMPTY,
    };
    cells.values.iter().map(|value| value.map_or(EMPTY, color)).collect()
}

/// Edges of the cells on the sheet, cut at the frame.
fn edges(axis: &AxisMap, ends: [f64; 2], count: usize, place: impl Fn(f64) -> i32) -> Option<Vec<i32>> {
    let (first, last) = (axis.map_value(ends[0])?, axis.map_value(ends[1])?);
    let at = |i: usize| first + (last - first) * (i as f64 / count as f64);
    Some((0..=count).map(|i| place(at(i).clamp(axis.low, axis.high))).collect())
}

pub(super) fn draw(canvas: &Canvas<'_>, cells: &Cells) -> Drawn {
    let frame = &canvas.frame;
    let columns = edges(&frame.x, [cells.x0, cells.x1], cells.nx, |m| frame.column(m));
    let rows = edges(&frame.y, [cells.y0, cells.y1], cells.ny, |m| frame.row(m));
    let (Some(columns), Some(rows)) = (columns, rows) else { return Ok(()) };
    let colors = colors(cells);
    for j in (0..cells.ny).rev() {
        let row = &colors[j * cells.nx..(j + 1) * cells.nx];
        let mut start = 0;
        for end in 1..=cells.nx {
            if end < cells.nx && row[end] == row[start] {
                continue;
            }
            run(canvas, [columns[start], columns[end]], [rows[j + 1], rows[j]], row[start])?;
            start = end;
        }
    }
    Ok(())
}

/// One run of equal cells. It reaches a pixel under its right and lower neighbours, which are drawn later, so that
/// no light seam shows between them.
fn run(canvas: &Canvas<'_>, x: [i32; 2], y: [i32; 2], color: RGBColor) -> Drawn {
    let area = canvas.frame.area;
    let (left, right, top, bottom) = (x[0].min(x[1]), x[0].max(x[1]), y[0].min(y[1]), y[0].max(y[1]));
    if left == right || top == bottom {
        return Ok(());
    }
    let lap = units(1.0);
    let rect = Rect { left, top, right: (right + lap).min(area.right), bottom: (bottom + lap).min(area.bottom) };
    canvas.rect(rect, color.filled())
}

/// The legend of a map from `at` down, no wider than `width` CSS pixels; gives the unit where it ends.
pub(super) fn legend(canvas: &Canvas<'_>, cells: &Cells, (x, top): Pixel, width: f64) -> Result<i32, super::Refused> {
    let mut y = top;
    match &cells.palette {
        Palette::Categories { names } => {
            for (index, name) in names.iter().enumerate() {
                swatch(canvas, (x, y), category(index), name, width)?;
                y += units(20.0);
            }
        }
        Palette::Sequential { label, scale } => {
            for words in wrap(label, 12.5, width) {
                canvas.text(&words, (x, y), 12.5, INK, LEFT)?;
                y += units(16.0);
            }
            y = bar(canvas, value_axis(cells, *scale), (x, y))?;
        }
    }
    if cells.values.iter().any(Option::is_none) {
        swatch(canvas, (x, y), EMPTY, "no value", width)?;
        y += units(20.0);
    }
    Ok(y)
}

fn swatch(canvas: &Canvas<'_>, (x, y): Pixel, color: RGBColor, name: &str, width: f64) -> Drawn {
    let area = Rect { left: x, top: y - units(6.0), right: x + units(16.0), bottom: y + units(6.0) };
    canvas.rect(area, color.filled())?;
    canvas.rect(area, stroke(GREY, 0.5))?;
    canvas.text(&shorten(name, 12.5, width - 22.0), (x + units(22.0), y), 12.5, INK, LEFT)
}

fn bar(canvas: &Canvas<'_>, axis: Option<AxisMap>, (x, top): Pixel) -> Result<i32, super::Refused> {
    let Some(axis) = axis else { return Ok(top) };
    let axis = axis.with_ticks(7);
    let height = f64::from(canvas.frame.area.bottom - canvas.frame.area.top) / UNITS * 0.5;
    let (bottom, right) = (top + units(height), x + units(16.0));
    let row = |fraction: f64| bottom - units(height * fraction);
    for level in (0..=LEVELS as i32).rev() {
        let fraction = f64::from(level) / LEVELS;
        let (above, below) = ((fraction + 0.5 / LEVELS).min(1.0), (fraction - 0.5 / LEVELS).max(0.0));
        let area = Rect { left: x, top: row(above), right, bottom: (row(below) + units(0.5)).min(bottom) };
        canvas.rect(area, sequential(fraction).filled())?;
    }
    canvas.rect(Rect { left: x, top, right, bottom }, stroke(GREY, 0.5))?;
    for tick in &axis.major {
        let y = row(axis.fraction(tick.at));
        canvas.line(vec![(right, y), (right + units(4.0), y)], stroke(INK, 1.0))?;
        canvas.text(&tick.label, (right + units(7.0), y), 12.0, INK, LEFT)?;
    }
    Ok(bottom + units(20.0))
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
        let light = |RGBColor(r, g, b): RGBColor| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        let steps: Vec<f64> = (0..=48).map(|i| light(sequential(f64::from(i) / 48.0))).collect();
        assert!(steps.windows(2).all(|pair| pair[1] < pair[0]), "{steps:?}");
    }

    #[test]
    fn on_a_log_axis_cells_have_equal_ratios() {
        let axis = Axis::log("x").with_range(1.0, 100.0);
        let (map, _) = AxisMap::new(&axis, &[], &[]).expect("a proper range");
        let middle = edges(&map, [1.0, 100.0], 2, |m| (m * 1000.0).round() as i32);
        assert_eq!(middle, Some(vec![0, 1000, 2000]));
    }

    #[test]
    fn values_without_a_colour_are_grey_not_extreme() {
        let palette = Palette::Sequential { label: String::new(), scale: Scale::Log };
        let colors = colors(&cells(vec![Some(1.0), Some(10.0), Some(-1.0), None], palette));
        assert_eq!(colors, [sequential(0.0), sequential(1.0), EMPTY, EMPTY]);
    }
}
