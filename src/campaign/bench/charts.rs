//! A benchmark as charts.

use super::tables::{Row, columns, rows, stage_of, stages};
use super::{Bench, Configuration};
use crate::campaign::report::{Bar, COLORS, bars};
use crate::lab::LabError;
use plotters::coord::combinators::BindKeyPoints;
use plotters::prelude::*;

const FONT: &str = "sans-serif";

/// File names (without `.svg`) and charts: the stages of every configuration as stacked bars, and for every stage its
/// time against what the columns of the tables vary, at the largest size.
///
/// # Errors
/// Drawing into memory gives none, whatever the benchmark.
pub fn charts(bench: &Bench) -> Result<Vec<(String, String)>, LabError> {
    let measured: Vec<&Configuration> = bench.configurations.iter().filter(|c| c.times.is_some()).collect();
    let all: Vec<Bar> = measured.iter().map(|c| bar(c)).collect();
    let title = format!("{}: ms of each stage (medians)", bench.device.name);
    let mut out = vec![("stages".to_string(), bars(&title, &all)?)];
    let (column, values) = columns(bench);
    let numbers: Vec<f64> = values.iter().filter_map(|v| v.parse().ok()).filter(|v| *v > 0.0).collect();
    if numbers.len() < 2 || numbers.len() < values.len() {
        return Ok(out);
    }
    let rows = rows(bench);
    let most = rows.iter().map(|r| u64::from(r.size.0) * u64::from(r.size.1)).max().unwrap_or(0);
    let rows: Vec<&Row> = rows.iter().filter(|r| u64::from(r.size.0) * u64::from(r.size.1) == most).collect();
    let mut names: Vec<String> = Vec::new();
    for stage in rows.iter().flat_map(|r| stages(r)) {
        if !names.contains(&stage) {
            names.push(stage);
        }
    }
    for stage in names {
        let lines: Vec<(&str, Vec<(f64, f64)>)> = rows
            .iter()
            .map(|row| {
                let points = numbers.iter().zip(&row.cells);
                let points = points.filter_map(|(x, c)| Some((*x, stage_of((*c)?, &stage)?.median)));
                (row.title.as_str(), points.collect())
            })
            .collect();
        let size = rows.first().map_or((0, 0), |r| r.size);
        let title = format!("{stage} at {}x{}, {}", size.0, size.1, bench.device.name);
        let mut svg = String::new();
        draw(&mut svg, &title, &column, &numbers, &lines)
            .map_err(|e| LabError::Request(format!("cannot draw '{title}': {e}")))?;
        let name: String = stage.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        out.push((format!("stage-{name}"), svg));
    }
    Ok(out)
}

fn bar(configuration: &Configuration) -> Bar {
    let labels = configuration.labels.iter().filter(|(name, _)| *name != "size");
    let labels: Vec<String> = labels.map(|(n, v)| format!("{n} {v}")).collect();
    let (w, h) = configuration.size;
    let stages = configuration.times.iter().flat_map(|t| &t.stages);
    Bar { label: format!("{w}x{h} {}", labels.join(", ")), parts: stages.map(|(n, s)| (n.clone(), s.median)).collect() }
}

fn draw(
    svg: &mut String,
    title: &str,
    x_title: &str,
    xs: &[f64],
    lines: &[(&str, Vec<(f64, f64)>)],
) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::with_string(svg, (800, 460)).into_drawing_area();
    area.fill(&WHITE)?;
    let most = lines.iter().flat_map(|l| &l.1).map(|p| p.1).fold(0.0, f64::max).max(1e-6);
    let (low, high) = xs.iter().fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(*v), b.max(*v)));
    let mut chart = ChartBuilder::on(&area)
        .margin(12)
        .caption(title, (FONT, 20))
        .x_label_area_size(46)
        .y_label_area_size(70)
        .build_cartesian_2d((low / 1.1..high * 1.1).log_scale().with_key_points(xs.to_vec()), 0.0..most * 1.1)?;
    chart
        .configure_mesh()
        .x_desc(format!("{x_title} (log)"))
        .y_desc("GPU ms, median")
        .x_label_formatter(&|x| x.to_string())
        .max_light_lines(1)
        .axis_desc_style((FONT, 17))
        .label_style((FONT, 14))
        .light_line_style(RGBColor(240, 240, 240))
        .draw()?;
    for (i, (name, points)) in lines.iter().enumerate() {
        let color = COLORS[i % COLORS.len()];
        chart
            .draw_series(LineSeries::new(points.clone(), color.stroke_width(2)))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        chart.draw_series(points.iter().map(|p| Circle::new(*p, 4, color.filled())))?;
    }
    if lines.len() > 1 {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .label_font((FONT, 15))
            .draw()?;
    }
    area.present()?;
    Ok(())
}
