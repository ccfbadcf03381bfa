//! Members of buffers by name: a graph names them where it needs their bytes, and the shaders that
//! declare them say where they lie.

use super::linked::{Linked, Target};
use crate::diagnostics::{Diagnostic, Loc, nearest};
use crate::graph::definition::Graph;
use crate::graph::file::{DISPATCH_WORDS, Path};
use crate::shader::layout::Scalar;
use crate::shader::{Compiled, Layout};

/// How the compiled shaders declare each buffer of a graph.
pub struct Layouts<'l> {
    pub(in crate::graph) graph: &'l Graph,
    /// Layouts by buffer.
    pub(super) declared: Vec<Vec<Declared<'l>>>,
}

/// A buffer's block in a shader.
pub(super) struct Declared<'l> {
    pub layout: &'l Layout,
    pub shader: &'l Compiled,
    /// The block's name there.
    pub name: &'l str,
}

impl<'l> Layouts<'l> {
    /// Layouts of a graph with its compiled shaders.
    pub fn new(graph: &'l Graph, linked: &'l [Linked]) -> Layouts<'l> {
        let mut declared: Vec<Vec<Declared<'l>>> =
            graph.buffers.iter().map(|_| Vec::new()).collect();
        for link in linked {
            for bound in &link.bound {
                let shader = link.stages.iter().find(|s| s.stage == bound.stage);
                let (Some(layout), Some(shader)) = (&bound.layout, shader) else {
                    continue;
                };
                for case in &bound.cases {
                    if let Target::Buffer(b) = case.target {
                        declared[b].push(Declared {
                            layout,
                            shader,
                            name: &bound.name,
                        });
                    }
                }
            }
        }
        Layouts { graph, declared }
    }

    /// How a buffer's block lies; nothing where no compiled shader declares it.
    pub fn of(&self, buffer: &str) -> Option<&'l Layout> {
        self.declared[self.graph.buffer(buffer)?]
            .first()
            .map(|d| d.layout)
    }

    /// The byte and type of a member; nothing where no compiled shader declares the buffer.
    ///
    /// # Errors
    /// No such member.
    pub(in crate::graph) fn find(
        &self,
        path: &Loc<Path>,
    ) -> Result<Option<(u32, Layout)>, Diagnostic> {
        let Some(block) = self.of(&path.value.buffer) else {
            return Ok(None);
        };
        block.find(&path.value.member).map(Some).map_err(|missing| {
            let of = [path.value.buffer.as_str(), missing.of.as_str()];
            let of = of
                .into_iter()
                .filter(|part| !part.is_empty())
                .collect::<Vec<_>>()
                .join(".");
            let message = format!("'{of}' has no member '{}'", missing.name);
            let help = nearest(&missing.name, missing.known.iter().map(String::as_str));
            self.graph.sources.error(path.at, message).help(help)
        })
    }

    /// The byte of a dispatch's or draw's sizes; nothing where no compiled shader declares the
    /// buffer.
    ///
    /// # Errors
    /// No such member, or one that is something else.
    pub(in crate::graph) fn command(
        &self,
        path: &Loc<Path>,
        words: u32,
    ) -> Result<Option<u64>, Diagnostic> {
        let Some(found) = self.find(path)? else {
            return Ok(None);
        };
        let block = self.of(&path.value.buffer);
        if block.is_some_and(|b| b.has_uints(&found, words)) {
            return Ok(Some(u64::from(found.0)));
        }
        let what = if words == DISPATCH_WORDS {
            "a dispatch takes its groups"
        } else {
            "a draw takes its counts"
        };
        let message = format!(
            "'{}' is of type {}; {what} from a uvec{words} or {words} uints",
            path.value, found.1
        );
        Err(self.graph.sources.error(path.at, message))
    }

    /// The 32-bit word of a check; nothing where no compiled shader declares the buffer.
    ///
    /// # Errors
    /// No such member, or one that is no whole number.
    pub fn check(&self, field: &Loc<Path>) -> Result<Option<u32>, Diagnostic> {
        let Some((offset, layout)) = self.find(field)? else {
            return Ok(None);
        };
        match layout {
            Layout::Scalar(Scalar::Uint | Scalar::Int) => Ok(Some(offset / 4)),
            other => {
                let message = format!(
                    "'{}' is of type {other}; a check needs a uint or an int",
                    field.value
                );
                Err(self.graph.sources.error(field.at, message))
            }
        }
    }

    /// Bytes of a buffer's block and of an element of the array at its end; nothing where no
    /// compiled shader declares it.
    ///
    /// # Errors
    /// The block ends in such an array and no count is given, or the reverse.
    pub(in crate::graph) fn struct_size(
        &self,
        buffer: &str,
        counted: bool,
    ) -> Result<Option<(u32, u32)>, String> {
        let Some(block) = self.of(buffer) else {
            return Ok(None);
        };
        match (block.endless(), counted) {
            (Some((_, stride)), true) => Ok(Some((block.bytes(), stride))),
            (None, false) => Ok(Some((block.bytes(), 0))),
            (Some((last, _)), false) => Err(format!(
                "'{buffer}' ends in '{}[]', whose length is the buffer's",
                last.name
            )),
            (None, true) => Err(format!(
                "'{buffer}' does not end in an array without a length: `Struct` is its size"
            )),
        }
    }
}
