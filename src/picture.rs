//! Results as files: PNG for what is display-encoded, EXR for what is linear.

use crate::lab::{LabError, Texels};
use crate::vulkan::format::Channels;
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image as ExrImage, Layer, LayerAttributes, WritableImage};
use std::io::Cursor;
use std::path::Path;

/// Texels as floats, four a texel, missing channels 0 and missing alpha 1. Slices of volumes follow one another downwards.
pub fn to_floats(texels: &Texels) -> Vec<[f32; 4]> {
    let f = texels.format;
    let bytes = f.bytes as usize;
    texels.bytes.chunks_exact(bytes).map(|t| decode(f.name, f.channels, f.count, t)).collect()
}

fn decode(name: &str, channels: Channels, count: u32, t: &[u8]) -> [f32; 4] {
    let mut out = [0.0, 0.0, 0.0, 1.0];
    let word = |i: usize| u32::from_ne_bytes([t[4 * i], t[4 * i + 1], t[4 * i + 2], t[4 * i + 3]]);
    let half = |i: usize| u16::from_ne_bytes([t[2 * i], t[2 * i + 1]]);
    for (i, slot) in out.iter_mut().enumerate().take(count as usize) {
        *slot = match (name, channels) {
            ("r11g11b10f", _) => small_float(word(0), i),
            ("rgb10a2", _) => {
                let bits = if i == 3 { 3.0 } else { 1023.0 };
                ((word(0) >> (10 * i)) & if i == 3 { 3 } else { 1023 }) as f32 / bits
            }
            ("rgba16" | "d16", _) => f32::from(half(i)) / 65535.0,
            ("r16ui", _) => f32::from(half(i)),
            ("rgba8ui" | "r8ui", _) => f32::from(t[i]),
            (_, Channels::Uint) => word(i) as f32,
            (_, Channels::Int) => word(i).cast_signed() as f32,
            (n, _) if n.contains("16f") => half::f16::from_bits(half(i)).to_f32(),
            (n, _) if n.contains('8') => f32::from(t[i]) / 255.0,
            _ => f32::from_bits(word(i)),
        };
    }
    out
}

/// One channel of B10G11R11_UFLOAT (Vulkan specification, "Unsigned 11-Bit Floating-Point Numbers").
fn small_float(word: u32, channel: usize) -> f32 {
    let (bits, mantissa_bits) = match channel {
        0 => (word & 0x7ff, 6),
        1 => ((word >> 11) & 0x7ff, 6),
        _ => (word >> 22, 5),
    };
    let exponent = bits >> mantissa_bits;
    let mantissa = (bits & ((1 << mantissa_bits) - 1)) as f32 / (1u32 << mantissa_bits) as f32;
    match exponent {
        0 => mantissa * 2f32.powi(-14),
        31 if mantissa == 0.0 => f32::INFINITY,
        31 => f32::NAN,
        e => (1.0 + mantissa) * 2f32.powi(e.cast_signed() - 15),
    }
}

/// Writes a PNG (8 bits; floats are clamped, not tone-mapped) or an EXR (32-bit floats), by the path's ending.
///
/// # Errors
/// Another ending, a folder that cannot be written to. The file is whole or absent.
pub fn write(path: &Path, texels: &Texels) -> Result<(), LabError> {
    let [width, height, depth] = texels.extent;
    // Slices of a volume are put below one another.
    let rows = height * depth;
    let bytes = match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("png") => png(width, rows, texels)?,
        Some("exr") => exr(width, rows, texels)?,
        _ => {
            let message = format!("'{}': give the output a name that ends in .png or .exr", path.display());
            return Err(LabError::Request(message));
        }
    };
    crate::files::write_whole(path, &bytes)
        .map_err(|e| LabError::Request(format!("cannot write '{}': {e}", path.display())))
}

fn png(width: u32, height: u32, texels: &Texels) -> Result<Vec<u8>, LabError> {
    let rgba: Vec<u8> = if texels.format.name.starts_with("rgba8") {
        texels.bytes.clone()
    } else {
        to_floats(texels).iter().flatten().map(|v| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8).collect()
    };
    // Alpha of a picture is not transparency.
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut out = Cursor::new(Vec::new());
    image::write_buffer_with_format(&mut out, &rgb, width, height, image::ColorType::Rgb8, image::ImageFormat::Png)
        .map_err(|e| LabError::Request(format!("cannot make the PNG: {e}")))?;
    Ok(out.into_inner())
}

fn exr(width: u32, height: u32, texels: &Texels) -> Result<Vec<u8>, LabError> {
    let floats = to_floats(texels);
    let channel = |name: &str, i: usize| AnyChannel::new(name, FlatSamples::F32(floats.iter().map(|p| p[i]).collect()));
    // EXR keeps channels in alphabetical order.
    let channels =
        AnyChannels::sort(["A", "B", "G", "R"].iter().zip([3, 2, 1, 0]).map(|(n, i)| channel(n, i)).collect());
    let size = (width as usize, height as usize);
    let layer = Layer::new(size, LayerAttributes::default(), exr::prelude::Encoding::SMALL_LOSSLESS, channels);
    let mut out = Cursor::new(Vec::new());
    ExrImage::from_layer(layer)
        .write()
        .to_buffered(&mut out)
        .map_err(|e| LabError::Request(format!("cannot make the EXR: {e}")))?;
    Ok(out.into_inner())
}
