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
    /// A small picture of a slice of a texture.
    Thumbnail(InspectTarget),
}

/// Longest side of a small picture, texels.
pub const THUMBNAIL: u32 = 88;

/// Its content.
pub enum Content {
    /// The texels of a slice.
    Texels(InspectTarget, Arc<Texels>),
    /// Number and layout of a table, and the bytes of its buffer.
    Table(usize, Table, Vec<u8>),
    /// Values and failed checks of shaders; nothing where no pass records any.
    Debug(Option<Debug>),
    /// Texels of a small picture.
    Thumbnail(InspectTarget, Arc<Texels>),
}

impl ReadBack {
    /// The side that it is read from: 0 is A, 1 is B.
    pub fn side(&self) -> usize {
        match self {
            ReadBack::Texture(target) | ReadBack::Thumbnail(target) => target.side,
            ReadBack::Table(_) | ReadBack::Debug => 0,
        }
    }

    /// The resource that a build has to keep, if the graph is known or need not be.
    pub fn resource(&self, graph: Option<&Graph>) -> Option<String> {
        match self {
            ReadBack::Texture(target) | ReadBack::Thumbnail(target) => Some(target.texture.clone()),
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
            ReadBack::Texture(t) | ReadBack::Thumbnail(t) => {
                let texels = match session.slice(&t.texture, t.mip, t.layer, t.axis, t.slice) {
                    Ok(texels) => texels,
                    Err(LabError::Vulkan(e)) => return Err(e.into()),
                    Err(_) => return Ok(None),
                };
                Ok(Some(match self {
                    ReadBack::Thumbnail(_) => {
                        Content::Thumbnail(t.clone(), Arc::new(reduced(&texels, THUMBNAIL)))
                    }
                    _ => Content::Texels(t.clone(), Arc::new(texels)),
                }))
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

/// The texels, or where a side is longer than `most`, evenly spaced ones.
fn reduced(texels: &Texels, most: u32) -> Texels {
    let [width, height, depth] = texels.extent;
    let (height, bytes) = (height * depth, texels.format.bytes as usize);
    let factor = f64::from(width.max(height)) / f64::from(most);
    if factor <= 1.0 {
        return texels.clone();
    }
    let size = [width, height].map(|n| ((f64::from(n) / factor) as u32).max(1));
    let at = |i: u32, from: u32, to: u32| u64::from(i) * u64::from(from) / u64::from(to);
    let mut out = Vec::with_capacity((size[0] * size[1]) as usize * bytes);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let row = at(y, height, size[1]) * u64::from(width);
            let first = (row + at(x, width, size[0])) as usize * bytes;
            let texel = texels.bytes.get(first..first + bytes);
            out.extend_from_slice(texel.unwrap_or(&[0; 16][..bytes.min(16)]));
        }
    }
    Texels {
        extent: [size[0], size[1], 1],
        format: texels.format,
        bytes: out,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vulkan::Format;

    #[test]
    fn a_large_texture_is_reduced_evenly() {
        let format = Format::named("r8").unwrap();
        let bytes = (0..8 * 4).collect();
        let texels = Texels {
            extent: [8, 4, 1],
            format,
            bytes,
        };
        let small = reduced(&texels, 4);
        assert_eq!(small.extent, [4, 2, 1]);
        assert_eq!(small.bytes, [0, 2, 4, 6, 16, 18, 20, 22]);
        assert_eq!(reduced(&texels, 8).bytes, texels.bytes);
    }
}
