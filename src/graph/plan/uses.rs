//! Uses of subresources.

use crate::graph::definition::Res;
use crate::vulkan::vk;
use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stages};

/// How a texture is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UseKind {
    /// Sampled in a shader.
    Sampled,
    /// Storage image.
    Storage,
    /// Colour attachment.
    Color,
    /// Depth attachment that is written.
    Depth,
    /// Depth attachment that is only tested.
    DepthRead,
    /// A clear.
    Clear,
    /// A buffer in a shader.
    Buffer,
    /// Sizes of a dispatch or draw.
    Indirect,
}

/// One use in one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Use {
    /// What.
    pub res: Res,
    /// First mip and their number; (0, 1) for buffers.
    pub mips: (u32, u32),
    /// How.
    pub kind: UseKind,
    /// Stages.
    pub stages: Stages,
    /// Accesses.
    pub access: Access,
    /// Layout.
    pub layout: Layout,
    /// Reads the old content.
    pub read: bool,
    /// Writes.
    pub write: bool,
    /// Replaces everything that was there.
    pub overwrite: bool,
}

const DEPTH_STAGES: Stages =
    Stages::from_raw(Stages::EARLY_FRAGMENT_TESTS.as_raw() | Stages::LATE_FRAGMENT_TESTS.as_raw());

impl Use {
    fn new(res: Res, mips: (u32, u32), kind: UseKind, stages: Stages, access: Access) -> Use {
        Use {
            res,
            mips,
            kind,
            stages,
            access,
            layout: Layout::UNDEFINED,
            read: true,
            write: false,
            overwrite: false,
        }
    }

    /// A storage buffer, a storage image or a sampled texture in a shader.
    pub fn shader(
        res: Res,
        mips: (u32, u32),
        kind: UseKind,
        stages: Stages,
        read: bool,
        write: bool,
    ) -> Use {
        let mut access = Access::empty();
        if read {
            access |= if kind == UseKind::Sampled {
                Access::SHADER_SAMPLED_READ
            } else {
                Access::SHADER_STORAGE_READ
            };
        }
        if write {
            access |= Access::SHADER_STORAGE_WRITE;
        }
        Use {
            read,
            write,
            ..Use::new(res, mips, kind, stages, access)
        }
    }

    /// A uniform block in a shader.
    pub fn uniform(res: Res, stages: Stages) -> Use {
        Use::new(res, (0, 1), UseKind::Buffer, stages, Access::UNIFORM_READ)
    }

    /// An attachment; one that is cleared as a whole holds nothing of before.
    pub fn attachment(texture: usize, mip: u32, kind: UseKind, overwrite: bool) -> Use {
        let (stages, access) = match kind {
            UseKind::Color => (
                Stages::COLOR_ATTACHMENT_OUTPUT,
                Access::COLOR_ATTACHMENT_WRITE
                    | if overwrite {
                        Access::empty()
                    } else {
                        Access::COLOR_ATTACHMENT_READ
                    },
            ),
            UseKind::Depth => (
                DEPTH_STAGES,
                Access::DEPTH_STENCIL_ATTACHMENT_READ | Access::DEPTH_STENCIL_ATTACHMENT_WRITE,
            ),
            _ => (DEPTH_STAGES, Access::DEPTH_STENCIL_ATTACHMENT_READ),
        };
        let (read, write) = (!overwrite, kind != UseKind::DepthRead);
        Use {
            read,
            write,
            overwrite,
            ..Use::new(Res::Texture(texture, false), (mip, 1), kind, stages, access)
        }
    }

    /// A clear, which replaces the content.
    pub fn clear(res: Res, mips: (u32, u32)) -> Use {
        let cleared = Use::new(
            res,
            mips,
            UseKind::Clear,
            Stages::ALL_TRANSFER,
            Access::TRANSFER_WRITE,
        );
        Use {
            read: false,
            write: true,
            overwrite: true,
            ..cleared
        }
    }

    /// Sizes of a dispatch or draw.
    pub fn indirect(buffer: usize) -> Use {
        let access = Access::INDIRECT_COMMAND_READ;
        Use::new(
            Res::Buffer(buffer, false),
            (0, 1),
            UseKind::Indirect,
            Stages::DRAW_INDIRECT,
            access,
        )
    }
}

/// Joins uses of the same subresources of the same kind (several stages, several names).
pub fn merge(uses: Vec<Use>) -> Vec<Use> {
    let mut list: Vec<Use> = Vec::new();
    for u in uses {
        match list
            .iter_mut()
            .find(|o| o.res == u.res && o.mips == u.mips && o.kind == u.kind)
        {
            Some(other) => {
                other.stages |= u.stages;
                other.access |= u.access;
                other.read |= u.read;
                other.write |= u.write;
                other.overwrite |= u.overwrite;
            }
            None => list.push(u),
        }
    }
    list
}

/// Whether a use begins new content.
pub(in crate::graph) fn begins(u: &Use) -> bool {
    u.write && u.overwrite && !u.read
}

/// A mip. A history read needs the content at the end of the last frame.
pub(super) type Part = (Res, u32);

pub(super) fn parts(u: &Use) -> impl Iterator<Item = Part> + use<> {
    let res = u.res.current();
    (u.mips.0..u.mips.0 + u.mips.1).map(move |mip| (res, mip))
}
