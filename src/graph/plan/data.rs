//! The work of a frame as data.

use super::uses::Use;
use crate::graph::definition::Res;
use crate::graph::file::Which;
use crate::vulkan::{Format, vk};

/// A texture as it is made.
#[derive(Clone, Debug, PartialEq)]
pub struct TexturePlan {
    /// Width, height, depth.
    pub extent: [u32; 3],
    /// 3D.
    pub volume: bool,
    /// Layers.
    pub layers: u32,
    /// Mips.
    pub mips: u32,
    /// Format.
    pub format: Format,
    /// Usage derived from the steps; empty when no step uses it and it is not made.
    pub usage: vk::ImageUsageFlags,
    /// Two copies, this frame's and last frame's.
    pub history: bool,
    /// Holds nothing between frames.
    pub transient: bool,
}

impl TexturePlan {
    /// Width, height, depth of a mip.
    pub fn mip_extent(&self, mip: u32) -> [u32; 3] {
        self.extent.map(|n| n.checked_shr(mip).unwrap_or(0).max(1))
    }

    /// Bytes of one layer of a mip, tightly packed.
    pub fn mip_bytes(&self, mip: u32) -> u64 {
        self.mip_extent(mip)
            .into_iter()
            .map(u64::from)
            .product::<u64>()
            * u64::from(self.format.bytes)
    }

    /// Bytes of all copies.
    pub fn bytes(&self) -> u64 {
        let mips: u64 = (0..self.mips).map(|mip| self.mip_bytes(mip)).sum();
        mips * u64::from(self.layers) * (1 + u64::from(self.history))
    }
}

/// A buffer as it is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BufferPlan {
    /// Bytes.
    pub size: u64,
    /// Whether any step uses it.
    pub used: bool,
    /// Two copies, this frame's and last frame's.
    pub history: bool,
    /// Holds nothing between frames.
    pub transient: bool,
}

impl BufferPlan {
    /// Bytes of all copies.
    pub fn bytes(&self) -> u64 {
        self.size * (1 + u64::from(self.history))
    }
}

/// The work of a step.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// Compute groups.
    Dispatch([u32; 3]),
    /// Compute groups from a buffer.
    DispatchIndirect(usize, u64),
    /// The scene's triangles.
    Scene(Which),
    /// Three vertices.
    Fullscreen,
    /// Vertices from a buffer.
    DrawIndirect(usize, u64),
    /// Clear a texture.
    ClearTexture(usize, [f64; 4]),
    /// Fill a buffer.
    ClearBuffer(usize, u32),
}

/// An attachment of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachmentPlan {
    /// Texture.
    pub texture: usize,
    /// Mip.
    pub mip: u32,
    /// Layer.
    pub layer: u32,
    /// Clear value.
    pub clear: Option<[f32; 4]>,
    /// Whether it is written (depth).
    pub write: bool,
}

/// The texture behind a binding, evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct BindingPlan {
    /// Index in the pass's bindings.
    pub bound: usize,
    /// The texture.
    pub texture: usize,
    /// First mip and their number.
    pub mips: (u32, u32),
    /// View format.
    pub format: Option<Format>,
    /// Last frame's copy.
    pub history: bool,
    /// Layout at the time of the step.
    pub layout: vk::ImageLayout,
}

/// One execution of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Pass number in the graph.
    pub pass: usize,
    /// Repeat index or mip.
    pub index: u32,
    /// Whether it reads only geometry that stays as it is.
    pub still: bool,
    /// The command.
    pub work: Work,
    /// Which case of each of the pass's bindings holds.
    pub cases: Vec<usize>,
    /// Textures behind its bindings.
    pub bindings: Vec<BindingPlan>,
    /// Indices of bindings of the pass with unused stores, which are removed from the shader. A
    /// binding that is missing in `bindings` too is not bound at all.
    pub stripped: Vec<usize>,
    /// Colour attachments; `None` if unused.
    pub color: Vec<Option<AttachmentPlan>>,
    /// Depth attachment.
    pub depth: Option<AttachmentPlan>,
    /// Viewport.
    pub viewport: [u32; 2],
    /// Samples without attachments.
    pub samples: u32,
    /// Every use of a resource.
    pub uses: Vec<Use>,
}

/// A frame's plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Textures, as in the graph.
    pub textures: Vec<TexturePlan>,
    /// Buffers, as in the graph.
    pub buffers: Vec<BufferPlan>,
    /// Steps in order.
    pub steps: Vec<Step>,
    /// Groups of steps that accumulate over frames.
    pub settling: Vec<Settling>,
    /// Frames until the picture has converged.
    pub convergence: Convergence,
    /// What shares memory.
    pub transients: Vec<Transient>,
    /// What passes write that are off: it begins with zeros, whatever another program left in it.
    pub missing: Vec<Res>,
    /// Passes left out, and why.
    pub dropped: Vec<(usize, String)>,
    /// Edge length above which triangles must be split, if needed.
    pub max_edge: Option<f64>,
}

/// Frames until everything that passes gather over frames has converged, one group of passes after
/// the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Convergence {
    /// From a fresh start; 1 if no pass gathers over frames.
    pub fresh: u32,
    /// After a change between frames, at most: passes replace their earlier result.
    pub changed: u32,
}

/// Steps that rest together.
#[derive(Clone, Debug, PartialEq)]
pub struct Settling {
    /// Frames without a change until they rest.
    pub frames: u32,
    /// They, in order.
    pub steps: Vec<usize>,
    /// These steps, and those through which their output returns to them, over frames too.
    pub ring: Vec<usize>,
    /// Textures and buffers with a history that they write.
    pub kept: Vec<Res>,
}

/// When a transient resource holds something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transient {
    /// It.
    pub res: Res,
    /// From each step that begins new content to the last step that uses this content.
    pub spans: Vec<(usize, usize)>,
}

impl Plan {
    /// Whether there are two copies of a resource.
    pub fn has_history(&self, res: Res) -> bool {
        match res {
            Res::Texture(t, _) => self.textures[t].history,
            Res::Buffer(b, _) => self.buffers[b].history,
        }
    }

    /// Which copy a resource is: with a history, odd frames write the second one and read the
    /// first.
    pub fn copy_of(&self, res: Res, odd: bool) -> usize {
        let (Res::Texture(_, last) | Res::Buffer(_, last)) = res;
        usize::from(self.has_history(res) && last != odd)
    }

    /// Bytes of all copies of a resource.
    pub fn bytes_of(&self, res: Res) -> u64 {
        match res {
            Res::Texture(t, _) => self.textures[t].bytes(),
            Res::Buffer(b, _) => self.buffers[b].bytes(),
        }
    }

    /// Textures and buffers that are made, in the graph's order.
    pub fn made(&self) -> impl Iterator<Item = Res> {
        let textures = self
            .textures
            .iter()
            .enumerate()
            .filter(|(_, t)| !t.usage.is_empty());
        let buffers = self.buffers.iter().enumerate().filter(|(_, b)| b.used);
        textures
            .map(|(t, _)| Res::Texture(t, false))
            .chain(buffers.map(|(b, _)| Res::Buffer(b, false)))
    }

    /// Whether a resource holds nothing between frames.
    pub fn is_transient(&self, res: Res) -> bool {
        match res {
            Res::Texture(t, _) => self.textures[t].transient,
            Res::Buffer(b, _) => self.buffers[b].transient,
        }
    }

    /// Numbers of the passes that run, in order.
    pub fn passes(&self) -> Vec<usize> {
        let mut list: Vec<usize> = self.steps.iter().map(|s| s.pass).collect();
        list.dedup();
        list
    }
}
