//! Charts as SVG.

use crate::diagnostics::excerpt::cut;
use crate::lab::LabError;
use crate::results::table::short;
use indexmap::IndexSet;
use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;

/// Colours in the order of use. They differ for people with red-green colour blindness (Okabe and
/// Ito).
pub const COLORS: [RGBColor; 10] = [
    RGBColor(0, 114, 178),
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(213, 94, 0),
    RGBColor(240, 228, 66),
    RGBColor(110, 110, 110),
    RGBColor(150, 100, 50),
    RGBColor(180, 180, 180),
];
/// Colour of lines for comparison.
const GREY: RGBColor = RGBColor(120, 120, 120);
/// Font of all texts.
pub const FONT: &str = "sans-serif";
/// Width of bars with their labels, pixels; of the labels alone, and the characters that fit.
const WIDTH: i32 = 1100;
const LEFT: i32 = 400;
const LABEL: usize = 60;
/// Right of the longest bar, pixels.
const RIGHT: i32 = 70;
/// Height of a bar, or of a line of a legend, pixels.
const ROW: i32 = 22;
/// Size of a chart of lines, pixels, and the part of its width that is no legend.
const LINES: (u32, u32) = (900, 420);
const PLOT: u32 = 680;

/// Drawing area of a chart.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Axes that are drawn on.
pub type Plane<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;
/// Error of the drawing library.
pub type Failure = Box<dyn std::error::Error>;

/// A chart of this size, pixels.
pub fn drawn(
    title: &str,
    size: (u32, u32),
    draw: impl FnOnce(&Area) -> Result<(), Failure>,
) -> Result<String, LabError> {
    let mut svg = String::new();
    let whole = |area: &Area| {
        area.fill(&WHITE)?;
        draw(area)?;
        Ok(area.present()?)
    };
    whole(&SVGBackend::with_string(&mut svg, size).into_drawing_area()).map_err(|e: Failure| {
        LabError::Make {
            what: format!("the chart '{title}'"),
            why: e.to_string(),
        }
    })?;
    Ok(svg)
}

/// The name as a file name.
pub fn file_name(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect()
}

/// Style of a text of this size, pixels.
pub fn text(size: i32, h: HPos, v: VPos) -> TextStyle<'static> {
    TextStyle::from((FONT, size)).pos(Pos::new(h, v))
}

/// An axis, linear or logarithmic.
#[derive(Clone)]
pub struct Axis {
    title: String,
    log: bool,
    range: (f64, f64),
    marks: Vec<f64>,
}

impl Axis {
    /// Axis with equal distances.
    pub fn linear(title: &str, range: (f64, f64)) -> Axis {
        Axis {
            title: title.into(),
            log: false,
            range,
            marks: steps(range),
        }
    }

    /// Axis with equal ratios. Both ends must be above 0.
    pub fn log(title: &str, range: (f64, f64)) -> Axis {
        Axis {
            title: format!("{title} (log)"),
            log: true,
            range,
            marks: ticks(range),
        }
    }

    /// Writes these numbers to the axis.
    pub fn marked(self, marks: Vec<f64>) -> Axis {
        Axis { marks, ..self }
    }
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    /// Values below a logarithmic axis are clamped to its end.
    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let (low, high) = self.range;
        let part = match self.log {
            true => (value.max(low) / low).ln() / (high / low).ln(),
            false => (value - low) / (high - low),
        };
        limit.0 + (f64::from(limit.1 - limit.0) * part).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() {
            Vec::new()
        } else {
            self.marks.clone()
        }
    }

    fn range(&self) -> Range<f64> {
        self.range.0..self.range.1
    }
}

/// Round numbers at equal distances in a range, about six at most.
fn steps((low, high): (f64, f64)) -> Vec<f64> {
    let rough = (high - low) / 5.0;
    let decade = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|s| s * decade)
        .into_iter()
        .find(|s| *s >= rough)
        .unwrap_or(rough);
    let first = (low / step).ceil();
    (0..=6)
        .map(|i| step * (first + f64::from(i)))
        .filter(|v| *v <= high)
        .collect()
}

/// Round numbers of a logarithmic axis, 2 to about 12. Where a range is too short for four at about
/// equal ratios, they are at equal distances.
pub fn ticks((low, high): (f64, f64)) -> Vec<f64> {
    let inside = |digits: &[f64]| -> Vec<f64> {
        let decades = (low.log10().floor() as i32)..=(high.log10().ceil() as i32);
        let all = decades.flat_map(|e| digits.iter().map(move |s| s * 10f64.powi(e)));
        all.filter(|v| (low..=high).contains(v)).collect()
    };
    let sets: [&[f64]; 3] = [&[1.0], &[1.0, 3.0], &[1.0, 2.0, 3.0, 5.0, 7.0]];
    sets.iter()
        .map(|s| inside(s))
        .find(|t| t.len() >= 4)
        .unwrap_or_else(|| steps((low, high)))
}

/// Axes with their titles and numbers.
pub fn plane<'a, 'b>(
    area: &'a Area<'b>,
    title: &str,
    x: &Axis,
    y: &Axis,
) -> Result<Plane<'a, 'b>, Failure> {
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .caption(title, (FONT, 18))
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(x.clone(), y.clone())?;
    chart
        .configure_mesh()
        .x_desc(&x.title)
        .y_desc(&y.title)
        .x_label_formatter(&|v| short(*v))
        .y_label_formatter(&|v| short(*v))
        .axis_desc_style((FONT, 15))
        .label_style((FONT, 13))
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 225, 225))
        .draw()?;
    Ok(chart)
}

/// A line of a chart.
pub struct Line {
    pub name: String,
    /// Points from left to right.
    pub points: Vec<(f64, f64)>,
    /// Whether the line is for comparison: thin and grey.
    pub grey: bool,
}

/// Lines with their names on the right.
pub fn lines(title: &str, x: &Axis, y: &Axis, lines: &[Line]) -> Result<String, LabError> {
    drawn(title, LINES, |area| {
        let (plot, legend) = area.split_horizontally(PLOT);
        let mut chart = plane(&plot, title, x, y)?;
        for (i, Line { name, points, grey }) in lines.iter().enumerate() {
            let color = if *grey { GREY } else { color(i) };
            let style = color.stroke_width(if *grey { 1 } else { 2 });
            chart.draw_series([PathElement::new(points.clone(), style)])?;
            chart.draw_series(points.iter().map(|p| Circle::new(*p, 2, color.filled())))?;
            let y = 50 + ROW * i32::try_from(i)?;
            legend.draw(&Rectangle::new([(4, y), (16, y + 4)], color.filled()))?;
            legend.draw(&Text::new(
                cut(name, 30),
                (22, y + 2),
                text(13, HPos::Left, VPos::Center),
            ))?;
        }
        Ok(())
    })
}

#[derive(Clone, Debug)]
pub struct Bar {
    pub label: String,
    /// Names and lengths, from left to right.
    pub parts: Vec<(String, f64)>,
    /// Whether the value is within the noise; only the outline is drawn.
    pub hollow: bool,
}

impl Bar {
    fn length(&self) -> f64 {
        self.parts.iter().map(|p| p.1).sum()
    }
}

/// Horizontal bars on one scale, with a legend above them. The scale has a `unit`; `shown` formats
/// the numbers of the bars.
pub fn bars(
    title: &str,
    unit: &str,
    shown: fn(f64) -> String,
    bars: &[Bar],
) -> Result<String, LabError> {
    let names: IndexSet<&str> = bars
        .iter()
        .flat_map(|b| &b.parts)
        .map(|p| p.0.as_str())
        .collect();
    let pixels = |rows: usize| ROW.saturating_mul(i32::try_from(rows).unwrap_or(i32::MAX));
    let top = 44 + pixels(names.len().div_ceil(4));
    let bottom = top.saturating_add(pixels(bars.len()));
    let size = (
        WIDTH.unsigned_abs(),
        bottom.saturating_add(40).unsigned_abs(),
    );
    drawn(title, size, |area| {
        area.draw(&Text::new(title.to_string(), (12, 12), (FONT, 20)))?;
        legend(area, &names)?;
        let most = bars.iter().map(Bar::length).fold(0.0, f64::max).max(1e-9);
        let x = |v: f64| LEFT + (v * f64::from(WIDTH - LEFT - RIGHT) / most).round() as i32;
        for value in steps((0.0, most)) {
            area.draw(&PathElement::new(
                [(x(value), top), (x(value), bottom)],
                RGBColor(220, 220, 220),
            ))?;
            let number = format!("{}{unit}", short(value));
            let style = text(14, HPos::Center, VPos::Top);
            area.draw(&Text::new(number, (x(value), bottom + 6), style))?;
        }
        for (y, bar) in (0i32..).map(|i| top + i * ROW).zip(bars) {
            let (label, style) = (cut(&bar.label, LABEL), text(14, HPos::Right, VPos::Center));
            area.draw(&Text::new(label, (LEFT - 8, y + ROW / 2), style))?;
            let mut from = 0.0;
            for (name, length) in &bar.parts {
                let color = color(names.get_index_of(name.as_str()).unwrap_or(0));
                let style = match bar.hollow {
                    true => color.stroke_width(1),
                    false => color.filled(),
                };
                let corners = [(x(from), y + 3), (x(from + length), y + ROW - 3)];
                area.draw(&Rectangle::new(corners, style))?;
                from += length;
            }
            let number = text(14, HPos::Left, VPos::Center);
            area.draw(&Text::new(shown(from), (x(from) + 6, y + ROW / 2), number))?;
        }
        Ok(())
    })
}

/// Four names per row below the title, with their colours.
fn legend(area: &Area, names: &IndexSet<&str>) -> Result<(), Failure> {
    for (i, name) in names.iter().enumerate() {
        let at = (
            12 + i32::try_from(i % 4)? * 260,
            42 + i32::try_from(i / 4)? * ROW,
        );
        let square = [at, (at.0 + 12, at.1 + 12)];
        area.draw(&Rectangle::new(square, color(i).filled()))?;
        let name = (*name).to_string();
        area.draw(&Text::new(name, (at.0 + 18, at.1), (FONT, 15)))?;
    }
    Ok(())
}

/// Colour of the entry with this index.
pub fn color(i: usize) -> RGBColor {
    COLORS[i % COLORS.len()]
}

/// A colour as charts write it.
pub fn hex(c: RGBColor) -> String {
    format!("#{:02X}{:02X}{:02X}", c.0, c.1, c.2)
}

#[cfg(test)]
mod tests {
    use super::ticks;

    #[test]
    fn logarithmic_axes_have_a_few_marks_apart_from_each_other() {
        for (low, ratio) in (0..60).flat_map(|i| (1..80).map(move |k| (i, k))) {
            let low = 0.003 * 1.13f64.powi(low);
            let ratio = 1.08f64.powi(ratio); // up to 470
            let marks = ticks((low, low * ratio));
            assert!(
                (2..=12).contains(&marks.len()),
                "{low} to {}: {marks:?}",
                low * ratio
            );
            // As a part of the axis.
            let part = |a: f64, b: f64| (b / a).ln() / ratio.ln();
            let least = marks.windows(2).map(|m| part(m[0], m[1])).reduce(f64::min);
            assert!(
                least.is_some_and(|l| l > 0.04),
                "{low} to {}: {marks:?}",
                low * ratio
            );
        }
    }
}
