//! Stacked bars of times.

use crate::lab::LabError;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A bar.
#[derive(Clone, Debug)]
pub struct Bar {
    /// What it is.
    pub label: String,
    /// Names and ms, from left to right.
    pub parts: Vec<(String, f64)>,
}

const FONT: &str = "sans-serif";
const WIDTH: i32 = 1100;
const ROW: i32 = 22;
/// Pixels for labels, and the characters that fit.
const LEFT: i32 = 400;
const LABEL: usize = 60;
const RIGHT: i32 = 70;

/// Colours of stages in the order in which they come, told apart by people who see red and green alike (Okabe and Ito).
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

/// All names of some bars' parts, in the order in which they come.
pub fn names(bars: &[Bar]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in bars.iter().flat_map(|b| &b.parts) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}

/// Horizontal bars, one below the other, on one scale, as SVG.
///
/// # Errors
/// Drawing into memory gives none, whatever the data.
pub fn bars(title: &str, bars: &[Bar]) -> Result<String, LabError> {
    let mut svg = String::new();
    draw(&mut svg, title, bars).map_err(|e| LabError::Request(format!("cannot draw '{title}': {e}")))?;
    Ok(svg)
}

fn draw(svg: &mut String, title: &str, bars: &[Bar]) -> Result<(), Box<dyn std::error::Error>> {
    let names = names(bars);
    // The legend stands in rows of four.
    let legend = i32::try_from(names.len().div_ceil(4))? * ROW;
    let top = 44 + legend;
    let height = top + i32::try_from(bars.len())? * ROW + 40;
    let area = SVGBackend::with_string(svg, (WIDTH.unsigned_abs(), height.unsigned_abs())).into_drawing_area();
    area.fill(&WHITE)?;
    area.draw(&Text::new(title.to_string(), (12, 12), (FONT, 20)))?;
    for (i, name) in names.iter().enumerate() {
        let (column, row) = (i32::try_from(i % 4)?, i32::try_from(i / 4)?);
        let at = (12 + column * 260, 42 + row * ROW);
        area.draw(&Rectangle::new([at, (at.0 + 12, at.1 + 12)], color(i).filled()))?;
        area.draw(&Text::new((*name).to_string(), (at.0 + 18, at.1), (FONT, 15)))?;
    }
    let most = bars.iter().map(total).fold(0.0, f64::max).max(1e-9);
    let scale = f64::from(WIDTH - LEFT - RIGHT) / most;
    let bottom = height - 40;
    ticks(&area, most, scale, (top, bottom))?;
    for (y, bar) in (0i32..).map(|i| top + i * ROW).zip(bars) {
        let right = Pos::new(HPos::Right, VPos::Center);
        area.draw(&Text::new(cut(&bar.label), (LEFT - 8, y + ROW / 2), (FONT, 14).into_text_style(&area).pos(right)))?;
        let mut from = 0.0;
        for (name, ms) in &bar.parts {
            let i = names.iter().position(|n| n == name).unwrap_or(0);
            let x = |v: f64| LEFT + (v * scale).round() as i32;
            area.draw(&Rectangle::new([(x(from), y + 3), (x(from + ms), y + ROW - 3)], color(i).filled()))?;
            from += ms;
        }
        let end = LEFT + (from * scale).round() as i32 + 6;
        let left = Pos::new(HPos::Left, VPos::Center);
        area.draw(&Text::new(format!("{from:.3}"), (end, y + ROW / 2), (FONT, 14).into_text_style(&area).pos(left)))?;
    }
    area.present()?;
    Ok(())
}

fn ticks(area: &Area, most: f64, scale: f64, (top, bottom): (i32, i32)) -> Result<(), Box<dyn std::error::Error>> {
    let rough = most / 6.0;
    let decade = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|f| f * decade).into_iter().find(|s| *s >= rough).unwrap_or(rough);
    let mut value = 0.0;
    while value <= most {
        let x = LEFT + (value * scale).round() as i32;
        area.draw(&PathElement::new([(x, top), (x, bottom)], RGBColor(220, 220, 220)))?;
        let centre = Pos::new(HPos::Center, VPos::Top);
        let digits = usize::try_from((-decade.log10().floor()).max(0.0) as i64)?;
        let style = (FONT, 14).into_text_style(area).pos(centre);
        area.draw(&Text::new(format!("{value:.digits$} ms"), (x, bottom + 6), style))?;
        value += step;
    }
    Ok(())
}

fn total(bar: &Bar) -> f64 {
    bar.parts.iter().map(|p| p.1).sum()
}

fn color(i: usize) -> RGBColor {
    COLORS[i % COLORS.len()]
}

fn cut(label: &str) -> String {
    if label.chars().count() <= LABEL {
        label.to_string()
    } else {
        label.chars().take(LABEL - 1).chain(['…']).collect()
    }
}
