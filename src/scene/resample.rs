//! Uncompressed textures at another size: for arrays with equal layers, and for devices without
//! block compression.

use super::texture::{Filter, first_level_rgba, texture_from_rgba};
use super::{Texture, TextureFormat};
use image::RgbaImage;
use image::imageops::{FilterType, resize};

impl TextureFormat {
    /// Whether the format is block-compressed.
    pub(crate) fn is_compressed(self) -> bool {
        !matches!(self, TextureFormat::Rgba8Srgb | TextureFormat::Rgba8Unorm)
    }
}

impl Texture {
    /// The same picture in RGBA8 at `width` x `height`, with new mips. A texture that cannot be
    /// decoded becomes magenta.
    pub(crate) fn resampled(&self, width: u32, height: u32) -> Texture {
        let format = if self.format.is_srgb() {
            TextureFormat::Rgba8Srgb
        } else {
            TextureFormat::Rgba8Unorm
        };
        let texels = first_level_rgba(self).ok().map(|t| t.into_owned());
        let image = texels.and_then(|t| RgbaImage::from_raw(self.width, self.height, t));
        let image =
            image.unwrap_or_else(|| RgbaImage::from_pixel(1, 1, image::Rgba([255, 0, 255, 255])));
        let sized = if image.dimensions() == (width, height) {
            image
        } else {
            resize(&image, width, height, FilterType::Triangle)
        };
        texture_from_rgba(
            &self.name,
            width,
            height,
            sized.into_raw(),
            format,
            Filter::Plain,
        )
    }
}
