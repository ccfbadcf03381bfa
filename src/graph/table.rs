//! Buffers as tables for people: a graph names rows and columns, or says where they lie, and the bytes become cells.

use super::file::Path;
use super::layouts::Layouts;
use crate::diagnostics::{At, Diagnostic, Items, Loc, nearest};
use crate::shader::Layout;
use crate::shader::layout::Scalar;
use serde::Deserialize;
use std::collections::HashSet;
use std::fmt;

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

/// A table with its bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Index of the 32-bit word that holds the number of rows.
    pub rows: u32,
    /// Byte where the first row begins.
    pub start: u32,
    /// Bytes from one row to the next.
    pub stride: u32,
    /// Columns in the order shown.
    pub columns: Vec<Column>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Heading, unique in the table.
    pub name: String,
    /// Byte of the row where it begins.
    pub at: u32,
    /// Type of its values.
    pub kind: CellKind,
    /// Unit, for people.
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

/// A value of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Of a `uint` column.
    Uint(u32),
    /// Of an `int` column.
    Int(i32),
    /// Of a `float` column.
    Float(f32),
    /// Of a `vec2`, `vec3` or `vec4` column.
    Vector(Vec<f32>),
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cell::Uint(v) => write!(f, "{v}"),
            Cell::Int(v) => write!(f, "{v}"),
            Cell::Float(v) => write!(f, "{v:.4}"),
            Cell::Vector(v) => {
                let parts: Vec<String> = v.iter().map(|x| format!("{x:.4}")).collect();
                write!(f, "{}", parts.join(" "))
            }
        }
    }
}

/// No table has more rows than this; what a buffer holds beyond it is not shown.
pub const MAX_ROWS: usize = 100_000;

/// The rows that `bytes`, the content of the table's buffer, hold: as many as the row word says, and at most as fit.
pub fn decode(table: &Table, bytes: &[u8]) -> Vec<Vec<Cell>> {
    let count = word(bytes, table.rows as usize * 4).map_or(0, |n| n as usize).min(MAX_ROWS);
    let stride = table.stride as usize;
    let rows = bytes.get(table.start as usize..).unwrap_or_default();
    let whole = rows.len().checked_div(stride).unwrap_or(0);
    (0..count.min(whole)).map(|row| decode_row(table, &rows[row * stride..(row + 1) * stride])).collect()
}

fn decode_row(table: &Table, row: &[u8]) -> Vec<Cell> {
    let column = |c: &Column| {
        let (kind, at) = (c.kind, c.at as usize);
        let value = |i: usize| word(row, at + 4 * i).unwrap_or(0);
        match kind {
            CellKind::Uint => Cell::Uint(value(0)),
            CellKind::Int => Cell::Int(value(0).cast_signed()),
            CellKind::Float => Cell::Float(f32::from_bits(value(0))),
            _ => Cell::Vector((0..kind.bytes() / 4).map(|i| f32::from_bits(value(i))).collect()),
        }
    };
    table.columns.iter().map(column).collect()
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at.checked_add(4)?)?;
    bytes.try_into().ok().map(u32::from_ne_bytes)
}

impl TableDecl {
    /// The buffer that it is read from.
    pub fn buffer(&self) -> &str {
        self.list.as_ref().map_or_else(|| self.buffer.as_ref().map_or("", |b| &b.value), |l| &l.value.buffer)
    }

    /// The members that it names, with what names them.
    pub(super) fn paths(&self) -> impl Iterator<Item = &Loc<Path>> {
        self.list.iter()
    }

    /// With its bytes; nothing where no compiled shader declares the buffer.
    ///
    /// # Errors
    /// Members that are not there, or that no table can show.
    pub(super) fn resolve(&self, layouts: &Layouts<'_>) -> Result<Option<Table>, Vec<Diagnostic>> {
        let Some(list) = &self.list else { return Ok(self.by_bytes()) };
        let error = |at: At, message: String| vec![layouts.graph().sources.error(at, message)];
        let rows = match &self.rows.value {
            RowCount::Word(word) => Some(*word),
            RowCount::Field(path) => {
                let path = Loc { value: path.clone(), at: self.rows.at };
                match layouts.find(&path).map_err(|e| vec![e])? {
                    Some((byte, Layout::Scalar(Scalar::Uint))) => Some(byte / 4),
                    Some((_, other)) => {
                        return Err(error(
                            path.at,
                            format!("'{}' is of type {other}; rows are counted by a uint", path.value),
                        ));
                    }
                    None => None,
                }
            }
        };
        let (Some(rows), Some((start, found))) = (rows, layouts.find(list).map_err(|e| vec![e])?) else {
            return Ok(None);
        };
        let Layout::Array { of, stride, .. } = found else {
            return Err(error(
                list.at,
                format!("'{}' is of type {found}; the rows of a table are an array's", list.value),
            ));
        };
        let (mut columns, mut wrong) = (Vec::new(), Vec::new());
        for column in &self.columns.0 {
            match column.value.resolve(&of) {
                Ok(column) => columns.push(column),
                Err((message, help)) => wrong.push(layouts.graph().sources.error(column.at, message).help(help)),
            }
        }
        if wrong.is_empty() { Ok(Some(Table { rows, start, stride, columns })) } else { Err(wrong) }
    }

    /// A table whose bytes stand in the file; nothing where it goes by names.
    pub fn by_bytes(&self) -> Option<Table> {
        let RowCount::Word(rows) = self.rows.value else { return None };
        let column =
            |c: &ColumnDecl| Some(Column { name: c.name.clone(), at: c.at?, kind: c.kind?, unit: c.unit.clone() });
        let columns = self.columns.0.iter().map(|c| column(&c.value)).collect::<Option<_>>()?;
        Some(Table { rows, start: self.start?, stride: self.stride?, columns })
    }

    /// What is wrong with it, and where, as far as that needs no shader; `at` is the table's own place.
    pub(super) fn mistakes(&self, at: At) -> Vec<(At, String)> {
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
    /// With its bytes in a row.
    fn resolve(&self, row: &Layout) -> Result<Column, (String, Option<String>)> {
        let path = self.of.as_deref().unwrap_or(&self.name);
        // The rows of an array of numbers have no members.
        let whole = row.members().is_empty() && self.of.is_none();
        let (at, layout) = if whole { Ok((0, row.clone())) } else { row.find(path) }.map_err(|missing| {
            let known = missing.known.iter().map(String::as_str);
            (format!("column '{}': a row has no member '{path}'", self.name), nearest(&missing.name, known))
        })?;
        let kind = match layout {
            Layout::Scalar(Scalar::Uint) => CellKind::Uint,
            Layout::Scalar(Scalar::Int) => CellKind::Int,
            Layout::Scalar(Scalar::Float) => CellKind::Float,
            Layout::Vector(Scalar::Float, 2) => CellKind::Vec2,
            Layout::Vector(Scalar::Float, 3) => CellKind::Vec3,
            Layout::Vector(Scalar::Float, 4) => CellKind::Vec4,
            other => {
                let message = format!("column '{}': '{path}' is of type {other}, which no table shows", self.name);
                return Err((message, Some("tables show uint, int, float, vec2, vec3 and vec4".into())));
            }
        };
        Ok(Column { name: self.name.clone(), at, kind, unit: self.unit.clone() })
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Table {
        crate::diagnostics::options().from_str::<TableDecl>(text).unwrap().by_bytes().unwrap()
    }

    const PAIRS: &str = r#"(buffer: "b", rows: 1, start: 8, stride: 16, title: "t", help: "h", columns: [
        (name: "n", at: 0, as: int), (name: "k", at: 0, as: uint), (name: "x", at: 4, as: float), (name: "v", at: 4, as: vec3),
    ])"#;

    fn buffer(rows: u32, floats: &[f32]) -> Vec<u8> {
        let mut words = vec![7, rows];
        words.extend(floats.iter().map(|f| f.to_bits()));
        words.iter().flat_map(|w| w.to_ne_bytes()).collect()
    }

    #[test]
    fn rows_become_cells() {
        let minus_two = f32::from_bits((-2i32).cast_unsigned());
        let cells = decode(&table(PAIRS), &buffer(1, &[minus_two, 1.5, 2.0, 3.0]));
        let vector = Cell::Vector(vec![1.5, 2.0, 3.0]);
        assert_eq!(cells, [[Cell::Int(-2), Cell::Uint(0xffff_fffe), Cell::Float(1.5), vector]]);
        let text: Vec<String> = cells[0].iter().map(ToString::to_string).collect();
        assert_eq!(text, ["-2", "4294967294", "1.5000", "1.5000 2.0000 3.0000"]);
    }

    #[test]
    fn what_does_not_fit_is_not_read() {
        // The word asks for more rows than there are bytes; the last row is cut short; there is no row word at all.
        assert_eq!(decode(&table(PAIRS), &buffer(u32::MAX, &[0.0; 11])).len(), 2);
        assert_eq!(decode(&table(PAIRS), &buffer(0, &[0.0; 8])).len(), 0);
        assert_eq!(decode(&table(PAIRS), &[0; 4]).len(), 0);
        let dense = table(
            r#"(buffer: "b", rows: 0, start: 4, stride: 4, title: "t", help: "h", columns: [(name: "n", at: 0, as: uint)])"#,
        );
        let mut bytes = vec![0xff; 4];
        bytes.resize(4 * (MAX_ROWS + 10), 0);
        assert_eq!(decode(&dense, &bytes).len(), MAX_ROWS);
    }
}
