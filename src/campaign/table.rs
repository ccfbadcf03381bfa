//! Tables: rows, and columns that say what stands in them.

use crate::lab::LabError;
use maud::{Markup, html};
use std::fmt::Display;

/// A table that is made column by column.
pub struct Table<'r, R> {
    rows: &'r [R],
    columns: Vec<Column>,
}

struct Column {
    title: String,
    /// The text of each row, with its class on pages.
    cells: Vec<(String, Option<&'static str>)>,
}

impl<'r, R> Table<'r, R> {
    /// A table of some rows, without columns.
    pub fn new(rows: &'r [R]) -> Table<'r, R> {
        Table {
            rows,
            columns: Vec::new(),
        }
    }

    /// Adds a column.
    pub fn column(&mut self, title: impl Into<String>, cell: impl Fn(&R) -> String) {
        self.marked(title, |row| (cell(row), None));
    }

    /// Adds a column whose cells have classes on pages.
    pub fn marked(
        &mut self,
        title: impl Into<String>,
        cell: impl Fn(&R) -> (String, Option<&'static str>),
    ) {
        self.columns.push(Column {
            title: title.into(),
            cells: self.rows.iter().map(cell).collect(),
        });
    }

    /// Leaves out columns in which nothing stands.
    pub fn without_empty(mut self) -> Table<'r, R> {
        self.columns
            .retain(|c| c.cells.iter().any(|cell| !cell.0.is_empty()));
        self
    }

    /// As comma-separated values (RFC 4180).
    ///
    /// # Errors
    /// Writing to memory gives none.
    pub fn csv(&self) -> Result<String, LabError> {
        let failed = |e: String| LabError::Make {
            what: "the table".into(),
            why: e,
        };
        let mut out = csv::Writer::from_writer(Vec::new());
        out.write_record(self.columns.iter().map(|c| &c.title))
            .map_err(|e| failed(e.to_string()))?;
        for i in 0..self.rows.len() {
            out.write_record(self.columns.iter().map(|c| &c.cells[i].0))
                .map_err(|e| failed(e.to_string()))?;
        }
        let bytes = out.into_inner().map_err(|e| failed(e.to_string()))?;
        String::from_utf8(bytes).map_err(|e| failed(e.to_string()))
    }

    /// For a page.
    pub fn html(&self) -> Markup {
        html! {
            div.wide {
                table {
                    tr { @for column in &self.columns { th { (column.title) } } }
                    @for i in 0..self.rows.len() {
                        tr { @for (text, class) in self.columns.iter().map(|c| &c.cells[i]) { td class=[*class] { (text) } } }
                    }
                }
            }
        }
    }
}

/// Lines of cells as Markdown, aligned for terminals too; the first is the head.
pub fn markdown(lines: &[Vec<String>]) -> String {
    let columns = lines.first().map_or(0, Vec::len);
    let width = |i: usize| {
        lines
            .iter()
            .map(|line| line[i].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut out = String::new();
    for (number, line) in lines.iter().enumerate() {
        let cells = line
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("| {:width$} ", cell.replace('|', "\\|")));
        out.extend(cells.chain(["|\n".into()]));
        if number == 0 {
            out.extend(
                widths
                    .iter()
                    .map(|width| format!("|{}", "-".repeat(width + 2)))
                    .chain(["|\n".into()]),
            );
        }
    }
    out
}

/// A cell; empty where there is nothing.
pub fn cell(value: Option<impl Display>) -> String {
    value.map_or(String::new(), |v| v.to_string())
}

/// A number that is one; empty otherwise.
pub fn number(value: Option<f64>) -> String {
    cell(value.filter(|v| v.is_finite()))
}

/// A number that is one, with at most three digits; empty otherwise.
pub fn shortly(value: Option<f64>) -> String {
    cell(value.filter(|v| v.is_finite()).map(short))
}

/// Bytes in MiB, to a hundredth.
pub fn mebibytes(bytes: u64) -> String {
    format!("{:.2}", bytes as f64 / f64::from(1 << 20))
}

/// At most three digits.
pub fn short(v: f64) -> String {
    match v {
        0.0 => "0".into(),
        _ if !(1e-3..1e4).contains(&v) => format!("{v:.0e}"),
        _ => format!("{}", format!("{v:.2e}").parse::<f64>().unwrap_or(v)),
    }
}
