//! Table with one row per scene, worst first: pictures and errors of every method.

use super::data::{Data, Dot};
use crate::campaign::page::url;
use crate::campaign::points::labelled;
use crate::campaign::record::first_line;
use crate::campaign::sweep::Subject;
use crate::lab::LabError;
use crate::metrics::{Metric, Noise};
use crate::results::table::{Table, cell, number, short};
use indexmap::{IndexMap, IndexSet};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// Settings that distinguish rows. All others distinguish methods.
const OF_A_ROW: [&str; 4] = ["scene", "camera", "size", "time"];
/// Largest number of methods in a row. If there are more, the first of each graph is shown.
const MAX_METHODS: usize = 12;
/// Numbers of a part, by metric.
type Scores = BTreeMap<String, f64>;
/// Metric that sorts the rows.
const WORST: &str = "flip";

pub struct Scenes {
    methods: Vec<String>,
    rows: Vec<Row>,
}

/// A scene, or another view of one.
struct Row {
    key: (Subject, String),
    cells: Vec<Cell>,
}

/// Result of one method.
#[derive(Clone)]
enum Cell {
    /// Index of the dot.
    Measured(usize),
    Failed(String),
    Left,
}

/// The first method of each graph, in order.
fn first_of_each_graph(all: &[((Subject, String), String, Cell)], data: &Data) -> Vec<String> {
    let mut first: IndexMap<&str, &String> = IndexMap::new();
    for (_, method, cell) in all {
        if let Cell::Measured(i) = cell {
            first.entry(&data.dots[*i].graph).or_insert(method);
        }
    }
    first.into_values().cloned().collect()
}

impl Scenes {
    /// `None` with fewer than two scenes.
    pub fn of(data: &Data) -> Option<Scenes> {
        let names: Vec<&String> = data
            .names
            .iter()
            .filter(|n| !OF_A_ROW.contains(&n.as_str()))
            .collect();
        let method = |labels: &IndexMap<String, String>| {
            labelled(names.iter().filter_map(|n| Some((*n, labels.get(*n)?))))
        };
        let measured = data.dots.iter().enumerate().map(|(i, dot)| {
            let key = data.keys[dot.subject].clone();
            (key, method(&dot.labels), Cell::Measured(i))
        });
        let failed = data.failed.iter().map(|f| {
            (
                f.key.clone(),
                method(&f.labels),
                Cell::Failed(f.error.clone()),
            )
        });
        let all: Vec<_> = measured.chain(failed).collect();
        let methods: IndexSet<String> = all.iter().map(|a| a.1.clone()).collect();
        let mut methods: Vec<String> = methods.into_iter().collect();
        if methods.len() > MAX_METHODS {
            methods = first_of_each_graph(&all, data);
        }
        methods.truncate(MAX_METHODS);
        let mut rows: IndexMap<(Subject, String), Vec<Cell>> = IndexMap::new();
        for (key, method, cell) in all {
            let Some(column) = methods.iter().position(|m| *m == method) else {
                continue;
            };
            rows.entry(key)
                .or_insert_with(|| vec![Cell::Left; methods.len()])[column] = cell;
        }
        let mut rows: Vec<Row> = rows
            .into_iter()
            .map(|(key, cells)| Row { key, cells })
            .collect();
        let several = rows.iter().any(|r| r.key.0.scene != rows[0].key.0.scene);
        // Stable sort: scenes without a score of the first method come last, in the order of the
        // sweep.
        rows.sort_by(|a, b| match (a.worst(data), b.worst(data)) {
            (Some(a), Some(b)) => b.total_cmp(&a),
            (a, b) => b.is_some().cmp(&a.is_some()),
        });
        several.then_some(Scenes { methods, rows })
    }

    /// Section of the page. The script inserts pictures from the points' data.
    pub fn html(&self, data: &Data) -> Markup {
        html! {
            h2 { "Scenes" }
            p {
                "Worst first, by FLIP of the total of the first method. Beside each picture is where its light differs from \
                 the reference: black at 0 to white at 1, relative."
            }
            div.wide {
                table id="scenes" {
                    thead {
                        tr {
                            th { "scene" }
                            th { "reference" }
                            @for method in &self.methods { th { (method) } }
                        }
                    }
                    tbody { @for row in &self.rows { (row.html(data)) } }
                }
            }
        }
    }

    /// As comma-separated values (RFC 4180), a line for each scene, method and number of bounces.
    pub fn csv(&self, data: &Data) -> Result<String, LabError> {
        let mut lines: Vec<Line> = Vec::new();
        for row in &self.rows {
            for (method, cell) in self.methods.iter().zip(&row.cells) {
                let line = |(bounces, scores, noise)| Line {
                    row,
                    method,
                    cell,
                    bounces,
                    scores,
                    noise,
                };
                match cell {
                    Cell::Measured(i) => {
                        lines.extend(scores(data, &data.dots[*i]).into_iter().map(line))
                    }
                    Cell::Failed(_) => lines.push(line((String::new(), None, None))),
                    Cell::Left => {}
                }
            }
        }
        let mut table = Table::new(&lines);
        table.column("scene", |l| l.row.key.0.scene.clone());
        table.column("camera", |l| l.row.key.0.camera.clone());
        table.column("width", |l| l.row.key.0.size.0.to_string());
        table.column("height", |l| l.row.key.0.size.1.to_string());
        table.column("method", |l| l.method.to_string());
        table.column("bounces", |l| l.bounces.clone());
        for metric in Metric::few() {
            table.column(metric.key, |l| {
                cell(l.scores.and_then(|s| s.get(metric.key)))
            });
            if let Some(of) = &metric.noise {
                table.column(format!("{} noise", metric.key), |l| {
                    number(l.noise.map(of.of))
                });
            }
        }
        table.column("median ms", |l| match l.cell {
            Cell::Measured(i) => data.dots[*i].ms.to_string(),
            _ => String::new(),
        });
        table.column("error", |l| match l.cell {
            Cell::Failed(error) => first_line(error).to_string(),
            _ => String::new(),
        });
        table.csv()
    }
}

/// A line of the comma-separated values.
struct Line<'s> {
    row: &'s Row,
    method: &'s str,
    cell: &'s Cell,
    bounces: String,
    scores: Option<&'s Scores>,
    /// Noise of the reference.
    noise: Option<Noise>,
}

impl Row {
    fn html(&self, data: &Data) -> Markup {
        let (subject, device) = &self.key;
        let about = format!(
            "camera {}, time {} s, {device}",
            subject.camera, subject.time
        );
        let reference = data
            .keys
            .iter()
            .position(|k| *k == self.key)
            .and_then(|s| data.references[s].as_ref());
        html! {
            tr {
                th title=(about) { (subject.scene) br; small { (subject.size.0) "x" (subject.size.1) } }
                td { @if let Some(bytes) = reference { img alt="reference" src=(url("image/jpeg", bytes)); } }
                @for cell in &self.cells { td { (cell.html(data)) } }
            }
        }
    }

    /// Sort key: FLIP of the first method's total against the reference with most bounces.
    fn worst(&self, data: &Data) -> Option<f64> {
        match self.cells.first()? {
            Cell::Measured(i) => scores(data, &data.dots[*i]).first()?.1?.get(WORST).copied(),
            _ => None,
        }
    }
}

impl Cell {
    fn html(&self, data: &Data) -> Markup {
        let i = match self {
            Cell::Measured(i) => *i,
            Cell::Failed(error) => return html! { p { "failed: " (first_line(error)) } },
            Cell::Left => return html! { "not measured yet" },
        };
        let number = |v: Option<&f64>| v.map_or("no number".into(), |v| short(*v));
        html! {
            img alt="picture" data-dot=(i) data-kind="picture";
            img alt="error" data-dot=(i) data-kind="error_map";
            table {
                tr { th { "bounces" } @for metric in Metric::few() { th { (metric.short()) } } }
                @for (bounces, values, _) in scores(data, &data.dots[i]) {
                    tr {
                        td { (bounces) }
                        @for metric in Metric::few() { td { (number(values.and_then(|v| v.get(metric.key)))) } }
                    }
                }
            }
            (short(data.dots[i].ms)) " ms"
        }
    }
}

/// Bounces of a reference, scores against it, and its noise.
type Scored<'d> = (String, Option<&'d Scores>, Option<Noise>);

/// Scores of a point's total by the bounces of the reference, most first.
fn scores<'d>(data: &Data, dot: &'d Dot) -> Vec<Scored<'d>> {
    let mut list: Vec<(u32, &Scores, Option<Noise>)> = Vec::new();
    for (part, scores) in &dot.scores {
        // All parts are scored against the first reference. Other scores of the total name theirs.
        let bounces = match part.as_str() {
            "total" => data.bounces[dot.subject],
            _ => part
                .strip_prefix("total, ")
                .and_then(|rest| rest.strip_suffix(" bounces")?.parse().ok()),
        };
        list.extend(bounces.map(|b| (b, scores, dot.noise.get(part).copied())));
    }
    list.sort_by_key(|s| std::cmp::Reverse(s.0));
    list.into_iter()
        .map(|(bounces, scores, noise)| (bounces.to_string(), Some(scores), noise))
        .collect()
}
