//! The rows as text: Markdown that is aligned for terminals too, and comma-separated values.

use super::row::{Delta, Row};
use crate::campaign::table::{self, Table, short};
use crate::lab::LabError;
use crate::metrics::{Best, Metric};
use indexmap::IndexSet;

/// The tables as Markdown: costs and verdicts, then the errors of each part.
pub fn markdown(rows: &[Row]) -> String {
    let mut verdicts = vec![
        [
            "parameter",
            "is",
            "plain",
            "time",
            "memory",
            "larger",
            "smaller",
            "verdict",
        ]
        .map(String::from)
        .to_vec(),
    ];
    for row in rows {
        let named = |sign: i8| {
            let errors = row.errors.iter().filter(|e| e.delta.sign() == sign);
            errors
                .map(|e| format!("{} {}", e.part, e.metric.short()))
                .collect::<Vec<_>>()
                .join(", ")
        };
        let failed: Vec<String> = row
            .failed
            .iter()
            .map(|(scene, why)| format!("{scene}: {why}"))
            .collect();
        let verdict = std::iter::once(row.verdict.to_string())
            .chain(failed)
            .collect::<Vec<_>>()
            .join("; ");
        let cost = |delta: &Option<Delta>| {
            delta
                .as_ref()
                .map_or("-".into(), |d| percent(d.change, d.noise))
        };
        let (from, to) = (row.change.from.to_string(), row.change.to.to_string());
        let name = row.change.name.clone();
        verdicts.push(vec![
            name,
            from,
            to,
            cost(&row.ms),
            cost(&row.bytes),
            named(1),
            named(-1),
            verdict,
        ]);
    }
    let mut out = table::markdown(&verdicts);
    let parts: IndexSet<&str> = rows
        .iter()
        .flat_map(|r| &r.errors)
        .map(|e| e.part.as_str())
        .collect();
    for part in parts {
        let table = errors(rows, part);
        if table.len() > 1 {
            out += "\n";
            out += &table::markdown(&table);
        }
    }
    out
}

/// Mean and worst change of each metric of a part; what the experiment itself has stands in the head.
fn errors(rows: &[Row], part: &str) -> Vec<Vec<String>> {
    let delta = |row: &Row, metric: &Metric| {
        row.errors
            .iter()
            .find(|e| e.part == part && e.metric == metric)
            .map(|e| e.delta.clone())
    };
    let there: Vec<&Metric> = Metric::few()
        .filter(|m| rows.iter().any(|r| delta(r, m).is_some()))
        .collect();
    if there.is_empty() {
        return Vec::new();
    }
    let mut head = vec![part.to_string()];
    for metric in &there {
        let own = rows.iter().find_map(|r| delta(r, metric));
        let own = own.map(|d| {
            format!(
                "{} {}, noise {}",
                metric.short(),
                short(d.unchanged),
                noise(metric, d.noise)
            )
        });
        head.push(own.unwrap_or("-".into()));
        head.push("worst".into());
    }
    let mut table = vec![head];
    for row in rows {
        let mut line = vec![row.change.name.clone()];
        for metric in &there {
            let Some(delta) = delta(row, metric) else {
                line.extend(["-".into(), "-".into()]);
                continue;
            };
            line.push(growth(metric, delta.change, delta.noise));
            line.push(format!(
                "{} {}",
                growth(metric, delta.worst, delta.worst_noise),
                delta.worst_scene
            ));
        }
        table.push(line);
    }
    table
}

/// What is not told from noise stands in brackets.
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

/// Comma-separated values (RFC 4180): for each parameter a line for its time, its memory and each error.
///
/// # Errors
/// Writing to memory gives none.
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
