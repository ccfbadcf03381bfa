//! Buffers shared by two devices of one physical device, so that one can paint a picture of the
//! other without a copy through main memory.
//!
//! No semaphore is shared. The reader gets a picture after the writing frame's fence has been
//! waited for, so the host orders the two, and it holds the buffer until its own frame has
//! finished. Neither device waits for the other's queue, so a hanging shader on one does not block
//! the other.

#[cfg(unix)]
use super::memory::Memory;
use super::{Buffer, Commands, Gpu, Result, VulkanError, vk};
#[cfg(unix)]
use ash::khr;
use std::sync::Arc;

/// Identity of a physical device and driver; only equal ones can share memory (Vulkan 1.3,
/// `VkPhysicalDeviceIDProperties`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct DeviceId {
    pub(super) device: [u8; 16],
    pub(super) driver: [u8; 16],
}

/// Copy destination and source.
#[cfg(unix)]
const USAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::from_raw(
    vk::BufferUsageFlags::TRANSFER_SRC.as_raw() | vk::BufferUsageFlags::TRANSFER_DST.as_raw(),
);

#[cfg(unix)]
const HANDLE: vk::ExternalMemoryHandleTypeFlags = vk::ExternalMemoryHandleTypeFlags::OPAQUE_FD;

/// Whether a device can export and import buffers.
#[cfg(unix)]
pub(super) fn is_supported(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    extensions: &[vk::ExtensionProperties],
) -> bool {
    use vk::ExternalMemoryFeatureFlags as Can;
    if !super::has(extensions, khr::external_memory_fd::NAME) {
        return false;
    }
    let info = vk::PhysicalDeviceExternalBufferInfo::default()
        .usage(USAGE)
        .handle_type(HANDLE);
    let mut found = vk::ExternalBufferProperties::default();
    // SAFETY: `physical` comes from this instance.
    unsafe { instance.get_physical_device_external_buffer_properties(physical, &info, &mut found) };
    found
        .external_memory_properties
        .external_memory_features
        .contains(Can::EXPORTABLE | Can::IMPORTABLE)
}

#[cfg(not(unix))]
pub(super) fn is_supported(
    _: &ash::Instance,
    _: vk::PhysicalDevice,
    _: &[vk::ExtensionProperties],
) -> bool {
    false
}

/// An exported memory handle.
#[cfg(unix)]
struct Handed {
    file: std::os::fd::OwnedFd,
    bytes: u64,
    kind: u32,
}

#[cfg(unix)]
impl Buffer {
    /// An exportable buffer in device memory ([`Buffer::taken`]).
    pub fn shareable(gpu: &Arc<Gpu>, name: &str, size: u64) -> Result<Buffer> {
        let mut buffer = Buffer::external(gpu, name, size)?;
        // SAFETY: the handle is this device's.
        let needs = unsafe { gpu.device.get_buffer_memory_requirements(buffer.handle) };
        // SAFETY: `physical` is this device's.
        let kinds = unsafe {
            gpu.instance
                .get_physical_device_memory_properties(gpu.physical)
        };
        let fits = |i: &u32| {
            let local = vk::MemoryPropertyFlags::DEVICE_LOCAL;
            needs.memory_type_bits & (1 << i) != 0
                && kinds.memory_types[*i as usize]
                    .property_flags
                    .contains(local)
        };
        let kind = (0..kinds.memory_type_count)
            .find(fits)
            .ok_or_else(|| out_of_memory(name, needs.size))?;
        let mut dedicated = vk::MemoryDedicatedAllocateInfo::default().buffer(buffer.handle);
        let mut export = vk::ExportMemoryAllocateInfo::default().handle_types(HANDLE);
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(needs.size)
            .memory_type_index(kind)
            .push_next(&mut dedicated)
            .push_next(&mut export);
        // SAFETY: a plain allocation; the buffer frees it.
        let memory = unsafe { gpu.device.allocate_memory(&info, None) }
            .map_err(|_| out_of_memory(name, needs.size))?;
        buffer.memory = Memory::Handed {
            memory,
            bytes: needs.size,
            kind,
        };
        // SAFETY: the memory was made for this buffer.
        unsafe { gpu.device.bind_buffer_memory(buffer.handle, memory, 0) }
            .map_err(VulkanError::at(format!("bind the memory of '{name}'")))?;
        Ok(buffer)
    }

    /// Imports another device's shareable buffer.
    ///
    /// # Errors
    /// The devices belong to different physical devices; out of memory.
    pub fn taken(gpu: &Arc<Gpu>, name: &str, from: &Buffer) -> Result<Buffer> {
        use std::os::fd::IntoRawFd;
        let handed = from.hand()?;
        let mut buffer = Buffer::external(gpu, name, from.size)?;
        // SAFETY: the handle is this device's; asking is required before memory is bound.
        let _ = unsafe { gpu.device.get_buffer_memory_requirements(buffer.handle) };
        let file = handed.file.into_raw_fd();
        let mut dedicated = vk::MemoryDedicatedAllocateInfo::default().buffer(buffer.handle);
        let mut import = vk::ImportMemoryFdInfoKHR::default()
            .handle_type(HANDLE)
            .fd(file);
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(handed.bytes)
            .memory_type_index(handed.kind)
            .push_next(&mut dedicated)
            .push_next(&mut import);
        // SAFETY: size and memory type match the exported memory, on a device with the same types
        // (callers compare `DeviceId`s). A successful import owns the descriptor.
        let memory = match unsafe { gpu.device.allocate_memory(&info, None) } {
            Ok(memory) => memory,
            Err(_) => {
                // SAFETY: the import failed, so the descriptor is still this function's own.
                drop(unsafe {
                    <std::os::fd::OwnedFd as std::os::fd::FromRawFd>::from_raw_fd(file)
                });
                return Err(out_of_memory(name, handed.bytes));
            }
        };
        buffer.memory = Memory::Handed {
            memory,
            bytes: handed.bytes,
            kind: handed.kind,
        };
        // SAFETY: the memory was made for a buffer of this size and usage.
        unsafe { gpu.device.bind_buffer_memory(buffer.handle, memory, 0) }
            .map_err(VulkanError::at(format!("bind the memory of '{name}'")))?;
        Ok(buffer)
    }

    fn hand(&self) -> Result<Handed> {
        use std::os::fd::{FromRawFd, OwnedFd};
        let Memory::Handed {
            memory,
            bytes,
            kind,
        } = self.memory
        else {
            return Err(VulkanError::Window(
                "a picture's memory cannot be shared".into(),
            ));
        };
        let loader = khr::external_memory_fd::Device::new(&self.gpu.instance, &self.gpu.device);
        let info = vk::MemoryGetFdInfoKHR::default()
            .memory(memory)
            .handle_type(HANDLE);
        // SAFETY: the memory was allocated for export with this handle type; each call creates a
        // new descriptor.
        let file = unsafe { loader.get_memory_fd(&info) }
            .map_err(VulkanError::at("share a picture's memory"))?;
        // SAFETY: the descriptor is new and has no other owner.
        let file = unsafe { OwnedFd::from_raw_fd(file) };
        Ok(Handed { file, bytes, kind })
    }

    fn external(gpu: &Arc<Gpu>, name: &str, size: u64) -> Result<Buffer> {
        let mut external = vk::ExternalMemoryBufferCreateInfo::default().handle_types(HANDLE);
        Buffer::with(
            gpu,
            name,
            size,
            vk::BufferCreateInfo::default()
                .usage(USAGE)
                .push_next(&mut external),
        )
    }
}

#[cfg(not(unix))]
impl Buffer {
    /// Always fails: buffer sharing is not implemented on this system.
    pub fn shareable(_: &Arc<Gpu>, name: &str, size: u64) -> Result<Buffer> {
        Err(out_of_memory(name, size))
    }

    /// Always fails, like [`Buffer::shareable`].
    pub fn taken(_: &Arc<Gpu>, name: &str, from: &Buffer) -> Result<Buffer> {
        Err(out_of_memory(name, from.size))
    }
}

fn out_of_memory(name: &str, bytes: u64) -> VulkanError {
    VulkanError::OutOfMemory {
        what: format!("'{name}'"),
        mib: bytes as f64 / f64::from(1 << 20),
    }
}

impl Commands<'_> {
    /// Releases a shared buffer, written by copies, to the other device.
    pub fn hand_over(&mut self, buffer: &Buffer) {
        let copy = (
            vk::PipelineStageFlags2::ALL_TRANSFER,
            vk::AccessFlags2::TRANSFER_WRITE,
        );
        let none = (vk::PipelineStageFlags2::NONE, vk::AccessFlags2::NONE);
        self.pass_on(
            buffer,
            (self.family(), vk::QUEUE_FAMILY_EXTERNAL),
            copy,
            none,
        );
    }

    /// Acquires a shared buffer from the other device, to copy from.
    pub fn take_over(&mut self, buffer: &Buffer) {
        let copy = (
            vk::PipelineStageFlags2::ALL_TRANSFER,
            vk::AccessFlags2::TRANSFER_READ,
        );
        let none = (vk::PipelineStageFlags2::NONE, vk::AccessFlags2::NONE);
        self.pass_on(
            buffer,
            (vk::QUEUE_FAMILY_EXTERNAL, self.family()),
            none,
            copy,
        );
    }
}
