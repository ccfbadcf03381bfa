//! From untrusted image files to textures; sizes and memory are limited.

use std::borrow::Cow;
use std::io::Cursor;

use glam::{Vec2, Vec4};
use image::{DynamicImage, ImageFormat, ImageReader, Limits, RgbaImage};

use crate::files::read_input;

use super::{
    Filter, MAX_FILE_BYTES, MAX_FILE_SIDE, Notice, Recipe, Source, Texture, TextureFormat, dds,
    ktx2, mips, texture_from_rgba,
};

/// Supported image formats besides DDS and KTX2.
const READ: [ImageFormat; 5] = [
    ImageFormat::Png,
    ImageFormat::Jpeg,
    ImageFormat::WebP,
    ImageFormat::Tga,
    ImageFormat::Bmp,
];
/// Larger textures are reduced to this side.
const MAX_SIDE: u32 = 4096;

/// The file and the error.
type Failure = (String, String);

/// The texture of a recipe; reductions are added to the warnings.
pub(super) fn cook(recipe: &Recipe, warnings: &mut Vec<Notice>) -> Result<Texture, Failure> {
    match recipe {
        Recipe::Color { image, mask } => {
            let filter = mask.map_or(Filter::Plain, |cutoff| {
                Filter::Masked(f32::from(cutoff) / 255.0)
            });
            single(image, true, filter, warnings)
        }
        Recipe::Normal { image } => single(image, false, Filter::Normal, warnings),
        Recipe::MetallicRoughness { image } => single(image, false, Filter::Plain, warnings),
        Recipe::ColorAndMask { color, alpha, mask } => {
            color_and_mask(color.as_ref(), alpha, f32::from(*mask) / 255.0, warnings)
        }
        Recipe::Glossiness { image, factor } => glossiness(image, *factor, warnings),
        Recipe::RoughnessAndMetallic {
            roughness,
            metallic,
        } => roughness_and_metallic(roughness.as_ref(), metallic.as_ref(), warnings),
    }
}

/// Level 0 of a texture as decompressed RGBA8.
pub(in crate::scene) fn first_level_rgba(texture: &Texture) -> Result<Cow<'_, [u8]>, String> {
    let level = texture.mips.first().ok_or("it has no levels")?;
    match texture.format {
        TextureFormat::Rgba8Srgb | TextureFormat::Rgba8Unorm => Ok(Cow::Borrowed(level)),
        format => dds::decompress(format, texture.width, texture.height, level).map(Cow::Owned),
    }
}

/// A linear colour texture at a low resolution.
#[derive(Clone, Debug)]
pub struct SmallPicture {
    /// Texels.
    pub width: u32,
    /// Texels.
    pub height: u32,
    texels: Vec<Vec4>,
}

impl SmallPicture {
    /// The texel at repeating texture coordinates: linear colour and alpha.
    pub fn at(&self, uv: Vec2) -> Vec4 {
        let index = |t: f32, n: u32| ((t.rem_euclid(1.0) * n as f32) as u32).min(n - 1);
        let place = index(uv.y, self.height) * self.width + index(uv.x, self.width);
        self.texels.get(place as usize).copied().unwrap_or_default()
    }
}

impl Texture {
    /// The finest level of at most `most` texels per side; `None` if there is none or it cannot be
    /// decoded.
    pub fn small(&self, most: u32) -> Option<SmallPicture> {
        let sized = (0u32..).zip(&self.mips).map(|(level, bytes)| {
            (
                (self.width >> level).max(1),
                (self.height >> level).max(1),
                bytes,
            )
        });
        let (width, height, bytes) = sized
            .clone()
            .find(|(w, h, _)| w.max(h) <= &most)
            .or_else(|| sized.last())?;
        let rgba = match self.format {
            TextureFormat::Rgba8Srgb | TextureFormat::Rgba8Unorm => Cow::Borrowed(bytes),
            format => Cow::Owned(dds::decompress(format, width, height, bytes).ok()?),
        };
        let texels: Vec<Vec4> = mips::decode(&rgba, self.format.is_srgb());
        (texels.len() == (width * height) as usize).then_some(SmallPicture {
            width,
            height,
            texels,
        })
    }
}

fn single(
    image: &Source,
    srgb: bool,
    filter: Filter,
    warnings: &mut Vec<Notice>,
) -> Result<Texture, Failure> {
    let fail = |problem: String| (image.name(), problem);
    let bytes = read(image).map_err(fail)?;
    if is_dds(&bytes) {
        return dds::texture(&bytes, &image.name(), srgb, filter, MAX_SIDE, warnings).map_err(fail);
    }
    let pixels = decode(&bytes, &image.name()).map_err(fail)?;
    Ok(finish(pixels, &image.name(), srgb, filter, warnings))
}

fn color_and_mask(
    color: Option<&Source>,
    alpha: &Source,
    cutoff: f32,
    warnings: &mut Vec<Notice>,
) -> Result<Texture, Failure> {
    let mask = pixels(alpha)?;
    let mut result = match color {
        Some(color) => pixels(color)?,
        None => RgbaImage::from_pixel(mask.width(), mask.height(), image::Rgba([255; 4])),
    };
    // A mask with an alpha channel uses that channel, a grey one its brightness.
    let has_alpha = mask.pixels().any(|p| p.0[3] < 255);
    let (w, h) = result.dimensions();
    for (x, y, pixel) in result.enumerate_pixels_mut() {
        let from = mask.get_pixel(scaled(x, w, mask.width()), scaled(y, h, mask.height()));
        pixel.0[3] = if has_alpha { from.0[3] } else { from.0[0] };
    }
    let name = color.unwrap_or(alpha).name();
    Ok(finish(
        result,
        &name,
        true,
        Filter::Masked(cutoff),
        warnings,
    ))
}

fn roughness_and_metallic(
    roughness: Option<&Source>,
    metallic: Option<&Source>,
    warnings: &mut Vec<Notice>,
) -> Result<Texture, Failure> {
    let rough = roughness.map(pixels).transpose()?;
    let metal = metallic.map(pixels).transpose()?;
    let width = rough
        .iter()
        .chain(&metal)
        .map(|i| i.width())
        .max()
        .unwrap_or(1);
    let height = rough
        .iter()
        .chain(&metal)
        .map(|i| i.height())
        .max()
        .unwrap_or(1);
    let red = |image: &Option<RgbaImage>, x: u32, y: u32| match image {
        Some(image) => {
            image
                .get_pixel(
                    scaled(x, width, image.width()),
                    scaled(y, height, image.height()),
                )
                .0[0]
        }
        None => 255,
    };
    let merged = RgbaImage::from_fn(width, height, |x, y| {
        image::Rgba([255, red(&rough, x, y), red(&metal, x, y), 255])
    });
    let name = roughness.or(metallic).map(Source::name).unwrap_or_default();
    Ok(finish(merged, &name, false, Filter::Plain, warnings))
}

fn glossiness(image: &Source, factor: u8, warnings: &mut Vec<Notice>) -> Result<Texture, Failure> {
    let mut texels = pixels(image)?;
    for pixel in texels.pixels_mut() {
        let gloss = u32::from(pixel.0[3]) * u32::from(factor) / 255;
        pixel.0 = [255, 255 - gloss as u8, 255, 255];
    }
    Ok(finish(
        texels,
        &image.name(),
        false,
        Filter::Plain,
        warnings,
    ))
}

fn scaled(x: u32, from: u32, to: u32) -> u32 {
    (u64::from(x) * u64::from(to) / u64::from(from)) as u32
}

fn pixels(source: &Source) -> Result<RgbaImage, Failure> {
    let fail = |problem: String| (source.name(), problem);
    let bytes = read(source).map_err(fail)?;
    if is_dds(&bytes) {
        dds::pixels(&bytes).map_err(fail)
    } else {
        decode(&bytes, &source.name()).map_err(fail)
    }
}

fn read(source: &Source) -> Result<Cow<'_, [u8]>, String> {
    match source {
        Source::File(path) => match read_input(path, MAX_FILE_BYTES) {
            Ok(bytes) => Ok(Cow::Owned(bytes)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                Err("the file does not exist".into())
            }
            Err(error) => Err(format!("cannot read it: {error}")),
        },
        Source::Bytes(_, bytes) => Ok(Cow::Borrowed(bytes)),
        Source::Missing(_, problem) => Err(problem.clone()),
    }
}

fn is_dds(bytes: &[u8]) -> bool {
    bytes.starts_with(b"DDS ")
}

/// The format follows from the file's magic number; TGA has none, so its extension decides.
fn decode(bytes: &[u8], name: &str) -> Result<RgbaImage, String> {
    if ktx2::is_ktx2(bytes) {
        return ktx2::pixels(bytes);
    }
    let by_name = || ImageFormat::from_path(name).ok();
    let format = image::guess_format(bytes)
        .ok()
        .or_else(by_name)
        .ok_or("not a PNG, JPEG, WebP, TGA, BMP, DDS or KTX2 image")?;
    if !READ.contains(&format) {
        return Err(format!(
            "{format:?} images are not supported; convert it to PNG"
        ));
    }
    decode_limited(bytes, format).map(DynamicImage::into_rgba8)
}

/// Decodes an image file within the size and memory limits.
pub(in crate::scene) fn decode_limited(
    bytes: &[u8],
    format: ImageFormat,
) -> Result<DynamicImage, String> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_FILE_SIDE);
    limits.max_image_height = Some(MAX_FILE_SIDE);
    limits.max_alloc = Some(MAX_FILE_BYTES);
    reader.limits(limits);
    let image = reader
        .decode()
        .map_err(|error| format!("the image is damaged or too large ({error})"))?;
    if image.width() == 0 || image.height() == 0 {
        Err("the image is empty".into())
    } else {
        Ok(image)
    }
}

fn finish(
    image: RgbaImage,
    name: &str,
    srgb: bool,
    filter: Filter,
    warnings: &mut Vec<Notice>,
) -> Texture {
    let format = if srgb {
        TextureFormat::Rgba8Srgb
    } else {
        TextureFormat::Rgba8Unorm
    };
    let (width, height) = image.dimensions();
    let mut rgba = image.into_raw();
    let to = within_limit(width, height);
    if to != (width, height) {
        warnings.push(Notice::of_size(name, (width, height), to));
        rgba = mips::reduce(&rgba, (width, height), to, srgb, filter);
    }
    texture_from_rgba(name, to.0, to.1, rgba, format, filter)
}

/// The size with a longer side of at most `MAX_SIDE`, aspect ratio kept.
fn within_limit(width: u32, height: u32) -> (u32, u32) {
    let longest = width.max(height);
    if longest <= MAX_SIDE {
        return (width, height);
    }
    (
        scaled(MAX_SIDE, longest, width).max(1),
        scaled(MAX_SIDE, longest, height).max(1),
    )
}

#[cfg(test)]
mod tests {
    use super::within_limit;

    #[test]
    fn large_sizes_keep_their_aspect() {
        assert_eq!(within_limit(8192, 2048), (4096, 1024));
        assert_eq!(within_limit(100, 4096), (100, 4096));
        assert_eq!(within_limit(16384, 1), (4096, 1));
    }
}
