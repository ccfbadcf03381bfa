//! Textures and buffers of a plan on a device.

use super::parts::{Change, Copies, Parts};
use crate::graph::definition::{Graph, Res};
use crate::graph::plan::{Plan, Transient, pack};
use crate::vulkan::{
    Bare, Buffer, Format, Gpu, Image, ImageDesc, Result, VulkanError, lay_together, vk,
};
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// The textures and buffers of a program.
#[derive(Default)]
pub(super) struct Resources {
    pub images: Vec<Copies<Image>>,
    pub buffers: Vec<Copies<Buffer>>,
    /// Bytes of the memory that transient ones share.
    pub shared_bytes: u64,
}

const BUFFER_USAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::from_raw(
    vk::BufferUsageFlags::STORAGE_BUFFER.as_raw()
        | vk::BufferUsageFlags::UNIFORM_BUFFER.as_raw()
        | vk::BufferUsageFlags::INDIRECT_BUFFER.as_raw()
        | vk::BufferUsageFlags::TRANSFER_SRC.as_raw()
        | vk::BufferUsageFlags::TRANSFER_DST.as_raw(),
);

impl Resources {
    /// A texture's image in frames of a parity; last frame's, or this one's.
    pub fn image(
        &self,
        plan: &Plan,
        texture: usize,
        last: bool,
        parity: usize,
    ) -> Result<&Arc<Image>> {
        let copy = plan.copy_of(Res::Texture(texture, last), parity == 1);
        self.images[texture][copy]
            .as_ref()
            .ok_or_else(|| VulkanError::Code {
                what: format!("find texture {texture} of the plan"),
                code: vk::Result::ERROR_UNKNOWN,
            })
    }

    /// A buffer in frames of a parity; last frame's, or this one's.
    pub fn buffer(
        &self,
        plan: &Plan,
        buffer: usize,
        last: bool,
        parity: usize,
    ) -> Option<&Arc<Buffer>> {
        self.buffers[buffer][plan.copy_of(Res::Buffer(buffer, last), parity == 1)].as_ref()
    }

    /// Takes all transient resources from parts, if these are the same ones at the same times; else
    /// none.
    fn take_over(
        &mut self,
        graph: &Graph,
        plan: &Plan,
        parts: &Parts,
        transients: &[(String, Transient)],
    ) -> bool {
        let Some(shared_bytes) = parts.shared_by(transients) else {
            return false;
        };
        let (mut images, mut buffers) = (Vec::new(), Vec::new());
        for (name, transient) in transients {
            let found = match transient.res {
                Res::Texture(t, _) => parts
                    .image(name, 0, &image_desc(graph, plan, t, 0))
                    .map(|image| images.push((t, image))),
                Res::Buffer(b, _) => parts
                    .buffer(name, 0, plan.buffers[b].size)
                    .map(|buffer| buffers.push((b, buffer))),
            };
            if found.is_none() {
                return false;
            }
        }
        images
            .into_iter()
            .for_each(|(t, image)| self.images[t][0] = Some(image));
        buffers
            .into_iter()
            .for_each(|(b, buffer)| self.buffers[b][0] = Some(buffer));
        self.shared_bytes = shared_bytes;
        true
    }

    fn make_transients(
        &mut self,
        gpu: &Arc<Gpu>,
        graph: &Graph,
        plan: &Plan,
        transients: &[(String, Transient)],
    ) -> Result<()> {
        let bare = |(name, transient): &(String, Transient)| match transient.res {
            Res::Texture(t, _) => Image::bare(gpu, image_desc(graph, plan, t, 0)).map(Bare::Image),
            Res::Buffer(b, _) => {
                Buffer::bare(gpu, name, plan.buffers[b].size, BUFFER_USAGE).map(Bare::Buffer)
            }
        };
        let list: Vec<Bare> = transients.iter().map(bare).collect::<Result<_>>()?;
        if list.is_empty() {
            return Ok(());
        }
        let needs: Vec<(u64, u64)> = list.iter().map(|bare| bare.needs(gpu)).collect();
        let (offsets, size) = pack(&needs, &plan.transients);
        let mut list: Vec<(Bare, u64)> = list.into_iter().zip(offsets).collect();
        lay_together(gpu, "transient resources", &mut list, size)?;
        self.shared_bytes = size;
        for ((bare, _), transient) in list.into_iter().zip(&plan.transients) {
            match (bare, transient.res) {
                (Bare::Image(image), Res::Texture(t, _)) => {
                    self.images[t][0] = Some(Arc::new(image))
                }
                (Bare::Buffer(buffer), Res::Buffer(b, _)) => {
                    self.buffers[b][0] = Some(Arc::new(buffer))
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// The transient resources of a plan by name.
pub(super) fn named(graph: &Graph, plan: &Plan) -> Vec<(String, Transient)> {
    plan.transients
        .iter()
        .map(|t| (graph.name_of(t.res).to_string(), t.clone()))
        .collect()
}

/// Makes them, except what fits among the parts of another program.
pub(super) fn make(
    gpu: &Arc<Gpu>,
    graph: &Graph,
    plan: &Plan,
    parts: &Parts,
    change: &mut Change,
) -> Result<Resources> {
    // Content of another program may stay if a pass writes the resource, and none of these passes
    // is off.
    let may_stay = |res: Res| {
        let written = plan
            .steps
            .iter()
            .flat_map(|s| &s.uses)
            .any(|u| u.write && u.res.current() == res);
        written
            && !plan.missing.iter().any(|r| r.current() == res)
            && !parts.is_shared(graph.name_of(res))
    };
    let mut made = Resources::default();
    for ((t, texture), (name, _)) in plan.textures.iter().enumerate().zip(&graph.textures) {
        let stays = may_stay(Res::Texture(t, false));
        let own = !texture.usage.is_empty() && !texture.transient;
        made.images.push(copies(own, texture.history, |c| {
            let desc = image_desc(graph, plan, t, c);
            let kept = parts.image(name, c, &desc).filter(|_| stays);
            change.resized += usize::from(kept.is_none() && parts.had(name));
            kept.map_or_else(|| Image::new(gpu, desc).map(Arc::new), Ok)
        })?);
    }
    for ((b, buffer), (name, _)) in plan.buffers.iter().enumerate().zip(&graph.buffers) {
        let stays = may_stay(Res::Buffer(b, false));
        let (own, size) = (buffer.used && !buffer.transient, buffer.size);
        made.buffers.push(copies(own, buffer.history, |c| {
            let kept = parts.buffer(name, c, size).filter(|_| stays);
            change.resized += usize::from(kept.is_none() && parts.had(name));
            let location = MemoryLocation::GpuOnly;
            let new = || Buffer::new(gpu, name, size, BUFFER_USAGE, location).map(Arc::new);
            kept.map_or_else(new, Ok)
        })?);
    }
    let transients = named(graph, plan);
    if !made.take_over(graph, plan, parts, &transients) {
        change.resized += transients
            .iter()
            .filter(|(name, _)| parts.had(name))
            .count();
        made.make_transients(gpu, graph, plan, &transients)?;
    }
    Ok(made)
}

/// The copies of a resource that has memory of its own.
fn copies<T>(
    own: bool,
    history: bool,
    mut make: impl FnMut(usize) -> Result<Arc<T>>,
) -> Result<Copies<T>> {
    let mut copies = [None, None];
    for (c, slot) in copies
        .iter_mut()
        .enumerate()
        .take(usize::from(own) * (1 + usize::from(history)))
    {
        *slot = Some(make(c)?);
    }
    Ok(copies)
}

fn image_desc(graph: &Graph, plan: &Plan, t: usize, copy: usize) -> ImageDesc {
    let ((name, decl), texture) = (&graph.textures[t], &plan.textures[t]);
    let views = decl.value.views.0.iter();
    ImageDesc {
        name: if copy == 0 {
            name.clone()
        } else {
            format!("{name} (other frame)")
        },
        extent: texture.extent,
        volume: texture.volume,
        layers: texture.layers,
        mips: texture.mips,
        format: texture.format.vk,
        views: views
            .filter_map(|v| Format::named(&v.value))
            .map(|f| f.vk)
            .collect(),
        usage: texture.usage,
    }
}
