//! The rows as text: Markdown that is aligned for terminals too, and comma-separated values.

use super::row::{Delta, Row};
use crate::lab::LabError;
use crate::metrics::{Best, Metric};
use crate::results::table::{Table, short};
use indexmap::IndexSet;

/// The tables as Markdown: costs and verdicts, then the errors of each part.
pub fn markdown(rows: &[Row]) -> String {
    let mut out = verdicts(rows);
    let parts: IndexSet<&str> = rows
        .iter()
        .flat_map(|r| &r.errors)
        .map(|e| e.part.as_str())
        .collect();
    for table in parts.iter().filter_map(|part| errors(rows, part)) {
        out += "\n";
        out += &table;
    }
    out
}

fn verdicts(rows: &[Row]) -> String {
    let named = |row: &Row, sign: i8| {
        let errors = row.errors.iter().filter(|e| e.delta.sign() == sign);
        let names: Vec<String> = errors
            .map(|e| format!("{} {}", e.part, e.metric.short()))
            .collect();
        names.join(", ")
    };
    let cost = |delta: &Option<Delta>| match delta {
        Some(d) => percent(d.change, d.noise),
        None => "-".into(),
    };
    let mut table = Table::new(rows);
    table.column("parameter", |r| r.change.name.clone());
    table.column("is", |r| r.change.from.to_string());
    table.column("plain", |r| r.change.to.to_string());
    table.column("time", |r| cost(&r.ms));
    table.column("memory", |r| cost(&r.bytes));
    table.column("larger", |r| named(r, 1));
    table.column("smaller", |r| named(r, -1));
    table.column("verdict", |r| {
        let failed = r
            .failed
            .iter()
            .map(|(scene, why)| format!("{scene}: {why}"));
        let all: Vec<String> = std::iter::once(r.verdict.to_string())
            .chain(failed)
            .collect();
        all.join("; ")
    });
    table.markdown()
}

/// Mean and worst change of each metric of a part. The titles have the values of the unchanged
/// experiment.
fn errors(rows: &[Row], part: &str) -> Option<String> {
    let delta = |row: &Row, metric: &Metric| {
        row.errors
            .iter()
            .find(|e| e.part == part && e.metric == metric)
            .map(|e| e.delta.clone())
    };
    let unchanged = |m| Some((m, rows.iter().find_map(|r| delta(r, m))?));
    let metrics: Vec<(&Metric, Delta)> = Metric::few().filter_map(unchanged).collect();
    let mut table = Table::new(rows);
    table.column(part, |r| r.change.name.clone());
    for (metric, own) in &metrics {
        let (value, noise) = (short(own.unchanged), noise(metric, own.noise));
        table.column(format!("{} {value}, noise {noise}", metric.short()), |r| {
            delta(r, metric).map_or("-".into(), |d| growth(metric, d.change, d.noise))
        });
        table.column("worst", |r| {
            delta(r, metric).map_or("-".into(), |d| {
                let change = growth(metric, d.worst, d.worst_noise);
                format!("{change} {}", d.worst_scene)
            })
        });
    }
    (!metrics.is_empty()).then(|| table.markdown())
}

/// The change, in brackets if it does not exceed the noise.
fn growth(metric: &Metric, change: f64, noise: f64) -> String {
    match metric.best {
        Best::One => told(format!("{change:+.4}"), change, noise),
        _ => percent(change, noise),
    }
}

fn percent(change: f64, noise: f64) -> String {
    told(format!("{:+.1} %", 100.0 * change), change, noise)
}

fn told(text: String, change: f64, noise: f64) -> String {
    if change.abs() > noise {
        text
    } else {
        format!("({text})")
    }
}

fn noise(metric: &Metric, noise: f64) -> String {
    match metric.best {
        Best::One => short(noise),
        _ => format!("{:.1} %", 100.0 * noise),
    }
}

/// Comma-separated values (RFC 4180): for each parameter a line for its time, its memory and each
/// error.
pub fn csv(rows: &[Row]) -> Result<String, LabError> {
    let mut lines: Vec<(&Row, &str, &str, &Delta)> = Vec::new();
    for row in rows {
        let costs = [("ms", &row.ms), ("bytes", &row.bytes)];
        lines.extend(
            costs
                .into_iter()
                .filter_map(|(quantity, delta)| Some((row, "", quantity, delta.as_ref()?))),
        );
        lines.extend(
            row.errors
                .iter()
                .map(|e| (row, e.part.as_str(), e.metric.key, &e.delta)),
        );
    }
    let mut table = Table::new(&lines);
    table.column("parameter", |l| l.0.change.name.clone());
    table.column("is", |l| l.0.change.from.to_string());
    table.column("plain", |l| l.0.change.to.to_string());
    table.column("verdict", |l| l.0.verdict.to_string());
    table.column("part", |l| l.1.to_string());
    table.column("quantity", |l| l.2.to_string());
    table.column("unchanged", |l| l.3.unchanged.to_string());
    table.column("change", |l| l.3.change.to_string());
    table.column("noise", |l| l.3.noise.to_string());
    table.column("worst change", |l| l.3.worst.to_string());
    table.column("its noise", |l| l.3.worst_noise.to_string());
    table.column("worst scene", |l| l.3.worst_scene.clone());
    table.csv()
}
