//! Tables for terminals, documents, pages and CSV files.

use crate::lab::LabError;
use maud::{Markup, html};
use std::collections::HashSet;
use std::error::Error;
use std::fmt::Display;

/// A table that is built column by column.
pub struct Table<'r, R> {
    rows: &'r [R],
    columns: Vec<Column>,
}

struct Column {
    title: String,
    /// Text of each row, with its class on pages.
    cells: Vec<(String, Option<&'static str>)>,
}

impl Column {
    /// Title and cells, padded to one width.
    fn padded(&self, right: bool, edit: impl Fn(&str) -> String) -> Vec<String> {
        let cells = self.cells.iter().map(|c| c.0.as_str());
        let texts: Vec<String> = std::iter::once(self.title.as_str())
            .chain(cells)
            .map(edit)
            .collect();
        let width = texts.iter().map(|t| t.chars().count()).max().unwrap_or(0);
        let pad = |text| match right {
            true => format!("{text:>width$}"),
            false => format!("{text:width$}"),
        };
        texts.iter().map(pad).collect()
    }

    fn is_numeric(&self) -> bool {
        let number = |c: char| c.is_ascii_digit() || "+-(".contains(c);
        self.cells.iter().any(|c| c.0.starts_with(number))
    }
}

impl<'r, R> Table<'r, R> {
    pub fn new(rows: &'r [R]) -> Table<'r, R> {
        Table {
            rows,
            columns: Vec::new(),
        }
    }

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

    /// Removes columns without any text.
    pub fn without_empty(mut self) -> Table<'r, R> {
        self.columns
            .retain(|c| c.cells.iter().any(|cell| !cell.0.is_empty()));
        self
    }

    /// Aligned text for terminals. Numbers are aligned to the right, except in the first column.
    pub fn text(&self) -> String {
        let columns: Vec<Vec<String>> = self
            .columns
            .iter()
            .enumerate()
            .map(|(i, column)| column.padded(i > 0 && column.is_numeric(), str::to_string))
            .collect();
        let line = |row: usize| {
            let cells: Vec<&str> = columns.iter().map(|c| c[row].as_str()).collect();
            format!("{}\n", cells.join("  ").trim_end())
        };
        (0..=self.rows.len()).map(line).collect()
    }

    /// Markdown, aligned for terminals too.
    pub fn markdown(&self) -> String {
        let columns: Vec<Vec<String>> = self
            .columns
            .iter()
            .map(|column| column.padded(false, |t| t.replace('|', "\\|")))
            .collect();
        let mut out = String::new();
        for row in 0..=self.rows.len() {
            out.extend(columns.iter().map(|c| format!("| {} ", c[row])));
            out += "|\n";
            if row == 0 {
                let rule = |c: &Vec<String>| format!("|{}", "-".repeat(c[0].chars().count() + 2));
                out.extend(columns.iter().map(rule));
                out += "|\n";
            }
        }
        out
    }

    /// Comma-separated values (RFC 4180).
    ///
    /// # Errors
    /// Two columns of one name: readers would take one for the other.
    pub fn csv(&self) -> Result<String, LabError> {
        self.records().map_err(LabError::making("the table"))
    }

    fn records(&self) -> Result<String, Box<dyn Error>> {
        let mut titles = HashSet::new();
        if let Some(column) = self.columns.iter().find(|c| !titles.insert(&c.title)) {
            return Err(format!("two columns are called '{}'", column.title).into());
        }
        let mut out = csv::Writer::from_writer(Vec::new());
        out.write_record(self.columns.iter().map(|c| &c.title))?;
        for i in 0..self.rows.len() {
            out.write_record(self.columns.iter().map(|c| &c.cells[i].0))?;
        }
        Ok(String::from_utf8(out.into_inner()?)?)
    }

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

/// The value as text, empty without one.
pub fn cell(value: Option<impl Display>) -> String {
    value.map_or(String::new(), |v| v.to_string())
}

/// The value as text, empty if it is not finite.
pub fn number(value: Option<f64>) -> String {
    cell(value.filter(|v| v.is_finite()))
}

/// The value with at most three digits, empty if it is not finite.
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

/// A number with four digits; `-` if it is not finite.
pub fn four_digits(v: f64) -> String {
    match v.abs() {
        a if a.is_nan() => "-".into(),
        0.0 => "0".into(),
        a if !(1e-3..1e4).contains(&a) => format!("{v:.2e}"),
        a if a < 10.0 => format!("{v:.4}"),
        a if a < 1000.0 => format!("{v:.2}"),
        _ => format!("{v:.0}"),
    }
}
