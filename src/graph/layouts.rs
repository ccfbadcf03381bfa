//! Members of buffers by name: a graph names them where it needs their bytes, and the shaders that declare them say where
//! they lie.

use super::file::{BufferSize, CheckDecl, Command, Dispatch, Draw, Path};
use super::link::{Linked, Target};
use super::load::Graph;
use super::table::Table;
use crate::diagnostics::{Diagnostic, Loc, nearest};
use crate::shader::layout::Scalar;
use crate::shader::{Compiled, Layout};
use std::collections::BTreeSet;

/// How the compiled shaders declare each buffer of a graph.
pub struct Layouts<'l> {
    graph: &'l Graph,
    declared: Vec<Vec<Declared<'l>>>,
}

/// A buffer's block in a shader.
pub(super) struct Declared<'l> {
    pub layout: &'l Layout,
    pub shader: &'l Compiled,
    /// The block's name there.
    pub name: &'l str,
}

/// 32-bit words of VkDispatchIndirectCommand.
pub(super) const DISPATCH_WORDS: u32 = 3;
/// 32-bit words of VkDrawIndirectCommand.
pub(super) const DRAW_WORDS: u32 = 4;

impl<'l> Layouts<'l> {
    /// Of a graph with the shaders that are compiled.
    pub fn new(graph: &'l Graph, linked: &'l [Linked]) -> Layouts<'l> {
        let mut declared: Vec<Vec<Declared<'l>>> = graph.buffers.iter().map(|_| Vec::new()).collect();
        for link in linked {
            for bound in &link.bound {
                let shader = link.stages.iter().find(|s| s.stage == bound.stage);
                let (Some(layout), Some(shader)) = (&bound.layout, shader) else { continue };
                for case in &bound.cases {
                    if let Target::Buffer(b) = case.target {
                        declared[b].push(Declared { layout, shader, name: &bound.name });
                    }
                }
            }
        }
        Layouts { graph, declared }
    }

    pub(super) fn graph(&self) -> &'l Graph {
        self.graph
    }

    /// How a buffer's block lies; nothing where no compiled shader declares it.
    pub fn of(&self, buffer: &str) -> Option<&'l Layout> {
        let index = self.graph.buffers.iter().position(|b| b.0 == buffer)?;
        self.declared[index].first().map(|d| d.layout)
    }

    /// The byte and type of a member; nothing where no compiled shader declares the buffer.
    ///
    /// # Errors
    /// No such member.
    pub(super) fn find(&self, path: &Loc<Path>) -> Result<Option<(u32, Layout)>, Diagnostic> {
        let Some(block) = self.of(&path.value.buffer) else { return Ok(None) };
        block.find(&path.value.member).map(Some).map_err(|missing| {
            let of = [path.value.buffer.as_str(), missing.of.as_str()];
            let of = of.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(".");
            let message = format!("'{of}' has no member '{}'", missing.name);
            let help = nearest(&missing.name, missing.known.iter().map(String::as_str));
            self.graph.sources.error(path.at, message).help(help)
        })
    }

    /// The byte of a dispatch's or draw's sizes; nothing where no compiled shader declares the buffer.
    ///
    /// # Errors
    /// No such member, or one that is something else.
    pub(super) fn command(&self, command: &Command, words: u32) -> Result<Option<u64>, Diagnostic> {
        if let Some(offset) = command.offset {
            return Ok(Some(offset));
        }
        let Some(found) = self.find(&command.path)? else { return Ok(None) };
        let block = self.of(&command.path.value.buffer);
        if block.is_some_and(|b| b.has_uints(&found, words)) {
            return Ok(Some(u64::from(found.0)));
        }
        let what = if words == DISPATCH_WORDS { "a dispatch takes its groups" } else { "a draw takes its counts" };
        let message =
            format!("'{}' is of type {}; {what} from a uvec{words} or {words} uints", command.path.value, found.1);
        Err(self.graph.sources.error(command.path.at, message))
    }

    /// The 32-bit word of a check; nothing where no compiled shader declares the buffer.
    ///
    /// # Errors
    /// No such member, or one that is no whole number.
    pub fn check(&self, check: &CheckDecl) -> Result<Option<u32>, Diagnostic> {
        let Some(field) = &check.field else { return Ok(check.word) };
        let Some((offset, layout)) = self.find(field)? else { return Ok(None) };
        match layout {
            Layout::Scalar(Scalar::Uint | Scalar::Int) => Ok(Some(offset / 4)),
            other => {
                let message = format!("'{}' is of type {other}; a check needs a uint or an int", field.value);
                Err(self.graph.sources.error(field.at, message))
            }
        }
    }

    /// A table with its bytes; nothing where no compiled shader declares its buffer.
    pub fn table(&self, number: usize) -> Option<Table> {
        self.graph.tables.get(number)?.value.resolve(self).ok().flatten()
    }

    /// What is wrong with the names of members, with the shaders compiled so far; with `all` of them, a buffer that none
    /// declares is a mistake too. `place` tells where a shader declares a name.
    pub(super) fn mistakes(&self, all: bool, place: impl Fn(&Declared<'_>, String) -> Diagnostic) -> Vec<Diagnostic> {
        let graph = self.graph;
        let mut found = Vec::new();
        let mut named: Vec<&Loc<Path>> = Vec::new();
        for pass in &graph.passes {
            let dispatch = pass.value.dispatch.as_ref().map(|d| &d.value);
            let draw = pass.value.draw.as_ref().map(|d| &d.value);
            let commands = [
                if let Some(Dispatch::Indirect(c)) = dispatch { Some((c, DISPATCH_WORDS)) } else { None },
                if let Some(Draw::Indirect(c)) = draw { Some((c, DRAW_WORDS)) } else { None },
            ];
            for (command, words) in commands.into_iter().flatten().filter(|(c, _)| c.offset.is_none()) {
                found.extend(self.command(command, words).err());
                named.push(&command.path);
            }
        }
        for check in &graph.checks {
            found.extend(self.check(check).err());
            named.extend(&check.field);
        }
        for table in &graph.tables {
            found.extend(table.value.resolve(self).err().into_iter().flatten());
            named.extend(table.value.paths());
        }
        let mut buffers: BTreeSet<&str> = named.iter().map(|path| path.value.buffer.as_str()).collect();
        for (name, buffer) in &graph.buffers {
            if let BufferSize::Struct(count) = &buffer.value.size.value {
                buffers.insert(name);
                found.extend(self.struct_size(name, count.is_some()).err().map(|message| {
                    let help = count.is_none().then(|| String::from("say how many: Struct(of: \"...\")"));
                    graph.sources.error(buffer.value.size.at, message).help(help)
                }));
                if all && self.of(name).is_none() {
                    let message = format!("no shader declares '{name}', so its struct has no size");
                    found.push(graph.sources.error(buffer.value.size.at, message));
                }
            }
        }
        for path in named.iter().filter(|path| all && self.of(&path.value.buffer).is_none()) {
            let message = format!("no shader declares '{}', so its members have no place", path.value.buffer);
            found.push(graph.sources.error(path.at, message));
        }
        for (_, declared) in graph.buffers.iter().zip(&self.declared).filter(|(b, _)| buffers.contains(b.0.as_str())) {
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

    /// Bytes of a buffer's block and of an element of the array at its end; nothing where no compiled shader declares it.
    ///
    /// # Errors
    /// The block ends in such an array and no count is given, or the reverse.
    pub(super) fn struct_size(&self, buffer: &str, counted: bool) -> Result<Option<(u32, u32)>, String> {
        let Some(block) = self.of(buffer) else { return Ok(None) };
        match (block.endless(), counted) {
            (Some((_, stride)), true) => Ok(Some((block.bytes(), stride))),
            (None, false) => Ok(Some((block.bytes(), 0))),
            (Some((last, _)), false) => {
                Err(format!("'{buffer}' ends in '{}[]', whose length is the buffer's", last.name))
            }
            (None, true) => Err(format!("'{buffer}' does not end in an array without a length: `Struct` is its size")),
        }
    }
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
