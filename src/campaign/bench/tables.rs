//! A benchmark as tables.

use super::{Bench, Configuration};
use crate::lab::LabError;
use crate::results::stats::Spread;
use std::fmt::Write;

/// Configurations that stand in one row of a table: those that differ in nothing but what the columns vary.
pub(super) struct Row<'a> {
    /// What it is, without its size.
    pub title: String,
    pub size: (u32, u32),
    /// One for each column.
    pub cells: Vec<Option<&'a Configuration>>,
}

/// Name and values of what the columns vary: the first setting that is no size and no experiment.
pub(super) fn columns(bench: &Bench) -> (String, Vec<String>) {
    let name = bench.names.iter().find(|n| *n != "size" && *n != "experiment").cloned().unwrap_or_default();
    let mut values: Vec<String> = Vec::new();
    for configuration in &bench.configurations {
        let value = configuration.labels.get(&name).cloned().unwrap_or_default();
        if !values.contains(&value) {
            values.push(value);
        }
    }
    (name, values)
}

pub(super) fn rows(bench: &Bench) -> Vec<Row<'_>> {
    let (column, values) = columns(bench);
    let varies = |name: &String| {
        let mut values = bench.configurations.iter().map(|c| c.labels.get(name));
        let first = values.next();
        values.any(|v| Some(v) != first)
    };
    let mut rows: Vec<Row> = Vec::new();
    for configuration in &bench.configurations {
        let others =
            configuration.labels.iter().filter(|(name, _)| **name != column && *name != "size" && varies(name));
        let parts: Vec<String> =
            others.map(|(n, v)| if n == "experiment" { v.clone() } else { format!("{n} {v}") }).collect();
        let title = if parts.is_empty() { configuration.experiment.clone() } else { parts.join(", ") };
        let same = |r: &&mut Row| r.title == title && r.size == configuration.size;
        let row = match rows.iter_mut().find(same) {
            Some(row) => row,
            None => {
                rows.push(Row { title, size: configuration.size, cells: vec![None; values.len()] });
                let last = rows.len() - 1;
                &mut rows[last]
            }
        };
        let value = configuration.labels.get(&column).cloned().unwrap_or_default();
        if let Some(cell) = values.iter().position(|v| *v == value) {
            row.cells[cell] = Some(configuration);
        }
    }
    rows
}

/// The tables for people: the stages of each configuration at the last size, the totals by size, and the totals of every
/// row beside those of the first at the same size, compared round by round.
pub fn text(bench: &Bench) -> String {
    let (column, values) = columns(bench);
    let rows = rows(bench);
    let mut out = format!(
        "{} ({}), {} rounds of {} frames after at least {} of warm-up; GPU ms, median (95 %)\n",
        bench.device.name, bench.device.driver, bench.rounds, bench.frames.count, bench.frames.warmup
    );
    let titles = rows.iter().map(|r| r.title.chars().count() + "1920x1080 ".len());
    let width = titles.chain(rows.iter().flat_map(stages).map(|s| s.chars().count())).max().unwrap_or(0) + 2;
    let header = |out: &mut String, title: &str| {
        let _ = writeln!(out, "\n{title}");
        let _ = write!(out, "{column:<width$}");
        out.extend(values.iter().map(|v| format!("{v:>22}")));
        out.push('\n');
    };
    let line = |out: &mut String, title: &str, cells: &[Option<String>]| {
        let _ = write!(out, "{title:<width$}");
        out.extend(cells.iter().map(|c| format!("{:>22}", c.as_deref().unwrap_or("-"))));
        out.push('\n');
    };
    let last = rows.iter().map(|r| u64::from(r.size.0) * u64::from(r.size.1)).max().unwrap_or(0);
    for row in rows.iter().filter(|r| u64::from(r.size.0) * u64::from(r.size.1) == last) {
        header(&mut out, &format!("{} at {}x{}", row.title, row.size.0, row.size.1));
        for stage in stages(row) {
            let cells: Vec<_> = row.cells.iter().map(|c| cell(stage_of((*c)?, &stage)?)).collect();
            line(&mut out, &stage, &cells);
        }
        line(&mut out, "total", &row.cells.iter().map(|c| cell(total((*c)?)?)).collect::<Vec<_>>());
    }
    header(&mut out, "total");
    for row in &rows {
        let title = format!("{}x{} {}", row.size.0, row.size.1, row.title);
        line(&mut out, &title, &row.cells.iter().map(|c| cell(total((*c)?)?)).collect::<Vec<_>>());
    }
    let compared: Vec<(&Row, &Row)> = rows
        .iter()
        .filter_map(|row| Some((rows.iter().find(|r| r.size == row.size)?, row)))
        .filter(|(first, row)| first.title != row.title)
        .collect();
    if !compared.is_empty() {
        header(&mut out, "total, times that of the first at its size: median of the rounds (least to most)");
        for (first, row) in compared {
            let cells: Vec<_> = first.cells.iter().zip(&row.cells).map(|(a, b)| ratio((*a)?, (*b)?)).collect();
            line(&mut out, &format!("{}x{} {}", row.size.0, row.size.1, row.title), &cells);
        }
    }
    for failed in bench.configurations.iter().filter(|c| c.error.is_some()) {
        let labels: Vec<String> = failed.labels.iter().map(|(n, v)| format!("{n} {v}")).collect();
        let error = failed.error.as_deref().and_then(|e| e.lines().next()).unwrap_or_default();
        let _ = writeln!(out, "failed: {}: {error}", labels.join(", "));
    }
    out
}

/// Names of the stages of a row's configurations, in the order of the graph.
pub(super) fn stages(row: &Row) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for times in row.cells.iter().flatten().filter_map(|c| c.times.as_ref()) {
        for stage in times.stages.keys().filter(|s| !names.contains(s)).cloned().collect::<Vec<_>>() {
            names.push(stage);
        }
    }
    names
}

pub(super) fn stage_of(configuration: &Configuration, stage: &str) -> Option<Spread> {
    configuration.times.as_ref()?.stages.get(stage).copied()
}

fn total(configuration: &Configuration) -> Option<Spread> {
    Some(configuration.times.as_ref()?.stats.total_gpu_ms)
}

fn cell(spread: Spread) -> Option<String> {
    Some(format!("{:.3} ({:.3})", spread.median, spread.p95))
}

fn ratio(first: &Configuration, other: &Configuration) -> Option<String> {
    let (a, b) = (&first.times.as_ref()?.rounds, &other.times.as_ref()?.rounds);
    let ratios: Vec<f64> = a.iter().zip(b).filter(|(a, _)| **a > 0.0).map(|(a, b)| b / a).collect();
    let most = ratios.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let s = crate::results::stats::spread(ratios);
    Some(format!("{:.2} ({:.2} to {:.2})", s.median, s.min, most))
}

/// One line for every pass, every stage and the total of each configuration, as comma-separated values.
///
/// # Errors
/// Writing to memory gives none, whatever the benchmark.
pub fn csv(bench: &Bench) -> Result<String, LabError> {
    let failed = |e: csv::Error| LabError::Request(format!("cannot make the table: {e}"));
    let mut out = csv::Writer::from_writer(Vec::new());
    let ends = ["experiment", "width", "height", "kind", "name", "min ms", "median ms", "p95 ms", "error"];
    let names: Vec<&String> = bench.names.iter().filter(|n| *n != "size" && *n != "experiment").collect();
    out.write_record(names.iter().map(|n| n.as_str()).chain(ends)).map_err(failed)?;
    for c in &bench.configurations {
        let labels: Vec<&str> = names.iter().map(|n| c.labels.get(*n).map_or("", String::as_str)).collect();
        let size = [c.size.0.to_string(), c.size.1.to_string()];
        let mut row = |kind: &str, name: &str, spread: Option<Spread>, error: &str| {
            let ms = spread.map_or([const { String::new() }; 3], |s| [s.min, s.median, s.p95].map(|v| v.to_string()));
            let before = [c.experiment.as_str(), &size[0], &size[1], kind, name, &ms[0], &ms[1], &ms[2], error];
            out.write_record(labels.iter().copied().chain(before)).map_err(failed)
        };
        if let Some(error) = &c.error {
            row("total", "total", None, error.lines().next().unwrap_or_default())?;
        }
        let Some(times) = &c.times else { continue };
        for pass in &times.stats.passes {
            row("pass", &pass.name, Some(pass.gpu_ms), "")?;
        }
        for (stage, spread) in &times.stages {
            row("stage", stage, Some(*spread), "")?;
        }
        row("total", "total", Some(times.stats.total_gpu_ms), "")?;
    }
    let bytes = out.into_inner().map_err(|e| LabError::Request(e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| LabError::Request(e.to_string()))
}
