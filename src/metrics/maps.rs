//! Error maps, as false-colour pictures and as numbers.

use super::colour::luminance;
use super::means::relative_square;
use super::{Compared, MetricError};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage,
};
use std::io::Cursor;

/// Decades of relative squared error from the darkest to the brightest colour.
const DECADES: (f64, f64) = (-4.0, 2.0);
/// Structure error of the brightest colour (natural log units): two of a block's four neighbours
/// differ by a factor of 3.
const STRUCTURE: f64 = 0.5;

/// One map as a file.
pub struct MapFile {
    /// Suffix of the file's name, for example `flip.png`.
    pub name: &'static str,
    /// Content of the file.
    pub bytes: Vec<u8>,
    /// Meaning of its colours or channels.
    pub scale: String,
}

/// Maps of a comparison as numbers, row by row, by name: `flip`, `hdrFlip`, `luminanceDifference`
/// (of the picture less the reference, radiance), `relativeSquaredError`, `structure`.
pub fn layers(compared: &Compared) -> Vec<(&'static str, Vec<f32>)> {
    let pairs = || compared.test.rgb.iter().zip(&compared.reference.rgb);
    let square = |(x, r): (&f32, &f32)| relative_square(*x, *r, *r);
    let relative = pairs().map(|(x, r)| x.iter().zip(r).map(square).sum::<f64>() / 3.0);
    let difference = pairs().map(|(x, r)| (luminance(*x) - luminance(*r)) as f32);
    vec![
        ("flip", compared.flip().to_vec()),
        ("hdrFlip", compared.hdr_flip().to_vec()),
        ("luminanceDifference", difference.collect()),
        ("relativeSquaredError", relative.map(|v| v as f32).collect()),
        ("structure", compared.structure().map()),
    ]
}

/// The error maps of a comparison. FLIP and HDR-FLIP use the colours of NVIDIA's evaluator (magma),
/// as do the relative squared error on a logarithmic scale and the structure error. The difference
/// of luminance runs from blue (too dark) over white to red (too bright). An EXR has all five as
/// channels.
///
/// # Errors
/// A size that PNG or EXR does not support.
pub fn maps(compared: &Compared) -> Result<Vec<MapFile>, MetricError> {
    let layers = layers(compared);
    let [flip, hdr_flip, difference, relative, structure] = &layers[..] else {
        return Err(MetricError("a map is missing".into()));
    };
    // The share of dark pixels in the mean is known.
    let full = (compared.dark / super::DARK).max(f64::MIN_POSITIVE);
    let size = compared.test.size;
    let logarithmic = |v: &f32| (f64::from(*v).log10() - DECADES.0) / (DECADES.1 - DECADES.0);
    let flip_scale = "magma, 0 to 1";
    let png = |name, rgb: Vec<[u8; 3]>, scale: String| {
        Ok::<_, MetricError>(MapFile {
            name,
            bytes: encode_png(size, &rgb)?,
            scale,
        })
    };
    Ok(vec![
        png("flip.png", flip.1.iter().map(|v| magma(f64::from(*v))).collect(), flip_scale.into())?,
        png("hdr-flip.png", hdr_flip.1.iter().map(|v| magma(f64::from(*v))).collect(), flip_scale.into())?,
        png(
            "relative-error.png",
            relative.1.iter().map(|v| magma(logarithmic(v))).collect(),
            format!("(x - r)^2 / (r^2 + 0.01), magma, logarithmic from 1e{} to 1e{}", DECADES.0, DECADES.1),
        )?,
        png(
            "luminance.png",
            difference.1.iter().map(|v| diverging(f64::from(*v) / full)).collect(),
            format!("luminance x - r, blue -{full:.4} over white 0 to red +{full:.4}"),
        )?,
        png(
            "structure.png",
            structure.1.iter().map(|v| magma(f64::from(*v) / STRUCTURE)).collect(),
            format!("structure error, magma, 0 to {STRUCTURE}"),
        )?,
        MapFile {
            name: "maps.exr",
            bytes: encode_exr(size, &layers)?,
            scale: "32-bit floats; channels flip, hdrFlip, luminanceDifference, relativeSquaredError, structure".into(),
        },
    ])
}

/// The colours of NVIDIA's maps (matplotlib's magma), sRGB, from 0 to 1 in 256 steps.
const MAGMA: &[u8; 768] = include_bytes!("magma.rgb");

/// The colour of a value in 0..1; NaN gets the brightest colour.
pub fn magma(value: f64) -> [u8; 3] {
    let value = if value.is_nan() {
        1.0
    } else {
        value.clamp(0.0, 1.0)
    };
    let i = 3 * (value * 255.0 + 0.5) as usize;
    [MAGMA[i], MAGMA[i + 1], MAGMA[i + 2]]
}

/// Blue at -1 over white at 0 to red at 1; black for NaN.
fn diverging(value: f64) -> [u8; 3] {
    if value.is_nan() {
        return [0; 3];
    }
    let full = if value < 0.0 {
        [33.0, 76.0, 190.0]
    } else {
        [190.0, 20.0, 38.0]
    };
    full.map(|f| (255.0 + value.abs().min(1.0) * (f - 255.0)).round() as u8)
}

fn encode_png((width, height): (u32, u32), rgb: &[[u8; 3]]) -> Result<Vec<u8>, MetricError> {
    let mut out = Cursor::new(Vec::new());
    let (colour, format) = (image::ColorType::Rgb8, image::ImageFormat::Png);
    image::write_buffer_with_format(&mut out, rgb.as_flattened(), width, height, colour, format)
        .map_err(|e| MetricError(format!("cannot make the PNG of a map: {e}")))?;
    Ok(out.into_inner())
}

fn encode_exr(
    (width, height): (u32, u32),
    layers: &[(&str, Vec<f32>)],
) -> Result<Vec<u8>, MetricError> {
    let channel = |(name, values): &(&str, Vec<f32>)| {
        AnyChannel::new(*name, FlatSamples::F32(values.clone()))
    };
    let channels = AnyChannels::sort(layers.iter().map(channel).collect());
    let size = (width as usize, height as usize);
    let layer = Layer::new(
        size,
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        channels,
    );
    let mut out = Cursor::new(Vec::new());
    let written = Image::from_layer(layer).write().to_buffered(&mut out);
    written.map_err(|e| MetricError(format!("cannot make the EXR of the maps: {e}")))?;
    Ok(out.into_inner())
}
