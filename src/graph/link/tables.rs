//! Tables of a graph, with the bytes that shaders give their members.

use super::layouts::Layouts;
use crate::diagnostics::{At, Diagnostic, Loc, nearest};
use crate::graph::file::{CellKind, ColumnDecl, RowCount, TableDecl};
use crate::graph::table::{Column, Table, by_bytes};
use crate::shader::Layout;
use crate::shader::layout::Scalar;

/// With its bytes; nothing where no compiled shader declares the buffer.
///
/// # Errors
/// Members that are not there, or that no table can show.
pub(super) fn resolve(decl: &TableDecl, layouts: &Layouts<'_>) -> Result<Option<Table>, Vec<Diagnostic>> {
    let Some(list) = &decl.list else { return Ok(by_bytes(decl)) };
    let error = |at: At, message: String| vec![layouts.graph.sources.error(at, message)];
    let rows = match &decl.rows.value {
        RowCount::Word(word) => Some(*word),
        RowCount::Field(path) => {
            let path = Loc { value: path.clone(), at: decl.rows.at };
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
        return Err(error(list.at, format!("'{}' is of type {found}; the rows of a table are an array's", list.value)));
    };
    let (mut columns, mut wrong) = (Vec::new(), Vec::new());
    for column in &decl.columns.0 {
        match column_of(&column.value, &of) {
            Ok(column) => columns.push(column),
            Err((message, help)) => wrong.push(layouts.graph.sources.error(column.at, message).help(help)),
        }
    }
    if wrong.is_empty() { Ok(Some(Table { rows, start, stride, columns })) } else { Err(wrong) }
}

/// With its bytes in a row.
fn column_of(decl: &ColumnDecl, row: &Layout) -> Result<Column, (String, Option<String>)> {
    let path = decl.of.as_deref().unwrap_or(&decl.name);
    // The rows of an array of numbers have no members.
    let whole = row.members().is_empty() && decl.of.is_none();
    let (at, layout) = if whole { Ok((0, row.clone())) } else { row.find(path) }.map_err(|missing| {
        let known = missing.known.iter().map(String::as_str);
        (format!("column '{}': a row has no member '{path}'", decl.name), nearest(&missing.name, known))
    })?;
    let kind = match layout {
        Layout::Scalar(Scalar::Uint) => CellKind::Uint,
        Layout::Scalar(Scalar::Int) => CellKind::Int,
        Layout::Scalar(Scalar::Float) => CellKind::Float,
        Layout::Vector(Scalar::Float, 2) => CellKind::Vec2,
        Layout::Vector(Scalar::Float, 3) => CellKind::Vec3,
        Layout::Vector(Scalar::Float, 4) => CellKind::Vec4,
        other => {
            let message = format!("column '{}': '{path}' is of type {other}, which no table shows", decl.name);
            return Err((message, Some("tables show uint, int, float, vec2, vec3 and vec4".into())));
        }
    };
    Ok(Column { name: decl.name.clone(), at, kind, unit: decl.unit.clone() })
}

/// A table of the graph; nothing where no compiled shader declares its buffer.
pub fn table(layouts: &Layouts<'_>, number: usize) -> Option<Table> {
    resolve(&layouts.graph.tables.get(number)?.value, layouts).ok().flatten()
}
