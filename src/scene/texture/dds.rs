//! DDS files: block-compressed levels are kept, other formats are decoded to RGBA8.

use ddsfile::Dds;
use image::RgbaImage;
use image_dds::{ImageFormat, Surface, dds_image_format};

use super::{Filter, Notice, Texture, TextureFormat, mips, texture_from_rgba};

/// Texture from a DDS file; `srgb` follows from its use, not from the file.
pub(super) fn texture(
    bytes: &[u8],
    name: &str,
    srgb: bool,
    filter: Filter,
    max_side: u32,
    warnings: &mut Vec<Notice>,
) -> Result<Texture, String> {
    let file = parse(bytes)?;
    let Some(format) = kept_format(file.format, srgb) else {
        return uncompressed(file, name, srgb, filter, max_side, warnings);
    };
    let levels = stored_levels(&file, format)?;
    // Levels above the size limit are skipped if the file has smaller ones.
    let fits = |level: &usize| {
        let (width, height) = level_size(&file, *level);
        width.max(height) <= max_side
    };
    let first = (0..levels.len()).find(fits).ok_or_else(|| {
        format!(
            "{}x{} is over {max_side} and it stores no smaller levels; store its mips",
            file.width, file.height
        )
    })?;
    let (width, height) = level_size(&file, first);
    if first > 0 {
        warnings.push(Notice::of_size(
            name,
            (file.width, file.height),
            (width, height),
        ));
    }
    let mips = levels.into_iter().skip(first).map(<[u8]>::to_vec).collect();
    Ok(Texture {
        name: name.into(),
        width,
        height,
        format,
        mips,
    })
}

/// Level 0 of a DDS file as RGBA8.
pub(super) fn pixels(bytes: &[u8]) -> Result<RgbaImage, String> {
    let file = parse(bytes)?;
    let rgba = decode(file.format, file.width, file.height, file.levels)?;
    RgbaImage::from_raw(file.width, file.height, rgba)
        .ok_or_else(|| "its data is shorter than its size says".into())
}

/// RGBA8 texels of one block-compressed level.
pub(super) fn decompress(
    format: TextureFormat,
    width: u32,
    height: u32,
    level: &[u8],
) -> Result<Vec<u8>, String> {
    use TextureFormat::*;
    let format = match format {
        Rgba8Srgb | Rgba8Unorm => return Ok(level.to_vec()),
        Bc1Srgb | Bc1Unorm => ImageFormat::BC1RgbaUnorm,
        Bc2Srgb | Bc2Unorm => ImageFormat::BC2RgbaUnorm,
        Bc3Srgb | Bc3Unorm => ImageFormat::BC3RgbaUnorm,
        Bc4Unorm => ImageFormat::BC4RUnorm,
        Bc5Unorm => ImageFormat::BC5RgUnorm,
        Bc7Srgb | Bc7Unorm => ImageFormat::BC7RgbaUnorm,
    };
    decode(format, width, height, level)
}

struct File<'a> {
    format: ImageFormat,
    width: u32,
    height: u32,
    level_count: u32,
    levels: &'a [u8],
}

fn parse(bytes: &[u8]) -> Result<File<'_>, String> {
    let dds = Dds::read(bytes).map_err(|error| format!("the DDS header is damaged ({error})"))?;
    let format = dds_image_format(&dds)
        .map_err(|_| "its DDS pixel format is not supported; store it as BC7")?;
    let (width, height) = (dds.get_width(), dds.get_height());
    if width == 0 || height == 0 || width > 16384 || height > 16384 {
        return Err(format!(
            "its size {width}x{height} is not between 1 and 16384"
        ));
    }
    let full_chain = 32 - width.max(height).leading_zeros();
    let level_count = dds.get_num_mipmap_levels().clamp(1, full_chain);
    // The levels follow the header to the end of the file.
    let levels = bytes
        .get(bytes.len() - dds.data.len()..)
        .unwrap_or_default();
    Ok(File {
        format,
        width,
        height,
        level_count,
        levels,
    })
}

/// The format that keeps the file's blocks, or `None` if they must be decoded.
fn kept_format(format: ImageFormat, srgb: bool) -> Option<TextureFormat> {
    use TextureFormat::*;
    let pick = |color, data| Some(if srgb { color } else { data });
    match format {
        ImageFormat::BC1RgbaUnorm | ImageFormat::BC1RgbaUnormSrgb => pick(Bc1Srgb, Bc1Unorm),
        ImageFormat::BC2RgbaUnorm | ImageFormat::BC2RgbaUnormSrgb => pick(Bc2Srgb, Bc2Unorm),
        ImageFormat::BC3RgbaUnorm | ImageFormat::BC3RgbaUnormSrgb => pick(Bc3Srgb, Bc3Unorm),
        ImageFormat::BC7RgbaUnorm | ImageFormat::BC7RgbaUnormSrgb => pick(Bc7Srgb, Bc7Unorm),
        ImageFormat::BC4RUnorm => Some(Bc4Unorm),
        ImageFormat::BC5RgUnorm => Some(Bc5Unorm),
        _ => None,
    }
}

fn level_size(file: &File, level: usize) -> (u32, u32) {
    ((file.width >> level).max(1), (file.height >> level).max(1))
}

fn stored_levels<'a>(file: &File<'a>, format: TextureFormat) -> Result<Vec<&'a [u8]>, String> {
    let mut rest = file.levels;
    let mut levels = Vec::new();
    for level in 0..file.level_count as usize {
        let (width, height) = level_size(file, level);
        let Some((bytes, after)) = rest.split_at_checked(format.level_bytes(width, height)) else {
            return Err(format!(
                "the file ends inside mip level {level} of {}",
                file.level_count
            ));
        };
        levels.push(bytes);
        rest = after;
    }
    Ok(levels)
}

fn uncompressed(
    file: File,
    name: &str,
    srgb: bool,
    filter: Filter,
    max_side: u32,
    warnings: &mut Vec<Notice>,
) -> Result<Texture, String> {
    let rgba = decode(file.format, file.width, file.height, file.levels)?;
    let format = if srgb {
        TextureFormat::Rgba8Srgb
    } else {
        TextureFormat::Rgba8Unorm
    };
    let from = (file.width, file.height);
    let mut to = from;
    while to.0.max(to.1) > max_side {
        to = ((to.0 / 2).max(1), (to.1 / 2).max(1));
    }
    if to == from {
        return Ok(texture_from_rgba(name, to.0, to.1, rgba, format, filter));
    }
    warnings.push(Notice::of_size(name, from, to));
    let rgba = mips::reduce(&rgba, from, to, srgb, filter);
    Ok(texture_from_rgba(name, to.0, to.1, rgba, format, filter))
}

/// Level 0 of a format as RGBA8.
pub(super) fn decode(
    image_format: ImageFormat,
    width: u32,
    height: u32,
    data: &[u8],
) -> Result<Vec<u8>, String> {
    let surface = Surface {
        width,
        height,
        depth: 1,
        layers: 1,
        mipmaps: 1,
        image_format,
        data,
    };
    let decoded = surface
        .decode_rgba8()
        .map_err(|error| format!("its data is damaged ({error})"))?;
    Ok(decoded.data)
}
