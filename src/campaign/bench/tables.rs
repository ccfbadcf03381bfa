//! A benchmark as tables.

use super::{Bench, Configuration};
use crate::campaign::points::labelled;
use crate::campaign::record::first_line;
use crate::lab::LabError;
use crate::results::stats::Spread;
use crate::results::table::{Table, cell};
use indexmap::{IndexMap, IndexSet};
use std::fmt::Write;

/// Configurations that differ only in the setting of the columns.
pub(super) struct Row<'a> {
    /// Title without the size.
    pub title: String,
    pub size: (u32, u32),
    pub cells: Vec<Option<&'a Configuration>>,
}

impl Row<'_> {
    pub fn pixels(&self) -> u64 {
        u64::from(self.size.0) * u64::from(self.size.1)
    }

    fn full_title(&self) -> String {
        format!("{}x{} {}", self.size.0, self.size.1, self.title)
    }

    fn ratios(&self, first: &Row) -> Vec<Option<String>> {
        let cells = first.cells.iter().zip(&self.cells);
        cells.map(|(a, b)| ratio((*a)?, (*b)?)).collect()
    }

    fn totals(&self) -> Vec<Option<String>> {
        self.cells
            .iter()
            .map(|c| Some(shown((*c)?.times.as_ref()?.stats.total_gpu_ms)))
            .collect()
    }
}

/// Name and values of the setting that varies over the columns: the first one except size and
/// experiment.
pub(super) fn columns(bench: &Bench) -> (String, Vec<String>) {
    let name = bench
        .names
        .iter()
        .find(|n| *n != "size" && *n != "experiment")
        .cloned()
        .unwrap_or_default();
    let values: IndexSet<String> = bench
        .configurations
        .iter()
        .map(|c| cell(c.labels.get(&name)))
        .collect();
    (name, values.into_iter().collect())
}

pub(super) fn rows(bench: &Bench) -> Vec<Row<'_>> {
    let (column, values) = columns(bench);
    let varies = |name: &String| {
        let values: IndexSet<_> = bench
            .configurations
            .iter()
            .map(|c| c.labels.get(name))
            .collect();
        values.len() > 1
    };
    type Cells<'a> = Vec<Option<&'a Configuration>>;
    let mut rows: IndexMap<(String, (u32, u32)), Cells> = IndexMap::new();
    for c in &bench.configurations {
        let title = labelled(
            c.labels
                .iter()
                .filter(|(n, _)| **n != column && *n != "size" && varies(n)),
        );
        let title = if title.is_empty() {
            c.experiment.clone()
        } else {
            title
        };
        let cells = rows
            .entry((title, c.size))
            .or_insert_with(|| vec![None; values.len()]);
        if let Some(at) = values
            .iter()
            .position(|v| *v == cell(c.labels.get(&column)))
        {
            cells[at] = Some(c);
        }
    }
    rows.into_iter()
        .map(|((title, size), cells)| Row { title, size, cells })
        .collect()
}

/// Title and cells of a printed line.
type Line = (String, Vec<Option<String>>);

/// Printed tables: stages of each configuration at the largest size, totals by size, and ratios of
/// totals to the first row of the same size, by round.
pub fn text(bench: &Bench) -> String {
    let (column, values) = columns(bench);
    let rows = rows(bench);
    let mut out = format!(
        "{} ({}), {} rounds of {} frames after at least {} of warm-up; GPU ms, median (95 %)\n",
        bench.device.name,
        bench.device.driver,
        bench.rounds,
        bench.frames.count,
        bench.frames.warmup
    );
    let last = rows.iter().map(Row::pixels).max().unwrap_or(0);
    let mut add = |title: String, lines: &[Line]| {
        let mut table = Table::new(lines);
        table.column(&column, |l| l.0.clone());
        for (i, value) in values.iter().enumerate() {
            table.column(value, |l| l.1[i].clone().unwrap_or("-".into()));
        }
        let _ = write!(out, "\n{title}\n{}", table.text());
    };
    for row in rows.iter().filter(|r| r.pixels() == last) {
        let stage = |stage: String| {
            let cell = |c: &Option<&Configuration>| Some(shown(stage_of((*c)?, &stage)?));
            let cells = row.cells.iter().map(cell).collect();
            (stage, cells)
        };
        let mut lines: Vec<Line> = stages(row).into_iter().map(stage).collect();
        lines.push(("total".into(), row.totals()));
        add(
            format!("{} at {}x{}", row.title, row.size.0, row.size.1),
            &lines,
        );
    }
    let totals: Vec<Line> = rows.iter().map(|r| (r.full_title(), r.totals())).collect();
    add("total".into(), &totals);
    let compared: Vec<Line> = rows
        .iter()
        .filter_map(|row| Some((rows.iter().find(|r| r.size == row.size)?, row)))
        .filter(|(first, row)| first.title != row.title)
        .map(|(first, row)| (row.full_title(), row.ratios(first)))
        .collect();
    if !compared.is_empty() {
        let title = "total divided by the total of the first row of that size: median of the rounds \
                     (minimum to maximum)";
        add(title.into(), &compared);
    }
    for failed in bench.configurations.iter().filter(|c| c.error.is_some()) {
        let error = failed.error.as_deref().map_or("", first_line);
        let _ = writeln!(out, "failed: {}: {error}", labelled(&failed.labels));
    }
    out
}

/// Names of the stages of a row's configurations, in the order of the graph.
pub(super) fn stages(row: &Row) -> IndexSet<String> {
    let times = row.cells.iter().flatten().filter_map(|c| c.times.as_ref());
    times.flat_map(|t| t.stages.keys()).cloned().collect()
}

pub(super) fn stage_of(configuration: &Configuration, stage: &str) -> Option<Spread> {
    configuration.times.as_ref()?.stages.get(stage).copied()
}

fn shown(spread: Spread) -> String {
    format!("{:.3} ({:.3})", spread.median, spread.p95)
}

fn ratio(first: &Configuration, other: &Configuration) -> Option<String> {
    let (a, b) = (&first.times.as_ref()?.rounds, &other.times.as_ref()?.rounds);
    let ratios: Vec<f64> = a
        .iter()
        .zip(b)
        .filter(|(a, _)| **a > 0.0)
        .map(|(a, b)| b / a)
        .collect();
    let most = ratios.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let s = crate::results::stats::spread(ratios);
    Some(format!("{:.2} ({:.2} to {:.2})", s.median, s.min, most))
}

/// One line for every pass, every stage and the total of each configuration, as comma-separated
/// values.
pub fn csv(bench: &Bench) -> Result<String, LabError> {
    let mut rows: Vec<(&Configuration, &str, &str, Option<Spread>)> = Vec::new();
    for c in &bench.configurations {
        if c.error.is_some() {
            rows.push((c, "total", "total", None));
        }
        let Some(times) = &c.times else { continue };
        rows.extend(
            times
                .stats
                .passes
                .iter()
                .map(|p| (c, "pass", p.name.as_str(), Some(p.gpu_ms))),
        );
        rows.extend(
            times
                .stages
                .iter()
                .map(|(stage, spread)| (c, "stage", stage.as_str(), Some(*spread))),
        );
        rows.push((c, "total", "total", Some(times.stats.total_gpu_ms)));
    }
    let mut table = Table::new(&rows);
    for name in bench
        .names
        .iter()
        .filter(|n| *n != "size" && *n != "experiment")
    {
        table.column(name, |r| cell(r.0.labels.get(name)));
    }
    table.column("experiment", |r| r.0.experiment.clone());
    table.column("width", |r| r.0.size.0.to_string());
    table.column("height", |r| r.0.size.1.to_string());
    table.column("kind", |r| r.1.to_string());
    table.column("name", |r| r.2.to_string());
    table.column("min ms", |r| cell(r.3.map(|s| s.min)));
    table.column("median ms", |r| cell(r.3.map(|s| s.median)));
    table.column("p95 ms", |r| cell(r.3.map(|s| s.p95)));
    table.column("error", |r| cell(r.0.error.as_deref().map(first_line)));
    table.csv()
}
