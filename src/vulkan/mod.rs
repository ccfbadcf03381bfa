//! A thin layer over Vulkan 1.3: one device and one queue, automatic memory, pipelines, timestamps.
//!
//! Independent of graphs, scenes and voxels. All `unsafe` of the crate is here. Every handle has an
//! owner that keeps the `Gpu` alive and destroys the handle on drop.

#![allow(unsafe_code, reason = "Vulkan is called here and nowhere else")]

mod clock;
mod command;
mod debug;
mod executable;
pub(crate) mod format;
mod gpu;
mod mask;
mod memory;
mod painter;
mod pipeline;
mod sampler;
mod share;
mod surface;

pub(crate) use ash::vk;
pub(crate) use clock::{ClockExtension, ClockReading};
pub(crate) use command::{Commands, FrameSlot, Recording};
pub(crate) use executable::statistics;
pub use executable::{Executable, Statistic};
pub use format::Format;
pub(crate) use gpu::Gpu;
pub use gpu::list_devices;
pub use gpu::{DeviceInfo, Faults, Features, GpuOptions};
pub(crate) use memory::{Bare, Buffer, Image, ImageDesc, Upload, View, ViewDesc, lay_together};
pub(crate) use painter::{Painter, PixelSource, Pixels};
pub use pipeline::Stage;
pub(crate) use pipeline::{
    Attachments, BindingDesc, Blend, DescriptorPool, DescriptorSet, DescriptorWrite, DrawState,
    Pipeline, PipelineDesc, StageDesc,
};
pub(crate) use sampler::{Sampler, SamplerDesc};
pub(crate) use share::DeviceId;
pub(crate) use surface::Surface;

/// Errors of Vulkan, with a remedy for the user.
#[derive(Debug, thiserror::Error)]
pub enum VulkanError {
    /// No loader library on this system.
    #[error("cannot load Vulkan: {0}. Install the Vulkan loader (Debian, Ubuntu: libvulkan1)")]
    Loader(String),
    /// No suitable device; the text lists the devices found.
    #[error(
        "no Vulkan 1.3 device {wanted}: found {found}. A software device comes with the package mesa-vulkan-drivers"
    )]
    NoDevice {
        /// The requested device.
        wanted: String,
        /// The devices found, with the reason why each was rejected.
        found: String,
    },
    /// A feature to be masked is unknown.
    #[error("there is no optional feature '{name}'; --without (CONELAB_WITHOUT) takes {names}")]
    NoFeature {
        /// The name given.
        name: String,
        /// All names.
        names: String,
    },
    /// The requested validation layer is not installed.
    #[error(
        "the Vulkan validation layer is not installed (Debian, Ubuntu: vulkan-validationlayers)"
    )]
    NoValidation,
    /// Device memory ran out.
    #[error(
        "out of device memory: {what} needs {mib:.0} MiB. Reduce the picture size or other settings that determine it"
    )]
    OutOfMemory {
        /// The resource that did not fit.
        what: String,
        /// Size of the resource (MiB).
        mib: f64,
    },
    /// A size above a device limit.
    #[error("{what} is {asked}, and {device} allows at most {limit}")]
    Limit {
        /// The limited quantity.
        what: String,
        /// The requested value.
        asked: String,
        /// The limit of the device.
        limit: String,
        /// Name of the device.
        device: String,
    },
    /// The device or driver lacks something.
    #[error("{device} does not offer {what}")]
    Unsupported {
        /// What is missing.
        what: &'static str,
        /// Name of the device.
        device: String,
    },
    /// The device was lost (a driver's reset, often a shader that runs too long).
    #[error("the GPU was lost during {0}: a shader ran too long, or the driver failed")]
    Lost(String),
    /// A frame exceeded its time limit ([`GpuOptions::patience`]).
    #[error("the GPU has not finished a frame within {0:.0} s: a shader hangs or takes too long")]
    Hung(f64),
    /// The device cannot present to this window.
    #[error(
        "{0} cannot present to this window. Name another device with --window-device (see `conelab devices`)"
    )]
    CannotPresent(String),
    /// Error of the window system.
    #[error("the window failed: {0}")]
    Window(String),
    /// Any other error code.
    #[error("Vulkan failed to {what}: {code}")]
    Code {
        /// The failed action.
        what: String,
        /// Vulkan's result code.
        code: vk::Result,
    },
}

impl VulkanError {
    /// Adds the failed action to a Vulkan result.
    pub(crate) fn at(what: impl Into<String>) -> impl FnOnce(vk::Result) -> VulkanError {
        let what = what.into();
        move |code| match code {
            vk::Result::ERROR_DEVICE_LOST => VulkanError::Lost(what),
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY | vk::Result::ERROR_OUT_OF_HOST_MEMORY => {
                VulkanError::OutOfMemory { what, mib: 0.0 }
            }
            code => VulkanError::Code { what, code },
        }
    }
}

/// Result of the Vulkan layer.
pub type Result<T> = std::result::Result<T, VulkanError>;

/// Whether a list contains this extension.
fn has(extensions: &[vk::ExtensionProperties], name: &std::ffi::CStr) -> bool {
    extensions
        .iter()
        .any(|e| e.extension_name_as_c_str() == Ok(name))
}
