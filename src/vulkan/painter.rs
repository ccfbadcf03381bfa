//! Draws egui meshes and pictures of the program into a window or an image.

use super::surface::{Surface, Swapchain, WHOLE};
use super::{
    Buffer, Commands, FrameSlot, Gpu, Image, ImageDesc, Result, Sampler, SamplerDesc, View,
    ViewDesc, VulkanError, vk,
};
use egui::{ClippedPrimitive, TextureId, TexturesDelta};
use egui_ash_renderer::allocator::DefaultAllocator;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer, vulkan};
use gpu_allocator::MemoryLocation;
use std::sync::{Arc, Weak};
use std::time::Instant;

/// Render target.
enum Target {
    Window {
        surface: Box<Surface>,
        swapchain: Option<Swapchain>,
        stale: bool,
    },
    Image(Option<(Arc<Image>, View)>),
}

/// An image to draw to.
struct Drawable {
    image: vk::Image,
    view: vk::ImageView,
    extent: vk::Extent2D,
    /// Signalled when a window's image has been drawn.
    drawn: Option<vk::Semaphore>,
}

/// Frames in flight.
const SLOTS: usize = 2;

struct Slot {
    commands: FrameSlot,
    acquired: vk::Semaphore,
    /// Staging buffers for new pixels, one per picture; reused, because allocating host memory
    /// takes milliseconds.
    staging: Vec<Option<Buffer>>,
    /// Buffers of another device that the last frame reads, held until it has finished.
    reads: Vec<(Arc<Buffer>, Arc<Buffer>)>,
}

/// A picture of 8-bit RGBA pixels that the program updates often.
struct Picture {
    image: Option<(Arc<Image>, View)>,
    set: vk::DescriptorSet,
    id: TextureId,
}

/// New pixels for a picture.
pub struct Pixels<'a> {
    /// Index of the picture, below the number given at creation.
    pub picture: usize,
    pub size: [u32; 2],
    /// RGBA, 8 bits each, tightly packed.
    pub source: PixelSource<'a>,
}

/// Location of new pixels.
#[derive(Clone, Copy)]
pub enum PixelSource<'a> {
    /// In main memory.
    Bytes(&'a [u8]),
    /// In a buffer of another device with the same [`super::DeviceId`], created by
    /// [`Buffer::shareable`] and handed over.
    Shared(&'a Arc<Buffer>),
}

pub struct Painter {
    renderer: Option<Renderer<DefaultAllocator>>,
    pictures: Vec<Picture>,
    slots: Vec<Slot>,
    frame: usize,
    acquired_image: Option<u32>,
    sampler: Sampler,
    pool: vk::DescriptorPool,
    layout: vk::DescriptorSetLayout,
    upload_pool: vk::CommandPool,
    /// Imported buffers of another device.
    taken: Vec<(Weak<Buffer>, Arc<Buffer>)>,
    target: Target,
    format: vk::Format,
    gpu: Arc<Gpu>,
    /// GPU time of the last finished frame (ms): copying pictures, and drawing.
    pub gpu_ms: (f64, f64),
    /// Time that the last frame waited for an earlier one on the GPU (ms).
    pub waited_ms: f64,
}

fn renderer_error(e: egui_ash_renderer::RendererError) -> VulkanError {
    match e {
        egui_ash_renderer::RendererError::Vulkan(code) => VulkanError::at("paint the window")(code),
        other => VulkanError::Window(other.to_string()),
    }
}

/// Magnified pixels stay visible.
const SAMPLER: SamplerDesc = SamplerDesc {
    filter: vk::Filter::NEAREST,
    mip_filter: vk::SamplerMipmapMode::NEAREST,
    address: vk::SamplerAddressMode::CLAMP_TO_EDGE,
    border: vk::BorderColor::FLOAT_TRANSPARENT_BLACK,
    compare: None,
    anisotropic: false,
};

impl Painter {
    /// A painter for a window, with a number of pictures.
    ///
    /// # Errors
    /// The device cannot present to the window; out of memory.
    pub fn for_window(
        gpu: &Arc<Gpu>,
        surface: Surface,
        size: (u32, u32),
        pictures: usize,
    ) -> Result<Painter> {
        let swapchain = Swapchain::new(gpu, &surface, size)?;
        let format = swapchain
            .as_ref()
            .map_or(vk::Format::B8G8R8A8_SRGB, |s| s.format);
        Painter::new(
            gpu,
            Target::Window {
                surface: Box::new(surface),
                swapchain,
                stale: false,
            },
            format,
            pictures,
        )
    }

    /// A painter into an image that [`Painter::read`] reads back.
    pub fn offscreen(gpu: &Arc<Gpu>, pictures: usize) -> Result<Painter> {
        Painter::new(
            gpu,
            Target::Image(None),
            vk::Format::R8G8B8A8_SRGB,
            pictures,
        )
    }

    fn new(gpu: &Arc<Gpu>, target: Target, format: vk::Format, pictures: usize) -> Result<Painter> {
        let sampler = Sampler::new(gpu, &SAMPLER)?;
        // The layout is declared compatible with the renderer's own.
        let layout =
            vulkan::create_vulkan_descriptor_set_layout(&gpu.device).map_err(renderer_error)?;
        let mut painter = Painter {
            renderer: None,
            pictures: Vec::new(),
            slots: Vec::new(),
            frame: 0,
            acquired_image: None,
            sampler,
            pool: vk::DescriptorPool::null(),
            layout,
            upload_pool: vk::CommandPool::null(),
            taken: Vec::new(),
            target,
            format,
            gpu: gpu.clone(),
            gpu_ms: (0.0, 0.0),
            waited_ms: 0.0,
        };
        let count = u32::try_from(pictures).unwrap_or(u32::MAX).max(1);
        // SAFETY: plain creations; `drop` destroys the handles.
        unsafe {
            let at = || VulkanError::at("prepare to paint");
            let d = &gpu.device;
            let info = vk::CommandPoolCreateInfo::default()
                .queue_family_index(gpu.family)
                .flags(vk::CommandPoolCreateFlags::TRANSIENT);
            painter.upload_pool = d.create_command_pool(&info, None).map_err(at())?;
            let sizes = [vk::DescriptorPoolSize {
                ty: vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
                descriptor_count: count,
            }];
            let info = vk::DescriptorPoolCreateInfo::default()
                .max_sets(count)
                .pool_sizes(&sizes);
            painter.pool = d.create_descriptor_pool(&info, None).map_err(at())?;
            for _ in 0..SLOTS {
                let commands = FrameSlot::new(gpu, 3)?;
                let acquired = d.create_semaphore(&Default::default(), None);
                painter.slots.push(Slot {
                    commands,
                    acquired: acquired.map_err(at())?,
                    staging: Vec::new(),
                    reads: Vec::new(),
                });
            }
        }
        painter.make_renderer(pictures)?;
        Ok(painter)
    }

    fn make_renderer(&mut self, pictures: usize) -> Result<()> {
        let mode = RenderMode::DynamicRendering(DynamicRendering {
            color_attachment_format: self.format,
            depth_attachment_format: None,
            stencil_attachment_format: None,
        });
        let options = Options {
            in_flight_frames: SLOTS,
            srgb_framebuffer: is_srgb(self.format),
            ..Options::default()
        };
        let gpu = &self.gpu;
        let mut renderer = Renderer::with_default_allocator(
            &gpu.instance,
            gpu.physical,
            gpu.device.clone(),
            mode,
            options,
        )
        .map_err(renderer_error)?;
        for _ in 0..pictures {
            let layouts = [self.layout];
            let info = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(self.pool)
                .set_layouts(&layouts);
            // SAFETY: pool and layout are alive.
            let set = unsafe { gpu.device.allocate_descriptor_sets(&info) }
                .map_err(VulkanError::at("prepare to paint"))?[0];
            let id = renderer.add_user_texture(set);
            self.pictures.push(Picture {
                image: None,
                set,
                id,
            });
        }
        self.renderer = Some(renderer);
        Ok(())
    }

    /// The egui texture of a picture; usable after its first pixels.
    pub fn picture(&self, number: usize) -> TextureId {
        self.pictures[number].id
    }

    /// Recreates the swapchain after the window was resized.
    pub fn resized(&mut self) {
        if let Target::Window { stale, .. } = &mut self.target {
            *stale = true;
        }
    }

    /// Waits for the last frame of a slot, and takes its times.
    fn wait(&mut self, slot: usize) -> Result<()> {
        let begun = Instant::now();
        let ticks = self.slots[slot].commands.wait()?;
        self.slots[slot].reads.clear();
        self.waited_ms = begun.elapsed().as_secs_f64() * 1e3;
        if let Some(ticks) = ticks
            && let [a, b, c] = ticks[..]
        {
            let ms = |a: u64, b: u64| self.gpu.info.ms_between(a, b);
            self.gpu_ms = (ms(a, b), ms(b, c));
        }
        Ok(())
    }

    /// Draws and presents a frame: updates textures, copies pictures, draws. Returns `false` if
    /// there is no target (a window without area, or one that provides no image now).
    pub fn paint(
        &mut self,
        size: (u32, u32),
        scale: f32,
        mut textures: TexturesDelta,
        primitives: &[ClippedPrimitive],
        pixels: &[Pixels<'_>],
    ) -> Result<bool> {
        let slot = self.frame % SLOTS;
        self.wait(slot)?;
        self.change_textures(&mut textures)?;
        for p in pixels {
            self.fit_picture(p)?;
        }
        let Some(target) = self.acquire(size, slot)? else {
            self.free_textures(&textures)?;
            return Ok(false);
        };
        self.stage(pixels)?;
        let Some(renderer) = &mut self.renderer else {
            return Ok(false);
        };
        let (gpu, pictures, slot) = (&self.gpu, &mut self.pictures, &mut self.slots[slot]);
        let (staging, reads) = (&mut slot.staging, &mut slot.reads);
        let mut result = Ok(());
        let semaphores = target.drawn.map(|drawn| (slot.acquired, drawn));
        slot.commands.submit_between(semaphores, |commands| {
            commands.timestamp();
            refill_pictures(commands, pictures, pixels, staging, reads);
            commands.timestamp();
            let drawn = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
            commands.attach(target.image, vk::ImageLayout::UNDEFINED, drawn);
            let color = [vk::RenderingAttachmentInfo::default()
                .image_view(target.view)
                .image_layout(drawn)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)];
            let info = vk::RenderingInfo::default()
                .render_area(vk::Rect2D::default().extent(target.extent))
                .layer_count(1)
                .color_attachments(&color);
            // SAFETY: the command buffer is recording, and view and image live until the frame has
            // finished.
            unsafe { gpu.device.cmd_begin_rendering(commands.handle, &info) };
            result = renderer.cmd_draw(commands.handle, target.extent, scale, primitives);
            // SAFETY: as above.
            unsafe { gpu.device.cmd_end_rendering(commands.handle) };
            let end = match target.drawn {
                Some(_) => vk::ImageLayout::PRESENT_SRC_KHR,
                None => vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            };
            commands.attach(target.image, drawn, end);
            commands.timestamp();
        })?;
        result.map_err(renderer_error)?;
        self.present()?;
        self.free_textures(&textures)?;
        self.frame += 1;
        Ok(true)
    }

    fn change_textures(&mut self, textures: &mut TexturesDelta) -> Result<()> {
        let Some(renderer) = &mut self.renderer else {
            return Ok(());
        };
        let queue = self
            .gpu
            .queue
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        for (id, deltas) in std::mem::take(&mut textures.set) {
            for delta in &deltas {
                renderer
                    .set_texture(*queue, self.upload_pool, id, delta)
                    .map_err(renderer_error)?;
            }
        }
        Ok(())
    }

    fn free_textures(&mut self, textures: &TexturesDelta) -> Result<()> {
        let Some(renderer) = self.renderer.as_mut().filter(|_| !textures.free.is_empty()) else {
            return Ok(());
        };
        // Rare (a removed thumbnail), so it waits for all frames instead of tracking their use.
        for slot in &mut self.slots {
            slot.commands.wait()?;
        }
        for id in &textures.free {
            renderer.free_texture(*id).map_err(renderer_error)?;
        }
        Ok(())
    }

    /// Resizes a picture's image to its new pixels.
    fn fit_picture(&mut self, p: &Pixels<'_>) -> Result<()> {
        let Some(picture) = self.pictures.get(p.picture) else {
            return Ok(());
        };
        let extent = [p.size[0], p.size[1], 1];
        if picture
            .image
            .as_ref()
            .is_some_and(|(image, _)| image.desc.extent == extent)
        {
            return Ok(());
        }
        for slot in &mut self.slots {
            slot.commands.wait()?;
        }
        // The device decodes on sampling and encodes on drawing, so bytes are preserved.
        let format = vk::Format::R8G8B8A8_SRGB;
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let (image, view) = plain_image(
            &self.gpu,
            "picture",
            p.size,
            format,
            usage,
            vk::ImageUsageFlags::SAMPLED,
        )?;
        let info = [vk::DescriptorImageInfo::default()
            .sampler(self.sampler.handle)
            .image_view(view.handle)
            .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)];
        let picture = &mut self.pictures[p.picture];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(picture.set)
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .image_info(&info);
        // SAFETY: no frame that uses the set is unfinished.
        unsafe { self.gpu.device.update_descriptor_sets(&[write], &[]) };
        picture.image = Some((image, view));
        Ok(())
    }

    fn stage(&mut self, pixels: &[Pixels<'_>]) -> Result<()> {
        // Resized pictures leave old buffers behind: release those without another owner.
        let held = |b: &Arc<Buffer>| Arc::strong_count(b) > 1;
        self.taken
            .retain(|(theirs, ours)| theirs.strong_count() > 0 || held(ours));
        let Slot { staging, reads, .. } = &mut self.slots[self.frame % SLOTS];
        staging.resize_with(self.pictures.len(), || None);
        for p in pixels.iter().filter(|p| p.picture < self.pictures.len()) {
            let bytes = match p.source {
                PixelSource::Bytes(bytes) => bytes,
                PixelSource::Shared(theirs) => {
                    let known = self
                        .taken
                        .iter()
                        .find(|(from, _)| std::ptr::eq(from.as_ptr(), Arc::as_ptr(theirs)));
                    let ours = match known {
                        Some((_, ours)) => ours.clone(),
                        None => {
                            let ours = Arc::new(Buffer::taken(
                                &self.gpu,
                                "picture of the engine",
                                theirs,
                            )?);
                            self.taken.push((Arc::downgrade(theirs), ours.clone()));
                            ours
                        }
                    };
                    reads.push((theirs.clone(), ours));
                    continue;
                }
            };
            let size = (bytes.len() as u64).max(16).next_multiple_of(4);
            let place = &mut staging[p.picture];
            if place.as_ref().is_none_or(|b| b.size != size) {
                let usage = vk::BufferUsageFlags::TRANSFER_SRC;
                *place = Some(Buffer::new(
                    &self.gpu,
                    "picture upload",
                    size,
                    usage,
                    MemoryLocation::CpuToGpu,
                )?);
            }
            if let Some(buffer) = place {
                buffer.bytes_mut()[..bytes.len()].copy_from_slice(bytes);
            }
        }
        Ok(())
    }

    /// The next image to draw to; `None` if the window provides none now.
    fn acquire(&mut self, size: (u32, u32), slot: usize) -> Result<Option<Drawable>> {
        match self.target {
            Target::Image(_) => self.offscreen_image(size),
            Target::Window { .. } => self.window_image(size, slot),
        }
    }

    /// The image of an offscreen painter, recreated after a change of size.
    fn offscreen_image(&mut self, size: (u32, u32)) -> Result<Option<Drawable>> {
        let Target::Image(image) = &mut self.target else {
            return Ok(None);
        };
        let fits = image
            .as_ref()
            .is_some_and(|(i, _)| i.desc.extent == [size.0, size.1, 1]);
        if !fits {
            for slot in &mut self.slots {
                slot.commands.wait()?;
            }
            let color = vk::ImageUsageFlags::COLOR_ATTACHMENT;
            let usage = color | vk::ImageUsageFlags::TRANSFER_SRC;
            let size = [size.0, size.1];
            *image = Some(plain_image(
                &self.gpu,
                "interface",
                size,
                self.format,
                usage,
                color,
            )?);
        }
        Ok(image.as_ref().map(|(image, view)| Drawable {
            image: image.handle,
            view: view.handle,
            extent: vk::Extent2D {
                width: size.0,
                height: size.1,
            },
            drawn: None,
        }))
    }

    /// The next image of the window; recreates an outdated swapchain.
    fn window_image(&mut self, size: (u32, u32), slot: usize) -> Result<Option<Drawable>> {
        let acquired = self.slots[slot].acquired;
        let Target::Window {
            surface,
            swapchain,
            stale,
        } = &mut self.target
        else {
            return Ok(None);
        };
        for _ in 0..3 {
            if *stale || swapchain.is_none() {
                *swapchain = None;
                *swapchain = new_swapchain(&self.gpu, surface, size)?;
                *stale = false;
            }
            let Some(chain) = swapchain else {
                return Ok(None);
            };
            // A hidden window may provide no image for a long time; the timeout keeps the
            // program responsive [ns].
            let timeout = 100_000_000;
            // SAFETY: the semaphore is unused: its last frame has been waited for.
            let next = unsafe {
                chain
                    .loader
                    .acquire_next_image(chain.handle, timeout, acquired, vk::Fence::null())
            };
            match next {
                Ok((index, suboptimal)) => {
                    *stale = suboptimal;
                    self.acquired_image = Some(index);
                    let i = index as usize;
                    return Ok(Some(Drawable {
                        image: chain.images[i],
                        view: chain.views[i],
                        extent: chain.extent,
                        drawn: Some(chain.drawn[i]),
                    }));
                }
                Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => return Ok(None),
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => *stale = true,
                Err(vk::Result::ERROR_SURFACE_LOST_KHR) => {
                    *swapchain = None;
                    surface.renew()?;
                    *stale = true;
                }
                Err(code) => {
                    return Err(VulkanError::at("get the window's next image")(code));
                }
            }
        }
        Ok(None)
    }

    fn present(&mut self) -> Result<()> {
        let Target::Window {
            swapchain: Some(chain),
            stale,
            ..
        } = &mut self.target
        else {
            return Ok(());
        };
        let Some(index) = self.acquired_image.take() else {
            return Ok(());
        };
        let (chains, indices, wait) = ([chain.handle], [index], [chain.drawn[index as usize]]);
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&wait)
            .swapchains(&chains)
            .image_indices(&indices);
        let queue = self
            .gpu
            .queue
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        // SAFETY: the image was acquired and its drawing signals the semaphore.
        match unsafe { chain.loader.queue_present(*queue, &info) } {
            Ok(suboptimal) => *stale |= suboptimal,
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR | vk::Result::ERROR_SURFACE_LOST_KHR) => {
                *stale = true
            }
            Err(code) => return Err(VulkanError::at("present a picture")(code)),
        }
        Ok(())
    }

    /// The pixels of the last frame painted offscreen: size and RGBA bytes.
    ///
    /// # Errors
    /// The device was lost; nothing was painted offscreen.
    pub fn read(&mut self) -> Result<([u32; 2], Vec<u8>)> {
        for slot in &mut self.slots {
            slot.commands.wait()?;
        }
        let Target::Image(Some((image, _))) = &self.target else {
            return Err(VulkanError::Window("nothing was painted offscreen".into()));
        };
        let [w, h, _] = image.desc.extent;
        let size = u64::from(w) * u64::from(h) * 4;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let target = Buffer::new(
            &self.gpu,
            "screenshot",
            size,
            usage,
            MemoryLocation::GpuToCpu,
        )?;
        super::Commands::once(&self.gpu, |commands| {
            commands.read_image(
                image,
                vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                0,
                0,
                None,
                &target,
            );
            commands.full_barrier();
        })?;
        Ok((
            [w, h],
            target.bytes()[..usize::try_from(size).unwrap_or(0)].to_vec(),
        ))
    }
}

/// Copies new pixels to the images of their pictures.
fn refill_pictures(
    commands: &mut Commands<'_>,
    pictures: &[Picture],
    pixels: &[Pixels<'_>],
    staging: &[Option<Buffer>],
    reads: &[(Arc<Buffer>, Arc<Buffer>)],
) {
    for p in pixels {
        let Some(Picture {
            image: Some((image, _)),
            ..
        }) = pictures.get(p.picture)
        else {
            continue;
        };
        match p.source {
            PixelSource::Bytes(_) => {
                if let Some(Some(staging)) = staging.get(p.picture) {
                    commands.refill(image, staging);
                }
            }
            PixelSource::Shared(theirs) => {
                if let Some((_, ours)) = reads.iter().find(|(from, _)| Arc::ptr_eq(from, theirs)) {
                    commands.take_over(ours);
                    commands.refill(image, ours);
                }
            }
        }
    }
}

/// A swapchain for the window's surface, which is recreated if it was lost.
fn new_swapchain(
    gpu: &Arc<Gpu>,
    surface: &mut Surface,
    size: (u32, u32),
) -> Result<Option<Swapchain>> {
    match Swapchain::new(gpu, surface, size) {
        Err(VulkanError::Code {
            code: vk::Result::ERROR_SURFACE_LOST_KHR,
            ..
        }) => {
            surface.renew()?;
            Swapchain::new(gpu, surface, size)
        }
        made => made,
    }
}

fn is_srgb(format: vk::Format) -> bool {
    matches!(
        format,
        vk::Format::R8G8B8A8_SRGB | vk::Format::B8G8R8A8_SRGB
    )
}

fn plain_image(
    gpu: &Arc<Gpu>,
    name: &str,
    size: [u32; 2],
    format: vk::Format,
    usage: vk::ImageUsageFlags,
    view_usage: vk::ImageUsageFlags,
) -> Result<(Arc<Image>, View)> {
    let desc = ImageDesc {
        name: name.into(),
        extent: [size[0], size[1], 1],
        volume: false,
        layers: 1,
        mips: 1,
        format,
        views: Vec::new(),
        usage,
    };
    let image = Arc::new(Image::new(gpu, desc)?);
    let desc = ViewDesc {
        kind: vk::ImageViewType::TYPE_2D,
        format,
        aspect: WHOLE.aspect_mask,
        mips: (0, 1),
        layers: (0, 1),
        usage: view_usage,
    };
    // Views of attachments must not swizzle.
    let sampled = view_usage.contains(vk::ImageUsageFlags::SAMPLED);
    let view = if sampled {
        View::opaque(&image, &desc)?
    } else {
        View::new(&image, &desc)?
    };
    Ok((image, view))
}

impl Drop for Painter {
    fn drop(&mut self) {
        // SAFETY: waits for all frames, then destroys their resources before the device is dropped.
        unsafe {
            let d = &self.gpu.device;
            let _ = d.device_wait_idle();
            for slot in &self.slots {
                d.destroy_semaphore(slot.acquired, None);
            }
            self.renderer = None;
            d.destroy_descriptor_pool(self.pool, None);
            d.destroy_descriptor_set_layout(self.layout, None);
            d.destroy_command_pool(self.upload_pool, None);
        }
        if let Target::Window { swapchain, .. } = &mut self.target {
            *swapchain = None;
        }
    }
}
