//! Command recording and submission, with timestamps.

use super::{Buffer, DescriptorSet, Gpu, Image, Pipeline, Result, View, VulkanError, vk};
use std::ffi::CString;
use std::sync::Arc;

/// A command buffer in the recording state. Methods map to Vulkan commands; callers insert the
/// barriers.
pub struct Commands<'a> {
    gpu: &'a Gpu,
    pub(super) handle: vk::CommandBuffer,
    queries: Option<(vk::QueryPool, u32)>,
}

/// A view with its clear value (`None`: load); `None` for a location that is not written.
pub type ColorAttachment<'a> = Option<(&'a View, Option<[f32; 4]>)>;

/// One frame in flight: command buffer, fence and timestamps.
pub struct FrameSlot {
    gpu: Arc<Gpu>,
    pool: vk::CommandPool,
    buffer: vk::CommandBuffer,
    /// The command buffer of the last recording ([`FrameSlot::submit_again`]).
    last: (vk::CommandPool, vk::CommandBuffer),
    fence: vk::Fence,
    queries: vk::QueryPool,
    query_count: u32,
    written: u32,
    pending: bool,
}

impl FrameSlot {
    /// A slot with room for this number of timestamps.
    pub fn new(gpu: &Arc<Gpu>, timestamps: u32) -> Result<FrameSlot> {
        let mut slot = FrameSlot {
            gpu: gpu.clone(),
            pool: vk::CommandPool::null(),
            buffer: vk::CommandBuffer::null(),
            last: (vk::CommandPool::null(), vk::CommandBuffer::null()),
            fence: vk::Fence::null(),
            queries: vk::QueryPool::null(),
            query_count: if gpu.info.timestamp_ns > 0.0 {
                timestamps
            } else {
                0
            },
            written: 0,
            pending: false,
        };
        let d = &gpu.device;
        // SAFETY: plain creations; `drop` destroys the handles, null or not.
        unsafe {
            let at = || VulkanError::at("create a frame");
            (slot.pool, slot.buffer) = command_buffer(gpu)?;
            slot.fence = d
                .create_fence(&vk::FenceCreateInfo::default(), None)
                .map_err(at())?;
            if slot.query_count > 0 {
                let info = vk::QueryPoolCreateInfo::default()
                    .query_type(vk::QueryType::TIMESTAMP)
                    .query_count(slot.query_count);
                slot.queries = d.create_query_pool(&info, None).map_err(at())?;
            }
        }
        Ok(slot)
    }

    /// Waits for the last frame submitted from this slot and returns its timestamps in ticks.
    ///
    /// # Errors
    /// The device was lost, or the frame exceeded [`super::GpuOptions::patience`]. After a timeout
    /// no object of the device is destroyed, because its work may continue.
    pub fn wait(&mut self) -> Result<Option<Vec<u64>>> {
        if !self.pending {
            return Ok(None);
        }
        let d = &self.gpu.device;
        // SAFETY: the fence was submitted with this slot's commands, which write the queries up to
        // `written`.
        unsafe {
            self.gpu.wait_for(self.fence)?;
            d.reset_fences(&[self.fence])
                .map_err(VulkanError::at("reset a fence"))?;
            self.pending = false;
            let mut ticks = vec![0u64; self.written as usize];
            if !ticks.is_empty() {
                d.get_query_pool_results(
                    self.queries,
                    0,
                    &mut ticks,
                    vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT,
                )
                .map_err(VulkanError::at("read timestamps"))?;
            }
            Ok(Some(ticks))
        }
    }

    /// Records and submits a frame, after the previous one of this slot has finished.
    pub fn submit(&mut self, record: impl FnOnce(&mut Commands<'_>)) -> Result<()> {
        self.submit_between(None, record)
    }

    /// Like [`FrameSlot::submit`]; waits for the first semaphore and signals the second.
    pub(super) fn submit_between(
        &mut self,
        semaphores: Option<(vk::Semaphore, vk::Semaphore)>,
        record: impl FnOnce(&mut Commands<'_>),
    ) -> Result<()> {
        self.wait()?;
        self.written = self.record(self.pool, self.buffer, true, record)?;
        self.send(&[self.buffer], semaphores)
    }

    /// Submits the commands of `first`, then a recording of this slot, then the commands of `last`.
    pub fn submit_again(
        &mut self,
        recording: &Recording,
        first: impl FnOnce(&mut Commands<'_>),
        last: Option<impl FnOnce(&mut Commands<'_>)>,
    ) -> Result<()> {
        self.wait()?;
        self.record(self.pool, self.buffer, false, first)?;
        self.written = recording.written;
        let Some(last) = last else {
            return self.send(&[self.buffer, recording.buffer], None);
        };
        if self.last.0 == vk::CommandPool::null() {
            self.last = command_buffer(&self.gpu)?;
        }
        self.record(self.last.0, self.last.1, false, last)?;
        self.send(&[self.buffer, recording.buffer, self.last.1], None)
    }

    /// Re-records the only buffer of a pool and returns the number of timestamps.
    fn record(
        &self,
        pool: vk::CommandPool,
        buffer: vk::CommandBuffer,
        timed: bool,
        record: impl FnOnce(&mut Commands<'_>),
    ) -> Result<u32> {
        let d = &self.gpu.device;
        let at = || VulkanError::at("record a frame");
        let queries = (timed && self.query_count > 0).then_some((self.queries, 0));
        // SAFETY: the buffer belongs to the pool of this slot or of a recording, and neither is
        // pending when it is recorded.
        unsafe {
            d.reset_command_pool(pool, vk::CommandPoolResetFlags::empty())
                .map_err(at())?;
            d.begin_command_buffer(buffer, &vk::CommandBufferBeginInfo::default())
                .map_err(at())?;
            let mut commands = Commands {
                gpu: &self.gpu,
                handle: buffer,
                queries,
            };
            record(&mut commands);
            let written = commands.queries.map_or(0, |q| q.1).min(self.query_count);
            d.end_command_buffer(buffer).map_err(at())?;
            Ok(written)
        }
    }

    fn send(
        &mut self,
        buffers: &[vk::CommandBuffer],
        semaphores: Option<(vk::Semaphore, vk::Semaphore)>,
    ) -> Result<()> {
        let buffers: Vec<_> = buffers
            .iter()
            .map(|b| vk::CommandBufferSubmitInfo::default().command_buffer(*b))
            .collect();
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let part = |s| {
            [vk::SemaphoreSubmitInfo::default()
                .semaphore(s)
                .stage_mask(all)]
        };
        let between = semaphores.map(|(wait, signal)| (part(wait), part(signal)));
        let mut submit = vk::SubmitInfo2::default().command_buffer_infos(&buffers);
        if let Some((wait, signal)) = &between {
            submit = submit
                .wait_semaphore_infos(wait)
                .signal_semaphore_infos(signal);
        }
        let queue = self
            .gpu
            .queue
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        let d = &self.gpu.device;
        // SAFETY: the buffers are recorded and not pending, nor are the slot's queries; the lock
        // restricts the queue to one thread.
        unsafe {
            if self.query_count > 0 {
                d.reset_query_pool(self.queries, 0, self.query_count);
            }
            d.queue_submit2(*queue, &[submit], self.fence)
                .map_err(VulkanError::at("submit a frame"))?;
        }
        self.pending = true;
        Ok(())
    }
}

/// Commands recorded once for a slot and submitted many times. Must be dropped before its slot.
pub struct Recording {
    gpu: Arc<Gpu>,
    pool: vk::CommandPool,
    buffer: vk::CommandBuffer,
    written: u32,
}

impl Recording {
    /// Records commands with the timestamps of a slot.
    pub fn new(slot: &FrameSlot, record: impl FnOnce(&mut Commands<'_>)) -> Result<Recording> {
        let (pool, buffer) = command_buffer(&slot.gpu)?;
        let mut recording = Recording {
            gpu: slot.gpu.clone(),
            pool,
            buffer,
            written: 0,
        };
        recording.written = slot.record(pool, buffer, true, record)?;
        Ok(recording)
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        if self.gpu.is_hung() {
            return;
        }
        // SAFETY: the owner drops a recording after the slot's last frame has finished.
        unsafe { self.gpu.device.destroy_command_pool(self.pool, None) };
    }
}

/// A command buffer with a pool of its own.
fn command_buffer(gpu: &Gpu) -> Result<(vk::CommandPool, vk::CommandBuffer)> {
    let at = || VulkanError::at("create a command buffer");
    let info = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.family);
    // SAFETY: plain creations; the caller destroys the pool, or it is destroyed here on failure.
    unsafe {
        let pool = gpu.device.create_command_pool(&info, None).map_err(at())?;
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool)
            .command_buffer_count(1);
        match gpu.device.allocate_command_buffers(&info) {
            Ok(buffers) => Ok((pool, buffers[0])),
            Err(code) => {
                gpu.device.destroy_command_pool(pool, None);
                Err(at()(code))
            }
        }
    }
}

impl Drop for FrameSlot {
    fn drop(&mut self) {
        let d = &self.gpu.device;
        // SAFETY: submitted work is waited for before destruction.
        unsafe {
            if self.pending {
                let _ = self.gpu.wait_for(self.fence);
            }
            if self.gpu.is_hung() {
                return;
            }
            d.destroy_query_pool(self.queries, None);
            d.destroy_fence(self.fence, None);
            d.destroy_command_pool(self.last.0, None);
            d.destroy_command_pool(self.pool, None);
        }
    }
}

// SAFETY (all `unsafe` below): the command buffer is in the recording state as long as a `Commands`
// exists. Callers keep the owner of every handle alive until the frame has finished.
#[allow(
    clippy::undocumented_unsafe_blocks,
    reason = "one reason for all, above"
)]
impl Commands<'_> {
    /// Records, submits and waits.
    pub fn once(gpu: &Arc<Gpu>, record: impl FnOnce(&mut Commands<'_>)) -> Result<()> {
        let mut slot = FrameSlot::new(gpu, 0)?;
        slot.submit(record)?;
        slot.wait()?;
        Ok(())
    }

    /// Writes the next timestamp after all previous commands.
    pub fn timestamp(&mut self) {
        if let Some((pool, next)) = &mut self.queries {
            unsafe {
                self.gpu.device.cmd_write_timestamp2(
                    self.handle,
                    vk::PipelineStageFlags2::ALL_COMMANDS,
                    *pool,
                    *next,
                );
            }
            *next += 1;
        }
    }

    /// Opens a label that debuggers show.
    pub fn begin_label(&mut self, name: &str) {
        if let (Some(names), Ok(text)) = (&self.gpu.names, CString::new(name)) {
            let label = vk::DebugUtilsLabelEXT::default().label_name(&text);
            unsafe {
                names
                    .device
                    .cmd_begin_debug_utils_label(self.handle, &label)
            };
        }
    }

    pub fn end_label(&mut self) {
        if let Some(names) = &self.gpu.names {
            unsafe { names.device.cmd_end_debug_utils_label(self.handle) };
        }
    }

    /// A barrier over images (with the image of each barrier) and memory.
    pub fn barrier(
        &mut self,
        memory: Option<vk::MemoryBarrier2<'static>>,
        images: &[(&Image, vk::ImageMemoryBarrier2<'static>)],
    ) {
        let images: Vec<_> = images
            .iter()
            .map(|(image, barrier)| barrier.image(image.handle))
            .collect();
        let info = vk::DependencyInfo::default()
            .memory_barriers(memory.as_slice())
            .image_memory_barriers(&images);
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.handle, &info) };
    }

    /// The queue family that the commands are for.
    pub(super) fn family(&self) -> u32 {
        self.gpu.family
    }

    /// Transfers ownership of a buffer between queue families; (stage, access) before and after.
    pub(super) fn pass_on(
        &mut self,
        buffer: &Buffer,
        families: (u32, u32),
        before: (vk::PipelineStageFlags2, vk::AccessFlags2),
        after: (vk::PipelineStageFlags2, vk::AccessFlags2),
    ) {
        let barrier = [vk::BufferMemoryBarrier2::default()
            .buffer(buffer.handle)
            .size(vk::WHOLE_SIZE)
            .src_queue_family_index(families.0)
            .dst_queue_family_index(families.1)
            .src_stage_mask(before.0)
            .src_access_mask(before.1)
            .dst_stage_mask(after.0)
            .dst_access_mask(after.1)];
        let info = vk::DependencyInfo::default().buffer_memory_barriers(&barrier);
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.handle, &info) };
    }

    /// Makes all earlier writes visible to all later commands, and to the host after the fence.
    pub fn full_barrier(&mut self) {
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let write = vk::AccessFlags2::MEMORY_WRITE;
        self.barrier(
            Some(
                vk::MemoryBarrier2::default()
                    .src_stage_mask(all)
                    .src_access_mask(write)
                    .dst_stage_mask(all | vk::PipelineStageFlags2::HOST)
                    .dst_access_mask(
                        vk::AccessFlags2::MEMORY_READ | write | vk::AccessFlags2::HOST_READ,
                    ),
            ),
            &[],
        );
    }

    /// Transitions a whole image, ordered after and before all other commands.
    pub fn transition(&mut self, image: &Image, from: vk::ImageLayout, to: vk::ImageLayout) {
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let barrier = vk::ImageMemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(all)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
            .old_layout(from)
            .new_layout(to)
            .subresource_range(whole(image));
        self.barrier(None, &[(image, barrier)]);
    }

    /// Binds a pipeline and its descriptor set.
    pub fn bind(&mut self, pipeline: &Pipeline, set: Option<DescriptorSet>) {
        let d = &self.gpu.device;
        unsafe {
            d.cmd_bind_pipeline(self.handle, pipeline.point, pipeline.handle);
            if let Some(set) = set {
                d.cmd_bind_descriptor_sets(
                    self.handle,
                    pipeline.point,
                    pipeline.layout,
                    0,
                    &[set.0],
                    &[],
                );
            }
        }
    }

    /// Push constants for all of the pipeline's stages.
    pub fn push(&mut self, pipeline: &Pipeline, bytes: &[u8]) {
        unsafe {
            self.gpu.device.cmd_push_constants(
                self.handle,
                pipeline.layout,
                pipeline.push_stages,
                0,
                bytes,
            )
        };
    }

    /// Dispatches workgroups.
    pub fn dispatch(&mut self, groups: [u32; 3]) {
        unsafe {
            self.gpu
                .device
                .cmd_dispatch(self.handle, groups[0], groups[1], groups[2])
        };
    }

    /// Dispatches workgroups with a count from a buffer.
    pub fn dispatch_indirect(&mut self, buffer: &Buffer, offset: u64) {
        unsafe {
            self.gpu
                .device
                .cmd_dispatch_indirect(self.handle, buffer.handle, offset)
        };
    }

    /// Starts rendering to attachments over an area; `None` colours are not written.
    pub fn begin_rendering(
        &mut self,
        size: [u32; 2],
        color: &[ColorAttachment<'_>],
        depth: Option<(&View, Option<f32>, bool)>,
    ) {
        let colors = color.iter().map(|slot| {
            let plain = vk::RenderingAttachmentInfo::default();
            slot.as_ref()
                .map_or(plain, |(view, clear)| color_attachment(view, *clear))
        });
        let colors: Vec<_> = colors.collect();
        let depth_info = depth.map(|(view, clear, write)| depth_attachment(view, clear, write));
        let area = vk::Rect2D::default().extent(vk::Extent2D {
            width: size[0],
            height: size[1],
        });
        let mut info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colors);
        if let Some(depth) = &depth_info {
            info = info.depth_attachment(depth);
        }
        let viewport = vk::Viewport {
            width: size[0] as f32,
            height: size[1] as f32,
            max_depth: 1.0,
            ..Default::default()
        };
        unsafe {
            self.gpu.device.cmd_begin_rendering(self.handle, &info);
            self.gpu
                .device
                .cmd_set_viewport(self.handle, 0, &[viewport]);
            self.gpu.device.cmd_set_scissor(self.handle, 0, &[area]);
        }
    }

    pub fn end_rendering(&mut self) {
        unsafe { self.gpu.device.cmd_end_rendering(self.handle) };
    }

    /// Draws without vertex buffers.
    pub fn draw(&mut self, vertices: u32, instances: u32) {
        unsafe {
            self.gpu
                .device
                .cmd_draw(self.handle, vertices, instances, 0, 0)
        };
    }

    /// Draws with parameters from a buffer.
    pub fn draw_indirect(&mut self, buffer: &Buffer, offset: u64) {
        unsafe {
            self.gpu
                .device
                .cmd_draw_indirect(self.handle, buffer.handle, offset, 1, 16)
        };
    }

    /// Binds 32-bit indices.
    pub fn bind_indices(&mut self, buffer: &Buffer) {
        unsafe {
            self.gpu.device.cmd_bind_index_buffer(
                self.handle,
                buffer.handle,
                0,
                vk::IndexType::UINT32,
            )
        };
    }

    /// An indexed draw: index count, first index, first instance.
    pub fn draw_indexed(&mut self, count: u32, first: u32, instance: u32) {
        unsafe {
            self.gpu
                .device
                .cmd_draw_indexed(self.handle, count, 1, first, 0, instance)
        };
    }

    /// Draws `count` indexed indirect commands of 20 bytes each.
    pub fn draw_indexed_indirect(&mut self, buffer: &Buffer, offset: u64, count: u32) {
        unsafe {
            self.gpu
                .device
                .cmd_draw_indexed_indirect(self.handle, buffer.handle, offset, count, 20)
        };
    }

    /// Writes bytes (a multiple of 4) at an offset; large data is split into 64 KiB.
    pub fn update(&mut self, buffer: &Buffer, at: u64, bytes: &[u8]) {
        for (offset, part) in (at..).step_by(65536).zip(bytes.chunks(65536)) {
            unsafe {
                self.gpu
                    .device
                    .cmd_update_buffer(self.handle, buffer.handle, offset, part)
            };
        }
    }

    /// Fills a buffer with a 32-bit value.
    pub fn fill(&mut self, buffer: &Buffer, value: u32) {
        unsafe {
            self.gpu
                .device
                .cmd_fill_buffer(self.handle, buffer.handle, 0, vk::WHOLE_SIZE, value)
        };
    }

    /// Clears an image in a layout.
    pub fn clear(&mut self, image: &Image, layout: vk::ImageLayout, value: vk::ClearColorValue) {
        let range = whole(image);
        unsafe {
            self.gpu.device.cmd_clear_color_image(
                self.handle,
                image.handle,
                layout,
                &value,
                &[range],
            )
        };
    }

    /// Clears the depth of a depth image in a layout.
    pub fn clear_depth(&mut self, image: &Image, layout: vk::ImageLayout, depth: f32) {
        let value = vk::ClearDepthStencilValue { depth, stencil: 0 };
        let range = whole(image);
        unsafe {
            self.gpu.device.cmd_clear_depth_stencil_image(
                self.handle,
                image.handle,
                layout,
                &value,
                &[range],
            )
        };
    }

    /// Copies the first bytes of a buffer.
    pub fn copy_buffer(&mut self, from: &Buffer, to: &Buffer, bytes: u64) {
        let region = [vk::BufferCopy::default().size(bytes)];
        unsafe {
            self.gpu
                .device
                .cmd_copy_buffer(self.handle, from.handle, to.handle, &region)
        };
    }

    /// Copies all mips to an image of the same size.
    pub fn copy_image(
        &mut self,
        from: &Image,
        from_layout: vk::ImageLayout,
        to: &Image,
        to_layout: vk::ImageLayout,
    ) {
        let regions: Vec<_> = (0..from.desc.mips.min(to.desc.mips))
            .map(|mip| {
                let part = layers(from, mip);
                let [width, height, depth] = from.mip_extent(mip);
                vk::ImageCopy::default()
                    .src_subresource(part)
                    .dst_subresource(part)
                    .extent(vk::Extent3D {
                        width,
                        height,
                        depth,
                    })
            })
            .collect();
        unsafe {
            self.gpu.device.cmd_copy_image(
                self.handle,
                from.handle,
                from_layout,
                to.handle,
                to_layout,
                &regions,
            );
        }
    }

    /// Copies one mip and layer, or a box (first texel, extent) of it, to a buffer, tightly packed.
    pub fn read_image(
        &mut self,
        image: &Image,
        layout: vk::ImageLayout,
        mip: u32,
        layer: u32,
        part: Option<([u32; 3], [u32; 3])>,
        to: &Buffer,
    ) {
        let (offset, [width, height, depth]) = part.unwrap_or(([0; 3], image.mip_extent(mip)));
        let [x, y, z] = offset.map(|n| i32::try_from(n).unwrap_or(i32::MAX));
        let region = [vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                base_array_layer: layer,
                layer_count: 1,
                ..layers(image, mip)
            })
            .image_offset(vk::Offset3D { x, y, z })
            .image_extent(vk::Extent3D {
                width,
                height,
                depth,
            })];
        unsafe {
            self.gpu.device.cmd_copy_image_to_buffer(
                self.handle,
                image.handle,
                layout,
                to.handle,
                &region,
            )
        };
    }

    /// Replaces the content of an image and prepares it for sampling in fragment shaders.
    pub(super) fn refill(&mut self, image: &Image, from: &Buffer) {
        let [width, height, depth] = image.mip_extent(0);
        let region = vk::BufferImageCopy::default()
            .image_subresource(layers(image, 0))
            .image_extent(vk::Extent3D {
                width,
                height,
                depth,
            });
        self.fill_image(image, from, &[region]);
    }

    /// Transitions a presentable image around rendering.
    pub(super) fn attach(&mut self, image: vk::Image, from: vk::ImageLayout, to: vk::ImageLayout) {
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(all)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
            .old_layout(from)
            .new_layout(to)
            .image(image)
            .subresource_range(super::surface::WHOLE)];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.handle, &info) };
    }

    pub(super) fn fill_image(
        &mut self,
        image: &Image,
        from: &Buffer,
        regions: &[vk::BufferImageCopy],
    ) {
        let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        self.transition(image, vk::ImageLayout::UNDEFINED, target);
        unsafe {
            self.gpu.device.cmd_copy_buffer_to_image(
                self.handle,
                from.handle,
                image.handle,
                target,
                regions,
            );
        }
        self.transition(image, target, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
    }
}

fn whole(image: &Image) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: image.aspect(),
        base_mip_level: 0,
        level_count: vk::REMAINING_MIP_LEVELS,
        base_array_layer: 0,
        layer_count: vk::REMAINING_ARRAY_LAYERS,
    }
}

fn layers(image: &Image, mip: u32) -> vk::ImageSubresourceLayers {
    vk::ImageSubresourceLayers {
        aspect_mask: image.aspect(),
        mip_level: mip,
        base_array_layer: 0,
        layer_count: image.desc.layers,
    }
}

/// How an attachment starts.
fn load(clear: bool) -> vk::AttachmentLoadOp {
    match clear {
        true => vk::AttachmentLoadOp::CLEAR,
        false => vk::AttachmentLoadOp::LOAD,
    }
}

fn color_attachment(view: &View, clear: Option<[f32; 4]>) -> vk::RenderingAttachmentInfo<'static> {
    let float32 = clear.unwrap_or_default();
    vk::RenderingAttachmentInfo::default()
        .image_view(view.handle)
        .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
        .load_op(load(clear.is_some()))
        .store_op(vk::AttachmentStoreOp::STORE)
        .clear_value(vk::ClearValue {
            color: vk::ClearColorValue { float32 },
        })
}

fn depth_attachment(
    view: &View,
    clear: Option<f32>,
    write: bool,
) -> vk::RenderingAttachmentInfo<'static> {
    let (layout, store) = match write {
        true => (
            vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL,
            vk::AttachmentStoreOp::STORE,
        ),
        false => (
            vk::ImageLayout::DEPTH_READ_ONLY_OPTIMAL,
            vk::AttachmentStoreOp::NONE,
        ),
    };
    let depth_stencil = vk::ClearDepthStencilValue {
        depth: clear.unwrap_or(1.0),
        stencil: 0,
    };
    vk::RenderingAttachmentInfo::default()
        .image_view(view.handle)
        .image_layout(layout)
        .load_op(load(clear.is_some()))
        .store_op(store)
        .clear_value(vk::ClearValue { depth_stencil })
}
