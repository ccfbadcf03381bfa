//! Buffers, images and views with automatic destruction.

use super::{Commands, Gpu, Result, VulkanError, vk};
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use std::sync::Arc;

/// Memory of a resource.
pub(super) enum Memory {
    /// Not bound yet.
    None,
    /// Own allocation.
    Own(Allocation),
    /// Part of an allocation shared with other resources.
    Shared(#[expect(dead_code, reason = "kept as long as the resource is")] Arc<SharedMemory>),
    /// Own allocation exported to or imported from another device: memory and memory type.
    #[cfg_attr(
        not(unix),
        expect(dead_code, reason = "shared by file descriptors alone")
    )]
    Handed {
        memory: vk::DeviceMemory,
        bytes: u64,
        kind: u32,
    },
}

/// An allocation for several resources.
pub(super) struct SharedMemory {
    gpu: Arc<Gpu>,
    allocation: Option<Allocation>,
}

impl Drop for SharedMemory {
    fn drop(&mut self) {
        if self.gpu.is_hung() {
            return;
        }
        free(&self.gpu, self.allocation.take());
    }
}

/// A buffer and its memory.
pub struct Buffer {
    pub(super) gpu: Arc<Gpu>,
    pub(super) handle: vk::Buffer,
    pub(super) memory: Memory,
    /// Bytes.
    pub size: u64,
}

/// Description of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageDesc {
    /// Name for debuggers and errors.
    pub name: String,
    /// Width, height, depth (1 for 2D).
    pub extent: [u32; 3],
    /// Whether it is a 3D image.
    pub volume: bool,
    pub layers: u32,
    pub mips: u32,
    /// Format of the texels.
    pub format: vk::Format,
    /// Additional view formats (mutable format).
    pub views: Vec<vk::Format>,
    /// Usage of the image.
    pub usage: vk::ImageUsageFlags,
}

/// An image and its memory.
pub struct Image {
    gpu: Arc<Gpu>,
    pub(super) handle: vk::Image,
    memory: Memory,
    pub desc: ImageDesc,
    /// Size of its memory (bytes).
    pub bytes: u64,
}

/// Subresource range and interpretation of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ViewDesc {
    /// Shape declared in the shader.
    pub kind: vk::ImageViewType,
    /// Format for reading.
    pub format: vk::Format,
    pub aspect: vk::ImageAspectFlags,
    /// First mip and count.
    pub mips: (u32, u32),
    /// First layer and count.
    pub layers: (u32, u32),
    /// Usage of the view, a subset of the image's usage that its format supports.
    pub usage: vk::ImageUsageFlags,
}

/// A view of an image, which it keeps alive.
pub struct View {
    pub(super) handle: vk::ImageView,
    image: Arc<Image>,
}

fn allocate(
    gpu: &Gpu,
    name: &str,
    requirements: vk::MemoryRequirements,
    location: MemoryLocation,
    scheme: AllocationScheme,
) -> Result<Allocation> {
    let out_of_memory = || VulkanError::OutOfMemory {
        what: format!("'{name}'"),
        mib: requirements.size as f64 / (1 << 20) as f64,
    };
    if requirements.size > gpu.info.heap && location == MemoryLocation::GpuOnly {
        return Err(out_of_memory());
    }
    let desc = AllocationCreateDesc {
        name,
        requirements,
        location,
        linear: true,
        allocation_scheme: scheme,
    };
    match gpu.allocator.lock() {
        Ok(mut guard) => guard
            .as_mut()
            .and_then(|a| a.allocate(&desc).ok())
            .ok_or_else(out_of_memory),
        Err(_) => Err(out_of_memory()),
    }
}

/// A buffer or image without memory, to be bound together with others.
pub enum Bare {
    Buffer(Buffer),
    Image(Image),
}

impl Bare {
    fn requirements(&self) -> vk::MemoryRequirements {
        match self {
            // SAFETY: the handles are this device's.
            Bare::Buffer(b) => unsafe { b.gpu.device.get_buffer_memory_requirements(b.handle) },
            // SAFETY: as above.
            Bare::Image(i) => unsafe { i.gpu.device.get_image_memory_requirements(i.handle) },
        }
    }

    /// Size and offset alignment, valid for buffers and images in one allocation.
    pub fn needs(&self, gpu: &Gpu) -> (u64, u64) {
        let needs = self.requirements();
        (
            needs.size,
            needs
                .alignment
                .max(gpu.info.limits.buffer_image_granularity),
        )
    }
}

/// Binds resources to one allocation of `size` bytes, each at its offset ([`Bare::needs`]). If no
/// memory type suits all of them, each gets its own allocation. Overlapping resources must not be
/// in use at the same time, and each use starts with undefined content (Vulkan 1.3, section 12.8,
/// Memory Aliasing).
pub fn lay_together(
    gpu: &Arc<Gpu>,
    name: &str,
    resources: &mut [(Bare, u64)],
    size: u64,
) -> Result<()> {
    let all = resources.iter().map(|(bare, _)| bare.requirements());
    let all: Vec<vk::MemoryRequirements> = all.collect();
    let kinds = all.iter().fold(!0, |kinds, r| kinds & r.memory_type_bits);
    if kinds == 0 {
        return resources.iter_mut().try_for_each(|(bare, _)| match bare {
            Bare::Buffer(b) => b.take_memory(MemoryLocation::GpuOnly, name),
            Bare::Image(i) => i.take_memory(),
        });
    }
    let granularity = gpu.info.limits.buffer_image_granularity;
    let alignment = all
        .iter()
        .map(|r| r.alignment)
        .fold(granularity.max(1), u64::max);
    let size = size.max(1).next_multiple_of(alignment);
    let requirements = vk::MemoryRequirements {
        size,
        alignment,
        memory_type_bits: kinds,
    };
    let scheme = AllocationScheme::GpuAllocatorManaged;
    let allocation = allocate(gpu, name, requirements, MemoryLocation::GpuOnly, scheme)?;
    // SAFETY: the handle is used for binding alone, while the allocation lives.
    let (memory, start) = (unsafe { allocation.memory() }, allocation.offset());
    let shared = Arc::new(SharedMemory {
        gpu: gpu.clone(),
        allocation: Some(allocation),
    });
    for (bare, offset) in resources {
        let what = || format!("bind shared memory of '{name}'");
        match bare {
            Bare::Buffer(b) => {
                // SAFETY: the caller aligned the offsets and sized the memory by `needs`, and the
                // memory type suits all resources.
                unsafe {
                    gpu.device
                        .bind_buffer_memory(b.handle, memory, start + *offset)
                }
                .map_err(VulkanError::at(what()))?;
                b.memory = Memory::Shared(shared.clone());
            }
            Bare::Image(i) => {
                // SAFETY: as above.
                unsafe {
                    gpu.device
                        .bind_image_memory(i.handle, memory, start + *offset)
                }
                .map_err(VulkanError::at(what()))?;
                i.memory = Memory::Shared(shared.clone());
            }
        }
    }
    Ok(())
}

impl Memory {
    fn own(&mut self) -> Option<Allocation> {
        match std::mem::replace(self, Memory::None) {
            Memory::Own(allocation) => Some(allocation),
            Memory::None | Memory::Shared(_) | Memory::Handed { .. } => None,
        }
    }
}

fn free(gpu: &Gpu, allocation: Option<Allocation>) {
    if let (Some(allocation), Ok(mut guard)) = (allocation, gpu.allocator.lock())
        && let Some(allocator) = guard.as_mut()
    {
        let _ = allocator.free(allocation);
    }
}

impl Buffer {
    /// A buffer; `host` memory is mapped.
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Buffer> {
        let mut buffer = Buffer::bare(gpu, name, size, usage)?;
        buffer.take_memory(location, name)?;
        Ok(buffer)
    }

    /// A buffer without memory, for [`lay_together`].
    pub fn bare(
        gpu: &Arc<Gpu>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
    ) -> Result<Buffer> {
        Buffer::with(
            gpu,
            name,
            size,
            vk::BufferCreateInfo::default().usage(usage),
        )
    }

    /// A buffer of this size without memory, created from `info`.
    pub(super) fn with(
        gpu: &Arc<Gpu>,
        name: &str,
        size: u64,
        info: vk::BufferCreateInfo<'_>,
    ) -> Result<Buffer> {
        let size = size.max(16).next_multiple_of(4);
        let info = info.size(size);
        // SAFETY: a plain creation; the handle is destroyed in `drop`.
        let handle = unsafe { gpu.device.create_buffer(&info, None) }.map_err(|_| {
            VulkanError::OutOfMemory {
                what: format!("'{name}'"),
                mib: size as f64 / 1048576.0,
            }
        })?;
        gpu.name(handle, name);
        Ok(Buffer {
            gpu: gpu.clone(),
            handle,
            memory: Memory::None,
            size,
        })
    }

    fn take_memory(&mut self, location: MemoryLocation, name: &str) -> Result<()> {
        let (gpu, handle) = (&self.gpu, self.handle);
        // SAFETY: the handle is this device's.
        let requirements = unsafe { gpu.device.get_buffer_memory_requirements(handle) };
        let scheme = if self.size > 16 << 20 {
            AllocationScheme::DedicatedBuffer(handle)
        } else {
            AllocationScheme::GpuAllocatorManaged
        };
        let allocation = allocate(gpu, name, requirements, location, scheme)?;
        // SAFETY: the memory is new, large enough and of an allowed type, because the allocator
        // used `requirements`.
        let bound = unsafe {
            gpu.device
                .bind_buffer_memory(handle, allocation.memory(), allocation.offset())
        };
        self.memory = Memory::Own(allocation);
        bound.map_err(VulkanError::at(format!("bind the memory of '{name}'")))
    }

    /// The mapped bytes of a host buffer; empty for others.
    pub fn bytes(&self) -> &[u8] {
        match &self.memory {
            Memory::Own(allocation) => allocation.mapped_slice().unwrap_or(&[]),
            Memory::None | Memory::Shared(_) | Memory::Handed { .. } => &[],
        }
    }

    /// The mapped bytes of a host buffer, to write; empty for others.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        match &mut self.memory {
            Memory::Own(allocation) => allocation.mapped_slice_mut().unwrap_or(&mut []),
            Memory::None | Memory::Shared(_) | Memory::Handed { .. } => &mut [],
        }
    }
}

impl std::fmt::Debug for Buffer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "buffer of {} bytes", self.size)
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        if self.gpu.is_hung() {
            return;
        }
        // SAFETY: owners drop buffers only after the frames that use them have finished.
        unsafe { self.gpu.device.destroy_buffer(self.handle, None) };
        if let Memory::Handed { memory, .. } = self.memory {
            // SAFETY: the only buffer in this memory is destroyed; the other device holds its own
            // reference.
            unsafe { self.gpu.device.free_memory(memory, None) };
        }
        free(&self.gpu, self.memory.own());
    }
}

impl Image {
    /// An image with undefined content and layout.
    ///
    /// # Errors
    /// Unsupported sizes, formats or usages; out of memory.
    pub fn new(gpu: &Arc<Gpu>, desc: ImageDesc) -> Result<Image> {
        let mut image = Image::bare(gpu, desc)?;
        image.take_memory()?;
        Ok(image)
    }

    /// An image without memory, for [`lay_together`].
    pub fn bare(gpu: &Arc<Gpu>, desc: ImageDesc) -> Result<Image> {
        let limits = &gpu.info.limits;
        let (kind, limit) = match desc.volume {
            true => (vk::ImageType::TYPE_3D, limits.max_image_dimension3_d),
            false => (vk::ImageType::TYPE_2D, limits.max_image_dimension2_d),
        };
        let refuse = |asked: String, limit: String| VulkanError::Limit {
            what: format!("'{}'", desc.name),
            asked,
            limit,
            device: gpu.info.name.clone(),
        };
        let [x, y, z] = desc.extent;
        if x.max(y).max(z) > limit || x.min(y).min(z) == 0 {
            let limit = format!("{limit} texels a side (and at least 1)");
            return Err(refuse(format!("{x}x{y}x{z}"), limit));
        }
        let most = limits.max_image_array_layers;
        if desc.layers > most {
            return Err(refuse(format!("{} layers", desc.layers), most.to_string()));
        }
        let formats = [&[desc.format], &desc.views[..]].concat();
        let mut list = vk::ImageFormatListCreateInfo::default().view_formats(&formats);
        let mut info = vk::ImageCreateInfo::default()
            .image_type(kind)
            .format(desc.format)
            .extent(vk::Extent3D {
                width: x,
                height: y,
                depth: z,
            })
            .mip_levels(desc.mips)
            .array_layers(desc.layers)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(desc.usage);
        if !desc.views.is_empty() {
            info = info
                .flags(vk::ImageCreateFlags::MUTABLE_FORMAT | vk::ImageCreateFlags::EXTENDED_USAGE)
                .push_next(&mut list);
        }
        // SAFETY: a plain creation; the handle is destroyed in `drop`.
        let handle = unsafe { gpu.device.create_image(&info, None) }.map_err(VulkanError::at(
            format!("create the image '{}' ({x}x{y}x{z})", desc.name),
        ))?;
        gpu.name(handle, &desc.name);
        // SAFETY: the handle is this device's.
        let bytes = unsafe { gpu.device.get_image_memory_requirements(handle) }.size;
        Ok(Image {
            gpu: gpu.clone(),
            handle,
            memory: Memory::None,
            bytes,
            desc,
        })
    }

    fn take_memory(&mut self) -> Result<()> {
        let (gpu, handle, name) = (&self.gpu, self.handle, &self.desc.name);
        // SAFETY: the handle is this device's.
        let requirements = unsafe { gpu.device.get_image_memory_requirements(handle) };
        // Dedicated allocations: images are few and large, and this separates buffers from images.
        let scheme = AllocationScheme::DedicatedImage(handle);
        let allocation = allocate(gpu, name, requirements, MemoryLocation::GpuOnly, scheme)?;
        // SAFETY: as for buffers.
        let bound = unsafe {
            gpu.device
                .bind_image_memory(handle, allocation.memory(), allocation.offset())
        };
        let bound = bound.map_err(VulkanError::at(format!("bind the memory of '{name}'")));
        self.memory = Memory::Own(allocation);
        bound
    }

    /// The aspect that holds texels.
    pub fn aspect(&self) -> vk::ImageAspectFlags {
        match self.desc.format {
            vk::Format::D32_SFLOAT | vk::Format::D16_UNORM => vk::ImageAspectFlags::DEPTH,
            _ => vk::ImageAspectFlags::COLOR,
        }
    }

    /// Extent of a mip level.
    pub fn mip_extent(&self, mip: u32) -> [u32; 3] {
        self.desc.extent.map(|n| (n >> mip).max(1))
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        if self.gpu.is_hung() {
            return;
        }
        // SAFETY: as for buffers.
        unsafe { self.gpu.device.destroy_image(self.handle, None) };
        free(&self.gpu, self.memory.own());
    }
}

impl View {
    /// Makes a view.
    pub fn new(image: &Arc<Image>, desc: &ViewDesc) -> Result<View> {
        View::swizzled(image, desc, vk::ComponentMapping::default())
    }

    /// A view with an alpha of 1, whatever the image holds.
    pub(super) fn opaque(image: &Arc<Image>, desc: &ViewDesc) -> Result<View> {
        let one = vk::ComponentSwizzle::ONE;
        View::swizzled(
            image,
            desc,
            vk::ComponentMapping {
                a: one,
                ..vk::ComponentMapping::default()
            },
        )
    }

    fn swizzled(
        image: &Arc<Image>,
        desc: &ViewDesc,
        components: vk::ComponentMapping,
    ) -> Result<View> {
        let mut usage = vk::ImageViewUsageCreateInfo::default().usage(desc.usage);
        let info = vk::ImageViewCreateInfo::default()
            .push_next(&mut usage)
            .image(image.handle)
            .view_type(desc.kind)
            .format(desc.format)
            .components(components)
            .subresource_range(
                vk::ImageSubresourceRange::default()
                    .aspect_mask(desc.aspect)
                    .base_mip_level(desc.mips.0)
                    .level_count(desc.mips.1)
                    .base_array_layer(desc.layers.0)
                    .layer_count(desc.layers.1),
            );
        // SAFETY: the image is kept alive by the view.
        let handle = unsafe { image.gpu.device.create_image_view(&info, None) }.map_err(
            VulkanError::at(format!("view the image '{}'", image.desc.name)),
        )?;
        image.gpu.name(handle, &image.desc.name);
        Ok(View {
            handle,
            image: image.clone(),
        })
    }
}

impl Drop for View {
    fn drop(&mut self) {
        if self.image.gpu.is_hung() {
            return;
        }
        // SAFETY: as for buffers.
        unsafe { self.image.gpu.device.destroy_image_view(self.handle, None) };
    }
}

/// Batches uploads to the device into one submission.
pub struct Upload {
    gpu: Arc<Gpu>,
    buffers: Vec<(Arc<Buffer>, Buffer)>,
    images: Vec<(Arc<Image>, Buffer, Vec<vk::BufferImageCopy>)>,
}

impl Upload {
    pub fn new(gpu: &Arc<Gpu>) -> Upload {
        Upload {
            gpu: gpu.clone(),
            buffers: Vec::new(),
            images: Vec::new(),
        }
    }

    fn staging(&self, bytes: &[u8]) -> Result<Buffer> {
        let mut staging = Buffer::new(
            &self.gpu,
            "upload",
            bytes.len() as u64,
            vk::BufferUsageFlags::TRANSFER_SRC,
            MemoryLocation::CpuToGpu,
        )?;
        staging.bytes_mut()[..bytes.len()].copy_from_slice(bytes);
        Ok(staging)
    }

    /// A device buffer with the given content.
    pub fn buffer(
        &mut self,
        name: &str,
        bytes: &[u8],
        usage: vk::BufferUsageFlags,
    ) -> Result<Arc<Buffer>> {
        let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = Arc::new(Buffer::new(
            &self.gpu,
            name,
            bytes.len() as u64,
            usage,
            MemoryLocation::GpuOnly,
        )?);
        if !bytes.is_empty() {
            let staging = self.staging(bytes)?;
            self.buffers.push((buffer.clone(), staging));
        }
        Ok(buffer)
    }

    /// Fills an image from `parts[layer][mip]` and prepares it for sampling.
    pub fn image(&mut self, image: &Arc<Image>, parts: &[Vec<&[u8]>]) -> Result<()> {
        let mut bytes: Vec<u8> = Vec::new();
        let mut regions = Vec::new();
        for (layer, mips) in (0u32..).zip(parts) {
            for (mip, part) in (0u32..).zip(mips) {
                // Offsets must be multiples of the texel block size; 16 covers all formats.
                bytes.resize(bytes.len().next_multiple_of(16), 0);
                let [width, height, depth] = image.mip_extent(mip);
                regions.push(
                    vk::BufferImageCopy::default()
                        .buffer_offset(bytes.len() as u64)
                        .image_subresource(
                            vk::ImageSubresourceLayers::default()
                                .aspect_mask(vk::ImageAspectFlags::COLOR)
                                .mip_level(mip)
                                .base_array_layer(layer)
                                .layer_count(1),
                        )
                        .image_extent(vk::Extent3D {
                            width,
                            height,
                            depth,
                        }),
                );
                bytes.extend_from_slice(part);
            }
        }
        let staging = self.staging(&bytes)?;
        self.images.push((image.clone(), staging, regions));
        Ok(())
    }

    /// Submits and waits.
    pub fn finish(self) -> Result<()> {
        Commands::once(&self.gpu, |commands| {
            for (buffer, staging) in &self.buffers {
                commands.copy_buffer(staging, buffer, staging.size.min(buffer.size));
            }
            for (image, staging, regions) in &self.images {
                commands.fill_image(image, staging, regions);
            }
        })
    }
}
