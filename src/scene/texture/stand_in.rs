//! Placeholders for images that cannot be decoded, made impossible to overlook.

use super::{Filter, Recipe, Texture, TextureFormat, texture_from_rgba};

/// An 8x8 checkerboard: magenta and black for colours, opposing values for normals and roughness.
pub(super) fn checkerboard(recipe: &Recipe, name: &str) -> Texture {
    let (format, filter, dark, light) = match recipe {
        Recipe::Color { .. } | Recipe::ColorAndMask { .. } => (
            TextureFormat::Rgba8Srgb,
            Filter::Plain,
            [0, 0, 0, 255],
            [255, 0, 255, 255],
        ),
        Recipe::Normal { .. } => (
            TextureFormat::Rgba8Unorm,
            Filter::Normal,
            [64, 128, 238, 255],
            [192, 128, 238, 255],
        ),
        Recipe::MetallicRoughness { .. }
        | Recipe::Glossiness { .. }
        | Recipe::RoughnessAndMetallic { .. } => (
            TextureFormat::Rgba8Unorm,
            Filter::Plain,
            [255, 0, 0, 255],
            [255, 255, 255, 255],
        ),
    };
    let texel = |i: usize| {
        if (i + i / 8).is_multiple_of(2) {
            light
        } else {
            dark
        }
    };
    let rgba: Vec<u8> = (0..64).flat_map(texel).collect();
    texture_from_rgba(name, 8, 8, rgba, format, filter)
}
