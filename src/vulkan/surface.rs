//! A window's surface and its swapchain.

use super::{Gpu, Result, VulkanError, vk};
use ash::khr;
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use std::sync::Arc;

/// Window types that can be presented to.
pub trait WindowHandles: HasWindowHandle + HasDisplayHandle + Send + Sync {}
impl<T: HasWindowHandle + HasDisplayHandle + Send + Sync> WindowHandles for T {}

/// A window's surface, which keeps the window alive.
pub struct Surface {
    gpu: Arc<Gpu>,
    pub(super) loader: khr::surface::Instance,
    pub(super) handle: vk::SurfaceKHR,
    window: Arc<dyn WindowHandles>,
}

impl Surface {
    /// Creates the surface of a window.
    ///
    /// # Errors
    /// The device cannot present to it.
    pub fn new(gpu: &Arc<Gpu>, window: Arc<dyn WindowHandles>) -> Result<Surface> {
        let loader = khr::surface::Instance::new(&gpu.entry, &gpu.instance);
        let handle = create(gpu, &window)?;
        let surface = Surface {
            gpu: gpu.clone(),
            loader,
            handle,
            window,
        };
        // SAFETY: device and surface belong to one instance.
        let supported = unsafe {
            surface.loader.get_physical_device_surface_support(
                gpu.physical,
                gpu.family,
                surface.handle,
            )
        };
        match supported {
            Ok(true) => Ok(surface),
            _ => Err(VulkanError::CannotPresent(gpu.info.name.clone())),
        }
    }

    /// Recreates a lost surface.
    pub(super) fn renew(&mut self) -> Result<()> {
        let handle = create(&self.gpu, &self.window)?;
        // SAFETY: no swapchain of the old surface is alive.
        unsafe { self.loader.destroy_surface(self.handle, None) };
        self.handle = handle;
        Ok(())
    }
}

fn create(gpu: &Gpu, window: &Arc<dyn WindowHandles>) -> Result<vk::SurfaceKHR> {
    let unavailable = |e: raw_window_handle::HandleError| VulkanError::Window(e.to_string());
    let display = window.display_handle().map_err(unavailable)?.as_raw();
    let handle = window.window_handle().map_err(unavailable)?.as_raw();
    // SAFETY: the handles are valid while `window` lives, which the surface keeps.
    unsafe { ash_window::create_surface(&gpu.entry, &gpu.instance, display, handle, None) }
        .map_err(VulkanError::at("make the window's surface"))
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: its swapchain was dropped before.
        unsafe { self.loader.destroy_surface(self.handle, None) };
    }
}

/// The images of a window.
pub(super) struct Swapchain {
    gpu: Arc<Gpu>,
    pub loader: khr::swapchain::Device,
    pub handle: vk::SwapchainKHR,
    pub extent: vk::Extent2D,
    pub format: vk::Format,
    pub images: Vec<vk::Image>,
    pub views: Vec<vk::ImageView>,
    /// Signalled when an image has been rendered.
    pub drawn: Vec<vk::Semaphore>,
}

impl Swapchain {
    /// Makes views and semaphores of the images.
    fn fill(&mut self) -> std::result::Result<(), vk::Result> {
        // SAFETY: the objects belong to this device; `drop` destroys them.
        unsafe {
            self.images = self.loader.get_swapchain_images(self.handle)?;
            for image in &self.images {
                let info = vk::ImageViewCreateInfo::default()
                    .image(*image)
                    .view_type(vk::ImageViewType::TYPE_2D)
                    .format(self.format)
                    .subresource_range(WHOLE);
                let device = &self.gpu.device;
                self.views.push(device.create_image_view(&info, None)?);
                let semaphore = device.create_semaphore(&Default::default(), None)?;
                self.drawn.push(semaphore);
            }
        }
        Ok(())
    }

    /// Images for a surface size; `None` if the window has no area.
    pub fn new(gpu: &Arc<Gpu>, surface: &Surface, size: (u32, u32)) -> Result<Option<Swapchain>> {
        let at = || VulkanError::at("make the window's images");
        // SAFETY: device and surface belong to one instance; `drop` destroys the created objects.
        unsafe {
            let physical = gpu.physical;
            let (loader, handle) = (&surface.loader, surface.handle);
            let can = loader.get_physical_device_surface_capabilities(physical, handle);
            let can = can.map_err(at())?;
            let formats = loader.get_physical_device_surface_formats(physical, handle);
            let format = format_of(&formats.map_err(at())?)
                .ok_or_else(|| VulkanError::CannotPresent(gpu.info.name.clone()))?;
            let extent = extent_of(&can, size);
            if [extent.width, extent.height, size.0, size.1].contains(&0) {
                return Ok(None);
            }
            let most = match can.max_image_count {
                0 => u32::MAX,
                most => most,
            };
            type Alpha = vk::CompositeAlphaFlagsKHR;
            let have = can.supported_composite_alpha;
            let inherits = have.contains(Alpha::INHERIT) && !have.contains(Alpha::OPAQUE);
            let alpha = if inherits {
                Alpha::INHERIT
            } else {
                Alpha::OPAQUE
            };
            let info = vk::SwapchainCreateInfoKHR::default()
                .surface(surface.handle)
                .min_image_count((can.min_image_count + 1).min(most))
                .image_format(format.format)
                .image_color_space(format.color_space)
                .image_extent(extent)
                .image_array_layers(1)
                .image_usage(vk::ImageUsageFlags::COLOR_ATTACHMENT)
                .pre_transform(can.current_transform)
                .composite_alpha(alpha)
                .present_mode(vk::PresentModeKHR::FIFO)
                .clipped(true);
            let loader = khr::swapchain::Device::new(&gpu.instance, &gpu.device);
            let handle = loader.create_swapchain(&info, None).map_err(at())?;
            let mut made = Swapchain {
                gpu: gpu.clone(),
                loader,
                handle,
                extent,
                format: format.format,
                images: Vec::new(),
                views: Vec::new(),
                drawn: Vec::new(),
            };
            made.fill().map_err(at())?;
            Ok(Some(made))
        }
    }
}

/// The only mip and layer of a window's image.
pub(super) const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

impl Drop for Swapchain {
    fn drop(&mut self) {
        // SAFETY: waits for everything that draws into or presents the images.
        unsafe {
            let _ = self.gpu.device.device_wait_idle();
            for view in &self.views {
                self.gpu.device.destroy_image_view(*view, None);
            }
            for semaphore in &self.drawn {
                self.gpu.device.destroy_semaphore(*semaphore, None);
            }
            self.loader.destroy_swapchain(self.handle, None);
        }
    }
}

/// sRGB formats preserve pictures. Without them the painter encodes itself, with an error of a few
/// steps of 255.
fn format_of(formats: &[vk::SurfaceFormatKHR]) -> Option<vk::SurfaceFormatKHR> {
    let wanted = [
        vk::Format::B8G8R8A8_SRGB,
        vk::Format::R8G8B8A8_SRGB,
        vk::Format::B8G8R8A8_UNORM,
        vk::Format::R8G8B8A8_UNORM,
    ];
    let mut found = wanted.iter();
    let found = found.find_map(|w| formats.iter().find(|f| f.format == *w));
    found.or(formats.first()).copied()
}

/// Wayland leaves the size to the program.
fn extent_of(can: &vk::SurfaceCapabilitiesKHR, size: (u32, u32)) -> vk::Extent2D {
    let (least, most) = (can.min_image_extent, can.max_image_extent);
    match can.current_extent.width == u32::MAX {
        true => vk::Extent2D {
            width: size.0.clamp(least.width, most.width),
            height: size.1.clamp(least.height, most.height),
        },
        false => can.current_extent,
    }
}
