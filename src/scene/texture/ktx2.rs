//! KTX2 files: the first level as RGBA8. Universal textures (ETC1S and UASTC) are transcoded; plain
//! formats with a DDS counterpart are supported too.

use std::ops::Range;

use basisu::{DecodeFlags, SourceFormat, TargetFormat, Transcoder};
use image::RgbaImage;
use image_dds::ImageFormat;
use ktx2::{Format, Header, Level, LevelIndex, SupercompressionScheme};
use ruzstd::{StreamingDecoder, io::Read};

use super::{MAX_FILE_BYTES, MAX_FILE_SIDE, dds};

#[cfg(test)]
mod tests;

/// Block size of ETC1S and UASTC (texels).
const SIDE: u32 = 4;
/// Block size of UASTC (bytes).
const UASTC_BYTES: usize = 16;

/// Position of the offset and length of the key-value data in the header.
const KEYS: Range<usize> = 56..64;

pub(super) fn is_ktx2(bytes: &[u8]) -> bool {
    bytes.starts_with(&ktx2::MAGIC)
}

/// The first level of a file. Whether it is sRGB follows from its use, not from the file.
pub(super) fn pixels(bytes: &[u8]) -> Result<RgbaImage, String> {
    let (header, level) = parse(bytes)?;
    let (width, height) = size(&header)?;
    let rgba = match header.format {
        None => universal(bytes, &header, &level)?,
        Some(format) => plain(format, &header, &level)?,
    };
    RgbaImage::from_raw(width, height, rgba)
        .ok_or_else(|| "its KTX2 data is shorter than its size says".into())
}

/// The header and the first level. [`ktx2::Reader`] parses more, and panics at some descriptors of
/// damaged files.
fn parse(bytes: &[u8]) -> Result<(Header, Level<'_>), String> {
    let (header, rest) = bytes
        .split_first_chunk()
        .ok_or("the KTX2 file ends inside its header")?;
    let header = Header::from_bytes(header)
        .map_err(|error| format!("the KTX2 file is damaged ({error})"))?;
    let index = rest
        .first_chunk()
        .map(LevelIndex::from_bytes)
        .ok_or("the KTX2 file ends inside its header")?;
    let range = |from: u64, length: u64| {
        let end = from.checked_add(length)?;
        bytes.get(usize::try_from(from).ok()?..usize::try_from(end).ok()?)
    };
    let data = range(index.byte_offset, index.byte_length)
        .ok_or("the KTX2 file ends inside its first level")?;
    Ok((
        header,
        Level {
            data,
            uncompressed_byte_length: index.uncompressed_byte_length,
        },
    ))
}

/// Width and height of a plain 2D texture.
fn size(header: &Header) -> Result<(u32, u32), String> {
    let (width, height) = (header.pixel_width, header.pixel_height);
    if height == 0 || header.pixel_depth > 0 || header.layer_count > 1 || header.face_count > 1 {
        return Err("the KTX2 file is no plain 2D texture; store one picture without layers, depth and faces".into());
    }
    let fits = width.max(height) <= MAX_FILE_SIDE
        && u64::from(width) * u64::from(height) * 4 <= MAX_FILE_BYTES;
    if fits {
        Ok((width, height))
    } else {
        Err(format!(
            "its size {width}x{height} is too large; store it smaller"
        ))
    }
}

fn universal(bytes: &[u8], header: &Header, level: &Level) -> Result<Vec<u8>, String> {
    let damaged = |error: basisu::Error| {
        format!("the KTX2 texture is damaged or of a kind that is not read ({error:?})")
    };
    if header.supercompression_scheme == Some(SupercompressionScheme::Zstandard) {
        // The transcoder allocates the declared size.
        let blocks = header.pixel_width.div_ceil(SIDE) as usize
            * header.pixel_height.div_ceil(SIDE) as usize;
        if level.uncompressed_byte_length != (blocks * UASTC_BYTES) as u64 {
            return Err(
                "the KTX2 texture is damaged: its uncompressed size is not that of its blocks"
                    .into(),
            );
        }
    }
    // Key-value data are not needed, and the transcoder panics at damaged ones.
    let mut bytes = bytes.to_vec();
    if let Some(place) = bytes.get_mut(KEYS) {
        place.fill(0);
    }
    let transcoder = Transcoder::new(&bytes).map_err(damaged)?;
    if !matches!(
        transcoder.source_format(),
        SourceFormat::Etc1s | SourceFormat::UastcLdr
    ) {
        return Err("its KTX2 format is not read; store it as ETC1S or UASTC".into());
    }
    transcoder
        .transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE)
        .map_err(damaged)
}

fn plain(format: Format, header: &Header, level: &Level) -> Result<Vec<u8>, String> {
    let (width, height) = (header.pixel_width, header.pixel_height);
    let texels = width as usize * height as usize;
    if matches!(format, Format::R8G8B8_UNORM | Format::R8G8B8_SRGB) {
        let data = uncompressed(header, level, 3 * texels)?;
        return Ok(data
            .as_chunks::<3>()
            .0
            .iter()
            .flat_map(|&[r, g, b]| [r, g, b, 255])
            .collect());
    }
    let (image, bytes, side) = layout(format).ok_or_else(|| {
        format!("its KTX2 format {format:?} is not read; store it as UASTC or R8G8B8A8_SRGB")
    })?;
    let blocks = width.div_ceil(side) as usize * height.div_ceil(side) as usize;
    let mut rgba = dds::decode(
        image,
        width,
        height,
        &uncompressed(header, level, blocks * bytes)?,
    )?;
    if matches!(
        format,
        Format::BC1_RGB_UNORM_BLOCK | Format::BC1_RGB_SRGB_BLOCK
    ) {
        rgba.iter_mut()
            .skip(3)
            .step_by(4)
            .for_each(|alpha| *alpha = 255);
    }
    Ok(rgba)
}

/// The DDS equivalent, the bytes of a block and its side in texels.
fn layout(format: Format) -> Option<(ImageFormat, usize, u32)> {
    Some(match format {
        Format::R8_UNORM | Format::R8_SRGB => (ImageFormat::R8Unorm, 1, 1),
        Format::R8G8_UNORM | Format::R8G8_SRGB => (ImageFormat::Rg8Unorm, 2, 1),
        Format::R8G8B8A8_UNORM | Format::R8G8B8A8_SRGB => (ImageFormat::Rgba8Unorm, 4, 1),
        Format::B8G8R8A8_UNORM | Format::B8G8R8A8_SRGB => (ImageFormat::Bgra8Unorm, 4, 1),
        Format::BC1_RGB_UNORM_BLOCK
        | Format::BC1_RGB_SRGB_BLOCK
        | Format::BC1_RGBA_UNORM_BLOCK
        | Format::BC1_RGBA_SRGB_BLOCK => (ImageFormat::BC1RgbaUnorm, 8, 4),
        Format::BC2_UNORM_BLOCK | Format::BC2_SRGB_BLOCK => (ImageFormat::BC2RgbaUnorm, 16, 4),
        Format::BC3_UNORM_BLOCK | Format::BC3_SRGB_BLOCK => (ImageFormat::BC3RgbaUnorm, 16, 4),
        Format::BC4_UNORM_BLOCK => (ImageFormat::BC4RUnorm, 8, 4),
        Format::BC5_UNORM_BLOCK => (ImageFormat::BC5RgUnorm, 16, 4),
        Format::BC6H_UFLOAT_BLOCK => (ImageFormat::BC6hRgbUfloat, 16, 4),
        Format::BC6H_SFLOAT_BLOCK => (ImageFormat::BC6hRgbSfloat, 16, 4),
        Format::BC7_UNORM_BLOCK | Format::BC7_SRGB_BLOCK => (ImageFormat::BC7RgbaUnorm, 16, 4),
        _ => return None,
    })
}

/// The first bytes of a level.
fn uncompressed(header: &Header, level: &Level, count: usize) -> Result<Vec<u8>, String> {
    let short = || format!("its KTX2 data is damaged: its size needs {count} bytes");
    match header.supercompression_scheme {
        None => level
            .data
            .get(..count)
            .map(<[u8]>::to_vec)
            .ok_or_else(short),
        Some(SupercompressionScheme::Zstandard) => {
            let mut stream = StreamingDecoder::new(level.data).map_err(|_| short())?;
            let mut bytes = vec![0; count];
            stream.read_exact(&mut bytes).map_err(|_| short())?;
            Ok(bytes)
        }
        Some(other) => Err(format!(
            "its KTX2 compression {other:?} is not read; store it with Zstandard or without"
        )),
    }
}
