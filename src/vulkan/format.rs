//! Texel formats with the names used in graphs and GLSL.

use ash::vk;

/// Numeric type of the channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// Floating point or normalised: `float` in shaders.
    Float,
    Uint,
    Int,
    Depth,
}

/// One row of the format table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// Name in graphs; for storage formats also in GLSL.
    pub name: &'static str,
    /// The format in Vulkan.
    pub vk: vk::Format,
    /// Bytes per texel.
    pub bytes: u32,
    /// Number of channels.
    pub count: u32,
    /// Numeric type of the channels.
    pub channels: Channels,
}

const fn row(
    name: &'static str,
    vk: vk::Format,
    bytes: u32,
    count: u32,
    channels: Channels,
) -> Format {
    Format {
        name,
        vk,
        bytes,
        count,
        channels,
    }
}

use Channels::{Depth, Float, Int, Uint};

/// All formats that a graph may name.
pub const FORMATS: &[Format] = &[
    row("rgba8", vk::Format::R8G8B8A8_UNORM, 4, 4, Float),
    row("rgba8_srgb", vk::Format::R8G8B8A8_SRGB, 4, 4, Float),
    row("rgba16f", vk::Format::R16G16B16A16_SFLOAT, 8, 4, Float),
    row("rgba32f", vk::Format::R32G32B32A32_SFLOAT, 16, 4, Float),
    row("rgba16", vk::Format::R16G16B16A16_UNORM, 8, 4, Float),
    row("rg16f", vk::Format::R16G16_SFLOAT, 4, 2, Float),
    row("rg32f", vk::Format::R32G32_SFLOAT, 8, 2, Float),
    row("r16f", vk::Format::R16_SFLOAT, 2, 1, Float),
    row("r32f", vk::Format::R32_SFLOAT, 4, 1, Float),
    row("r8", vk::Format::R8_UNORM, 1, 1, Float),
    row("rg8", vk::Format::R8G8_UNORM, 2, 2, Float),
    row(
        "r11g11b10f",
        vk::Format::B10G11R11_UFLOAT_PACK32,
        4,
        3,
        Float,
    ),
    row("rgb10a2", vk::Format::A2B10G10R10_UNORM_PACK32, 4, 4, Float),
    row("r32ui", vk::Format::R32_UINT, 4, 1, Uint),
    row("rg32ui", vk::Format::R32G32_UINT, 8, 2, Uint),
    row("rgba32ui", vk::Format::R32G32B32A32_UINT, 16, 4, Uint),
    row("rgba8ui", vk::Format::R8G8B8A8_UINT, 4, 4, Uint),
    row("r16ui", vk::Format::R16_UINT, 2, 1, Uint),
    row("r8ui", vk::Format::R8_UINT, 1, 1, Uint),
    row("r32i", vk::Format::R32_SINT, 4, 1, Int),
    row("d32", vk::Format::D32_SFLOAT, 4, 1, Depth),
    row("d16", vk::Format::D16_UNORM, 2, 1, Depth),
];

impl Format {
    /// The format with this name.
    pub fn named(name: &str) -> Option<Format> {
        FORMATS.iter().find(|f| f.name == name).copied()
    }

    /// All names.
    pub fn names() -> impl Iterator<Item = &'static str> {
        FORMATS.iter().map(|f| f.name)
    }

    /// Whether it is a depth format.
    pub fn is_depth(&self) -> bool {
        self.channels == Depth
    }

    /// The image aspect of the format.
    pub fn aspect(&self) -> vk::ImageAspectFlags {
        if self.is_depth() {
            vk::ImageAspectFlags::DEPTH
        } else {
            vk::ImageAspectFlags::COLOR
        }
    }
}
