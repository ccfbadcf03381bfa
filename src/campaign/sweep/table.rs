//! A sweep as a table.

use super::record::{Collected, Outcome, Record};
use crate::lab::LabError;
use crate::measure::Point;
use crate::metrics::Scores;
use std::collections::BTreeMap;

/// Scores of a point, by part and metric.
pub fn parts_of(point: &Point) -> BTreeMap<String, BTreeMap<String, f64>> {
    point.scores.iter().map(|(part, scores)| (part.clone(), numbers(scores))).collect()
}

/// Scores by metric, without those that are no number.
pub fn numbers(scores: &Scores) -> BTreeMap<String, f64> {
    match serde_json::to_value(scores) {
        Ok(serde_json::Value::Object(map)) => map.into_iter().filter_map(|(k, v)| Some((k, v.as_f64()?))).collect(),
        _ => BTreeMap::new(),
    }
}

/// Comma-separated values (RFC 4180), a line for each point in the order of the list. Columns that end in ` ms` are
/// times and differ from run to run; everything else is the same on one device.
///
/// # Errors
/// Writing to memory gives none, whatever the sweep.
pub fn csv(collected: &Collected) -> Result<String, LabError> {
    let records: Vec<Option<&Record>> = collected.points.iter().map(|p| p.1.as_ref()).collect();
    let points: Vec<&Point> = records.iter().flatten().filter_map(|r| done(r)).collect();
    let mut stages: Vec<String> = Vec::new();
    let mut scores: Vec<(String, String)> = Vec::new();
    for point in &points {
        for pass in point.stats.passes.iter().filter(|p| !stages.contains(&p.name)).collect::<Vec<_>>() {
            stages.push(pass.name.clone());
        }
        for (part, metrics) in parts_of(point) {
            scores.extend(metrics.into_keys().map(|m| (part.clone(), m)));
        }
        scores.sort();
        scores.dedup();
    }
    let mut header: Vec<String> = vec!["id".into(), "outcome".into()];
    header.extend(collected.names.iter().cloned());
    header.extend(["graph", "scene", "width", "height", "device", "driver", "bytes", "warnings"].map(String::from));
    header.extend(["reference samples", "error", "total median ms", "total p95 ms", "total min ms"].map(String::from));
    header.extend(scores.iter().map(|(part, metric)| format!("{part} {metric}")));
    header.extend(stages.iter().map(|s| format!("{s} ms")));
    let mut lines = vec![header];
    for ((planned, _), record) in collected.points.iter().zip(&records) {
        let point = record.and_then(done);
        let error = record.and_then(|r| match &r.outcome {
            Outcome::Failed(e) => e.lines().next(),
            Outcome::Done(_) => None,
        });
        let outcome = match (point, error) {
            (Some(_), _) => "done",
            (None, Some(_)) => "failed",
            (None, None) => "left",
        };
        let mut row: Vec<String> = vec![planned.id.clone(), outcome.into()];
        row.extend(collected.names.iter().map(|n| planned.labels.get(n).cloned().unwrap_or_default()));
        let stats = point.map(|p| &p.stats);
        let text = |f: &dyn Fn(&crate::results::stats::Stats) -> String| stats.map(f).unwrap_or_default();
        row.push(text(&|s| s.graph.clone()));
        row.push(text(&|s| s.scene.clone()));
        row.push(text(&|s| s.size[0].to_string()));
        row.push(text(&|s| s.size[1].to_string()));
        row.push(record.map_or(String::new(), |r| r.device.name.clone()));
        row.push(record.map_or(String::new(), |r| r.device.driver.clone()));
        row.push(text(&|s| s.total_bytes.to_string()));
        row.push(text(&|s| s.warnings.join("; ")));
        let samples = point.iter().flat_map(|p| &p.references).map(|(bounces, n)| format!("{bounces} bounces: {n}"));
        row.push(samples.collect::<Vec<_>>().join("; "));
        row.push(error.unwrap_or_default().to_string());
        row.push(text(&|s| s.total_gpu_ms.median.to_string()));
        row.push(text(&|s| s.total_gpu_ms.p95.to_string()));
        row.push(text(&|s| s.total_gpu_ms.min.to_string()));
        let parts = point.map(parts_of).unwrap_or_default();
        let score = |(part, metric): &(String, String)| parts.get(part).and_then(|p| p.get(metric));
        row.extend(scores.iter().map(|s| score(s).map_or(String::new(), f64::to_string)));
        let pass = |name: &String| stats.and_then(|s| s.passes.iter().find(|p| p.name == *name));
        row.extend(stages.iter().map(|s| pass(s).map_or(String::new(), |p| p.gpu_ms.median.to_string())));
        lines.push(row);
    }
    csv_text(&lines)
}

/// Lines of cells as comma-separated values (RFC 4180).
///
/// # Errors
/// Lines of different lengths.
pub(crate) fn csv_text(lines: &[Vec<String>]) -> Result<String, LabError> {
    let failed = |e: String| LabError::Request(format!("cannot make the table: {e}"));
    let mut out = csv::Writer::from_writer(Vec::new());
    lines.iter().try_for_each(|l| out.write_record(l)).map_err(|e| failed(e.to_string()))?;
    let bytes = out.into_inner().map_err(|e| failed(e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| failed(e.to_string()))
}

fn done(record: &Record) -> Option<&Point> {
    match &record.outcome {
        Outcome::Done(point) => Some(point),
        Outcome::Failed(_) => None,
    }
}
