//! Content between host and device, and layouts of single mips.

use crate::vulkan::{Buffer, Commands, Image, vk};
use std::sync::Arc;
use vk::{AccessFlags2 as Access, PipelineStageFlags2 as Stages};

/// New content of a buffer or of a part of it.
#[derive(Clone, Debug)]
pub struct Update {
    /// Which.
    pub buffer: Arc<Buffer>,
    /// The part that begins at this byte, a multiple of 4; where absent, all that counts of it.
    pub at: Option<u64>,
    /// A multiple of 4 of them.
    pub bytes: Vec<u8>,
}

impl Update {
    /// All that counts, from the first byte on.
    pub fn all(buffer: &Arc<Buffer>, bytes: Vec<u8>) -> Update {
        Update {
            buffer: buffer.clone(),
            at: None,
            bytes,
        }
    }
}

/// Writes new content into buffers, after all that reads the old one and before all that reads the
/// new one.
pub(super) fn send(commands: &mut Commands<'_>, updates: &[Update]) {
    if !updates.is_empty() {
        let barrier = |src, src_access, dst, dst_access| {
            vk::MemoryBarrier2::default()
                .src_stage_mask(src)
                .src_access_mask(src_access)
                .dst_stage_mask(dst)
                .dst_access_mask(dst_access)
        };
        let (all, copy) = (Stages::ALL_COMMANDS, Stages::ALL_TRANSFER);
        commands.barrier(
            Some(barrier(all, Access::empty(), copy, Access::TRANSFER_WRITE)),
            &[],
        );
        for Update { buffer, at, bytes } in updates {
            commands.update(buffer, at.unwrap_or(0), bytes);
        }
        commands.barrier(
            Some(barrier(
                copy,
                Access::TRANSFER_WRITE,
                all,
                Access::MEMORY_READ,
            )),
            &[],
        );
    }
}

/// Copies a (mip, layer) of an image that rests in a layout, and leaves it there.
pub(super) fn copy_out(
    commands: &mut Commands<'_>,
    image: &Image,
    layout: vk::ImageLayout,
    (mip, layer): (u32, u32),
    part: Option<([u32; 3], [u32; 3])>,
    to: &Buffer,
) {
    let src = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
    commands.barrier(None, &[(image, relayout(image, layout, src, mip))]);
    commands.read_image(image, src, mip, layer, part, to);
    commands.barrier(None, &[(image, relayout(image, src, layout, mip))]);
    commands.full_barrier();
}

/// A barrier for mips of an image between (stages, accesses).
pub(super) fn image_barrier(
    image: &Image,
    mips: (u32, u32),
    src: (Stages, Access),
    dst: (Stages, Access),
    layouts: (vk::ImageLayout, vk::ImageLayout),
) -> vk::ImageMemoryBarrier2<'static> {
    let range = vk::ImageSubresourceRange::default()
        .aspect_mask(image.aspect())
        .base_mip_level(mips.0)
        .level_count(mips.1)
        .layer_count(vk::REMAINING_ARRAY_LAYERS);
    vk::ImageMemoryBarrier2::default()
        .src_stage_mask(src.0)
        .src_access_mask(src.1)
        .dst_stage_mask(dst.0)
        .dst_access_mask(dst.1)
        .old_layout(layouts.0)
        .new_layout(layouts.1)
        .subresource_range(range)
}

/// A barrier that waits for all and takes a mip to another layout.
pub(super) fn relayout(
    image: &Image,
    from: vk::ImageLayout,
    to: vk::ImageLayout,
    mip: u32,
) -> vk::ImageMemoryBarrier2<'static> {
    let (src, dst) = (
        Access::MEMORY_WRITE,
        Access::MEMORY_READ | Access::MEMORY_WRITE,
    );
    image_barrier(
        image,
        (mip, 1),
        (Stages::ALL_COMMANDS, src),
        (Stages::ALL_COMMANDS, dst),
        (from, to),
    )
}
