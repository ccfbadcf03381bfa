//! Base colours, sampled on the CPU.

use crate::metrics::colour::srgb_to_linear;
use crate::scene::{Lookup, Scene, Texture};
use glam::{Vec2, Vec4};
use std::borrow::Cow;

/// Materials and linear textures of a scene.
pub struct Surfaces<'s> {
    scene: &'s Scene,
    /// Textures by index, only base colours, as RGBA8.
    textures: Vec<Option<Cow<'s, Texture>>>,
    /// sRGB byte to linear.
    linear: [f32; 256],
}

impl<'s> Surfaces<'s> {
    /// Decodes the base colour textures of the scene's materials.
    pub fn new(scene: &'s Scene) -> Surfaces<'s> {
        let mut textures = vec![None; scene.textures.len()];
        for index in scene.materials.iter().filter_map(|m| m.base_color_texture) {
            let (Some(slot), Some(t)) = (
                textures.get_mut(index as usize),
                scene.textures.get(index as usize),
            ) else {
                continue;
            };
            if slot.is_none() {
                let packed = t.format.is_compressed();
                *slot = Some(if packed {
                    Cow::Owned(t.resampled(t.width, t.height))
                } else {
                    Cow::Borrowed(t)
                });
            }
        }
        Surfaces {
            scene,
            textures,
            linear: std::array::from_fn(|i| srgb_to_linear(i as f32 / 255.0)),
        }
    }

    /// Alpha cutoff of a material; 0 without a mask.
    pub fn cutoff(&self, material: u32) -> f32 {
        self.scene
            .materials
            .get(material as usize)
            .map_or(0.0, |m| m.alpha_cutoff)
    }

    /// Number of texels of the base colour's finest level; 0 without a texture.
    pub fn texels(&self, material: u32) -> f32 {
        self.texture(material)
            .map_or(0.0, |t| t.width as f32 * t.height as f32)
    }

    fn texture(&self, material: u32) -> Option<&Texture> {
        let index = self
            .scene
            .materials
            .get(material as usize)?
            .base_color_texture?;
        self.textures.get(index as usize)?.as_deref()
    }

    /// The coordinate set of the base colour.
    pub fn set(&self, material: u32, sets: Vec4) -> Vec2 {
        self.lookup(material).set(sets)
    }

    fn lookup(&self, material: u32) -> Lookup {
        self.scene
            .materials
            .get(material as usize)
            .map_or_else(Lookup::default, |m| m.lookups.base_color)
    }

    /// Linear base colour and alpha without vertex colours. `level` is the mip level; the nearest
    /// one is filtered bilinearly.
    pub fn base_color(&self, material: u32, sets: Vec4, level: f32) -> Vec4 {
        let uv = self.lookup(material).place(sets);
        let factor = self
            .scene
            .materials
            .get(material as usize)
            .map_or(Vec4::ONE, |m| m.base_color);
        let Some(texture) = self.texture(material) else {
            return factor;
        };
        let level = (level.round().max(0.0) as usize).min(texture.mips.len().saturating_sub(1));
        let size = [texture.width, texture.height].map(|n| (n >> level).max(1));
        let at = (uv - uv.floor()) * Vec2::new(size[0] as f32, size[1] as f32) - 0.5;
        let (low, part) = (at.floor(), at - at.floor());
        let texel = |dx: i32, dy: i32| {
            let x = (low.x as i32 + dx).rem_euclid(size[0] as i32) as usize;
            let y = (low.y as i32 + dy).rem_euclid(size[1] as i32) as usize;
            let start = 4 * (x + size[0] as usize * y);
            let bytes = texture.mips[level]
                .get(start..start + 4)
                .unwrap_or(&[255, 0, 255, 255]);
            let channel = |i: usize| {
                if texture.format.is_srgb() {
                    self.linear[bytes[i] as usize]
                } else {
                    f32::from(bytes[i]) / 255.0
                }
            };
            Vec4::new(
                channel(0),
                channel(1),
                channel(2),
                f32::from(bytes[3]) / 255.0,
            )
        };
        let row = |dy: i32| texel(0, dy).lerp(texel(1, dy), part.x);
        factor * row(0).lerp(row(1), part.y)
    }
}
