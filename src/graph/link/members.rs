//! Members of buffers where shaders put them: tables, and names that the shaders do not have or
//! have otherwise than others.

use super::layouts::{Declared, Layouts};
use crate::diagnostics::{At, Diagnostic, Loc, nearest};
use crate::graph::file::{BufferSize, ColumnDecl, Path, TableDecl};
use crate::graph::table::{CellKind, Column, Table};
use crate::shader::Layout;
use crate::shader::layout::Scalar;
use std::collections::BTreeSet;

/// With its bytes; nothing where no compiled shader declares the buffer.
///
/// # Errors
/// Members that are not there, or that no table can show.
fn resolve(decl: &TableDecl, layouts: &Layouts<'_>) -> Result<Option<Table>, Vec<Diagnostic>> {
    let error = |at: At, message: String| vec![layouts.graph.sources.error(at, message)];
    let find = |path| layouts.find(path).map_err(|e| vec![e]);
    let (list, count) = (&decl.list, &decl.rows);
    let (Some((byte, rows)), Some((start, found))) = (find(count)?, find(list)?) else {
        return Ok(None);
    };
    if rows != Layout::Scalar(Scalar::Uint) {
        return Err(error(
            count.at,
            format!(
                "'{}' is of type {rows}; rows are counted by a uint",
                count.value
            ),
        ));
    }
    let Layout::Array { of, stride, .. } = found else {
        return Err(error(
            list.at,
            format!(
                "'{}' is of type {found}; the rows of a table are an array's",
                list.value
            ),
        ));
    };
    let (mut columns, mut wrong) = (Vec::new(), Vec::new());
    for column in &decl.columns.0 {
        match column_of(&column.value, &of) {
            Ok(column) => columns.push(column),
            Err((message, help)) => {
                wrong.push(layouts.graph.sources.error(column.at, message).help(help))
            }
        }
    }
    if wrong.is_empty() {
        Ok(Some(Table {
            rows: byte / 4,
            start,
            stride,
            columns,
        }))
    } else {
        Err(wrong)
    }
}

/// With its bytes in a row.
fn column_of(decl: &ColumnDecl, row: &Layout) -> Result<Column, (String, Option<String>)> {
    let path = decl.of.as_deref().unwrap_or(&decl.name);
    // The rows of an array of numbers have no members.
    let whole = row.members().is_empty() && decl.of.is_none();
    let (at, layout) = if whole {
        Ok((0, row.clone()))
    } else {
        row.find(path)
    }
    .map_err(|missing| {
        let known = missing.known.iter().map(String::as_str);
        (
            format!("column '{}': a row has no member '{path}'", decl.name),
            nearest(&missing.name, known),
        )
    })?;
    let kind = match layout {
        Layout::Scalar(Scalar::Uint) => CellKind::Uint,
        Layout::Scalar(Scalar::Int) => CellKind::Int,
        Layout::Scalar(Scalar::Float) => CellKind::Float,
        Layout::Vector(Scalar::Float, 2) => CellKind::Vec2,
        Layout::Vector(Scalar::Float, 3) => CellKind::Vec3,
        Layout::Vector(Scalar::Float, 4) => CellKind::Vec4,
        other => {
            let message = format!(
                "column '{}': '{path}' is of type {other}, which no table shows",
                decl.name
            );
            return Err((
                message,
                Some("tables show uint, int, float, vec2, vec3 and vec4".into()),
            ));
        }
    };
    Ok(Column {
        name: decl.name.clone(),
        at,
        kind,
        unit: decl.unit.clone(),
    })
}

/// A table of the graph; nothing where no compiled shader declares its buffer.
pub fn table(layouts: &Layouts<'_>, number: usize) -> Option<Table> {
    resolve(&layouts.graph.tables.get(number)?.value, layouts)
        .ok()
        .flatten()
}

/// Adds the declarations of a buffer that differ from its first one.
fn differences(
    declared: &[Declared<'_>],
    place: &impl Fn(&Declared<'_>, String) -> Diagnostic,
    found: &mut Vec<Diagnostic>,
) {
    let Some((first, others)) = declared.split_first() else {
        return;
    };
    for other in others.iter().filter(|o| o.layout != first.layout) {
        let there = place(first, String::new()).place;
        let there = format!("{}:{}", there.file.display(), there.line);
        let message = format!("'{}' is declared otherwise than in {there}", other.name);
        let wrong = place(other, message).help(difference(first.layout, other.layout));
        if !found.contains(&wrong) {
            found.push(wrong);
        }
    }
}

/// Mistakes in the names of members, from the compiled shaders. With `all` shaders, an undeclared
/// buffer is a mistake too. `place` is the place of a declaration in a shader.
pub(super) fn mistakes(
    layouts: &Layouts<'_>,
    all: bool,
    place: impl Fn(&Declared<'_>, String) -> Diagnostic,
) -> Vec<Diagnostic> {
    let graph = layouts.graph;
    let mut found = Vec::new();
    let mut named: Vec<&Loc<Path>> = Vec::new();
    let commands = graph.passes.iter().filter_map(|pass| pass.value.command());
    for (path, words) in commands {
        found.extend(layouts.command(path, words).err());
        named.push(path);
    }
    for field in graph.checks.iter().map(|check| &check.value.field) {
        found.extend(layouts.check(field).err());
        named.push(field);
    }
    for table in &graph.tables {
        found.extend(resolve(&table.value, layouts).err().into_iter().flatten());
        named.push(&table.value.list);
    }
    let mut buffers = BTreeSet::new();
    buffers.extend(named.iter().map(|path| path.value.buffer.as_str()));
    for (name, buffer) in &graph.buffers {
        let size = &buffer.value.size;
        let BufferSize::Struct(count) = &size.value else {
            continue;
        };
        buffers.insert(name);
        if let Err(message) = layouts.struct_size(name, count.is_some()) {
            let how = || String::from("say how many: Struct(of: \"...\")");
            let help = count.is_none().then(how);
            found.push(graph.sources.error(size.at, message).help(help));
        }
        if all && layouts.of(name).is_none() {
            let message = format!("no shader declares '{name}', so its struct has no size");
            found.push(graph.sources.error(size.at, message));
        }
    }
    for path in &named {
        let name = &path.value.buffer;
        if all && layouts.of(name).is_none() {
            let message = format!("no shader declares '{name}', so its members have no place");
            found.push(graph.sources.error(path.at, message));
        }
    }
    let declared = graph.buffers.iter().zip(&layouts.declared);
    for (_, declared) in declared.filter(|(b, _)| buffers.contains(b.0.as_str())) {
        differences(declared, &place, &mut found);
    }
    found
}

/// The first member that differs, in words.
fn difference(there: &Layout, here: &Layout) -> Option<String> {
    let (there, here) = (there.members(), here.members());
    let differs = there.iter().zip(here).find(|(a, b)| a != b);
    Some(match differs {
        Some((a, b)) => format!(
            "here `{} {}` at byte {}, there `{} {}` at byte {}",
            b.layout, b.name, b.offset, a.layout, a.name, a.offset
        ),
        None => format!("here it has {} members, there {}", here.len(), there.len()),
    })
}
