//! A benchmark as charts.

use super::tables::{Row, columns, rows, stage_of, stages};
use super::{Bench, Configuration};
use crate::campaign::charts::{Axis, Bar, Line, bars, file_name, lines};
use crate::campaign::points::labelled;
use crate::lab::LabError;
use indexmap::IndexSet;

/// File names (without `.svg`) and charts: stacked bars of the stages of all configurations, and
/// one chart of each stage's time over the varied setting at the largest size.
pub fn charts(bench: &Bench) -> Result<Vec<(String, String)>, LabError> {
    let measured = bench.configurations.iter().filter(|c| c.times.is_some());
    let title = format!("{}: ms of each stage (medians)", bench.device.name);
    let stacked = bars(
        &title,
        " ms",
        |ms| format!("{ms:.3}"),
        &measured.map(bar).collect::<Vec<_>>(),
    )?;
    let mut out = vec![("stages".to_string(), stacked)];
    let (column, values) = columns(bench);
    let numbers: Vec<f64> = values
        .iter()
        .filter_map(|v| v.parse().ok())
        .filter(|v| *v > 0.0)
        .collect();
    if numbers.len() < 2 || numbers.len() < values.len() {
        return Ok(out);
    }
    let rows = rows(bench);
    let most = rows.iter().map(Row::pixels).max().unwrap_or(0);
    let rows: Vec<&Row> = rows.iter().filter(|r| r.pixels() == most).collect();
    let names: IndexSet<String> = rows.iter().flat_map(|r| stages(r)).collect();
    let (low, high) = numbers
        .iter()
        .fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(*v), b.max(*v)));
    let x = Axis::log(&column, (low / 1.1, high * 1.1)).marked(numbers.clone());
    for stage in names {
        let line = |row: &&Row| {
            let points = numbers.iter().zip(&row.cells);
            let points = points.filter_map(|(x, c)| Some((*x, stage_of((*c)?, &stage)?.median)));
            Line {
                name: row.title.clone(),
                points: points.collect(),
                grey: false,
            }
        };
        let list: Vec<Line> = rows.iter().map(line).collect();
        let most = list
            .iter()
            .flat_map(|l| &l.points)
            .map(|p| p.1)
            .fold(0.0, f64::max)
            .max(1e-6);
        let size = rows.first().map_or((0, 0), |r| r.size);
        let title = format!("{stage} at {}x{}, {}", size.0, size.1, bench.device.name);
        let svg = lines(
            &title,
            &x,
            &Axis::linear("GPU ms, median", (0.0, most * 1.1)),
            &list,
        )?;
        out.push((format!("stage-{}", file_name(&stage)), svg));
    }
    Ok(out)
}

fn bar(configuration: &Configuration) -> Bar {
    let labels = labelled(
        configuration
            .labels
            .iter()
            .filter(|(name, _)| *name != "size"),
    );
    let (w, h) = configuration.size;
    let stages = configuration.times.iter().flat_map(|t| &t.stages);
    let parts = stages.map(|(n, s)| (n.clone(), s.median)).collect();
    Bar {
        label: format!("{w}x{h} {labels}"),
        parts,
        hollow: false,
    }
}
