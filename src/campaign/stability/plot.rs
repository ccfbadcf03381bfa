//! Static error against stability with costs: rows, table and chart.

use super::chart_spec::CostChart;
use super::record::{Cost, PartResult, Report};
use crate::campaign::charts::{Area, Axis, Failure, color, drawn, plane, text};
use crate::campaign::page::figure;
use crate::diagnostics::excerpt::cut;
use crate::lab::LabError;
use crate::metrics::{NOISE_FACTOR, RELMSE, within_noise};
use crate::results::table::{Table, cell, mebibytes, number, shortly};
use maud::{Markup, html};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Size of a panel, pixels.
const PANEL: (u32, u32) = (620, 500);
/// Height of a dot's label, pixels.
const LABEL: i32 = 16;
/// Ratio of values above which an axis is logarithmic.
const SPREAD: f64 = 8.0;

/// A value and its noise: the same metric between the halves of the reference.
#[derive(Clone, Copy)]
struct Score {
    value: f64,
    noise: f64,
    /// The value without the mean contribution of the reference's noise.
    without: f64,
}

/// A method in a group.
struct Row {
    method: String,
    /// Value that was chosen for the method.
    setting: String,
    ms: Option<f64>,
    ratio: Option<f64>,
    /// Whether the method misses the first method's time although it has to match it.
    off: bool,
    memory_bytes: Option<u64>,
    error: Option<Score>,
    change: Option<Score>,
}

/// The chart of a suite's costs.
pub(super) struct Plot<'a> {
    spec: &'a CostChart,
    groups: Vec<(String, Vec<Row>)>,
    /// Panels side by side, `None` if no method has both values.
    pub svg: Option<String>,
}

impl Plot<'_> {
    /// From the results of a suite.
    pub fn new<'a>(report: &Report, spec: &'a CostChart) -> Result<Plot<'a>, LabError> {
        let rows = |list: &[String]| list.iter().map(|m| row(report, spec, m)).collect();
        let groups: Vec<(String, Vec<Row>)> = spec
            .groups
            .0
            .iter()
            .map(|g| (g.0.value.clone(), rows(&g.1.value)))
            .collect();
        let svg = draw(spec, &groups)?;
        Ok(Plot { spec, groups, svg })
    }

    /// `cost.csv`.
    pub fn csv(&self) -> Result<String, LabError> {
        let rows: Vec<(&String, &Row)> = self
            .groups
            .iter()
            .flat_map(|(group, rows)| rows.iter().map(move |r| (group, r)))
            .collect();
        let part = self.spec.part();
        let mut table = Table::new(&rows);
        table.column("group", |r| r.0.clone());
        table.column("method", |r| r.1.method.clone());
        table.column("setting", |r| r.1.setting.clone());
        table.column("GPU ms", |r| number(r.1.ms));
        table.column("part of the first's ms", |r| number(r.1.ratio));
        table.column("memory MiB", |r| cell(r.1.memory_bytes.map(mebibytes)));
        table.column(format!("{part} relMSE"), |r| {
            number(r.1.error.map(|s| s.value))
        });
        table.column(format!("{part} relMSE noise"), |r| {
            number(r.1.error.map(|s| s.noise))
        });
        table.column(format!("{part} E_t"), |r| {
            number(r.1.change.map(|s| s.value))
        });
        table.column(format!("{part} E_t noise"), |r| {
            number(r.1.change.map(|s| s.noise))
        });
        table.csv()
    }

    /// Chart and tables, HTML.
    pub fn html(&self) -> Markup {
        let CostChart {
            error,
            motions,
            equal_time,
            ..
        } = self.spec;
        let off = self.groups.iter().flat_map(|g| &g.1).any(|r| r.off);
        html! {
            h2 { "What stability costs" }
            p {
                "Part: " (self.spec.part()) ". To the right relMSE of " (error.join(", ")) ", up the root mean square of E_t of "
                (motions.join(", ")) "; both are better towards the lower left. Times and memory are of frames that make \
                 the picture alone, timed in '" (cell(motions.first())) "'. A bar reaches to what is left without the noise \
                 that the reference adds on average; hollow: less than " (NOISE_FACTOR) " times the noise between its \
                 halves. " a href="cost.csv" { "cost.csv" }
            }
            @match &self.svg {
                Some(svg) => (figure(svg)),
                None => p { "No chart: no method has results in all of these cases." }
            }
            @for (group, rows) in &self.groups { (table(group, rows)) }
            @if let Some(equal) = equal_time.as_ref().filter(|_| off) {
                p.bad { "Red: no value comes within " (format!("{:.0}", 100.0 * equal.tolerance)) " % of the first's time." }
            }
        }
    }
}

/// A row for each method of a group.
fn table(group: &str, rows: &[Row]) -> Markup {
    let mut table = Table::new(rows);
    table.column(group, |r| r.method.clone());
    table.column("setting", |r| r.setting.clone());
    table.column("GPU ms", |r| shortly(r.ms));
    table.marked("of the first's", |r| {
        (
            cell(r.ratio.map(|v| format!("{v:.2}"))),
            r.off.then_some("bad"),
        )
    });
    table.column("MiB", |r| cell(r.memory_bytes.map(mebibytes)));
    type Of = fn(&Row) -> Option<Score>;
    let scores: [(&str, Of); 2] = [("relMSE", |r| r.error), ("E_t", |r| r.change)];
    for (title, score) in scores {
        let noisy = |s: Option<Score>| s.is_some_and(|s| s.noisy()).then_some("noise");
        table.marked(title, |r| {
            (shortly(score(r).map(|s| s.value)), noisy(score(r)))
        });
        table.column("noise", |r| shortly(score(r).map(|s| s.noise)));
    }
    table.html()
}

impl Score {
    fn noisy(&self) -> bool {
        within_noise(self.value, Some(self.noise))
    }
}

fn row(report: &Report, spec: &CostChart, method: &str) -> Row {
    let cost: Option<&Cost> = report.costs.iter().find(|c| c.method == method);
    let taken = cost.and_then(Cost::taken);
    let ratio = taken.and_then(|c| c.ratio());
    let tolerance = spec
        .equal_time
        .as_ref()
        .filter(|_| !spec.varied(method).is_empty())
        .map(|e| e.tolerance);
    Row {
        method: method.to_string(),
        setting: match (cost, taken) {
            (Some(cost), Some(taken)) if !cost.parameter.is_empty() => {
                format!("{} = {}", cost.parameter, taken.value)
            }
            _ => String::new(),
        },
        ms: taken.and_then(|c| c.time()),
        ratio,
        off: tolerance
            .zip(ratio)
            .is_some_and(|(t, r)| (r - 1.0).abs() > t),
        memory_bytes: taken.map(|c| c.memory_bytes),
        // The difference of the halves has four times the variance of their mean: each has half the
        // samples, and there are two.
        error: values(report, spec, &spec.error, method, |p| {
            Some((p.scores.as_ref()?.get(RELMSE), p.noise?))
        })
        .map(|list| {
            let mean =
                |f: fn(&(f64, f64)) -> f64| list.iter().map(f).sum::<f64>() / list.len() as f64;
            let (value, noise) = (mean(|v| v.0), mean(|v| v.1));
            Score {
                value,
                noise,
                without: (value - noise / 4.0).max(0.0),
            }
        }),
        change: values(report, spec, &spec.motions, method, |p| {
            Some((p.e?, p.e_noise?))
        })
        .map(|list| {
            let square = |f: fn(&(f64, f64)) -> f64| {
                list.iter().map(|v| f(v).powi(2)).sum::<f64>() / list.len() as f64
            };
            let (value, noise) = (square(|v| v.0), square(|v| v.1));
            Score {
                value: value.sqrt(),
                noise: noise.sqrt(),
                without: (value - noise / 4.0).max(0.0).sqrt(),
            }
        }),
    }
}

/// Values of a method in all variants of some cases. `None` if one is missing, because a mean over
/// other cases is not comparable.
fn values(
    report: &Report,
    spec: &CostChart,
    cases: &[String],
    method: &str,
    value: impl Fn(&PartResult) -> Option<(f64, f64)>,
) -> Option<Vec<(f64, f64)>> {
    let mut list = Vec::new();
    for case in cases {
        let own = report
            .results
            .iter()
            .filter(|r| r.about.case == *case && r.about.method == method);
        let before = list.len();
        for record in own {
            list.push(
                value(record.part(spec.part())?).filter(|v| v.0.is_finite() && v.1.is_finite())?,
            );
        }
        (list.len() > before).then_some(())?;
    }
    Some(list)
}

fn draw_panel(
    area: &Area,
    panel: &Area,
    (title, rows): (&str, &[Row]),
    (x, y): (&Axis, &Axis),
) -> Result<(), Failure> {
    let mut chart = plane(panel, title, x, y)?;
    let mut placed: Vec<(i32, i32)> = Vec::new();
    let mut dots = dots(rows);
    dots.sort_by(|a, b| b.2.value.total_cmp(&a.2.value));
    for (name, error, change, color) in &dots {
        let at = (error.value, change.value);
        let bars = [
            vec![(error.without, at.1), at],
            vec![(at.0, change.without), at],
        ];
        chart.draw_series(bars.map(|bar| PathElement::new(bar, color.stroke_width(1))))?;
        let hollow = error.noisy() || change.noisy();
        let inside = if hollow { WHITE } else { *color };
        chart.draw_series([
            Circle::new(at, 5, inside.filled()),
            Circle::new(at, 5, color.stroke_width(2)),
        ])?;
        // Labels are next to their dots: on the left above the bar, and below labels of
        // close dots.
        let dot = chart.backend_coord(&at);
        let (left, width) = (panel.get_pixel_range().0.start, panel.dim_in_pixel().0);
        let right = dot.0 - left < i32::try_from(width)? * 2 / 3;
        let near = placed.iter().filter(|p| (p.0 - dot.0).abs() < 200);
        let line = near
            .map(|p| p.1 + LABEL)
            .fold(dot.1 - if right { 0 } else { 10 }, i32::max);
        placed.push((dot.0, line));
        let (side, anchor) = if right {
            (9, HPos::Left)
        } else {
            (-9, HPos::Right)
        };
        let style = text(13, anchor, VPos::Center);
        area.draw(&Text::new(cut(name, 34), (dot.0 + side, line), style))?;
    }
    Ok(())
}

/// Axis over the range of some values.
fn axis(title: &str, values: impl Iterator<Item = f64> + Clone) -> Axis {
    let most = values.clone().fold(0.0, f64::max);
    let least = values.filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
    match most > 0.0 && most / least > SPREAD {
        true => Axis::log(title, (least / 1.6, most * 1.6)),
        false => Axis::linear(title, (0.0, if most > 0.0 { most * 1.15 } else { 1.0 })),
    }
}

/// Name, error and change of a method in a group, with its colour.
type Dot<'a> = (&'a str, Score, Score, RGBColor);

fn dots(rows: &[Row]) -> Vec<Dot<'_>> {
    let dot =
        |(i, r): (usize, &Row)| Some((rows[i].method.as_str(), r.error?, r.change?, color(i)));
    rows.iter().enumerate().filter_map(dot).collect()
}

/// One panel per group, on equal axes. Colours follow the order in a group.
fn draw(spec: &CostChart, groups: &[(String, Vec<Row>)]) -> Result<Option<String>, LabError> {
    let all: Vec<Dot> = groups.iter().flat_map(|g| dots(&g.1)).collect();
    if all.is_empty() {
        return Ok(None);
    }
    let x = axis(
        &format!("relMSE of {}, standing still", spec.part()),
        all.iter().map(|d| d.1.value),
    );
    let y = axis(
        &format!("E_t of {}, moving", spec.part()),
        all.iter().map(|d| d.2.value),
    );
    let width = PANEL
        .0
        .saturating_mul(u32::try_from(groups.len()).unwrap_or(u32::MAX));
    let svg = drawn("cost", (width, PANEL.1), |area| {
        for ((title, rows), panel) in groups.iter().zip(area.split_evenly((1, groups.len()))) {
            draw_panel(area, &panel, (title, rows), (&x, &y))?;
        }
        Ok(())
    })?;
    Ok(Some(svg))
}
