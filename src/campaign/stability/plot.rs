//! Static error against stability with costs: rows, table and chart.

use super::chart_spec::CostChart;
use super::cost::Cost;
use super::record::{Measured, PartResult, Report};
use super::table::{mebibytes, text};
use crate::campaign::report::{COLORS, escaped, short, ticks};
use crate::campaign::sweep::csv_text;
use crate::lab::LabError;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fmt::Write;
use std::ops::Range;

const FONT: &str = "sans-serif";
/// A panel, pixels.
const PANEL: (u32, u32) = (620, 500);
/// Height of a dot's label, pixels.
const LABEL: i32 = 16;
/// Values that spread by more than this factor get a logarithmic axis.
const SPREAD: f64 = 8.0;
/// Results below so many times the noise of the reference are not told apart from it.
const NOISE_FACTOR: f64 = 4.0;

/// A value with the same between the halves of the reference.
#[derive(Clone, Copy)]
struct Score {
    value: f64,
    noise: f64,
    /// The value without what a reference of that noise adds to it on average.
    without: f64,
}

/// A method in a group.
struct Row {
    method: String,
    /// The value that was chosen for the method.
    setting: String,
    ms: Option<f64>,
    ratio: Option<f64>,
    /// Whether the method was to be as fast as the first, and is not.
    off: bool,
    memory_bytes: Option<u64>,
    error: Option<Score>,
    change: Option<Score>,
}

/// The chart of a suite's costs.
pub(super) struct Plot<'a> {
    spec: &'a CostChart,
    groups: Vec<(String, Vec<Row>)>,
    /// Panels side by side; none where no method has both values.
    pub svg: Option<String>,
}

impl Plot<'_> {
    /// From the results of a suite.
    ///
    /// # Errors
    /// Drawing into memory gives none, whatever the results.
    pub fn new<'a>(report: &Report, spec: &'a CostChart) -> Result<Plot<'a>, LabError> {
        let rows = |list: &[String]| list.iter().map(|m| row(report, spec, m)).collect();
        let groups: Vec<(String, Vec<Row>)> = spec.groups.iter().map(|g| (g.0.clone(), rows(&g.1))).collect();
        let svg = draw(spec, &groups).map_err(|e| LabError::Request(format!("cannot draw the chart of costs: {e}")))?;
        Ok(Plot { spec, groups, svg })
    }

    /// `cost.csv`.
    pub fn csv(&self) -> Result<String, LabError> {
        let header = ["group", "method", "setting", "GPU ms", "part of the first's ms", "memory MiB"].map(String::from);
        let scores = ["relMSE", "relMSE noise", "E_t", "E_t noise"].map(|c| format!("{} {c}", self.spec.part));
        let mut lines = vec![header.into_iter().chain(scores).collect::<Vec<_>>()];
        for (group, rows) in &self.groups {
            lines.extend(rows.iter().map(|r| {
                let score = |s: Option<Score>| [text(s.map(|s| s.value)), text(s.map(|s| s.noise))];
                let own = [group.clone(), r.method.clone(), r.setting.clone(), text(r.ms), text(r.ratio)];
                let memory = r.memory_bytes.map_or(String::new(), mebibytes);
                own.into_iter().chain([memory]).chain(score(r.error)).chain(score(r.change)).collect()
            }));
        }
        csv_text(&lines)
    }

    /// Chart and tables, HTML.
    pub fn html(&self) -> String {
        let mut out = String::new();
        let _ = writeln!(
            out,
            "<h2>What stability costs</h2>\n<p>Part: {}. To the right relMSE of {}, up the root mean square of E_t of {}; \
             both are better towards the lower left. Times and memory are of frames that make the picture alone, timed \
             in '{}'. A bar reaches to what is left without the noise that the reference adds on average; hollow: less \
             than {NOISE_FACTOR} times the noise between its halves. <a href=\"cost.csv\">cost.csv</a></p>",
            escaped(&self.spec.part),
            escaped(&self.spec.error.join(", ")),
            escaped(&self.spec.motions.join(", ")),
            escaped(self.spec.motions.first().map_or("", String::as_str))
        );
        match &self.svg {
            Some(svg) => drop(writeln!(out, "<figure>{svg}</figure>")),
            None => out += "<p>No chart: no method has results in all of these cases.</p>\n",
        }
        for (group, rows) in &self.groups {
            let _ = writeln!(
                out,
                "<div class=\"wide\"><table><tr><th>{}</th><th>setting</th><th>GPU ms</th><th>of the first's</th>\
                 <th>MiB</th><th>relMSE</th><th>noise</th><th>E_t</th><th>noise</th></tr>",
                escaped(group)
            );
            for r in rows {
                let _ = write!(out, "<tr><td>{}</td><td>{}</td>", escaped(&r.method), escaped(&r.setting));
                let number = |v: Option<f64>| v.map_or(String::new(), short);
                let off = if r.off { " class=\"bad\"" } else { "" };
                let ratio = r.ratio.map_or(String::new(), |v| format!("{v:.2}"));
                let _ = write!(out, "<td>{}</td><td{off}>{ratio}</td>", number(r.ms));
                let _ = write!(out, "<td>{}</td>", r.memory_bytes.map_or(String::new(), mebibytes));
                for score in [r.error, r.change] {
                    let noisy = if score.is_some_and(|s| s.within_noise()) { " class=\"noise\"" } else { "" };
                    let (value, noise) = (number(score.map(|s| s.value)), number(score.map(|s| s.noise)));
                    let _ = write!(out, "<td{noisy}>{value}</td><td>{noise}</td>");
                }
                out += "</tr>\n";
            }
            out += "</table></div>\n";
        }
        if let Some(equal) = &self.spec.equal_time
            && self.groups.iter().flat_map(|g| &g.1).any(|r| r.off)
        {
            let percent = 100.0 * equal.tolerance;
            let _ =
                writeln!(out, "<p class=\"bad\">Red: no value comes within {percent:.0} % of the first's time.</p>");
        }
        out
    }
}

impl Score {
    fn within_noise(&self) -> bool {
        self.value < NOISE_FACTOR * self.noise
    }
}

fn row(report: &Report, spec: &CostChart, method: &str) -> Row {
    let cost: Option<&Cost> = report.costs.iter().find(|c| c.method == method);
    let taken = cost.and_then(Cost::taken);
    let ratio = taken.and_then(|c| c.ratio());
    let tolerance = spec.equal_time.as_ref().filter(|_| !spec.varied(method).is_empty()).map(|e| e.tolerance);
    Row {
        method: method.to_string(),
        setting: match (cost, taken) {
            (Some(cost), Some(taken)) if !cost.parameter.is_empty() => format!("{} = {}", cost.parameter, taken.value),
            _ => String::new(),
        },
        ms: taken.and_then(|c| c.time()),
        ratio,
        off: tolerance.zip(ratio).is_some_and(|(t, r)| (r - 1.0).abs() > t),
        memory_bytes: taken.map(|c| c.memory_bytes),
        // The halves differ by four times the variance of their mean (half the samples each, and two of them).
        error: values(report, spec, &spec.error, method, |p| Some((p.scores.as_ref()?.relmse, p.noise?))).map(|list| {
            let mean = |f: fn(&(f64, f64)) -> f64| list.iter().map(f).sum::<f64>() / list.len() as f64;
            let (value, noise) = (mean(|v| v.0), mean(|v| v.1));
            Score { value, noise, without: (value - noise / 4.0).max(0.0) }
        }),
        change: values(report, spec, &spec.motions, method, |p| Some((p.e?, p.e_noise?))).map(|list| {
            let square = |f: fn(&(f64, f64)) -> f64| list.iter().map(|v| f(v).powi(2)).sum::<f64>() / list.len() as f64;
            let (value, noise) = (square(|v| v.0), square(|v| v.1));
            Score { value: value.sqrt(), noise: noise.sqrt(), without: (value - noise / 4.0).max(0.0).sqrt() }
        }),
    }
}

/// A method's values in all variants of some cases; none if one is missing: a mean over other cases is another number.
fn values(
    report: &Report,
    spec: &CostChart,
    cases: &[String],
    method: &str,
    value: impl Fn(&PartResult) -> Option<(f64, f64)>,
) -> Option<Vec<(f64, f64)>> {
    let mut list = Vec::new();
    for case in cases {
        let own = report.results.iter().filter(|r| r.case == *case && r.method == method);
        let before = list.len();
        for record in own {
            let part = record.measured().and_then(|m: &Measured| m.parts.get(&spec.part))?;
            list.push(value(part).filter(|v| v.0.is_finite() && v.1.is_finite())?);
        }
        (list.len() > before).then_some(())?;
    }
    Some(list)
}

/// An axis: linear or logarithmic, from its least to its greatest value.
#[derive(Clone)]
struct Axis {
    log: bool,
    range: (f64, f64),
}

impl Axis {
    fn of(values: &[f64]) -> Axis {
        let most = values.iter().copied().fold(0.0, f64::max);
        let least = values.iter().copied().filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
        match most > 0.0 && most / least > SPREAD {
            true => Axis { log: true, range: (least / 1.6, most * 1.6) },
            false => Axis { log: false, range: (0.0, if most > 0.0 { most * 1.15 } else { 1.0 }) },
        }
    }

    fn title(&self, what: &str) -> String {
        if self.log { format!("{what} (log)") } else { what.to_string() }
    }
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    /// What is below a logarithmic axis lies at its end.
    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let (low, high) = self.range;
        let part = match self.log {
            true => (value.max(low) / low).ln() / (high / low).ln(),
            false => (value - low) / (high - low),
        };
        limit.0 + (f64::from(limit.1 - limit.0) * part).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        match (hint.weight().allow_light_points(), self.log) {
            (true, _) => Vec::new(),
            (false, true) => ticks(self.range),
            (false, false) => {
                let decade = 10f64.powf((self.range.1 / 5.0).log10().floor());
                let steps = [1.0, 2.0, 5.0, 10.0].map(|s| s * decade);
                let step = steps.into_iter().find(|s| s * 5.0 >= self.range.1).unwrap_or(self.range.1);
                (0..=5).map(|i| step * f64::from(i)).filter(|v| *v <= self.range.1).collect()
            }
        }
    }

    fn range(&self) -> Range<f64> {
        self.range.0..self.range.1
    }
}

type Failure = Box<dyn std::error::Error>;

/// A panel a group, on equal axes; a colour for each place in a group.
fn draw(spec: &CostChart, groups: &[(String, Vec<Row>)]) -> Result<Option<String>, Failure> {
    type Dot<'a> = (&'a str, Score, Score, RGBColor);
    fn dots(rows: &[Row]) -> Vec<Dot<'_>> {
        let colors = COLORS.iter().cycle();
        rows.iter()
            .zip(colors)
            .filter_map(|(r, color)| Some((r.method.as_str(), r.error?, r.change?, *color)))
            .collect()
    }
    let all: Vec<Dot> = groups.iter().flat_map(|g| dots(&g.1)).collect();
    if all.is_empty() {
        return Ok(None);
    }
    let (x, y) = (
        Axis::of(&all.iter().map(|d| d.1.value).collect::<Vec<_>>()),
        Axis::of(&all.iter().map(|d| d.2.value).collect::<Vec<_>>()),
    );
    let count = u32::try_from(groups.len())?;
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (PANEL.0 * count, PANEL.1)).into_drawing_area();
        area.fill(&WHITE)?;
        for ((title, rows), panel) in groups.iter().zip(area.split_evenly((1, groups.len()))) {
            let mut chart = ChartBuilder::on(&panel)
                .margin(12)
                .caption(title, (FONT, 18))
                .x_label_area_size(46)
                .y_label_area_size(76)
                .build_cartesian_2d(x.clone(), y.clone())?;
            chart
                .configure_mesh()
                .x_desc(x.title(&format!("relMSE of {}, standing still", spec.part)))
                .y_desc(y.title(&format!("E_t of {}, moving", spec.part)))
                .x_label_formatter(&|v| short(*v))
                .y_label_formatter(&|v| short(*v))
                .axis_desc_style((FONT, 15))
                .label_style((FONT, 13))
                .light_line_style(WHITE)
                .bold_line_style(RGBColor(225, 225, 225))
                .draw()?;
            let mut placed: Vec<(i32, i32)> = Vec::new();
            let mut dots = dots(rows);
            dots.sort_by(|a, b| b.2.value.total_cmp(&a.2.value));
            for (name, error, change, color) in &dots {
                let at = (error.value, change.value);
                let bars = [vec![(error.without, at.1), at], vec![(at.0, change.without), at]];
                chart.draw_series(bars.map(|bar| PathElement::new(bar, color.stroke_width(1))))?;
                let hollow = error.within_noise() || change.within_noise();
                let inside = if hollow { WHITE.filled() } else { color.filled() };
                chart.draw_series([Circle::new(at, 5, inside), Circle::new(at, 5, color.stroke_width(2))])?;
                // Labels stand beside their dots, on the left above the bar, and below those of dots that are close.
                let dot = chart.backend_coord(&at);
                let (left, width) = (panel.get_pixel_range().0.start, panel.dim_in_pixel().0);
                let right = dot.0 - left < i32::try_from(width)? * 2 / 3;
                let near = placed.iter().filter(|p| (p.0 - dot.0).abs() < 200);
                let line = near.map(|p| p.1 + LABEL).fold(dot.1 - if right { 0 } else { 10 }, i32::max);
                placed.push((dot.0, line));
                let (side, anchor) = if right { (9, HPos::Left) } else { (-9, HPos::Right) };
                let style = (FONT, 13).into_text_style(&area).pos(Pos::new(anchor, VPos::Center));
                area.draw(&Text::new(name.chars().take(34).collect::<String>(), (dot.0 + side, line), style))?;
            }
        }
        area.present()?;
    }
    Ok(Some(svg))
}
