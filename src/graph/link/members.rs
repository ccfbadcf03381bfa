//! Names of members that the shaders do not have, or have otherwise than others.

use super::layouts::{Declared, Layouts};
use super::tables::resolve;
use crate::diagnostics::{Diagnostic, Loc};
use crate::graph::file::{BufferSize, Path};
use crate::shader::Layout;
use std::collections::BTreeSet;

/// What is wrong with the names of members, with the shaders compiled so far; with `all` of them, a buffer that none
/// declares is a mistake too. `place` tells where a shader declares a name.
pub(super) fn mistakes(
    layouts: &Layouts<'_>,
    all: bool,
    place: impl Fn(&Declared<'_>, String) -> Diagnostic,
) -> Vec<Diagnostic> {
    let graph = layouts.graph;
    let mut found = Vec::new();
    let mut named: Vec<&Loc<Path>> = Vec::new();
    let commands = graph.passes.iter().filter_map(|pass| pass.value.command());
    for (command, words) in commands.filter(|(c, _)| c.offset.is_none()) {
        found.extend(layouts.command(command, words).err());
        named.push(&command.path);
    }
    for check in &graph.checks {
        found.extend(layouts.check(&check.value).err());
        named.extend(&check.value.field);
    }
    for table in &graph.tables {
        found.extend(resolve(&table.value, layouts).err().into_iter().flatten());
        named.extend(table.value.paths());
    }
    let mut buffers: BTreeSet<&str> = named.iter().map(|path| path.value.buffer.as_str()).collect();
    for (name, buffer) in &graph.buffers {
        if let BufferSize::Struct(count) = &buffer.value.size.value {
            buffers.insert(name);
            found.extend(layouts.struct_size(name, count.is_some()).err().map(|message| {
                let help = count.is_none().then(|| String::from("say how many: Struct(of: \"...\")"));
                graph.sources.error(buffer.value.size.at, message).help(help)
            }));
            if all && layouts.of(name).is_none() {
                let message = format!("no shader declares '{name}', so its struct has no size");
                found.push(graph.sources.error(buffer.value.size.at, message));
            }
        }
    }
    for path in named.iter().filter(|path| all && layouts.of(&path.value.buffer).is_none()) {
        let message = format!("no shader declares '{}', so its members have no place", path.value.buffer);
        found.push(graph.sources.error(path.at, message));
    }
    for (_, declared) in graph.buffers.iter().zip(&layouts.declared).filter(|(b, _)| buffers.contains(b.0.as_str())) {
        let Some((first, others)) = declared.split_first() else { continue };
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
