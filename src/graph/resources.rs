//! Textures and buffers of a plan on a device.

use super::hot_reload::{Change, Parts};
use super::load::Graph;
use super::plan::Plan;
use super::transient::{Transient, pack};
use super::usage::Res;
use crate::vulkan::{Bare, Buffer, Format, Gpu, Image, ImageDesc, Result, lay_together, vk};
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// What a program works on; two copies of what has a history.
pub(super) struct Resources {
    pub images: Vec<[Option<Arc<Image>>; 2]>,
    pub buffers: Vec<[Option<Arc<Buffer>>; 2]>,
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

/// The transient resources of a plan by name.
pub(super) fn named(graph: &Graph, plan: &Plan) -> Vec<(String, Transient)> {
    let name = |res: Res| match res {
        Res::Texture(t, _) => graph.textures[t].0.clone(),
        Res::Buffer(b, _) => graph.buffers[b].0.clone(),
    };
    plan.transients.iter().map(|t| (name(t.res), t.clone())).collect()
}

/// Makes them, except what fits among the parts of another program.
pub(super) fn make(
    gpu: &Arc<Gpu>,
    graph: &Graph,
    plan: &Plan,
    parts: &Parts,
    change: &mut Change,
) -> Result<Resources> {
    let mut made = Resources { images: Vec::new(), buffers: Vec::new(), shared_bytes: 0 };
    for (t, texture) in plan.textures.iter().enumerate() {
        let mut copies = [None, None];
        let own = !texture.usage.is_empty() && !texture.transient;
        for (c, slot) in copies.iter_mut().enumerate().take(usize::from(own) * (1 + usize::from(texture.history))) {
            let (name, desc) = (&graph.textures[t].0, image_desc(graph, plan, t, c));
            *slot = Some(
                match parts
                    .image(name, c, &desc)
                    .filter(|_| is_kept(plan, |r| matches!(r, Res::Texture(n, _) if n == t)))
                {
                    Some(kept) => kept,
                    None => {
                        change.resized += usize::from(parts.had(name));
                        Arc::new(Image::new(gpu, desc)?)
                    }
                },
            );
        }
        made.images.push(copies);
    }
    for (n, ((name, _), b)) in graph.buffers.iter().zip(&plan.buffers).enumerate() {
        let mut copies = [None, None];
        let own = b.used && !b.transient;
        for (c, slot) in copies.iter_mut().enumerate().take(usize::from(own) * (1 + usize::from(b.history))) {
            *slot = Some(
                match parts
                    .buffer(name, c, b.size)
                    .filter(|_| is_kept(plan, |r| matches!(r, Res::Buffer(m, _) if m == n)))
                {
                    Some(kept) => kept,
                    None => {
                        change.resized += usize::from(parts.had(name));
                        Arc::new(Buffer::new(gpu, name, b.size, BUFFER_USAGE, MemoryLocation::GpuOnly)?)
                    }
                },
            );
        }
        made.buffers.push(copies);
    }
    let transients = named(graph, plan);
    if !take_over(graph, plan, parts, &transients, &mut made) {
        change.resized += transients.iter().filter(|(name, _)| parts.had(name)).count();
        make_transients(gpu, graph, plan, &transients, &mut made)?;
    }
    Ok(made)
}

/// Whether what another program left in it may stay: somebody writes it, and nobody who would is off.
fn is_kept(plan: &Plan, is: impl Fn(Res) -> bool) -> bool {
    plan.steps.iter().flat_map(|s| &s.uses).any(|u| u.write && is(u.res)) && !plan.missing.iter().any(|r| is(*r))
}

fn image_desc(graph: &Graph, plan: &Plan, t: usize, copy: usize) -> ImageDesc {
    let ((name, decl), texture) = (&graph.textures[t], &plan.textures[t]);
    let views = decl.value.views.0.iter();
    ImageDesc {
        name: if copy == 0 { name.clone() } else { format!("{name} (other frame)") },
        extent: texture.extent,
        volume: texture.volume,
        layers: texture.layers,
        mips: texture.mips,
        format: texture.format.vk,
        views: views.filter_map(|v| Format::named(&v.value)).map(|f| f.vk).collect(),
        usage: texture.usage,
    }
}

/// Takes all transient resources from parts, if these are the same ones at the same times; else none.
fn take_over(
    graph: &Graph,
    plan: &Plan,
    parts: &Parts,
    transients: &[(String, Transient)],
    made: &mut Resources,
) -> bool {
    let Some(shared_bytes) = parts.shared_by(transients) else { return false };
    let mut images = Vec::new();
    let mut buffers = Vec::new();
    for (name, transient) in transients {
        match transient.res {
            Res::Texture(t, _) => match parts.shared_image(name, &image_desc(graph, plan, t, 0)) {
                Some(image) => images.push((t, image)),
                None => return false,
            },
            Res::Buffer(b, _) => match parts.shared_buffer(name, plan.buffers[b].size) {
                Some(buffer) => buffers.push((b, buffer)),
                None => return false,
            },
        }
    }
    images.into_iter().for_each(|(t, image)| made.images[t][0] = Some(image));
    buffers.into_iter().for_each(|(b, buffer)| made.buffers[b][0] = Some(buffer));
    made.shared_bytes = shared_bytes;
    true
}

fn make_transients(
    gpu: &Arc<Gpu>,
    graph: &Graph,
    plan: &Plan,
    transients: &[(String, Transient)],
    made: &mut Resources,
) -> Result<()> {
    let bare = |(name, transient): &(String, Transient)| match transient.res {
        Res::Texture(t, _) => Image::bare(gpu, image_desc(graph, plan, t, 0)).map(Bare::Image),
        Res::Buffer(b, _) => Buffer::bare(gpu, name, plan.buffers[b].size, BUFFER_USAGE).map(Bare::Buffer),
    };
    let list: Vec<Bare> = transients.iter().map(bare).collect::<Result<_>>()?;
    if list.is_empty() {
        return Ok(());
    }
    let needs: Vec<(u64, u64)> = list.iter().map(|bare| bare.needs(gpu)).collect();
    let (offsets, size) = pack(&needs, &plan.transients);
    let mut list: Vec<(Bare, u64)> = list.into_iter().zip(offsets).collect();
    lay_together(gpu, "transient resources", &mut list, size)?;
    made.shared_bytes = size;
    for ((bare, _), transient) in list.into_iter().zip(&plan.transients) {
        match (bare, transient.res) {
            (Bare::Image(image), Res::Texture(t, _)) => made.images[t][0] = Some(Arc::new(image)),
            (Bare::Buffer(buffer), Res::Buffer(b, _)) => made.buffers[b][0] = Some(Arc::new(buffer)),
            _ => {}
        }
    }
    Ok(())
}
