//! Charts of a suite, SVG.

use super::record::{PartResult, Record, Report};
use crate::campaign::report::{COLORS, short};
use crate::lab::LabError;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const FONT: &str = "sans-serif";
const LINES: (u32, u32) = (900, 420);
const WIDTH: i32 = 900;
const LEFT: i32 = 360;
const ROW: i32 = 20;
/// Lines that are no method: grey.
const NOISE: &str = "noise of the reference";
const REFERENCE: &str = "reference";

/// A chart.
pub(super) struct Chart {
    /// File name without its ending.
    pub name: String,
    /// The case that it belongs to; none is for the whole suite.
    pub case: Option<String>,
    /// The chart.
    pub svg: String,
}

/// Bars over everything: part, name, title, value.
type Bar = (&'static str, &'static str, &'static str, fn(&PartResult) -> Option<f64>);
const BARS: [Bar; 4] = [
    ("total", "all E_t", "E_t of the total, radiance", |p| p.e),
    ("diffuse", "all E_t of diffuse", "E_t of diffuse light, radiance", |p| p.e),
    ("diffuse", "all flicker of diffuse", "Flicker index of diffuse light, mean over pixels", |p| {
        p.flicker.filter(|_| p.frames.len() > 1).map(|f| f.mean)
    }),
    ("total", "all relMSE", "relMSE of the total, last frame", |p| p.scores.as_ref().map(|s| s.relmse)),
];

type Failure = Box<dyn std::error::Error>;

/// Over the frames of each case E_t, after a switch or a cut the error, for a switched light its response; bars over
/// everything.
pub(super) fn charts(report: &Report) -> Result<Vec<Chart>, LabError> {
    let mut out = Vec::new();
    let mut add = |name: &str, case: Option<&str>, drawn: Result<Option<String>, Failure>| {
        let drawn = drawn.map_err(|e| LabError::Request(format!("cannot draw '{name}': {e}")))?;
        let plain = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' });
        out.extend(drawn.map(|svg| Chart { name: plain.collect(), case: case.map(String::from), svg }));
        Ok::<(), LabError>(())
    };
    for (part, name, title, value) in BARS {
        let row = |r: &Record| {
            let part = r.measured()?.parts.get(part)?;
            let noisy = title.starts_with("E_t") && part.told_apart == Some(false);
            Some((r.title(), r.method.clone(), value(part)?, noisy))
        };
        let list: Vec<_> = report.results.iter().filter_map(row).collect();
        add(name, None, bars_of(title, &list))?;
    }
    let mut cases: Vec<String> = report.results.iter().map(Record::title).collect();
    cases.dedup();
    for case in &cases {
        let of = || report.results.iter().filter(|r| r.title() == *case);
        let frames = |value: &dyn Fn(&super::FrameScore) -> Option<f64>, part: &str| {
            let line = |r: &Record| {
                let part = r.measured()?.parts.get(part)?;
                let points: Vec<(f64, f64)> =
                    part.frames.iter().filter_map(|f| Some((f.frame as f64, value(f)?))).collect();
                (points.len() > 1).then(|| (r.method.clone(), points))
            };
            of().filter_map(line).collect::<Vec<_>>()
        };
        for part in ["total", "diffuse"] {
            let mut lines = frames(&|f| f.change.map(|c| c.rms), part);
            let noise = frames(&|f| f.noise, part).into_iter().next();
            lines.extend(noise.map(|(_, points)| (NOISE.to_string(), points)));
            let title = format!("{case}: E_t of {part}");
            add(&format!("{case} E_t of {part}"), Some(case), lines_of(&title, "radiance", &lines))?;
        }
        if of().any(|r| r.measured().is_some_and(|m| m.event.is_some())) {
            let title = format!("{case}: relMSE of diffuse light");
            let lines = frames(&|f| f.relmse, "diffuse");
            add(&format!("{case} error"), Some(case), lines_of(&title, "relMSE", &lines))?;
        }
        if of().any(|r| r.measured().is_some_and(|m| m.parts.values().any(|p| p.step.is_some()))) {
            let mut lines = frames(&|f| f.mean, "diffuse");
            let reference = frames(&|f| f.reference_mean, "diffuse").into_iter().next();
            lines.extend(reference.map(|(_, points)| (REFERENCE.to_string(), points)));
            let title = format!("{case}: mean luminance of diffuse light");
            add(&format!("{case} response"), Some(case), lines_of(&title, "radiance", &lines))?;
        }
    }
    Ok(out)
}

fn color(i: usize) -> RGBColor {
    COLORS[i % COLORS.len()]
}

/// Values over frames.
fn lines_of(title: &str, unit: &str, lines: &[(String, Vec<(f64, f64)>)]) -> Result<Option<String>, Failure> {
    let points = || lines.iter().flat_map(|l| &l.1);
    let most = points().map(|p| p.1).fold(0.0, f64::max);
    if lines.is_empty() || most <= 0.0 {
        return Ok(None);
    }
    let (first, last) = points().fold((f64::INFINITY, 0.0f64), |(a, b), p| (a.min(p.0), b.max(p.0)));
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, LINES).into_drawing_area();
        area.fill(&WHITE)?;
        let (plot, legend) = area.split_horizontally(680);
        let mut chart = ChartBuilder::on(&plot)
            .margin(12)
            .caption(title, (FONT, 18))
            .x_label_area_size(40)
            .y_label_area_size(76)
            .build_cartesian_2d(first..last.max(first + 1.0), 0.0..most * 1.08)?;
        chart
            .configure_mesh()
            .x_desc("frame")
            .y_desc(unit)
            .x_label_formatter(&|v| format!("{v:.0}"))
            .y_label_formatter(&|v| short(*v))
            .axis_desc_style((FONT, 15))
            .label_style((FONT, 13))
            .light_line_style(WHITE)
            .bold_line_style(RGBColor(225, 225, 225))
            .draw()?;
        for (i, (name, points)) in lines.iter().enumerate() {
            let reference = name == NOISE || name == REFERENCE;
            let color = if reference { RGBColor(120, 120, 120) } else { color(i) };
            let style = color.stroke_width(if reference { 1 } else { 2 });
            chart.draw_series(std::iter::once(PathElement::new(points.clone(), style)))?;
            chart.draw_series(points.iter().map(|p| Circle::new(*p, 2, color.filled())))?;
            let y = 50 + ROW * i32::try_from(i)?;
            legend.draw(&Rectangle::new([(4, y), (16, y + 4)], color.filled()))?;
            legend.draw(&Text::new(name.chars().take(30).collect::<String>(), (22, y - 5), (FONT, 13)))?;
        }
        area.present()?;
    }
    Ok(Some(svg))
}

/// Bars of (case, method, value, hollow), one below the other, on a linear scale.
fn bars_of(title: &str, list: &[(String, String, f64, bool)]) -> Result<Option<String>, Failure> {
    let most = list.iter().map(|l| l.2).filter(|v| v.is_finite()).fold(0.0, f64::max);
    if list.is_empty() || most <= 0.0 {
        return Ok(None);
    }
    let mut methods: Vec<&str> = Vec::new();
    for (_, method, ..) in list {
        if !methods.contains(&method.as_str()) {
            methods.push(method);
        }
    }
    let height = 50 + ROW * i32::try_from(list.len())?;
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (WIDTH.unsigned_abs(), height.unsigned_abs())).into_drawing_area();
        area.fill(&WHITE)?;
        area.draw(&Text::new(title.to_string(), (12, 12), (FONT, 18)))?;
        let scale = f64::from(WIDTH - LEFT - 90) / most;
        let mut case = "";
        for (i, (name, method, value, hollow)) in list.iter().enumerate() {
            let y = 44 + ROW * i32::try_from(i)?;
            if case != name && i > 0 {
                area.draw(&PathElement::new([(12, y), (WIDTH - 12, y)], RGBColor(220, 220, 220)))?;
            }
            let right = (FONT, 13).into_text_style(&area).pos(Pos::new(HPos::Right, VPos::Center));
            let label = if case == name { method.clone() } else { format!("{name}, {method}") };
            case = name;
            let label: String = label.chars().take(54).collect();
            area.draw(&Text::new(label, (LEFT - 8, y + ROW / 2), right))?;
            let color = color(methods.iter().position(|m| m == method).unwrap_or(0));
            let end = LEFT + (value * scale).round() as i32;
            let style = if *hollow { color.stroke_width(1) } else { color.filled() };
            area.draw(&Rectangle::new([(LEFT, y + 3), (end.max(LEFT + 1), y + ROW - 3)], style))?;
            let left = (FONT, 13).into_text_style(&area).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(short(*value), (end + 6, y + ROW / 2), left))?;
        }
        area.present()?;
    }
    Ok(Some(svg))
}
