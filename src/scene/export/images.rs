//! Textures as PNG, environment maps as EXR.

use crate::files::FileError;
use std::io::Cursor;
use std::path::Path;

use glam::Vec3;
use image::codecs::openexr::OpenExrEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::scene::environment::Environment;
use crate::scene::texture::first_level_rgba;
use crate::scene::{SceneError, Texture, TextureFormat};

/// Level 0 as an RGBA PNG.
pub(super) fn rgba_png(texture: &Texture, target: &Path) -> Result<Vec<u8>, SceneError> {
    encode(
        &texels(texture, target)?,
        texture,
        ExtendedColorType::Rgba8,
        target,
    )
}

/// One channel of level 0 as a grey PNG.
pub(super) fn grey_png(
    texture: &Texture,
    channel: usize,
    target: &Path,
) -> Result<Vec<u8>, SceneError> {
    let grey: Vec<u8> = texels(texture, target)?
        .iter()
        .skip(channel)
        .step_by(4)
        .copied()
        .collect();
    encode(&grey, texture, ExtendedColorType::L8, target)
}

/// The environment map times `factor` as an EXR.
pub(super) fn sky_exr(
    sky: &Environment,
    factor: Vec3,
    target: &Path,
) -> Result<Vec<u8>, SceneError> {
    let (width, height) = sky.picture.size();
    let radiance = |texel: &[f32; 3]| (Vec3::from_array(*texel) * factor).to_array();
    let texels: Vec<[f32; 3]> = sky.picture.texels().iter().map(radiance).collect();
    let mut exr = Cursor::new(Vec::new());
    OpenExrEncoder::new(&mut exr)
        .write_image(
            bytemuck::cast_slice(&texels),
            width,
            height,
            ExtendedColorType::Rgb32F,
        )
        .map_err(|error| FileError::write(target, error))?;
    Ok(exr.into_inner())
}

fn texels(texture: &Texture, target: &Path) -> Result<Vec<u8>, SceneError> {
    let fail = |problem: String| {
        FileError::write(
            target,
            format!("texture {} cannot be decoded: {problem}", texture.name),
        )
    };
    let mut rgba = first_level_rgba(texture).map_err(fail)?.into_owned();
    if texture.format == TextureFormat::Bc5Unorm {
        // BC5 stores x and y of a unit normal; z follows.
        for texel in rgba.as_chunks_mut::<4>().0 {
            let [x, y] = [texel[0], texel[1]].map(|c| f32::from(c) / 127.5 - 1.0);
            let z = (1.0 - x * x - y * y).max(0.0).sqrt();
            texel[2] = (z * 127.5 + 127.5).round() as u8;
        }
    }
    Ok(rgba)
}

fn encode(
    bytes: &[u8],
    texture: &Texture,
    color: ExtendedColorType,
    target: &Path,
) -> Result<Vec<u8>, SceneError> {
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Fast, FilterType::Adaptive)
        .write_image(bytes, texture.width, texture.height, color)
        .map_err(|error| FileError::write(target, error))?;
    Ok(png)
}
