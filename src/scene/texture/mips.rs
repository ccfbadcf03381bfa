//! Mip chains by area-weighted box filtering in linear light, with preserved alpha coverage and
//! unit normals.

use std::sync::LazyLock;

use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::{Texture, TextureFormat, first_level_rgba};
use crate::metrics::colour::{linear_to_srgb, srgb_to_linear};

/// Property that a mip level preserves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::scene) enum Filter {
    /// The mean of each channel.
    Plain,
    /// Alpha coverage at the cutoff (0 to 1); colours are weighted by alpha.
    Masked(f32),
    /// Unit length after decoding.
    Normal,
}

static SRGB_TO_LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| srgb_to_linear(i as f32 / 255.0)));

/// sRGB byte by linear value in steps of 1/16384, fine enough for a lossless round trip of bytes.
static LINEAR_TO_SRGB: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let encode = |i| (linear_to_srgb(f64::from(i) / 16384.0) * 255.0 + 0.5) as u8;
    (0..=16384).map(encode).collect()
});

/// A texture with its full mip chain from RGBA8 texels. Panics if their number is not width *
/// height.
pub(in crate::scene) fn texture_from_rgba(
    name: &str,
    width: u32,
    height: u32,
    rgba: Vec<u8>,
    format: TextureFormat,
    filter: Filter,
) -> Texture {
    assert_eq!(
        rgba.len(),
        format.level_bytes(width, height),
        "texels of {name}"
    );
    let srgb = format.is_srgb();
    let mut level = decode(&rgba, srgb);
    let coverage = if let Filter::Masked(cutoff) = filter {
        alpha_coverage(&level, 1.0, cutoff)
    } else {
        0.0
    };
    let mut mips = vec![rgba];
    let (mut w, mut h) = (width, height);
    while w > 1 || h > 1 {
        let (next_w, next_h) = ((w / 2).max(1), (h / 2).max(1));
        level = shrink(&level, (w, h), (next_w, next_h), filter);
        (w, h) = (next_w, next_h);
        match filter {
            Filter::Masked(cutoff) => {
                mips.push(encode(&with_coverage(&level, cutoff, coverage), srgb))
            }
            _ => mips.push(encode(&level, srgb)),
        }
    }
    Texture {
        name: name.into(),
        width,
        height,
        format,
        mips,
    }
}

/// The linear mean of a texture, from its last level.
pub(super) fn mean_color(texture: &Texture) -> Result<Vec4, String> {
    let level = texture.mips.len().saturating_sub(1);
    let size = |n: u32| (n >> level).max(1);
    let last = Texture {
        name: texture.name.clone(),
        width: size(texture.width),
        height: size(texture.height),
        format: texture.format,
        mips: texture.mips.last().cloned().into_iter().collect(),
    };
    let texels = decode(&first_level_rgba(&last)?, texture.format.is_srgb());
    Ok(texels.iter().sum::<Vec4>() / texels.len().max(1) as f32)
}

/// RGBA8 texels reduced by the filter of the mips.
pub(super) fn reduce(
    rgba: &[u8],
    from: (u32, u32),
    to: (u32, u32),
    srgb: bool,
    filter: Filter,
) -> Vec<u8> {
    encode(&shrink(&decode(rgba, srgb), from, to, filter), srgb)
}

/// Linear values of RGBA8 texels.
pub(super) fn decode(rgba: &[u8], srgb: bool) -> Vec<Vec4> {
    let plain = |c: u8| f32::from(c) / 255.0;
    let color = |c: u8| {
        if srgb {
            SRGB_TO_LINEAR[c as usize]
        } else {
            plain(c)
        }
    };
    let texels = rgba.as_chunks::<4>().0;
    texels
        .par_iter()
        .with_min_len(4096)
        .map(|&[r, g, b, a]| Vec4::new(color(r), color(g), color(b), plain(a)))
        .collect()
}

fn encode(texels: &[Vec4], srgb: bool) -> Vec<u8> {
    let plain = |c: f32| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let color = |c: f32| match srgb {
        true => LINEAR_TO_SRGB[(c.clamp(0.0, 1.0) * 16384.0 + 0.5) as usize],
        false => plain(c),
    };
    texels
        .iter()
        .flat_map(|t| [color(t.x), color(t.y), color(t.z), plain(t.w)])
        .collect()
}

/// Each target texel is the mean over the source area that it covers, so that odd sizes lose no
/// row.
fn shrink(texels: &[Vec4], from: (u32, u32), to: (u32, u32), filter: Filter) -> Vec<Vec4> {
    let columns: Vec<Vec<(usize, f32)>> = (0..to.0).map(|x| taps(x, from.0, to.0)).collect();
    let row = |y: u32| -> Vec<Vec4> {
        let rows = taps(y, from.1, to.1);
        columns
            .iter()
            .map(|columns| mean(texels, from.0 as usize, columns, &rows, filter))
            .collect()
    };
    (0..to.1).into_par_iter().flat_map_iter(row).collect()
}

/// Source texels of a target texel along one axis, with weights that sum to 1.
fn taps(target: u32, from: u32, to: u32) -> Vec<(usize, f32)> {
    let scale = f64::from(from) / f64::from(to);
    let (start, end) = (f64::from(target) * scale, f64::from(target + 1) * scale);
    let first = start.floor() as usize;
    let last = (end.ceil() as usize).min(from as usize);
    let covered = |i: usize| (end.min(i as f64 + 1.0) - start.max(i as f64)).max(0.0) / scale;
    (first..last)
        .map(|i| (i, covered(i) as f32))
        .filter(|tap| tap.1 > 1e-6)
        .collect()
}

fn mean(
    texels: &[Vec4],
    width: usize,
    columns: &[(usize, f32)],
    rows: &[(usize, f32)],
    filter: Filter,
) -> Vec4 {
    let mut sum = Vec4::ZERO;
    let mut weighted = Vec3::ZERO;
    let mut weight = 0.0;
    for &(y, wy) in rows {
        for &(x, wx) in columns {
            let texel = texels[y * width + x];
            sum += texel * (wx * wy);
            weighted += texel.truncate() * (texel.w * wx * wy);
            weight += texel.w * wx * wy;
        }
    }
    match filter {
        Filter::Plain => sum,
        // The colour of transparent texels is arbitrary and must not bleed in.
        Filter::Masked(_) if weight > 1e-4 => (weighted / weight).extend(sum.w),
        Filter::Masked(_) => sum,
        Filter::Normal => {
            let normal = (sum.truncate() * 2.0 - 1.0).normalize_or(Vec3::Z);
            (normal * 0.5 + 0.5).extend(sum.w)
        }
    }
}

/// Fraction of texels with an alpha, scaled and quantised to a byte, at or above the cutoff.
fn alpha_coverage(texels: &[Vec4], scale: f32, cutoff: f32) -> f32 {
    let passes = |t: &&Vec4| (t.w * scale * 255.0 + 0.5).floor() >= (cutoff * 255.0).round();
    texels.iter().filter(passes).count() as f32 / texels.len() as f32
}

/// Scales alpha to the coverage of level 0 (Castano 2010).
fn with_coverage(texels: &[Vec4], cutoff: f32, coverage: f32) -> Vec<Vec4> {
    let (mut low, mut high) = (0.0f32, 8.0f32);
    for _ in 0..16 {
        let middle = 0.5 * (low + high);
        if alpha_coverage(texels, middle, cutoff) < coverage {
            low = middle
        } else {
            high = middle
        }
    }
    // Few texels allow few coverages: take the nearest one.
    let miss = |scale: f32| (alpha_coverage(texels, scale, cutoff) - coverage).abs();
    let scale = if miss(low) < miss(high) { low } else { high };
    texels
        .iter()
        .map(|t| t.truncate().extend((t.w * scale).min(1.0)))
        .collect()
}
