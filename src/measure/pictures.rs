//! Thumbnails of a point.

use crate::lab::{LabError, Texels};
use crate::metrics::colour::display;
use crate::metrics::{Kind, Linear};
use crate::results::picture::rgb8;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::{FilterType, resize};
use image::{ImageBuffer, Rgb, RgbImage};

/// Longest side (pixels): 200 points with two pictures each stay below 4 MB.
const SIDE: u32 = 256;
/// JPEG quality, percent.
const QUALITY: u8 = 82;

/// JPEG of a display-encoded picture.
pub(super) fn thumbnail(texels: &Texels) -> Result<Vec<u8>, LabError> {
    let [width, height, _] = texels.extent;
    small_jpeg(RgbImage::from_raw(width, height, rgb8(texels)))
}

/// Radiance with the default display transform of graphs, to compare the reference with their
/// pictures. NaN is black.
pub(super) fn displayed(light: &Linear) -> Result<Vec<u8>, LabError> {
    let byte =
        |v: f32| (display(Kind::Radiance, if v.is_finite() { v } else { 0.0 }) * 255.0 + 0.5) as u8;
    small_jpeg(RgbImage::from_raw(
        light.size.0,
        light.size.1,
        light.rgb.iter().flatten().map(|v| byte(*v)).collect(),
    ))
}

/// The square root of each pixel's relative squared error, |x - r| / sqrt(r^2 + 0.01), mean over
/// channels: black at 0, through red and yellow to white at 1 and above.
pub(super) fn error_map(test: &Linear, reference: &Linear) -> Result<Vec<u8>, LabError> {
    let heat = test.rgb.iter().zip(&reference.rgb).flat_map(|(x, r)| {
        let squares = x
            .iter()
            .zip(r)
            .map(|(x, r)| (x - r).powi(2) / (r * r + 0.01))
            .sum::<f32>()
            / 3.0;
        let e = squares.sqrt() * 3.0;
        [e, e - 1.0, e - 2.0].map(|v| (v.clamp(0.0, 1.0) * 255.0) as u8)
    });
    small_jpeg(RgbImage::from_raw(test.size.0, test.size.1, heat.collect()))
}

fn small_jpeg(picture: Option<ImageBuffer<Rgb<u8>, Vec<u8>>>) -> Result<Vec<u8>, LabError> {
    let failed = |why: String| LabError::Request(format!("cannot make the small picture: {why}"));
    let picture = picture.ok_or_else(|| failed("it has too few texels".into()))?;
    let (width, height) = picture.dimensions();
    let scale = f64::from(SIDE) / f64::from(width.max(height).max(SIDE));
    let side = |n: u32| ((f64::from(n) * scale).round() as u32).max(1);
    let small = resize(&picture, side(width), side(height), FilterType::Triangle);
    let mut out = Vec::new();
    small
        .write_with_encoder(JpegEncoder::new_with_quality(&mut out, QUALITY))
        .map_err(|e| failed(e.to_string()))?;
    Ok(out)
}
