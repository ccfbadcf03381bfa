//! Resources of the running graph that a tab reads back: the request, and the content.

use crate::graph::table::Table;
use crate::graph::{Debug, Graph};
use crate::lab::{LabError, Session, Texels};
use crate::workbench::desired::request::InspectTarget;
use std::sync::Arc;

/// A requested resource.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadBack {
    /// A slice of a texture.
    Texture(InspectTarget),
    /// A table of side A, by its number in the graph.
    Table(usize),
    /// Values and failed checks of the shaders of side A.
    Debug,
}

/// Its content.
pub enum Content {
    /// The texels of a slice.
    Texels(InspectTarget, Arc<Texels>),
    /// Number and layout of a table, and the bytes of its buffer.
    Table(usize, Table, Vec<u8>),
    /// Values and failed checks of shaders; nothing where no pass records any.
    Debug(Option<Debug>),
}

impl ReadBack {
    /// The side that it is read from: 0 is A, 1 is B.
    pub fn side(&self) -> usize {
        match self {
            ReadBack::Texture(target) => target.side,
            ReadBack::Table(_) | ReadBack::Debug => 0,
        }
    }

    /// The resource that a build has to keep, if the graph is known or need not be.
    pub fn resource(&self, graph: Option<&Graph>) -> Option<String> {
        match self {
            ReadBack::Texture(target) => Some(target.texture.clone()),
            ReadBack::Table(number) => {
                let table = graph?.tables.get(*number)?;
                Some(table.value.list.value.buffer.clone())
            }
            ReadBack::Debug => None,
        }
    }

    /// Reads it; nothing if the session does not make it. A build that makes it may be in work.
    pub fn read(&self, session: &mut Session) -> Result<Option<Content>, LabError> {
        match self {
            ReadBack::Texture(t) => {
                match session.slice(&t.texture, t.mip, t.layer, t.axis, t.slice) {
                    Ok(texels) => Ok(Some(Content::Texels(t.clone(), Arc::new(texels)))),
                    Err(LabError::Vulkan(e)) => Err(e.into()),
                    Err(_) => Ok(None),
                }
            }
            ReadBack::Table(number) => {
                let name = self.resource(Some(&session.graph));
                let Some((name, table)) = name.zip(session.table(*number)) else {
                    return Ok(None);
                };
                let bytes = session.buffer(&name)?;
                Ok(Some(Content::Table(*number, table, bytes)))
            }
            ReadBack::Debug => Ok(Some(Content::Debug(session.debug()?))),
        }
    }
}
