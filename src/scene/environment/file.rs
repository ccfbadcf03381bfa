//! Environment maps from untrusted files: sizes and memory are limited, and invalid radiance
//! becomes 0.

use super::{Environment, Level, SkyPicture};
use crate::diagnostics::panics::caught;
use crate::files::read_input;
use crate::scene::texture::{MAX_FILE_BYTES, decode_limited};
use image::ImageFormat;
use std::path::Path;
use std::sync::Arc;

/// Larger pictures are reduced to this size.
const MAX_SIZE: (u32, u32) = (4096, 2048);
/// Largest radiance: far above any sky, and its products stay finite.
const MAX_RADIANCE: f32 = 1e12;

/// Reads an HDR or EXR file. Deviations from the file are added to the warnings, which name the
/// file.
pub(crate) fn read(path: &Path, warnings: &mut Vec<String>) -> Result<Environment, String> {
    if !path.exists() {
        return Err(format!("Sky '{}': file not found", path.display()));
    }
    let level = caught(|| decode(path))
        .flatten()
        .map_err(|problem| format!("environment '{}': {problem}", path.display()))?;
    let mut warn = |what: String| warnings.push(format!("environment {}: {what}", path.display()));
    let level = checked(level, &mut warn);
    let picture = Arc::new(SkyPicture::new(level));
    Ok(Environment {
        file: Some(path.into()),
        picture,
        rotation: 0.0,
    })
}

fn decode(path: &Path) -> Result<Level, String> {
    let bytes = read_input(path, MAX_FILE_BYTES).map_err(|e| format!("cannot read it: {e}"))?;
    let format = image::guess_format(&bytes).ok();
    let format = format
        .filter(|f| matches!(f, ImageFormat::Hdr | ImageFormat::OpenExr))
        .ok_or("not a Radiance HDR or OpenEXR picture")?;
    let image = decode_limited(&bytes, format)?.into_rgb32f();
    let (width, height) = image.dimensions();
    Ok(Level {
        width,
        height,
        texels: image.pixels().map(|p| p.0).collect(),
    })
}

/// Replaces invalid values and reduces the picture to [`MAX_SIZE`].
fn checked(mut level: Level, warn: &mut dyn FnMut(String)) -> Level {
    let (width, height) = (level.width, level.height);
    if width != 2 * height {
        warn(format!(
            "{width}x{height} is not twice as wide as high; it is stretched over all directions"
        ));
    }
    let mut wrong = 0;
    for value in level.texels.iter_mut().flatten() {
        if !(*value >= 0.0 && *value <= MAX_RADIANCE) {
            wrong += 1;
            *value = if *value > MAX_RADIANCE && value.is_finite() {
                MAX_RADIANCE
            } else {
                0.0
            };
        }
    }
    if wrong > 0 {
        warn(format!(
            "{wrong} values are negative, not finite or above {MAX_RADIANCE:e}; they are set to 0 or to that"
        ));
    }
    let to = (width.min(MAX_SIZE.0), height.min(MAX_SIZE.1));
    if to == (width, height) {
        return level;
    }
    warn(format!("{width}x{height} reduced to {}x{}", to.0, to.1));
    level.reduced(to.0, to.1)
}
