//! The sky's picture on the device: prefiltered for rays and cones, and as a density for sampling
//! directions.

use crate::metrics::colour::luminance;
use crate::scene::environment::Level;
use crate::scene::{Environment, SkyPicture};
use crate::vulkan::{Gpu, Image, ImageDesc, Result, Upload, View, ViewDesc, vk};
use half::f16;
use std::sync::Arc;

/// Largest radiance of a texel. A brighter picture is scaled down, and its factor up.
const MOST: f32 = 60_000.0;

/// The texture `skyTexture`.
pub(super) struct SkyTexture {
    pub view: Arc<View>,
    pub bytes: u64,
}

/// Divisor of the picture on the device.
pub(super) fn scale_of(environment: Option<&Environment>) -> f32 {
    let texels = environment.map_or(&[][..], |e| e.picture.texels());
    texels.iter().flatten().fold(MOST, |most, v| most.max(*v)) / MOST
}

/// Turns about y, 0 to 1; below 0 where there is no picture.
pub(super) fn turn_of(rotation: Option<f32>) -> f32 {
    rotation.map_or(-1.0, |degrees| (degrees / 360.0).rem_euclid(1.0))
}

/// Layer 0 is the picture without its sun, layer 1 the whole; where it has none there is one layer.
pub(super) fn texture(
    gpu: &Arc<Gpu>,
    environment: Option<&Environment>,
    upload: &mut Upload,
) -> Result<SkyTexture> {
    let scale = scale_of(environment);
    let layers: Vec<Vec<Vec<u8>>> = match environment.map(|e| &*e.picture) {
        None => vec![vec![bytes(
            &Level {
                width: 1,
                height: 1,
                texels: vec![[1.0; 3]],
            },
            1.0,
        )]],
        Some(SkyPicture { level, sun: None }) => vec![mips(level.clone(), scale)],
        Some(SkyPicture {
            level,
            sun: Some(sun),
        }) => {
            vec![mips(sun.removed(level), scale), mips(level.clone(), scale)]
        }
    };
    let (width, height) = environment.map_or((1, 1), |e| e.picture.size());
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let (levels, layer_count) = (
        layers.first().map_or(0, |l| count(l.len())),
        count(layers.len()),
    );
    let format = vk::Format::R16G16B16A16_SFLOAT;
    let desc = ImageDesc {
        name: "skyTexture".into(),
        extent: [width, height, 1],
        volume: false,
        layers: layer_count,
        mips: levels,
        format,
        views: vec![],
        usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
    };
    let image = Arc::new(Image::new(gpu, desc)?);
    let parts: Vec<Vec<&[u8]>> = layers
        .iter()
        .map(|mips| mips.iter().map(Vec::as_slice).collect())
        .collect();
    upload.image(&image, &parts)?;
    let desc = ViewDesc {
        kind: vk::ImageViewType::TYPE_2D_ARRAY,
        format,
        aspect: vk::ImageAspectFlags::COLOR,
        mips: (0, levels),
        layers: (0, layer_count),
        usage: vk::ImageUsageFlags::SAMPLED,
    };
    Ok(SkyTexture {
        view: Arc::new(View::new(&image, &desc)?),
        bytes: image.bytes,
    })
}

fn mips(level: Level, scale: f32) -> Vec<Vec<u8>> {
    level
        .chain()
        .iter()
        .map(|level| bytes(level, scale))
        .collect()
}

fn bytes(level: &Level, scale: f32) -> Vec<u8> {
    let texel = |[r, g, b]: &[f32; 3]| {
        [
            f16::from_f32(r / scale),
            f16::from_f32(g / scale),
            f16::from_f32(b / scale),
            f16::ONE,
        ]
    };
    level
        .texels
        .iter()
        .flat_map(texel)
        .flat_map(f16::to_ne_bytes)
        .collect()
}

/// The words of `skyTexels` (`shaders/reference/sky.glsl`): width, height, two words of nothing;
/// radiance around the sun; how likely the rows up to each are, from 0 to 1; how likely in each row
/// the texels up to each are; texels of two words, red and green, blue and whether it is the sun's.
pub(super) fn texels(environment: Option<&Environment>) -> Vec<u32> {
    let nothing = SkyPicture {
        level: Level {
            width: 1,
            height: 1,
            texels: vec![[0.0; 3]],
        },
        sun: None,
    };
    let (picture, scale) = (
        environment.map_or(&nothing, |e| &*e.picture),
        scale_of(environment),
    );
    let level = &picture.level;
    let around = picture
        .sun
        .as_ref()
        .map_or([0.0; 3], |sun| (sun.surroundings / scale).to_array());
    let mut words = vec![level.width, level.height, 0, 0];
    words.extend(around.map(f32::to_bits));
    words.push(0);
    let rows: Vec<&[[f32; 3]]> = level.texels.chunks_exact(level.width as usize).collect();
    let row_weight = |(y, row): (u32, &&[[f32; 3]])| {
        row.iter().map(|t| luminance(*t)).sum::<f64>() * level.solid_angle(y)
    };
    words.extend(shares((0u32..).zip(&rows).map(row_weight)));
    rows.iter()
        .for_each(|row| words.extend(shares(row.iter().map(|t| luminance(*t)))));
    let half = |v: f32| u32::from(f16::from_f32(v / scale).to_bits());
    let first = words.len();
    words.extend(
        level
            .texels
            .iter()
            .flat_map(|[r, g, b]| [half(*r) | half(*g) << 16, half(*b)]),
    );
    for texel in picture.sun.iter().flat_map(|sun| &sun.texels) {
        words[first + 2 * *texel as usize + 1] |= 1 << 16;
    }
    words
}

/// Sums of the weights up to each, from 0 to 1, as bits; without any weight they stay 0.
fn shares(weights: impl Iterator<Item = f64>) -> Vec<u32> {
    let mut sum = 0.0;
    let mut sums = vec![0.0];
    sums.extend(weights.map(|w| {
        sum += w;
        sum
    }));
    let all = if sum > 0.0 { sum } else { 1.0 };
    sums.iter().map(|s| ((s / all) as f32).to_bits()).collect()
}
