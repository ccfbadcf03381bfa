//! A table with one row for each scene, worst first: what every method shows of it, and how far that is from the
//! reference.

use super::data::{Data, Dot};
use super::page::{escaped, url};
use super::scatter::short;
use crate::campaign::sweep::{Subject, csv_text};
use crate::lab::LabError;
use std::fmt::Write;

/// What tells rows apart; everything else that is varied tells methods apart.
const OF_A_ROW: [&str; 4] = ["scene", "camera", "size", "time"];
/// Most methods beside each other.
const MAX_METHODS: usize = 12;
/// Scores in the table: title and metric.
const SCORES: [(&str, &str); 3] = [("energy", "energy_ratio"), ("relMSE", "relmse"), ("FLIP", "flip")];

/// The table.
pub struct Scenes {
    methods: Vec<String>,
    rows: Vec<Row>,
}

/// A scene, or another view of one.
struct Row {
    /// What is looked at, and the device's name.
    key: (Subject, String),
    /// By method.
    cells: Vec<Cell>,
}

/// What one method did there.
#[derive(Clone)]
enum Cell {
    /// Number of the dot.
    Measured(usize),
    Failed(String),
    /// Not finished.
    Left,
}

impl Scenes {
    /// None where there are not several scenes.
    pub fn of(data: &Data) -> Option<Scenes> {
        let names: Vec<&String> = data.names.iter().filter(|n| !OF_A_ROW.contains(&n.as_str())).collect();
        let method = |labels: &indexmap::IndexMap<String, String>| {
            let values = names.iter().filter_map(|n| Some((n.as_str(), labels.get(*n)?)));
            let text = values.map(|(n, v)| if n == "experiment" { v.clone() } else { format!("{n} {v}") });
            text.collect::<Vec<_>>().join(", ")
        };
        let measured = data.dots.iter().enumerate().map(|(i, dot)| {
            let key = data.keys[dot.subject].clone();
            (key, method(&dot.labels), Cell::Measured(i))
        });
        let failed = data.failed.iter().map(|f| (f.key.clone(), method(&f.labels), Cell::Failed(f.error.clone())));
        let all: Vec<_> = measured.chain(failed).collect();
        let mut methods: Vec<String> = Vec::new();
        for (_, method, _) in &all {
            if !methods.contains(method) && methods.len() < MAX_METHODS {
                methods.push(method.clone());
            }
        }
        let mut rows: Vec<Row> = Vec::new();
        for (key, method, cell) in all {
            let Some(column) = methods.iter().position(|m| *m == method) else { continue };
            let row = rows.iter().position(|r| r.key == key).unwrap_or_else(|| {
                rows.push(Row { key, cells: vec![Cell::Left; methods.len()] });
                rows.len() - 1
            });
            rows[row].cells[column] = cell;
        }
        let several = rows.iter().any(|r| r.key.0.scene != rows[0].key.0.scene);
        // Stable: scenes that the first method has no score of come last, in the order of the sweep.
        rows.sort_by(|a, b| match (a.worst(data), b.worst(data)) {
            (Some(a), Some(b)) => b.total_cmp(&a),
            (a, b) => b.is_some().cmp(&a.is_some()),
        });
        several.then_some(Scenes { methods, rows })
    }

    /// As a section of the page. Its pictures are filled in by the script, from the points' data.
    pub fn html(&self, data: &Data) -> String {
        let mut out = String::from(
            "<h2>Scenes</h2>\n<p>Worst first, by FLIP of the total of the first method. Beside each picture is where its light \
             differs from the reference: black at 0 to white at 1, relative.</p>\n\
             <div class=\"wide\"><table id=\"scenes\">\n<thead><tr><th>scene</th><th>reference</th>",
        );
        for method in &self.methods {
            let _ = write!(out, "<th>{}</th>", escaped(method));
        }
        out += "</tr></thead>\n<tbody>\n";
        for row in &self.rows {
            let (subject, device) = &row.key;
            let (width, height) = subject.size;
            let name = escaped(&subject.scene);
            let reference = data.keys.iter().position(|k| *k == row.key).and_then(|s| data.references[s].as_ref());
            let reference = reference
                .map_or(String::new(), |b| format!("<img alt=\"reference\" src=\"{}\">", url("image/jpeg", b)));
            let _ = write!(
                out,
                "<tr><th title=\"{}\">{name}<br><small>{width}x{height}</small></th><td>{reference}</td>",
                escaped(&format!("camera {}, time {} s, {device}", subject.camera, subject.time))
            );
            for cell in &row.cells {
                let _ = write!(out, "<td>{}</td>", cell.html(data));
            }
            out += "</tr>\n";
        }
        out += "</tbody></table></div>\n";
        out
    }

    /// As comma-separated values (RFC 4180), a line for each scene, method and number of bounces.
    ///
    /// # Errors
    /// Writing to memory gives none, whatever the data.
    pub fn csv(&self, data: &Data) -> Result<String, LabError> {
        let head = ["scene", "camera", "width", "height", "method", "bounces", "energy_ratio", "relmse", "flip"];
        let mut lines = vec![head.into_iter().chain(["median ms", "error"]).map(String::from).collect::<Vec<_>>()];
        for row in &self.rows {
            let subject = &row.key.0;
            for (method, cell) in self.methods.iter().zip(&row.cells) {
                let (ms, error) = match cell {
                    Cell::Measured(i) => (data.dots[*i].ms.to_string(), String::new()),
                    Cell::Failed(error) => (String::new(), first_line(error).to_string()),
                    Cell::Left => continue,
                };
                let mut scored = match cell {
                    Cell::Measured(i) => scores(data, &data.dots[*i]),
                    _ => Vec::new(),
                };
                if scored.is_empty() {
                    scored.push((String::new(), [None; 3]));
                }
                for (bounces, values) in scored {
                    let (width, height) = (subject.size.0.to_string(), subject.size.1.to_string());
                    let place = [&subject.scene, &subject.camera, &width, &height, method, &bounces].map(String::clone);
                    let values = values.map(|v| v.map_or(String::new(), |v| v.to_string()));
                    lines.push(place.into_iter().chain(values).chain([ms.clone(), error.clone()]).collect());
                }
            }
        }
        csv_text(&lines)
    }
}

impl Row {
    /// What rows are sorted by: FLIP of the total of the first method, against the reference of most bounces.
    fn worst(&self, data: &Data) -> Option<f64> {
        match self.cells.first()? {
            Cell::Measured(i) => scores(data, &data.dots[*i]).first()?.1[2],
            _ => None,
        }
    }
}

impl Cell {
    fn html(&self, data: &Data) -> String {
        let i = match self {
            Cell::Measured(i) => *i,
            Cell::Failed(error) => return format!("<p>failed: {}</p>", escaped(first_line(error))),
            Cell::Left => return "not measured yet".into(),
        };
        let mut out = String::new();
        for (kind, what) in [("picture", "picture"), ("error_map", "error")] {
            let _ = write!(out, "<img alt=\"{what}\" data-dot=\"{i}\" data-kind=\"{kind}\">");
        }
        out += "<table><tr><th>bounces</th>";
        for (title, _) in SCORES {
            let _ = write!(out, "<th>{title}</th>");
        }
        out += "</tr>";
        for (bounces, values) in scores(data, &data.dots[i]) {
            let _ = write!(out, "<tr><td>{bounces}</td>");
            for value in values {
                let _ = write!(out, "<td>{}</td>", value.map_or("no number".into(), short));
            }
            out += "</tr>";
        }
        let _ = write!(out, "</table>{} ms", short(data.dots[i].ms));
        out
    }
}

/// Scores of a point's total by the bounces of the reference, most first.
fn scores(data: &Data, dot: &Dot) -> Vec<(String, [Option<f64>; 3])> {
    let mut list: Vec<(u32, [Option<f64>; 3])> = Vec::new();
    for (part, metrics) in &dot.scores {
        // All parts are scored against the first reference; the total's other scores say against which.
        let bounces = match part.as_str() {
            "total" => data.bounces[dot.subject],
            _ => part.strip_prefix("total, ").and_then(|rest| rest.strip_suffix(" bounces")?.parse().ok()),
        };
        list.extend(bounces.map(|b| (b, SCORES.map(|(_, metric)| metrics.get(metric).copied()))));
    }
    list.sort_by_key(|s| std::cmp::Reverse(s.0));
    list.into_iter().map(|(bounces, values)| (bounces.to_string(), values)).collect()
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}
