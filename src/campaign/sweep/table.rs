//! A sweep as a table.

use super::record::{Collected, ManifestPoint, PointRecord};
use crate::lab::LabError;
use crate::measure::Point;
use crate::metrics::METRICS;
use crate::results::stats::Stats;
use crate::results::table::{Table, cell};
use indexmap::IndexSet;
use std::collections::{BTreeMap, BTreeSet};

/// Scores of a point, by part and metric.
pub fn parts_of(point: &Point) -> BTreeMap<String, BTreeMap<String, f64>> {
    point
        .scores
        .iter()
        .map(|(part, scores)| (part.clone(), scores.numbers()))
        .collect()
}

/// Scores of a point with the noise of the reference, `METRIC noise`.
fn columns_of(point: &Point) -> BTreeMap<String, BTreeMap<String, f64>> {
    let mut parts = parts_of(point);
    for (part, numbers) in &mut parts {
        let noise = point.noise_of(part);
        for metric in METRICS {
            let value = metric.noise.as_ref().map(|of| (of.of)(noise));
            if let Some(value) = value.filter(|v| v.is_finite()) {
                numbers.insert(format!("{} noise", metric.key), value);
            }
        }
    }
    parts
}

/// A line of the table.
struct Row<'c> {
    planned: &'c ManifestPoint,
    record: Option<&'c PointRecord>,
    parts: BTreeMap<String, BTreeMap<String, f64>>,
}

impl<'c> Row<'c> {
    fn new((planned, record): &'c (ManifestPoint, Option<PointRecord>)) -> Row<'c> {
        let record = record.as_ref();
        Row {
            planned,
            record,
            parts: record
                .and_then(|r| r.done())
                .map(columns_of)
                .unwrap_or_default(),
        }
    }

    fn point(&self) -> Option<&Point> {
        self.record?.done()
    }
}

/// For each point with bit-identical scores to an earlier one against the same reference, the id of the first: the
/// settings that differ do not change the picture.
fn same_scores<'c>(rows: &[Row<'c>]) -> BTreeMap<&'c str, &'c str> {
    let mut first = BTreeMap::new();
    let mut same = BTreeMap::new();
    for row in rows {
        let Some(point) = row.point().filter(|p| !p.scores.is_empty()) else {
            continue;
        };
        let bits: Vec<u64> = row
            .parts
            .values()
            .flat_map(|m| m.values())
            .map(|v| v.to_bits())
            .collect();
        let key = (&point.stats.scene, &point.references, bits);
        match first.get(&key) {
            Some(id) => {
                same.insert(row.planned.id.as_str(), *id);
            }
            None => {
                first.insert(key, row.planned.id.as_str());
            }
        }
    }
    same
}

/// Comma-separated values (RFC 4180), a line for each point in order. Columns that end in ` ms` are
/// times and differ between runs. All others are the same on one device.
pub fn csv(collected: &Collected) -> Result<String, LabError> {
    let rows: Vec<Row> = collected.points.iter().map(Row::new).collect();
    let points = rows.iter().filter_map(Row::point);
    let passes: IndexSet<&str> = points
        .flat_map(|p| &p.stats.passes)
        .map(|p| p.name.as_str())
        .collect();
    let parts = rows.iter().flat_map(|r| &r.parts);
    let scores: BTreeSet<(&str, &str)> = parts
        .flat_map(|(part, m)| m.keys().map(|m| (part.as_str(), m.as_str())))
        .collect();
    let references: BTreeSet<u32> = rows
        .iter()
        .filter_map(Row::point)
        .flat_map(|p| p.references.keys().copied())
        .collect();
    let same = same_scores(&rows);
    let mut table = Table::new(&rows);
    table.column("id", |r| r.planned.id.clone());
    table.column("outcome", |r| {
        let done = r.record.map(|r| r.done().is_some());
        done.map_or("left", |done| if done { "done" } else { "failed" })
            .into()
    });
    for name in &collected.names {
        table.column(name, |r| cell(r.planned.labels.get(name)));
    }
    let of = |value: fn(&Stats) -> String| {
        move |r: &Row| r.point().map(|p| value(&p.stats)).unwrap_or_default()
    };
    // An axis of that name has the values that were asked for.
    for (name, value) in [
        ("experiment", of(|s: &Stats| s.experiment.clone())),
        ("graph", of(|s| s.graph.clone())),
        ("scene", of(|s| s.scene.clone())),
    ] {
        if !collected.names.iter().any(|n| n == name) {
            table.column(name, value);
        }
    }
    table.column("width", of(|s| s.size[0].to_string()));
    table.column("height", of(|s| s.size[1].to_string()));
    table.column("device", |r| cell(r.record.map(|r| &r.device.name)));
    table.column("driver", |r| cell(r.record.map(|r| &r.device.driver)));
    table.column("bytes", of(|s| s.total_bytes.to_string()));
    table.column("warnings", of(|s| s.warnings.join("; ")));
    for bounces in references {
        table.column(format!("reference samples, {bounces} bounces"), |r| {
            cell(r.point().and_then(|p| p.references.get(&bounces)))
        });
    }
    table.column("same scores as", |r| cell(same.get(r.planned.id.as_str())));
    table.column("error", |r| cell(r.record.and_then(|r| r.error())));
    table.column("total median ms", of(|s| s.total_gpu_ms.median.to_string()));
    table.column("total p95 ms", of(|s| s.total_gpu_ms.p95.to_string()));
    table.column("total min ms", of(|s| s.total_gpu_ms.min.to_string()));
    for (part, metric) in scores {
        table.column(format!("{part} {metric}"), |r| {
            cell(r.parts.get(part).and_then(|p| p.get(metric)))
        });
    }
    for name in passes {
        table.column(format!("{name} ms"), |r| {
            let pass = r
                .point()
                .and_then(|p| p.stats.passes.iter().find(|p| p.name == name));
            cell(pass.map(|p| p.gpu_ms.median))
        });
    }
    table.csv()
}
