//! Instance, device, queue, allocator and pipeline cache.

use super::clock::{Clock, ClockExtension};
use super::debug::{Messages, Names, messenger_info};
use super::{DeviceId, Result, VulkanError};
use crate::files::content_id;
use ash::{Entry, ext, khr, nv, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use std::ffi::{CStr, CString};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};
use std::time::{Duration, Instant};

/// Options for opening a device.
#[derive(Clone, Debug, Default)]
pub struct GpuOptions {
    /// Part of the device's name, or its number in `conelab devices`. Default: the fastest kind of
    /// device.
    pub device: Option<String>,
    /// Enables the validation layer with synchronization validation.
    pub validation: bool,
    /// Optional features that are not used, even if the device has them.
    pub without: Vec<String>,
    /// Bytes of device memory that graphs may use; the device's own when absent.
    pub memory: Option<u64>,
    /// Folder for the pipeline cache; none when absent.
    pub cache: Option<PathBuf>,
    /// Time limit of a frame before the device counts as hung; ten times longer on software
    /// devices. Default: none.
    pub patience: Option<Duration>,
    /// Injected faults, for tests.
    pub faults: Option<Arc<Faults>>,
}

/// Faults that a test injects into the next wait for a device. They imitate a driver reset and a
/// shader that never ends, on devices that have neither.
#[derive(Debug, Default)]
pub struct Faults(AtomicU8);

impl Faults {
    /// The next wait reports a lost device.
    pub fn lose(&self) {
        self.0.store(1, Ordering::Relaxed);
    }

    /// The next wait uses a fence that is never signalled.
    pub fn hang(&self) {
        self.0.store(2, Ordering::Relaxed);
    }

    /// The next wait panics.
    pub fn panic(&self) {
        self.0.store(3, Ordering::Relaxed);
    }
}

/// Duration of a wait after [`Faults::hang`].
const SHORT: Duration = Duration::from_millis(50);

/// Optional device features, enabled only by the switches that need them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Features {
    /// `VK_EXT_conservative_rasterization`, overestimating.
    pub conservative_rasterization: bool,
    pub(crate) geometry: bool,
    pub(crate) tessellation: bool,
    /// Stores and atomics in fragment shaders.
    pub fragment_stores: bool,
    /// Stores and atomics in vertex, tessellation and geometry shaders.
    pub vertex_stores: bool,
    /// `gl_ClipDistance`.
    pub(crate) clip_distance: bool,
    /// Clamping of depth instead of clipping.
    pub depth_clamp: bool,
    /// BC1 to BC7 textures.
    pub(crate) bc: bool,
    pub(crate) anisotropy: bool,
    /// Storage images can be written without a format in the shader.
    pub write_without_format: bool,
    /// Several indirect draws in one call.
    pub(crate) multi_draw_indirect: bool,
    /// Attachments of one pass can blend differently.
    pub(crate) independent_blend: bool,
    /// Vertex indices above 2^24.
    pub(crate) full_index: bool,
    /// 64-bit integers in shaders, and atomics on them in buffers.
    pub(crate) int64_atomics: bool,
    /// `VK_KHR_pipeline_executable_properties`.
    pub pipeline_statistics: bool,
    /// The device's clock can be read next to the CPU's.
    pub(crate) clock: ClockExtension,
    /// Buffers can be shared with another device of the same physical device.
    pub(crate) shares_memory: bool,
    /// Non-conformant implementation with VK_KHR_portability_subset (MoltenVK).
    pub(crate) portability: bool,
}

/// Properties of a device.
#[derive(Clone, Debug)]
pub struct DeviceInfo {
    /// Device name as the driver gives it.
    pub name: String,
    /// Driver name and version.
    pub driver: String,
    /// Supported Vulkan version.
    pub api: String,
    /// discrete, integrated, virtual, cpu or other.
    pub kind: &'static str,
    /// Nanoseconds per timestamp tick; 0 if the queue has no timestamps.
    pub timestamp_ns: f64,
    /// Valid bits of a timestamp; the counter wraps above them.
    pub(crate) timestamp_mask: u64,
    pub(crate) limits: vk::PhysicalDeviceLimits,
    /// Size of the largest device-local heap (bytes).
    pub heap: u64,
    /// Optional features.
    pub features: Features,
    /// Most resident warps per multiprocessor (`VK_NV_shader_sm_builtins`).
    pub(crate) warps: Option<u32>,
    /// Identity of the physical device and driver.
    pub id: DeviceId,
    cache_key: String,
}

impl DeviceInfo {
    /// Milliseconds between two timestamps, including one wrap of the counter; 0 if the second is
    /// earlier.
    pub(crate) fn ms_between(&self, from: u64, to: u64) -> f64 {
        let ticks = to.wrapping_sub(from) & self.timestamp_mask;
        if ticks > self.timestamp_mask / 2 {
            0.0
        } else {
            ticks as f64 * self.timestamp_ns * 1e-6
        }
    }

    /// Names the device, its driver and the features that may be used, in a few letters that fit into
    /// a file's name.
    pub fn key(&self) -> String {
        let features = content_id([format!("{:?}", self.features)], 8);
        format!("{}-{features}", self.cache_key)
    }

    /// Whether GPU times have a place on the CPU's time line.
    pub fn calibrates(&self) -> bool {
        self.features.clock != ClockExtension::None
    }

    /// A fictitious device with these features and generous limits, for checks without a device.
    pub fn imaginary(features: Features) -> DeviceInfo {
        let limits = vk::PhysicalDeviceLimits {
            max_image_dimension2_d: 16384,
            max_image_dimension3_d: 4096,
            max_image_array_layers: 2048,
            max_storage_buffer_range: u32::MAX,
            max_viewport_dimensions: [16384; 2],
            max_framebuffer_width: 16384,
            max_framebuffer_height: 16384,
            max_compute_work_group_count: [65535; 3],
            framebuffer_no_attachments_sample_counts: vk::SampleCountFlags::from_raw(0x1f),
            ..Default::default()
        };
        DeviceInfo {
            name: "any device".into(),
            driver: String::new(),
            api: String::new(),
            kind: "none",
            timestamp_ns: 0.0,
            timestamp_mask: u64::MAX,
            limits,
            heap: u64::MAX,
            warps: None,
            features,
            id: DeviceId::default(),
            cache_key: String::new(),
        }
    }
}

/// An open device with one graphics and compute queue.
pub struct Gpu {
    pub(super) device: ash::Device,
    pub(super) queue: Mutex<vk::Queue>,
    pub(super) family: u32,
    pub(super) allocator: Mutex<Option<Allocator>>,
    pub(super) pipeline_cache: vk::PipelineCache,
    pub(super) names: Option<Names>,
    pub(super) clock: Option<Clock>,
    pub(super) executables: Option<khr::pipeline_executable_properties::Device>,
    /// Properties of the device.
    pub info: DeviceInfo,
    cache_file: Option<PathBuf>,
    patience: Option<Duration>,
    hung: AtomicBool,
    faults: Option<Arc<Faults>>,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Messages>,
    pub(super) physical: vk::PhysicalDevice,
    pub(super) instance: ash::Instance,
    pub(super) entry: Entry,
}

/// Held while a device is opened or closed. NVIDIA's driver (580.159) may hang in `vkDestroyDevice`
/// while another thread of the process opens or closes a device. This happened in one of six runs
/// of 22 tests with a device each, and in none of 48 serialised runs.
static DOOR: Mutex<()> = Mutex::new(());

/// Locks [`DOOR`], but not behind a driver that hangs.
fn door() -> Option<MutexGuard<'static, ()>> {
    const LONGEST: Duration = Duration::from_secs(5);
    let since = Instant::now();
    loop {
        match DOOR.try_lock() {
            Ok(guard) => return Some(guard),
            Err(TryLockError::Poisoned(poisoned)) => return Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) if since.elapsed() > LONGEST => return None,
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(1)),
        }
    }
}

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

fn load() -> Result<Entry> {
    // SAFETY: loads the system's Vulkan loader; its initialisation has no preconditions.
    unsafe { Entry::load() }.map_err(|e| VulkanError::Loader(e.to_string()))
}

fn create_instance(
    entry: &Entry,
    validation: bool,
    display: Option<raw_window_handle::RawDisplayHandle>,
    messages: &Messages,
) -> Result<(ash::Instance, bool)> {
    // SAFETY: plain enumeration and creation calls with structures that outlive them.
    unsafe {
        let layers = entry
            .enumerate_instance_layer_properties()
            .map_err(VulkanError::at("list layers"))?;
        let is_validation = |l: &vk::LayerProperties| l.layer_name_as_c_str() == Ok(VALIDATION);
        if validation && !layers.iter().any(is_validation) {
            return Err(VulkanError::NoValidation);
        }
        let extensions = entry
            .enumerate_instance_extension_properties(None)
            .map_err(VulkanError::at("list extensions"))?;
        let debug_utils = super::has(&extensions, ext::debug_utils::NAME) || validation;
        // If all devices are non-conformant, the loader hides them unless enumeration of
        // portability drivers is enabled.
        let portability = cfg!(target_os = "macos")
            && super::has(&extensions, khr::portability_enumeration::NAME);
        let layer_names = Vec::from_iter(validation.then_some(VALIDATION.as_ptr()));
        let debug_name = debug_utils.then_some(ext::debug_utils::NAME.as_ptr());
        let mut extension_names = Vec::from_iter(debug_name);
        let mut flags = vk::InstanceCreateFlags::empty();
        if portability {
            extension_names.push(khr::portability_enumeration::NAME.as_ptr());
            flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
        }
        if let Some(display) = display {
            let needed = ash_window::enumerate_required_extensions(display)
                .map_err(VulkanError::at("present to this window"))?;
            extension_names.extend_from_slice(needed);
        }
        let app = vk::ApplicationInfo::default()
            .application_name(c"conelab")
            .api_version(vk::API_VERSION_1_3);
        let enables = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features =
            vk::ValidationFeaturesEXT::default().enabled_validation_features(&enables);
        let mut messenger = messenger_info(messages);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&app)
            .flags(flags)
            .enabled_layer_names(&layer_names)
            .enabled_extension_names(&extension_names);
        if validation {
            info = info.push_next(&mut features).push_next(&mut messenger);
        }
        let instance = entry
            .create_instance(&info, None)
            .map_err(VulkanError::at("create an instance"))?;
        Ok((instance, debug_utils))
    }
}

/// Mask of the valid timestamp bits (VkQueueFamilyProperties).
fn mask_of(valid_bits: u32) -> u64 {
    u64::MAX.checked_shr(64 - valid_bits.min(64)).unwrap_or(0)
}

fn allocator(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: &ash::Device,
) -> Result<Allocator> {
    Allocator::new(&AllocatorCreateDesc {
        instance: instance.clone(),
        device: device.clone(),
        physical_device,
        debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
        buffer_device_address: false,
        // Small blocks: software devices have one heap of 2 GiB, and large images use dedicated
        // allocations.
        allocation_sizes: gpu_allocator::AllocationSizes::new(32 << 20, 16 << 20),
    })
    .map_err(|e| VulkanError::OutOfMemory {
        what: format!("the allocator ({e})"),
        mib: 0.0,
    })
}

pub(super) fn text(c: &[std::ffi::c_char]) -> String {
    let bytes = c.iter().take_while(|&&b| b != 0).map(|b| b.cast_unsigned());
    String::from_utf8_lossy(&bytes.collect::<Vec<u8>>()).into_owned()
}

fn version_text(version: u32) -> String {
    let (major, minor) = (
        vk::api_version_major(version),
        vk::api_version_minor(version),
    );
    format!("{major}.{minor}.{}", vk::api_version_patch(version))
}

fn kind_of(kind: vk::PhysicalDeviceType) -> &'static str {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => "discrete",
        vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated",
        vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual",
        vk::PhysicalDeviceType::CPU => "cpu",
        _ => "other",
    }
}

fn describe(instance: &ash::Instance, physical: vk::PhysicalDevice) -> DeviceInfo {
    // SAFETY: `physical` comes from this instance; the chained structures live through the calls.
    unsafe {
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut ids = vk::PhysicalDeviceIDProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default()
            .push_next(&mut driver)
            .push_next(&mut ids);
        instance.get_physical_device_properties2(physical, &mut properties);
        let core = properties.properties;
        let mut have12 = vk::PhysicalDeviceVulkan12Features::default();
        let mut all = vk::PhysicalDeviceFeatures2::default().push_next(&mut have12);
        instance.get_physical_device_features2(physical, &mut all);
        let have = all.features;
        let extensions = instance
            .enumerate_device_extension_properties(physical)
            .unwrap_or_default();
        let mut builtins = vk::PhysicalDeviceShaderSMBuiltinsPropertiesNV::default();
        if super::has(&extensions, nv::shader_sm_builtins::NAME) {
            let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut builtins);
            instance.get_physical_device_properties2(physical, &mut properties);
        }
        let memory = instance.get_physical_device_memory_properties(physical);
        let local = |h: &&vk::MemoryHeap| h.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL);
        let heaps = memory.memory_heaps_as_slice().iter().filter(local);
        let (name, more) = (text(&driver.driver_name), text(&driver.driver_info));
        let families = instance.get_physical_device_queue_family_properties(physical);
        let family =
            queue_family(instance, physical).and_then(|f| families.get(f as usize).copied());
        // Timers with fewer bits would wrap within a frame or two.
        let timestamps = family.is_some_and(|f| f.timestamp_valid_bits >= 36);
        DeviceInfo {
            name: text(&core.device_name),
            driver: format!("{name} {more}").trim().to_string(),
            api: version_text(core.api_version),
            kind: kind_of(core.device_type),
            timestamp_mask: family.map_or(u64::MAX, |f| mask_of(f.timestamp_valid_bits)),
            timestamp_ns: match timestamps {
                true => f64::from(core.limits.timestamp_period),
                false => 0.0,
            },
            limits: core.limits,
            warps: Some(builtins.shader_warps_per_sm).filter(|n| *n > 0),
            heap: heaps.map(|h| h.size).max().unwrap_or(0),
            features: Features {
                // Anisotropic filtering costs software devices seconds per frame.
                anisotropy: have.sampler_anisotropy == vk::TRUE
                    && core.device_type != vk::PhysicalDeviceType::CPU,
                pipeline_statistics: reports_pipelines(instance, physical, &extensions),
                shares_memory: super::share::is_supported(instance, physical, &extensions),
                ..features(&have, &have12, &extensions)
            },
            id: DeviceId {
                device: ids.device_uuid,
                driver: ids.driver_uuid,
            },
            cache_key: format!(
                "{:04x}-{:04x}-{:08x}-{}",
                core.vendor_id,
                core.device_id,
                core.driver_version,
                crate::files::hex(&core.pipeline_cache_uuid)
            ),
        }
    }
}

/// Whether a device reports statistics of pipelines.
fn reports_pipelines(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    extensions: &[vk::ExtensionProperties],
) -> bool {
    if !super::has(extensions, khr::pipeline_executable_properties::NAME) {
        return false;
    }
    let mut have = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut have);
    // SAFETY: `physical` comes from this instance and has the extension.
    unsafe { instance.get_physical_device_features2(physical, &mut features) };
    have.pipeline_executable_info == vk::TRUE
}

/// The optional features that a device reports.
fn features(
    have: &vk::PhysicalDeviceFeatures,
    have12: &vk::PhysicalDeviceVulkan12Features,
    extensions: &[vk::ExtensionProperties],
) -> Features {
    Features {
        conservative_rasterization: super::has(extensions, ext::conservative_rasterization::NAME),
        geometry: have.geometry_shader == vk::TRUE,
        tessellation: have.tessellation_shader == vk::TRUE,
        fragment_stores: have.fragment_stores_and_atomics == vk::TRUE,
        vertex_stores: have.vertex_pipeline_stores_and_atomics == vk::TRUE,
        clip_distance: have.shader_clip_distance == vk::TRUE,
        depth_clamp: have.depth_clamp == vk::TRUE,
        bc: have.texture_compression_bc == vk::TRUE,
        write_without_format: have.shader_storage_image_write_without_format == vk::TRUE,
        multi_draw_indirect: have.multi_draw_indirect == vk::TRUE
            && have.draw_indirect_first_instance == vk::TRUE,
        independent_blend: have.independent_blend == vk::TRUE,
        full_index: have.full_draw_index_uint32 == vk::TRUE,
        int64_atomics: have.shader_int64 == vk::TRUE
            && have12.shader_buffer_int64_atomics == vk::TRUE,
        clock: ClockExtension::of(extensions),
        portability: super::has(extensions, khr::portability_subset::NAME),
        ..Features::default()
    }
}

/// The reason why a device cannot be used, or `None`.
fn refusal(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<String> {
    // SAFETY: as in `describe`.
    unsafe {
        let properties = instance.get_physical_device_properties(physical);
        if properties.api_version < vk::API_VERSION_1_3 {
            return Some("Vulkan older than 1.3".into());
        }
        let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
        let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut v13);
        instance.get_physical_device_features2(physical, &mut features);
        if v13.dynamic_rendering == vk::FALSE || v13.synchronization2 == vk::FALSE {
            return Some("no dynamic rendering or synchronization2".into());
        }
        queue_family(instance, physical)
            .is_none()
            .then(|| "no queue with graphics and compute".into())
    }
}

fn queue_family(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<u32> {
    let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    // SAFETY: `physical` comes from this instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    families
        .iter()
        .position(|f| f.queue_flags.contains(wanted))
        .and_then(|i| u32::try_from(i).ok())
}

fn physical_devices(instance: &ash::Instance) -> Result<Vec<vk::PhysicalDevice>> {
    // SAFETY: the instance is alive.
    unsafe { instance.enumerate_physical_devices() }.map_err(VulkanError::at("list devices"))
}

/// Every device with the reason why it cannot be used, in the order of the numbers of
/// `GpuOptions::device`.
pub fn list_devices() -> Result<Vec<(DeviceInfo, Option<String>)>> {
    let entry = load()?;
    let messages = Messages::default();
    let (instance, _) = create_instance(&entry, false, None, &messages)?;
    let list = physical_devices(&instance).map(|all| {
        all.into_iter()
            .map(|p| (describe(&instance, p), refusal(&instance, p)))
            .collect()
    });
    // SAFETY: nothing made from the instance is alive any more.
    unsafe { instance.destroy_instance(None) };
    list
}

fn choose(instance: &ash::Instance, wanted: Option<&str>) -> Result<vk::PhysicalDevice> {
    let mut found = Vec::new();
    let mut usable = Vec::new();
    for (number, physical) in physical_devices(instance)?.into_iter().enumerate() {
        let info = describe(instance, physical);
        match refusal(instance, physical) {
            Some(why) => found.push(format!("{number}: {} ({why})", info.name)),
            None => {
                found.push(format!("{number}: {}", info.name));
                usable.push((number, physical, info));
            }
        }
    }
    let matches = |number: usize, info: &DeviceInfo| match wanted {
        None => true,
        // A number selects by index even if names contain digits.
        Some(w) if w.parse::<usize>().is_ok() => w == number.to_string(),
        Some(w) => info.name.to_lowercase().contains(&w.to_lowercase()),
    };
    let rank = |info: &DeviceInfo| match info.kind {
        "discrete" => 0,
        "integrated" => 1,
        "virtual" => 2,
        _ => 3,
    };
    usable
        .into_iter()
        .filter(|(number, _, info)| matches(*number, info))
        .min_by_key(|(number, _, info)| (rank(info), *number))
        .map(|(_, physical, _)| physical)
        .ok_or_else(|| VulkanError::NoDevice {
            wanted: wanted.map_or(String::from("with graphics and compute"), |w| {
                format!("named '{w}'")
            }),
            found: if found.is_empty() {
                "none".into()
            } else {
                found.join(", ")
            },
        })
}

impl Gpu {
    /// Opens a device.
    pub fn open(options: &GpuOptions) -> Result<Arc<Gpu>> {
        Gpu::open_for(options, None)
    }

    /// Opens a device that can present to windows.
    pub fn open_for(
        options: &GpuOptions,
        display: Option<raw_window_handle::RawDisplayHandle>,
    ) -> Result<Arc<Gpu>> {
        let _door = door();
        let entry = load()?;
        let messages = Box::new(Messages::default());
        let (instance, debug_utils) =
            create_instance(&entry, options.validation, display, &messages)?;
        let messenger = if options.validation {
            let api = ext::debug_utils::Instance::new(&entry, &instance);
            // SAFETY: the callback's user data is the boxed message list, which outlives the
            // messenger.
            let handle =
                unsafe { api.create_debug_utils_messenger(&messenger_info(&messages), None) }
                    .map_err(VulkanError::at("create the debug messenger"))?;
            Some((api, handle))
        } else {
            None
        };
        let physical = choose(&instance, options.device.as_deref())?;
        let mut info = describe(&instance, physical);
        super::mask::apply(&mut info, &options.without)?;
        info.heap = info.heap.min(options.memory.unwrap_or(u64::MAX));
        let family = queue_family(&instance, physical).unwrap_or(0);
        let presents = display.is_some();
        let device = create_device(&instance, physical, family, &info.features, presents)?;
        // SAFETY: the family and index were used to create the device.
        let queue = unsafe { device.get_device_queue(family, 0) };
        let allocator = allocator(&instance, physical, &device)?;
        let cache = options.cache.as_ref();
        let cache_file = cache.map(|dir| dir.join(format!("pipelines-{}", info.cache_key)));
        let blob = cache_file.as_deref().and_then(crate::files::read_checked);
        let blob = blob.unwrap_or_default();
        let cache_info = vk::PipelineCacheCreateInfo::default().initial_data(&blob);
        // SAFETY: the driver checks the blob's header; a checksum verified its content.
        let pipeline_cache = unsafe { device.create_pipeline_cache(&cache_info, None) }
            .map_err(VulkanError::at("create the pipeline cache"))?;
        let times = if info.kind == "cpu" { 10 } else { 1 };
        let patience = options.patience.map(|p| p * times);
        let names = debug_utils.then(|| Names {
            device: ext::debug_utils::Device::new(&instance, &device),
        });
        let clock = Clock::new(&entry, &instance, physical, &device, info.features.clock);
        let executables = info
            .features
            .pipeline_statistics
            .then(|| khr::pipeline_executable_properties::Device::new(&instance, &device));
        Ok(Arc::new(Gpu {
            clock,
            executables,
            device,
            queue: Mutex::new(queue),
            family,
            allocator: Mutex::new(Some(allocator)),
            pipeline_cache,
            names,
            info,
            cache_file,
            patience,
            hung: AtomicBool::new(false),
            faults: options.faults.clone(),
            messenger,
            messages,
            physical,
            instance,
            entry,
        }))
    }

    /// Waits for a fence up to the time limit. After a timeout the device counts as hung for good.
    pub(super) fn wait_for(&self, fence: vk::Fence) -> Result<()> {
        let at = || VulkanError::at("wait for a frame");
        let hung = || VulkanError::Hung(self.patience.unwrap_or_default().as_secs_f64());
        if self.is_hung() {
            return Err(hung());
        }
        let (mut fence, mut patience) = (fence, self.patience);
        match self
            .faults
            .as_ref()
            .map_or(0, |f| f.0.swap(0, Ordering::Relaxed))
        {
            0 => {}
            1 => return Err(at()(vk::Result::ERROR_DEVICE_LOST)),
            2 => {
                // SAFETY: a plain creation; a hung device leaks its objects.
                fence = unsafe {
                    self.device
                        .create_fence(&vk::FenceCreateInfo::default(), None)
                }
                .map_err(at())?;
                patience = Some(SHORT);
            }
            _ => panic!("a panic injected by a test"),
        }
        let limit = patience.map_or(u64::MAX, |p| {
            u64::try_from(p.as_nanos()).unwrap_or(u64::MAX)
        });
        // SAFETY: the fence is this device's.
        match unsafe { self.device.wait_for_fences(&[fence], true, limit) } {
            Err(vk::Result::TIMEOUT) => {
                self.hung.store(true, Ordering::Relaxed);
                Err(hung())
            }
            waited => waited.map_err(at()),
        }
    }

    /// Time limit of a frame; `None` is unlimited.
    pub fn patience(&self) -> Option<Duration> {
        self.patience
    }

    /// Whether a frame exceeded the time limit. Objects of a hung device are never destroyed,
    /// because its work may continue.
    pub fn is_hung(&self) -> bool {
        self.hung.load(Ordering::Relaxed)
    }

    /// Messages of the validation layer; empty without it.
    pub fn messages(&self) -> Vec<String> {
        self.messages
            .0
            .lock()
            .map(|m| m.clone())
            .unwrap_or_default()
    }

    /// Writes the pipeline cache to disk atomically. A failure only slows down the next start.
    fn save_pipeline_cache(&self) {
        let Some(file) = &self.cache_file else { return };
        // SAFETY: the cache is alive.
        if let Ok(blob) = unsafe { self.device.get_pipeline_cache_data(self.pipeline_cache) } {
            let _ = crate::files::write_checked(file, &blob);
        }
    }

    pub(super) fn name<H: vk::Handle>(&self, handle: H, name: &str) {
        let Some(names) = &self.names else { return };
        let Ok(text) = CString::new(name) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default()
            .object_handle(handle)
            .object_name(&text);
        // SAFETY: the handle belongs to this device. A debugger's label has no effect if it fails.
        let _ = unsafe { names.device.set_debug_utils_object_name(&info) };
    }
}

fn create_device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    family: u32,
    have: &Features,
    present: bool,
) -> Result<ash::Device> {
    let features = vk::PhysicalDeviceFeatures::default()
        .geometry_shader(have.geometry)
        .tessellation_shader(have.tessellation)
        .fragment_stores_and_atomics(have.fragment_stores)
        .vertex_pipeline_stores_and_atomics(have.vertex_stores)
        .shader_clip_distance(have.clip_distance)
        .depth_clamp(have.depth_clamp)
        .texture_compression_bc(have.bc)
        .sampler_anisotropy(have.anisotropy)
        .shader_storage_image_write_without_format(have.write_without_format)
        .multi_draw_indirect(have.multi_draw_indirect)
        .draw_indirect_first_instance(have.multi_draw_indirect)
        .independent_blend(have.independent_blend)
        .full_draw_index_uint32(have.full_index)
        .shader_int64(have.int64_atomics)
        .robust_buffer_access(true);
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .synchronization2(true)
        .maintenance4(true)
        .robust_image_access(true);
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default()
        .host_query_reset(true)
        .uniform_buffer_standard_layout(true)
        .shader_buffer_int64_atomics(have.int64_atomics);
    let priorities = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(family)
        .queue_priorities(&priorities)];
    let extensions: Vec<_> = have
        .conservative_rasterization
        .then(|| ext::conservative_rasterization::NAME.as_ptr())
        .into_iter()
        .chain(present.then(|| khr::swapchain::NAME.as_ptr()))
        .chain(
            have.shares_memory
                .then(|| khr::external_memory_fd::NAME.as_ptr()),
        )
        .chain(
            have.portability
                .then(|| khr::portability_subset::NAME.as_ptr()),
        )
        .chain(
            have.pipeline_statistics
                .then(|| khr::pipeline_executable_properties::NAME.as_ptr()),
        )
        .chain(have.clock.name().map(std::ffi::CStr::as_ptr))
        .collect();
    let mut executables = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
        .pipeline_executable_info(true);
    let mut info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .enabled_features(&features)
        .push_next(&mut v13)
        .push_next(&mut v12);
    if have.pipeline_statistics {
        info = info.push_next(&mut executables);
    }
    // SAFETY: this device supports every enabled feature and extension.
    unsafe { instance.create_device(physical, &info, None) }
        .map_err(VulkanError::at("open the device"))
}

impl Drop for Gpu {
    fn drop(&mut self) {
        if self.is_hung() {
            // Pending work may use all allocations until the process ends.
            if let Ok(mut allocator) = self.allocator.lock() {
                std::mem::forget(allocator.take());
            }
            std::mem::forget(self.entry.clone());
            return;
        }
        self.save_pipeline_cache();
        // SAFETY: the device is alive. The wait may be long, so the lock is not held.
        let _ = unsafe { self.device.device_wait_idle() };
        let _door = door();
        // SAFETY: every object of the device holds an `Arc` of this, so all are destroyed; the
        // allocator frees its memory before the device.
        unsafe {
            self.device
                .destroy_pipeline_cache(self.pipeline_cache, None);
            if let Ok(mut allocator) = self.allocator.lock() {
                allocator.take();
            }
            self.device.destroy_device(None);
            if let Some((api, handle)) = self.messenger.take() {
                api.destroy_debug_utils_messenger(handle, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn timestamps_that_start_over_give_their_time() {
        let info = |bits: u32| DeviceInfo {
            timestamp_ns: 50.0,
            timestamp_mask: mask_of(bits),
            ..DeviceInfo::imaginary(Features::default())
        };
        let last = (1u64 << 36) - 1;
        assert_eq!(info(36).ms_between(last - 9_999, 10_000), 1.0);
        assert_eq!(info(36).ms_between(5, 20_005), 1.0);
        assert_eq!(info(64).ms_between(u64::MAX - 9_999, 10_000), 1.0);
        // Timestamps that a device writes out of order.
        assert_eq!(info(36).ms_between(20_005, 5), 0.0);
        assert_eq!((mask_of(0), mask_of(64), mask_of(36)), (0, u64::MAX, last));
    }
}
