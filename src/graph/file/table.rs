//! Buffers as tables for people: a graph names rows and columns, or says where they lie.

use super::resource::Path;
use crate::diagnostics::{At, Items, Loc};
use serde::Deserialize;
use std::collections::HashSet;

/// A buffer whose content may be read as a table, as it stands in a graph file: by names of members, or by bytes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableDecl {
    /// The array whose elements are the rows, `buffer.member`; or, by bytes, `buffer`, `start` and `stride`.
    pub list: Option<Loc<Path>>,
    /// The buffer.
    pub buffer: Option<Loc<String>>,
    /// What holds the number of rows.
    pub rows: Loc<RowCount>,
    /// Byte where the first row begins.
    pub start: Option<u32>,
    /// Bytes from one row to the next.
    pub stride: Option<u32>,
    /// Heading, unique in the graph.
    pub title: String,
    /// One line.
    pub help: String,
    /// Columns in the order shown.
    pub columns: Items<ColumnDecl>,
}

/// What holds the number of rows of a table.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum RowCount {
    /// The 32-bit word of that index.
    Word(u32),
    /// A member.
    Field(Path),
}

/// A column of a table, as it stands in a graph file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColumnDecl {
    /// Heading, unique in the table.
    pub name: String,
    /// The member of a row; that of the column's name when absent.
    pub of: Option<String>,
    /// Byte of the row where it begins, in a table by bytes.
    pub at: Option<u32>,
    /// Type of its values, in a table by bytes.
    #[serde(rename = "as")]
    pub kind: Option<CellKind>,
    /// Unit, for people.
    #[serde(default)]
    pub unit: String,
}

/// Type of a column's values: 32-bit numbers, one or several.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "named after GLSL's types")]
pub enum CellKind {
    Uint,
    Int,
    Float,
    Vec2,
    Vec3,
    Vec4,
}

impl CellKind {
    /// Size in bytes.
    pub fn bytes(self) -> usize {
        match self {
            CellKind::Uint | CellKind::Int | CellKind::Float => 4,
            CellKind::Vec2 => 8,
            CellKind::Vec3 => 12,
            CellKind::Vec4 => 16,
        }
    }
}

impl TableDecl {
    /// The buffer that it is read from.
    pub fn buffer(&self) -> &str {
        self.list.as_ref().map_or_else(|| self.buffer.as_ref().map_or("", |b| &b.value), |l| &l.value.buffer)
    }

    /// The members that it names, with what names them.
    pub fn paths(&self) -> impl Iterator<Item = &Loc<Path>> {
        self.list.iter()
    }

    /// What is wrong with it, and where, as far as that needs no shader; `at` is the table's own place.
    pub fn mistakes(&self, at: At) -> Vec<(At, String)> {
        let mut list = Vec::new();
        let title = &self.title;
        if self.columns.0.is_empty() {
            list.push((at, format!("table '{title}' has no columns")));
        }
        if self.help.trim().is_empty() || self.help.contains('\n') {
            list.push((at, format!("table '{title}' needs one line of help")));
        }
        let mut names = HashSet::new();
        for Loc { value: column, at } in &self.columns.0 {
            if !names.insert(&column.name) {
                list.push((*at, format!("two columns of '{title}' are named '{}'", column.name)));
            }
        }
        let by_bytes =
            self.columns.0.iter().all(|c| c.value.at.is_some() && c.value.kind.is_some() && c.value.of.is_none());
        let by_names = self.columns.0.iter().all(|c| c.value.at.is_none() && c.value.kind.is_none());
        match (&self.list, &self.buffer, self.start, self.stride, &self.rows.value) {
            (Some(path), None, None, None, rows) if by_names => {
                if let RowCount::Field(rows) = rows
                    && rows.buffer != path.value.buffer
                {
                    let message = format!("'{rows}' is not in '{}', which holds the rows", path.value.buffer);
                    list.push((self.rows.at, message));
                }
            }
            (None, Some(_), Some(start), Some(stride), RowCount::Word(_)) if by_bytes => {
                if stride == 0 || !stride.is_multiple_of(4) || !start.is_multiple_of(4) {
                    let message = format!(
                        "table '{title}': start {start} and stride {stride} must be multiples of 4, the stride not 0"
                    );
                    list.push((at, message));
                }
                for Loc { value: column, at } in &self.columns.0 {
                    list.extend(column.outside(stride).map(|message| (*at, message)));
                }
            }
            _ => {
                let message = format!(
                    "table '{title}' needs either list and rows by names, or buffer, rows, start, stride and for each column at and as"
                );
                list.push((at, message));
            }
        }
        list
    }
}

impl ColumnDecl {
    /// Why it does not lie in a row of so many bytes.
    fn outside(&self, stride: u32) -> Option<String> {
        let (name, at) = (&self.name, self.at?);
        let end = u64::from(at) + self.kind?.bytes() as u64;
        if end > u64::from(stride) {
            Some(format!("column '{name}' ends at byte {end} of a row of {stride}"))
        } else if !at.is_multiple_of(4) {
            Some(format!("column '{name}' begins at byte {at}, which is no multiple of 4"))
        } else {
            None
        }
    }
}
